#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A proof of no path that test_rigid_plan writes is accepted by check/motions.py, and changed ones are refused.

Usage: test_motions.py TEST_RIGID_PLAN CHECK_FOLDER
"""
import contextlib
import copy
import io
import json
import os
import random
import subprocess
import sys
import tempfile
from fractions import Fraction


def leaf(told, random_, kind):
    box = random_.choice([b for b in told["boxes"] if any(part[0] == kind for part in b["tree"])])
    return random_.choice([part for part in box["tree"] if part[0] == kind])


def other_side(told, random_):
    """All parts of one box on the start's side are told to be on the other."""
    for part in random_.choice(told["boxes"])["tree"]:
        if part[0] == "start":
            part[0] = "other"


def blocked_by_none(told, random_):
    """A free leaf is told to be blocked."""
    part = leaf(told, random_, "start")
    part[:] = ["blocked", 0, random_.randrange(4)]


def goal_at_start(told, random_):
    told["to"] = told["from"]


def grown(told, random_):
    """An inner piece is larger than what it is in."""
    piece = random_.choice([p for box in told["boxes"] for p in box["inner"]])
    piece["points"] = [[str(Fraction(x) * Fraction(11, 10)) for x in p] for p in piece["points"]]


def smaller_robot(told, random_):
    """Another robot, in which the inner pieces are not."""
    for piece in told["robot"]:
        piece["points"] = [[str(Fraction(x) / 2) for x in p] for p in piece["points"]]


def moved_obstacle(told, random_):
    for p in random_.choice(told["obstacles"])["points"]:
        p[2] = str(Fraction(p[2]) + 20)


def box_left_out(told, random_):
    told["boxes"].pop(random_.randrange(len(told["boxes"])))


def box_twice(told, random_):
    """A box stands in the place of another."""
    i, k = random_.sample(range(len(told["boxes"])), 2)
    told["boxes"][i] = told["boxes"][k]


def wider_box(told, random_):
    """A box is told to be as wide as its chart."""
    box = random_.choice(told["boxes"])
    box["box"] = [[low, high] if low == high else [-2 ** 20, 2 ** 20] for low, high in box["box"]]


def no_inner(told, random_):
    random_.choice(told["boxes"])["inner"] = []


def loop(told, random_):
    """A part is its own child."""
    tree = random_.choice(told["boxes"])["tree"]
    tree[0][2] = 0


LIES = [other_side, blocked_by_none, goal_at_start, grown, smaller_robot, moved_obstacle, box_left_out, box_twice,
        wider_box, no_inner, loop]


def is_proven(motions, told):
    with contextlib.redirect_stdout(io.StringIO()):
        try:
            motions.Motions(told).check()
            return True
        except (ValueError, LookupError, TypeError, AttributeError, ZeroDivisionError):
            return False


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
    seed = int(os.environ.get("PIR_TEST_SEED", "1"))
    print("seed", seed)
    random_ = random.Random(seed)
    check_form(motions, random_)
    with tempfile.TemporaryDirectory() as place:
        path = os.path.join(place, "proof.json")
        subprocess.run([program, path], check=True, stdout=subprocess.DEVNULL)
        with open(path, encoding="utf-8") as file:
            told = json.load(file)
        assert motions.main(path) == 0, "a proof is refused"
    for lie in LIES:
        changed = copy.deepcopy(told)
        lie(changed, random_)
        assert not is_proven(motions, changed), f"{lie.__name__}: a lie is accepted"
        print("refused:", lie.__name__)


if __name__ == "__main__":
    main(*sys.argv[1:])
