#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette view: slices as meshes, contact sheets, sections and pages; what goes wrong."""
import base64
import json
import math
import re
import struct
import xml.etree.ElementTree as ElementTree
from fractions import Fraction

from command_test import CommandTest, main

STEPS = 24
AXIS = "1,2,2"
SVG = "{http://www.w3.org/2000/svg}"


def box_off(low, high):
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    return "OFF\n8 0 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in corners)


class Sliced(CommandTest):
    """A robot of two boxes and two obstacles, a turn about one axis."""

    def setUp(self):
        super().setUp()
        self.robot, self.obstacles = self.path / "robot", self.path / "obstacles"
        for folder, boxes in ((self.robot, [((-1, -.25, -.25), (1, .25, .25)), ((.5, .25, -.25), (1, 1, .25))]),
                              (self.obstacles, [((1.5, -2, -1), (2, 2, 1)), ((-2, -3, -1), (2, -2, 1))])):
            folder.mkdir()
            for i, corners in enumerate(boxes):
                (folder / f"{i}.off").write_text(box_off(*corners))
        self.slices = self.path / "slices.h5"
        self.good("slice", self.robot, self.obstacles, "-o", self.slices, "--axis", AXIS, "--steps", STEPS)

    def view(self, name, *args):
        self.good("view", self.slices, "-o", self.path / name, *args)
        return (self.path / name).read_bytes()

    def quat(self, k):
        """The quaternion of slice k as the page has it."""
        page = self.data_of(self.view("page.html"))
        rotations = base64.b64decode(page["rotations"])
        return struct.unpack_from("<4d", rotations, 32 * k)

    @staticmethod
    def data_of(page):
        return json.loads(re.search(rb'<script id="data" type="application/json">(.*?)</script>', page, re.S)[1])


def off_of(text):
    """Vertices and facets of an OFF file."""
    tokens = text.decode().split()
    vertices, facets = int(tokens[1]), int(tokens[2])
    at = 4
    points = [tuple(Fraction(t) for t in tokens[at + 3 * i:at + 3 * i + 3]) for i in range(vertices)]
    at += 3 * vertices
    loops = []
    for _ in range(facets):
        count = int(tokens[at])
        loops.append([int(t) for t in tokens[at + 1:at + 1 + count]])
        at += 1 + count
    return points, loops


class View(Sliced):
    def test_a_slice_is_the_sum_at_its_rotation(self):
        for k, pair in ((0, (0, 0)), (7, (1, 0)), (STEPS - 1, (1, 1)), (11, (0, 1))):
            x, y, z, w = self.quat(k)
            sum_off = self.path / "sum.off"
            self.good("sum", self.robot / f"{pair[0]}.off", self.obstacles / f"{pair[1]}.off", "--difference",
                      "--exact", f"--quat={x!r},{y!r},{z!r},{w!r}", "-o", sum_off)
            exact = self.view("slice.off", "--slice", k, "--pair", f"{pair[0]},{pair[1]}", "--exact")
            self.assertEqual(off_of(exact), off_of(sum_off.read_bytes()))

    def test_every_format_of_a_mesh(self):
        for ending, begins in ((".off", b"OFF"), (".obj", b""), (".stl", b""), (".ply", b"ply"), (".svg", b"<svg")):
            written = self.view("one" + ending, "--slice", 5)
            self.assertTrue(written.startswith(begins) and len(written) > 300, ending)
        self.assertTrue(self.good("view", self.slices, "--slice", 3, "-o", "-").startswith("OFF"))

    def test_what_was_written_is_told(self):
        told = self.data("view", self.slices, "-o", self.path / "some.html", "--every", 5)
        self.assertEqual((told["slices"], told["shown"], told["first"], told["every"]), (STEPS, 5, 0, 5))
        told = self.data("view", self.slices, "-o", self.path / "one.svg", "--slice", 5)
        self.assertEqual((told["shown"], told["first"]), (1, 5))
        self.assertIn("24 of 24 slices", self.good("view", self.slices, "-o", self.path / "all.svg"))

    def test_a_sheet_has_a_view_for_each_slice(self):
        sheet = ElementTree.fromstring(self.view("sheet.svg"))
        views = [group for group in sheet.iter(SVG + "g") if group.get("class") == "view"]
        self.assertEqual(len(views), STEPS)
        places = {group.get("transform") for group in views}
        self.assertEqual(len(places), STEPS)
        # facets of one kind have different shades, as they face the light
        shades = {path.get("fill") for group in views for path in group.iter(SVG + "path")}
        self.assertGreater(len(shades), 12, shades)
        width, height = float(sheet.get("width")), float(sheet.get("height"))
        for k, group in enumerate(views):
            self.assertTrue(group.find(SVG + "text").text.startswith(f"{k}: "))
            x, y = map(float, re.findall(r"[\d.]+", group.get("transform")))
            for path in group.iter(SVG + "path"):
                for px, py in re.findall(r"(-?[\d.]+) (-?[\d.]+)", path.get("d")):
                    self.assertTrue(abs(float(px)) <= 84.1 and abs(float(py)) <= 84.1)
                    self.assertTrue(0 <= x + float(px) <= width and 0 <= y + float(py) <= height)

    def test_sections_of_a_sheet_are_those_of_the_mesh(self):
        offset = 0.25
        sheet = ElementTree.fromstring(self.view("sections.svg", "--planar", f"z={offset}"))
        views = [group for group in sheet.iter(SVG + "g") if group.get("class") == "view"]
        self.assertEqual(len(views), STEPS)
        scales = set()
        for k in (0, 5, 13):
            paths = [path.get("d") for path in views[k].iter(SVG + "path")]
            areas = []
            for pair in ("0,0", "0,1", "1,0", "1,1"):
                points, loops = off_of(self.view("slice.off", "--slice", k, "--pair", pair))
                areas.append(section_area(points, loops, Fraction(offset)))
            areas = [area for area in areas if area > 0]
            self.assertEqual(len(paths), len(areas))
            for path, area in zip(paths, areas):
                drawn = [tuple(map(float, p)) for p in re.findall(r"(-?[\d.]+) (-?[\d.]+)", path)]
                scales.add(round(math.sqrt(abs(polygon_area(drawn)) / area), 1))
        self.assertLess(max(scales) - min(scales), 0.02 * max(scales), scales)

    def test_a_page_needs_nothing_else(self):
        page = self.view("page.html").decode()
        self.assertFalse(re.search(r'(?:src|href)\s*=|https?://(?!www\.w3\.org)|import\s*\(|fetch\(', page))
        data = self.data_of(page.encode())
        self.assertEqual((data["slices"], data["total"], len(data["pairs"])), (STEPS, STEPS, 4))

    def test_a_name_that_is_no_html(self):
        odd = self.path / "a<b>&\"'.h5"
        odd.write_bytes(self.slices.read_bytes())
        self.good("view", odd, "-o", self.path / "odd.html")
        self.good("view", odd, "-o", self.path / "odd.svg")
        self.assertIn("a<b>&", self.data_of((self.path / "odd.html").read_bytes())["title"])
        ElementTree.fromstring((self.path / "odd.svg").read_text())

    def test_what_cannot_be_viewed(self):
        out = self.path / "out.off"
        self.bad("view", self.slices, says="-o")
        self.bad("view", self.slices, "-o", out, says="--slice")
        self.bad("view", self.slices, "-o", self.path / "out.png", says=[".png", ".html"])
        self.bad("view", self.slices, "-o", out, "--slice", STEPS, says=f"no slice {STEPS}")
        self.bad("view", self.slices, "-o", out, "--slice", 0, "--pair", "2,0", says="robot has no piece 2")
        self.bad("view", self.slices, "-o", out, "--slice", 0, "--pair", "0,2", says="obstacle has no piece 2")
        self.bad("view", self.slices, "-o", out, "--slice", 0, "--pair", "0.5,0", says="0.5")
        self.bad("view", self.slices, "-o", self.path / "out.svg", "--pair", "0,0", says="--pair")
        self.bad("view", self.slices, "-o", self.path / "out.html", "--planar", "z=0", says="--planar")
        self.bad("view", self.slices, "-o", self.path / "out.html", "--exact", says="--exact")
        self.bad("view", self.slices, "-o", self.path / "out.svg", "--slice", 1, "--every", 2, says="--every")
        for plane in ("z", "z=", "w=1", "z=1x", "z=nan", "z=1e999", ""):
            self.bad("view", self.slices, "-o", self.path / "out.svg", "--planar", plane, says="--planar")
        self.bad("view", self.path / "none.h5", "-o", out, "--slice", 0, says="none.h5")
        self.bad("view", self.tetrahedron, "-o", out, "--slice", 0, says="tetrahedron.off")
        self.bad("view", self.slices, "-o", self.path / "no" / "out.off", "--slice", 0, says="out.off")
        self.bad("view", self.slices, "-o", "/dev/full", "--slice", 0, says="/dev/full")
        self.assertFalse(out.exists() or (self.path / "out.svg").exists())


def polygon_area(points):
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(points, points[1:] + points[:1])) / 2


def section_area(points, loops, offset):
    """The area of the section at z = offset: from the facets that cross it, by their sides about one point of it."""
    sides = []
    for loop in loops:
        ends = []
        for a, b in zip(loop, loop[1:] + loop[:1]):
            p, q = points[a], points[b]
            if (p[2] > offset) != (q[2] > offset):
                t = (offset - p[2]) / (q[2] - p[2])
                ends.append((p[2] > offset, [p[k] + t * (q[k] - p[k]) for k in range(2)]))
        if len(ends) == 2:
            down, up = sorted(ends, key=lambda end: not end[0])
            sides.append((down[1], up[1]))
    return float(sum(a[0] * b[1] - a[1] * b[0] for a, b in sides) / 2) if sides else 0.0


if __name__ == "__main__":
    main()
