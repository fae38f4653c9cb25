#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the `pirouette` command and looks at its exit status, stdout and stderr: test_command.py COMMAND [CLASS]"""
import json
import math
import os
import pty
import select
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree
from fractions import Fraction
from pathlib import Path

COMMAND = ""

TETRAHEDRON = """OFF
4 4 6
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
"""
# a square pyramid with rational corners, and a point inside that is no corner of the hull
PYRAMID = """OFF # comment
6 0 0
-1/3 -1/3 0
1/3 -1/3 0
1/3 1/3 0
-1/3 1/3 0
1/7 -1/11 5/7
0 0 1/5
"""


def rotation(quat):
    """The exact matrix of a quaternion of doubles."""
    x, y, z, w = (Fraction(c) for c in quat)
    n = x * x + y * y + z * z + w * w
    return [
        [1 - 2 * (y * y + z * z) / n, 2 * (x * y - z * w) / n, 2 * (x * z + y * w) / n],
        [2 * (x * y + z * w) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - x * w) / n],
        [2 * (x * z - y * w) / n, 2 * (y * z + x * w) / n, 1 - 2 * (x * x + y * y) / n],
    ]


def numbers(values):
    return ",".join(repr(float(v)) for v in values)


def read_terminal(terminal, seconds):
    """What comes from a terminal's other side within so many seconds; nothing when that side is closed."""
    if not select.select([terminal], [], [], seconds)[0]:
        return b""
    try:
        return os.read(terminal, 4096)
    except OSError:
        return b""  # how Linux tells that the other side is closed


class CommandTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)
        self.tetrahedron = self.file("tetrahedron.off", TETRAHEDRON)
        self.pyramid = self.file("pyramid.off", PYRAMID)

    def file(self, name, text):
        path = self.path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def run_command(self, *args):
        return subprocess.run([COMMAND, *map(str, args)], capture_output=True, text=True, timeout=60)

    def good(self, *args):
        """stdout of a run that must succeed, with nothing on stderr."""
        done = self.run_command(*args)
        self.assertEqual((done.returncode, done.stderr), (0, ""), args)
        return done.stdout

    def data(self, *args):
        return json.loads(self.good(*args, "--json"))

    def bad(self, *args, says=()):
        """A run that must end with status 2 and one line on stderr, which holds every word of `says`."""
        done = self.run_command(*args)
        self.assertEqual(done.returncode, 2, (args, done.stdout, done.stderr))
        self.assertEqual(done.stdout, "", args)
        self.assertTrue(done.stderr.startswith("pirouette: "), (args, done.stderr))
        self.assertTrue(done.stderr.endswith("\n"), args)
        self.assertEqual(done.stderr.count("\n"), 1, (args, done.stderr))
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, done.stderr, args)


class Usage(CommandTest):
    def test_help_and_version_go_to_stdout(self):
        help_text = self.good("--help")
        for name in ("info", "shape", "sum", "track"):
            self.assertIn(name, help_text)
            self.assertTrue(self.good(name, "--help").startswith(f"usage: pirouette {name}"))
        self.assertRegex(self.good("--version"), r"^pirouette \d+\.\d+\.\d+\n$")

    def test_help_names_every_option(self):
        for option in ("--quat", "--axis", "--angle", "--difference", "--method", "--exact", "-o", "--json", "--help"):
            self.assertIn(option, self.good("sum", "--help"))
        for option in ("--steps", "--frames", "--axis", "--seed", "--method", "--verify", "--verify-every", "--brute",
                       "--dump", "--every", "--plot", "--json", "--help"):
            self.assertIn(option, self.good("track", "--help"))

    def test_no_subcommand_or_an_unknown_one(self):
        self.bad(says="usage")
        self.bad("spin", says="'spin'")
        self.bad("--spin", says="'--spin'")
        self.bad("", says="''")

    def test_too_few_and_too_many_arguments(self):
        self.bad("info", says="MODEL is missing")
        self.bad("sum", self.tetrahedron, says="Q is missing")
        self.bad("track", says="P is missing")
        self.bad("info", self.tetrahedron, "more", says="'more'")

    def test_options_that_do_not_exist_or_lack_their_value(self):
        self.bad("info", self.tetrahedron, "--jsn", says="'--jsn'")
        self.bad("info", self.tetrahedron, "--json=1", says="--json")
        self.bad("sum", "a", "b", "-x", says="'-x'")
        self.bad("sum", "a", "b", "--quat", says="--quat")
        self.bad("track", "a", "b", "--steps", says="--steps")
        self.bad("sum", "a", "b", "--step=3", says="'--step=3'")

    def test_words_behind_two_dashes_are_no_options(self):
        self.bad("info", "--", "--json", says="--json")
        self.bad("info", "--", "-nothing.off", says="-nothing.off")

    def test_a_complaint_is_one_line_whatever_is_in_it(self):
        self.bad("info", "no\nsuch\rfile.off")
        self.bad("sp\nin")
        self.bad("info", "x" * 5000)


class BadNumbers(CommandTest):
    def test_quaternions(self):
        for text in ("1,2,x,4", "1,2,3", "1,2,3,4,5", "", ",,,", "nan,0,0,1", "inf,0,0,1", "1e999,0,0,1", "0,0,0,0",
                     "-0.0,0,0,0", "1 ,0,0,0", " 1,0,0,0", "1;0;0;0", "1,0,0,0,", "9" * 200 + ",0,0,1"):
            for form in (["--quat", text], [f"--quat={text}"]):
                self.bad("sum", self.tetrahedron, self.pyramid, *form, says="--quat")

    def test_axes_and_angles(self):
        for axis in ("0,0,0", "1,0", "x,y,z", "nan,1,0", "random"):
            self.bad("sum", self.tetrahedron, self.pyramid, "--axis", axis, "--angle", "90", says="--axis")
        for angle in ("", "ninety", "nan", "inf", "-inf", "1,2", "90deg"):
            self.bad("sum", self.tetrahedron, self.pyramid, "--axis=0,0,1", f"--angle={angle}", says="--angle")
        for axis in ("0,0,0", "1,0", "x,y,z", "nan,1,0", "Random"):
            self.bad("track", self.tetrahedron, self.pyramid, "--axis", axis, says="--axis")

    def test_two_rotations_or_half_of_one(self):
        pair = ["sum", self.tetrahedron, self.pyramid]
        self.bad(*pair, "--quat", "0,0,0,1", "--axis", "0,0,1", "--angle", "3", says=["--quat", "--axis"])
        self.bad(*pair, "--quat", "0,0,0,1", "--angle", "3", says=["--quat", "--angle"])
        self.bad(*pair, "--axis", "0,0,1", says="--angle")
        self.bad(*pair, "--angle", "5", says="--axis")

    def test_counts(self):
        for option in ("--steps", "--frames", "--verify-every"):
            for text in ("0", "-1", "1.5", "", "1e3", "0x10", "many", "99999999999999999999999", " 5"):
                self.bad("track", self.tetrahedron, self.pyramid, f"{option}={text}", says=option)
        for text in ("-1", "x", "99999999999999999999999"):
            self.bad("track", self.tetrahedron, self.pyramid, "--seed", text, says="--seed")
        self.bad("track", self.tetrahedron, self.pyramid, "--dump", self.path / "d", "--every", "0", says="--every")
        self.assertFalse((self.path / "d").exists())

    def test_methods(self):
        self.bad("sum", self.tetrahedron, self.pyramid, "--method", "magic", says=["'magic'", "walk", "hull"])
        self.bad("track", self.tetrahedron, self.pyramid, "--method", "hull", says=["'hull'", "auto", "update", "walk"])


class BadModels(CommandTest):
    def test_files_that_are_no_models(self):
        broken = {
            "empty.off": "",
            "word.off": "hello",
            "truncated.off": TETRAHEDRON[:30],
            "lying.off": TETRAHEDRON.replace("4 4 6", "9 4 6"),
            "open.off": TETRAHEDRON.replace("4 4 6", "4 3 6").replace("3 1 2 3\n", ""),
            "far.off": TETRAHEDRON.replace("3 1 2 3", "3 1 2 77"),
            "nan.off": TETRAHEDRON.replace("1 0 0", "nan 0 0"),
            "zero.off": TETRAHEDRON.replace("1 0 0", "1/0 0 0"),
            "binary.off": bytes(range(256)) * 40,
            "model.txt": TETRAHEDRON,
            "plain": TETRAHEDRON,
        }
        for name, text in broken.items():
            path = self.file(name, text)
            self.bad("info", path, says=name)
            self.bad("sum", self.tetrahedron, path, says=name)
            self.bad("track", path, self.tetrahedron, says=name)

    def test_files_that_are_not_there(self):
        self.bad("info", self.path / "none.off", says="none.off")
        self.bad("info", "", says="")
        (self.path / "folder.off").mkdir()
        self.bad("info", self.path / "folder.off", says="folder.off")

    def test_shapes_that_do_not_exist(self):
        for name in ("shape:", "shape:cub", "shape:cube?", "shape:cube?size=nan", "shape:box?x=0", "shape:box?x=-1",
                     "shape:box?x", "shape:geodesic?level=1e9"):
            self.bad("info", name)
            self.bad("sum", "shape:cube", name)


class BadOutputs(CommandTest):
    def leaves_nothing(self, before):
        self.assertEqual(sorted(os.listdir(self.path)), before)

    def test_files_that_cannot_be_written(self):
        before = sorted(os.listdir(self.path))
        pair = [self.tetrahedron, self.pyramid]
        self.bad("sum", *pair, "-o", self.path / "none" / "sum.off", says="sum.off")
        self.bad("sum", *pair, "-o", self.path / "sum.xyz", says="sum.xyz")
        self.bad("sum", *pair, "--exact", "-o", self.path / "sum.svg", says="sum.svg")
        self.bad("shape", "cube", "-o", self.path / "none" / "cube.off", says="cube.off")
        self.bad("shape", "cube", "-o", "", says="")
        self.bad("track", *pair, "--plot", self.path / "none" / "plot.svg", says="plot.svg")
        self.bad("track", *pair, "--plot", self.path / "plot.png", says=["plot.png", ".svg"])
        self.bad("track", *pair, "--dump", self.path / "none" / "dump", says="dump")
        self.bad("track", *pair, "--dump", self.tetrahedron, says="tetrahedron.off")
        self.bad("track", *pair, "--every", "5", says="--dump")
        self.leaves_nothing(before)

    def test_a_plot_over_a_folder_leaves_no_other_file(self):
        (self.path / "plot.svg").mkdir()
        before = sorted(os.listdir(self.path))
        self.bad("track", self.tetrahedron, self.pyramid, "--frames", "3", "--plot", self.path / "plot.svg",
                 says="plot.svg")
        self.leaves_nothing(before)

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full here")
    def test_a_full_device(self):
        for args in (["info", "shape:cube"], ["info", "shape:cube", "--json"], ["--help"], ["sum", "--help"],
                     ["track", "shape:cube", "shape:cube", "--frames", "2"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([COMMAND, *args], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
            self.assertEqual(done.returncode, 2, args)
            self.assertRegex(done.stderr, r"^pirouette: standard output: [^\n]+\n$")

    def test_a_reader_that_went_away(self):
        reader, writer = os.pipe()
        os.close(reader)
        with os.fdopen(writer, "w") as pipe:
            done = subprocess.run([COMMAND, "shape", "--list"], stdout=pipe, stderr=subprocess.PIPE, text=True,
                                  timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^pirouette: standard output: [^\n]+\n$")


class Info(CommandTest):
    def test_counts_bounds_and_volume(self):
        self.assertEqual(self.data("info", "shape:box?x=1&y=2&z=0.5"), {
            "model": "shape:box?x=1&y=2&z=0.5", "dimension": 3, "vertices": 8, "edges": 12, "facets": 6,
            "bounds": {"low": [-0.5, -1, -0.25], "high": [0.5, 1, 0.25]}, "volume": 1,
        })
        pyramid = self.data("info", self.pyramid)
        self.assertEqual([pyramid[k] for k in ("dimension", "vertices", "edges", "facets")], [3, 5, 8, 5])
        self.assertEqual(pyramid["bounds"]["low"], [-1 / 3, -1 / 3, 0])
        self.assertEqual(pyramid["bounds"]["high"], [1 / 3, 1 / 3, 5 / 7])
        self.assertAlmostEqual(pyramid["volume"], 4 / 9 * 5 / 7 / 3, places=14)

    def test_flat_bodies(self):
        for name, text, counts in (
                ("square.off", "OFF\n4 0 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n", [2, 4, 4, 2]),
                ("segment.off", "OFF\n3 0 0\n0 0 0\n1 1 1\n2 2 2\n", [1, 2, 1, 0]),
                ("point.off", "OFF\n2 0 0\n3 4 5\n3 4 5\n", [0, 1, 0, 0])):
            told = self.data("info", self.file(name, text))
            self.assertEqual([told[k] for k in ("dimension", "vertices", "edges", "facets")], counts)
            self.assertEqual(told["volume"], 0)

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

    def test_what_is_missing_is_said(self):
        self.bad("shape", "cube", says="-o")
        self.bad("shape", "-o", self.path / "x.off", says="NAME")
        self.bad("shape", "cube", "--list", says="--list")
        self.bad("shape", "sphinx", "-o", self.path / "x.off", says="sphinx")
        self.assertFalse((self.path / "x.off").exists())


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

    def test_walk_and_hull_write_the_same_bytes(self):
        for p, q in ((self.tetrahedron, self.pyramid), ("shape:cube", "shape:cube"), (self.pyramid, "shape:icosahedron")):
            for pose in self.POSES:
                for extra in ([], ["--difference"]):
                    told = {}
                    for method in ("walk", "hull"):
                        told[method] = self.data("sum", p, q, *pose, *extra, "--method", method, "--exact", "-o",
                                                 self.path / f"{method}.off")
                        self.assertEqual(told[method].pop("method"), method)
                        self.assertGreater(told[method].pop("seconds"), 0)
                    self.assertEqual(told["walk"], told["hull"])
                    self.assertEqual((self.path / "walk.off").read_bytes(), (self.path / "hull.off").read_bytes())

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


class Track(CommandTest):
    def test_defaults_and_fields(self):
        told = self.data("track", self.tetrahedron, self.pyramid)
        self.assertEqual([told[k] for k in ("frames", "steps", "axis", "seed", "method")], [1000, 500, "random", 1, "auto"])
        for key in ("rebuild_walk_ns", "speedup_walk", "checked_per_frame", "repaired_per_frame"):
            self.assertGreater(told[key], 0, key)
        self.assertLessEqual(told["update_ns"]["median"], told["update_ns"]["p99"])
        self.assertLessEqual(told["update_ns"]["p99"], told["update_ns"]["max"])
        self.assertAlmostEqual(told["speedup_walk"], told["rebuild_walk_ns"] / told["update_ns"]["median"])
        self.assertEqual(told["updates"] + told["rebuilds"], 1000)
        self.assertEqual(told["allocations"], 0)
        self.assertAlmostEqual(sum(told["signs"][k] for k in ("filter", "exact", "perturbation")), 1)
        # what was not asked for was not found out
        self.assertEqual([told[k] for k in ("brute_ns", "mismatches")], [None] * 2)
        self.assertGreater(told["rebuild_cgm_ns"], 0)
        self.assertGreater(told["speedup_cgm"], 0)
        self.assertEqual(told["verified"], 0)

    def test_every_frame_equals_a_rebuild(self):
        for axis in ("0,0,1", "1,1,1", "-1,2,0.5", "random"):
            for steps in (1, 3, 8, 12, 100):
                for pair in ((self.tetrahedron, self.pyramid), ("shape:cube", "shape:cube")):
                    told = self.data("track", *pair, f"--axis={axis}", "--steps", steps, "--frames=60", "--verify")
                    self.assertEqual([told["mismatches"], told["verified"]], [0, 60])

    def test_region_is_kept_and_verified(self):
        for region in ("0,0,1,30", "-1,2,0.5,5", "1,0,0,120", "0,1,0,0"):
            told = self.data("track", "shape:gs4", self.pyramid, "--frames=80", "--verify", f"--region={region}")
            self.assertEqual([told["mismatches"], told["verified"]], [0, 80])
            self.assertEqual(told["region"] + [told["region_degrees"]], [float(x) for x in region.split(",")])
        part = self.data("track", "shape:gs4", "shape:gs4", "--frames=80", "--region=0,0,1,30")
        whole = self.data("track", "shape:gs4", "shape:gs4", "--frames=80", "--region=0,0,1,180")
        self.assertLess(part["checked_per_frame"], whole["checked_per_frame"] / 3)
        self.assertNotIn("region", whole)
        self.assertIn("within 30 degrees of 0,0,1",
                      self.good("track", self.pyramid, self.pyramid, "--frames=5", "--region=0,0,1,30"))
        for bad in ("0,0,1", "0,0,0,30", "0,0,1,181", "0,0,1,-1", "0,0,1,nan", "x"):
            self.bad("track", self.pyramid, self.pyramid, f"--region={bad}", says="--region")

    def test_methods_do_what_they_say(self):
        pair = ["track", self.tetrahedron, self.pyramid, "--frames", "50", "--method"]
        self.assertEqual([self.data(*pair, "update")[k] for k in ("updates", "rebuilds")], [50, 0])
        self.assertEqual([self.data(*pair, "walk")[k] for k in ("updates", "rebuilds")], [0, 50])

    def test_verify_every_and_brute_force(self):
        told = self.data("track", self.tetrahedron, self.pyramid, "--frames", "100", "--verify-every", "30", "--brute")
        self.assertEqual([told["verified"], told["mismatches"]], [4, 0])
        self.assertGreater(told["brute_ns"], 0)

    def test_text_holds_the_figures(self):
        text = self.good("track", self.tetrahedron, self.pyramid, "--frames", "40", "--brute", "--verify")
        for word in ("40 frames", "500 steps", "method auto", "update", "median", "rebuild by walk", "brute force",
                     "pairs checked", "pairs repaired", "rebuilds", "allocations", "signs"):
            self.assertIn(word, text)
        self.assertRegex(text, r"verified +40 frames, 0 differ")

    def test_one_frame(self):
        self.assertEqual(self.data("track", "shape:cube", self.pyramid, "--frames", "1", "--verify")["mismatches"], 0)


class Frames(CommandTest):
    def dump(self, name, *args):
        folder = self.path / name
        self.good("track", *args, "--dump", folder)
        frames = json.loads((folder / "frames.json").read_text())["frames"]
        self.assertEqual(sorted(p.name for p in folder.iterdir()), sorted([f["file"] for f in frames] + ["frames.json"]))
        return [(f["index"], f["quat"], (folder / f["file"]).read_bytes()) for f in frames]

    def test_every_kth_frame_from_the_first(self):
        frames = self.dump("a", self.tetrahedron, self.pyramid, "--frames", "25", "--every", "10")
        self.assertEqual([f[0] for f in frames], [0, 10, 20])
        self.assertEqual(len(self.dump("b", self.tetrahedron, self.pyramid, "--frames", "7")), 7)

    def test_a_frame_is_the_exact_sum_at_its_quaternion(self):
        for axis in ("random", "0.3,-0.1,2"):
            for index, quat, text in self.dump(axis, self.tetrahedron, self.pyramid, "--axis", axis, "--frames", "160",
                                               "--every", "53"):
                self.good("sum", self.tetrahedron, self.pyramid, f"--quat={numbers(quat)}", "--method", "hull", "--exact",
                          "-o", self.path / "sum.off")
                self.assertEqual((self.path / "sum.off").read_bytes(), text, index)

    def test_aligned_boxes_recur_exactly(self):
        box = "shape:box?x=1&y=1&z=2"
        frames = self.dump("a", box, box, "--axis", "0,0,1", "--steps", "360", "--frames", "721", "--every", "90")
        turns = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
                 [[-1, 0, 0], [0, -1, 0], [0, 0, 1]], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
        for k, (index, quat, text) in enumerate(frames):
            self.assertEqual(rotation(quat), turns[k % 4], index)
            self.assertTrue(text.startswith(b"OFF\n8 6 12\n"), index)
        thirds = self.dump("b", "shape:cube", "shape:cube", "--axis=1,1,1", "--steps=300", "--frames=301", "--every=100")
        for index, quat, text in thirds:
            self.assertTrue(text.startswith(b"OFF\n8 6 12\n"), index)
            self.assertEqual({abs(c) for row in rotation(quat) for c in row}, {0, 1}, index)

    def test_steps_are_equal_turns(self):
        for index, (x, y, z, w), _ in self.dump("a", self.tetrahedron, self.pyramid, "--axis=0,0,3", "--steps=7",
                                                "--frames", "20"):
            turn = 2 * math.atan2(z, w) / (2 * math.pi)
            self.assertAlmostEqual((turn - index / 7 + 0.5) % 1, 0.5, places=12)

    def test_random_axes_change_after_fifty_frames_and_follow_the_seed(self):
        args = [self.tetrahedron, self.pyramid, "--frames", "120", "--steps", "90"]
        first = self.dump("a", *args)
        self.assertEqual(first, self.dump("b", *args, "--seed", "1"))
        self.assertNotEqual(first, self.dump("c", *args, "--seed", "2"))
        self.assertEqual(rotation(first[0][1]), [[1, 0, 0], [0, 1, 0], [0, 0, 1]])

        def step(i):
            # the axis of the turn from frame i - 1 to frame i
            x, y, z, w = first[i][1]
            a, b, c, d = (-first[i - 1][1][0], -first[i - 1][1][1], -first[i - 1][1][2], first[i - 1][1][3])
            axis = (w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a, w * c + x * b - y * a + z * d)
            size = sum(v * v for v in axis) ** 0.5
            return [v / size for v in axis]

        same = lambda i, j: sum(abs(a - b) for a, b in zip(step(i), step(j))) < 1e-9
        self.assertTrue(same(1, 49) and same(50, 99) and same(100, 119))
        self.assertFalse(same(49, 50) or same(99, 100))

    def test_frames_do_not_depend_on_the_method(self):
        args = [self.pyramid, "shape:icosahedron", "--frames", "90", "--steps", "40", "--every", "9", "--method"]
        auto = self.dump("a", *args, "auto")
        self.assertEqual(auto, self.dump("b", *args, "update"))
        self.assertEqual(auto, self.dump("c", *args, "walk"))


class Plot(CommandTest):
    def plot(self, *args):
        file = self.path / "plot.svg"
        self.good("track", *args, "--plot", file)
        root = ElementTree.parse(file).getroot()
        words = " | ".join("".join(e.itertext()) for e in root.iter() if e.tag.endswith("text"))
        for path in (e for e in root.iter() if e.tag.endswith("path")):
            self.assertNotRegex(path.get("d"), "nan|inf")
        return file.read_text(), words

    def test_title_axes_and_legend(self):
        _, words = self.plot(self.tetrahedron, self.pyramid, "--frames", "90", "--steps", "70", "--brute")
        for word in ("tetrahedron.off", "pyramid.off", "70 steps", "90 frames", "method auto", "frame", "µs", "tracked sum, median",
                     "rebuild by walk, median", "brute-force re-check, median"):
            self.assertIn(word, words)
        self.assertNotIn("brute", self.plot(self.tetrahedron, self.pyramid, "--frames", "90")[1])

    def test_one_frame_and_many(self):
        self.plot(self.tetrahedron, self.pyramid, "--frames", "1")
        few, _ = self.plot(self.tetrahedron, self.pyramid, "--frames", "400")
        many, words = self.plot(self.tetrahedron, self.pyramid, "--frames", "20000")
        self.assertIn("50 frames", words)
        self.assertLess(len(many), 2 * len(few))

    def test_names_that_xml_must_escape(self):
        name = self.file("a<b & c>.off", TETRAHEDRON)
        self.assertIn("a<b & c>.off", self.plot(name, self.pyramid, "--frames", "3")[1])


class Terminal(CommandTest):
    def open_terminal(self):
        try:
            master, slave = pty.openpty()
        except OSError:
            self.skipTest("no pseudo-terminal to be had here")
        self.addCleanup(os.close, master)
        return master, slave

    def test_a_long_run_shows_its_progress_on_a_terminal_only(self):
        master, slave = self.open_terminal()
        started = time.monotonic()
        running = subprocess.Popen([COMMAND, "track", "shape:icosahedron", self.pyramid, "--frames", "5000000"],
                                   stdout=subprocess.DEVNULL, stderr=slave)
        os.close(slave)
        shown = b""
        while b"\r[" not in shown and time.monotonic() - started < 30 and running.poll() is None:
            shown += read_terminal(master, 1)
        waited = time.monotonic() - started
        running.terminate()
        running.wait()
        self.assertIn(b"of 5000000", shown)
        self.assertGreater(waited, 0.9)

    def test_a_short_run_shows_nothing(self):
        master, slave = self.open_terminal()
        done = subprocess.run([COMMAND, "track", "shape:cube", self.pyramid, "--frames", "5"], stdout=subprocess.PIPE,
                              stderr=slave, timeout=60)
        os.close(slave)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(read_terminal(master, 0), b"")


if __name__ == "__main__":
    COMMAND = sys.argv.pop(1)
    unittest.main()
