#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Certificates of answers about solids, and lies about them: test_solids.py COMMAND.

check/solids.py accepts every certificate that the command writes, with the answer that it printed. State and distance
are those of solid_oracle.py, which knows neither. Each lie is refused. A digit that was changed is refused, or the
statement stays what it was, as where another plane parts two pieces as well. PIR_TEST_ANSWERS says how many answers
there are (36).
"""
import collections
import copy
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
from fractions import Fraction

import solid_oracle as oracle

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "check"))
import solids  # noqa: E402  (the checker, beside the project's sources)

REFUSALS = (ValueError, LookupError, TypeError, AttributeError, ZeroDivisionError)
TURNS = [(0, 0, 0, 1), (0, 0, 1, 1), (1, 0, 0, 1), (1, 2, 3, 4), (0.1, 0.2, -0.3, 0.9), (1, 1, 1, 1)]
CELLS = {
    "L": [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
    "U": [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0)],
    "ring": [(x, y, 0) for x in range(3) for y in range(3) if (x, y) != (1, 1)],
    "peg": [(0, 0, 0), (0, 0, 1)],
}


def shapes(chance):
    """Plain solids, aligned and of integers, and others whose corners are moved by some rationals, or sheared."""
    made = [oracle.Solid(cells, lambda c: tuple(map(Fraction, c))) for cells in CELLS.values()]
    for name in ("L", "U"):
        moves = collections.defaultdict(lambda: [Fraction(chance.choice((0, 0, 0, -1, 1, 2)), chance.choice((8, 21)))
                                                 for _ in range(3)])
        made.append(oracle.Solid(CELLS[name], lambda c, by=moves: tuple(x + y for x, y in zip(c, by[c]))))
    made.append(oracle.Solid(CELLS["ring"], lambda c: (c[0] + Fraction(c[1], 3), c[1], c[2] + Fraction(c[0], 7))))
    return made


def random_move(chance, p, q, quat):
    """A translation of doubles: of halves, of a vertex onto another one or onto the middle of a facet, or any."""
    kind = chance.randrange(4)
    if kind == 0:
        return tuple(chance.randint(-6, 6) / 2 for _ in range(3))
    if kind == 1:
        return tuple(chance.uniform(-4, 4) for _ in range(3))
    corner = chance.choice(chance.choice(p.placed(quat, (0, 0, 0))))
    facet = [q.points[i] for i in chance.choice(q.facets)]
    on = facet[0] if kind == 2 else [(x + y) / 2 for x, y in zip(*facet[:2])]
    return tuple(float(x - y) for x, y in zip(on, corner))


class Model(solids.Model):
    """A model that remembers which pieces it was found to be."""
    known = set()

    def check(self, pieces):
        what = self.path, tuple((tuple(piece.points), str(piece.facets)) for piece in pieces)
        if what not in self.known:
            super().check(pieces)
            self.known.add(what)


solids.Model = Model


class Case:
    """An answer and its certificate, of P and Q in files."""

    def __init__(self, command, folder, files, pose, prove):
        self.files, self.pose = files, pose
        quat, move = (",".join(map(repr, numbers)) for numbers in pose)
        path = folder / "certificate.json"
        done = subprocess.run([command, "query", *files, "--solid", "--quat=" + quat, "--translate=" + move, "--json",
                               "--certificate", path, "--prove", prove], capture_output=True, text=True, check=True)
        self.answer, self.text = json.loads(done.stdout), path.read_text(encoding="ascii")
        self.told = json.loads(self.text)

    def check(self, told=None, files=None, answer=None):
        proof = solids.Proof(told or self.told, files or self.files)
        words = proof.check()
        proof.check_answer(answer or self.answer)
        return words


# --- lies: each returns what to check, or nothing where it cannot be told ---

def other_side(chance, told):
    plane = chance.choice(told["planes"])
    plane[2] = [str(-int(x)) for x in plane[2]]


def no_normal(chance, told):
    chance.choice(told["planes"])[2] = ["0", "0", "0"]


def no_plane(chance, told):
    told["planes"].remove(chance.choice(told["planes"]))


def plane_of_another(chance, told):
    if len(told["planes"]) < 2:
        return False
    one, other = chance.sample(told["planes"], 2)
    one[:2] = other[:2]


def no_piece(chance, told):
    told[chance.choice("pq")].pop()


def piece_twice(chance, told):
    body = told[chance.choice("pq")]
    body.append(chance.choice(body))


def moved_corner(chance, told):
    point = chance.choice(chance.choice(told[chance.choice("pq")])["points"])
    axis = chance.randrange(3)
    point[axis] = str(Fraction(point[axis]) + Fraction(chance.choice((-1, 1)), 1 << chance.choice((0, 4, 60))))


def lost_facet(chance, told):
    chance.choice(told[chance.choice("pq")])["facets"].pop()


def exchanged(chance, told):
    if told["p"] == told["q"]:
        return False
    told["p"], told["q"] = told["q"], told["p"]


def heavier(chance, told):
    pair = chance.choice(told["pairs"])
    pair[2] = str(Fraction(pair[2]) + Fraction(chance.choice((-1, 1, 3)), 1 << chance.choice((0, 40))))


def without_weight(chance, told):
    told["pairs"].append(told["pairs"][0][:2] + ["0"])


def another_distance(chance, told):
    told["distance_squared"] = str(Fraction(told["distance_squared"]) * (1 + Fraction(chance.choice((-1, 1)), 1 << 70)))


def moved(chance, told):
    axis = chance.randrange(3)
    told["translation"][axis] = str(Fraction(told["translation"][axis]) + Fraction(chance.choice((-1, 1)), 1 << 60))


def another_claim(chance, told):
    # what has a distance is apart, too
    told["claim"] = chance.choice([claim for claim in solids.CLAIMS if claim not in (told["claim"], "apart")])
    given = {"planes": [], "pieces": [0, 0], "pairs": [[0, 0, "1"]], "distance_squared": "1"}
    for key in solids.CLAIMS[told["claim"]][1] - set(told):
        told[key] = given.get(key, ["0"] * 3)
    for key in set(told) - solids.COMMON - solids.CLAIMS[told["claim"]][1]:
        del told[key]


LIES = [other_side, no_normal, no_plane, plane_of_another, no_piece, piece_twice, moved_corner, lost_facet, exchanged,
        heavier, without_weight, another_distance, moved, another_claim]
NEEDS = {other_side: "planes", no_normal: "planes", no_plane: "planes", plane_of_another: "planes", heavier: "pairs",
         without_weight: "pairs", another_distance: "distance_squared"}


def nearer_point(told):
    """A corner of the two pieces in place of their nearest points, with all numbers that it makes."""
    p, q = (solids.vector(told[name][i]["points"][0]) for name, i in zip("pq", told["pieces"]))
    turned = solids.turned(solids.vector(told["quat"], 4), p)
    p = tuple(x + t for x, t in zip(turned, solids.vector(told["translation"])))
    square = sum((x - y) ** 2 for x, y in zip(p, q))
    if square == Fraction(told["distance_squared"]):
        return False
    told.update(pairs=[[0, 0, "1"]], point_p=[str(x) for x in p], point_q=[str(x) for x in q],
                distance_squared=str(square))


def random_digit(chance, text):
    at = chance.choice([m.start() for m in re.finditer(r"\d", text)])
    return text[:at] + chance.choice([d for d in "0123456789" if d != text[at]]) + text[at + 1:]


class Test:
    def __init__(self, command):
        self.command, self.chance = command, random.Random(5)
        self.accepted, self.refused, self.same = (collections.Counter() for _ in range(3))
        self.apart = {}  # the last certificate that parts two models, and its answer

    def must_refuse(self, lie, case, **changed):
        try:
            case.check(**changed)
        except REFUSALS:
            self.refused[lie] += 1
            return
        raise AssertionError(f"accepted: {lie} {case.files} {case.pose}\n{changed}\n{case.text}")

    def tell_lies(self, case):
        chance = self.chance
        for lie in chance.sample(LIES, 4):
            told = copy.deepcopy(case.told)
            if NEEDS.get(lie, "claim") in told and lie(chance, told) is not False:
                self.must_refuse(lie.__name__, case, told=told)
        told = copy.deepcopy(case.told)
        if told["claim"] == "distance" and nearer_point(told) is not False:
            answer = {**case.answer, "distance": float(Fraction(told["distance_squared"])) ** 0.5}
            self.must_refuse("nearer_point", case, told=told, answer=answer)
        for _ in range(2):
            try:
                told = json.loads(random_digit(chance, case.text))
                case.check(told=told)
            except REFUSALS:
                self.refused["digit"] += 1
            else:
                keys = ("claim", "translation", "distance_squared")
                assert all(told.get(k) == case.told.get(k) for k in keys), told
                self.same["digit"] += 1

    def tell_of_other_places(self, case):
        """What parts two models elsewhere does not part them where they meet."""
        if case.told["claim"] in ("apart", "distance"):
            self.apart[case.files] = case
        elif case.files in self.apart:
            other = self.apart[case.files]
            told = {**other.told, **{key: case.told[key] for key in ("quat", "translation")}}
            answer = {**other.answer, **{key: case.answer[key] for key in ("quat", "translation")}}
            self.must_refuse("another place", other, told=told, answer=answer)

    def run(self, folder, answers):
        made = shapes(self.chance)
        files = []
        for i, solid in enumerate(made):
            files.append(folder / f"{i}.off")
            files[-1].write_text(solid.off(), encoding="ascii")
        for _ in range(answers):
            i, k = (self.chance.randrange(len(made)) for _ in range(2))
            quat = self.chance.choice(TURNS[:3] * 2 + TURNS)
            move = random_move(self.chance, made[i], made[k], quat)
            prove = self.chance.choice(("state", "number", "number"))
            case = Case(self.command, folder, (files[i], files[k]), (quat, move), prove)
            claim = case.check().split(",")[0]
            state, square = oracle.relation(made[i].placed(quat, [Fraction(x) for x in move]),
                                            made[k].placed((0, 0, 0, 1), (0, 0, 0)))
            assert (solids.CLAIMS[claim][0], case.answer["state"]) == (state, state), (case.files, case.pose, state)
            assert Fraction(case.told.get("distance_squared", square)) == square, (case.files, case.pose, square)
            self.accepted[claim] += 1
            self.tell_lies(case)
            self.tell_of_other_places(case)
            other = self.chance.choice([file for file in files if file != files[k]])
            self.must_refuse("another model", case, files=(files[i], other))
        assert set(self.accepted) == set(solids.CLAIMS) and len(self.refused) == len(LIES) + 4, "some did not occur"
        print(f"accepted {self.accepted.total()}: {dict(self.accepted)}; refused {self.refused.total()}: "
              f"{dict(self.refused)}; the same said otherwise: {self.same.total()}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        Test(sys.argv[1]).run(pathlib.Path(place), int(os.environ.get("PIR_TEST_ANSWERS", "36")))
