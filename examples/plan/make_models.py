#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes models to plan with, in OFF: make_models.py FOLDER.

- window-24-9020.off and so on, a plate with a round hole of 24 or 96 corners and diameter .9020 or .9010, and
  tetrahedron.off, regular, of edge 1: it goes through by translations from diameter .901388 on (Halperin, Sharir,
  Yehuda, arXiv 2102.04262), turned as WINDOW_TURN says;
- plate.off, with a square hole, and pegs: peg-tight.off fits exactly, peg-loose.off with room, peg-large.off not;
- trap.off, a box whose entrance reaches into it, and bug.off, which finds out, bug-large.off, which does not;
- burr-S-1.off to burr-S-6.off, the pieces of a burr puzzle of seed S, assembled: piece 1 of seeds 1 to 3 is a key, a
  whole bar; seed 4 has none.
"""
import math
import pathlib
import random
import sys

# The turn in which the tetrahedron goes through the smallest window along z: a quaternion x, y, z, w.
WINDOW_TURN = (0, 0.20354053471956063, 0, 0.9790665200720916)


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
    return made


def main(folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in models().items():
        (folder / (name + ".off")).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
