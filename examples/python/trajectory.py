# SPDX-License-Identifier: MIT
"""A path past an obstacle: least bending, kept 0.1 away at all of its poses by distances with their gradients.

scipy's L-BFGS moves the path where scipy is installed, else plain steps against the gradient do.
"""
import numpy as np

import pirouette

COUNT, MARGIN, WEIGHT = 40, 0.1, 400.0
robot, obstacle = pirouette.Polytope.shape("box?x=0.6&y=0.2&z=0.2"), pirouette.Polytope.shape("icosahedron")
pair = pirouette.Pair(robot, obstacle)
start, goal = np.array([-3.0, 0.1, 0.05]), np.array([3.0, 0.1, 0.05])
poses = np.tile([0.0, 0, 0, 1, 0, 0, 0], (COUNT, 1))


def cost(flat):
    """Squared steps, and squared shortfalls of the margin; and their gradient."""
    path = np.vstack([start, flat.reshape(-1, 3), goal])
    poses[:, 4:] = path[1:-1]
    answers = pair.signed_distance(poses, gradient=True)
    short = np.maximum(MARGIN - answers.distance, 0)
    steps = np.diff(path, axis=0)
    slope = 2 * (steps[:-1] - steps[1:]) - 2 * WEIGHT * short[:, None] * answers.gradient[:, :3]
    return (steps**2).sum() + WEIGHT * (short**2).sum(), slope.ravel()


path = np.linspace(start, goal, COUNT + 2)[1:-1].ravel()
before = pair.signed_distance(np.hstack([poses[:, :4], path.reshape(-1, 3)])).distance.min()
try:
    from scipy.optimize import minimize
    path = minimize(cost, path, jac=True, method="L-BFGS-B", options={"maxiter": 500}).x
except ImportError:
    for _ in range(4000):
        path = path - 5e-4 * cost(path)[1]
after = pair.signed_distance(np.hstack([poses[:, :4], path.reshape(-1, 3)])).distance.min()
print(f"least distance before {before:.3f}, after {after:.3f}")
assert before < 0 < after
print("done: trajectory")
