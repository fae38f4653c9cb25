#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks proofs that there is no path by translations and turns about one axis, in rationals.

Usage: turns.py FILE   the pieces in FILE are taken as the bodies, which are closed

Prints `proven: ` and what is, or `refused: ` and why, and then exits with 1. It stands on plan.py and cells.py
beside it.

The argument: arcs of angles, each beginning where the one before ends, make one full turn. At every angle of an arc the
robot has the arc's inner pieces, so translations that their sums with obstacles block are blocked. The tree of the arc
divides the box: parts are blocked by one sum, or of the start's side, or of the other. No part of one side shares a
polygon with one of the other of its arc, nor a point with one of the arcs before and after. Free poses are an open set,
so a path could be moved to go through polygons alone: it never leaves the side of its start. Its end is on the other.

An arc's angle is told by sine and cosine (s, c) of its half, of any length: the rotation of the quaternion (s·u, c).
A normal n turns from n0 to n1 within the triangle of n0, n1 and m, where the tangents of its arc meet: half-spaces of
these three leave what is in the half-space of n at every angle.
"""
import sys

import plan
from cells import Cell
from paths import Paths
from plan import Piece, Plan, dot, half_space, need, turned, vector


def before(a, b):
    """Twice the area of two half angles: positive where the second is farther on by less than half a turn of these."""
    return a[1] * b[0] - a[0] * b[1]


class Arc(Plan):
    """One arc: its inner pieces, whose sums are Plan's, and the leaves of its tree."""

    def __init__(self, whole, told):
        self.told, self.open, self.axis = told, False, whole.axis
        self.ends = [vector(told["begin"], 2), vector(told["end"], 2)]
        inner = [Piece([vector(p) for p in piece["points"]], piece["facets"]) for piece in told["inner"]]
        for piece, own in zip(told["inner"], inner):
            need(0 <= piece["body"] < len(whole.robot), "no such piece of the robot")
            self.check_inner(whole.robot[piece["body"]], own)
        self.pieces, self.sums = [inner, whole.obstacles], {}
        self.opposite = [piece.opposite((0, 0, 0, 1)) for piece in inner]
        self.leaves = self.walk(whole)

    def turn(self, v, end):
        s, c = self.ends[end]
        return turned(tuple(s * x for x in self.axis) + (c,), v)

    def check_inner(self, piece, inner):
        (s, c), (t, d), u = *self.ends, self.axis
        size = dot(u, u)
        cosine = c * d + s * t * size  # of half the arc, times both lengths
        need(cosine > 0, "an arc is half a turn or more")
        wide = 2 * cosine ** 2 / ((c * c + s * s * size) * (d * d + t * t * size))  # 1 + cosine of the arc
        for n, most in piece.planes:
            a, b, along = self.turn(n, 0), self.turn(n, 1), dot(u, n) / size
            middle = tuple(along * u[k] + (a[k] + b[k] - 2 * along * u[k]) / wide for k in range(3))
            need(all(dot(m, x) <= most for m in (a, b, middle) for x in inner.points),
                 "an inner piece is not within the robot at all angles of its arc")

    def has(self, turn):
        """Whether an angle, given by its half, is in the arc; either half serves."""
        return any(before(self.ends[0], h) >= 0 and before(h, self.ends[1]) >= 0
                   for h in (turn, tuple(-x for x in turn)))

    def walk(self, whole):
        leaves, todo, tree = {"start": [], "other": []}, [(0, Cell.box(whole.low, whole.high))], self.told["tree"]
        while todo:
            node, cell = todo.pop()
            part = tree[node]
            if part[0] == "split":
                need(len(part) == 4 and min(part[2:]) > node,
                     f"part {node}: parts are to come after the ones that they are of")
                todo += zip(part[2:], cell.split(half_space(part[1])))
            elif part[0] == "blocked":
                need(len(part) == 3, f"part {node}: faces of blocked parts count for open bodies alone")
                self.check_blocked(cell, node, part)
            else:
                leaves[part[0]].append(cell.packed())
                leaves[part[0]][-1].node = node
        return leaves

    def check_apart(self, other, fewest):
        for name, rival in (("start", "other"), ("other", "start")):
            for a in self.leaves[name]:
                need(all(a.shared(b) < fewest for b in other.leaves[rival]), "parts of different sides meet")


class Turns:
    def __init__(self, told):
        need(told.get("turns") == 1, "not a proof of version 1")
        self.axis, self.low, self.high = (vector(told[name]) for name in ("axis", "low", "high"))
        need(any(self.axis) and all(a < b for a, b in zip(self.low, self.high)), "no axis, or an empty box")
        self.robot, self.obstacles = ([Piece([vector(p) for p in piece["points"]], piece["facets"])
                                       for piece in told[name]] for name in ("robot", "obstacles"))
        self.places = [(vector(told[name]), vector(told[name + "_turn"], 2)) for name in ("from", "to")]
        need(all(any(turn) for _, turn in self.places), "a turn is zero")
        self.arcs = [Arc(self, arc) for arc in told["arcs"]]

    def check_circle(self):
        """Half angles go up from 0 to half a turn."""
        ends = [arc.ends for arc in self.arcs]
        need(len(ends) > 2 and all(a[1] == b[0] for a, b in zip(ends, ends[1:])), "arcs do not follow each other")
        need(all(before(*arc) > 0 for arc in ends), "an arc goes back")
        need(all(arc[0][0] > 0 for arc in ends[1:]), "arcs go round more than once")
        (s, c), (t, d) = ends[0][0], ends[-1][1]
        need(s == 0 < c and t == 0 > d, "arcs are not a full turn")

    def check(self):
        self.check_circle()
        box = Cell.box(self.low, self.high)
        for name, (at, turn) in zip(("start", "other"), self.places):
            need(box.has(at), "an end is outside of the box")
            sides = [side for arc in self.arcs if arc.has(turn) for side in arc.leaves
                     for cell in arc.leaves[side] if cell.has(at)]
            need(set(sides) == {name}, f"an end is not in parts of side {name} alone")
        for i, arc in enumerate(self.arcs):
            arc.check_apart(arc, 3)
            arc.check_apart(self.arcs[i - 1], 1)
        return f"no path: {len(self.arcs)} arcs of a turn keep start and end apart"


def taken(told):
    return (Paths if "path" in told else Turns)(told)


def main(path):
    return plan.main(taken, path)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
