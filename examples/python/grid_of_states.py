# SPDX-License-Identifier: MIT
"""A slice of configuration space: for many translations of a turned box, whether it overlaps a box that stands.

`#` overlaps, `o` touches, `.` is free. The quaternion (0, 0, 1, 2) is a turn with cosine 3/5 and sine 4/5, and states
are exact: no touch is missed or invented.
"""
import numpy as np

import pirouette

SIDE, SPACING = 33, 0.0625  # exact in binary, as the translations are
places = SPACING * (np.arange(SIDE) - SIDE // 2)
x, y = np.meshgrid(places, places)
translations = np.stack([x, y, np.full_like(x, 0.25)], axis=-1).reshape(-1, 3)

shapes = (pirouette.Polytope.shape(f"box?x={x}&y={y}&z={z}") for x, y, z in ((0.625, 0.625, 1), (1, 0.5, 1)))
states = pirouette.MinkowskiSum(*shapes, rotation=[0, 0, 1, 2]).states(translations).reshape(SIDE, SIDE)
for row in states[::-1]:
    print("".join(".o#"[state] for state in row))
print("done: grid_of_states")
