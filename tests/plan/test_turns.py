#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Proofs of no path that test_turn_plan writes are accepted by check/turns.py, and changed ones refused.

Usage: test_turns.py TEST_TURN_PLAN CHECK_FOLDER
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
    arc = random_.choice([a for a in told["arcs"] if any(part[0] == kind for part in a["tree"])])
    return random_.choice([part for part in arc["tree"] if part[0] == kind])


def other_side(told, random_):
    """All parts of one arc on the start's side are told to be on the other."""
    for part in random_.choice(told["arcs"])["tree"]:
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
    piece = random_.choice([p for arc in told["arcs"] for p in arc["inner"]])
    piece["points"] = [[str(Fraction(x) * Fraction(11, 10)) for x in p] for p in piece["points"]]


def smaller_robot(told, random_):
    """Another robot, in which the inner pieces are not."""
    for piece in told["robot"]:
        piece["points"] = [[str(Fraction(x) / 2) for x in p] for p in piece["points"]]


def moved_obstacle(told, random_):
    for p in random_.choice(told["obstacles"])["points"]:
        p[2] = str(Fraction(p[2]) + 20)


def arc_left_out(told, random_):
    told["arcs"].pop(random_.randrange(len(told["arcs"])))


def wider_arc(told, random_):
    """Arcs are put together, and the one that is kept does not serve for both."""
    i = random_.randrange(len(told["arcs"]) - 1)
    told["arcs"][i]["end"] = told["arcs"].pop(i + 1)["end"]


def no_inner(told, random_):
    random_.choice(told["arcs"])["inner"] = []


def other_axis(told, random_):
    told["axis"] = ["1", "0", "0"]


def loop(told, random_):
    """A part is its own child."""
    tree = random_.choice(told["arcs"])["tree"]
    tree[0][2] = 0


LIES = [other_side, blocked_by_none, goal_at_start, grown, smaller_robot, moved_obstacle, arc_left_out, wider_arc,
        no_inner, other_axis, loop]


def is_proven(turns, told):
    with contextlib.redirect_stdout(io.StringIO()):
        try:
            turns.Turns(told).check()
            return True
        except (ValueError, LookupError, TypeError, AttributeError, ZeroDivisionError):
            return False


def main(program, folder):
    sys.path.insert(0, folder)
    import turns
    with tempfile.TemporaryDirectory() as place:
        path = os.path.join(place, "proof.json")
        subprocess.run([program, path], check=True, stdout=subprocess.DEVNULL)
        with open(path, encoding="utf-8") as file:
            told = json.load(file)
        assert turns.main(path) == 0, "a proof is refused"
    seed = int(os.environ.get("PIR_TEST_SEED", "1"))
    print("seed", seed)
    random_ = random.Random(seed)
    for lie in LIES:
        for _ in range(2 if os.environ.get("PIR_TEST_CASES") else 1):
            changed = copy.deepcopy(told)
            lie(changed, random_)
            assert not is_proven(turns, changed), f"{lie.__name__}: a lie is accepted"
        print("refused:", lie.__name__)


if __name__ == "__main__":
    main(*sys.argv[1:])
