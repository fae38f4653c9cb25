# SPDX-License-Identifier: MIT
"""Whether a piece of the robot meets one of the obstacles, at a place, at all rotations of a box: in integers.

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
from cells import lowest
from plan import Piece, cross, dot, need, sub


class Whole(Piece):
    """A convex polytope in integers: its planes in lowest terms, and edges (point, direction, facets beside)."""

    def __init__(self, points, facets):
        super().__init__(points, facets)
        shortest = [(lowest(n), facet[0]) for (n, _), facet in zip(self.planes, facets)]
        self.planes = [(n, dot(n, points[i])) for n, i in shortest]
        beside = {side: i for i, f in enumerate(facets) for side in zip(f, f[1:] + f[:1])}
        self.sides = [(points[a], sub(points[b], points[a]), (i, beside[b, a]))
                      for (a, b), i in beside.items() if a < b]


def form(p, q, v):
    """B(p, q)v = (p v q* + q v p*) / 2 for quaternions x, y, z, w."""
    a, b, s, t = p[:3], q[:3], p[3], q[3]
    of_b, of_a = dot(b, v), dot(a, v)
    mixed = [s * y + t * x for x, y in zip(a, b)]
    over, level = cross(mixed, v), s * t - dot(a, b)
    return tuple(level * v[k] + over[k] + of_b * a[k] + of_a * b[k] for k in range(3))


class Turned:
    """A piece of the robot over a box, whose pairs of corners are told as B(p, q), by rows, and p.q."""

    def __init__(self, piece, forms):
        self.piece, self.forms, self.known, self.most = piece, forms, {}, {}
        # half-spaces of -R(q)P: a place is in one where (a, b, c, d).(place, 1) >= 0
        self.planes = [[(*v, w * d) for v, (_, w) in zip(self.of(n), forms)] for n, d in piece.planes]
        # points to try: corners, their mean, middles of edges, for which coordinates are multiples of what divides
        self.within = piece.points + [tuple(sum(c) // len(piece.points) for c in zip(*piece.points))]
        self.within += [tuple(y + z // 2 for y, z in zip(a, way)) for a, way, _ in piece.sides]

    def of(self, v):
        """B(p, q)v for all pairs of corners."""
        if v not in self.known:
            self.known[v] = [(dot(a, v), dot(b, v), dot(c, v)) for (a, b, c), _ in self.forms]
        return self.known[v]

    def farthest(self, n, i):
        """The most of N.B(p, q)v / p.q for a point v, as numerator and denominator."""
        if (n, i) not in self.most:
            most, least = None, 1
            for v, (_, w) in zip(self.of(self.within[i]), self.forms):
                size = dot(n, v)
                if most is None or size * least > most * w:
                    most, least = size, w
            self.most[n, i] = most, least
        return self.most[n, i]


class Pair:
    """A piece of the robot and one of the obstacles over a box; an o for a point x is told as (m (x - o), m), m > 0."""

    def __init__(self, turned, obstacle):
        self.turned, self.robot, self.obstacle = turned, turned.piece, obstacle

    def stays(self, facet, i, x):
        """Whether a point of the robot is in the half-space of a facet of the obstacle throughout."""
        n, d = self.obstacle.planes[facet]
        most, least = self.turned.farthest(n, i)
        return (dot(n, x) - d) * least + most <= 0

    def covers(self, facet, o):
        """Whether o is in the half-space of a facet of the robot throughout."""
        (a, b, c), m = o
        return all(a * x + b * y + c * z + m * d >= 0 for x, y, z, d in self.turned.planes[facet])

    def crosses(self, e, f, o, p):
        """Whether N of two edges serves with o and p."""
        (way, m), of_f, of_p = o, self.turned.of(f), self.turned.of(cross(f, p))
        across = cross(way, e)
        return all(dot(a, across) + m * dot(e, b) <= 0 for a, b in zip(of_f, of_p))

    def ways(self, x):
        """An o for each corner of the obstacle, and those nearest to x of edges and facets."""
        yield from ((sub(x, o), 1) for o in self.obstacle.points)
        for a, way, _ in self.obstacle.sides:
            size, part = dot(way, way), dot(sub(x, a), way)
            if 0 < part < size:
                yield tuple(size * (y - z) - part * v for y, z, v in zip(x, a, way)), size
        for n, d in self.obstacle.planes:
            size, over = dot(n, n), dot(n, x) - d
            at = tuple(size * y - over * z for y, z in zip(x, n))  # the nearest point of the plane, times size
            if all(dot(m, at) <= size * most for m, most in self.obstacle.planes):
                yield tuple(over * z for z in n), size

    def check(self, x):
        """The pieces meet at x throughout."""
        points, ways = range(len(self.turned.within)), list(self.ways(x))[::-1]
        if any(all(self.covers(f, o) for f in range(len(self.robot.planes))) for o in ways):
            return
        for facets, some, holds in ((range(len(self.obstacle.planes)), points, lambda f, i: self.stays(f, i, x)),
                                    (range(len(self.robot.planes)), ways, self.covers)):
            need(all(any(holds(f, i) for i in some) for f in facets), "a sum has a point where pieces may be apart")
        open_e = [edge for edge in self.obstacle.sides
                  if not any(all(self.stays(f, i, x) for f in edge[2]) for i in points)]
        open_f = [edge for edge in self.robot.sides if not any(all(self.covers(f, o) for f in edge[2]) for o in ways)]
        for a, e, _ in open_e:
            for b, f, _ in open_f:
                tries = [((sub(x, a), 1), b)] + [(o, p) for o in ways for p in self.robot.points]
                for way in (e, sub((0, 0, 0), e)):
                    need(any(self.crosses(way, f, o, p) for o, p in tries), "a point of a sum is outside at an edge")
