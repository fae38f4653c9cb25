#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes models to plan with, in OFF, or OBJ where one is of several solids: make_models.py FOLDER.

- window-24-9020.off and so on, a plate with a round hole of 24 or 96 corners and diameter .9020 or .9010, and
  tetrahedron.off, regular, of edge 1: it goes through by translations from diameter .901388 on (Halperin, Sharir,
  Yehuda, arXiv 2102.04262), turned as WINDOW_TURN says;
- plate.off, with a square hole, and pegs: peg-tight.off fits exactly, peg-loose.off with room, peg-large.off not;
- trap.off, a box whose entrance reaches into it, and bug.off, which finds out, bug-large.off, which does not;
- burr-S-1.off to burr-S-6.off, the pieces of a burr puzzle of seed S, assembled: piece 1 of seeds 1 to 3 is a key, a
  whole bar; seed 4 has none;
- alpha-30.obj, alpha-50.obj and alpha-74.obj, a tube of radius .030 and so on, bent to the letter alpha, in prisms that
  overlap where it bends. Two of them hang in each other at ALPHA_LINKED. Where a tube crosses itself, .300 less two
  radii are free: a tube of .074 has .152 there, to be passed by one of .148.
"""
import math
import pathlib
import random
import sys

# The turn in which the tetrahedron goes through the smallest window along z: a quaternion x, y, z, w.
WINDOW_TURN = (0, 0.20354053471956063, 0, 0.9790665200720916)

# Where one alpha hangs in the other, turned by half a turn: x, y, z, and a quaternion.
ALPHA_LINKED = (-1.5, 0, 0, 0, 1, 1, 0)


def off(points, facets):
    lines = ["OFF", f"{len(points)} {len(facets)} 0"]
    lines += [" ".join(repr(x) for x in p) for p in points]
    lines += [" ".join(str(i) for i in (len(f), *f)) for f in facets]
    return "\n".join(lines) + "\n"


def cubes(places):
    """The solid of unit cubes, each by its least corner."""
    places, number, facets = set(places), {}, []
    for place in sorted(places):
        for k in range(3):
            for up in range(2):
                beside = [place[j] + (2 * up - 1) * (j == k) for j in range(3)]
                if tuple(beside) in places:
                    continue
                facet = []
                for i in range(4):
                    turn, corner = (i if up else 3 - i), [0, 0, 0]
                    corner[k] = place[k] + up
                    corner[(k + 1) % 3] = place[(k + 1) % 3] + (turn in (1, 2))
                    corner[(k + 2) % 3] = place[(k + 2) % 3] + (turn >= 2)
                    facet.append(number.setdefault(tuple(corner), len(number)))
                facets.append(facet)
    return off(list(number), facets)


def block(low, high):
    return {(x, y, z) for x in range(low[0], high[0]) for y in range(low[1], high[1]) for z in range(low[2], high[2])}


def window(diameter, sides, thickness=1e-6, side=4.0):
    """A square plate about the origin with a hole whose corners are on a circle."""
    h, t = side / 2, thickness / 2
    ring = [(diameter / 2 * math.cos(2 * math.pi * i / sides), diameter / 2 * math.sin(2 * math.pi * i / sides))
            for i in range(sides)]
    square = [(h, 0.0), (h, h), (-h, h), (-h, -h), (h, -h)]
    # both faces are one polygon each, with a slit from the square to the ring
    points = [(x, y, z) for z in (t, -t) for x, y in ring + square]
    n = sides + 5
    top = [sides + i for i in range(5)] + [sides, 0] + list(range(sides - 1, 0, -1)) + [0]
    facets = [top, [n + i for i in reversed(top)]]
    facets += [[i, (i + 1) % sides, n + (i + 1) % sides, n + i] for i in range(sides)]
    facets += [[n + sides + i, n + sides + (i + 1) % 5, sides + (i + 1) % 5, sides + i] for i in range(5)]
    return off(points, facets)


def tetrahedron():
    e = 8 ** -0.5
    return off([(e, e, e), (e, -e, -e), (-e, e, -e), (-e, -e, e)], [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])


def trap():
    """A box of side 11 with a tube of bore 3 that reaches into it, as into a pot of lobsters."""
    walls = block((0, 0, 0), (11, 11, 11)) - block((1, 1, 1), (10, 10, 10))
    tube = block((3, 3, 4), (8, 8, 10)) - block((4, 4, 4), (7, 7, 10))
    return (walls | tube) - block((4, 4, 10), (7, 7, 11))


def burr(seed):
    """Six bars of 2 × 2 × 6, two along each axis, in which cubes that two bars share are given to one of them."""
    rng = random.Random(seed)
    bars = []
    for axis in (2, 0, 1):
        for low in (0, -2):
            span = {axis: (-3, 3), (axis + 1) % 3: (-1, 1), (axis + 2) % 3: (low, low + 2)}
            bars.append(block([span[k][0] for k in range(3)], [span[k][1] for k in range(3)]))
    owner = {}
    for cube in sorted(set().union(*bars)):
        own = [i for i, bar in enumerate(bars) if cube in bar]
        owner[cube] = own[0] if own[0] == 0 and seed < 4 else rng.choice(own)
    pieces = [{c for c in owner if owner[c] == i} for i in range(6)]
    return [connected(piece) for piece in pieces]


def connected(piece):
    """The largest part of cubes that hang together by sides."""
    parts, left = [], set(piece)
    while left:
        part, todo = set(), [left.pop()]
        while todo:
            cube = todo.pop()
            part.add(cube)
            for k in range(3):
                for step in (-1, 1):
                    beside = tuple(cube[j] + step * (j == k) for j in range(3))
                    if beside in left:
                        left.remove(beside)
                        todo.append(beside)
        parts.append(part)
    return max(parts, key=len)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(v):
    return [x / math.sqrt(dot(v, v)) for x in v]


def tube(line, radius, grid=2.0 ** -16):
    """Six-sided prisms along a line of points, in OBJ. Numbers are multiples of the grid, so that facets are planar."""
    def on_grid(v):
        return [round(x / grid) * grid for x in v]

    ways = [unit([b - a for a, b in zip(p, q)]) for p, q in zip(line, line[1:])]
    lines, side = [], (0.0, 0.0, 1.0)
    for i, way in enumerate(ways):
        side = unit([x - dot(side, way) * y for x, y in zip(side, way)])
        across = [way[k - 2] * side[k - 1] - way[k - 1] * side[k - 2] for k in range(3)]
        # each end goes on to where the sides of the next prism begin
        cosines = [dot(way, ways[k]) if 0 <= k < len(ways) else 1.0 for k in (i - 1, i + 1)]
        more = [radius * math.sqrt((1 - c) / (1 + c)) for c in cosines]
        begin = on_grid([x - more[0] * y for x, y in zip(line[i], way)])
        along = on_grid([x + more[1] * y - z for x, y, z in zip(line[i + 1], way, begin)])
        p = on_grid([radius * x for x in side])
        q = on_grid([radius * (x / 2 + math.sqrt(0.75) * y) for x, y in zip(side, across)])
        ring = [p, q, [b - a for a, b in zip(p, q)]]
        ring += [[-x for x in v] for v in ring]
        points = [[x + y + k * z for x, y, z in zip(begin, v, along)] for k in range(2) for v in ring]
        facets = [range(6, 0, -1), range(7, 13), *([k + 1, (k + 1) % 6 + 1, (k + 1) % 6 + 7, k + 7] for k in range(6))]
        lines += [f"o prism-{i + 1}", *("v " + " ".join(map(repr, v)) for v in points)]
        lines += ["f " + " ".join(str(12 * i + k) for k in facet) for facet in facets]
    return "\n".join(lines) + "\n"


def alpha(radius, prisms=10, height=0.15, end=1.3):
    """A tube along a cubic that crosses itself over the origin, with twice the height between its middle lines."""
    at = [end * (2 * i / prisms - 1) for i in range(prisms + 1)]
    return tube([(s * s - 1, 1.2 * (s ** 3 - s), height * s) for s in at], radius)


def models():
    """Each model by its name."""
    plate = block((0, 0, 0), (6, 6, 1)) - block((2, 2, 0), (4, 4, 1))
    made = {"plate": cubes(plate), "peg-tight": cubes(block((0, 0, 0), (2, 2, 4))),
            "peg-loose": cubes(block((0, 0, 0), (1, 1, 4))), "peg-large": cubes(block((0, 0, 0), (3, 2, 4))),
            "trap": cubes(trap()), "bug": cubes(block((0, 0, 0), (2, 2, 2))),
            "bug-large": cubes(block((0, 0, 0), (4, 4, 2))),
            "tetrahedron": tetrahedron()}
    for diameter in (9010, 9020):
        for sides in (24, 96):
            made[f"window-{sides}-{diameter}"] = window(diameter / 10000, sides)
    for seed in range(1, 5):
        for i, piece in enumerate(burr(seed)):
            made[f"burr-{seed}-{i + 1}"] = cubes(piece)
    for radius in (30, 50, 74):
        made[f"alpha-{radius}"] = alpha(radius / 1000)
    return made


def main(folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in models().items():
        suffix = ".off" if text.startswith("OFF") else ".obj"
        (folder / (name + suffix)).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
