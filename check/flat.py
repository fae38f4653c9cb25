# SPDX-License-Identifier: MIT
"""Convex polygons in a plane, in rationals: lists of corners counter-clockwise, with an area."""
from fractions import Fraction

from plan import dot, need, vector


def left(a, b, p):
    """Twice the area of a triangle in the plane: positive where p is to the left of the way from a to b."""
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def sides(polygon):
    return zip(polygon, polygon[1:] + polygon[:1])


def hull(points):
    """The corners of the convex hull counter-clockwise: none if it has no area."""
    chain = []
    for order in (sorted(set(points)), sorted(set(points), reverse=True)):
        half = []
        for p in order:
            while len(half) > 1 and left(half[-2], half[-1], p) <= 0:
                half.pop()
            half.append(p)
        chain += half[:-1]
    return chain if len(chain) > 2 else []


def cut(polygon, a, b):
    """The parts of a convex polygon to the left and to the right of a line: none where that has no area."""
    at = [left(a, b, p) for p in polygon]
    for sign in (1, -1):
        part = []
        for (p, u), (q, v) in sides(list(zip(polygon, at))):
            part += [p] if sign * u >= 0 else []
            part += [tuple(x + u / (u - v) * (y - x) for x, y in zip(p, q))] if u * v < 0 else []
        yield part if any(sign * u > 0 for u in at) else []


def without(parts, polygon):
    """What convex polygons have outside of another one."""
    rest = []
    for part in parts:
        if any(all(left(a, b, p) <= 0 for p in part) for a, b in sides(polygon)):
            rest.append(part)
            continue
        for a, b in sides(polygon):
            part, outer = cut(part, a, b)
            rest += [outer] if outer else []
    return rest


def within(polygon, a, b):
    """Where a polygon has the way from a to b: an interval of [0, 1], or none."""
    low, high = Fraction(0), Fraction(1)
    for c, d in sides(polygon):
        u, v = left(c, d, a), left(c, d, b)
        if max(u, v) < 0:
            return None
        if min(u, v) < 0:
            low, high = (max(low, u / (u - v)), high) if u < 0 else (low, min(high, u / (u - v)))
    return low, high


def along(a, b, c, d):
    """Where the way from c to d runs along that from a to b in the opposite direction: as above."""
    if left(a, b, c) != 0 or left(a, b, d) != 0:
        return None
    way = [y - x for x, y in zip(a, b)]
    ends = [sum((x - o) * w for x, o, w in zip(p, a, way)) / sum(w * w for w in way) for p in (d, c)]
    return (max(ends[0], 0), min(ends[1], 1)) if ends[0] < ends[1] else None


def is_covered(intervals):
    """Whether [0, 1] is in the union of closed intervals, of which those that end before they begin have nothing."""
    reached = 0
    for low, high in sorted(interval for interval in intervals if interval and interval[0] <= interval[1]):
        reached = max(reached, high) if low <= reached else reached
    return reached >= 1


class Plane:
    """The plane n.x = d, and coordinates in it, counter-clockwise about n."""

    def __init__(self, told):
        *self.n, self.d = vector(told, 4)
        need(any(self.n), "a plane without a normal")
        k = max(range(3), key=lambda i: abs(self.n[i]))
        self.axes = ((k + 1) % 3, (k + 2) % 3) if self.n[k] > 0 else ((k + 2) % 3, (k + 1) % 3)

    def above(self, p):
        return dot(self.n, p) - self.d

    def flat(self, p):
        return tuple(p[k] for k in self.axes)

    def wider(self, polygon, room):
        """A polygon widened about the mean of its corners, in 2^-64, by 2^-k of its size, k least such that none moves
        by more than room."""
        mean = [Fraction(sum(p[i] for p in polygon) * (1 << 64) // len(polygon), 1 << 64) for i in range(2)]
        a, b, c = (self.n[k] for k in (*self.axes, 3 - sum(self.axes)))
        most, part = max(abs(x) + abs(y) + abs((a * x + b * y) / c)
                         for x, y in ((p[0] - mean[0], p[1] - mean[1]) for p in polygon)), Fraction(1)
        if not room:
            return polygon
        while part * most > room:
            part /= 2
        return [tuple(x + part * (x - m) for x, m in zip(p, mean)) for p in polygon]

    def section(self, points):
        """The section of the hull of points, where some are before the plane and some beyond: else none."""
        told = [(self.flat(p), self.above(p)) for p in points]
        before, beyond = ([(p, h) for p, h in told if sign * h > 0] for sign in (-1, 1))
        met = [tuple(x + g / (g - h) * (y - x) for x, y in zip(p, q)) for p, g in before for q, h in beyond]
        return hull(met + [p for p, h in told if h == 0]) if met else []
