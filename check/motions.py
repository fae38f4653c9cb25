#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks proofs that there is no path by any motion, in rationals.

Usage: motions.py FILE   the pieces in FILE are taken as the bodies, which are closed

Prints `proven: ` and what is, or `refused: ` and why, and then exits with 1. It stands on plan.py and turns.py beside
it.

The argument: boxes cover all rotations. Each box has sums, of a piece P of the robot and a piece O of the obstacles
each: polytopes of translations at which P meets O at every rotation of the box, so they are blocked. The tree of the
box divides the translations: parts are blocked by one sum, or of the start's side, or of the other. No part of one side
shares a polygon with one of the other of its box, nor a point with one of a box that shares a rotation. Free poses are
an open set, so a path could be moved to go through polygons alone: it never leaves the side of its start. Its end is on
the other.

A box is four intervals, in 2^-20, of quaternions x, y, z, w, of which one is 1 alone: a quaternion divided by its
largest component is in one, or its negative is. A box is the hull of its corners q. With B(p, q)v the polar form of
|q|^2 R(q)v, and q = sum of a_i q_i, |q|^2 R(q)v is the sum of a_i a_k B(q_i, q_k)v, and |q|^2 that of a_i a_k q_i.q_k,
with a_i >= 0. So what is linear in R(q)v is at most 0 in the box where it is so for B(q_i, q_k)v / (q_i.q_k) of all
pairs of corners.

P at x meets O where x is in S(q) = O - R(q)P. Half-spaces of S are those with normals N of facets of O, of facets of
-R(q)P, and e x R(q)f for edges e of O and f of P, in both directions. It is in one where N.(x - o + R(q)p) <= 0 for
some o in O and p in P. The last ones count only where N is between the normals of both facets at e, and of both at f.
So they hold as well where both half-spaces of O at e do with one p (the same o on e serves both), or both of P at f
with one o. And where all half-spaces of P do with one o, that is in P throughout.
"""
import sys
from fractions import Fraction
from itertools import combinations_with_replacement, product
from math import gcd, lcm

import turns
from plan import Cell, Piece, Plan, cross, dot, need, sub, vector

ONE = 1 << 20


class Whole:
    """A convex polytope in integers, a piece times a number: points, facets (n, d), edges with facets beside."""

    def __init__(self, piece, scale):
        self.points = [tuple(int(scale * x) for x in p) for p in piece.points]
        first = [[self.points[i] for i in facet[:3]] for facet in piece.facets]
        normals = [reduced(cross(sub(b, a), sub(c, a))) for a, b, c in first]
        self.planes = [(n, dot(n, facet[0])) for n, facet in zip(normals, first)]
        beside = {side: i for i, f in enumerate(piece.facets) for side in zip(f, f[1:] + f[:1])}
        self.edges = [(self.points[a], sub(self.points[b], self.points[a]), (i, beside[b, a]))
                      for (a, b), i in beside.items() if a < b]


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


class Pair:
    """A piece of the robot and one of the obstacles over a box; an o for a point x is told as (m (x - o), m), m > 0."""

    def __init__(self, robot, obstacle, forms):
        self.robot, self.obstacle, self.forms, self.most = robot, obstacle, forms, {}
        self.back = [[tuple(-y for y in form(p, q, n)) for p, q, _ in forms] for n, _ in robot.planes]
        count = len(robot.points)
        self.within = robot.points + [tuple(Fraction(sum(c), count) for c in zip(*robot.points))]
        self.within += [tuple(y + Fraction(z, 2) for y, z in zip(a, way)) for a, way, _ in robot.edges]

    def stays(self, facet, i, x):
        """Whether a point of the robot is in the half-space of a facet of the obstacle throughout."""
        n, d = self.obstacle.planes[facet]
        if (facet, i) not in self.most:
            self.most[facet, i] = max(Fraction(dot(n, form(p, q, self.within[i]))) / w for p, q, w in self.forms)
        return dot(n, x) + self.most[facet, i] <= d

    def covers(self, facet, o):
        """Whether o is in the half-space of a facet of the robot throughout."""
        (way, m), d = o, self.robot.planes[facet][1]
        return all(dot(n, way) <= w * d * m for n, (_, _, w) in zip(self.back[facet], self.forms))

    def crosses(self, e, f, o, p):
        """Whether N of two edges serves with o and p."""
        (way, m), of_p = o, cross(f, p)
        return all(dot(cross(e, form(a, b, f)), way) + m * dot(e, form(a, b, of_p)) <= 0 for a, b, _ in self.forms)

    def check(self, x):
        """The pieces meet at x throughout."""
        points, ways = range(len(self.within)), [(sub(x, o), 1) for o in self.obstacle.points]
        for a, way, _ in self.obstacle.edges:
            size, part = dot(way, way), dot(sub(x, a), way)
            if 0 < part < size:  # the nearest point of the edge
                ways.append((tuple(size * (y - z) - part * v for y, z, v in zip(x, a, way)), size))
        for n, d in self.obstacle.planes:
            size, above = dot(n, n), dot(n, x) - d
            at = tuple(size * y - above * z for y, z in zip(x, n))  # the nearest point of the plane, times size
            if all(dot(m, at) <= size * most for m, most in self.obstacle.planes):
                ways.append((tuple(above * z for z in n), size))
        ways.reverse()
        if any(all(self.covers(f, o) for f in range(len(self.robot.planes))) for o in ways):
            return
        for facets, some, holds in ((range(len(self.obstacle.planes)), points, lambda f, i: self.stays(f, i, x)),
                                    (range(len(self.robot.planes)), ways, self.covers)):
            need(all(any(holds(f, i) for i in some) for f in facets), "a sum has a point where pieces may be apart")
        open_e = [edge for edge in self.obstacle.edges
                  if not any(all(self.stays(f, i, x) for f in edge[2]) for i in points)]
        open_f = [edge for edge in self.robot.edges if not any(all(self.covers(f, o) for f in edge[2]) for o in ways)]
        for a, e, _ in open_e:
            for b, f, _ in open_f:
                tries = [((sub(x, a), 1), b)] + [(o, p) for o in ways for p in self.robot.points]
                for way in (e, sub((0, 0, 0), e)):
                    need(any(self.crosses(way, f, o, p) for o, p in tries), "a point of a sum is outside at an edge")


class Box(turns.Arc):
    """One box of rotations: its sums, and the leaves of its tree."""

    def __init__(self, whole, told):  # pylint: disable=super-init-not-called
        self.told, self.open = told, False
        self.bounds = [(int(low), int(high)) for low, high in told["box"]]
        need(len(self.bounds) == 4 and all(low <= high for low, high in self.bounds), "a box is no box")
        need((ONE, ONE) in self.bounds, "a box is in no chart")
        corners = sorted(set(product(*self.bounds)))
        pairs = list(combinations_with_replacement(corners, 2))
        forms = [(p, q, sum(a * b for a, b in zip(p, q))) for p, q in pairs]
        need(all(w > 0 for _, _, w in forms), "a box is too wide")
        self.sums = {}
        for piece in told["sums"]:
            own = Piece([vector(p) for p in piece["points"]], piece["facets"])
            k, l = divmod(piece["body"], len(whole.obstacles))
            need(0 <= k < len(whole.robot), "no such piece of the robot")
            bodies = own, whole.robot[k], whole.obstacles[l]
            scale = lcm(*(x.denominator for body in bodies for p in body.points for x in p))
            pair = Pair(Whole(whole.robot[k], scale), Whole(whole.obstacles[l], scale), forms)
            for p in own.points:
                pair.check(tuple(int(scale * x) for x in p))
            self.sums[k, l] = own.planes
        self.leaves = self.walk(whole)

    def check_blocked(self, cell, node, part):
        """A sum has the part."""
        need((part[1], part[2]) in self.sums, "no such sum")
        need(all(dot(n, p) <= d for n, d in self.sums[part[1], part[2]] for p, _ in cell.vertices),
             f"part {node}: not within the sum")

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
        """The boxes of each chart are what halvings of it leave."""
        todo = [([(ONE, ONE) if k == chart else (-ONE, ONE) for k in range(4)],
                 [box.bounds for box in self.boxes if box.bounds[chart] == (ONE, ONE)]) for chart in range(4)]
        while todo:
            bounds, rest = todo.pop()
            if bounds in rest:
                continue
            for k, (low, high) in enumerate(bounds):
                middle = (low + high) // 2
                below, above = [b for b in rest if b[k][1] <= middle], [b for b in rest if b[k][0] >= middle]
                if low < middle and len(below) + len(above) == len(rest) > 0:
                    break
            else:
                raise ValueError("the boxes leave rotations out")
            todo += [(bounds[:k] + [half] + bounds[k + 1:], part)
                     for half, part in (((low, middle), below), ((middle, high), above))]

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
