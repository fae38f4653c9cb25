#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette info and pirouette shape."""
import json
import subprocess

from command_test import CommandTest, main


class Info(CommandTest):
    def test_counts_bounds_and_volume(self):
        self.assertEqual(self.data("info", "shape:box?x=1&y=2&z=0.5"), {
            "model": "shape:box?x=1&y=2&z=0.5", "dimension": 3, "vertices": 8, "edges": 12, "facets": 6,
            "bounds": {"low": [-0.5, -1, -0.25], "high": [0.5, 1, 0.25]}, "volume": 1,
            "input": {"surface": "closed", "convex": True, "points": 8, "facets": 6, "volume": 1},
        })
        pyramid = self.data("info", self.pyramid)
        self.assertEqual([pyramid[k] for k in ("dimension", "vertices", "edges", "facets")], [3, 5, 8, 5])
        self.assertEqual(pyramid["bounds"]["low"], [-1 / 3, -1 / 3, 0])
        self.assertEqual(pyramid["bounds"]["high"], [1 / 3, 1 / 3, 5 / 7])
        self.assertAlmostEqual(pyramid["volume"], 4 / 9 * 5 / 7 / 3, places=14)

    def test_figures_are_the_librarys(self):
        for model in (self.tetrahedron, self.pyramid, "shape:gs4", "shape:cone?sides=7", "shape:ellipsoid?level=3"):
            told, library = self.data("info", model), self.answers("info", model)
            for key in ("dimension", "vertices", "edges", "facets", "volume"):
                self.assertEqual([told[key]], library[key], (model, key))
            self.assertEqual([told["bounds"]["low"], told["bounds"]["high"]], [library["low"], library["high"]])

    def test_what_is_not_finite_is_null(self):
        told = self.data("info", self.file("large.off", "OFF 4 0 0 0 0 0 1e150 0 0 0 1e150 0 0 0 1e150"))
        self.assertIsNone(told["volume"])

    def test_flat_bodies(self):
        for name, text, counts in (
                ("square.off", "OFF\n4 0 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n", [2, 4, 4, 2]),
                ("segment.off", "OFF\n3 0 0\n0 0 0\n1 1 1\n2 2 2\n", [1, 2, 1, 0]),
                ("point.off", "OFF\n2 0 0\n3 4 5\n3 4 5\n", [0, 1, 0, 0])):
            told = self.data("info", self.file(name, text))
            self.assertEqual([told[k] for k in ("dimension", "vertices", "edges", "facets")], counts)
            self.assertEqual(told["volume"], 0)

    def test_facets_merge_within_a_length(self):
        # a square whose corner is a thousandth off the plane of the others, under an apex
        model = self.file("bent.off", "OFF\n5 0 0\n0 0 0\n3 0 0\n3 3 1/1000\n0 3 0\n1 1 2\n")
        exact, merged, finer = (self.data("info", model, *merge)
                                for merge in ((), ("--merge", "0.01"), ("--merge", "1e-5")))
        self.assertEqual([exact["facets"], merged["facets"], finer["facets"]], [6, 5, 6])
        self.assertNotIn("merge_bound", exact)
        self.assertEqual(finer["merge_bound"], 0)
        self.assertGreater(merged["merge_bound"], 0)
        self.assertLessEqual(merged["merge_bound"], 0.001)
        self.assertRegex(self.good("info", model, "--merge", "0.01"), r"merged +within .* of the hull\n")
        with open(model) as file:
            told = subprocess.run([self.command, "info", "-", "--merge=0.01", "--json"], stdin=file,
                                  capture_output=True)
        self.assertEqual(json.loads(told.stdout)["facets"], 5)
        self.assertEqual(self.data("info", "shape:cube", "--merge", "1e-9")["facets"], 6)
        # a body's size: all of a fine sphere's facets are within it of each other
        self.assertLess(self.data("info", "shape:geodesic?level=4", "--merge", "0.2")["facets"], 500)
        for command in (("query", model, "shape:cube", "--translate", "0,0,9"), ("cgm", model),
                        ("track", model, model, "--frames", "2")):
            self.good(*command, "--merge", "0.01")
        self.assertEqual(self.data("sum", model, model, "--merge", "0.01")["facets"], 5)

    def test_a_merge_tolerance_that_is_no_length_is_refused(self):
        for value, why in (("-1", "below 0"), ("nan", "nan"), ("x", "x")):
            self.bad("info", "shape:cube", "--merge", value, says=["--merge", why])

    def test_text_holds_the_same(self):
        text = self.good("info", self.pyramid)
        for pattern in (r"dimension +3\n", r"vertices +5\n", r"edges +8\n", r"facets +5\n", r"volume +0\.1058"):
            self.assertRegex(text, pattern)


class Shape(CommandTest):
    def test_the_list_names_models_that_can_be_made(self):
        shapes = self.data("shape", "--list")["shapes"]
        self.assertGreater(len(shapes), 20)
        self.assertEqual(self.good("shape"), self.good("shape", "--list"))
        for shape in shapes:
            self.assertTrue(shape["help"])
            self.assertGreater(self.data("info", f"shape:{shape['name']}")["vertices"], 0, shape["name"])
            self.assertIn(shape["name"], self.good("shape", "--list"))

    def test_a_written_model_reads_back_as_itself(self):
        for name in ("icosahedron", "dodecahedron", "truncated-cube", "geodesic?level=3"):
            file = self.path / "shape.off"
            told = self.data("shape", name, "-o", file)
            first, again = self.data("info", f"shape:{name}"), self.data("info", file)
            del first["model"], again["model"]
            self.assertEqual(first, again)
            self.assertNotIn("/", file.read_text())
            self.assertEqual(told["vertices"], first["vertices"])
            plain = file.read_bytes()
            self.assertIn("written to", self.good("shape", f"shape:{name}", "-o", file))
            self.assertEqual(file.read_bytes(), plain)

    def test_exact_text_is_the_same_body(self):
        for extra in ([], ["--exact"]):
            self.good("shape", "gs2", "-o", self.path / f"a{len(extra)}.off", *extra)
        self.assertNotEqual((self.path / "a0.off").read_bytes(), (self.path / "a1.off").read_bytes())
        a, b = self.data("info", self.path / "a0.off"), self.data("info", self.path / "a1.off")
        self.assertEqual(a["bounds"], b["bounds"])
        self.assertEqual(a["facets"], b["facets"])

    def test_a_written_model_is_the_librarys_mesh(self):
        for exact in (0, 1):
            told = self.data("shape", "gs2", "-o", self.path / "ours.off", *["--exact"] * exact)
            library = self.answers("mesh", "shape:gs2", o=self.path / "library.off", exact=(exact,))
            self.assertEqual([told[k] for k in ("vertices", "edges", "facets")], library["mesh"])
            self.assertEqual((told["name"], told["file"]), ("gs2", str(self.path / "ours.off")))
            self.assertEqual((self.path / "ours.off").read_bytes(), (self.path / "library.off").read_bytes())

    def test_what_is_missing_is_said(self):
        self.bad("shape", "cube", says="-o")
        self.bad("shape", "-o", self.path / "x.off", says="NAME")
        self.bad("shape", "cube", "--list", says="--list")
        self.bad("shape", "sphinx", "-o", self.path / "x.off", says="sphinx")
        self.assertFalse((self.path / "x.off").exists())


if __name__ == "__main__":
    main()
