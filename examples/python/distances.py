# SPDX-License-Identifier: MIT
"""Signed distances and gradients of 10,000 poses of a tool about a part, in one call."""
import numpy as np

import pirouette

random = np.random.default_rng(1)
tool, part = pirouette.Polytope.shape("box?x=1&y=0.2&z=0.2"), pirouette.Polytope.shape("dodecahedron")
poses = np.hstack([random.normal(size=(10000, 4)), random.uniform(-2, 2, size=(10000, 3))])

pair = pirouette.Pair(tool, part)
answers = pair.signed_distance(poses, gradient=True)
for name, state in (("apart", pirouette.OUTSIDE), ("touch", pirouette.BOUNDARY), ("overlap", pirouette.INSIDE)):
    print(f"{np.count_nonzero(answers.state == state):6d} {name}")

# a step along the gradient takes the deepest pose out
deepest = answers.distance.argmin()
out = poses[deepest].copy()
out[4:] -= answers.distance[deepest] * answers.gradient[deepest, :3]
print(f"the deepest is {-answers.distance[deepest]:.3f} deep; a step along its normal leaves "
      f"{abs(float(pair.signed_distance(out).distance)):.0e}")
assert abs(pair.signed_distance(out).distance) < 1e-12
print("done: distances")
