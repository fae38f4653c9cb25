# SPDX-License-Identifier: MIT
"""A planner in 60 lines: two trees of poses grow towards each other (RRT-Connect, Kuffner and LaValle, ICRA 2000).

A bar goes through a window in a wall that is lower than the bar is long: it has to turn. A motion is tried at poses
0.02 apart, all in one call.
"""
import numpy as np

import pirouette

STEP, FINE = 0.3, 0.02
random = np.random.default_rng(3)
bar = pirouette.Polytope.shape("box?x=0.2&y=0.2&z=1.2")
# a wall across x with a window 1.6 wide and 0.6 high
SLABS = ((0.1, 4, 1.7, (0, 0, 1.15)), (0.1, 4, 1.7, (0, 0, -1.15)), (0.1, 1.2, 0.6, (0, 1.4, 0)),
         (0.1, 1.2, 0.6, (0, -1.4, 0)))
wall = [pirouette.Polytope.shape(f"box?x={x}&y={y}&z={z}").moved(at) for x, y, z, at in SLABS]
pairs = [pirouette.Pair(bar, slab) for slab in wall]


def is_free(poses):
    return not any(pair.overlap(poses).any() for pair in pairs)


def between(a, b, step):
    """Poses on the way from a to b, b the last; quaternions need not be of length 1."""
    b = b if a[:4] @ b[:4] >= 0 else b * np.array([-1, -1, -1, -1, 1, 1, 1])
    return a + (b - a) * np.linspace(0, 1, 1 + max(1, int(np.ceil(np.linalg.norm(b - a) / step))))[1:, None]


def grow(tree, target):
    """Goes from the nearest pose of a tree towards the target as far as it is free; whether it came there."""
    nearest = int(np.argmin([np.linalg.norm(pose - target) for pose, _ in tree]))
    for pose in between(tree[nearest][0], target, STEP):
        if not is_free(between(tree[nearest][0], pose, FINE)):
            return False
        tree.append((pose, nearest))
        nearest = len(tree) - 1
    return True


def path_to_root(tree, node):
    while node is not None:
        yield tree[node][0]
        node = tree[node][1]


def plan(start, goal):
    trees = [[(start, None)], [(goal, None)]]
    for _ in range(2000):
        sample = np.append(random.normal(size=4), random.uniform([-2, -0.8, -0.3], [2, 0.8, 0.3]))
        sample[:4] /= np.linalg.norm(sample[:4])
        grow(trees[0], sample)
        if grow(trees[1], trees[0][-1][0]):
            return [*path_to_root(trees[0], len(trees[0]) - 1)][::-1] + [*path_to_root(trees[1], len(trees[1]) - 1)]
        trees.reverse()
    raise SystemExit("no path in 2000 samples")


upright = np.array([0.0, 0, 0, 1])
path = plan(np.append(upright, [-2, 0, 0]), np.append(upright, [2, 0, 0]))
print(f"{len(path)} poses; the straight way is {'free' if is_free(between(path[0], path[-1], FINE)) else 'blocked'}")
assert all(is_free(between(a, b, FINE)) for a, b in zip(path, path[1:]))
print("done: rrt")
