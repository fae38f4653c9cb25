#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pictures of solids: at each pixel the facet that a ray meets first, told by its shade."""
import math
import struct
import zlib
from fractions import Fraction

from command_test import CommandTest, main
from test_solid import prism

MARGIN, SIZE, STEP = 24, 640, 13


def read_png(data):
    """The rows of an RGB picture, as lists of (red, green, blue)."""
    at, packed, width = 8, b"", 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert (depth, colour) == (8, 2)
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    raw, rows, above = zlib.decompress(packed), [], bytearray(3 * width)
    for first in range(0, len(raw), 3 * width + 1):
        line = bytearray(raw[first + 1:first + 3 * width + 1])
        unfilter(raw[first], line, above)
        rows.append([tuple(line[i:i + 3]) for i in range(0, 3 * width, 3)])
        above = line
    return rows


def unfilter(way, line, above):
    """One row as it was, of bytes that its filter made small."""
    if way == 2:
        line[:] = bytes(a + b & 255 for a, b in zip(line, above))
    if way not in (1, 3, 4):
        return
    a, c = [0, 0, 0], [0, 0, 0]
    for i, up in enumerate(above):
        k = i % 3
        left, corner = a[k], c[k]
        if way == 1:
            guess = left
        elif way == 3:
            guess = left + up >> 1
        else:
            by_left, by_up, by_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
            guess = left if by_left <= by_up and by_left <= by_corner else up if by_up <= by_corner else corner
        a[k] = line[i] = line[i] + guess & 255
        c[k] = up


def read_off(text):
    words = iter(text.split()[1:])
    vertices, facets, _ = (int(next(words)) for _ in range(3))
    points = [tuple(float(Fraction(next(words))) for _ in range(3)) for _ in range(vertices)]
    return points, [[int(next(words)) for _ in range(int(next(words)))] for _ in range(facets)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def normal_of(loop):
    n = [0, 0, 0]
    for a, b in zip(loop, loop[1:] + loop[:1]):
        for k in range(3):
            n[k] += (a[(k + 1) % 3] - b[(k + 1) % 3]) * (a[(k + 2) % 3] + b[(k + 2) % 3])
    return tuple(x / math.sqrt(dot(n, n)) for x in n)


def holds(loop, x, y):
    """Whether a loop of the picture goes round a point, sides that are walked both ways left out of count."""
    inside = False
    for a, b in zip(loop, loop[1:] + loop[:1]):
        if (a[1] > y) != (b[1] > y) and x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]):
            inside = not inside
    return inside


class SolidPicture(CommandTest):
    def draw(self, *args):
        done = self.run_command(*args, "-o", self.path / "picture.png")
        if "does not end in .off\n" in done.stderr:
            self.skipTest("this build has no libpng")
        self.assertEqual((done.returncode, done.stderr), (0, ""), args)
        return read_png((self.path / "picture.png").read_bytes())

    def check(self, meshes, rows):
        """Each pixel away from edges against rays; how many were, and at how many a facet hides another."""
        a, e = math.radians(35), math.radians(25)
        view = ((-math.sin(a), math.cos(a), 0), (-math.cos(a) * math.sin(e), -math.sin(a) * math.sin(e), math.cos(e)),
                (math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)))
        seen = [[tuple(dot(row, p) for row in view) for p in points] for points, _ in meshes]
        low = [min(p[k] for points in seen for p in points) for k in range(2)]
        high = [max(p[k] for points in seen for p in points) for k in range(2)]
        scale = SIZE / max(h - l for l, h in zip(low, high))
        facets = [(mesh, loop, normal_of(loop)) for mesh, (points, (_, loops)) in enumerate(zip(seen, meshes))
                  for loop in [[points[v] for v in corners] for corners in loops]]
        colours, checked, hiding = {}, 0, 0
        for row in range(3, len(rows) - 3, STEP):
            for column in range(3, len(rows[0]) - 3, STEP):
                around = {rows[row + i][column + k] for i in range(-2, 3) for k in range(-2, 3)}
                if len(around) > 1:
                    continue
                x, y = low[0] + (column + 0.5 - MARGIN) / scale, high[1] - (row + 0.5 - MARGIN) / scale
                met = sorted(((dot(n, loop[0]) - n[0] * x - n[1] * y) / n[2], mesh, n) for mesh, loop, n in facets
                             if n[2] > 0 and holds(loop, x, y))
                key = (met[-1][1], *(round(k, 6) for k in met[-1][2])) if met else None
                self.assertEqual(colours.setdefault(key, rows[row][column]), rows[row][column], (row, column, key))
                checked += 1
                hiding += len(met) > 1
        self.assertEqual(colours.get(None, (255, 255, 255)), (255, 255, 255))
        # a facet's shade is that of one angle: two may look alike, but not many
        self.assertGreater(len(set(colours.values())), 2 / 3 * len(colours))
        return checked, hiding

    def test_what_is_nearer_hides_what_is_behind(self):
        model = self.file("l.off", prism())
        args = ("sum", model, "shape:cube", "--solid", "--quat", "0.2,-0.4,0.1,0.9")
        rows = self.draw(*args)
        self.good(*args, "-o", self.path / "sum.off")
        checked, hiding = self.check([read_off((self.path / "sum.off").read_text())], rows)
        self.assertGreater(checked, 500)
        self.assertGreater(hiding, 0)

    def test_each_piece_has_its_colour(self):
        model = self.file("l.off", prism())
        rows = self.draw("decompose", model)
        self.good("decompose", model, "-o", self.path / "pieces")
        pieces = [read_off((self.path / f"pieces/piece-{k:06}.off").read_text()) for k in range(2)]
        self.assertGreater(self.check(pieces, rows)[0], 500)

    def test_pictures_go_where_meshes_go(self):
        self.draw("sum", "shape:cube", "shape:cube", "--solid")
        self.bad("sum", "shape:cube", "shape:cube", "--solid", "-o", self.path / "none" / "x.png", says="none/x.png")
        self.bad("sum", "shape:cube", "shape:cube", "--solid", "-o", "x.svg", says="does not end in .off or .png")


if __name__ == "__main__":
    main()
