#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Proofs of no path that test_turn_plan writes are accepted by check/turns.py, and changed ones refused.

Usage: test_turns.py TEST_TURN_PLAN CHECK_FOLDER
"""
import sys

import proof_lies


def wider_arc(told, parts, random_):
    """Arcs are put together, and the one that is kept does not serve for both."""
    i = random_.randrange(len(told[parts]) - 1)
    told[parts][i]["end"] = told[parts].pop(i + 1)["end"]


def other_axis(told, parts, random_):
    told["axis"] = ["1", "0", "0"]


def main(program, folder):
    sys.path.insert(0, folder)
    import turns
    proof_lies.hold(program, turns.main, turns.Turns, "arcs", [wider_arc, other_axis])


if __name__ == "__main__":
    main(*sys.argv[1:])
