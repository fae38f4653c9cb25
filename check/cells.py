# SPDX-License-Identifier: MIT
"""Convex polytopes in integers, which the checkers of plans divide: exact, without a division but by what divides all.
"""
from functools import cached_property
from math import gcd, lcm


def lowest(numbers):
    """Integers divided by what divides all."""
    most = gcd(*numbers) or 1
    return tuple(x // most for x in numbers)


def integers(numbers):
    """Rationals times a positive number: a direction, a point (x, y, z, 1) or a half-space stays what it is."""
    least = lcm(*(x.denominator for x in numbers))
    return lowest([x.numerator * (least // x.denominator) for x in numbers])


def above(plane, p):
    """The sign of a point: above 0 beyond the plane."""
    return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3]


class Cell:
    """A convex polytope in integers: vertices, each ((X, Y, Z, W), the bits of the planes that it is on), which stands
    for X/W, Y/W, Z/W with W > 0, and planes (a, b, c, -d) of half-spaces a x + b y + c z <= d."""

    def __init__(self, vertices, planes):
        self.vertices, self.planes = vertices, planes

    @staticmethod
    def box(low, high):
        """Planes k and k + 3 are the low and high one of axis k."""
        sides = [[-(i == k) for i in range(3)] + [low[k]] for k in range(3)]
        sides += [[int(i == k) for i in range(3)] + [-high[k]] for k in range(3)]
        return Cell([(integers([high[k] if v >> k & 1 else low[k] for k in range(3)] + [1]),
                      sum(1 << (k + 3 * (v >> k & 1)) for k in range(3))) for v in range(8)],
                    [integers(side) for side in sides])

    @cached_property
    def bounds(self):
        """Between which multiples of 2^-64 it is, per axis: rounded outwards, so what they part is apart."""
        return [(min(((p[k] << 64) // p[3] for p, _ in self.vertices), default=0),
                 -min(((-p[k] << 64) // p[3] for p, _ in self.vertices), default=0)) for k in range(3)]

    def sides(self, plane):
        """The sign for each vertex: above 0 beyond the plane."""
        a, b, c, d = plane
        return [a * x + b * y + c * z + d * w for (x, y, z, w), _ in self.vertices]

    def split(self, plane):
        """The parts on both sides. An edge is between vertices where no third is on all planes of both."""
        bit, sides = 1 << len(self.planes), self.sides(plane)
        under, on, over = [], [], []
        for (p, bits), side in zip(self.vertices, sides):
            (under if side < 0 else over if side else on).append((p, bits if side else bits | bit, side))
        for a, on_a, u in under:
            for b, on_b, v in over:
                both = on_a & on_b
                if both & both - 1 and sum(bits & both == both for _, bits in self.vertices) == 2:
                    on.append((lowest([v * x - u * y for x, y in zip(a, b)]), both | bit, 0))
        return [Cell([vertex[:2] for vertex in half + on], self.planes + [own])
                for half, own in ((under, plane), (over, tuple(-x for x in plane)))]

    def packed(self):
        """The same without planes that have no vertex."""
        used = [j for j in range(len(self.planes)) if any(on >> j & 1 for _, on in self.vertices)]
        return Cell([(p, sum((on >> j & 1) << i for i, j in enumerate(used))) for p, on in self.vertices],
                    [self.planes[j] for j in used])

    def has(self, p):
        return bool(self.vertices) and all(above(plane, p) <= 0 for plane in self.planes)

    def shared(self, other):
        """How many vertices the intersection of two cells has."""
        if any(a[0] > b[1] or b[0] > a[1] for a, b in zip(self.bounds, other.bounds)):
            return 0
        for plane in other.planes:
            if max(self.sides(plane), default=0) > 0:
                self = self.split(plane)[0]
        return len(self.vertices)
