#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks proofs that there is no path by any motion, in rationals.

Usage: motions.py FILE   the pieces in FILE are taken as the bodies, which are closed

Prints `proven: ` and what is, or `refused: ` and why, and then exits with 1. It stands on plan.py and turns.py beside
it.

The argument: boxes cover all rotations. At every rotation of a box the robot has the box's inner pieces, so
translations that their sums with obstacles block are blocked. The tree of the box divides the translations: parts are
blocked by one sum, or of the start's side, or of the other. No part of one side shares a polygon with one of the other
of its box, nor a point with one of a box that shares a rotation. Free poses are an open set, so a path could be moved
to go through polygons alone: it never leaves the side of its start. Its end is on the other.

A box is four intervals, in 2^-20, of quaternions x, y, z, w, of which one is 1 alone: a quaternion divided by its
largest component is in one, or its negative is. A box is the hull of its corners q. With B(p, q)v the polar form of
|q|^2 R(q)v, a turned normal times |q|^2 = sum of a_i a_k (q_i.q_k) is the sum of a_i a_k B(q_i, q_k)n with the same a_i
>= 0. So a point x with B(q_i, q_k)n.x <= (q_i.q_k) d for all pairs of corners is in the half-space n.x <= d at every
rotation.
"""
import sys
from fractions import Fraction
from itertools import combinations_with_replacement, product
from math import gcd, lcm

import turns
from plan import Cell, Piece, Plan, cross, dot, need, sub, vector

ONE = 1 << 20


class Whole:
    """A convex polytope in integers, that of a piece times a number: points, and directions of normals and edges."""

    def __init__(self, piece, scale, sign):
        self.points = [tuple(int(sign * scale * x) for x in p) for p in piece.points]
        self.edges = {reduced([int(scale * x) for x in sub(piece.points[b], piece.points[a])])
                      for facet in piece.facets for a, b in zip(facet, facet[1:] + facet[:1])}
        self.normals = {reduced([int(sign * scale ** 2 * x) for x in n]) for n, _ in piece.planes}

    def planes_of_sum(self, other):
        """Half-spaces (n, d) whose intersection is the sum: normals of facets and of pairs of edges have all facets."""
        crossed = [cross(a, b) for a in self.edges for b in other.edges]
        normals = self.normals | other.normals | {reduced(n) for n in crossed if any(n)}
        return [(n, sum(max(dot(n, p) for p in whole.points) for whole in (self, other))) for n in normals]


def reduced(n):
    most = gcd(*n)
    return tuple(x // most for x in n)


def form(p, q, v):
    """B(p, q)v = (p v q* + q v p*) / 2 for quaternions x, y, z, w."""
    a, b, s, t = p[:3], q[:3], p[3], q[3]
    of_b, of_a = dot(b, v), dot(a, v)
    mixed = [s * y + t * x for x, y in zip(a, b)]
    over, level = cross(mixed, v), s * t - dot(a, b)
    return tuple(level * v[k] + over[k] + of_b * a[k] + of_a * b[k] for k in range(3))


def are_apart(a, b):
    """Whether a box or a plane of one has the other beyond it: what most cells tell at once."""
    return (any(a.high[k] < b.low[k] or b.high[k] < a.low[k] for k in range(3)) or
            any(all(dot(n, p) > d for p, _ in other.vertices) for own, other in ((a, b), (b, a))
                for n, d in own.planes))


class Box(turns.Arc):
    """One box of rotations: its inner pieces, whose sums are Plan's, and the leaves of its tree."""

    def __init__(self, whole, told):  # pylint: disable=super-init-not-called
        self.told, self.open = told, False
        self.bounds = [(int(low), int(high)) for low, high in told["box"]]
        need(len(self.bounds) == 4 and all(low <= high for low, high in self.bounds), "a box is no box")
        need((ONE, ONE) in self.bounds, "a box is in no chart")
        corners = sorted(set(product(*self.bounds)))
        pairs = list(combinations_with_replacement(corners, 2))
        self.forms = [(p, q, sum(a * b for a, b in zip(p, q))) for p, q in pairs]
        need(all(w > 0 for _, _, w in self.forms), "a box is too wide")
        inner = [Piece([vector(p) for p in piece["points"]], piece["facets"]) for piece in told["inner"]]
        for piece, own in zip(told["inner"], inner):
            need(0 <= piece["body"] < len(whole.robot), "no such piece of the robot")
            for n, d in whole.robot[piece["body"]].planes:
                for p, q, w in self.forms:
                    m = form(p, q, n)
                    need(all(dot(m, x) <= w * d for x in own.points), "an inner piece is not within the robot")
        points = [p for piece in inner + whole.obstacles for p in piece.points]
        self.scale, self.sums = lcm(*(x.denominator for p in points for x in p)), {}
        self.inner, self.obstacles = ([Whole(piece, self.scale, sign) for piece in pieces]
                                      for pieces, sign in ((inner, -1), (whole.obstacles, 1)))
        self.leaves = self.walk(whole)

    def check_blocked(self, cell, node, part):
        """A sum has the part."""
        k, l = part[1:]
        need(0 <= k < len(self.inner) and 0 <= l < len(self.obstacles), "no such piece")
        if (k, l) not in self.sums:
            self.sums[k, l] = self.inner[k].planes_of_sum(self.obstacles[l])
        for p, _ in cell.vertices:
            w = lcm(*(x.denominator for x in p))
            x = tuple(int(y * w) * self.scale for y in p)
            need(all(dot(n, x) <= d * w for n, d in self.sums[k, l]), f"part {node}: not within the sum")

    def has(self, turn):
        """Whether a rotation is in the box."""
        chart = self.bounds.index((ONE, ONE))
        return turn[chart] != 0 and all(low <= ONE * x / turn[chart] <= high
                                        for x, (low, high) in zip(turn, self.bounds))

    def check_apart(self, other, fewest):
        for name, rival in (("start", "other"), ("other", "start")):
            for a in self.leaves[name]:
                for b in other.leaves[rival]:
                    need(are_apart(a, b) or a.shared(b) < fewest, "parts of different sides meet")

    def touches(self, other):
        return any(all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(self.bounds, bounds))
                   for bounds in (other.bounds, [(-high, -low) for low, high in other.bounds]))


class Motions(Plan):
    def __init__(self, told):  # pylint: disable=super-init-not-called
        need(told.get("motions") == 1, "not a proof of version 1")
        self.low, self.high = vector(told["low"]), vector(told["high"])
        need(all(a < b for a, b in zip(self.low, self.high)), "an empty box")
        self.robot, self.obstacles = ([Piece([vector(p) for p in piece["points"]], piece["facets"])
                                       for piece in told[name]] for name in ("robot", "obstacles"))
        self.places = [(vector(told[name]), vector(told[name + "_rotation"], 4)) for name in ("from", "to")]
        need(all(any(turn) for _, turn in self.places), "a quaternion is zero")
        self.boxes = [Box(self, box) for box in told["boxes"]]

    def check_cover(self):
        """The boxes of each chart are the leaves of an octree of it."""
        there = {tuple(box.bounds) for box in self.boxes}
        todo = [[(ONE, ONE) if k == chart else (-ONE, ONE) for k in range(4)] for chart in range(4)]
        while todo:
            bounds = todo.pop()
            if tuple(bounds) in there:
                continue
            need(all(low + high == 2 * ((low + high) // 2) for low, high in bounds), "the boxes leave rotations out")
            need(sum(high - low > 1 for low, high in bounds) == 3, "the boxes leave rotations out")
            halves = [[(low, high)] if low == high else [(low, (low + high) // 2), ((low + high) // 2, high)]
                      for low, high in bounds]
            todo += [list(child) for child in product(*halves)]

    def check(self, models=()):
        self.check_cover()
        whole = Cell.box(self.low, self.high)
        for name, (at, turn) in zip(("start", "other"), self.places):
            need(whole.has(at), "an end is outside of the box")
            sides = [side for box in self.boxes if box.has(turn) for side in box.leaves
                     for cell in box.leaves[side] if cell.has(at)]
            need(set(sides) == {name}, f"an end is not in parts of side {name} alone")
        for i, box in enumerate(self.boxes):
            box.check_apart(box, 3)
            for other in self.boxes[:i]:
                if box.touches(other):
                    box.check_apart(other, 1)
        return f"no path: {len(self.boxes)} boxes of rotations keep start and end apart"


def main(path):
    return turns.main(path, Motions)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
