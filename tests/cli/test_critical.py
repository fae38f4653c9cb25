#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette slice --critical, and configuration on its files: poses, angles and places all around a turn."""
import csv
import math
import random

from command_test import CommandTest, main, numbers


def box_model(low, high):
    corners = [tuple((low, high)[k >> axis & 1][axis] for axis in range(3)) for k in range(8)]
    return "OFF\n8 0 0\n" + "".join("%r %r %r\n" % c for c in corners)


class Critical(CommandTest):
    def setUp(self):
        super().setUp()
        self.robot = self.file("robot.off", box_model((-2, -0.5, -0.5), (1, 0.5, 0.5)))
        self.walls = [self.file("wall0.off", box_model((2, -1, -1), (3, 1, 1))),
                      self.file("wall1.off", box_model((-1, 2, -1), (1, 3, 0)))]
        self.turn = self.path / "a.turn"
        self.told = self.data("slice", self.robot, *self.walls, "--axis", "0,0,1", "--critical", "-o", self.turn)

    def ask(self, *options):
        return self.data("configuration", self.turn, *options)

    def state(self, quat, translate):
        states = [self.data("query", self.robot, wall, f"--quat={numbers(quat)}",
                            f"--translate={numbers(translate)}")["state"] for wall in self.walls]
        return next(s for s in ("inside", "boundary", "outside") if s in states)

    def test_what_is_made_is_told(self):
        self.assertEqual((self.told["robot_pieces"], self.told["obstacle_pieces"]), (1, 2))
        events = sum(len(self.data("events", self.robot, wall, "--axis", "0,0,1", "--difference")["events"])
                     for wall in self.walls)
        self.assertEqual(self.told["events"], events)
        self.assertEqual(self.told["bytes"], self.turn.stat().st_size)
        text = self.good("slice", self.robot, self.walls[0], "--axis", "0,0,1", "--critical", "-o", self.turn)
        self.assertIn("a full turn of", text)

    def test_poses_have_the_state_of_queries(self):
        chance = random.Random(8)
        for _ in range(6):
            quat = (0, 0, chance.randrange(-3, 4), chance.randrange(1, 4))
            place = [chance.randrange(-16, 17) / 8 for _ in range(3)]
            told = self.ask(f"--quat={numbers(quat)}", f"--translate={numbers(place)}")
            state = self.state(quat, place)
            self.assertEqual((told["state"], told["verdict"]), (state, "free" if state == "outside" else "blocked"))
            self.assertIn("interval", told)
            if quat[2]:
                same = self.ask(f"--kappa={quat[3] / quat[2]!r}", f"--translate={numbers(place)}")
                self.assertEqual(same["state"], state)
        # one box exactly beside the other, and rotations beside the axis
        self.assertEqual(self.ask("--translate=1,0,0")["state"], "boundary")
        told = self.ask("--translate=1,0,0", "--axis=1,0,0", "--angle=20")
        self.assertEqual((told["state"], "interval" in told), (self.state((math.sin(math.pi / 18), 0, 0,
                                                                           math.cos(math.pi / 18)), (1, 0, 0)), False))

    def test_all_around_a_place(self):
        for place in ([0, 0, 0], [1, 0.25, 0], [0, 0, 0.5], [9, 0, 0]):
            told = self.ask(f"--translate={numbers(place)}", "--around")
            self.assertEqual(told["at_start"], self.state((0, 0, 0, 1), place))
            end = [0, 0]
            for stretch in told["stretches"]:
                self.assertEqual(stretch["from_degrees"], end)
                end = stretch["to_degrees"]
                if stretch["to_degrees"][0] - stretch["from_degrees"][1] < 1e-6:
                    continue
                middle = math.radians(stretch["from_degrees"][1] + stretch["to_degrees"][0]) / 4
                self.assertEqual(stretch["state"], self.state((0, 0, math.sin(middle), math.cos(middle)), place))
            self.assertEqual(end, [360, 360])
        self.assertGreater(len(self.ask("--translate=0,0,0", "--around")["stretches"]), 3)
        self.assertIn("from 0 to 360 degrees: free", self.good("configuration", self.turn, "--translate=9,0,0",
                                                               "--around"))

    def test_many_poses_are_never_unknown(self):
        chance = random.Random(9)
        rows = []
        for _ in range(400):
            half = chance.random() * math.pi
            rows.append([0, 0, math.sin(half), math.cos(half)] + [chance.uniform(-2, 2) for _ in range(3)])
        poses = self.file("poses.csv", "".join(numbers(row) + "\n" for row in rows))
        out = self.path / "answers.csv"
        counts = self.data("configuration", self.turn, "--batch", poses, "-o", out)
        self.assertEqual((counts["poses"], counts["unknown"], counts["free"] + counts["blocked"]), (400, 0, 400))
        with open(out, newline="") as file:
            answers = list(csv.DictReader(file))
        self.assertEqual(len(answers), 400)
        self.assertTrue(all(a["interval"] != "" for a in answers))
        for k in range(0, 400, 80):
            self.assertEqual(answers[k]["state"], self.state(rows[k][:4], rows[k][4:]))
        self.assertIn("0 unknown", self.good("configuration", self.turn, "--batch", poses, "-o", out))

    def test_bad_requests_are_refused(self):
        make = ["slice", self.robot, self.walls[0]]
        self.bad(*make, "--axis=0,0,1", "--critical", "-o", self.path / "a.h5", says=".turn")
        self.bad(*make, "--critical", "-o", self.turn, says="--axis")
        self.bad(*make, "--axis=0,0,1", "--critical", "--steps=5", "-o", self.turn, says="--steps")
        self.bad(*make, "--axis=0,0,0", "--critical", "-o", self.turn, says="zero vector")
        self.bad(*make, "--axis=0,0,1", "--quat=0,0,0,0", "--critical", "-o", self.turn, says="zero quaternion")
        self.bad(*make, "--axis=0,0,1", "--quat=0,0,0,1", "--steps=5", "-o", self.path / "a.h5", says="--quat")
        flat = self.file("flat.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")
        self.bad("slice", flat, flat, "--axis=0,0,1", "--critical", "-o", self.turn, says="no inside")
        self.bad("configuration", self.turn, says="--translate")
        self.bad("configuration", self.turn, "--translate=0,0,0", "--to=1,0,0", says="--to")
        self.bad("configuration", self.turn, "--translate=0,0,0", "--kappa=1", "--around", says="--around")
        self.bad("configuration", self.robot, "--translate=0,0,0", "--around", says="robot.off")
        whole = self.turn.read_bytes()
        for data in (whole[:-1], whole[:60], whole[:-9] + b"x" + whole[-8:]):
            self.turn.write_bytes(data)
            self.bad("configuration", self.turn, "--translate=0,0,0", says=["a.turn", "critical map"])


if __name__ == "__main__":
    main()
