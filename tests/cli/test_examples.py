#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the programs of examples/ print, held against what is worked out here from the bodies alone.

Usage: test_examples.py NAME PROGRAM [ARGUMENT...], where NAME is the example and a method of Examples.
"""
import itertools
import math
import pathlib
import random
import re
import subprocess
import sys
from fractions import Fraction


# ---- Bodies as points, rotations exactly ----------------------------------------------------------------------------


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def add(a, b, factor=1):
    return tuple(x + factor * y for x, y in zip(a, b))


def turned(quat, points):
    """The points turned by a quaternion of any length; exact for rational arguments."""
    x, y, z, w = quat
    n = x * x + y * y + z * z + w * w
    rows = ((w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z))
    return [tuple(dot(row, p) / n for row in rows) for p in points]


def box(*sizes):
    return list(itertools.product(*((-s / 2, s / 2) for s in sizes)))


def box_edges(*sizes):
    return [tuple(s if i == k else 0 for i in range(3)) for k, s in enumerate(sizes)]


def support(points, n):
    return max(dot(p, n) for p in points)


def normals(edges):
    """Both normals of each two edge directions that are not parallel: all facet normals of a sum are among them."""
    for a, b in itertools.combinations(edges, 2):
        n = cross(a, b)
        if any(n):
            yield n
            yield tuple(-c for c in n)


def slacks(p, q, edges, t):
    """For each normal n how far t is inside of D = Q + (-P) along it, times |n|; D is where none is negative."""
    minus_p = [tuple(-c for c in point) for point in p]
    return [(support(q, n) + support(minus_p, n) - dot(n, t), n) for n in normals(edges)]


def between_segments(a, b):
    """How far two segments, each of two points that differ, are apart at most where they are nearest."""
    u, v, w = add(a[1], a[0], -1), add(b[1], b[0], -1), add(a[0], b[0], -1)
    uu, uv, vv, uw, vw = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    area = uu * vv - uv * uv
    s = min(1, max(0, (uv * vw - vv * uw) / area)) if area > 1e-12 else 0
    t = min(1, max(0, (uv * s + vw) / vv))
    s = min(1, max(0, (uv * t - uw) / uu))
    return math.hypot(*add(add(w, u, s), v, -t))


def beside_box(point, sizes):
    """How far a point is from a box about the origin."""
    return math.hypot(*(max(0, abs(c) - s / 2) for c, s in zip(point, sizes)))


def beside_capsule(at, half, box_sides):
    """How far a segment along z, its middle and half of it, is from a box along the axes."""
    low, high = add(at, (0, 0, half), -1), add(at, (0, 0, half))
    return math.hypot(*(max(0, a - h, l - b) for (a, b), l, h in zip(box_sides, low, high)))


# ---- What the examples print ----------------------------------------------------------------------------------------


class Examples:
    def __init__(self, name, command):
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
        assert (done.returncode, done.stderr) == (0, ""), (done.returncode, done.stderr, done.stdout[-400:])
        self.arguments, self.command = command[1:], command
        self.lines = done.stdout.splitlines()
        getattr(self, name)()

    def again(self, *arguments):
        """The lines of another run, with these arguments."""
        return subprocess.run([*self.command, *arguments], capture_output=True, text=True, timeout=600,
                              check=True).stdout.splitlines()

    def rows(self, pattern, count):
        """The numbers of each line, all of which must match; so many lines."""
        found = [re.fullmatch(pattern, line) for line in self.lines]
        assert all(found) and len(found) == count, self.lines
        return [[float(number) for number in match.groups()] for match in found]

    def contacts(self):
        """A cube of edge 1 tilted about x is above the table, at z = 0.05, by its lowest edge."""
        heads = [line for line in self.lines if line.startswith("frame")]
        assert len(heads) == 8, self.lines
        for frame, line in enumerate(heads):
            told, distance, count = re.fullmatch(r"frame (\d): distance (\S+), (\d) contacts", line).groups()
            angle = 2 * 0.02 * (1 - frame / 7)
            true = 0.62 - 0.02 * frame - 0.05 - (math.cos(angle) + math.sin(angle)) / 2
            beyond = true > 0.05  # the cutoff; the far edge is higher by sin(angle)
            near = 0 if beyond else 2 if true + math.sin(angle) > 0.05 else 4
            assert int(told) == frame and abs(float(distance) - min(true, 0.05)) < 6e-5 and int(count) == near, line

    def exact(self):
        """The corners of a zonotope: each is a sum of two corners, and together they reach as far as all sums."""
        quat = [Fraction(c) for c in (1, 2, 3, 4)]
        cube, edges = box(*[Fraction(2)] * 3), box_edges(*[Fraction(2)] * 3)
        p = turned(quat, cube)
        told = [tuple(Fraction(c) for c in line.split()) for line in self.lines]
        sums = {add(a, b) for a in p for b in cube}
        every = list(normals(turned(quat, edges) + edges))
        assert len(set(told)) == len(told) and set(told) <= sums, told
        for n in every:
            assert support(told, n) == support(sums, n), n
        for corner in told:  # and none is between others: some direction has it alone for its farthest
            lean = [n for n in every if dot(n, corner) == support(told, n)]
            n = tuple(map(sum, zip(*lean)))
            assert [c for c in told if dot(c, n) == support(told, n)] == [corner], corner

    def track(self):
        """After a full turn the sum reaches as far as P and Q together, in every direction."""

        def points_of(path):
            tokens = re.sub(r"#[^\n]*", "", pathlib.Path(path).read_text(encoding="ascii")).split()[1:]
            return [tuple(map(float, tokens[i:i + 3])) for i in range(3, 3 + 3 * int(tokens[0]), 3)]

        p, q, told = map(points_of, self.arguments)
        match = re.fullmatch(r".*: (\d+) vertices, (\d+) facets", self.lines[-1])
        assert int(match[1]) == len(told) and len(self.lines) == 8, self.lines
        # Every frame has ee pairs; of so small steps few pairs change, which the counters show.
        for line in self.lines[1:-1]:
            frame, pairs, looked, repaired = map(float, line.split())
            assert pairs > 100 and 0 < repaired < pairs and 0 < looked < pairs, line
        seed = 20101
        numbers = random.Random(seed)
        for _ in range(200):
            n = [numbers.gauss(0, 1) for _ in range(3)]
            far = support(p, n) + support(q, n)
            assert abs(support(told, n) - far) < 1e-12 * (1 + abs(far)) * 100, (seed, n)

    def fall_and_rest(self):
        """A fall by Euler steps, in which the box never goes below the height that its lowest corner allows."""
        rows = self.rows(r"frame +(\d+): height (\S+), distance (\S+), (\d+) contacts", 13)
        height, speed = 2.0, 0.0
        for frame in range(49):
            half = 0.4 * (40 - frame) / 40 if frame < 40 else 0
            corners = turned((math.sin(half), math.sin(half), 0, math.sqrt(2) * math.cos(half)), box(1, 0.6, 0.4))
            lowest = 0.5 - min(corner[2] for corner in corners)
            if height < lowest:
                height, speed = lowest, 0.0
            if frame % 4 == 0:
                told = rows[frame // 4]
                # The answer's own contact always counts, others up to the margin.
                near = sum(height + c[2] - 0.5 <= max(0.01, height - lowest + 1e-9) for c in corners)
                assert told[0] == frame and abs(told[1] - height) < 2e-6 and abs(told[2] - height + lowest) < 2e-6, told
                assert told[3] == near, (told, near)
            speed -= 9.81 / 60
            height += speed / 60
        assert rows[-1][1] == 0.7 and rows[-1][3] == 4, rows[-1]

    def follow_normal(self):
        """The depth is the least slack over all candidates for a facet of the difference."""
        within = re.compile(r"frame +(\d+): depth (\S+), (\S+) from the axis, (\d+) of (\d+) edge pairs kept")
        left = re.compile(r"frame +(\d+): depth (\S+), outside the cone; the cone has (\S+)")
        golden = (1 + math.sqrt(5)) / 4
        body = [c for a, b in itertools.product((-0.5, 0.5), (-golden, golden))
                for c in ((0, a, b), (a, b, 0), (b, 0, a))]
        edges = [add(a, b, -1) for a, b in itertools.combinations(body, 2)
                 if abs(dot(add(a, b, -1), add(a, b, -1)) - 1) < 1e-9]
        assert len(edges) == 30
        edges = [e for i, e in enumerate(edges) if not any(max(map(abs, cross(e, f))) < 1e-9 for f in edges[:i])]
        seen = {within: 0, left: 0}
        for line in self.lines:
            form = within if within.fullmatch(line) else left
            frame, depth, *rest = map(float, form.fullmatch(line).groups())
            half = 0.01 * frame
            quat = (0.3 * math.sin(half), math.sin(half), 0.2 * math.sin(half), math.cos(half))
            t = (0.5 - 0.002 * frame, 0.3, 0.01 * frame)
            candidates = slacks(turned(quat, body), body, turned(quat, edges) + edges, t)
            least = min(slack / math.hypot(*n) for slack, n in candidates if math.hypot(*n) > 1e-9)
            assert abs(depth - least) < 2e-9, (line, least)
            if form is within:
                assert rest[0] < 0.5 and 0 < rest[1] < rest[2] / 2, line
            else:
                assert rest[0] > depth, line
            seen[form] += 1
        assert seen[within] >= 7 and seen[left] >= 1, self.lines

    def redraw(self):
        """A sum of boxes is a zonotope: its volume is the sum of the boxes that any three edges span."""
        rows = self.rows(r"frame +(\d+): volume (\S+), (\d+) facet slots, (\d+) rewritten so far", 7)
        for frame, volume, slots, rewritten in rows:
            half = 0.02 * frame
            axis = (0.6, 0.64, 0.48)
            quat = [c * math.sin(half) for c in axis] + [math.cos(half)]
            edges = turned(quat, box_edges(1, 2, 3)) + box_edges(2, 1, 1)
            true = sum(abs(dot(a, cross(b, c))) for a, b, c in itertools.combinations(edges, 3))
            assert abs(volume - true) < 1e-11, (frame, volume, true)
            # Six facets of each box are always there, and two facets for every two edges that make one.
            assert slots >= 30 and rewritten < 60 * slots / 4, (slots, rewritten)
        assert 0 < rows[-1][3], "the motion is long enough for pairs to change"

    def sum_of_three(self):
        """A zonotope's facets are counted by the planes that its edges span; a point is inside by its slack in each."""
        edges = []
        boxes = (((30, 30, 30), (0, 0, 0, 1)), ((15, 30, 45), (1, 2, 3, 4)), ((78, 39, 39), (2, 1, -3, 5)))
        for sizes, quat in boxes:
            edges += turned([Fraction(c) for c in quat], box_edges(*map(Fraction, sizes)))
        reduced = {}
        for n in normals(edges):
            scale = max(map(abs, n))
            reduced[tuple(c / scale for c in n)] = sum(abs(dot(n, e)) for e in edges) / 2 / scale  # its offset

        # A facet is a polygon of twice as many sides as it has edge directions; each side is on two facets.
        def directions(n):
            lie = [e for e in edges if dot(n, e) == 0]
            return len([e for i, e in enumerate(lie) if not any(cross(e, f) == (0, 0, 0) for f in lie[:i])])

        sides = sum(2 * directions(n) for n in reduced)
        counts = (2 + sides // 2 - len(reduced), sides // 2, len(reduced))
        assert self.lines[0] == "vertices %d, edges %d, facets %d" % counts, (self.lines[0], counts)
        said = set()
        for line in self.lines[1:]:
            *point, place = re.fullmatch(r"\((\S+), (\S+), (\S+)\) (\w+)", line).groups()
            point = [Fraction(float(c)) for c in point]
            slack = min(offset - dot(n, point) for n, offset in reduced.items())
            assert place == ("outside" if slack < 0 else "boundary" if slack == 0 else "inside"), (line, float(slack))
            said.add(place)
        assert len(self.lines) == 6 and said == {"outside", "boundary", "inside"}, self.lines

    def trajectory(self):
        """Every pose of the path is free: its distance from the post is worked out from corners and edges."""
        sizes = ((1.6, 0.2, 0.2), (0.4, 0.4, 4))
        sides = [[(a, b) for a, b in itertools.combinations(box(*s), 2) if sum(x != y for x, y in zip(a, b)) == 1]
                 for s in sizes]
        least = [float(re.fullmatch(r"step \d+: least distance (\S+)", line).group(1)) for line in self.lines[:5]]
        # at first the bar is in the post, from which it leaves sideways, past half of either less 0.125
        assert abs(least[0] + 0.2 + 0.1 - 0.125) < 1e-6 and 0.05 < least[-1] < 0.1, least
        self.lines = self.lines[5:]
        rows = self.rows(r"pose (\d+): (\S+) (\S+) (\S+) turned (\S+) (\S+) (\S+) (\S+)", 13)
        nearest = math.inf
        for number, *pose in rows:
            at, quat = tuple(pose[:3]), tuple(pose[3:])
            back = tuple(-c for c in quat[:3]) + quat[3:]
            p, q = turned(quat, box(*sizes[0])), box(*sizes[1])
            edges = turned(quat, box_edges(*sizes[0])) + box_edges(*sizes[1])
            assert min(slack for slack, n in slacks(p, q, edges, at) if math.hypot(*n) > 1e-9) < 0, pose
            corners = [beside_box(add(c, at), sizes[1]) for c in p]
            corners += [beside_box(c, sizes[0]) for c in turned(back, [add(c, at, -1) for c in q])]
            true = min(corners + [between_segments([add(c, at) for c in turned(quat, a)], b)
                                  for a in sides[0] for b in sides[1]])
            if number in (0, 12):
                assert quat == ((0, 0, 0.28, 0.96) if number else (0, 0, 0, 1)), (number, pose)
                assert at == (number / 4 - 1.5, 0.125, 0.0625), (number, pose)
            else:
                nearest = min(nearest, true)
        assert abs(nearest - least[-1]) < 1e-6, (nearest, least)

    def character(self):
        """A capsule on a course: how far it is from each block is worked out here, in every frame."""
        assert self.again("2") == self.lines, "another way with two threads"
        boxes = [((-20, 20), (-20, 40), (-1, 0)), ((3, 4), (9, 13), (-1, 3)), ((0, 3), (12, 13), (-1, 3)),
                 ((0, 5), (22, 23), (-1, 3))] + [((1.6 + 0.4 * i, 8), (-1, 1), (-1, 0.25 * i)) for i in range(1, 9)]
        planes = [((-math.sin(math.radians(80)), 0, math.cos(math.radians(80))), (3, 0, 0), (4, 7)),
                  ((-math.sqrt(0.5), math.sqrt(0.5), 0), (1, 18, 0), (18, 22)),
                  ((-math.sin(math.radians(35)), 0, math.cos(math.radians(35))), (2, 0, -4), (29, 31))]
        told, rows = {}, {}
        for line in self.lines:
            name, frame, *numbers = re.fullmatch(r"([a-z ]+) (nearest|\d+) (.*)", line).groups()
            numbers = [float(number) for number in numbers[0].split()]
            if frame == "nearest":
                told[name] = numbers[0]
            else:
                rows.setdefault(name, []).append((tuple(numbers[:3]), numbers[3] == 1))
        for name, frames in rows.items():
            least = math.inf
            for i, (at, _) in enumerate(frames):
                turn = min(i + 1, len(frames) - 1 - i) / 60  # how far a block has come
                lift = {"platform": (1.25 * turn, 0.5 * turn, 0.5 * turn)}.get(name, (0, 0, 0))
                ram = 1.5 * turn if name == "pushed" else 0
                moved = [tuple((a + d, b + d) for (a, b), d in zip(((-6, -4), (-6, -4), (0.25, 0.5)), lift)),
                         ((9 + ram, 10 + ram), (14, 17), (0.125, 2))]
                gaps = [beside_capsule(at, 0.6, block) for block in boxes + moved]
                gaps += [dot(add(at, foot, -1), n) - 0.6 * abs(n[2]) for n, foot, (low, high) in planes
                         if low <= at[1] <= high]
                least = min(least, min(gaps) - 0.3)
            assert least > 0.0005 and abs(least - told[name]) < 1e-6, (name, least, told[name])
        ends = {name: frames[-1][0] for name, frames in rows.items()}
        assert set(told) == set(ends) and len(ends) == 8 and all(frames[-1][1] for frames in rows.values()), ends
        assert ends["up stairs"][0] > 5 and 2.9 < ends["up stairs"][2] < 2.912, ends
        assert ends["down stairs"][0] < -0.5 and 0.9 < ends["down stairs"][2] < 0.912, ends
        assert ends["steep"][0] < 3 and 0.9 < ends["steep"][2] < 0.912, ends
        assert ends["slope"][2] > 3 and ends["pushed"][0] > 13.3, ends
        for name in ("steep", "corner", "narrow", "pushed"):
            assert max(math.dist(at, ends[name]) for at, _ in rows[name][-100:]) < 1e-9, (name, rows[name][-100:])
        ride = [at for at, _ in rows["platform"][20:]]
        for i, (a, b) in enumerate(zip(ride, ride[1:])):
            part = 1 if i + 21 < 120 else -1
            assert math.dist(add(b, a, -1), (part * 1.25 / 60, part * 0.5 / 60, part * 0.5 / 60)) < 1e-9, (i, a, b)

    def game(self):
        """One hash of all frames for each number of threads, and where no frame is taken back."""
        line, = self.lines
        form = r"hash [0-9a-f]{16}, (\d+) hits, (\d+) seen, (\d+) sensed, hero at (\S+) (\S+) (\S+)"
        numbers = re.fullmatch(form, line)
        hits, seen, sensed, *at = map(float, numbers.groups())
        assert hits > 10 and seen > 1000 and sensed > 10 and at[0] > 18 and at[2] > 0.9, line
        for arguments in (("2",), ("4",), ("3", "plain")):
            assert self.again(*arguments) == self.lines, arguments

    def first(self):
        """A cube on a corner's edge, turned by 45 degrees, sunk by an eighth: its lower corners."""
        half = math.sqrt(0.5)
        corners = {(0.25 + half, 0.5), (0.25 - half, 0.5), (0.25, 0.5 + half), (0.25, 0.5 - half)}
        assert self.lines[0] == "distance -0.125, out along 0 0 1"
        told = [tuple(map(float, line.split()[1:])) for line in self.lines[1:]]
        assert sorted((round(x, 3), round(y, 3)) for x, y in corners) == sorted((x, y) for x, y, _ in told)
        assert all(z == 0.125 for _, _, z in told)

    def two_bodies(self):
        """Boxes are as far apart as a corner from the other, or two edges; as deep as their least slack."""
        form = re.compile(r"frame +(\d+): (?:distance (\S+), normal (\S+) (\S+) (\S+), (\d+) contacts|farther.* 1.25)")
        sizes = ((1, 0.6, 0.4), (2, 2, 0.5))
        sides = [[(a, b) for a, b in itertools.combinations(box(*s), 2) if sum(x != y for x, y in zip(a, b)) == 1]
                 for s in sizes]
        seen = set()
        for line in self.lines[:-1]:
            frame, distance, *normal, contacts = form.fullmatch(line).groups()
            time = int(frame) / 60
            quat_p, at = (math.sin(time / 2), 0, 0, math.cos(time / 2)), (3 - 2 * time, 0.25, 0.6)
            quat_q = (0, 0, math.sin(time), math.cos(time))
            back = [(-q[0], -q[1], -q[2], q[3]) for q in (quat_p, quat_q)]
            p, q = turned(quat_p, box(*sizes[0])), turned(quat_q, box(*sizes[1]))
            edges = turned(quat_p, box_edges(*sizes[0])) + turned(quat_q, box_edges(*sizes[1]))
            true = -min(slack / math.hypot(*n) for slack, n in slacks(p, q, edges, at) if math.hypot(*n) > 1e-9)
            if true > 0:
                corners = [beside_box(c, sizes[1]) for c in turned(back[1], [add(c, at) for c in p])]
                corners += [beside_box(c, sizes[0]) for c in turned(back[0], [add(c, at, -1) for c in q])]
                true = min(corners + [between_segments([add(c, at) for c in turned(quat_p, a)], turned(quat_q, b))
                                      for a in sides[0] for b in sides[1]])
            if distance is None:
                assert true > 1.25, (line, true)
                seen.add("far")
                continue
            assert abs(float(distance) - true) < 2e-9, (line, true)
            assert (int(contacts) > 0) == (true <= 0.02), (line, true)  # the margin
            n = tuple(map(float, normal))  # along it the bodies are as far apart as that, so it proves the distance
            gap = dot(n, at) - support(q, n) - support([tuple(-c for c in corner) for corner in p], n)
            assert abs(gap - true) < 1e-8, (line, gap)
            seen.add("apart" if true > 0 else "overlapping")
        assert len(self.lines) == 22 and seen == {"far", "apart", "overlapping"}, self.lines
        counts = [int(number) for number in re.findall(r"\d+", self.lines[-1])]
        assert counts[0] == 201 and counts[1] > 0 and counts[2] > 0, counts

    def grid_of_states(self):
        """Every mark by the exact slack of its translation."""
        quat = [Fraction(c) for c in (0, 0, 1, 2)]
        p, q = (Fraction(5, 8), Fraction(5, 8), Fraction(1)), (Fraction(1), Fraction(1, 2), Fraction(1))
        minus_p = turned(quat, box(*p))  # a box is its own reflection
        edges = turned(quat, box_edges(*p)) + box_edges(*q)
        planes = {n: support(box(*q), n) + support(minus_p, n) for n in normals(edges)}
        assert len(self.lines) == 33, self.lines
        marks = set()
        for row, line in zip(range(32, -1, -1), self.lines):
            assert len(line) == 33, line
            for column, mark in enumerate(line):
                t = (Fraction(column - 16, 16), Fraction(row - 16, 16), Fraction(1, 4))
                slack = min(offset - dot(n, t) for n, offset in planes.items())
                assert mark == (".", "o", "#")[1 + (slack > 0) - (slack < 0)], (row, column, mark, float(slack))
                marks.add(mark)
        assert marks == set(".o#"), marks


if __name__ == "__main__":
    Examples(sys.argv[1], sys.argv[2:])
