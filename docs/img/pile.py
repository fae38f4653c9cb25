#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/img/pile.svg: hulls that fall into a box and come to rest, in motion.

Usage: pile.py COMMAND OUTPUT, where COMMAND is the built `pirouette`.

`pirouette simulate --record` runs a scene and keeps the pose of every body. This script only projects the bodies and
shows the frames one after another: of each hull its outline, and on it the part that faces the light; hulls that others
hide are left out. Two of the box's four walls are not drawn.
"""
import pathlib
import struct
import subprocess
import sys
import tempfile

SCENE = pathlib.Path(__file__).parent.parent.parent / "examples/scenes/heap.json"
RUN, EVERY, REST = 2.5, 5, 1.5  # seconds of the run, one of so many recorded frames, seconds that the last one stays
RATE = 60                       # recorded frames a second
UNIT = 240                      # user units of the picture a metre
MIDDLE = 250, 410               # where the picture has the origin
HALF, WALL = 0.64, 0.5          # of the box within its walls, and how high they are drawn
# The picture's x and y in space, and what points at the viewer: orthonormal, from integers over 5 and 13.
ACROSS, UP, TOWARDS = (4 / 5, 3 / 5, 0), (-3 / 13, 4 / 13, 12 / 13), (36 / 65, -48 / 65, 5 / 13)
LIGHT = (-0.2, -0.5, 0.84)
CELL = 3                        # of the grid on which it is seen what hides what
COLOURS = ((66, 135, 245), (245, 158, 46), (38, 166, 121), (232, 93, 117), (139, 108, 239))
STYLE = """\
.f{visibility:hidden;animation:f %gs steps(1) infinite}
.l{animation-name:l}@keyframes l{0%%{visibility:visible}%.3f%%{visibility:hidden}}
@keyframes f{0%%{visibility:visible}%.3f%%{visibility:hidden}}
path{stroke-linejoin:round;stroke-width:.8}.b{fill:#d8dce2}.w{fill:#e9ecf0}
@media(prefers-color-scheme:dark){.b{fill:#30363d}.w{fill:#21262d}}
@media(prefers-reduced-motion){.f{animation:none}.l{visibility:visible}}
"""


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def less(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def placed(pose, points):
    """Points of a body in the world; the quaternion is of length 1 but for rounding."""
    at, (x, y, z, w) = pose[:3], pose[3:]
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    return [tuple(dot(row, p) + t for row, t in zip(rows, at)) for p in points]


def flat(p):
    return round(MIDDLE[0] + UNIT * dot(p, ACROSS)), round(MIDDLE[1] - UNIT * dot(p, UP))


def read_recording(data):
    """Shapes as points and triangles, the shape of each body, and the frames; see docs/scenes.md."""
    shapes, bodies, statics, frames = struct.unpack_from("<8x4I", data)
    at, made = 28, []

    def take(form):
        nonlocal at
        values = struct.unpack_from("<" + form, data, at)
        at += struct.calcsize("<" + form)
        return values

    for _ in range(shapes):
        vertices, triangles = take("2I")
        points = [take("3f") for _ in range(vertices)]
        made.append((points, [take("3I") for _ in range(triangles)]))
    take(f"{10 * statics}f")
    of = take(f"{bodies}I")
    return made, of, [[take("7f") for _ in range(bodies)] for _ in range(frames)]


def outline(points):
    """The hull of points of the plane, in order."""
    points, sides = sorted(set(points)), []
    for line in (points, points[::-1]):
        side = []
        for p in line:
            while len(side) > 1 and ((side[-1][0] - side[-2][0]) * (p[1] - side[-2][1]) -
                                     (side[-1][1] - side[-2][1]) * (p[0] - side[-2][0])) <= 0:
                side.pop()
            side.append(p)
        sides += side[:-1]
    return sides


def border(triangles):
    """The loop of edges that one of the triangles has alone, or None where they are several."""
    edges = {(t[i], t[(i + 1) % 3]) for t in triangles for i in range(3)}
    after = {a: b for a, b in edges if (b, a) not in edges}
    if not after:
        return None
    loop = [min(after)]
    while len(loop) < len(after):
        loop.append(after[loop[-1]])
    return loop if len(set(loop)) == len(loop) else None


def path(name, corners):
    (x, y), steps = corners[0], []
    for corner in corners[1:]:
        steps.append(f"{corner[0] - x} {corner[1] - y}")
        x, y = corner
    return f'<path class="{name}" d="M{corners[0][0]} {corners[0][1]}l' + " ".join(steps).replace(" -", "-") + 'z"/>'


def cells(corners):
    """The cells of the grid whose middles an outline holds."""
    low, high = min(y for _, y in corners), max(y for _, y in corners)
    for row in range(low // CELL, high // CELL + 1):
        y, cut = (row + 0.5) * CELL, []
        for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]):
            if (ay <= y) != (by <= y):
                cut.append(ax + (y - ay) * (bx - ax) / (by - ay))
        for column in range(round(min(cut, default=0) / CELL), round(max(cut, default=0) / CELL)):
            yield row, column


def draw_frame(shapes, of, poses):
    """What is seen of the bodies, from back to front."""
    seen, taken = [], set()
    for body in sorted(range(len(of)), key=lambda i: -dot(poses[i][:3], TOWARDS)):
        points, triangles = shapes[of[body]]
        points = placed(poses[body], points)
        around = outline([flat(p) for p in points])
        covered = set(cells(around)) - taken
        if len(covered) < 12:
            continue
        taken |= covered
        lit = []
        for t in triangles:
            n = cross(less(points[t[1]], points[t[0]]), less(points[t[2]], points[t[0]]))
            if dot(n, TOWARDS) > 0 and dot(n, LIGHT) > 0.55 * dot(n, n) ** 0.5:
                lit.append(t)
        loop = border(lit)
        colour = body % len(COLOURS)
        seen.append(path(f"d{colour}", around) + (path(f"c{colour}", [flat(points[v]) for v in loop]) if loop else ""))
    return "".join(reversed(seen))


def rgb(colour, light):
    return "#" + "".join(format(min(255, round(c * light)), "02x") for c in colour)


def draw(shapes, of, frames):
    seconds = len(frames) * EVERY / RATE + REST
    part = 100 * EVERY / RATE / seconds
    style = STYLE % (seconds, part + 100 * REST / seconds, part)
    for index, colour in enumerate(COLOURS):
        style += f".c{index}{{fill:{rgb(colour, 1)}}}.d{index}{{fill:{rgb(colour, 0.7)};stroke:{rgb(colour, 0.45)}}}"
    h, w = HALF, WALL
    box = [path("b", [flat(p) for p in ((-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0))]),
           path("w", [flat(p) for p in ((-h, -h, 0), (-h, h, 0), (-h, h, w), (-h, -h, w))]),
           path("w", [flat(p) for p in ((-h, h, 0), (h, h, 0), (h, h, w), (-h, h, w))])]
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 500 510" role="img">',
           f"<title>{len(of)} hulls fall into a box and come to rest.</title>", f"<style>\n{style}\n</style>", *box]
    for index, poses in enumerate(frames):
        name = "f l" if index + 1 == len(frames) else "f"
        out.append(f'<g class="{name}" style="animation-delay:{index * EVERY / RATE - seconds:.3f}s">'
                   + draw_frame(shapes, of, poses) + "</g>")
    return "\n".join(out) + "\n</svg>\n"


def main(command, output):
    with tempfile.TemporaryDirectory() as folder:
        recording = pathlib.Path(folder) / "pile.bin"
        subprocess.run([command, "simulate", str(SCENE), "--seconds", str(RUN), "--record", str(recording)], check=True,
                       stdout=subprocess.DEVNULL)
        shapes, of, frames = read_recording(recording.read_bytes())
    pathlib.Path(output).write_text(draw(shapes, of, frames[::EVERY]), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
