#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Certificates of sums of solids, and lies: test_solid_sum.py COMMAND.

The checker accepts each one that the command writes, of bodies of cells, straight, skewed or with corners moved. Random
points are held against an oracle of its own: a point is in the sum where it is in that of two cells, which is bounded
by planes along two edges each. Lies are refused; a change at random may be accepted where the mesh stays as it was and
the oracle finds nothing: then the box or the pieces are divided in another way.

PIR_TEST_CASES says how many random pairs (6), PIR_TEST_TAMPERED how many random changes (30).
"""
import copy
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
from fractions import Fraction
from itertools import combinations, product

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "check"))
import plan  # noqa: E402  (beside the checker)
import solid_sum  # noqa: E402  (the checker, beside the project's sources)

REFUSALS = (ValueError, LookupError, TypeError, AttributeError, ZeroDivisionError)
FOLDER = pathlib.Path(tempfile.mkdtemp())
COMMAND = sys.argv[1]
ROTATIONS = ("0,0,0,1", "0,0,1,2", "1,2,3,4", "0,1,0,3", "1,1,1,1", "0.3,-0.1,0.7,0.2")
SHAPES = {
    "cube": [(0, 0, 0)],
    "l": [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
    "u": [(0, 0, 0), (0, 1, 0), (0, 2, 0), (1, 0, 0), (1, 2, 0)],
    "frame": [c for c in product(range(3), range(3), [0]) if c[:2] != (1, 1)],
    "notched": [c for c in product(range(2), repeat=3) if c != (1, 1, 1)],
    "hollow": [c for c in product(range(3), repeat=3) if c != (1, 1, 1)],
    "edge": [(0, 0, 0), (1, 1, 0)],
    "corner": [(0, 0, 0), (1, 1, 1)],
    "cup": [c for c in product(range(3), repeat=3) if c not in ((1, 1, 1), (1, 1, 2))],
}
SQUARES = {(axis, end): [c for c in product(range(2), repeat=3) if c[axis] == end]
           for axis, end in product(range(3), range(2))}


def determinant(rows):
    return plan.dot(rows[0], plan.cross(rows[1], rows[2]))


class Body:
    """Cells of a grid, scaled and skewed by a matrix of dyadic numbers; perhaps with corners moved, then triangles."""

    def __init__(self, cells, matrix=None, moved=None, name="body"):
        self.cells, self.matrix = sorted(cells), matrix or [[int(i == k) for i in range(3)] for k in range(3)]
        self.moved, self.path = moved or {}, FOLDER / f"{name}.off"
        numbers, facets = {}, []
        for cell in self.cells:
            for (axis, end), corners in SQUARES.items():
                beside = tuple(x + (2 * end - 1) * (k == axis) for k, x in enumerate(cell))
                if beside in self.cells:
                    continue
                a, b, c, d = (numbers.setdefault(tuple(map(sum, zip(cell, v))), len(numbers)) for v in corners)
                loop = [a, c, d, b] if (axis != 1) == (end == 1) else [a, b, d, c]
                loop = loop if determinant(self.matrix) > 0 else loop[::-1]
                facets += [loop[:3], [loop[0], *loop[2:]]] if self.moved else [loop]
        points = "".join(" ".join(str(float(x)) for x in self.place(p)) + "\n" for p in numbers)
        loops = "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in facets)
        self.path.write_text(f"OFF\n{len(numbers)} {len(facets)} 0\n{points}{loops}", encoding="ascii")

    def place(self, point):
        moved = [x + y for x, y in zip(point, self.moved.get(tuple(point), (0, 0, 0)))]
        return [sum(Fraction(m) * x for m, x in zip(row, moved)) for row in self.matrix]


def random_body(rng, name):
    if rng.random() < .5:
        cells = SHAPES[rng.choice(list(SHAPES))]
    else:
        cells, most = {(1, 1, 1)}, rng.randint(2, 5)
        while len(cells) < most:
            near = list(rng.choice(sorted(cells)))
            near[rng.randrange(3)] += rng.choice((-1, 1))
            cells.add(tuple(near))
    kind, matrix, moved = rng.randrange(4), None, None
    if kind > 0:
        while not matrix or determinant(matrix) == 0:
            matrix = [[(rng.randint(1, 12) if i == k else kind > 1 and rng.randint(-3, 3)) / 8 for i in range(3)]
                      for k in range(3)]
    if kind == 3 and len(cells) < 4:
        corners = {tuple(map(sum, zip(c, v))) for c in cells for v in product((0, 1), repeat=3)}
        moved = {p: [rng.randint(-9, 9) / 64 for _ in range(3)] for p in corners}
    return Body(cells, matrix, moved, name)


# --- the oracle ---

def rotated(q, v):
    """By the matrix of a quaternion."""
    x, y, z, w = q
    rows = [[w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z]]
    return [sum(a * b for a, b in zip(row, v)) / (x * x + y * y + z * z + w * w) for row in rows]


class Oracle:
    def __init__(self, p, q, quat, difference):
        sign = -1 if difference else 1
        edges = [[sign * x for x in rotated(quat, [row[k] for row in map(list, p.matrix)])] for k in range(3)]
        edges += [[Fraction(row[k]) for row in q.matrix] for k in range(3)]
        self.slabs = []
        for a, b in combinations(edges, 2):
            n = plan.cross(a, b)
            if any(n):
                self.slabs.append((n, sum(abs(plan.dot(n, e)) for e in edges) / 2))
        half = Fraction(1, 2)
        centres = [[body.place([x + half for x in cell]) for cell in body.cells] for body in (p, q)]
        self.centres = [[sign * x + y for x, y in zip(rotated(quat, a), b)] for a in centres[0] for b in centres[1]]

    def side(self, point):
        """Above 0 inside, 0 on the boundary of a cell's sum, below 0 outside."""
        return max(min(width - abs(plan.dot(n, plan.sub(point, c))) for n, width in self.slabs) for c in self.centres)


def mesh_of(told):
    model, points = object.__new__(plan.Model), [plan.vector(p) for p in told["vertices"]]
    model.path, model.facets = "mesh", [[points[i] for i in f] for f in told["facets"]]
    return model


def differs(told, p, q, rng, count):
    """A random point that the mesh and the oracle tell apart, or none."""
    oracle, model = Oracle(p, q, plan.vector(told["quat"], 4), told["claim"] == "difference"), mesh_of(told)
    low, high = plan.vector(told["low"]), plan.vector(told["high"])
    for _ in range(count):
        point = tuple(a + (b - a) * Fraction(rng.randint(1, 9999), 10007) for a, b in zip(low, high))
        side = oracle.side(point)
        if side and model.has(point) != (side > 0):
            return point
    return None


# --- lies ---

def counted(told):
    walked = [list(zip(f, f[1:] + f[:1])) for f in told["facets"]]
    used = sorted({i for f in told["facets"] for i in f})
    told["vertices"] = [told["vertices"][i] for i in used]
    told["facets"] = [[used.index(i) for i in f] for f in told["facets"]]
    told["vertex_count"], told["facet_count"] = len(used), len(walked)
    told["edge_count"] = len({frozenset(side) for own in walked for side in own if side[::-1] not in own})
    return told


def add_tetrahedron(told, middle, size, turns):
    """Surfaces of a small body, the right way round or inside out."""
    first = len(told["vertices"])
    corners = [middle, *([x + size * (i == k) for i, x in enumerate(middle)] for k in range(3))]
    told["vertices"] += [[str(x) for x in p] for p in corners]
    for f in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)):
        told["facets"].append([first + i for i in f[::turns]])
    return counted(told)


def components(told):
    parts = []
    for f in told["facets"]:
        near = [part for part in parts if set(f) & part[0]]
        parts = [part for part in parts if not set(f) & part[0]]
        parts.append((set(f).union(*(part[0] for part in near)), [g for part in near for g in part[1]] + [f]))
    return [part[1] for part in parts]


def middle_of(told, word):
    """The middle of a part of this word, and its number."""
    checker = solid_sum.SolidSum(told)
    tree, todo = told["tree"], [(0, checker.box)]
    while todo:
        node, cell = todo.pop()
        if tree[node][0] == "split":
            todo += zip(tree[node][2:], cell.split(plan.half_space(tree[node][1])))
        elif tree[node][0] == word:
            corners = [[Fraction(x, v[3]) for x in v[:3]] for v, _ in cell.vertices]
            return [sum(c) / len(corners) for c in zip(*corners)]
    return None


def pushed(told, way):
    """A facet pushed in or out: a point off it instead of its middle."""
    k = next(k for k, f in enumerate(told["facets"]) if len(f) == len(set(f)))
    facet = told["facets"].pop(k)
    points = [plan.vector(told["vertices"][i]) for i in facet]
    n = plan.cross(plan.sub(points[1], points[0]), plan.sub(points[2], points[1]))
    apex = [sum(c) / 3 + way * x / 10 ** 6 for c, x in zip(zip(*points[:3]), n)]
    told["vertices"].append([str(x) for x in apex])
    told["facets"] += [[a, b, len(told["vertices"]) - 1] for a, b in zip(facet, facet[1:] + facet[:1])]
    return counted(told)


def with_facets(told, facets):
    return counted({**told, "facets": facets})


def other_nodes(told, rng, lie):
    """A part told to be another."""
    tree = told["tree"]
    word = {"blocked is free": "blocked", "free is blocked": "free", "no such pair": "blocked"}.get(lie, "split")
    node = rng.choice([i for i, part in enumerate(tree) if part[0] == word])
    if word == "split":
        tree[node] = tree[tree[node][2]] if lie == "a part left out" else tree[node][:2] + tree[node][:1:-1]
    else:
        tree[node] = {"blocked is free": ["free"], "no such pair": ["blocked", 0, len(told["q"])],
                      "free is blocked": ["blocked", 0, 0]}[lie]
    return told


def lies(told, rng):
    """Names and files that say something false, or prove nothing."""
    def fresh():
        return copy.deepcopy(told)
    facets = told["facets"]
    yield "missing facet", with_facets(fresh(), facets[1:])
    yield "a facet twice", with_facets(fresh(), facets + facets[:1])
    yield "a facet the other way", with_facets(fresh(), [facets[0][::-1]] + facets[1:])
    yield "inside out", with_facets(fresh(), [f[::-1] for f in facets])
    yield "all twice", with_facets(fresh(), facets + facets)
    yield "a fin", with_facets(fresh(), facets + [facets[0][:3], facets[0][2::-1]])
    yield "no mesh", with_facets(fresh(), [])
    yield "pushed in", pushed(fresh(), -1)
    yield "pushed out", pushed(fresh(), 1)
    small = Fraction(1, 10 ** 6)
    yield "a cavity", add_tetrahedron(fresh(), middle_of(told, "blocked"), small, -1)
    yield "a body within", add_tetrahedron(fresh(), middle_of(told, "blocked"), small, 1)
    yield "a body outside", add_tetrahedron(fresh(), middle_of(told, "free"), small, 1)
    yield "a body beyond the box", add_tetrahedron(fresh(), [Fraction(1000)] * 3, small, 1)
    parts = components(told)
    for k in range(len(parts) if len(parts) > 1 else 0):
        yield "a surface left out", with_facets(fresh(), [f for part in parts[:k] + parts[k + 1:] for f in part])
    for lie in ("blocked is free", "free is blocked", "no such pair", "sides of a plane", "a part left out"):
        yield lie, other_nodes(fresh(), rng, lie)
    for key in ("vertex_count", "edge_count", "facet_count"):
        yield key, {**told, key: told[key] + 1}
    yield "small box", {**told, "low": told["p"][0]["points"][0], "high": told["high"]}
    for side in ("p", "q"):
        yield "no pieces", {**told, side: []}
        yield "a piece left out", {**told, side: told[side][1:]}
        yield "a piece twice", {**told, side: told[side] + told[side][:1]}
    for i in range(3):
        changed = fresh()
        v = rng.randrange(len(told["vertices"]))
        changed["vertices"][v][i] = str(Fraction(changed["vertices"][v][i]) + Fraction(1, 10 ** 9))
        yield "moved vertex", changed


def changed_text(text, rng):
    """One digit, sign or line changed."""
    kind = rng.randrange(3)
    if kind == 0:
        at = rng.choice([m.start() for m in re.finditer(r"\d", text)])
        return text[:at] + rng.choice([d for d in "0123456789" if d != text[at]]) + text[at + 1:]
    if kind == 1:
        at = rng.choice([m.start() for m in re.finditer(r'"-?\d', text)]) + 1
        return text[:at] + text[at + 1:] if text[at] == "-" else text[:at] + "-" + text[at:]
    lines = text.split("\n")
    at = rng.randrange(1, len(lines) - 3)
    return "\n".join(lines[:at] + lines[at + 1 + (rng.random() < .1):])


# --- the test ---

def written(p, q, rotation, difference):
    path = FOLDER / "certificate.json"
    done = subprocess.run([COMMAND, "sum", p.path, q.path, "--solid", f"--quat={rotation}", "--certificate", path,
                           *(["--difference"] if difference else [])], capture_output=True, text=True)
    assert done.returncode == 0, (p.path.read_text(), q.path.read_text(), rotation, done.stderr)
    return path.read_text(encoding="ascii")


def verdict(told, models):
    """What is proven, or none."""
    try:
        return solid_sum.SolidSum(told).check(models)
    except REFUSALS:
        return None


class Run:
    def __init__(self):
        self.accepted = self.refused = self.true = self.bytes = 0
        self.wrong = []

    def accept(self, p, q, rotation, difference, rng):
        text = written(p, q, rotation, difference)
        told, self.bytes = json.loads(text), max(self.bytes, len(text))
        try:
            solid_sum.SolidSum(told).check((p.path, q.path))
            self.accepted += 1
        except REFUSALS as error:
            self.wrong.append(("refused", error, p.path.read_text(), q.path.read_text(), rotation, difference))
        if not p.moved and not q.moved and differs(told, p, q, rng, 12):
            self.wrong.append(("oracle", p.path.read_text(), q.path.read_text(), rotation, difference))
        return text

    def refuse(self, name, told, models):
        if verdict(told, models):
            self.wrong.append(("accepted", name))
        self.refused += 1

    def change(self, text, p, q, rng):
        changed = changed_text(text, rng)
        before = json.loads(text)
        try:
            told = json.loads(changed)
            proven = verdict(told, (p.path, q.path))
        except ValueError:
            proven = None
        if not proven:
            self.refused += 1
        elif mesh_of(told).facets != mesh_of(before).facets or differs(told, p, q, rng, 40):
            lines = zip(text.split("\n"), changed.split("\n"))
            self.wrong.append(("accepted", next((a, b) for a, b in lines if a != b)))
        else:
            self.true += 1


def main():
    run, cases = Run(), int(os.environ.get("PIR_TEST_CASES", "6"))
    tampered = int(os.environ.get("PIR_TEST_TAMPERED", "30"))
    for number in range(cases):
        rng = random.Random(f"sums of solids {number}")
        p, q = random_body(rng, "p"), random_body(rng, "q")
        run.accept(p, q, rng.choice(ROTATIONS), rng.random() < .3, rng)
    rng = random.Random("lies about sums of solids")
    half = [[Fraction(int(i == k), 2) for i in range(3)] for k in range(3)]
    told = []
    for a, b, rotation in (("l", "u", "0,0,1,2"), ("hollow", "cube", "0,0,0,1"), ("frame", "cube", "0,0,0,1"),
                           ("l", "edge", "0,0,0,1")):
        p, q = Body(SHAPES[a], name=f"{a}_p"), Body(SHAPES[b], half, name=f"{b}_q")
        text = run.accept(p, q, rotation, False, rng)
        told.append((text, p, q))
        models, data = (p.path, q.path), json.loads(text)
        for name, lie in lies(data, rng) if a != "frame" else ():
            if name != "a piece left out" or len(data["p"]) > 1 and len(data["q"]) > 1:
                run.refuse(f"{name}: {a}, {b}", lie, models if "piece" in name else ())
        for other in ((q.path, p.path), (p.path, Body(SHAPES["notched"], name="other").path), (p.path,)):
            run.refuse(f"other models: {a}, {b}", data, other)
    for number in range(tampered):
        run.change(*told[number % len(told)], random.Random(f"change {number}"))
    print(f"accepted {run.accepted}, of {run.bytes} bytes at most; refused {run.refused}; changed and true {run.true}")
    for wrong in run.wrong[:5]:
        print(*wrong)
    return 1 if run.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
