#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette sum and its poses."""
import math
import xml.etree.ElementTree as ElementTree

from command_test import CommandTest, main, numbers, rotation


class Pose(CommandTest):
    def quat(self, *pose):
        return self.data("sum", "shape:cube", self.tetrahedron, *pose)["quat"]

    def turned(self, axis, angle):
        return rotation(self.quat("--axis", axis, f"--angle={angle}"))

    def test_without_a_pose_nothing_turns(self):
        self.assertEqual(self.quat(), [0, 0, 0, 1])
        self.assertEqual(self.quat("--axis=3,1,2", "--angle", "0"), [0, 0, 0, 1])
        self.assertEqual(self.quat("--axis=3,1,2", "--angle", "-1080"), [0, 0, 0, 1])

    def test_a_quaternion_is_taken_bit_for_bit(self):
        for quat in ((0.1, -0.2, 1 / 3, 0.7), (3e-160, 0, 4e-160, 5e-160), (1e150, -2e150, 3e150, 7e150),
                     (5e-324, 0, 0, 1), (-1.0000000000000002, 0.9999999999999999, 1, 1)):
            self.assertEqual(self.quat("--quat", numbers(quat)), list(quat))
            self.assertEqual(self.quat(f"--quat={numbers(quat)}"), list(quat))

    def test_the_length_of_an_axis_does_not_matter(self):
        for x, y, z in ((3, 1, 2), (1, 3, 2), (1, 2, -3), (1e-3, 2, 1)):
            for angle in (37, 120, 200.5, -1):
                turned = self.turned(numbers((x, y, z)), angle)
                for factor in (2.0**-1000, 2.0**-300, 2.0**300, 2.0**1000):
                    self.assertEqual(self.turned(numbers((x * factor, y * factor, z * factor)), angle), turned)

    def test_right_angles_are_exact(self):
        quarter = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        half = [[-1, 0, 0], [0, -1, 0], [0, 0, 1]]
        back = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
        for axis in ("0,0,1", "0,0,0.1", "0,0,1e300", "0,0,3e-310", "0,0,7"):
            for whole in (-720, -360, 0, 360, 3600):
                self.assertEqual(self.turned(axis, whole + 90), quarter)
                self.assertEqual(self.turned(axis, whole + 180), half)
                self.assertEqual(self.turned(axis, whole + 270), back)
        self.assertEqual(self.turned("0,0,-2", 90), back)
        self.assertEqual(self.turned("1,0,0", 90), [[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        self.assertEqual(self.turned("0,1,0", -90), [[0, 0, -1], [0, 1, 0], [1, 0, 0]])
        self.assertEqual(self.quat("--axis", "0,0,1", "--angle", "90"), [0, 0, 1, 1])
        self.assertEqual(self.quat("--axis", "0,0,1", "--angle", "180"), [0, 0, 1, 0])

    def test_thirds_and_halves_about_diagonals_are_exact(self):
        cycle = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
        other = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]
        self.assertEqual(self.turned("1,1,1", 120), cycle)
        self.assertEqual(self.turned("5,5,5", -240), cycle)
        self.assertEqual(self.turned("1,1,1", 240), other)
        self.assertEqual(self.turned("1,1,1", 60), rotation((1, 1, 1, 3)))
        self.assertEqual(self.turned("1,1,0", 180), [[0, 1, 0], [1, 0, 0], [0, 0, -1]])
        self.assertEqual(self.turned("3,4,0", 90), rotation((3, 4, 0, 5)))

    def test_other_angles_are_near_and_opposites_inverse(self):
        one = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        for angle in (1e-9, 0.5, 29.99, 44, 46, 89.9, 91, 100, 135.5, 179.999):
            there, back = self.turned("1,-2,3", angle), self.turned("1,-2,3", -angle)
            product = [[sum(there[i][k] * back[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
            self.assertEqual(product, one)
            x, y, z, w = self.quat("--axis=0,1,0", f"--angle={angle}")
            self.assertEqual((x, z), (0, 0))
            self.assertAlmostEqual(2 * math.degrees(math.atan2(y, w)), angle, delta=1e-12 * (1 + angle))


class Sum(CommandTest):
    POSES = ([], ["--quat=0.1,-0.2,0.3,0.9"], ["--quat", "-0.5,0.25,0,1e-9"], ["--axis", "0,0,1", "--angle", "90"],
             ["--axis", "1,1,1", "--angle", "120"])

    def test_walk_hull_and_object_write_the_same_bytes(self):
        for p, q in ((self.tetrahedron, self.pyramid), ("shape:cube", "shape:cube"),
                     (self.pyramid, "shape:icosahedron")):
            for pose in self.POSES:
                for extra in ([], ["--difference"]):
                    told = {}
                    for method in ("walk", "hull", "object"):
                        told[method] = self.data("sum", p, q, *pose, *extra, "--method", method, "--exact", "-o",
                                                 self.path / f"{method}.off")
                        self.assertEqual(told[method].pop("method"), method)
                        self.assertTrue(0 < told[method].pop("seconds") < 60)
                    for method in ("hull", "object"):
                        self.assertEqual(told["walk"], told[method])
                        self.assertEqual((self.path / "walk.off").read_bytes(),
                                         (self.path / f"{method}.off").read_bytes())

    def test_object_space_is_for_simple_bodies(self):
        self.bad("sum", "shape:geodesic?level=9", "shape:geodesic?level=9", "--method", "object",
                 says=["--method object", "1002 vertices", "2^32"])
        self.data("sum", "shape:geodesic?level=9", "shape:cube", "--method", "object")

    def test_counts_of_aligned_boxes(self):
        told = self.data("sum", "shape:cube", "shape:box?x=1&y=2&z=3")
        self.assertEqual([told[k] for k in ("vertices", "edges", "facets", "fv", "vf")], [8, 12, 6, 6, 6])
        turned = self.data("sum", "shape:cube", "shape:box?x=1&y=2&z=3", "--axis", "0,0,1", "--angle", "30")
        self.assertEqual([turned[k] for k in ("vertices", "edges", "facets")], [16, 24, 10])

    def test_euler_and_pair_counts(self):
        told = self.data("sum", self.tetrahedron, self.pyramid, "--quat", "0.3,0.1,-0.7,0.2")
        self.assertEqual(told["vertices"] - told["edges"] + told["facets"], 2)
        self.assertEqual(told["facets"], told["fv"] + told["vf"] + told["ee"])
        self.assertEqual([told["fv"], told["vf"]], [4, 5])

    def test_the_difference_of_a_body_with_itself_is_symmetric(self):
        told = self.data("sum", self.tetrahedron, self.tetrahedron, "--difference", "-o", self.path / "d.off")
        self.assertEqual([told["vertices"], told["facets"]], [12, 14])
        bounds = self.data("info", self.path / "d.off")["bounds"]
        self.assertEqual(bounds["low"], [-c for c in bounds["high"]])

    def test_written_doubles_read_back_as_the_same_sum(self):
        told = self.data("sum", self.tetrahedron, "shape:cube", "-o", self.path / "sum.off")
        self.assertEqual(self.data("info", self.path / "sum.off")["vertices"], told["vertices"])
        self.assertEqual(self.data("info", self.path / "sum.off")["bounds"], {"low": [-0.5] * 3, "high": [1.5] * 3})

    def test_counts_are_the_librarys(self):
        for p, q in ((self.tetrahedron, self.pyramid), ("shape:cube", "shape:cube"), (self.pyramid, "shape:gs2")):
            for quat in ((0, 0, 0, 1), (0, 0, 1, 1), (0.1, -0.2, 0.3, 0.7)):
                for difference in (0, 1):
                    library = self.answers("sum", p, q, quat=quat, difference=(difference,))
                    for method in ("walk", "cgm", "hull", "object"):
                        told = self.data("sum", p, q, f"--quat={numbers(quat)}", "--method", method,
                                         *["--difference"] * difference)
                        self.assertEqual([told[k] for k in ("vertices", "edges", "facets")], library["mesh"])
                        self.assertEqual([[told[k]] for k in ("fv", "vf", "ee")],
                                         [library[k] for k in ("fv", "vf", "ee")])
                        self.assertEqual((told["p"], told["q"], told["quat"]), (str(p), str(q), list(quat)))
                        self.assertEqual((told["difference"], told["method"]), (bool(difference), method))
                        self.assertTrue(0 < told["seconds"] < 60)

    def test_files_are_the_librarys(self):
        quat = (0.1, -0.2, 0.3, 0.7)
        for ending in (".off", ".svg", ".obj", ".stl", ".ply", ".OFF"):
            for exact in (0, 1) if ending == ".off" else (0,):
                ours, library = self.path / f"ours{ending}", self.path / f"library{ending}"
                args = ["sum", self.tetrahedron, "shape:gs2", f"--quat={numbers(quat)}", "-o", ours,
                        *["--exact"] * exact]
                self.good(*args)
                self.answers("sum", self.tetrahedron, "shape:gs2", quat=quat, exact=(exact,), o=library)
                self.assertEqual(ours.read_bytes(), library.read_bytes(), ending)

    def test_drawings_are_xml(self):
        self.good("sum", self.tetrahedron, "shape:cube", "-o", self.path / "sum.svg")
        self.assertTrue(ElementTree.parse(self.path / "sum.svg").getroot().tag.endswith("svg"))

    def test_text_holds_the_counts_and_the_file(self):
        text = self.good("sum", self.tetrahedron, "shape:cube", "-o", self.path / "sum.off")
        told = self.data("sum", self.tetrahedron, "shape:cube")
        for word in ("vertices", "edges", "facets"):
            self.assertRegex(text, rf"{word} +{told[word]}\n")
        self.assertIn(f"fv {told['fv']}, vf {told['vf']}, ee {told['ee']}", text)
        self.assertIn("sum.off", text)


if __name__ == "__main__":
    main()
