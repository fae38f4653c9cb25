#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette distance."""
import math
import xml.etree.ElementTree as ElementTree

from command_test import CommandTest, main

COMB = """OFF
8 1 0
0 0 0
4 0 0
4 3 0
3 3 0
3 1 0
1 1 0
1 3 0
0 3 0
8 0 1 2 3 4 5 6 7
"""


class Distance(CommandTest):
    def write(self, name, text):
        path = self.path / name
        path.write_text(text)
        return path

    def test_cubes_apart(self):
        told = self.data("distance", "shape:cube", "shape:cube", "--translate", "4,0,0")
        self.assertEqual((told["state"], told["distance"]), ("apart", 3))
        self.assertEqual(told["a"], {"model": "shape:cube", "triangles": 12, "degenerate": 0, "closed": True})
        self.assertEqual(told["points"]["a"][0] - told["points"]["b"][0], 3)
        far = self.data("distance", "shape:cube", "shape:cube", "--translate", "4,0,0", "--farthest")
        self.assertAlmostEqual(far["farthest"], math.sqrt(25 + 1 + 1), places=12)
        self.assertNotIn("state", far)

    def test_states(self):
        for place, state in (("1,0,0", "meet"), ("0.5,0,0", "meet"), ("1.0000000000000002,0,0", "apart")):
            self.assertEqual(self.data("distance", "shape:cube", "shape:cube", "--translate", place)["state"], state)
        small, large = "shape:box?x=0.5&y=0.5&z=0.5", "shape:cube"
        self.assertEqual(self.data("distance", small, large, "--axis", "1,2,3", "--angle", "40")["state"], "a inside")
        self.assertEqual(self.data("distance", large, small)["state"], "b inside")

    def test_a_mesh_is_taken_as_it_is_not_its_hull(self):
        comb = self.write("comb.off", COMB)
        told = self.data("distance", "shape:box?x=0.5&y=0.5&z=0.5", comb, "--translate", "2,2.5,0")
        self.assertEqual((told["state"], told["b"]["closed"], told["b"]["triangles"]), ("apart", False, 6))
        self.assertEqual(told["distance"], 0.75)

    def test_within_lists_pairs(self):
        pair = "shape:cube", "shape:cube", "--translate", "4,0,0"
        none = self.data("distance", *pair, "--within", "2.5")["within"]
        self.assertEqual(none, {"distance": 2.5, "count": 0, "pairs": []})
        # what is exactly the distance is within it
        told = self.data("distance", *pair, "--within", "3")["within"]
        self.assertEqual(len(told["pairs"]), told["count"])
        self.assertEqual(told["pairs"], sorted(told["pairs"]))
        near = self.data("distance", *pair)
        self.assertEqual(told["pairs"][0], near["triangles"])
        everything = self.data("distance", *pair, "--within", "100")["within"]
        self.assertEqual(everything["count"], 144)
        self.assertIn("144 pairs", self.good("distance", *pair, "--within", "100"))

    def test_text_and_picture(self):
        picture = self.path / "two.svg"
        text = self.good("distance", "shape:cube", "shape:octahedron", "--translate", "0,0,5", "-o", picture)
        self.assertRegex(text, r"^shape:cube against shape:octahedron: apart\n  distance +4\n  triangles +\d+, \d+\n")
        root = ElementTree.parse(picture).getroot()
        self.assertEqual(len(list(root.iter("{http://www.w3.org/2000/svg}path"))), 12 + 8 + 2 + 1)
        self.assertIn("distance 4", picture.read_text())

    def test_refusals(self):
        bad = self.write("bad.off", "OFF 3 1 0  0 0 0  1 0 0  2 0 0  3 0 1 2")
        self.bad("distance", bad, "shape:cube", says="none of the 1 triangles has an area")
        self.bad("distance", "shape:cube", self.path / "none.off", says="none.off")
        self.bad("distance", "shape:cube", "shape:cube", "--within=-1", says="less than 0")
        self.bad("distance", "shape:cube", says="B")
        self.bad("distance", "shape:cube", "shape:cube", "--translate", "1e300,0,0", says="distance: too large")


if __name__ == "__main__":
    main()
