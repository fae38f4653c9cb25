#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""solids.py CERTIFICATE P Q [ANSWER]: checks what `pirouette query P Q --solid --certificate CERTIFICATE` writes.

P and Q are solids in OFF, ANSWER is what `--json` printed. Prints `proven: ` and what is, or `refused: ` and why, and
then exits with 1. Nothing of Pirouette is used: all is in whole numbers and fractions, on plan.py and cells.py beside.

P, turned by a quaternion, then moved, and Q are told as convex pieces. That those do not overlap and are the models is
checked first. Walls between pieces have no volume. So the solids share a point where two pieces do, and an inner point
only where two pieces do: an open set that both have reaches into a piece of each, and there into both at once.

- "apart": of each pair of pieces a plane that parts them.
- "distance": planes whose gaps are not below the distance, and two points that have it.
- "touching": one common point, and planes that no inner point of a piece is on or beyond.
- "overlap": one common inner point of two pieces. How deep is not told.
"""
import json
import sys
from fractions import Fraction
from itertools import combinations
from math import lcm

from plan import Model, Piece, cross, dot, need, rational, sub, tell, turned, vector

getattr(sys, "set_int_max_str_digits", int)(0)  # numbers of any length, where Python has a limit
COMMON = {"pirouette_solids", "claim", "quat", "translation", "p", "q"}
# Of each claim the state that it proves, and the keys that its certificate has beside those of all.
CLAIMS = {
    "apart": ("outside", {"planes"}),
    "distance": ("outside", {"planes", "pieces", "pairs", "point_p", "point_q", "distance_squared"}),
    "touching": ("boundary", {"planes", "pieces", "pairs", "point"}),
    "overlap": ("inside", {"pieces", "pairs", "point"}),
}


def is_number_of(index, things):
    return type(index) is int and 0 <= index < len(things)


class Proof:
    """A certificate. `body` has the pieces of P, then of Q, each as points where it stands, in whole numbers of 1/unit.
    """

    def __init__(self, told, models):
        need(isinstance(told, dict) and told.get("pirouette_solids") == 1, "not a certificate of solids of version 1")
        need(told["claim"] in CLAIMS and set(told) == COMMON | CLAIMS[told["claim"]][1], "other keys than are needed")
        self.told, self.claim = told, told["claim"]
        self.quat, self.move = vector(told["quat"], 4), vector(told["translation"])
        need(any(self.quat), "the quaternion is 0")
        at = []
        for name, model in zip(("p", "q"), models):
            pieces = [Piece([vector(p) for p in piece["points"]], piece["facets"]) for piece in told[name]]
            Model(model).check(pieces)
            at.append([piece.points for piece in pieces])
        at[0] = [[tuple(x + t for x, t in zip(turned(self.quat, p), self.move)) for p in points] for points in at[0]]
        self.unit = lcm(*(x.denominator for body in at for points in body for p in points for x in p))
        self.body = [[[tuple(int(x * self.unit) for x in p) for p in points] for points in body] for body in at]

    def gaps(self):
        """Of each pair of pieces the normal n of its plane, and the least n·p less the greatest n·q."""
        p, q, met = *self.body, set()
        for i, k, texts in self.told["planes"]:
            need(is_number_of(i, p) and is_number_of(k, q) and (i, k) not in met, "a plane of no pair, or a second one")
            met.add((i, k))
            n = vector(texts)
            need(any(n), f"the plane of pieces {i} and {k} has no normal")
            n = [x.numerator if x.denominator == 1 else x for x in n]  # whole numbers are faster
            yield i, k, n, min(dot(n, v) for v in p[i]) - max(dot(n, v) for v in q[k])
        need(len(met) == len(p) * len(q), "a pair of pieces has no plane")

    def mix(self):
        """Pairs of vertices of two pieces with weights, 1 in all: the points that they make, and the differences."""
        (i, k), weights, of, differences = self.told["pieces"], [], [[], []], []
        need(is_number_of(i, self.body[0]) and is_number_of(k, self.body[1]), "the point is of no pieces")
        p, q = self.body[0][i], self.body[1][k]
        for a, b, weight in self.told["pairs"]:
            need(is_number_of(a, p) and is_number_of(b, q), "a pair of no vertices")
            weights.append(rational(weight))
            of[0].append(p[a])
            of[1].append(q[b])
            differences.append(sub(q[b], p[a]))
        need(weights and min(weights) > 0 and sum(weights) == 1, "weights that are not above 0, and 1 in all")
        points = [tuple(sum(w * v[c] for w, v in zip(weights, some)) for c in range(3)) for some in of]
        for name, point in zip(("point_p", "point_q") if self.claim == "distance" else ("point", "point"), points):
            need(vector(self.told[name]) == tuple(x / self.unit for x in point), f"{name} is not where pairs put it")
        return points, differences

    def check(self):
        """What is proven, in words."""
        square = 0
        if self.claim == "overlap":
            # a ball about the origin lies in the hull of the differences, which are in no plane: see check.py
            _, d = self.mix()
            edges = [sub(v, d[0]) for v in d[1:]]
            need(any(dot(cross(a, b), c) for a, b, c in combinations(edges, 3)), "the differences lie in one plane")
            return "overlap"
        if self.claim != "apart":
            points, _ = self.mix()
            z = sub(*points)
            square = dot(z, z)  # in units
        if self.claim == "distance":
            need(square > 0, "the two points are one")
            need(rational(self.told["distance_squared"]) == Fraction(square) / self.unit ** 2, "another distance")
        for i, k, n, gap in self.gaps():
            need(gap >= 0 if self.claim == "touching" else gap > 0, f"no plane parts pieces {i} and {k}")
            need(gap * gap >= square * dot(n, n), f"pieces {i} and {k} may be nearer")
        return self.claim + (f", distance_squared {self.told['distance_squared']}" if square else "")

    def check_answer(self, answer):
        """The answer that the command printed: pose and state exactly, distances within 1e-11 of what they are of."""
        need(tuple(map(Fraction, answer["quat"])) == self.quat, "the answer has another rotation")
        need(tuple(map(Fraction, answer["translation"])) == self.move, "the answer has another translation")
        need(answer["solid"] is True and answer["state"] == CLAIMS[self.claim][0], "the answer has another state")
        if self.claim in ("distance", "touching"):
            told, square = Fraction(answer["distance"]), Fraction(self.told.get("distance_squared", 0))
            reach = Fraction(max(abs(x) for body in self.body for points in body for p in points for x in p), self.unit)
            error = (abs(told) + reach + max(map(abs, self.move))) / 10 ** 11
            need(max(told - error, 0) ** 2 <= square <= (told + error) ** 2, "the answer has another distance")


def once(pairs):
    need(len(dict(pairs)) == len(pairs), "a key is there twice")
    return dict(pairs)


def main(certificate, p, q, answer=None):
    def check():
        with open(certificate, encoding="ascii") as file:
            proof = Proof(json.load(file, object_pairs_hook=once), (p, q))
        words = proof.check()
        if answer:
            with open(answer, encoding="utf-8") as file:
                proof.check_answer(json.load(file))
        return words
    return tell(check)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) in (4, 5) else __doc__)
