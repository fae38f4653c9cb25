#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette cgm. Usage: test_cgm.py COMMAND [CLASS...]"""
import xml.etree.ElementTree as ElementTree

from command_test import CommandTest, main


class Cgm(CommandTest):
    def test_maps_of_an_octahedron_are_bare_squares(self):
        told = self.data("cgm", "shape:octahedron")
        self.assertEqual([m["face"] for m in told["maps"]], ["-x", "-y", "-z", "+x", "+y", "+z"])
        for one in told["maps"]:
            self.assertEqual((one["vertices"], one["halfedges"], one["faces"]), (4, 8, 2))
        self.assertEqual(told["total"], {"vertices": 24, "halfedges": 48, "faces": 12})
        self.assertEqual(told["mesh"], {"vertices": 6, "edges": 12, "facets": 8})

    def test_overlay_is_the_sum(self):
        for extra in ([], ["--difference"], ["--quat=0.1,0.2,0.3,0.9"]):
            overlay = self.data("cgm", self.tetrahedron, "shape:gs2", *extra)
            walked = self.data("sum", self.tetrahedron, "shape:gs2", *extra)
            for key in ("vertices", "edges", "facets"):
                self.assertEqual(overlay["mesh"][key], walked[key], (key, extra))
        self.assertIn("total", self.good("cgm", self.tetrahedron, self.pyramid, "--axis", "0,0,1", "--angle", "90"))

    def test_sum_by_cgm_writes_the_same_file(self):
        for extra in ([], ["--difference"], ["--exact"], ["--quat=0,0,1,1"]):
            written = []
            for method in ("walk", "cgm", "hull"):
                path = self.path / f"{method}.off"
                self.good("sum", self.pyramid, "shape:cube", "--method", method, "-o", path, *extra)
                written.append(path.read_bytes())
            self.assertEqual(written[0], written[1], extra)
            self.assertEqual(written[0], written[2], extra)

    def test_picture_shows_whose_arcs_they_are(self):
        path = self.path / "map.svg"
        self.good("cgm", self.tetrahedron, "shape:cube", "--quat=0.1,0.2,0.3,0.9", "-o", path)
        root = ElementTree.parse(path).getroot()
        strokes = {e.get("stroke"): e.get("d") for e in root.iter() if e.tag.endswith("path")}
        self.assertTrue(strokes["#d22f27"] and strokes["#2456c8"])
        # six edges of the tetrahedron, each in one to three maps
        self.assertTrue(6 <= strokes["#d22f27"].count("M") <= 40)

    def test_bad_calls(self):
        self.bad("cgm", says="P is missing")
        self.bad("cgm", self.tetrahedron, "-o", self.path / "map.off", says=".svg")
        self.bad("cgm", self.tetrahedron, "-o", self.path / "nowhere" / "map.svg", says="map.svg")
        self.bad("cgm", self.tetrahedron, "--quat=0,0,0,0", says="quat")
        self.bad("cgm", "shape:nothing", says="nothing")


if __name__ == "__main__":
    main()
