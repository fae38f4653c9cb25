#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks what `pirouette plan -o FILE` writes, in rationals, without anything of the library.

Usage: plan.py FILE ROBOT... OBSTACLE...   each solid in OFF, in the order of the command
       plan.py FILE                        the pieces in FILE are taken as the bodies

Prints `proven: ` and what is, or `refused: ` and why, and then exits with 1. It stands on cells.py beside it.
docs/plan.md has the format and the argument: a path is proven by each motion's missing each sum of pieces; that there
is none, by parts of the box that sums block and others of two sides that do not meet.
"""
import json
import sys
from fractions import Fraction
from itertools import combinations

from cells import Cell, above, integers


class Refused(ValueError):
    """The file does not prove what it says."""


def need(holds, why):
    if not holds:
        raise Refused(why)


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rational(text):
    """A number, or a text "-3/4"; one with a power of ten could be of any length."""
    need(not isinstance(text, str) or "e" not in text.lower(), "a rational with an exponent")
    return Fraction(text)


def vector(texts, count=3):
    need(isinstance(texts, list) and len(texts) == count, "a vector has another length")
    return tuple(map(rational, texts))


def half_space(texts):
    """a x + b y + c z <= d as (a, b, c, -d)."""
    a, b, c, d = vector(texts, 4)
    return integers((a, b, c, -d))


def turned(q, v):
    """R·v for the rotation of a quaternion x, y, z, w of any length."""
    w, u = q[3], q[:3]
    n = dot(u, u) + w * w
    t = cross(u, v)
    s = cross(u, t)
    return tuple(v[k] + 2 * (w * t[k] + s[k]) / n for k in range(3))


class Piece:
    """A convex polytope: points, the planes (n, d) of its facets with n·x <= d, directions of edges."""

    def __init__(self, points, facets):
        self.points, self.planes, self.facets = points, [], facets
        for facet in facets:
            a, b, c = (points[i] for i in facet[:3])
            n = cross(sub(b, a), sub(c, a))
            need(all(dot(n, p) <= dot(n, a) for p in points), "a piece is not convex")
            need(all(dot(n, points[i]) == dot(n, a) for i in facet), "a facet of a piece is not planar")
            turns = zip(facet, facet[1:] + facet[:1], facet[2:] + facet[:2])
            need(all(dot(n, cross(sub(points[j], points[i]), sub(points[k], points[j]))) > 0 for i, j, k in turns),
                 "a facet of a piece is not convex")
            self.planes.append((n, dot(n, a)))
        sides = [side for f in facets for side in zip(f, f[1:] + f[:1])]
        need(sides and len(set(sides)) == len(sides) and {(k, i) for i, k in sides} == set(sides),
             "the surface of a piece is not closed")
        self.edges = {integers(sub(points[k], points[i])) for i, k in sides}
        self.middle = tuple(Fraction(sum(p[k] for p in points), len(points)) for k in range(3))

    def opposite(self, q):
        """−R·P, whose facets walk the other way round."""
        return Piece([tuple(-x for x in turned(q, p)) for p in self.points], [f[::-1] for f in self.facets])

    def is_beside(self, other):
        """Whether the plane of a facet has another piece beyond it."""
        return any(all(dot(n, p) >= d for p in other.points) for n, d in self.planes)

    def planes_of_sum(self, other):
        """Half-spaces whose intersection is P + Q: normals of facets and of pairs of edges have all facets."""
        crossed = [cross(a, b) for a in self.edges for b in other.edges]
        normals = {integers(n) for n in [n for n, _ in self.planes + other.planes] + crossed if any(n)}
        return [integers((*n, -sum(max(dot(n, p) for p in piece.points) for piece in (self, other)))) for n in normals]


class Model:
    """A model in OFF, as facets, lists of points. One with holes is a loop with slits, which count for nothing."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            words = [word for line in file for word in line.split("#")[0].split()]
        need(words and words[0] == "OFF", f"{path}: not OFF")
        count, place = int(words[1]), 4
        at = [Fraction(float(w)) if "." in w or "e" in w.lower() else Fraction(w) for w in words[4:4 + 3 * count]]
        self.path, self.facets, place = path, [], 4 + 3 * count
        for _ in range(int(words[2])):
            size = int(words[place])
            self.facets.append([tuple(at[3 * int(i):3 * int(i) + 3]) for i in words[place + 1:place + 1 + size]])
            place += 1 + size

    @staticmethod
    def meets_inside(polygon, piece):
        """Whether a polygon has an area within a piece."""
        for n, d in piece.planes:
            if all(dot(n, p) >= d for p in polygon):
                return False
            left = []
            for a, b in zip(polygon, polygon[1:] + polygon[:1]):
                u, v = dot(n, a) - d, dot(n, b) - d
                left += [a] if u <= 0 else []
                left += [tuple(a[k] + (b[k] - a[k]) * u / (u - v) for k in range(3))] if u * v < 0 else []
            polygon = left
        areas = [cross(sub(b, polygon[0]), sub(c, polygon[0])) for b, c in zip(polygon[1:], polygon[2:])]
        return any(sum(a[k] for a in areas) for k in range(3))

    def has(self, point):
        """Whether the facets wind round a point: the signs of those that a ray meets, which meets no edge."""
        for trial in range(1, 100):
            way, count, good = (Fraction(1), Fraction(trial, 101), Fraction(trial * trial, 10007)), 0, True
            for f in self.facets:
                for i in range(1, len(f) - 1):
                    a, b, c = (sub(x, point) for x in (f[0], f[i], f[i + 1]))
                    n, signs = cross(sub(b, a), sub(c, a)), [dot(way, cross(x, y)) for x, y in ((a, b), (b, c), (c, a))]
                    if min(signs) > 0 or max(signs) < 0:
                        count += (dot(n, a) * dot(n, way) > 0) * (1 if signs[0] > 0 else -1)
                    elif any(n) and min(signs) * max(signs) >= 0:
                        good = False
            if good:
                return count != 0
        raise Refused(f"{self.path}: no ray from the middle of a piece misses all edges")

    def check(self, pieces):
        """The pieces have disjoint insides, and their union is the model."""
        for piece in pieces:
            need(not any(self.meets_inside(f, piece) for f in self.facets), f"{self.path}: a facet is within a piece")
            need(self.has(piece.middle), f"{self.path}: a piece is outside")
        for a, b in combinations(pieces, 2):
            parted = a.is_beside(b) or b.is_beside(a)
            need(parted or any(plane[3] >= 0 for plane in a.planes_of_sum(b.opposite((0, 0, 0, 1)))),
                 f"{self.path}: pieces overlap")
        sizes = [sum(dot(f[0], cross(b, c)) for f in facets for b, c in zip(f[1:], f[2:]))
                 for facets in [self.facets] + [[[p.points[i] for i in f] for f in p.facets] for p in pieces]]
        need(sizes[0] == sum(sizes[1:]), f"{self.path}: the pieces are not all of it")


class Plan:
    def __init__(self, told):
        need(told.get("plan") == 1, "not a plan of version 1")
        need(told["bodies"] in ("open", "closed") and told["answer"] in ("path", "no path"), "an unknown word")
        self.told, self.open = told, told["bodies"] == "open"
        self.low, self.high, self.q = vector(told["low"]), vector(told["high"]), vector(told["rotation"], 4)
        self.ends = [vector(told["from"]), vector(told["to"])]
        self.pieces = [[Piece([vector(p) for p in piece["points"]], piece["facets"]) for piece in told[name]]
                       for name in ("robot", "obstacles")]
        self.opposite, self.sums = [p.opposite(self.q) for p in self.pieces[0]], {}

    def sum(self, k, l):
        if (k, l) not in self.sums:
            need(0 <= k < len(self.opposite) and 0 <= l < len(self.pieces[1]), "no such piece")
            self.sums[k, l] = self.opposite[k].planes_of_sum(self.pieces[1][l])
        return self.sums[k, l]

    def is_blocked(self, planes, a, b):
        """Whether a segment meets a sum, its inside where bodies are open."""
        low, high = Fraction(0), Fraction(1)
        for plane in planes:
            u, v = above(plane, a), above(plane, b)
            if min(u, v) > 0 or (self.open and min(u, v) == 0):
                return False
            if u > 0:
                low = max(low, u / (u - v))
            if v > 0:
                high = min(high, u / (u - v))
        return low < high if self.open else low <= high

    def check_path(self):
        path = [vector(p) for p in self.told["path_exact"]]
        need([path[0], path[-1]] == self.ends, "the path has other ends")
        for p in path:
            need(not self.told["bounded"] or Cell.box(self.low, self.high).has(p), "the path leaves the bounds")
        for i, (a, b) in enumerate(zip(path, path[1:])):
            for k in range(len(self.opposite)):
                for l in range(len(self.pieces[1])):
                    need(not self.is_blocked(self.sum(k, l), a, b), f"motion {i} meets pieces {k} and {l}")
        return f"a path of {len(path) - 1} motions"

    def check_box(self):
        """Without bounds, the box has all sums and both ends within it, so that what is round it is free."""
        need(all(a < b for a, b in zip(self.low, self.high)), "the box is empty")
        whole = Cell.box(self.low, self.high)
        for plane in whole.planes:
            most = sum(max(dot(plane, p) for piece in body for p in piece.points)
                       for body in (self.opposite, self.pieces[1]))
            need(self.told["bounded"] or most + plane[3] < 0, "the box is too small")
        need(all(whole.has(p) for p in self.ends), "an end is outside of the box")
        return whole

    def check_blocked(self, cell, node, part):
        """A sum has the part. With open bodies its faces on the sum's planes are parts of their own."""
        planes, faces = self.sum(part[1], part[2]), []
        need(all(max(cell.sides(plane), default=0) <= 0 for plane in planes), f"part {node}: not within the sum")
        for told, child in part[3:]:
            plane = half_space(told)
            need(max(cell.sides(plane), default=0) <= 0, f"part {node}: a face that is none")
            faces.append(({i for i, side in enumerate(cell.sides(plane)) if side == 0}, child, plane))
        for plane in planes if self.open else ():
            on = {i for i, side in enumerate(cell.sides(plane)) if side == 0}
            need(len(on) < len(cell.vertices), f"part {node}: on the sum's boundary")
            need(not on or any(on <= face[0] for face in faces), f"part {node}: a face is not looked at")
        return [(child, cell.split(plane)[1]) for _, child, plane in faces]

    def check_tree(self):
        tree, leaves = self.told["tree"], {"start": [], "other": []}
        todo = [(0, self.check_box())]
        while todo:
            node, cell = todo.pop()
            part = tree[node]
            need(all(node < i for i in (part[2:] if part[0] == "split" else [f[1] for f in part[3:]])),
                 f"part {node}: parts are to come after the ones that they are of")
            if part[0] == "split":
                need(len(part) == 4, f"part {node}: two parts are wanted")
                todo += zip(part[2:], cell.split(half_space(part[1])))
            elif part[0] == "blocked":
                todo += self.check_blocked(cell, node, part)
            else:
                leaves[part[0]].append((node, cell.packed()))
        for name, end in zip(("start", "other"), self.ends):
            sides = {side for side in leaves for _, cell in leaves[side] if cell.has(end)}
            need(sides == {name}, f"an end is not in parts of side {name} alone")
        for i, a in leaves["start"]:
            for k, b in leaves["other"]:
                need(a.shared(b) < (1 if self.open else 3), f"parts {i} and {k} of different sides meet")
        return f"no path: {len(leaves['start'])} and {len(leaves['other'])} free parts of {len(tree)} do not meet"

    def check(self, models=()):
        if models:
            told = [(place, piece["body"]) for place in ("robot", "obstacles") for piece in self.told[place]]
            bodies = sorted(set(told), key=lambda body: (body[0] != "robot", body[1]))
            need(len(bodies) == len(models), f"{len(bodies)} models are wanted")
            for body, model in zip(bodies, models):
                Model(model).check([p for p, own in zip(self.pieces[0] + self.pieces[1], told) if own == body])
        return self.check_path() if self.told["answer"] == "path" else self.check_tree()


def tell(check):
    """Prints what is proven, or why nothing is. Returns the exit status."""
    try:
        print("proven:", check())
        return 0
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, OSError, RecursionError) as error:
        print(f"refused: {type(error).__name__}: {error}")
        return 1


def main(proof, path, *models):
    def check():
        with open(path, encoding="utf-8") as file:
            return proof(json.load(file)).check(*([models] if models else []))
    return tell(check)


if __name__ == "__main__":
    sys.exit(main(Plan, *sys.argv[1:]) if len(sys.argv) > 1 else __doc__)
