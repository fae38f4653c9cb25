#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A proof of no path that test_rigid_plan writes is accepted by check/motions.py, and changed ones are refused.

Usage: test_motions.py TEST_RIGID_PLAN CHECK_FOLDER
"""
import random
import sys
from fractions import Fraction

import proof_lies


def box_twice(told, parts, random_):
    """A box stands in the place of another."""
    i, k = random_.sample(range(len(told[parts])), 2)
    told[parts][i] = told[parts][k]


def wider_box(told, parts, random_):
    """A box is told to be as wide as its chart."""
    box = random_.choice(told[parts])
    box["box"] = [[low, high] if low == high else [-2 ** 20, 2 ** 20] for low, high in box["box"]]


def narrower_box(told, parts, random_):
    """A box is told to be the half of itself."""
    box = random_.choice(told[parts])["box"]
    interval = random_.choice([interval for interval in box if interval[0] < interval[1]])
    interval[random_.randrange(2)] = sum(interval) // 2


def other_pair(told, parts, random_):
    """A sum is told to be of another obstacle."""
    piece = random_.choice([p for box in told[parts] for p in box["sums"]])
    piece["body"] = (piece["body"] + random_.randrange(1, len(told["obstacles"]))) % len(told["obstacles"])


def point_moved(told, parts, random_):
    """A corner of a sum is farther out."""
    piece = random_.choice([p for box in told[parts] for p in box["sums"]])
    i = random_.randrange(len(piece["points"]))
    middle = [sum(Fraction(p[k]) for p in piece["points"]) / len(piece["points"]) for k in range(3)]
    piece["points"][i] = [str(2 * Fraction(x) - m) for x, m in zip(piece["points"][i], middle)]


def check_form(motions, random_):
    """The polar form of a quaternion with itself is its rotation, and it is linear and symmetric."""
    from plan import turned
    for _ in range(100):
        p, q, r, v = ([Fraction(random_.randrange(-9, 10)) for _ in range(n)] for n in (4, 4, 4, 3))
        if not any(q):
            continue
        size = sum(x * x for x in q)
        assert motions.form(q, q, v) == tuple(size * x for x in turned(tuple(q), v))
        assert motions.form(p, q, v) == motions.form(q, p, v)
        both = motions.form([a + b for a, b in zip(p, r)], q, v)
        assert both == tuple(a + b for a, b in zip(motions.form(p, q, v), motions.form(r, q, v)))


def main(program, folder):
    sys.path.insert(0, folder)
    import motions
    check_form(motions, random.Random(1))
    lies = [box_twice, wider_box, narrower_box, other_pair, point_moved]
    proof_lies.hold(program, motions.main, motions.Motions, "boxes", lies)


if __name__ == "__main__":
    main(*sys.argv[1:])
