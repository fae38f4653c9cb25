#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A proof of no path that test_rigid_plan writes is accepted by check/motions.py, and changed ones are refused.

Usage: test_motions.py TEST_RIGID_PLAN CHECK_FOLDER
"""
import json
import os
import random
import subprocess
import sys
import tempfile
from fractions import Fraction
from itertools import product
from math import prod

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


def blocked_beside(told, parts, random_):
    """A box, a plane of its tree that parts a blocked leaf from a free one, and which of both is blocked."""
    nodes = [(box, node, k) for box in told[parts] for node in box["tree"] if node[0] == "split" for k in (2, 3)
             if box["tree"][node[k]][0] == "blocked" and box["tree"][node[5 - k]][0] in ("start", "other")]
    return random_.choice(nodes)


def both_blocked(told, parts, random_):
    """What is free beyond a plane of a blocked part is told to be blocked as well."""
    _, node, k = blocked_beside(told, parts, random_)
    node[5 - k] = node[k]


def half_left_out(told, parts, random_):
    """One of the parts beside a plane is left out."""
    blocked_beside(told, parts, random_)[1].pop()


def sum_left_out(told, parts, random_):
    """A sum that blocks a part is not told."""
    box, node, k = blocked_beside(told, parts, random_)
    _, robot, obstacle = box["tree"][node[k]]
    box["sums"] = [p for p in box["sums"] if p["body"] != robot * len(told["obstacles"]) + obstacle]


def one_side(told, parts, random_):
    """One free part is told to be on the other side."""
    proof_lies.leaf(told, parts, random_, "start")[0] = "other"


def keep_boxes(motions):
    """Boxes that are told as before are made once, for a lie about one leaves the others as they are."""
    make, kept = motions.Box, {}

    def keep(whole, told):
        key = json.dumps([told, str([whole.low, whole.high, whole.along]), [s.signs for s in whole.symmetries]] +
                         [[p.points, p.facets] for p in whole.robot + whole.obstacles])
        if key not in kept:
            kept[key] = make(whole, told)
        return kept[key]
    motions.Box = keep


def other_sign(told, parts, random_):
    """A symmetry is another, or none of the bodies."""
    signs = random_.choice(told["symmetries"][1:])
    signs[random_.randrange(6)] *= -1


def symmetries_exchanged(told, parts, random_):
    i, k = random_.sample(range(len(told["symmetries"])), 2)
    signs = told["symmetries"]
    signs[i], signs[k] = signs[k], signs[i]


def symmetry_left_out(told, parts, random_):
    """With all that is told for it: images are left out."""
    del told["symmetries"][-1]
    for box in told[parts]:
        del box["sides"][-1]


def half_of_symmetries(told, parts, random_):
    """A group, but with too few images."""
    half = len(told["symmetries"]) // 2
    del told["symmetries"][half:]
    for box in told[parts]:
        del box["sides"][half - 1:]


def all_bodies_but_one(told, parts, random_):
    """A corner of an obstacle is moved by an ulp, and so is its image under some symmetries alone."""
    p = random_.choice(random_.choice(told["obstacles"])["points"])
    k = random_.randrange(3)
    p[k] = str(Fraction(p[k]) * (1 + Fraction(1, 2 ** 52)))


def bent_robot(told, parts, random_):
    """A corner of the robot is moved by an ulp."""
    p = random_.choice(random_.choice(told["robot"])["points"])
    p[0] = str(Fraction(p[0]) * (1 + Fraction(1, 2 ** 52)))


def wider_bounds(told, parts, random_):
    """Bounds that are not symmetric."""
    told["high"][0] = str(Fraction(told["high"][0]) + 1)


def other_side_of_image(told, parts, random_):
    """All parts of one side of an image are told to be on the other."""
    sides = random_.choice(told[parts])["sides"]
    i = random_.randrange(len(sides))
    sides[i] = sides[i].replace(*random_.choice([("s", "o"), ("o", "s")]))


def sides_of_another(told, parts, random_):
    """An image has the sides of one that goes the other way through the window."""
    for box in told[parts]:
        box["sides"] = [text.translate(str.maketrans("so", "os")) for text in box["sides"]]


def two_letters(told, parts, random_):
    """Letters that stand for several images."""
    box = random_.choice(told[parts])
    box["sides"][0] = [letter + letter for letter in box["sides"][0]]


def check_signs(motions, random_):
    """The image of a rotation under signs is the product of three matrices."""
    from plan import turned

    class Whole:
        robot = obstacles = ()
        low, high = (-1, -1, -1), (1, 1, 1)

    for signs in product((-1, 1), repeat=6):
        q, v = ([Fraction(random_.randrange(-9, 10)) for _ in range(n)] for n in (4, 3))
        if prod(signs) < 0 or not any(q):
            continue
        symmetry = motions.Symmetry(Whole, list(signs))
        image = motions.multiplied(motions.multiplied(symmetry.turns[0], q), symmetry.turns[1])
        assert turned(image, v) == motions.signed(signs[:3], turned(tuple(q), motions.signed(signs[3:], v)))


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
    check_signs(motions, random.Random(2))
    with tempfile.TemporaryDirectory() as place:
        path = os.path.join(place, "proof.json")
        subprocess.run([program, path, "box"], check=True, stdout=subprocess.DEVNULL)
        assert motions.main(path) == 0, "a proof of a box is refused"
    keep_boxes(motions)
    lies = [box_twice, wider_box, narrower_box, other_pair, point_moved, both_blocked, half_left_out, sum_left_out,
            one_side, other_sign, symmetries_exchanged, symmetry_left_out, half_of_symmetries, all_bodies_but_one,
            bent_robot, wider_bounds, other_side_of_image, sides_of_another, two_letters]
    proof_lies.hold(program, motions.main, motions.Motions, "boxes", lies)


if __name__ == "__main__":
    main(*sys.argv[1:])
