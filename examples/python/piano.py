# SPDX-License-Identifier: MIT
"""A piano goes through a gap that it does not fit straight: its configuration space is sliced, a way is found by asking
the slices alone, and the way is checked at 10,000 points by exact queries. Needs a package that was built with HDF5.
"""
import itertools
import pathlib
import sys
import tempfile

import numpy as np

import pirouette

if not pirouette.HAS_SLICES:
    print("skipped: this package was built without HDF5")
    sys.exit()

STEPS, STRIDE, POINTS = 120, 0.4, 10000
LEAST, MOST = np.array([-3, -2, -0.2, -3.14]), np.array([3, 2, 0.2, 3.14])  # x, y, z and the turn about z
START, GOAL = np.array([-2.0, 0, 0, 0]), np.array([2, -0.3, 0, 1.5])
random = np.random.default_rng(1)


def box(a, b):
    return pirouette.Polytope(list(itertools.product(*zip(a, b))))


lid = [[-1, -0.15, 0.2], [-1, 0.15, 0.2], [1, -0.15, 0.2], [1, 0.15, 0.2], [-0.8, 0, 0.5]]
piano = [box([-1, -0.15, -0.2], [1, 0.15, 0.2]), box([0.7, 0.15, -0.2], [1, 0.75, 0.2]), pirouette.Polytope(lid)]
corners = [[1.4 + 0.25 * np.cos(i * np.pi / 3), 1.2 + 0.25 * np.sin(i * np.pi / 3), z]
           for i in range(6) for z in (-2, 2)]
room = [box([-0.1, 0.4, -2], [0.1, 4, 2]), box([-0.1, -4, -2], [0.1, -0.4, 2]), pirouette.Polytope(corners)]


def poses(spots):
    half, zero = spots[..., 3] / 2, np.zeros_like(spots[..., 3])
    return np.stack([zero, zero, np.sin(half), np.cos(half), *np.moveaxis(spots[..., :3], -1, 0)], axis=-1)


def may_go(slices, a, b):
    """Whether the straight motion is proven free. Single poses take less time, and tell most that are not."""
    some = a + (b - a) * np.linspace(0, 1, 9)[1:, None]
    return (abs(a[3] - b[3]) < 3 and (slices.classify(poses(some)).verdict == pirouette.FREE).all() and
            slices.segment(poses(a), poses(b)).verdict == pirouette.FREE)


def grow(slices, tree, to):
    """Goes one stride from a tree's nearest spot towards another: 1 there, 0 on the way, -1 where it is not free."""
    nearest = int(np.argmin([np.linalg.norm(spot - to) for spot, _ in tree]))
    from_, far = tree[nearest][0], np.linalg.norm(tree[nearest][0] - to)
    target = to if far <= STRIDE else from_ + (to - from_) * (STRIDE / far)
    if not may_go(slices, from_, target):
        return -1
    tree.append((target, nearest))
    return int(far <= STRIDE)


def branch(tree):
    at = len(tree) - 1
    while at is not None:
        yield tree[at][0]
        at = tree[at][1]


def plan(slices):
    """RRT-Connect (Kuffner and LaValle, ICRA 2000)."""
    trees = [[(START, None)], [(GOAL, None)]]
    for turn in range(4000):
        a, b = trees[turn % 2], trees[1 - turn % 2]
        if grow(slices, a, random.uniform(LEAST, MOST)) < 0:
            continue
        reached = 0
        while reached == 0:
            reached = grow(slices, b, a[-1][0])
        if reached == 1:
            return [*branch(trees[0])][::-1] + [*branch(trees[1])][1:]
    raise SystemExit("no way was found")


def shortened(slices, path, tries=100):
    for _ in range(tries):
        if len(path) < 3:
            break
        a = int(random.integers(len(path) - 2))
        b = int(random.integers(a + 2, len(path)))
        if may_go(slices, path[a], path[b]):
            path = path[:a + 1] + path[b:]
    return path


with tempfile.TemporaryDirectory() as folder:
    file = pathlib.Path(folder) / "piano.h5"
    slices = pirouette.CSpace.build(file, piano, room, STEPS, axis=[0, 0, 1])
    found = plan(slices)
    path = shortened(slices, found)
    slices.close()
print(f"{len(piano) * len(room)} pairs of pieces at {STEPS} rotations")
print(f"a path of {len(found)} spots, shortened to {len(path)}")
at = np.linspace(0, len(path) - 1, POINTS)
spots = np.stack([np.interp(at, range(len(path)), column) for column in np.transpose(path)], axis=1)
hits = sum((pirouette.Pair(p, q).states(poses(spots)) != pirouette.OUTSIDE).sum() for p in piano for q in room)
print(f"{POINTS} points asked, {hits} overlap")
assert hits == 0 and np.array_equal(path[0], START) and np.array_equal(path[-1], GOAL)
print("done: piano")
