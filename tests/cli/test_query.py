#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette query, one placement and many."""
import json
import os
import random
import re
import subprocess
import time
import xml.etree.ElementTree as ElementTree
from fractions import Fraction

from command_test import CommandTest, main, numbers, read_terminal, rotation, with_own_signals

STATES = ["outside", "boundary", "inside"]
CASTS = ["hit", "miss", "receding", "start inside", "at rest", "step limit"]
# state, and what is given beside the translation
PLACEMENTS = [
    ("outside", "2,0.25,0.125", {}), ("outside", "0,0,-9", {"direction": "0,0,1", "cast": "0,0,20"}),
    ("outside", "3,0,0", {"direction": "-1,0.01,0", "cast": "-0.5,0,0"}),
    ("outside", "3,0,0", {"direction": "1,0,0", "cast": "1,0,0"}),
    ("outside", "3,0,0", {"cast": "0,0,0"}), ("outside", "2,2,2", {"radius_p": "0.25", "radius_q": "0.5"}),
    ("inside", "0,0,0", {}), ("inside", "0.1,-0.05,0.01", {"direction": "1,2,3", "cast": "0,0,1"}),
    ("inside", "0.3,0.2,0.1", {"radius_q": "0.25"}),
]


class Query(CommandTest):
    def ask(self, p, q, translate, pose=(), **given):
        options = [f"--{key.replace('_', '-')}={value}" for key, value in given.items()]
        return self.data("query", p, q, f"--translate={translate}", *pose, *options)

    def hold(self, told, library, given):
        """Holds the command's JSON against the library's answer to the same question."""
        state = int(library["state"][0])
        self.assertEqual(told["state"], STATES[state])
        self.assertEqual([told["closest"]["p"], told["closest"]["q"], told["normal"]],
                         [library["p"], library["q"], library["normal"]])
        self.assertEqual("distance" in told, state != 2)
        self.assertEqual("penetration" in told, state == 2)
        if state == 2:
            self.assertEqual(told["penetration"], {"depth": -library["distance"][0], "normal": library["normal"]})
        else:
            self.assertEqual(told["distance"], library["distance"][0])
        p_kind, p, q_kind, q = library["witness"]
        self.assertEqual(told["witness"], {"kind": "-vef"[int(p_kind)] + "-vef"[int(q_kind)], "p": p, "q": q})
        self.assertEqual(told["steps"], library["steps"][0])
        self.assertGreater(told["seconds"], 0)
        self.assertEqual("directional" in told, "direction" in given)
        self.assertEqual("cast" in told, "cast" in given)
        if "direction" in given:
            along, none = library["directional"]
            expected = {"depth": -along} if state == 2 else {"distance": None if none else along}
            self.assertEqual(told["directional"], {**expected, "hits": not none})
        if "cast" in given:
            outcome, time, *normal = library["cast"]
            expected = {"outcome": CASTS[int(outcome)], "time": time, **({"normal": normal} if outcome == 0 else {})}
            self.assertEqual(told["cast"], expected)

    def test_every_option_is_the_librarys_answer(self):
        for pose, quat in (([], (0, 0, 0, 1)), (["--quat=0.1,-0.2,0.3,0.7"], (0.1, -0.2, 0.3, 0.7)),
                           (["--axis=0,0,1", "--angle=90"], (0, 0, 1, 1))):
            for state, translate, given in PLACEMENTS:
                for p, q in ((self.tetrahedron, self.pyramid), ("shape:gs2", "shape:cube")):
                    told = self.ask(p, q, translate, pose, **given)
                    library = self.answers("query", p, q, quat=quat, translate=translate, **given)
                    self.hold(told, library, given)
                    self.assertEqual((told["p"], told["q"], told["quat"]), (str(p), str(q), list(quat)))
                    self.assertEqual(told["translation"], [float(c) for c in translate.split(",")])
                    if p == "shape:gs2":
                        self.assertEqual(told["state"], state, (translate, given))

    def test_random_placements_are_the_librarys_answers(self):
        seed = 11
        chance = random.Random(seed)
        for _ in range(30):
            quat, place, way = (tuple(chance.gauss(0, 1) for _ in range(n)) for n in (4, 3, 3))
            given = {"direction": numbers(way), "cast": numbers(way)}
            told = self.ask("shape:gs1", self.pyramid, numbers(place), [f"--quat={numbers(quat)}"], **given)
            library = self.answers("query", "shape:gs1", self.pyramid, quat=quat, translate=place, **given)
            with self.subTest(seed=seed, quat=quat, place=place):
                self.hold(told, library, given)

    def test_boundary_is_exact(self):
        # cubes of edge 1 that share a facet, an edge, a corner; one ulp to either side of that
        for translate in ("1,0,0", "1,1,0", "1,-1,1"):
            told = self.ask("shape:cube", "shape:cube", translate)
            self.assertEqual((told["state"], told["distance"]), ("boundary", 0))
        self.assertEqual(self.ask("shape:cube", "shape:cube", "1.0000000000000002,0,0")["state"], "outside")
        self.assertEqual(self.ask("shape:cube", "shape:cube", "0.9999999999999999,0,0")["state"], "inside")

    def test_moving_by_the_depth_parts_the_bodies(self):
        told = self.ask("shape:cube", self.pyramid, "0.5,0.25,0.125", ["--quat=1,2,3,4"])
        depth, normal = told["penetration"]["depth"], told["penetration"]["normal"]
        for factor, state in ((1 - 1e-9, "inside"), (1 + 1e-9, "outside")):
            place = [t + factor * depth * n for t, n in zip((0.5, 0.25, 0.125), normal)]
            self.assertEqual(self.ask("shape:cube", self.pyramid, numbers(place), ["--quat=1,2,3,4"])["state"], state)

    def test_the_closest_points_are_on_the_bodies(self):
        told = self.ask(self.tetrahedron, "shape:cube", "3,4,5", ["--quat=1,0,2,3"])
        matrix = rotation((1, 0, 2, 3))
        turned = [[float(sum(r * Fraction(c) for r, c in zip(row, v))) + t for row, t in zip(matrix, (3, 4, 5))]
                  for v in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))]
        low = [min(v[k] for v in turned) for k in range(3)]
        high = [max(v[k] for v in turned) for k in range(3)]
        p, q = told["closest"]["p"], told["closest"]["q"]
        for k in range(3):
            self.assertTrue(low[k] - 1e-12 <= p[k] <= high[k] + 1e-12 and abs(q[k]) <= 0.5 + 1e-12)
        self.assertAlmostEqual(sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5, told["distance"], places=12)

    def test_text_holds_the_same_numbers(self):
        for state, translate, given in PLACEMENTS:
            options = [f"--{key.replace('_', '-')}={value}" for key, value in given.items()]
            text = self.good("query", "shape:gs2", "shape:cube", f"--translate={translate}", *options)
            told = self.ask("shape:gs2", "shape:cube", translate, **given)
            lines = dict(re.findall(r"^  (\S+(?: \S+)*?)  +(.*)$", text, re.M))
            self.assertTrue(text.startswith(f"shape:gs2 against shape:cube: {state}\n"))
            depth = told["penetration"]["depth"] if state == "inside" else told["distance"]
            self.assertEqual(float(lines["depth" if state == "inside" else "distance"]), depth)
            for name, vector in (("normal", told["normal"]), ("point of P", told["closest"]["p"]),
                                 ("point of Q", told["closest"]["q"])):
                self.assertEqual([float(c) for c in lines[name].split(", ")], vector)
            self.assertEqual(lines["witness"], "{kind} {p}, {q}".format(**told["witness"]))
            if "direction" in given and not told["directional"]["hits"]:
                self.assertEqual(lines["direction"], "never touches")
            elif "direction" in given:
                name, key = ("depth along", "depth") if state == "inside" else ("touches at", "distance")
                self.assertEqual(float(lines[name]), told["directional"][key])
            if "cast" in given:
                outcome, time = lines["cast"].split(", time ")
                self.assertEqual((outcome, float(time)), (told["cast"]["outcome"], told["cast"]["time"]))

    def test_a_picture_shows_both_bodies_and_the_answer(self):
        for state, translate, word in (("outside", "3,0.5,0", "distance"), ("boundary", "1,0,0", "touching"),
                                       ("inside", "0.5,0.25,0", "depth")):
            file = self.path / "picture.svg"
            told = self.data("query", "shape:cube", "shape:octahedron" if state != "boundary" else "shape:cube",
                             f"--translate={translate}", "-o", file)
            root = ElementTree.parse(file).getroot()
            kinds = [e.tag.split("}")[1] for e in root.iter()]
            self.assertEqual((told["state"], kinds.count("line"), kinds.count("circle")), (state, 25, 2))
            size = told["penetration"]["depth"] if state == "inside" else told["distance"]
            self.assertEqual([e.text for e in root.iter() if e.tag.endswith("text")], [f"{word} {size:.6g}"])
            # the answer is seen at full length: as long as its numbers say, in the scale of the picture
            red = next(e for e in root.iter() if e.get("stroke") == "#c0392b")
            line = next(e for e in red if e.tag.endswith("line"))
            ends = [float(line.get(k)) for k in ("x1", "y1", "x2", "y2")]
            self.assertAlmostEqual(ends[1], ends[3], places=2)
            # the bodies fill the picture but for its margin
            lines = [e for e in root.iter() if e.tag.endswith("line")]
            spans = [sorted(float(e.get(k + n)) for e in lines for n in "12") for k in "xy"]
            self.assertTrue(all(39.9 < s[0] and s[-1] < 600.1 for s in spans), spans)
            self.assertAlmostEqual(max(s[-1] - s[0] for s in spans), 560, places=1)
            self.assertIn("picture.svg", self.good("query", "shape:cube", "shape:cube", f"--translate={translate}",
                                                   "-o", file))
            for e in root.iter():
                for value in e.attrib.values():
                    self.assertNotRegex(value, "nan|inf")

    def test_what_is_wrong_is_named(self):
        pair = ["query", "shape:cube", self.pyramid]
        self.bad(*pair, says=["--translate", "--batch"])
        for option in ("--translate", "--direction", "--cast"):
            for text in ("1,2", "1,2,3,4", "a,0,0", "0,nan,0", "0,0,1e999", ""):
                self.bad(*pair, "--translate=0,0,0", f"{option}={text}", says=option)
        for option in ("--radius-p", "--radius-q"):
            for text in ("-1", "-1e-300", "x", "inf", "1,2", ""):
                self.bad(*pair, "--translate=0,0,0", f"{option}={text}", says=option)
        self.bad(*pair, "--translate=0,0,0", "--direction=0,-0,0", says=["--direction", "zero"])
        # numbers that are finite, but not what is made of them
        huge = "1.7e308,1.7e308,1.7e308"
        self.bad(*pair, f"--translate={huge}", says=["--translate", huge, "too large"])
        self.bad(*pair, "--batch", self.file("places.csv", f"0,0,0\n{huge}\n"), "-o", self.path / "a.csv",
                 says=["places.csv:2:1: x,y,z: too large"])
        self.bad(*pair, "--translate=0,0,0", "-o", self.path / "picture.png", says=["-o", "picture.png", ".svg"])
        self.bad(*pair, "--translate=0,0,0", "-o", self.path / "no" / "picture.svg", says="picture.svg")
        self.bad("query", "shape:cube", self.path / "none.off", "--translate=0,0,0", says="none.off")
        self.bad("query", self.path / "none.off", "shape:cube", "--translate=0,0,0", says="none.off")


class Progress(CommandTest):
    def test_a_long_batch_shows_how_much_of_its_file_is_read(self):
        places = self.file("places.csv", "0.1,0.2,0.3\n" * 3000000)
        total = places.stat().st_size
        master, slave = self.open_terminal()
        running = subprocess.Popen([self.command, "query", "shape:cube", self.pyramid, "--batch", places, "-o",
                                    "/dev/null"], stdout=subprocess.DEVNULL, stderr=slave,
                                   preexec_fn=with_own_signals)
        os.close(slave)
        shown, started = b"", time.monotonic()
        while shown.count(b"\r[") < 3 and time.monotonic() - started < 30 and running.poll() is None:
            shown += read_terminal(master, 1)
        running.terminate()
        running.wait()
        shown += read_terminal(master, 1)
        done = [int(n) for n in re.findall(rb"(\d+) of %d, [0-9.e+]+ a second, \d+ s left" % total, shown)]
        self.assertGreaterEqual(len(done), 2, shown[:300])
        self.assertTrue(all(a < b <= total for a, b in zip(done, done[1:])), done)
        # whole lines, each with its end
        self.assertEqual([n % 12 for n in done], [0] * len(done))


class Batch(CommandTest):
    def batch(self, text, *extra):
        return self.data("query", self.tetrahedron, self.pyramid, "--batch", self.file("places.csv", text), "-o",
                         self.path / "answers.csv", *extra)

    def rows(self):
        head, *lines = (self.path / "answers.csv").read_text().splitlines()
        self.assertEqual(head, "x,y,z,state,distance,nx,ny,nz")
        return [line.split(",") for line in lines]

    def test_rows_are_the_librarys_answers(self):
        chance = random.Random(7)
        places = [tuple(chance.uniform(-1.5, 1.5) for _ in range(3)) for _ in range(200)]
        text = "".join(numbers(p) + "\n" for p in places)
        for extra, given in (([], {}), (["--quat=1,2,3,4"], {"quat": (1, 2, 3, 4)}),
                             (["--radius-p=0.125", "--radius-q=0.25"], {"radius_p": (0.125,), "radius_q": (0.25,)})):
            told = self.batch(text, *extra)
            library = self.answers("query", self.tetrahedron, self.pyramid, list=self.path / "places.csv",
                                   **given)["row"]
            rows = [[STATES.index(c) if c in STATES else float(c) for c in row] for row in self.rows()]
            self.assertEqual(rows, library)
            self.assertEqual([r[:3] for r in rows], [list(p) for p in places])
            counts = [sum(r[3] == k for r in rows) for k in range(3)]
            self.assertEqual([told["placements"]] + [told[k] for k in STATES], [200] + counts)
            self.assertGreater(min(counts[0], counts[2]), 10)
            self.assertEqual((told["interrupted"], told["seconds"] > 0), (False, True))

    def test_text_counts_the_states(self):
        places = self.file("places.csv", "9,0,0\n0.1,0.1,0.1\n0.9,0,0\n0,0,9\n")
        text = self.good("query", "shape:cube", "shape:cube", "--batch", places, "-o", self.path / "answers.csv")
        self.assertEqual(text, "4 placements: 2 outside, 0 boundary, 2 inside\n")
        text = self.good("query", "shape:cube", "shape:cube", "--batch", self.file("places.csv", "1,0,0"), "-o",
                         self.path / "a")
        self.assertEqual(text, "1 placements: 0 outside, 1 boundary, 0 inside\n")

    def test_headings_blank_lines_blanks_and_line_ends(self):
        for text in ("1,2,3\n4,5,6\n", "x,y,z\n1,2,3\n4,5,6", "tx , ty,\ttz\r\n1, 2 ,3\r\n\r\n  \n 4,5,6\r\n\n",
                     "\n\n1,2,3\n4e0,0x5,+6\n"):
            self.assertEqual(self.batch(text)["placements"], 2, text)
            self.assertEqual([r[:3] for r in self.rows()], [["1", "2", "3"], ["4", "5", "6"]])

    def test_a_bad_line_is_named_with_its_column(self):
        long = "1,2," + "3" * 1100
        for text, where, why in (
                ("1,2\n", "1:1", "2 fields"), ("1,2,3,4\n", "1:7", "4 fields"), ("1\n", "1:1", "1 field between"),
                ("hello\n1,2,3\n", "1:1", "1 field"),
                ("1,y,3\n", "1:3", "y: 'y'"), ("x,y,3\n1,2,3\n", "1:1", "x: 'x'"), ("x,,z\n1,2,3\n", "1:1", "x: 'x'"),
                ("nan,0,0\n", "1:1", "'nan'"),
                ("1,2,inf\n", "1:5", "z: 'inf'"), ("1,2,1e999\n", "1:5", "'1e999'"), ("1,2,3\n\n1,,3\n", "3:3", "''"),
                ("1;2;3\n", "1:1", "1 field"),
                ("x,y,z\nx,y,z\n", "2:1", "x: 'x'"), ("1,2,3\n1, 2x,3\n", "2:4", "y: '2x'"),
                ("1,2,3\n" + long, "2:1024", "1023"),
                ("1,2,3\0,4\n", "1:6", "zero byte"), ("1,2,3 4\n", "1:5", "'3 4'")):
            file = self.file("places.csv", text)
            self.bad("query", "shape:cube", self.pyramid, "--batch", file, "-o", self.path / "answers.csv",
                     says=[f"{file}:{where}: ", why])
            self.assertFalse((self.path / "answers.csv").exists())
        self.batch("1,2," + "0" * 1018 + "3\n")

    def test_files_that_cannot_be_read_or_hold_nothing(self):
        out = ["-o", self.path / "answers.csv"]
        pair = ["query", "shape:cube", self.pyramid, "--batch"]
        for text in ("", "\n \n", "x,y,z\n"):
            self.bad(*pair, self.file("places.csv", text), *out, says=["places.csv", "no translation"])
        self.bad(*pair, self.path / "none.csv", *out, says=["none.csv", "cannot open"])
        self.bad(*pair, self.path, *out, says="cannot read")
        self.bad(*pair, self.file("places.csv", "1,2,3"), says="-o")
        self.bad(*pair, self.file("places.csv", "1,2,3"), "-o", "", says="cannot write: No such file")
        self.bad(*pair, self.file("places.csv", "1,2,3"), "-o", self.path / "no" / "a.csv", says="a.csv")
        self.assertFalse((self.path / "answers.csv").exists())

    def test_lines_come_from_standard_input(self):
        done = subprocess.run([self.command, "query", "shape:cube", "shape:cube", "--batch", "-", "-o", "-"],
                              input="x,y,z\n3,0,0\n",
                              capture_output=True, text=True, timeout=600)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout, "x,y,z,state,distance,nx,ny,nz\n3,0,0,outside,2,1,0,0\n")
        done = subprocess.run([self.command, "query", "shape:cube", "shape:cube", "--batch", "-", "-o",
                               self.path / "a.csv", "--json"],
                              input="3,0,0\nbad\n", capture_output=True, text=True, timeout=600)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertTrue(done.stderr.startswith("pirouette: standard input:2:1: "), done.stderr)


if __name__ == "__main__":
    main()
