#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Models that are not convex, open or hostile. Usage: test_models.py COMMAND ANSWERS FAULTY [CLASS...]"""
import math
import struct
import subprocess

from command_test import CommandTest, TETRAHEDRON, main

# a prism over an L, of volume 3 in a hull of volume 3.5
L = """OFF
12 8 0
0 0 0
2 0 0
2 1 0
1 1 0
1 2 0
0 2 0
0 0 1
2 0 1
2 1 1
1 1 1
1 2 1
0 2 1
6 5 4 3 2 1 0
6 6 7 8 9 10 11
4 0 1 7 6
4 1 2 8 7
4 2 3 9 8
4 3 4 10 9
4 4 5 11 10
4 5 0 6 11
"""

# the faces of a tetrahedron but one, in each format
CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TRIANGLES = [(0, 2, 1), (0, 1, 3), (0, 3, 2)]
PLY = "ply\nformat ascii 1.0\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"


def rows(form, values, first=0):
    return "".join(form % tuple(v + first for v in row) for row in values)


def open_models():
    """Names and contents."""
    yield "open.off", "OFF\n4 3 0\n" + rows("%d %d %d\n", CORNERS) + rows("3 %d %d %d\n", TRIANGLES)
    yield "open.obj", rows("v %d %d %d\n", CORNERS) + rows("f %d %d %d\n", TRIANGLES, 1)
    yield "open.ply", (PLY + "element vertex 4\n" + XYZ + "element face 3\nproperty list uchar int vertex_indices\n"
                       "end_header\n" + rows("%d %d %d\n", CORNERS) + rows("3 %d %d %d\n", TRIANGLES))
    yield "open.stl", "solid\n" + "".join(
        "facet normal 0 0 0\nouter loop\n" + rows("vertex %d %d %d\n", [CORNERS[i] for i in t]) + "endloop\nendfacet\n"
        for t in TRIANGLES) + "endsolid\n"
    yield "binary.stl", b"\0" * 80 + struct.pack("<I", 3) + b"".join(
        struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *CORNERS[i]) for i in t) + b"\0\0" for t in TRIANGLES)


class Surfaces(CommandTest):
    def setUp(self):
        super().setUp()
        self.l = self.file("l.off", L)

    def test_a_model_that_is_not_convex_is_told(self):
        told = self.data("info", self.l)
        self.assertEqual(told["volume"], 3.5)
        self.assertEqual(told["input"], {"surface": "closed", "convex": False, "points": 12, "facets": 8, "volume": 3})
        cube = ("shape:cube", "6 facets, convex\n +volume 1")
        for model, text in ((self.l, "8 facets, not convex\n +volume 3"), cube):
            self.assertRegex(self.good("info", model), rf"\n  as given   closed surface of {text}\n")

    def test_every_subcommand_tells_it_of_both_models(self):
        pose = ["--translate", "3,0,0"]
        for name, *more in (["sum"], ["cgm"], ["track", "--frames", "2"], ["query", *pose]):
            told = self.data(name, self.l, self.tetrahedron, *more)["inputs"]
            self.assertEqual((told["p"]["convex"], told["p"]["volume"], told["q"]["convex"], told["q"]["surface"]),
                             (False, 3, True, "closed"), name)
            told = self.data(name, self.tetrahedron, self.l, *more)["inputs"]
            self.assertEqual((told["p"]["convex"], told["q"]["convex"]), (True, False), name)
            self.assertIn("P as given closed surface of 8 facets, not convex; its convex hull is taken\n",
                          self.good(name, self.l, self.tetrahedron, *more))
            self.assertIn("Q as given", self.good(name, self.tetrahedron, self.l, *more))
            self.assertNotIn("as given", self.good(name, self.tetrahedron, "shape:cube", *more))
        self.assertEqual(list(self.data("cgm", self.l)["inputs"]), ["p"])

    def test_require_convex_refuses_in_every_subcommand(self):
        says = ["l.off:19: not convex: this facet is inside the convex hull; volume 3, of the hull 3.5"]
        for name, *more in (["sum"], ["cgm"], ["track", "--frames", "2"], ["query", "--translate", "3,0,0"]):
            self.bad(name, self.l, self.tetrahedron, *more, "--require-convex", says=says)
            self.bad(name, self.tetrahedron, self.l, *more, "--require-convex", says=says)
            self.good(name, self.tetrahedron, "shape:cube", *more, "--require-convex")
        self.bad("info", self.l, "--require-convex", says=says)
        self.good("info", self.tetrahedron, "--require-convex")
        done = subprocess.run([self.command, "info", "-", "--require-convex"], input=L, capture_output=True, text=True,
                              timeout=600)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, r"^pirouette: standard input:19: not convex: [^\n]*\n$")

    def test_open_surfaces_are_the_same_in_every_format(self):
        for name, text in open_models():
            path = self.file(name, text)
            told = self.data("info", path)
            self.assertEqual((told["dimension"], told["vertices"], told["facets"]), (3, 4, 4), name)
            told = told["input"]
            self.assertEqual([told[k] for k in ("surface", "convex", "facets", "volume")], ["open", False, 3, 0], name)
            self.bad("info", path, "--require-convex",
                     says=[name, "the surface is open: the edge from (", "is on 1 facet\n"])

    def test_points_alone(self):
        told = self.data("info", self.pyramid)["input"]
        self.assertEqual(told, {"surface": "points", "convex": False, "points": 6, "facets": 0, "volume": None})
        self.bad("info", self.pyramid, "--require-convex", says="of 6 places 1 are no vertices of their hull")
        segment = self.file("points.obj", "v 0 0 0\nv 1 2 3\n")
        self.assertTrue(self.data("info", segment, "--require-convex")["input"]["convex"])

    def test_rationals_are_judged_exactly(self):
        third = ("OFF\n5 6 0\n0 0 0\n1/3 0 0\n0 1/3 0\n0 0 1/3\n1/9 1/9 %s\n"
                 "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 4\n3 2 3 4\n3 3 1 4\n")
        on = self.data("info", self.file("on.off", third % "1/9"))
        self.assertEqual((on["vertices"], on["input"]["convex"]), (4, True))
        below = self.data("info", self.file("below.off", third % ("1" * 41 + "/1" + "0" * 41)))
        self.assertEqual((below["vertices"], below["input"]["convex"]), (4, False))
        self.assertTrue(math.isclose(below["input"]["volume"], below["volume"]))

    def test_a_written_hull_is_convex(self):
        for ending in ("off", "obj", "ply", "stl"):
            path = self.path / f"cube.{ending}"
            self.good("shape", "cube", "-o", path)
            told = self.data("info", path, "--require-convex")
            self.assertEqual((told["volume"], told["input"]["volume"]), (1, 1), ending)


class Hostile(CommandTest):
    def test_a_header_that_does_not_end(self):
        head = PLY + "element vertex 1\n" + XYZ
        mixed = head.replace("\n", "\r") + "end_header\n0 0 0\n"
        for number, text in enumerate(("ply", "ply\n", head, head + "end_header", head + "end_head\n0 0 0\n", mixed,
                                       head + "end_header garbage\n0 0 0\n", head + " \n" * 5000 + "end_headex\n")):
            self.bad("info", self.file(f"{number}.ply", text), says=f"{number}.ply:")

    def test_no_other_file_is_opened(self):
        corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
        self.good("info", self.file("a.obj", f"mtllib {self.path}\n" + corners))
        for word in ("call", "csh"):
            self.bad("info", self.file("a.obj", corners + f"{word} {self.tetrahedron}\n"),
                     says=f"a.obj:4: '{word}' statements are not read")

    def test_a_promise_takes_no_memory(self):
        head = PLY.replace("ascii", "binary_big_endian") + "element vertex 1\n" + XYZ.replace("float", "char")
        faces = "element face 1\nproperty list uint uint vertex_index\nend_header\n"
        self.bad("info", self.file("a.ply", head + faces + "\0\0\0\x7f\x7f\x7f\x7f"), says="promises 2139062143 values")
        self.bad("info", self.file("a.stl", b"\0" * 80 + b"\xff" * 4), says="4294967295 triangles are promised")
        self.bad("info", self.file("a.off", TETRAHEDRON.replace("4 4 6", "4294967295 4 6")), says="4294967295 vertices")


if __name__ == "__main__":
    main()
