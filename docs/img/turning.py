#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/img/turning.svg: a body that turns, one that stands, and their tracked sum, in motion.

Usage: turning.py COMMAND OUTPUT, where COMMAND is the built `pirouette`.

`pirouette track --dump` gives every frame of the sum, already exact and merged. This script only projects what faces
the viewer, colours each facet by what it came from, and shows the frames one after another. A cube about its diagonal
is itself again after a third of a turn, so the motion has no seam.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

P, Q = "shape:cube", "shape:dodecahedron"
FRAMES, SECONDS = 90, 7.5
AXIS = "1,1,1"
UNIT = 200  # user units of the picture a unit of length
# The picture's x and y in space, and what points at the viewer: orthonormal, from integers over 9 and 3.
ACROSS, UP, TOWARDS = (7 / 9, 4 / 9, -4 / 9), (-4 / 9, 8 / 9, 1 / 9), (4 / 9, 1 / 9, 8 / 9)
LIGHT = (1 / 3, 2 / 3, 2 / 3)
SHADES = 4
COLOURS = {"p": (66, 135, 245), "q": (245, 158, 46), "e": (38, 166, 121)}
STYLE = """\
.f{visibility:hidden;animation:f %ss steps(1) infinite}.f:first-of-type{visibility:visible}
@keyframes f{0%%{visibility:visible}%s%%{visibility:hidden}}
path{stroke:#fff;stroke-width:3;stroke-linejoin:round}.s{stroke:#888;stroke-width:9;stroke-linecap:round;fill:none}
@media(prefers-color-scheme:dark){path{stroke:#0d1117}}
@media(prefers-reduced-motion){.f{animation:none}}
"""


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def less(a, b):
    return tuple(x - y for x, y in zip(a, b))


def turned(quat, points):
    x, y, z, w = quat
    n = dot(quat, quat)
    rows = ((w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z))
    return [tuple(dot(row, p) / n for row in rows) for p in points]


def read_off(text):
    """Points and facets of an OFF file as the command writes it."""
    words = text.split()[1:]
    count, facets = int(words[0]), int(words[1])
    points = [tuple(map(float, words[i:i + 3])) for i in range(3, 3 + 3 * count, 3)]
    loops, at = [], 3 + 3 * count
    for _ in range(facets):
        size = int(words[at])
        loops.append([int(w) for w in words[at + 1:at + 1 + size]])
        at += 1 + size
    return points, loops


def normal(points, loop):
    """The outward unit normal of a facet, from the sum of a fan's cross products."""
    n = (0.0, 0.0, 0.0)
    for i in range(2, len(loop)):
        a, b, c = points[loop[0]], points[loop[i - 1]], points[loop[i]]
        n = tuple(x + y for x, y in zip(n, cross(less(b, a), less(c, a))))
    return tuple(c / dot(n, n) ** 0.5 for c in n)


def paths(points, loops, middle, kind_of):
    """The facets that face the viewer as paths, one for each kind and shade, in steps from corner to corner."""
    drawn = {}
    flat = [(round(middle[0] + UNIT * dot(p, ACROSS)), round(middle[1] - UNIT * dot(p, UP))) for p in points]
    for loop in loops:
        n = normal(points, loop)
        if dot(n, TOWARDS) <= 0:
            continue
        shade = min(SHADES - 1, int(SHADES * (0.5 + 0.5 * dot(n, LIGHT))))
        x, y = flat[loop[0]]
        path = f"M{x} {y}l"
        steps = []
        for corner in loop[1:]:
            steps.append(f"{flat[corner][0] - x} {flat[corner][1] - y}")
            x, y = flat[corner]
        drawn.setdefault(kind_of(n) + str(shade), []).append(path + " ".join(steps).replace(" -", "-") + "z")
    return "".join(f'<path class="{name}" d="{"".join(parts)}"/>' for name, parts in sorted(drawn.items()))


def kinds(*bodies):
    """A facet of the sum is parallel to one of P (p), to one of Q (q), or made of an edge of each (e)."""
    known = [(kind, normal(points, loop)) for kind, points, loops in bodies for loop in loops]
    return lambda n: next((kind for kind, other in known if dot(n, other) > 1 - 1e-9), "e")


def draw(p, q, sums):
    """The picture, from both bodies and a list of (quaternion, points, loops)."""
    style = STYLE % (SECONDS, format(100 / FRAMES, ".4f"))
    for kind, colour in COLOURS.items():
        for shade in range(SHADES):
            light = 0.62 + 0.38 * (shade + 1) / SHADES
            style += f".{kind}{shade}{{fill:#{''.join(format(round(c * light), '02x') for c in colour)}}}"
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1800 800" role="img">',
           "<title>A cube turns, a dodecahedron stands: their Minkowski sum follows. Facets of the sum that come from "
           "the cube are blue, from the dodecahedron orange, from an edge of each green.</title>",
           f"<style>\n{style}\n</style>",
           '<path class="s" d="M420 400h80M460 360v80M945 380h80M945 420h80"/>',
           paths(*q, (700, 400), lambda n: "q")]
    for index, (quat, points, loops) in enumerate(sums):
        there = turned(quat, p[0])
        out.append(f'<g class="f" style="animation-delay:{index * SECONDS / FRAMES - SECONDS:.3f}s">'
                   + paths(there, p[1], (230, 400), lambda n: "p")
                   + paths(points, loops, (1420, 400), kinds(("p", there, p[1]), ("q", *q))) + "</g>")
    return "\n".join(out) + "\n</svg>\n"


def main(command, output):
    def run(*args):
        return subprocess.run([command, *args], check=True, capture_output=True, text=True).stdout

    with tempfile.TemporaryDirectory() as folder:
        run("track", P, Q, "--steps", str(3 * FRAMES), "--frames", str(FRAMES), "--axis", AXIS, "--dump", folder,
            "--every", "1", "--json")
        folder = pathlib.Path(folder)
        frames = json.loads((folder / "frames.json").read_text())["frames"][:FRAMES]
        sums = [(frame["quat"], *read_off((folder / frame["doubles"]).read_text())) for frame in frames]
    p, q = (read_off(run("shape", name.partition(":")[2], "-o", "-")) for name in (P, Q))
    pathlib.Path(output).write_text(draw(p, q, sums), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
