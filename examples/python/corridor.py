# SPDX-License-Identifier: MIT
"""Can a part be taken out of its housing without being turned? Decided exactly, with the path or the proof."""
import numpy as np

import pirouette


def housing(gap):
    """A box without a lid but for two ledges that leave a gap, as a list of solids."""
    parts = [((6, 4, 1), (0, 0, -2)), ((1, 4, 5), (-2.5, 0, 0)), ((1, 4, 5), (2.5, 0, 0)), ((6, 1, 5), (0, 2, 0)),
             ((6, 1, 5), (0, -2, 0)), (((4 - gap), 3, 0.5), (-gap / 2, 0, 2.25))]
    return [pirouette.Polytope.shape(f"box?x={x}&y={y}&z={z}").moved(at) for (x, y, z), at in parts]


step = pirouette.Solid.prism([[-1, -0.5], [1, -0.5], [1, 0], [0, 0], [0, 0.5], [-1, 0.5]], 0.5)
for gap, touching in ((1.75, False), (2.0, False), (2.0, True), (2.25, False)):
    way = pirouette.plan(step, housing(gap), [-0.5, 0, -1], [0, 0, 6], open=touching)
    print(f"a gap of {gap}{', touching' if touching else ''}: {way!r}, {way.sums} sums, {way.parts} parts")
    assert way.found == (gap > 2 or gap == 2 and touching)
    if way:
        assert np.array_equal(way.points[0], [-0.5, 0, -1]) and np.array_equal(way.points[-1], [0, 0, 6])
print("done: corridor")
