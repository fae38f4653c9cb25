# SPDX-License-Identifier: MIT
"""The first program of docs/getting-started.md: a cube, turned by 45 degrees, has sunk into a plate."""
import numpy as np

import pirouette

cube, plate = pirouette.Polytope.shape("cube"), pirouette.Polytope.shape("box?x=4&y=4&z=0.5")
pair = pirouette.Pair(cube, plate)
pose = [0, 0, np.tan(np.pi / 8), 1, 0.25, 0.5, 0.625]
answer = pair.signed_distance(pose)
contacts = pair.contacts(pose)
print("distance {:.3f}, out along {:.0f} {:.0f} {:.0f}".format(answer.distance, *answer.normal))
for point in contacts.point_p:
    print("contact {:.3f} {:.3f} {:.3f}".format(*point))
print("done: first")
