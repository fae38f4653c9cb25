# SPDX-License-Identifier: MIT
"""The exact corners of a sum: a cube, turned by the quaternion (1, 2, 3, 4), added to a cube that stands.

The rotation matrix is rational, here in multiples of 1/15, and so is every coordinate that comes out.
"""
import pirouette

cube = pirouette.Polytope([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
for corner in pirouette.MinkowskiSum(cube, cube, [1, 2, 3, 4]).mesh(exact=True).exact:
    print(*corner)
print("done: exact")
