# SPDX-License-Identifier: MIT
"""Solids of jittered grid cells, and what they are to each other, by all pairs of their tetrahedra, in fractions."""
from fractions import Fraction
from itertools import combinations, permutations, product
from math import lcm


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return tuple(a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3] for k in range(3))


class Solid:
    """Cells of a grid, each in the six tetrahedra on its diagonal, `place` telling where corners of the grid are. The
    surface is the triangles that one tetrahedron alone has."""

    def __init__(self, cells, place):
        corners = sorted({tuple(c + d for c, d in zip(cell, by)) for cell in cells
                          for by in product((0, 1), repeat=3)})
        self.points, number = [place(c) for c in corners], {c: i for i, c in enumerate(corners)}
        self.tetrahedra, facets = [], {}
        for cell in cells:
            for order in permutations(range(3)):
                walk = [cell]
                for axis in order:
                    walk.append(tuple(x + (k == axis) for k, x in enumerate(walk[-1])))
                self.add([number[c] for c in walk], facets)
        self.facets = list(facets.values())

    def add(self, tetrahedron, facets):
        self.tetrahedra.append(tetrahedron)
        for apex in tetrahedron:
            facet = [i for i in tetrahedron if i != apex]
            a, b, c, d = (self.points[i] for i in facet + [apex])
            if dot(cross(sub(b, a), sub(c, a)), sub(d, a)) > 0:
                facet.reverse()
            if facets.pop(frozenset(facet), None) is None:
                facets[frozenset(facet)] = facet

    def off(self):
        lines = ["OFF", f"{len(self.points)} {len(self.facets)} 0"]
        lines += [" ".join(map(str, p)) for p in self.points]
        return "\n".join(lines + [" ".join(map(str, [3] + f)) for f in self.facets]) + "\n"

    def placed(self, quat, move):
        """The tetrahedra, where the body stands."""
        x, y, z, w = map(Fraction, quat)
        rows = ((w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
                (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
                (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z))
        norm = x * x + y * y + z * z + w * w
        at = [tuple(dot(row, p) / norm + t for row, t in zip(rows, move)) for p in self.points]
        return [[at[i] for i in t] for t in self.tetrahedra]


def to_segment(p, a, b):
    d = sub(b, a)
    t = min(max(Fraction(dot(sub(p, a), d)) / dot(d, d), 0), 1)
    v = tuple(x + t * y - z for x, y, z in zip(a, d, p))
    return dot(v, v)


def to_triangle(p, a, b, c):
    n = cross(sub(b, a), sub(c, a))
    if all(dot(cross(n, sub(y, x)), sub(p, x)) >= 0 for x, y in ((a, b), (b, c), (c, a))):
        return Fraction(dot(n, sub(p, a))) ** 2 / dot(n, n)
    return min(to_segment(p, x, y) for x, y in ((a, b), (b, c), (c, a)))


def of_lines(a, b, c, d):
    """The square of the distance of two segments whose common normal meets both, or none."""
    u, v, w = sub(b, a), sub(d, c), sub(c, a)
    n = cross(u, v)
    square = dot(n, n)
    if square and 0 <= dot(cross(w, v), n) <= square and 0 <= dot(cross(w, u), n) <= square:
        return Fraction(dot(w, n)) ** 2 / square
    return None


def do_overlap(s, t):
    """Whether two tetrahedra have a common inner point: no plane along facets or two edges is between them."""
    edges = [[sub(b, a) for a, b in combinations(x, 2)] for x in (s, t)]
    normals = [cross(a, b) for some in edges for a, b in combinations(some, 2)]
    normals += [cross(a, b) for a in edges[0] for b in edges[1]]
    for n in normals:
        if any(n):
            u, v = [dot(n, p) for p in s], [dot(n, p) for p in t]
            if max(u) <= min(v) or max(v) <= min(u):
                return False
    return True


def square_of(s, t):
    """The square of the distance of two tetrahedra that do not overlap."""
    found = [to_triangle(p, *f) for x, y in ((s, t), (t, s)) for p in x for f in combinations(y, 3)]
    found += [of_lines(*e, *f) for e in combinations(s, 2) for f in combinations(t, 2)]
    return min(x for x in found if x is not None)


def between_boxes(s, t):
    """The square of the distance of the boxes round two tetrahedra."""
    gaps = (max(min(p[k] for p in s) - max(p[k] for p in t), min(p[k] for p in t) - max(p[k] for p in s), 0)
            for k in range(3))
    return sum(gap * gap for gap in gaps)


def relation(p, q):
    """The state of two bodies in tetrahedra, and the square of their distance; in whole numbers, which are faster."""
    unit = lcm(*(Fraction(x).denominator for body in (p, q) for t in body for v in t for x in v))
    p, q = ([[tuple(int(x * unit) for x in v) for v in t] for t in body] for body in (p, q))
    pairs = sorted(((between_boxes(s, t), i, k) for i, s in enumerate(p) for k, t in enumerate(q)))
    best = None
    for bound, i, k in pairs:
        if best is not None and bound > best:
            break
        if bound == 0 and do_overlap(p[i], q[k]):
            return "inside", Fraction(0)
        if best != 0:
            square = square_of(p[i], q[k])
            best = square if best is None else min(best, square)
    return ("boundary" if best == 0 else "outside"), Fraction(best) / unit ** 2
