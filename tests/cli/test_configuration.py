#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette configuration: poses, motions and files of poses, asked of a file of slices."""
import csv
import json
import math
import os
import random
import struct
import subprocess

from command_test import CommandTest, main, numbers

# the boxes of write_slices.c
ROBOT = [((-1, -0.125, -0.25), (1, 0.125, 0.25)), ((0.75, 0, -0.25), (1, 1, 0.25))]
WALLS = [((-3, -0.125, -1), (-1, 0.125, 1)), ((1, -0.125, -1), (3, 0.125, 1))]


def box_model(low, high):
    corners = [tuple((low, high)[k >> axis & 1][axis] for axis in range(3)) for k in range(8)]
    return "OFF\n8 0 0\n" + "".join("%r %r %r\n" % c for c in corners)


class Configuration(CommandTest):
    def setUp(self):
        super().setUp()
        self.slices = self.path / "map.h5"
        subprocess.run([os.environ["PIR_WRITE_SLICES"], self.slices], check=True, timeout=600)
        self.pieces = [[self.file(f"{name}{k}.off", box_model(*box)) for k, box in enumerate(boxes)]
                       for name, boxes in (("robot", ROBOT), ("wall", WALLS))]

    def state(self, quat, translate):
        """The most overlapping state over all pairs of boxes, by pirouette query."""
        states = [self.data("query", p, q, f"--quat={numbers(quat)}", f"--translate={numbers(translate)}")["state"]
                  for p in self.pieces[0] for q in self.pieces[1]]
        return next(s for s in ("inside", "boundary", "outside") if s in states)

    def ask(self, *options):
        return self.data("configuration", self.slices, *options)

    def test_poses_of_the_grid_have_their_exact_state(self):
        chance = random.Random(5)
        for turn in (0, 10, 30):
            quat = [(0, 0, 0, 1), (0, 0, 1, 1), (0, 0, 1, 0), (0, 0, -1, 1)][turn // 10]
            for _ in range(2):
                place = [chance.randrange(-16, 17) / 8 for _ in range(3)]
                told = self.ask(f"--quat={numbers(quat)}", f"--translate={numbers(place)}")
                state = self.state(quat, place)
                self.assertEqual((told["state"], told["slice"], told["turn"]), (state, turn, 0))
                self.assertEqual(told["verdict"], "free" if state == "outside" else "blocked")
                self.assertEqual((told["quat"], told["translation"]), (list(map(float, quat)), place))
        # one box exactly upon the other
        told = self.ask("--translate=2,0.25,0")
        self.assertEqual((told["state"], told["verdict"]), ("boundary", "blocked"))

    def test_other_poses_are_right_or_unknown(self):
        chance = random.Random(6)
        verdicts = []
        for _ in range(8):
            quat = [chance.gauss(0, 0.05), chance.gauss(0, 0.05), chance.gauss(0, 1), chance.gauss(0, 1)]
            place = [chance.uniform(-3, 3), chance.uniform(-1, 1), chance.uniform(-1, 1)]
            told = self.ask(f"--quat={numbers(quat)}", f"--translate={numbers(place)}")
            verdicts.append(told["verdict"])
            self.assertNotIn("state", told)
            self.assertTrue(0 < told["turn"] < math.pi and 0 <= told["slice"] < 40)
            if told["verdict"] != "unknown":
                self.assertEqual(told["verdict"] == "free", self.state(quat, place) == "outside", (quat, place))
        self.assertTrue({"free", "blocked"} <= set(verdicts), verdicts)

    def test_motions_tell_where(self):
        through = self.ask("--quat=0,0,1,1", "--translate=0.25,-2,0", "--to=0.25,2,0")
        self.assertEqual((through["verdict"], through["from"], through["to"]), ("free", 0, 0))
        # across, the arm of the L meets a wall; without a turn the middle of the way is blocked
        across = self.ask("--translate=0.125,-2,0", "--to=0.125,2,0")
        self.assertEqual(across["verdict"], "blocked")
        self.assertTrue(0 < across["from"] < across["to"] < 1)
        turning = self.ask("--quat=0,0,1,1", "--translate=0,0,0", "--to-quat=0,0,0,1")
        self.assertEqual((turning["verdict"], turning["to_quat"], turning["to_translation"]),
                         ("blocked", [0, 0, 0, 1], [0, 0, 0]))
        text = self.good("configuration", self.slices, "--translate=0.125,-2,0", "--to=0.125,2,0")
        self.assertIn("the motion is blocked", text)
        self.assertIn("of the way", text)

    def test_text_says_what_json_says(self):
        told = self.ask("--translate=0,2,0")
        text = self.good("configuration", self.slices, "--translate=0,2,0")
        self.assertIn(f"{told['verdict']}\n", text)
        self.assertIn(f"state        {told['state']}\n", text)

    def test_batches_are_single_answers(self):
        chance = random.Random(7)
        poses = [[chance.gauss(0, 1) for _ in range(4)] + [chance.uniform(-2, 2) for _ in range(3)] for _ in range(6)]
        rows = self.file("poses.csv", "x,y,z,w,tx,ty,tz\n" + "".join(numbers(p) + "\n" for p in poses))
        header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (6, 7), }\n"
        array = self.file("poses.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header +
                          b"".join(struct.pack("<7d", *p) for p in poses))
        out = self.path / "answers.csv"
        counts = self.data("configuration", self.slices, "--batch", rows, "-o", out)
        answers = list(csv.DictReader(out.read_text().splitlines()))
        self.assertEqual(len(answers), 6)
        for pose, answer in zip(poses, answers):
            one = self.ask(f"--quat={numbers(pose[:4])}", f"--translate={numbers(pose[4:])}")
            self.assertEqual([float(answer[k]) for k in ("x", "y", "z", "w", "tx", "ty", "tz")], pose)
            self.assertEqual((answer["verdict"], int(answer["slice"]), float(answer["turn"]), answer["state"]),
                             (one["verdict"], one["slice"], one["turn"], one.get("state", "")))
        for verdict in ("free", "blocked", "unknown"):
            self.assertEqual(counts[verdict], sum(a["verdict"] == verdict for a in answers))
        self.assertEqual((counts["poses"], counts["interrupted"]), (6, False))
        self.assertEqual(self.good("configuration", self.slices, "--batch", array, "-o", "-"), out.read_text())
        piped = subprocess.run([self.command, "configuration", self.slices, "--batch", "-", "-o", "-"],
                               input=rows.read_text(), capture_output=True, text=True, timeout=600)
        self.assertEqual((piped.returncode, piped.stdout, piped.stderr), (0, out.read_text(), ""))
        self.assertIn("6 poses", self.good("configuration", self.slices, "--batch", rows, "-o", out))

    def test_bad_input_is_told_with_its_place(self):
        place = "--translate=0,0,0"
        self.bad("configuration", self.slices, says="--translate")
        self.bad("configuration", self.slices, place, "--quat=0,0,0,0", says="zero quaternion")
        self.bad("configuration", self.slices, place, "--to-quat=0,0,0,0", says="--to-quat")
        self.bad("configuration", self.slices, "--translate=nan,0,0", says=["--translate", "nan"])
        self.bad("configuration", self.slices, place, "-o", self.path / "a.csv", says="-o is for --batch")
        self.bad("configuration", self.slices, "--batch", "x.csv", says="-o")
        self.bad("configuration", self.slices, place, "--around", says=["--around", "--critical"])
        self.bad("configuration", self.slices, place, "--kappa=1", says="--critical")
        self.bad("configuration", self.slices, place, "--batch", "x.csv", "-o", "-", says=["--batch", "--translate"])
        self.bad("configuration", self.path / "none.h5", place, says=["none.h5", "No such file"])
        self.bad("configuration", self.tetrahedron, place, says=["tetrahedron.off", "no HDF5"])
        out = self.path / "out.csv"
        for text, says in (("0,0,0,1,0,0,0\n0,0,0,nan,0,0,0\n", ["rows.csv:2:", "nan"]),
                           ("0,0,0,1\n", ["rows.csv:1:", "4 numbers, not 7"]), ("", ["rows.csv", "empty"]),
                           ("0,0,0,0,1,1,1\n", ["rows.csv:1:", "no rotation"])):
            rows = self.file("rows.csv", text)
            self.bad("configuration", self.slices, "--batch", rows, "-o", out, says=says)
            self.assertFalse(out.exists())

    def test_broken_files_are_refused_or_right(self):
        whole = self.slices.read_bytes()
        options = ["--quat=0.1,0,1,1", "--translate=1.3,0.2,0"]
        right = self.ask(*options)["verdict"]
        chance = random.Random(8)
        refused = 0
        for k in range(16):
            changed = bytearray(whole[:len(whole) * (k + 1) // 18] if k % 4 == 0 else whole)
            for _ in range(k % 4):
                changed[chance.randrange(len(changed))] = chance.randrange(256)
            path = self.file("broken.h5", bytes(changed))
            done = self.run_command("configuration", path, *options, "--json")
            if done.returncode == 0:
                self.assertEqual(json.loads(done.stdout)["verdict"], right)
                continue
            refused += 1
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
            self.assertTrue(done.stderr.startswith("pirouette: "), done.stderr)
        self.assertGreaterEqual(refused, 4)


if __name__ == "__main__":
    main()
