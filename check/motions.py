#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks paths by any motion, and proofs that there is none, in rationals.

Usage: motions.py FILE   the pieces in FILE are taken as the bodies, which are closed

Prints `proven: ` and what is, or `refused: ` and why, and then exits with 1. It stands on meets.py, which says when two
pieces meet throughout a box, turns.py, plan.py and cells.py beside it. openings.py has proofs by openings of planes,
paths.py paths.

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
"""
import sys
from bisect import bisect_right
from itertools import combinations_with_replacement, product
from math import lcm

import plan
import turns
from cells import Cell, integers
from meets import Pair, Turned, Whole, form
from openings import Openings
from paths import Paths
from plan import Piece, Plan, cross, dot, need, sub, vector

ONE = 1 << 20


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
        return Cell([((*signed(self.places, p), p[3]), on) for p, on in cell.vertices],
                    [(*signed(self.places, n), n[3]) for n in cell.planes])

    def box(self, bounds):
        """The image of a box: components are exchanged, and change signs, such that the one of its chart is 1."""
        ends = [multiplied(multiplied(self.turns[0], q), self.turns[1]) for q in zip(*bounds)]
        sign = next(a for a, b in zip(*ends) if a == b) // ONE
        return [tuple(sorted((sign * a, sign * b))) for a, b in zip(*ends)]


def are_apart(a, b):
    """Whether a plane of one has the other beyond it: what most cells tell at once."""
    return any(min(other.sides(plane)) > 0 for own, other in ((a, b), (b, a)) for plane in own.planes)


class Box(turns.Arc):
    """One box of rotations: its sums, and the leaves of its tree."""

    def __init__(self, whole, told):  # pylint: disable=super-init-not-called
        self.told, self.open = told, False
        self.bounds = [(int(low), int(high)) for low, high in told["box"]]
        need(len(self.bounds) == 4 and all(low <= high for low, high in self.bounds), "a box is no box")
        need((ONE, ONE) in self.bounds, "a box is in no chart")
        corners = sorted(set(product(*self.bounds)))
        pairs = list(combinations_with_replacement(corners, 2))
        axes = (1, 0, 0), (0, 1, 0), (0, 0, 1)
        forms = [(tuple(zip(*(form(p, q, axis) for axis in axes))), sum(a * b for a, b in zip(p, q))) for p, q in pairs]
        need(all(w > 0 for _, w in forms), "a box is too wide")
        turned = [Turned(piece, forms) for piece in whole.robot]
        self.sums = {}
        for piece in told["sums"]:
            own = Piece(whole.points(piece), piece["facets"])
            k, l = divmod(piece["body"], len(whole.obstacles))
            need(0 <= k < len(whole.robot), "no such piece of the robot")
            pair = Pair(turned[k], whole.obstacles[l])
            for p in own.points:
                pair.check(p)
            self.sums[k, l] = [integers((*(whole.scale * x for x in n), -d)) for n, d in own.planes]
        self.images = [symmetry.box(self.bounds) for symmetry in whole.symmetries]
        need(self.images[0] == self.bounds, "the first symmetry is to be none")
        sides = told.get("sides", [])
        need(len(sides) == len(self.images) - 1 and all(isinstance(text, str) for text in sides),
             "sides are to be told for each image")
        self.parts = [(cell, side[0] + "".join(text[cell.node] for text in sides))  # a letter for each image
                      for side, cells in self.walk(whole).items() for cell in cells]
        self.shown = {}

    def check_blocked(self, cell, node, part):
        """A sum has the part."""
        need((part[1], part[2]) in self.sums, "no such sum")
        need(all(plane in cell.planes or max(cell.sides(plane), default=0) <= 0
                 for plane in self.sums[part[1], part[2]]), f"part {node}: not within the sum")

    def sides_at(self, whole, at, turn):
        """The sides of the parts that have a place, of all images."""
        for i, (bounds, symmetry) in enumerate(zip(self.images, whole.symmetries)):
            most = turn[bounds.index((ONE, ONE))]
            if most != 0 and all(low <= ONE * x / most <= high for x, (low, high) in zip(turn, bounds)):
                yield from (sides[i] for cell, sides in self.parts if cell.has(signed(symmetry.places, at)))

    def image(self, whole, image):
        """Its parts after a symmetry, from low to high along an axis, and how low each is."""
        if image not in self.shown:
            parts = [(whole.symmetries[image].cell(cell), "".join(sides[i ^ image] for i in range(len(sides))))
                     for cell, sides in self.parts]
            parts.sort(key=lambda part: part[0].bounds[whole.along])
            self.shown[image] = parts, [cell.bounds[whole.along][0] for cell, _ in parts]
        return self.shown[image]

    def check_apart(self, other, whole, image, fewest):
        """Parts of the box do not meet those of an image of another where sides are different, in any image of both."""
        parts, lows = other.image(whole, image)
        for a, own in self.parts:
            (west, east), (south, north), (low, high) = a.bounds
            for b, sides in parts[:bisect_right(lows, a.bounds[whole.along][1])]:
                if own != sides:
                    (w, e), (s, n), (l, h) = b.bounds
                    need(w > east or west > e or s > north or south > n or l > high or low > h or are_apart(a, b) or
                         a.shared(b) < fewest, "parts of different sides meet")

    def touches(self, bounds):
        return any(all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(self.bounds, other))
                   for other in (bounds, [(-high, -low) for low, high in bounds]))


class Motions(Plan):
    def __init__(self, told):  # pylint: disable=super-init-not-called
        need(told.get("motions") == 1, "not a proof of version 1")
        self.low, self.high = vector(told["low"]), vector(told["high"])
        need(all(a < b for a, b in zip(self.low, self.high)), "an empty box")
        bodies = [told[name] for name in ("robot", "obstacles")]
        pieces = [piece for some in bodies + [box["sums"] for box in told["boxes"]] for piece in some]
        # all points are integers on this scale, and so are means of any two, and of all points of a piece of the robot
        self.scale = lcm(*{x.denominator for piece in pieces for p in piece["points"] for x in vector(p)})
        self.scale *= lcm(2, *(len(piece["points"]) for piece in told["robot"]))
        self.robot, self.obstacles = ([Whole(self.points(piece), piece["facets"]) for piece in some] for some in bodies)
        self.places = [(vector(told[name]), vector(told[name + "_rotation"], 4)) for name in ("from", "to")]
        need(all(any(turn) for _, turn in self.places), "a quaternion is zero")
        way = sub(self.places[1][0], self.places[0][0])
        self.along = max(range(3), key=lambda k: abs(way[k]))  # where most parts of different sides are apart
        self.symmetries = [Symmetry(self, signs) for signs in told.get("symmetries", [[1] * 6])]
        for (i, a), (k, b) in product(enumerate(self.symmetries), repeat=2):
            need(list(signed(a.signs, b.signs)) == self.symmetries[i ^ k].signs, "symmetries are not in order")
        self.boxes = [Box(self, box) for box in told["boxes"]]

    def points(self, piece):
        return [tuple(int(self.scale * x) for x in vector(p)) for p in piece["points"]]

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

    def check(self):
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


def taken(told):
    return (Openings if "openings" in told else Paths if "path" in told else Motions)(told)


def main(path):
    return plan.main(taken, path)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
