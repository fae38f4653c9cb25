#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette cgm."""
import re
import xml.etree.ElementTree as ElementTree

from command_test import CommandTest, main, numbers


class Cgm(CommandTest):
    def test_maps_of_an_octahedron_are_bare_squares(self):
        told = self.data("cgm", "shape:octahedron")
        self.assertEqual([m["face"] for m in told["maps"]], ["-x", "-y", "-z", "+x", "+y", "+z"])
        for one in told["maps"]:
            self.assertEqual((one["vertices"], one["halfedges"], one["faces"]), (4, 8, 2))
        self.assertEqual(told["total"], {"vertices": 24, "halfedges": 48, "faces": 12})
        self.assertEqual(told["mesh"], {"vertices": 6, "edges": 12, "facets": 8})

    def test_maps_are_the_librarys(self):
        for q in ([], ["shape:gs2"], [self.pyramid]):
            for difference in (0, 1):
                quat = (0.1, 0.2, 0.3, 0.9)
                told = self.data("cgm", self.tetrahedron, *q, f"--quat={numbers(quat)}", *["--difference"] * difference)
                library = self.answers("cgm", self.tetrahedron, *q, quat=quat, difference=(difference,))
                total = [0, 0, 0]
                for one in told["maps"]:
                    counts = [one[k] for k in ("vertices", "halfedges", "faces")]
                    self.assertEqual(counts, library[one["face"]])
                    total = [a + b for a, b in zip(total, counts)]
                self.assertEqual([told["total"][k] for k in ("vertices", "halfedges", "faces")], total)
                self.assertEqual([told["mesh"][k] for k in ("vertices", "edges", "facets")], library["mesh"])
                self.assertEqual((told["p"], told.get("q")), (str(self.tetrahedron), str(q[0]) if q else None))
                self.assertEqual(told["quat"], list(quat))
                self.assertGreater(told["seconds"], 0)

    def test_text_holds_the_counts(self):
        for q in ([], [self.pyramid]):
            told = self.data("cgm", self.tetrahedron, *q)
            text = self.good("cgm", self.tetrahedron, *q, "-o", self.path / "map.svg")
            for name, counts in [(m["face"], m) for m in told["maps"]] + [("total", told["total"])]:
                row = r" +".join(str(counts[k]) for k in ("vertices", "halfedges", "faces"))
                self.assertRegex(text, rf"\n  {re.escape(name)} +{row}\n")
            self.assertRegex(text, r"\n  {} +vertices {vertices}, edges {edges}, facets {facets}\n".format(
                "sum" if q else "polytope", **told["mesh"]))
            # a line for each map and one for all, and no other before the mesh's
            table = re.search(r"\n  map .*\n((?:  \S+ +\d+ +\d+ +\d+\n)*)  (?:sum|polytope) ", text)
            self.assertTrue(table and table[1].count("\n") == 7, text)
            self.assertRegex(text, r"\n  time +[0-9.]+ (ns|us|ms|s)\n  file +.*map\.svg\n$")

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
        # each line is in one square of the unfolded cube, and the lines of each square reach its corners
        squares = {(18 + 190 * x, 18 + 190 * y): [] for x, y in ((0, 1), (1, 2), (3, 1), (2, 1), (1, 0), (1, 1))}
        for line in " ".join(strokes.values()).replace("L", " ").split("M")[1:]:
            x, y, u, v = map(float, line.split())
            homes = [square for square in squares if all(left - 0.01 <= c <= left + 190.01 for left, ends in
                                                         zip(square, ((x, u), (y, v))) for c in ends)]
            self.assertTrue(homes, line)
            for square in homes:
                squares[square] += [(x, y), (u, v)]
        for (left, top), ends in squares.items():
            for x, y in ((left, top), (left + 190, top), (left, top + 190), (left + 190, top + 190)):
                self.assertTrue(any(abs(a - x) + abs(b - y) < 0.01 for a, b in ends), (left, top))

    def test_bad_calls(self):
        self.bad("cgm", says="P is missing")
        self.bad("cgm", self.tetrahedron, "-o", self.path / "map.off", says=".svg")
        self.bad("cgm", self.tetrahedron, "-o", self.path / "nowhere" / "map.svg", says="map.svg")
        self.bad("cgm", self.tetrahedron, "--quat=0,0,0,0", says="quat")
        self.bad("cgm", "shape:nothing", says="nothing")


if __name__ == "__main__":
    main()
