#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette track: figures, frames, charts, progress."""
import json
import math
import os
import re
import subprocess
import time
import xml.etree.ElementTree as ElementTree
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from command_test import CommandTest, TETRAHEDRON, main, numbers, read_terminal, rotation, with_own_signals
from motion import motion


class Track(CommandTest):
    def test_defaults_and_fields(self):
        told = self.data("track", self.tetrahedron, self.pyramid)
        self.assertEqual([told[k] for k in ("frames", "steps", "axis", "seed", "method")],
                         [1000, 500, "random", 1, "auto"])
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

    def test_long_runs_keep_times_by_size(self):
        """Beyond 65536 frames times are counted; the figures still hold together, and the chart says what it shows."""
        args = ["track", "shape:tetrahedron", "shape:tetrahedron", "--axis=0,0,1", "--frames=70000"]
        told = self.data(*args, "--plot", self.path / "plot.svg")
        self.assertTrue(0 < told["update_ns"]["median"] <= told["update_ns"]["p99"] <= told["update_ns"]["max"])
        self.assertEqual(told["updates"] + told["rebuilds"], 70000)
        self.assertIn("side by side, one in 2<", (self.path / "plot.svg").read_text())

    def test_bad_tolerances(self):
        for text in ("-1", "-1e-300", "x", "nan", "", "1,2"):
            self.bad("track", self.tetrahedron, self.pyramid, f"--tolerance={text}", says="--tolerance")

    def test_one_frame(self):
        self.assertEqual(self.data("track", "shape:cube", self.pyramid, "--frames", "1", "--verify")["mismatches"], 0)


METHODS = ["auto", "update", "walk", "cgm"]


class Turned(NamedTuple):
    """How a run turns P: about an axis, or about random ones from a seed; and the method of the sum."""
    axis: tuple = None
    seed: int = 1
    method: str = "auto"


class Counters(CommandTest):
    """What a run counts, held against the library's counters over the same rotations, which motion.py makes anew."""

    def compare(self, p, q, frames, steps, options=(), turned=Turned(), **given):
        axis, seed, method = turned
        about = [f"--axis={numbers(axis)}"] if axis else ["--axis=random", f"--seed={seed}"]
        told = self.data("track", p, q, f"--frames={frames}", f"--steps={steps}", "--method", method, *about, *options)
        rotations = self.file("rotations.txt", "".join(numbers(r) + "\n" for r in motion(frames, steps, axis, seed)))
        library = self.answers("track", p, q, list=rotations, method=(METHODS.index(method),), **given)
        self.assertEqual([[told[k]] for k in ("updates", "rebuilds")], [library[k] for k in ("updates", "rebuilds")])
        self.assertEqual([told["checked_per_frame"], told["repaired_per_frame"]],
                         [library[k][0] / frames for k in ("checked", "repaired")])
        self.assertEqual(told["signs"]["asked"], sum(library["signs"]))
        for key, count in zip(("filter", "exact", "perturbation"), library["signs"]):
            share = count / sum(library["signs"]) if sum(library["signs"]) else None
            self.assertEqual(told["signs"][key], share)
        self.assertEqual([told[k] for k in ("frames", "steps", "seed", "method")], [frames, steps, seed, method])
        self.assertEqual(told["axis"], list(axis) if axis else "random")
        return told, library

    def test_methods_axes_and_seeds(self):
        for p, q in ((self.tetrahedron, self.pyramid), ("shape:gs2", "shape:cube")):
            for method in METHODS:
                self.compare(p, q, 120, 300, turned=Turned(method=method))
            for axis in ((0, 0, 1), (1, 2, -0.5)):
                for steps in (1, 2, 3, 4, 6, 12, 1000):
                    self.compare(p, q, 30, steps, turned=Turned(axis))
            self.compare(p, q, 120, 90, turned=Turned(seed=2**64 - 1))

    def test_what_else_is_done_in_a_frame_is_not_counted(self):
        self.compare("shape:gs1", self.pyramid, 60, 50, ["--verify", "--brute", "--dump", self.path / "d", "--every",
                                                         "7"])

    def test_difference_region_and_tolerance(self):
        told, _ = self.compare("shape:gs2", self.pyramid, 80, 500, ["--difference"], difference=(1,))
        self.assertTrue(told["difference"])
        told, _ = self.compare("shape:gs2", self.pyramid, 80, 500, ["--region=0,1,2,40"], region=(0, 1, 2, 40))
        self.assertEqual((told["region"], told["region_degrees"], told["difference"]), ([0, 1, 2], 40, False))
        told, library = self.compare("shape:gs2", self.pyramid, 200, 5000, ["--tolerance=0.01", "--verify"],
                                     tolerance=(0.01,))
        self.assertEqual([told["kept"]], library["kept"])
        self.assertEqual([told["shortfall"]], library["shortfall"])
        self.assertGreater(told["kept"], 10)
        self.assertTrue(0 < told["shortfall"] <= told["tolerance"] == 0.01)
        self.assertEqual((told["verified"], told["mismatches"]), (200, 0))
        text = self.good("track", "shape:gs2", self.pyramid, "--frames=200", "--steps=5000", "--tolerance=0.01")
        self.assertRegex(text,
                         rf"pairing kept +{told['kept']} of 200 frames, the support short by [0-9.e-]+ at most, 0\.01 ")

    def test_the_counters_that_the_readme_quotes(self):
        root = Path(__file__).resolve().parents[2]
        models = {"controller, mug": [root / "examples/models" / f"{n}.off" for n in ("gamepad", "mug")],
                  "gs4, gs4": ["shape:gs4"] * 2}
        rows = re.findall(r"^\| ([a-z0-9, ]*)\| (\d+) \|(?: [0-9.,/ ]+ \|){3} ([0-9.]+) \| ([0-9.]+) \|$",
                          (root / "README.md").read_text(), re.M)
        self.assertEqual(len(rows), 6)
        name = ""
        for title, steps, checked, repaired in rows:
            name = title.strip() or name
            frames = 3000 if name == "gs4, gs4" else 2000
            told = self.data("track", *models[name], f"--steps={steps}", f"--frames={frames}")
            for quoted, counted in ((checked, told["checked_per_frame"]), (repaired, told["repaired_per_frame"])):
                digits = len(quoted.split(".")[1]) if "." in quoted else 0
                self.assertEqual(f"{counted:.{digits}f}", quoted, (name, steps))

    def test_text_holds_the_counters(self):
        args = ["track", "shape:gs2", self.pyramid, "--frames=60", "--steps=90"]
        told, text = self.data(*args), self.good(*args)
        self.assertIn(f"{told['checked_per_frame']:.4g} a frame\n", text)
        self.assertRegex(text, rf"pairs repaired +{told['repaired_per_frame']:.4g} a frame\n")
        self.assertRegex(text, rf"rebuilds +{told['rebuilds']} of 60 frames\n")
        shares = [100 * told["signs"][k] for k in ("filter", "exact", "perturbation")]
        line = "signs              {:.4g} a frame: {:.3f} % by filter, {:.3f} % by exact arithmetic, {:.3f} % ties\n"
        self.assertIn(line.format(told["signs"]["asked"] / 60, *shares), text)


class Frames(CommandTest):
    def dump(self, name, *args):
        folder = self.path / name
        self.good("track", *args, "--dump", folder)
        frames = json.loads((folder / "frames.json").read_text())["frames"]
        files = [f[key] for f in frames for key in ("file", "doubles") if key in f]
        self.assertEqual(sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()),
                         sorted(files + ["frames.json"]))
        return [(f["index"], f["quat"], (folder / f["file"]).read_bytes()) for f in frames]

    def test_every_kth_frame_from_the_first(self):
        frames = self.dump("a", self.tetrahedron, self.pyramid, "--frames", "25", "--every", "10")
        self.assertEqual([f[0] for f in frames], [0, 10, 20])
        self.assertEqual(len(self.dump("b", self.tetrahedron, self.pyramid, "--frames", "7")), 7)

    def test_a_frame_is_the_exact_sum_at_its_quaternion(self):
        for axis in ("random", "0.3,-0.1,2"):
            for index, quat, text in self.dump(axis, self.tetrahedron, self.pyramid, "--axis", axis, "--frames", "160",
                                               "--every", "53"):
                self.good("sum", self.tetrahedron, self.pyramid, f"--quat={numbers(quat)}", "--method", "hull",
                          "--exact",
                          "-o", self.path / "sum.off")
                self.assertEqual((self.path / "sum.off").read_bytes(), text, index)

    def parts(self, text):
        """Coordinates as text and facets of an OFF file with one thing to a line."""
        head, counts, *lines = text.decode().splitlines()
        vertices, facets, _ = map(int, counts.split())
        self.assertEqual((head, len(lines)), ("OFF", vertices + facets))
        return [line.split() for line in lines[:vertices]], lines[vertices:]

    def test_doubles_are_the_rationals_rounded(self):
        for extra in ([], ["--difference"]):
            folder = self.path / f"doubles{len(extra)}"
            self.good("track", self.tetrahedron, self.pyramid, "--frames=9", "--every=4", "--steps=11", "--dump",
                      folder, *extra)
            for frame in json.loads((folder / "frames.json").read_text())["frames"]:
                self.assertEqual(frame["file"], f"exact/{frame['doubles']}")
                exact, facets = self.parts((folder / frame["file"]).read_bytes())
                doubles, same_facets = self.parts((folder / frame["doubles"]).read_bytes())
                self.assertEqual(facets, same_facets)
                for given, rounded in zip(exact, doubles):
                    for a, b in zip(given, rounded):
                        # what any reader of OFF takes, and no digit more than the double needs
                        self.assertRegex(b, r"^-?[0-9]+(\.[0-9]+)?(e[-+][0-9]+)?$")
                        self.assertLessEqual(abs(Fraction(float(b)) - Fraction(a)), Fraction(1, 2**50))
                        digits = next(n for n in (15, 16, 17) if float(f"{float(b):.{n}g}") == float(b))
                        self.assertEqual(f"{float(b):.{digits}g}", b)

    def test_exact_frames_stand_alone(self):
        both = self.dump("a", self.tetrahedron, self.pyramid, "--frames=9", "--every=4")
        exact = self.dump("b", self.tetrahedron, self.pyramid, "--frames=9", "--every=4", "--exact")
        self.assertEqual(exact, both)
        self.assertEqual(sorted(p.name for p in (self.path / "b").iterdir()),
                         ["frame-000000.off", "frame-000004.off", "frame-000008.off", "frames.json"])
        self.bad("track", self.tetrahedron, self.pyramid, "--dump", "-", says=["--dump", "'-'"])
        self.bad("track", self.tetrahedron, self.pyramid, "--exact", says=["--exact", "--dump"])
        self.bad("track", self.tetrahedron, self.pyramid, "--tolerance=1", "--dump", self.path / "c",
                 says=["--tolerance", "--dump"])
        self.assertFalse((self.path / "c").exists())

    def test_a_frame_of_a_difference_is_the_exact_difference(self):
        for index, quat, text in self.dump("a", self.tetrahedron, self.pyramid, "--difference", "--frames=60",
                                           "--every=29"):
            self.good("sum", self.tetrahedron, self.pyramid, f"--quat={numbers(quat)}", "--difference", "--method",
                      "hull",
                      "--exact", "-o", self.path / "sum.off")
            self.assertEqual((self.path / "sum.off").read_bytes(), text, index)

    def test_rotations_are_those_of_the_motion(self):
        for axis, steps in (((0, 0, 1), 7), ((1, 2, -0.5), 100), (None, 90)):
            about = [f"--axis={numbers(axis)}"] if axis else ["--seed=5"]
            frames = self.dump(f"m{steps}", self.tetrahedron, self.pyramid, "--frames=120", f"--steps={steps}", *about)
            self.assertEqual([tuple(f[1]) for f in frames], motion(120, steps, axis, 5)[1:])

    def test_aligned_boxes_recur_exactly(self):
        box = "shape:box?x=1&y=1&z=2"
        frames = self.dump("a", box, box, "--axis", "0,0,1", "--steps", "360", "--frames", "721", "--every", "90")
        turns = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
                 [[-1, 0, 0], [0, -1, 0], [0, 0, 1]], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
        for k, (index, quat, text) in enumerate(frames):
            self.assertEqual(rotation(quat), turns[k % 4], index)
            self.assertTrue(text.startswith(b"OFF\n8 6 12\n"), index)
        thirds = self.dump("b", "shape:cube", "shape:cube", "--axis=1,1,1", "--steps=300", "--frames=301",
                           "--every=100")
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
        for word in ("tetrahedron.off", "pyramid.off", "70 steps", "90 frames", "method auto", "frame", "µs",
                     "tracked sum, median",
                     "rebuild by walk, median", "brute-force re-check, median"):
            self.assertIn(word, words)
        self.assertNotIn("brute", self.plot(self.tetrahedron, self.pyramid, "--frames", "90")[1])

    def test_lines_and_labels_stay_in_the_window(self):
        text, _ = self.plot(self.tetrahedron, self.pyramid, "--frames", "90", "--brute")
        levels = [float(y) for y in re.findall(r"<path d='M78 ([0-9.-]+)H936' stroke='#[ce]", text)]
        self.assertGreaterEqual(len(levels), 5)
        self.assertTrue(all(103.9 <= y <= 482.1 for y in levels), levels)
        # strong lines, one to a power of ten, have labels; of the others at most those at 2 and 5 of each
        strong = re.findall(r"<path d='M78 ([0-9.]+)H936' stroke='#c8c8c8'/>\n<text [^>]*>([0-9.e+-]+)<", text)
        self.assertEqual(len(strong), text.count("stroke='#c8c8c8'"))
        self.assertTrue(all(abs(math.log10(float(t)) - round(math.log10(float(t)))) < 1e-9 for _, t in strong), strong)
        weak = re.findall(r"stroke='#ececec'/>\n<text x='70' [^>]*>([0-9.e+-]+)<", text)
        self.assertTrue(all(f"{float(t):e}"[0] in "25" for t in weak), weak)
        columns = [float(x) for x in re.findall(r"<path d='M([0-9.-]+) 104V482' stroke='#ececec'", text)]
        self.assertGreaterEqual(len(columns), 5)
        self.assertTrue(all(78 <= x <= 936 for x in columns), columns)

    def test_the_axis_is_told(self):
        self.assertIn("axis 0,1,0.5", self.plot(self.tetrahedron, self.pyramid, "--frames=5", "--axis=0,1,0.5")[1])
        self.assertIn("a new random axis every 50 frames", self.plot(self.tetrahedron, self.pyramid, "--frames=5")[1])

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
    def test_a_long_run_shows_its_progress_on_a_terminal_only(self):
        """The bar, its parts and their agreement; wiped away before anything else is printed."""
        master, slave = self.open_terminal()
        started = time.monotonic()
        running = subprocess.Popen([self.command, "track", "shape:gs4", self.pyramid, "--frames", "5000000"],
                                   stdout=subprocess.DEVNULL, stderr=slave, preexec_fn=with_own_signals)
        os.close(slave)
        shown = b""
        while shown.count(b"\r[") < 3 and time.monotonic() - started < 30 and running.poll() is None:
            shown += read_terminal(master, 1)
            waited = time.monotonic() - started if shown.count(b"\r[") <= 1 else waited
        self.assertIsNone(running.poll(), "the run ended before it could be looked at")
        running.terminate()
        running.wait()
        shown += read_terminal(master, 1)
        bars = re.findall(rb"\r\[([#.]{30})\] +(\d+) %  (\d+) of 5000000, [0-9.e+]+ a second, (\d+) s left"
                          rb"\033\[K", shown)
        self.assertGreaterEqual(len(bars), 3)
        self.assertTrue(0.9 < waited < 15)
        before = 0
        for bar, percent, done, left in bars:
            part = int(done) / 5000000
            self.assertEqual((bar.rstrip(b"."), int(percent)), (b"#" * math.ceil(30 * part), round(100 * part)))
            self.assertGreater(int(done), before)
            before = int(done)
            # the time that is left, by the time that it took until now
            self.assertLess(int(left), 30 / part)
        self.assertTrue(shown.endswith(b"\r\033[K"), shown[-80:])

    def test_a_short_run_shows_nothing(self):
        master, slave = self.open_terminal()
        done = subprocess.run([self.command, "track", "shape:cube", self.pyramid, "--frames", "5"],
                              stdout=subprocess.PIPE,
                              stderr=slave, timeout=600)
        os.close(slave)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(read_terminal(master, 0), b"")


if __name__ == "__main__":
    main()
