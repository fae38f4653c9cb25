#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks proofs that the openings of a plane let no piece of the robot through, by any motion, in rationals.

Usage: openings.py FILE   the pieces in FILE are taken as the bodies, which are closed

Prints `proven: ` and what is, or `refused: ` and why, and then exits with 1. It stands on flat.py, which has
polygons, turns.py and plan.py beside it, and motions.py hands it the files that have `openings`.

The argument. K is a piece of the robot, which is before a plane at the start and beyond it at the goal. In a motion
between them, look at the last moment at which K is not beyond anywhere, and at the first one after it at which K is
nowhere before. In between the plane cuts K. The section of K's inside is convex and open, moves continuously, and
misses W, the sections of the obstacles. A point of K's inside crosses the plane meanwhile, in Q: where translations
within the bounds can take it. Q without W is within holes. A hole is a group of convex polygons each of whose edges is
in W or along opposite edges of the group, so that the section does not leave it. So the section stays in a disc whose
square radius is that of the widest hole. Where there is no hole, that is a contradiction.

Of two obstacles that nearly touch the slit between them is no part of a hole, and a corner of K may be in it. So K may
stand for K made smaller about its point, by a part of 2^-shrink: that is farther from the obstacles, by the same part
of the distance from the point to K's facets, at least by `room`. Then sections may be wider by `room`: each is, about
the mean of its corners, by the largest power of two of its size that moves none farther.

As K sees it, the plane is u.x = s, u on the surface of the cube [-1, 1]^3. No |s| is above the sum of |coordinates| of
a corner that the plane meets. So in (u, s) the motion goes from START, where K is on the side u.x <= s, to GOAL, where
it is on the other one. Cells cover all (u, s). A blocked cell has chords A B of K, which planes of the cell cross, with
weights. p is where a plane crosses a chord, as A + l (B - A): l is a quotient of two linear functions, so it is most
and least at corners of the cell. The variance of the points p by weights is at most the square radius of a disc that
has them. It is convex in all l, so it is at least what its tangent at the middles of the ranges of l has. Where that is
above the square radius, the section is in no such disc. The other cells are of side +, which do not meet GOAL, or of
side -, which do not meet START. None of + meets one of -, in which the motion would have to be in turn: there is none.
"""
import sys
from fractions import Fraction
from itertools import product
from math import lcm

from flat import Plane, along, is_covered, left, sides, within, without
from plan import Piece, dot, main, need, sub, turned, vector

ONE = 1 << 40  # coordinates of cells are multiples of 2^-40
FINE = 128  # bits of l, rounded outwards
MOST = 64  # the largest exponent of an end of a chord


class Hole:
    """Convex polygons of the plane, as coordinates in it, and the square radius of a ball that has them."""

    def __init__(self, plane, told):
        centre, parts = vector(told["centre"]), [[vector(p) for p in part] for part in told["parts"]]
        self.parts = [[plane.flat(p) for p in part] for part in parts]
        need(all(plane.above(p) == 0 for part in parts for p in part), "a corner of a hole is not in the plane")
        for part in self.parts:
            need(len(part) > 2 and all(left(a, b, p) >= 0 for a, b in sides(part) for p in part) and
                 all(left(a, b, c) > 0 for a, b, c in zip(part, part[1:] + part[:1], part[2:] + part[:2])),
                 "a part of a hole is not convex and counter-clockwise")
        away = [sub(p, centre) for part in parts for p in part]
        self.square = max(dot(x, x) for x in away)

    def check_closed(self, sections):
        for i, part in enumerate(self.parts):
            others = [side for k, other in enumerate(self.parts) if k != i for side in sides(other)]
            for a, b in sides(part):
                need(is_covered([within(section, a, b) for section in sections] +
                                [along(a, b, *side) for side in others]), "an edge of a hole is open")


class Charts:
    """The cells of all planes that meet K, whose corners are integers on a scale, as is the bound of s."""

    def __init__(self, points, reach, square):
        scale = lcm(reach.denominator, *(x.denominator for p in points for x in p))
        self.points = [tuple(int(scale * x) for x in p) for p in points]
        self.reach, self.square = int(scale * reach), square * scale ** 2
        self.boxes, self.halves, self.sides, self.depths = [], [], [], []  # of each node, halves after the whole
        self.roots, self.blocked = [], 0

    def add(self, told):
        """One chart: its nodes, and its leaves looked at."""
        k, sign, text, leaves = told["axis"], told["sign"], told["tree"], iter(told["blocked"])
        need(k in (0, 1, 2) and sign in (1, -1) and isinstance(text, str), "a chart is no chart")
        self.roots.append(len(self.boxes))
        todo = [((-ONE, ONE) * 3, 0, None)]
        for letter in text:
            need(todo, "a tree goes on after its end")
            cell, depth, whole = todo.pop()
            node = len(self.boxes)
            if whole is not None:
                self.halves[whole].append(node)
            surface = (sign * ONE, sign * ONE) + cell[:4]  # from axis k on
            self.boxes.append(surface[6 - 2 * k:] + surface[:6 - 2 * k] + cell[4:])
            self.halves.append([])
            self.depths.append(depth)
            self.sides.append({"+": 1, "-": 2}.get(letter, 0))
            if letter in ("0", "1", "2"):
                i = 2 * int(letter)
                middle, odd = divmod(cell[i] + cell[i + 1], 2)
                need(not odd, "a cell is halved too often")
                todo.append((cell[:i] + (middle,) + cell[i + 1:], depth + 1, node))
                todo.append((cell[:i + 1] + (middle,) + cell[i + 2:], depth + 1, node))
            elif letter == "x":
                self.check_blocked(k, sign, cell, next(leaves, None))
            else:
                need(letter in ("+", "-"), "a cell of no kind")
                self.check_side(k, sign, cell, 1 if letter == "+" else -1)
        need(not todo and next(leaves, None) is None, "a tree has another number of cells")

    def check_side(self, k, sign, cell, side):
        """A corner of K is on one side of all planes of the cell: before them for +, beyond them for -."""
        a, b, s = cell[:2], cell[2:4], cell[4:]
        bound = side * s[side < 0] * self.reach
        need(any(side * sign * ONE * p[k] + max(side * p[k - 2] * x for x in a) + max(side * p[k - 1] * x for x in b) <
                 bound for p in self.points), f"a cell of side {'+-'[side < 0]} meets the other end")

    def chord(self, told, shift):
        """Its ends, times the scale and 2^shift."""
        ends = []
        for i, j, e in told:
            need(0 <= i < len(self.points) and 0 <= j < len(self.points), "no such corner of a piece")
            ends.append([(x << shift) + (y - x << shift - e) for x, y in zip(self.points[i], self.points[j])])
        return ends

    def range(self, k, sign, cell, chord, shift):
        """Between which multiples of 2^-FINE planes of the cell cross a chord."""
        at, crossed = [[sign * ONE * p[k] + x * p[k - 2] + y * p[k - 1] for x in cell[:2] for y in cell[2:4]]
                       for p in chord], []
        for s in (s * (self.reach << shift) for s in cell[4:]):
            need(all(g < s < h for g, h in zip(*at)), "a plane of a cell does not cross a chord")
            crossed += [(s - g << FINE) // (h - g) for g, h in zip(*at)]
        return min(crossed), max(crossed) + 1

    def check_blocked(self, k, sign, cell, told):
        need(isinstance(told, list) and len(told) in (2, 3), "a blocked cell has two or three chords")
        need(all(isinstance(x, int) for w, a, b in told for x in (w, *a, *b)) and all(w > 0 for w, _, _ in told),
             "weights are positive integers, as are numbers of corners")
        exponents = [end[2] for _, *ends in told for end in ends]
        need(0 <= min(exponents) <= max(exponents) <= MOST, "an end of a chord is not on an edge")
        shift, weights, parts = max(exponents), [w for w, _, _ in told], []
        for _, *ends in told:
            a, b = self.chord(ends, shift)
            low, high = self.range(k, sign, cell, (a, b), shift)
            way = sub(b, a)
            # times the scale, 2^shift and 2^(FINE + 1): the middle of its crossings
            parts.append(([(x << FINE + 1) + (low + high) * y for x, y in zip(a, way)], way, high - low))
        total = sum(weights)
        mean = [sum(w * p[i] for w, (p, _, _) in zip(weights, parts)) for i in range(3)]
        least = total * sum(w * dot(p, p) for w, (p, _, _) in zip(weights, parts)) - dot(mean, mean)
        for w, (p, way, wide) in zip(weights, parts):
            least -= 2 * w * wide * abs(total * dot(way, p) - dot(way, mean))
        need(least * self.square.denominator > self.square.numerator * (total << shift + FINE + 1) ** 2,
             "a section fits a hole in a blocked cell")
        self.blocked += 1

    def check_apart(self):
        """No cell of side + shares a point with one of side -: pairs of boxes are halved while they meet."""
        boxes, halves, depths, kinds = self.boxes, self.halves, self.depths, self.sides
        for node in reversed(range(len(boxes))):
            for half in halves[node]:
                kinds[node] |= kinds[half]
        todo = list(product(self.roots, repeat=2))
        while todo:
            i, k = todo.pop()
            if not kinds[i] & 1 or not kinds[k] & 2:
                continue
            a, b, c, d, e, f, g, h = boxes[i]
            m, n, o, p, q, r, s, t = boxes[k]
            if a > n or m > b or c > p or o > d or e > r or q > f or g > t or s > h:
                continue
            need(halves[i] or halves[k], "cells of both sides meet")
            if halves[i] and (not halves[k] or depths[i] <= depths[k]):
                todo += [(half, k) for half in halves[i]]
            else:
                todo += [(i, half) for half in halves[k]]


class Openings:
    def __init__(self, told):
        need(told.get("openings") == 1, "not a proof of version 1")
        self.told, self.plane = told, Plane(told["plane"])
        self.low, self.high = vector(told["low"]), vector(told["high"])
        need(all(a < b for a, b in zip(self.low, self.high)), "an empty box")
        bodies = [[Piece([vector(p) for p in piece["points"]], piece["facets"]) for piece in told[name]]
                  for name in ("robot", "obstacles")]
        need(0 <= told["piece"] < len(bodies[0]), "no such piece of the robot")
        self.piece, self.point = bodies[0][told["piece"]], vector(told["point"])
        need(all(dot(n, self.point) < d for n, d in self.piece.planes), "the point is not inside the piece")
        need(told.get("shrink", 0) < 1000, "a piece that is smaller by more than it may be")
        part, self.room = Fraction(1, 1 << told.get("shrink", 0)), vector([told.get("room", "0")], 1)[0]
        need(self.room >= 0 and (self.room == 0 or all((part * (d - dot(n, self.point))) ** 2 >= self.room ** 2 *
                                                       dot(n, n) for n, d in self.piece.planes)),
             "the smaller piece is not as far inside of the piece")
        self.points = [tuple(x + part * (y - x) for x, y in zip(p, self.point)) if self.room else p
                       for p in self.piece.points]
        sections = (self.plane.section(o.points) for o in bodies[1])
        self.sections = [self.plane.wider(section, self.room) for section in sections if section]
        self.holes = [Hole(self.plane, hole) for hole in told["holes"]]

    def check_ends(self):
        for name, side in (("from", -1), ("to", 1)):
            at, turn = vector(self.told[name]), vector(self.told[name + "_rotation"], 4)
            need(any(turn), "a quaternion is zero")
            need(all(a <= x <= b for a, x, b in zip(self.low, at, self.high)), "an end is outside of the box")
            for p in self.piece.points:
                place = [x + y for x, y in zip(turned(turn, p), at)]
                need(side * self.plane.above(place) > 0, "an end of the motion is not on its side of the plane")

    def check_cover(self):
        """Where the point can cross the plane there is an obstacle or a hole."""
        wide = sum(abs(x) for x in self.point)
        corners = product(*((a - wide, b + wide) for a, b in zip(self.low, self.high)))
        self.check_holes(self.plane.section(list(corners)))

    def check_holes(self, whole):
        """Obstacles and holes have all of a polygon of the plane, and no edge of a hole is open."""
        rest = [whole]
        for polygon in self.sections + [part for hole in self.holes for part in hole.parts]:
            rest = without(rest, polygon)
        need(not rest, "the holes leave a part of the plane out")
        for hole in self.holes:
            hole.check_closed(self.sections)

    def check(self):
        self.check_ends()
        self.check_cover()
        if not self.holes:
            return "no path: a plane is closed where the robot could cross it"
        reach = vector([self.told["reach"]], 1)[0]
        need(all(sum(abs(x) for x in p) <= reach for p in self.piece.points), "planes farther away meet the piece")
        charts = Charts(self.points, reach, max(hole.square for hole in self.holes))
        told = self.told["charts"]
        need(sorted((chart["axis"], chart["sign"]) for chart in told) == list(product(range(3), (-1, 1))),
             "there is to be one chart for each side of a cube")
        for chart in told:
            charts.add(chart)
        charts.check_apart()
        return f"no path: {charts.blocked} of {len(charts.boxes)} cells keep a plane from going through a piece"


if __name__ == "__main__":
    sys.exit(main(Openings, sys.argv[1]) if len(sys.argv) == 2 else __doc__)
