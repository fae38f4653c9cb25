# SPDX-License-Identifier: MIT
"""Proofs by openings of planes, made in doubles, and the models that they are about.

Cells of planes are halved while they are neither blocked nor of one side, or touch a cell of the other side.
"""
from fractions import Fraction
from itertools import combinations, product
from math import cos, pi, sin

AXES = 3


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def texts(v):
    return [str(Fraction(x)) for x in v]


def prism(ring, low, high):
    """A piece over a convex polygon."""
    n = len(ring)
    points = [(*p, z) for z in (low, high) for p in ring]
    facets = [list(range(n))[::-1], list(range(n, 2 * n))]
    facets += [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return points, facets


def tetrahedron(size=1.0):
    e = size * 8 ** -0.5
    return [(e, e, e), (e, -e, -e), (-e, e, -e), (-e, -e, e)], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]


def block(x, y, z):
    return prism([(-x, -y), (x, -y), (x, y), (-x, y)], -z, z)


def round_window(diameter, corners, thickness=2 ** -10, half=2.0):
    """Pieces of a square plate round a hole of 8, 16, 24, ... corners, and the hole."""
    ring = [(diameter / 2 * cos(2 * pi * i / corners), diameter / 2 * sin(2 * pi * i / corners))
            for i in range(corners)]
    outer = []
    for i, (x, y) in enumerate(ring):
        far = half / max(abs(x), abs(y))
        p = [x * far, y * far]
        for k in range(2):
            if abs(abs(p[k]) - half) < 1e-9:
                p[k] = half if p[k] > 0 else -half
        outer.append(tuple(p))
    pieces = []
    for i in range(corners):
        k = (i + 1) % corners
        pieces.append(prism([ring[i], outer[i], outer[k], ring[k]], -thickness, thickness))
    return pieces, [{"centre": (0, 0, 0), "parts": [[(*p, 0) for p in ring]]}]


def grid_window(holes, unit, half, thickness=2 ** -10):
    """A plate of squares, some of which are left out: holes, each of some squares."""
    out = {square for hole in holes for square in hole}

    def corners(i, k):
        return [(unit * (i + x), unit * (k + y)) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    pieces = [prism(corners(i, k), -thickness, thickness)
              for i, k in product(range(-half, half), repeat=2) if (i, k) not in out]
    told = []
    for hole in holes:
        parts = [[(*p, 0) for p in corners(*square)] for square in hole]
        all_ = [p for part in parts for p in part]
        told.append({"centre": [(min(x) + max(x)) / 2 for x in zip(*all_)], "parts": parts})
    return pieces, told


def least_circle(points):
    """The square radius of the least circle round points of a plane, and up to three of them with weights."""
    best = (-1.0, None)
    for i, k in combinations(range(len(points)), 2):
        d = [x - y for x, y in zip(points[i], points[k])]
        best = max(best, (dot(d, d) / 4, ((i, 0.5), (k, 0.5))), key=lambda b: b[0])
    for some in combinations(range(len(points)), 3):
        a, b, c = (points[i] for i in some)
        squares = [sum((x - y) ** 2 for x, y in zip(p, q)) for p, q in ((b, c), (c, a), (a, b))]
        x, y, z = squares
        weights = [x * (y + z - x), y * (z + x - y), z * (x + y - z)]
        if min(weights) > 0:
            total = sum(weights)
            best = max(best, (x * y * z / total, tuple((i, w / total) for i, w in zip(some, weights))),
                       key=lambda b: b[0])
    return best


class Planes:
    """All planes that meet a piece, divided until those that fit a disc are on two sides that do not touch."""

    def __init__(self, points, square):
        self.points, self.square = points, square
        self.reach = Fraction(2 ** -10 * (int(1024 * max(sum(abs(x) for x in p) for p in points)) + 1))
        self.far, self.widest = float(self.reach), {}
        self.pairs = list(combinations(range(len(points)), 2))
        self.cells = [self.node(k, sign, (-1.0, 1.0) * 3) for k in range(AXES) for sign in (1, -1)]
        while True:
            meeting = self.meeting()
            if not meeting:
                break
            for cell in meeting:
                self.halve(cell)

    def normals(self, cell):
        k, sign, (a, b, c, d, _, _) = cell["axis"], cell["sign"], cell["box"]
        for x, y in product((a, b), (c, d)):
            n = [0.0] * 3
            n[k], n[(k + 1) % 3], n[(k + 2) % 3] = sign, x, y
            yield n

    def node(self, k, sign, box):
        """A cell, halved until it is blocked or of one side."""
        cell = {"axis": k, "sign": sign, "box": box}
        surface = (sign, sign) + box[:4]
        cell["world"] = surface[6 - 2 * k:] + surface[:6 - 2 * k] + box[4:]
        normals, low, high = list(self.normals(cell)), box[4] * self.far, box[5] * self.far
        heights = [[dot(n, p) for n in normals] for p in self.points]
        plus, minus = any(max(h) < low - 1e-9 for h in heights), any(min(h) > high + 1e-9 for h in heights)
        cell["blocked"] = self.blocked(cell, heights, low, high) if plus and minus else None
        if cell["blocked"]:
            cell["kind"] = "x"
        elif plus and minus:
            cell["kind"] = self.side(cell)
        else:
            cell["kind"] = "+" if plus else "-" if minus else None
        if cell["kind"] is None or max(b - a for a, b in zip(box[::2], box[1::2])) > 1:
            self.halve(cell)
        return cell

    def halve(self, cell):
        box = cell["box"]
        assert min(b - a for a, b in zip(box[::2], box[1::2])) > 2 ** -9, "no proof is found"
        i = max(range(3), key=lambda i: box[2 * i + 1] - box[2 * i])
        middle = (box[2 * i] + box[2 * i + 1]) / 2
        cell["kind"], cell["letter"] = None, str(i)
        cell["halves"] = [self.node(cell["axis"], cell["sign"], half) for half in
                          (box[:2 * i + 1] + (middle,) + box[2 * i + 2:], box[:2 * i] + (middle,) + box[2 * i + 1:])]

    def section(self, n, s):
        """Where a plane meets the segments between corners."""
        places = []
        for i, k in self.pairs:
            g, h = dot(n, self.points[i]), dot(n, self.points[k])
            if min(g, h) < s < max(g, h):
                places.append([x + (s - g) / (h - g) * (y - x) for x, y in zip(self.points[i], self.points[k])])
        return places

    def middle(self, cell):
        n = [sum(x) / 4 for x in zip(*self.normals(cell))]
        return n, (cell["box"][4] + cell["box"][5]) / 2 * self.far

    def side(self, cell):
        """Which side of the widest section of its direction."""
        n, s = self.middle(cell)
        if tuple(n) not in self.widest:
            heights = sorted(dot(n, p) for p in self.points)
            tried = [heights[0] + (heights[-1] - heights[0]) * i / 12 for i in range(1, 12)]
            self.widest[tuple(n)] = max(tried, key=lambda s: least_circle(self.section(n, s))[0])
        return "+" if s > self.widest[tuple(n)] else "-"

    def end(self, told):
        i, k, e = told
        return [x + 2.0 ** -e * (y - x) for x, y in zip(self.points[i], self.points[k])]

    def chords(self, heights, low, high):
        """Chords of corners that all planes of a cell cross, and short ones near corners that some meet."""
        under = [i for i, h in enumerate(heights) if max(h) < low - 1e-9]
        over = [i for i, h in enumerate(heights) if min(h) > high + 1e-9]
        for i, k in product(under, over):
            yield [i, i, 0], [k, k, 0]
        for m in set(range(len(heights))).difference(under, over):
            best = (0, None, None)
            for i, k in product(under, over):
                e = best[0]
                while e < 8 and all(a + (b - a) * 2.0 ** -(e + 1) < low - 1e-9 for a, b in zip(heights[m], heights[i])
                                    ) and all(a + (b - a) * 2.0 ** -(e + 1) > high + 1e-9
                                              for a, b in zip(heights[m], heights[k])):
                    e += 1
                if e > best[0]:
                    best = (e, i, k)
            if best[0]:
                yield [m, best[1], best[0]], [m, best[2], best[0]]

    def blocked(self, cell, heights, low, high):
        chords, places, (n, s) = list(self.chords(heights, low, high)), [], self.middle(cell)
        for a, b in ([self.end(end) for end in chord] for chord in chords):
            g, h = dot(n, a), dot(n, b)
            places.append([x + (s - g) / (h - g) * (y - x) for x, y in zip(a, b)])
        if len(places) < 2:
            return None
        told = [[max(1, round(1000 * w)), *chords[at]] for at, w in least_circle(places)[1]]
        return told if self.is_blocked(cell, told) else None

    def is_blocked(self, cell, told):
        total, parts = sum(w for w, _, _ in told), []
        for w, *ends in told:
            a, b = (self.end(end) for end in ends)
            crossed = []
            for n in self.normals(cell):
                g, h = dot(n, a), dot(n, b)
                for s in (cell["box"][4] * self.far, cell["box"][5] * self.far):
                    if not g < s - 1e-9 or not s + 1e-9 < h:
                        return False
                    crossed.append((s - g) / (h - g))
            way, l = [y - x for x, y in zip(a, b)], (min(crossed) + max(crossed)) / 2
            parts.append((w / total, [x + l * y for x, y in zip(a, way)], way, (max(crossed) - min(crossed)) / 2))
        mean = [sum(w * p[k] for w, p, _, _ in parts) for k in range(3)]
        least = sum(w * dot(p, p) for w, p, _, _ in parts) - dot(mean, mean)
        least -= sum(abs(2 * w * (dot(p, way) - dot(mean, way))) * wide for w, p, way, wide in parts)
        return least > self.square * (1 + 1e-9)

    def meeting(self):
        """The cells of both sides that touch one of the other side."""
        def kinds(cell):
            cell["kinds"] = {cell["kind"]}.union(*(kinds(half) for half in cell.get("halves", [])))
            return cell["kinds"]
        for cell in self.cells:
            kinds(cell)
        todo, found = list(product(self.cells, repeat=2)), {}
        while todo:
            a, b = todo.pop()
            if "+" not in a["kinds"] or "-" not in b["kinds"] or not touch(a, b):
                continue
            if "halves" not in a and "halves" not in b:
                found.update({id(a): a, id(b): b})
            else:
                todo += product(a.get("halves", [a]), b.get("halves", [b]))
        return list(found.values())

    def told(self):
        """The charts."""
        charts = []
        for cell in self.cells:
            todo, text, blocked = [cell], "", []
            while todo:
                node = todo.pop()
                text += node.get("letter") or node["kind"]
                todo += node.get("halves", [])[::-1]
                blocked += [node["blocked"]] if node["kind"] == "x" else []
            charts.append({"axis": cell["axis"], "sign": cell["sign"], "tree": text, "blocked": blocked})
        return charts


def touch(a, b):
    p, q = a["world"], b["world"]
    return all(p[i] <= q[i + 1] and q[i] <= p[i + 1] for i in range(0, 8, 2))


def proof(piece, window, turn=(0.0, 0.0, 0.0, 1.0), tilt=0.0):
    """That a piece does not go through a window in the plane z = -tilt x, told as a checker takes it."""
    pieces, holes = window
    holes = [{"centre": (*hole["centre"][:2], -tilt * hole["centre"][0]),
              "parts": [[(p[0], p[1], -tilt * p[0]) for p in part] for part in hole["parts"]]} for hole in holes]
    square = max((sum((x - c) ** 2 for x, c in zip(p, hole["centre"])) for hole in holes for part in hole["parts"]
                  for p in part), default=0)
    charts, reach = [], Fraction(1)
    if holes and piece:
        planes = Planes(piece[0], square)
        charts, reach = planes.told(), planes.reach

    def bodies(some):
        return [{"body": 0, "points": [texts(p) for p in points], "facets": facets} for points, facets in some]
    return {"openings": 1, "low": texts((-1, -1, -2)), "high": texts((1, 1, 2)), "from": texts((0, 0, -1.5)),
            "to": texts((0, 0, 1.5)), "from_rotation": texts(turn), "to_rotation": texts((0, 0, 0, 1)),
            "robot": bodies([piece] if piece else []), "obstacles": bodies(pieces),
            "piece": 0, "point": texts((0, 0, 0)),
            "plane": texts((tilt, 0, 1, 0)), "reach": str(reach), "charts": charts,
            "holes": [{"centre": texts(hole["centre"]), "parts": [[texts(p) for p in part] for part in hole["parts"]]}
                      for hole in holes]}
