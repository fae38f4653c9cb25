#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette info --solid, sum --solid, track --solid, query --solid and decompose."""
import json
import subprocess

from command_test import CommandTest, main

# an L, 1 thick: 12 vertices, 8 facets, a reflex edge
CORNERS = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]


def prism(facets=None):
    points = [(x, y, z) for z in (0, 1) for x, y in CORNERS]
    loops = [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11]] + [[i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6] for i in range(6)]
    loops = loops if facets is None else facets(loops)
    lines = [f"{x} {y} {z}" for x, y, z in points] + [" ".join(map(str, [len(f), *f])) for f in loops]
    return "\n".join([f"OFF\n{len(points)} {len(loops)} 0", *lines]) + "\n"


class Solid(CommandTest):
    def test_info_counts_what_the_hull_hides(self):
        told = self.data("info", self.file("l.off", prism()), "--solid")
        keys = ("vertices", "edges", "facets", "reflex_edges", "shells", "genus", "volume")
        self.assertEqual([told[k] for k in keys], [12, 18, 8, 1, 1, 0, 5])
        self.assertIn("1 of them reflex", self.good("info", self.file("l.off", prism()), "--solid"))

    def test_sum_of_solids_is_not_that_of_their_hulls(self):
        model, out = self.file("l.off", prism()), self.path / "sum.off"
        told = self.data("sum", model, "shape:cube", "--solid", "--exact", "-o", out)
        self.assertEqual([told[k] for k in ("vertices", "edges", "facets", "pieces")], [12, 18, 8, [2, 1]])
        again = self.data("info", out, "--solid")
        self.assertEqual((again["reflex_edges"], again["facets"]), (1, 8))
        turned = self.data("sum", model, model, "--solid", "--quat", "0,0,1,1", "--difference")
        self.assertTrue(turned["solid"] and turned["difference"])

    def test_open_solids_leave_tight_passages_out(self):
        # a block with a square hole, through which the cube passes
        ring = [(0, 0), (3, 0), (3, 3), (0, 3)], [(1, 1), (2, 1), (2, 2), (1, 2)]
        points = [(x, y, z) for z in (0, 1) for loop in ring for x, y in loop]
        sides = [[i, (i + 1) % 4, (i + 1) % 4 + 8, i + 8] for i in range(4)]
        holes = [[(i + 1) % 4 + 4, i + 4, i + 12, (i + 1) % 4 + 12] for i in range(4)]
        tops = [[i + 8, (i + 1) % 4 + 8, (i + 1) % 4 + 12, i + 12] for i in range(4)]
        loops = sides + holes + tops + [[i - 8 for i in f[::-1]] for f in tops]
        lines = ["OFF\n16 16 0", *(f"{x} {y} {z}" for x, y, z in points)]
        lines += [" ".join(map(str, [4, *f])) for f in loops]
        model, out = self.file("frame.off", "\n".join(lines) + "\n"), self.path / "open.off"
        told = self.data("sum", model, "shape:box?x=1&y=1&z=1", "--solid", "--open", "-o", out)
        keys = ("vertices", "edges", "facets", "two_sided", "segments", "points")
        self.assertEqual([told[k] for k in keys], [10, 13, 6, 0, 1, 0])
        self.assertIn("# segment 8 9", out.read_text())
        self.assertEqual(self.data("sum", model, "shape:box?x=1&y=1&z=1", "--solid")["facets"], 6)
        self.bad("sum", model, model, "--open", says="give --solid as well")

    def test_frames_of_a_tracked_sum_are_the_sums_at_their_rotations(self):
        model, folder = self.file("l.off", prism()), self.path / "frames"
        told = self.data("track", model, "shape:box?x=1&y=2&z=1", "--solid", "--frames", "7", "--steps", "12",
                         "--verify-every", "2", "--dump", folder, "--every", "3", "--exact", "--difference")
        self.assertEqual([told[k] for k in ("frames", "verified", "mismatches", "dumped", "solid", "open")],
                         [7, 4, 0, 3, True, False])
        frames = json.loads((folder / "frames.json").read_text())["frames"]
        self.assertEqual([f["index"] for f in frames], [0, 3, 6])
        out = self.path / "sum.off"
        for frame in frames:
            quat = ",".join(map(repr, frame["quat"]))
            self.data("sum", model, "shape:box?x=1&y=2&z=1", "--solid", "--difference", f"--quat={quat}", "--exact",
                      "-o", out)
            self.assertEqual(out.read_text(), (folder / frame["file"]).read_text())
        self.assertIn("0 differ from a sum made anew", self.good("track", model, model, "--solid", "--open", "--frames",
                                                               "2", "--verify"))
        self.bad("track", model, model, "--open", says="give --solid as well")
        self.bad("track", model, model, "--solid", "--tolerance", "1", says="--tolerance is for hulls")
        self.bad("track", model, model, "--solid", "--method", "walk", says="--method")
        self.bad("track", model, model, "--method", "rebuild", says="--method")
        for method in "auto", "update", "rebuild":
            told = self.data("track", model, model, "--solid", "--frames", "9", "--steps", "5000", "--verify",
                             "--method", method)
            self.assertEqual((told["method"], told["verified"], told["mismatches"]), (method, 9, 0))

    def test_what_a_sum_writes_is_a_solid_again(self):
        # a ring round a hole, of unit cells, and cells that touch along an edge
        boxes = [(x, y) for x in range(3) for y in range(3) if (x, y) != (1, 1)] + [(3, 3)]
        lines, loops = [], []
        for x, y in boxes:
            at = len(lines)
            lines += [f"{x + (k & 1)} {y + (k >> 1 & 1)} {k >> 2}" for k in range(8)]
            for dx, dy, loop in ((-1, 0, (0, 4, 6, 2)), (1, 0, (1, 3, 7, 5)), (0, -1, (0, 1, 5, 4)),
                                 (0, 1, (2, 6, 7, 3)), (9, 9, (0, 2, 3, 1)), (9, 9, (4, 5, 7, 6))):
                if (x + dx, y + dy) not in boxes:
                    loops.append([4, *(at + k for k in loop)])
        text = [f"OFF\n{len(lines)} {len(loops)} 0", *lines, *(" ".join(map(str, f)) for f in loops)]
        model, out, more = self.file("ring.off", "\n".join(text) + "\n"), self.path / "a.off", self.path / "b.off"
        self.assertEqual([self.data("info", model, "--solid")[k] for k in ("volume", "shells")], [9, 2])
        small = "shape:box?x=0.25&y=0.25&z=0.25"
        self.assertEqual(self.data("sum", model, small, "--solid", "-o", out)["holes"], 2)
        told = self.data("info", out, "--solid")
        self.assertEqual([told[k] for k in ("volume", "genus")], [1.25 * (3.25**2 - 0.75**2 + 1.25**2 - 0.25**2), 1])
        self.data("sum", out, model, "--solid", "--quat", "1,2,3,4", "-o", more)
        self.assertIn("/", more.read_text())
        again = self.data("info", more, "--solid")
        self.assertEqual(self.data("decompose", more, "-o", self.path / "pieces")["pieces"] > 1, True)
        volume = sum(self.data("info", p)["volume"] for p in sorted((self.path / "pieces").iterdir()))
        self.assertAlmostEqual(volume, again["volume"], delta=1e-9)
        self.data("sum", more, small, "--solid")

    def test_query_of_solids_is_not_that_of_their_hulls(self):
        model, cube = self.file("l.off", prism()), "shape:box?x=1&y=1&z=1"
        told = self.data("query", cube, model, "--solid", "--translate", "2,2,0.5", "--cast=-2,0,0")
        self.assertEqual((told["state"], told["distance"], told["pieces"]), ("outside", 0.5, [1, 2]))
        self.assertAlmostEqual(told["cast"]["time"], 0.25, delta=1e-5)
        self.assertEqual(self.data("query", cube, model, "--translate", "2,2,0.5")["state"], "inside")
        self.assertEqual(self.data("query", cube, model, "--solid", "--translate", "1.5,1.5,0")["state"], "boundary")
        self.assertIn("inside", self.good("query", cube, model, "--solid", "--translate", "0.25,0.25,0"))
        self.bad("query", cube, model, "--solid", "--translate", "1,1,0", "--direction", "1,0,0", says="not for solids")

    def test_depth_of_solids_is_not_that_of_a_pair_of_pieces(self):
        # an L of three unit squares; a unit cube in its corner leaves by the notch, or by the nearest side
        model, cube = self.file("l.off", prism()), "shape:box?x=1&y=1&z=1"
        told = self.data("query", cube, model, "--solid", "--translate", "0.25,0.25,0.125")
        depth = told["penetration"]
        self.assertEqual(told["state"], "inside")
        self.assertEqual(told["normal"], depth["normal"])
        moved = ",".join(repr(x + depth["depth"] * n) for x, n in zip((0.25, 0.25, 0.125), depth["normal"]))
        self.assertEqual(self.data("query", cube, model, "--solid", "--translate", moved)["state"], "boundary")
        self.assertIn(depth["facets"], (1, 2, 3))
        self.assertIn("depth", self.good("query", cube, model, "--solid", "--translate", "0.25,0.25,0.125"))

    def test_text_says_what_json_does(self):
        model, cube = self.file("l.off", prism()), "shape:box?x=1&y=1&z=1"
        text = self.good("query", cube, model, "--solid", "--translate", "2,2,0.5", "--cast=-2,0,0")
        for part in ("outside", "distance     0.5", "normal       1, 0, 0", "cast         hit, time 0.2",
                     "1 of P, 2 of Q"):
            self.assertIn(part, text)
        text = self.good("query", cube, model, "--solid", "--translate", "2,2,0.5", "--cast=2,0,0")
        self.assertIn("cast         miss", text)
        text = self.good("sum", model, cube, "--solid", "--open")
        self.assertIn("left out   0 two-sided facets, 0 segments, 0 points", text)

    def test_a_solid_comes_on_stdin(self):
        def run(text):
            return subprocess.run([self.command, "info", "-", "--solid"], input=text, text=True, capture_output=True,
                                  check=False)

        done = run(prism())
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("1 of them reflex", done.stdout)
        done = run(prism(lambda f: f[:-1]))
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, r"^pirouette: standard input:15: the surface is open.*\n$")
        self.assertEqual(done.stderr.count("\n"), 1)

    def test_decompose_makes_fewer_pieces_when_asked(self):
        model = self.file("l.off", prism())
        for method in ("facets", "walls"):
            told = self.data("decompose", model, "--method", method)
            self.assertEqual((told["method"], told["pieces"], told["exact_pieces"], told["error"]), (method, 2, 2, 0))
        for option, value in (("--pieces", 1), ("--tolerance", 10)):
            told = self.data("decompose", model, option, value)
            self.assertEqual((told["pieces"], told["exact_pieces"]), (1, 2))
            self.assertGreater(told["error"], 0.1)
            self.assertIn(" of the solid, for 2 exact pieces", self.good("decompose", model, option, value))
        self.assertEqual(self.data("decompose", model, "--tolerance", 1e-3)["pieces"], 2)
        for option, value, says in (("--method", "saw", "saw"), ("--pieces", 0, "--pieces"), ("--pieces", "x", "--pi"),
                                    ("--tolerance", -1, "a length of 0 or more"), ("--tolerance", "nan", "--tol")):
            self.bad("decompose", model, option, value, says=says)

    def test_decompose_writes_a_piece_each(self):
        model = self.file("l.off", prism())
        self.assertEqual(self.data("decompose", model, "-o", self.path / "pieces")["pieces"], 2)
        volumes = [self.data("info", self.path / f"pieces/piece-{k:06}.off")["volume"] for k in range(2)]
        self.assertEqual(sum(volumes), 5)
        self.good("decompose", model, "-o", self.path / "pieces.obj")
        with open(self.path / "pieces.obj", encoding="utf-8") as file:
            self.assertEqual(sum(line.startswith("o ") for line in file), 2)

    def test_what_is_no_solid_is_refused_with_its_place(self):
        for name, change, text in (
                ("open", lambda f: f[:-1], "bad.off:15: the surface is open"),
                ("inside out", lambda f: [g[::-1] for g in f], "inside out"),
                ("doubled", lambda f: f + [f[0]], "is on 3 facets"),
                ("turned", lambda f: f[:-1] + [f[-1][::-1]], "the same way")):
            with self.subTest(name):
                self.bad("sum", self.file("bad.off", prism(change)), "shape:cube", "--solid", says=text)

    def test_what_is_about_hulls_is_refused(self):
        model = self.file("l.off", prism())
        self.bad("info", model, "--solid", "--merge", "1", says="--merge is for hulls")
        self.bad("sum", model, model, "--solid", "--method", "walk", says="--method is for hulls")
        self.bad("sum", model, model, "--solid", "-o", "sum.stl", says="does not end in .off")


if __name__ == "__main__":
    main()
