# SPDX-License-Identifier: MIT
"""Changes to proofs of no path, after which they prove nothing.

`parts` is what the proof calls its parts: arcs of a turn, or boxes of rotations.
"""
import contextlib
import copy
import io
import json
import os
import random
import subprocess
import tempfile
from fractions import Fraction


def polytopes(part):
    """What a part has that blocks: inner pieces, or sums."""
    return part["inner" if "inner" in part else "sums"]


def leaf(told, parts, random_, kind):
    part = random_.choice([p for p in told[parts] if any(node[0] == kind for node in p["tree"])])
    return random_.choice([node for node in part["tree"] if node[0] == kind])


def other_side(told, parts, random_):
    """All of one part on the start's side is told to be on the other."""
    for node in random_.choice(told[parts])["tree"]:
        if node[0] == "start":
            node[0] = "other"


def blocked_by_none(told, parts, random_):
    """A free leaf is told to be blocked."""
    leaf(told, parts, random_, "start")[:] = ["blocked", 0, random_.randrange(4)]


def goal_at_start(told, parts, random_):
    told["to"] = told["from"]


def grown(told, parts, random_):
    """A polytope is larger than what it is in."""
    piece = random_.choice([p for part in told[parts] for p in polytopes(part)])
    piece["points"] = [[str(Fraction(x) * Fraction(11, 10)) for x in p] for p in piece["points"]]


def smaller_robot(told, parts, random_):
    """Another robot, which blocks less."""
    for piece in told["robot"]:
        piece["points"] = [[str(Fraction(x) / 2) for x in p] for p in piece["points"]]


def moved_obstacle(told, parts, random_):
    for p in random_.choice(told["obstacles"])["points"]:
        p[2] = str(Fraction(p[2]) + 20)


def part_left_out(told, parts, random_):
    told[parts].pop(random_.randrange(len(told[parts])))


def no_inner(told, parts, random_):
    polytopes(random_.choice(told[parts])).clear()


def loop(told, parts, random_):
    """A node is its own child."""
    random_.choice(told[parts])["tree"][0][2] = 0


LIES = [other_side, blocked_by_none, goal_at_start, grown, smaller_robot, moved_obstacle, part_left_out, no_inner, loop]


def is_proven(proof, told):
    with contextlib.redirect_stdout(io.StringIO()):
        try:
            proof(told).check()
            return True
        except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError):
            return False


def hold(program, main, proof, parts, more):
    """The proof that a program writes is accepted, and refused after each lie, those of `more` among them."""
    with tempfile.TemporaryDirectory() as place:
        path = os.path.join(place, "proof.json")
        subprocess.run([program, path], check=True, stdout=subprocess.DEVNULL)
        with open(path, encoding="utf-8") as file:
            told = json.load(file)
        assert main(path) == 0, "a proof is refused"
    seed = int(os.environ.get("PIR_TEST_SEED", "1"))
    print("seed", seed)
    random_ = random.Random(seed)
    for lie in LIES + more:
        for _ in range(2 if os.environ.get("PIR_TEST_CASES") else 1):
            changed = copy.deepcopy(told)
            lie(changed, parts, random_)
            assert not is_proven(proof, changed), f"{lie.__name__}: a lie is accepted"
        print("refused:", lie.__name__)
