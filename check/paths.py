# SPDX-License-Identifier: MIT
"""Paths of any motion, or by translations and turns about one axis, held against pieces in integers.

motions.py and turns.py hand files to it that have a path. The pieces there are taken as the bodies, which are closed.
It stands on plan.py beside it.

The argument: between two poses the origin goes straight and evenly, and the robot turns evenly about one axis, by the
lesser angle. That is halved until, for each piece of the robot and each of the obstacles, a plane has the obstacle's on
one side, and the robot's at both ends of the interval on the other, by more than what the robot does between: a point
that turns by an angle t is off the line between its places by less than t^2/8 of its distance r from the origin. With c
the distance of the unit quaternions of both ends, up to sqrt 2, t <= 4 asin(c/2) <= 2.222 c, so t^2/8 < 5/8 c^2.

Numbers: coordinates are integers of 2^-UNIT of the largest one, quaternions of ONE. Each rounding of a coordinate is by
at most 1: of the corners of both, of a turned one, of a translation, where each halving adds 1/2. A unit quaternion is
off by 2^-58 for each halving, which at most pi/2 of it reach the next ones: by less than 2^-52 after 30, so a place is
by less than 2^-50 r. Planes are looked for in doubles, and held in integers.
"""
from fractions import Fraction
from itertools import product
from math import cos, isqrt, sin

from plan import Refused, cross, dot, need, sub, vector

ONE, UNIT, FINE = 1 << 60, 60, 1 << 20
DEEPEST = 30
MOST_PLANES = 10 ** 6
ROUNDED = 64  # more than the length of all roundings of a point of each body


def turned(q, v):
    """R v for an integer quaternion and vector, each coordinate rounded down."""
    w, u = q[3], q[:3]
    n, t = dot(u, u) + w * w, cross(u, v)
    s = cross(u, t)
    return tuple(v[k] + 2 * (w * t[k] + s[k]) // n for k in range(3))


def unit(q):
    """A quaternion of numbers as the nearest one of length ONE, of integers."""
    n = isqrt(sum(x * x for x in q))
    need(n > 0, "a quaternion is zero")
    return tuple((2 * x * ONE + n) // (2 * n) for x in q)


class Interval:
    """A motion between two poses: (quaternion, translation)."""

    def __init__(self, a, b):
        self.ends = a, b

    def halves(self):
        (q, x), (r, y) = self.ends
        middle = unit([s + t for s, t in zip(q, r)]), tuple((s + t) // 2 for s, t in zip(x, y))
        return Interval(self.ends[0], middle), Interval(middle, self.ends[1])

    def slack(self, reach):
        """How much farther than at both ends a point at a distance from the origin can be."""
        way = sum((s - t) ** 2 for s, t in zip(self.ends[0][0], self.ends[1][0]))
        return reach * 5 * way // (8 * ONE * ONE) + (reach >> 48) + ROUNDED

    def places(self, points):
        return [tuple(s + t for s, t in zip(turned(q, p), x)) for q, x in self.ends for p in points]


def directions(robot, obstacle):
    """Normals that may part two sets of corners of convex pieces: of facets, and of pairs of edges, in doubles."""
    (points, facets, edges), (others, faces, sides) = robot, obstacle
    for corners, some in ((points, facets), (others, faces)):
        for a, b, c in some:
            yield cross(sub(corners[b], corners[a]), sub(corners[c], corners[a]))
    for (a, b), (c, d) in product(edges, sides):
        yield cross(sub(points[b], points[a]), sub(others[d], others[c]))


class Body:
    """A piece: its corners, three corners of each facet, and its edges."""

    def __init__(self, points, facets):
        self.points, self.facets = points, [f[:3] for f in facets]
        self.edges = {tuple(sorted(side)) for f in facets for side in zip(f, f[1:] + f[:1])}
        self.reach = isqrt(max(dot(p, p) for p in points)) + 1


def gap(n, places, points):
    """How far a set of points is before another one along a normal, times its length."""
    return min(dot(n, p) for p in places) - max(dot(n, p) for p in points)


class Paths:
    def __init__(self, told):
        need(1 in (told.get("motions"), told.get("turns")), "not a path of version 1")
        self.low, self.high = vector(told["low"]), vector(told["high"])
        bodies = [[([vector(p) for p in piece["points"]], piece["facets"]) for piece in told[name]]
                  for name in ("robot", "obstacles")]
        self.ends, self.path = self.poses(told) if "turns" in told else (
            [(vector(told[name]), vector(told[name + "_rotation"], 4)) for name in ("from", "to")],
            [(vector(pose["at"]), vector(pose["quat"], 4)) for pose in told["path"]])
        need(len(self.path) > 1, "a path has two poses at least")
        most = max(abs(x) for v in [p for body in bodies for points, _ in body for p in points] +
                   [at for at, _ in self.path] for x in v)
        self.scale = (1 << UNIT) / most
        self.robot, self.obstacles = ([Body([self.rounded(p) for p in points], facets) for points, facets in body]
                                      for body in bodies)
        for body in self.robot + self.obstacles:
            need(all(0 <= i < len(body.points) for f in body.facets for i in f), "no such corner")
        self.normals, self.planes = {}, 0

    @staticmethod
    def poses(told):
        """Ends and path of turns about an axis: at each place the robot turns to an angle of the next step, and goes
        there. Which angle of those that the step has does not matter, for all of the way is looked at."""
        def about(s, c):
            return tuple(s * x for x in axis) + (c,)
        axis = vector(told["axis"])
        ends = [(vector(told[name]), about(*vector(told[name + "_turn"], 2))) for name in ("from", "to")]
        path = ends[:1]
        for step in told["path"]:
            half = sum(step["radians"]) / 4
            turn = about(Fraction(sin(half)), Fraction(cos(half)))
            path += [(path[-1][0], turn), (vector(step["at"]), turn)]
        return ends, path + [(path[-1][0], ends[1][1])]

    def rounded(self, v):
        return tuple(int(x * self.scale // 1) for x in v)

    def check_ends(self):
        for pose, end, name in zip((self.path[0], self.path[-1]), self.ends, ("begin", "end")):
            same = all(a * d == b * c for (a, c), (b, d) in product(zip(pose[1], end[1]), repeat=2))
            need(pose[0] == end[0] and any(end[1]) and same, f"the path does not {name} where it is asked to")
        for at, _ in self.path:
            need(all(a <= x <= b for a, x, b in zip(self.low, at, self.high)), "the path leaves the bounds")

    def parts(self, n, places, pair, slack):
        """Whether a normal parts what a piece of the robot does from one of the obstacles, in integers."""
        return gap(n, places, self.obstacles[pair[1]].points) > (isqrt(dot(n, n)) + 1) * slack

    def is_apart(self, interval, places, pair):
        """Whether a plane is found that parts two pieces throughout an interval."""
        slack = interval.slack(self.robot[pair[0]].reach)
        self.planes += 1
        if pair in self.normals and self.parts(self.normals[pair], places, pair, slack):
            return True
        robot, obstacle = self.robot[pair[0]], self.obstacles[pair[1]]
        near, far = ([tuple(map(float, p)) for p in some] for some in (places, obstacle.points))
        half, found = len(robot.points), (0.0, None)
        told = (near[:half], robot.facets, robot.edges), (far, obstacle.facets, obstacle.edges)
        for n in directions(*told):
            length = sum(x * x for x in n) ** 0.5
            for sign in (1, -1) if length > 0 else ():
                own = tuple(sign * x / length for x in n)
                least = gap(own, near, far)
                found = (least, own) if least > found[0] else found
        if found[1] is None or found[0] < slack:
            return False
        self.normals[pair] = tuple(round(FINE * x) for x in found[1])
        return self.parts(self.normals[pair], places, pair, slack)

    def check_motion(self, index, interval, pairs, depth=0):
        need(depth <= DEEPEST and self.planes <= MOST_PLANES,
             f"motion {index}: pieces {pairs[0]} are not shown to be apart")
        places, left = {}, []
        for pair in pairs:
            if pair[0] not in places:
                places[pair[0]] = interval.places(self.robot[pair[0]].points)
            if not self.is_apart(interval, places[pair[0]], pair):
                left.append(pair)
        for half in interval.halves() if left else ():
            self.check_motion(index, half, left, depth + 1)

    def check(self):
        self.check_ends()
        pairs = list(product(range(len(self.robot)), range(len(self.obstacles))))
        for i, ((x, q), (y, r)) in enumerate(zip(self.path, self.path[1:])):
            a, b = (unit([int(c * (1 << 1100)) for c in turn]) for turn in (q, r))
            along = dot(a, b) + a[3] * b[3]
            # a turn by half a circle may go either way
            ways = (1, -1) if abs(along) <= ONE else (1,) if along > 0 else (-1,)
            for sign in ways:
                try:
                    end = tuple(sign * c for c in b), self.rounded(y)
                    self.check_motion(i, Interval((a, self.rounded(x)), end), pairs)
                    break
                except Refused:
                    if sign == ways[-1]:
                        raise
        return f"a path of {len(self.path) - 1} motions, by {self.planes} planes"
