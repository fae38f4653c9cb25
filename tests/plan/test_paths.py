#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Motions are proven to be free where they are, and refused where they are not: test_paths.py CHECK_FOLDER.

An oracle in doubles asks for the least distance along separating axes at many moments of random motions. Where pieces
meet, a proof is to be refused; where they stay apart by more than it can miss, one is to be found. Lies are told about
a path that is proven.
"""
import copy
import os
import random
import sys
from itertools import product
from math import acos, sin

import opening_models as models
import proof_lies

MOMENTS = 300


def turned(q, v):
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def unit(q):
    size = sum(x * x for x in q) ** 0.5
    return [x / size for x in q]


def between(q, r, l):
    """The rotation that is l of the way from q to r, by sines."""
    along = sum(x * y for x, y in zip(q, r))
    r = [x if along >= 0 else -x for x in r]
    angle = acos(min(1.0, abs(along)))
    if angle < 1e-9:
        return q
    return [(sin((1 - l) * angle) * x + sin(l * angle) * y) / sin(angle) for x, y in zip(q, r)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def apart(one, other):
    """How far two convex pieces are apart along the best of all axes; negative where they meet."""
    normals, ways = [], []
    for points, facets in (one, other):
        for f in facets:
            normals.append(cross(minus(points[f[1]], points[f[0]]), minus(points[f[2]], points[f[0]])))
        ways.append([minus(points[f[i]], points[f[i - 1]]) for f in facets for i in range(len(f)) if f[i] > f[i - 1]])
    best = -1e9
    for n in normals + [cross(a, b) for a, b in product(*ways)]:
        size = models.dot(n, n) ** 0.5
        if size < 1e-9:
            continue
        heights = [[models.dot(n, p) / size for p in points] for points, _ in (one, other)]
        best = max(best, min(heights[0]) - max(heights[1]), min(heights[1]) - max(heights[0]))
    return best


def body(points, facets):
    return {"body": 0, "points": [models.texts(p) for p in points], "facets": facets}


def path_of(robot, obstacles, poses, wide=100):
    """A path that is told as pirouette plan -o tells it."""
    ends = [(models.texts(x), models.texts(q)) for x, q in (poses[0], poses[-1])]
    return {"motions": 1, "low": models.texts([-wide] * 3), "high": models.texts([wide] * 3),
            "from": ends[0][0], "to": ends[1][0], "from_rotation": ends[0][1], "to_rotation": ends[1][1],
            "robot": [body(*piece) for piece in robot], "obstacles": [body(*piece) for piece in obstacles],
            "answer": "path", "path": [{"at": list(x), "quat": list(q)} for x, q in poses]}


def least_distance(robot, obstacles, poses):
    """The least over moments of all motions, and how far a point goes from one moment to the next at most."""
    reach = max(models.dot(p, p) for points, _ in robot for p in points) ** 0.5
    least, step = 1e9, 0
    for (x, q), (y, r) in zip(poses, poses[1:]):
        q, r = unit(q), unit(r)
        step = max(step, (models.dot(minus(y, x), minus(y, x)) ** 0.5 + 4 * reach) / MOMENTS)
        for i in range(MOMENTS + 1):
            l = i / MOMENTS
            rotation, place = between(q, r, l), [s + l * (t - s) for s, t in zip(x, y)]
            for points, facets in robot:
                here = [[s + t for s, t in zip(turned(rotation, p), place)] for p in points], facets
                least = min([least] + [apart(here, piece) for piece in obstacles])
    return least, step


def hold_random(random_, paths):
    """One random motion of a box, or of a tetrahedron, past others: 1 proven, 0 refused, or None where it is close."""
    def piece(where=(0, 0, 0), most=1.0):
        if random_.random() < 0.5:
            points, facets = models.block(*(random_.uniform(0.1, most) for _ in range(3)))
        else:
            points, facets = models.tetrahedron(2 * most * random_.uniform(0.3, 1))
        rotation = unit([random_.gauss(0, 1) for _ in range(4)])
        return [[s + t for s, t in zip(turned(rotation, p), where)] for p in points], facets
    robot = [piece() for _ in range(random_.choice([1, 2]))]
    obstacles = [piece([random_.uniform(-2, 2) for _ in range(3)]) for _ in range(random_.choice([1, 3]))]
    size = 2.0 ** random_.choice([-3, 0, 3])
    poses = [([random_.uniform(-4, 4) for _ in range(3)], [size * random_.gauss(0, 1) for _ in range(4)])
             for _ in range(2)]
    least, step = least_distance(robot, obstacles, poses)
    proven = proof_lies.is_proven(paths.Paths, path_of(robot, obstacles, poses))
    assert not (proven and least < -1e-9), f"a path is proven that has a depth of {-least}"
    assert proven or least < step, f"a path is refused that is free by {least}"
    return proven if proven or least < -1e-9 else None


def through_window():
    """A box that goes through a window and turns in it, and its path."""
    window, _ = models.round_window(1.0, 16, thickness=0.01)
    robot = [models.block(0.1, 0.2, 0.6)]
    side, up = (0, 0.5, 0, 0.5), (0, 0, 0, 1)
    return robot, window, [((0, 0, -2), side), ((0, 0, -1), up), ((0.1, 0, 1), (0, 0, 1, 1)), ((0, 0, 2), side)]


def smaller_window(told, _):
    told["obstacles"] = [body(*piece) for piece in models.round_window(0.3, 16, thickness=0.01)[0]]


def larger_robot(told, _):
    told["robot"] = [body(*models.block(0.1, 0.6, 0.6))]


def pose_left_out(told, _):
    told["path"].pop(1)


def pose_moved(told, random_):
    told["path"][2]["at"][0] += random_.choice([-1, 1]) * random_.uniform(1, 3)


def pose_turned(told, _):
    told["path"][1]["quat"] = [0.0, 1.0, 0.0, 1.0]
    told["path"][2]["quat"] = [0.0, 1.0, 0.0, 1.0]


def other_start(told, random_):
    told["path"][0]["at"][random_.randrange(3)] += 2.0 ** -random_.randrange(1, 40)


def other_rotation(told, random_):
    told["path"][-1]["quat"][random_.randrange(4)] += 2.0 ** -random_.randrange(1, 40)


def end_left_out(told, random_):
    told["path"].pop(random_.choice([0, -1]))


def no_path(told, random_):
    told["path"] = told["path"][:random_.randrange(2)]


def zero_quaternion(told, random_):
    random_.choice(told["path"])["quat"] = [0, 0, 0, 0]


def no_number(told, random_):
    wrong = random_.choice([float("nan"), float("inf"), "1e999999999", "x", None])
    random_.choice(told["path"])["at"][random_.randrange(3)] = wrong


def narrow_bounds(told, random_):
    told["high"][random_.randrange(2)] = "1/20"
    told["low"][2] = "-1"


def obstacle_in_the_way(told, random_):
    z = random_.uniform(-1.5, 1.5)
    told["obstacles"].append(body([(x / 64, y / 64, z + w / 64) for x, y, w in ((0, 0, 0), (1, 0, 0), (0, 1, 0),
                                                                               (0, 0, 1))], []))


def no_corner(told, random_):
    random_.choice(told["robot"] + told["obstacles"])["facets"][0][0] = random_.choice([-1, 99])


def other_version(told, random_):
    told["motions"] = random_.choice([0, 2, "1"])


LIES = [smaller_window, larger_robot, pose_left_out, pose_moved, pose_turned, other_start, other_rotation,
        end_left_out, no_path, zero_quaternion, no_number, narrow_bounds, obstacle_in_the_way, no_corner,
        other_version]


def hold_close(paths):
    """A box slides along a wall at a distance, and turns above it at another one; touching it is refused."""
    def is_free(slide, turn):
        poses = [((-1, 0, 0.75 + slide), (0, 0, 0, 1)), ((1, 0.3, 0.75 + slide), (0, 0, 0, 1)),
                 ((1, 0.3, 0.75 + turn), (0, 0, 0, 1)), ((1, 0.3, 0.75 + turn), (0, 0, 0.3, 1))]
        told = path_of([models.block(0.5, 0.5, 0.25)], [models.block(4, 4, 0.5)], poses)
        return proof_lies.is_proven(paths.Paths, told)
    assert is_free(2.0 ** -42, 2.0 ** -14), "what is near is not seen to be free"
    for gap in (0, -2.0 ** -48):
        assert not is_free(gap, 1) and not is_free(1, gap), "touching is told to be free"


def hold_half_circle(paths):
    """A half circle that is free one way is proven whichever way the signs tell, and refused where neither is."""
    points, facets = models.block(1, 0.1, 0.1)
    robot, walls = [([(x + 1, y, z) for x, y, z in points], facets)], []
    for sign in (1, -1):
        points, facets = models.block(0.25, 0.25, 0.25)
        walls.append(([(x, y + sign, z) for x, y, z in points], facets))
    for told, free in ((walls[:1], True), (walls[1:], True), (walls, False)):
        for q in ((0, 0, 1, 0), (0, 0, -1, 0)):
            poses = [((0, 0, 0), (0, 0, 0, 1)), ((0, 0, 0), q)]
            assert proof_lies.is_proven(paths.Paths, path_of(robot, told, poses)) == free, "half a circle"


def main(folder):
    sys.path.insert(0, folder)
    import paths
    seed, cases = int(os.environ.get("PIR_TEST_SEED", "1")), int(os.environ.get("PIR_TEST_CASES", "20"))
    print("seed", seed)
    random_ = random.Random(seed)
    told = [hold_random(random_, paths) for _ in range(cases)]
    print(f"of {cases} motions {told.count(True)} proven, {told.count(False)} refused, {told.count(None)} too close")
    hold_close(paths)
    hold_half_circle(paths)
    path = path_of(*through_window())
    print(paths.Paths(copy.deepcopy(path)).check())
    for lie in LIES:
        for _ in range(max(1, cases // 10)):
            changed = copy.deepcopy(path)
            lie(changed, random_)
            assert not proof_lies.is_proven(paths.Paths, changed), f"{lie.__name__}: a lie is accepted"
    print(f"{len(LIES)} kinds of lies are refused")


if __name__ == "__main__":
    main(*sys.argv[1:])
