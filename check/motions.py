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

Symmetries are told by signs: a diagonal matrix D of them that leaves obstacles and bounds as they are, another, E, that
leaves the robot, of the same determinant. R v + x is in the robot's place at (R, x) where D (R v + x) is in that at
(D R E, D x). So what is blocked throughout a box is so, after D, throughout its image, of quaternions d q e: then
only one box is told with sums, and of its images on which side each free part is. They are a group, i after k being
i ^ k, so that images of two boxes meet as these do: it is enough to hold each box against all images of all.

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


def multiplied(p, q):
    """The product of quaternions x, y, z, w."""
    (*a, s), (*b, t) = p, q
    return tuple(s * y + t * x + z for x, y, z in zip(a, b, cross(a, b))) + (s * t - dot(a, b),)


def signed(signs, v):
    return tuple(s * x for s, x in zip(signs, v))


class Symmetry:
    """Signs of translations, and of the robot."""

    def __init__(self, whole, signs):
        need(len(signs) == 6 and all(s in (-1, 1) for s in signs), "signs are 1 or -1")
        self.signs, self.places, self.turns = signs, signs[:3], []
        for own in (signs[:3], signs[3:]):
            odd = own[0] * own[1] * own[2]  # half a turn has two negative signs; the opposite of one has the others
            self.turns.append(tuple(int(s * odd > 0 and own != [odd] * 3) for s in own) + (int(own == [odd] * 3),))
        need(signs[0] * signs[1] * signs[2] == signs[3] * signs[4] * signs[5], "a symmetry of one determinant only")
        for body, own in ((whole.robot, signs[3:]), (whole.obstacles, signs[:3])):
            pieces = {frozenset(piece.points) for piece in body}
            need({frozenset(signed(own, p) for p in piece) for piece in pieces} == pieces, "a symmetry that is none")
        need(all(s > 0 or -a == b for s, a, b in zip(signs, whole.low, whole.high)), "bounds are not symmetric")

    def cell(self, cell):
        """The image of a part."""
        return Cell([(signed(self.places, p), on) for p, on in cell.vertices],
                    [(signed(self.places, n), d) for n, d in cell.planes])

    def box(self, bounds):
        """The image of a box: components are exchanged, and change signs, such that the one of its chart is 1."""
        ends = [multiplied(multiplied(self.turns[0], q), self.turns[1]) for q in zip(*bounds)]
        sign = next(a for a, b in zip(*ends) if a == b) // ONE
        return [tuple(sorted((sign * a, sign * b))) for a, b in zip(*ends)]


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
        self.images = [symmetry.box(self.bounds) for symmetry in whole.symmetries]
        need(self.images[0] == self.bounds, "the first symmetry is to be none")
        sides = told.get("sides", [])
        need(len(sides) == len(self.images) - 1 and all(isinstance(text, str) for text in sides),
             "sides are to be told for each image")
        self.parts = [(cell, side[0] + "".join(text[cell.node] for text in sides))  # a letter for each image
                      for side, cells in self.walk(whole).items() for cell in cells]

    def check_blocked(self, cell, node, part):
        """A sum has the part."""
        need((part[1], part[2]) in self.sums, "no such sum")
        need(all(dot(n, p) <= d for n, d in self.sums[part[1], part[2]] for p, _ in cell.vertices),
             f"part {node}: not within the sum")

    def sides_at(self, whole, at, turn):
        """The sides of the parts that have a place, of all images."""
        for i, (bounds, symmetry) in enumerate(zip(self.images, whole.symmetries)):
            most = turn[bounds.index((ONE, ONE))]
            if most != 0 and all(low <= ONE * x / most <= high for x, (low, high) in zip(turn, bounds)):
                yield from (sides[i] for cell, sides in self.parts if cell.has(signed(symmetry.places, at)))

    def check_apart(self, other, whole, image, fewest):
        """Parts of the box do not meet those of an image of another where sides are different, in any image of both."""
        shown = [(whole.symmetries[image].cell(cell), "".join(sides[i ^ image] for i in range(len(sides))))
                 for cell, sides in other.parts]
        for a, own in self.parts:
            for b, sides in shown:
                need(own == sides or are_apart(a, b) or a.shared(b) < fewest, "parts of different sides meet")

    def touches(self, bounds):
        return any(all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(self.bounds, other))
                   for other in (bounds, [(-high, -low) for low, high in bounds]))


class Motions(Plan):
    def __init__(self, told):  # pylint: disable=super-init-not-called
        need(told.get("motions") == 1, "not a proof of version 1")
        self.low, self.high = vector(told["low"]), vector(told["high"])
        need(all(a < b for a, b in zip(self.low, self.high)), "an empty box")
        self.robot, self.obstacles = ([Piece([vector(p) for p in piece["points"]], piece["facets"])
                                       for piece in told[name]] for name in ("robot", "obstacles"))
        self.places = [(vector(told[name]), vector(told[name + "_rotation"], 4)) for name in ("from", "to")]
        need(all(any(turn) for _, turn in self.places), "a quaternion is zero")
        self.symmetries = [Symmetry(self, signs) for signs in told.get("symmetries", [[1] * 6])]
        for (i, a), (k, b) in product(enumerate(self.symmetries), repeat=2):
            need(list(signed(a.signs, b.signs)) == self.symmetries[i ^ k].signs, "symmetries are not in order")
        self.boxes = [Box(self, box) for box in told["boxes"]]

    def check_cover(self):
        """The boxes of each chart are what halvings of it leave."""
        todo = [([(ONE, ONE) if k == chart else (-ONE, ONE) for k in range(4)],
                 [image for box in self.boxes for image in box.images if image[chart] == (ONE, ONE)])
                for chart in range(4)]
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
            sides = {side for box in self.boxes for side in box.sides_at(self, at, turn)}
            need(sides == {name[0]}, f"an end is not in parts of side {name} alone")
        for i, box in enumerate(self.boxes):
            for other in self.boxes[:i + 1]:
                for k, image in enumerate(other.images):
                    if other is box and k == 0:
                        box.check_apart(box, self, 0, 3)
                    elif box.touches(image):
                        box.check_apart(other, self, k, 1)
        return f"no path: {len(self.boxes) * len(self.symmetries)} boxes of rotations keep start and end apart"


def main(path):
    return turns.main(path, Motions)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
