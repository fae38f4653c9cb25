#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette impact."""
import math
import random
from fractions import Fraction

from command_test import CommandTest, main, numbers, rotation
from test_solid import prism


def value(coefficients, kappa):
    total = Fraction(0)
    for c in coefficients:
        total = total * Fraction(kappa) + int(c)
    return total


class Impact(CommandTest):
    def state_at(self, models, axis, pivot, place, kappa):
        """The state of the pair once P has turned to κ: of the start turned about the pivot by exact numbers."""
        quat = (*axis, kappa)
        turned = [sum(r * (Fraction(t) - Fraction(c)) for r, t, c in zip(row, place, pivot)) + Fraction(o)
                  for row, o in zip(rotation(quat), pivot)]
        return self.data("query", *models, "--quat=" + numbers(quat), "--translate=" + numbers(turned))["state"]

    def hold(self, told):
        """Holds a hit to what every one keeps to."""
        low, high = told["kappa"]
        self.assertLessEqual(low, high)
        ends = [value(told["polynomial"], k) for k in (low, high)]
        self.assertTrue(ends[0] * ends[1] < 0 or 0 in ends)
        self.assertAlmostEqual(math.hypot(*told["normal"]), 1, places=12)

    def test_a_door(self):
        told = self.data("impact", "shape:cube", "shape:cube", "--axis", "0,0,1", "--pivot", "3,3,0", "--translate",
                         "0,5,0")
        self.hold(told)
        self.assertEqual((told["outcome"], told["normal"], told["solid"]), ("hit", [0, 1, 0], False))
        # the corner at (-3.5, 1.5) from the pivot comes down to 2.5 below it
        turned = math.asin(2.5 / math.hypot(3.5, 1.5)) + math.atan2(1.5, 3.5)
        self.assertAlmostEqual(told["degrees"], math.degrees(turned), places=9)
        self.assertLessEqual(told["degrees"], math.degrees(turned) + 1e-12)
        self.assertAlmostEqual(told["fraction"], told["degrees"] / 360, places=15)
        self.assertEqual(told["witness"]["kind"][1], "f")
        # the other way round, and too short
        back = self.data("impact", "shape:cube", "shape:cube", "--axis", "0,0,-1", "--pivot", "3,3,0", "--translate",
                         "0,5,0", "--angle=-360")
        self.assertEqual(back["kappa"], told["kappa"])
        short = self.data("impact", "shape:cube", "shape:cube", "--axis", "0,0,1", "--pivot", "3,3,0", "--translate",
                          "0,5,0", "--angle", "64")
        self.assertEqual((short["outcome"], short["fraction"], short["degrees"]), ("miss", 1, 64))
        self.assertNotIn("kappa", short)

    def test_states_around_the_hit_are_those_of_queries(self):
        source, hits, inside = random.Random(7), 0, 0
        models = "shape:cube", "shape:icosahedron"
        for _ in range(12):
            axis = [source.randint(-4, 4) for _ in range(2)] + [source.randint(1, 4)]
            pivot, place = [3, 1, 0], [source.uniform(-1, 1), source.uniform(2, 3), source.uniform(-1, 1)]
            told = self.data("impact", *models, "--axis=" + numbers(axis), "--translate=" + numbers(place),
                             "--pivot=" + numbers(pivot))
            if told["outcome"] != "hit":
                continue
            self.hold(told)
            low, high = (told["kappa"][k] + (1 + abs(told["kappa"][k])) * (-1e-7, 1e-7)[k] for k in (0, 1))
            self.assertEqual(self.state_at(models, axis, pivot, place, high), "outside")
            hits += 1
            inside += self.state_at(models, axis, pivot, place, low) == "inside"
        self.assertGreater(hits, 2)
        self.assertEqual(inside, hits)

    def test_a_way(self):
        told = self.data("impact", "shape:cube", "shape:cube", "--translate", "3,0,0", "--way=-4,0,0")
        self.hold(told)
        self.assertEqual(told["outcome"], "hit")
        self.assertTrue(0.5 - 1e-9 < told["fraction"] <= 0.5 and told["kappa"][0] <= 2 <= told["kappa"][1])
        self.assertEqual((told["polynomial"], told["normal"]), (["0", "1", "-2"], [1, 0, 0]))
        self.assertEqual(len(told["witness"]["p"]) + len(told["witness"]["q"]), 5)
        self.assertNotIn("degrees", told)
        cast = self.data("query", "shape:cube", "shape:cube", "--translate", "3,0,0", "--cast=-4,0,0")
        self.assertAlmostEqual(cast["cast"]["time"], told["fraction"], places=9)
        slid = self.data("impact", "shape:cube", "shape:cube", "--translate", "1,0,0", "--way", "0,1,0")
        self.assertEqual((slid["outcome"], slid["fraction"]), ("receding", 0))
        inside = self.data("impact", "shape:cube", "shape:cube", "--way", "0,1,0")
        self.assertEqual(inside["outcome"], "start inside")
        rest = self.data("impact", "shape:cube", "shape:cube", "--translate", "3,0,0", "--way", "0,0,0")
        self.assertEqual(rest["outcome"], "at rest")

    def test_a_screw(self):
        # the lower side comes down to the upper one, wherever it has turned to: after 2/3 of the way
        screw = "shape:cube", "shape:cube", "--translate=0,0,2.5", "--axis=0,0,3", "--angle=90", "--way=0,0,-2.25"
        told = self.data("impact", *screw)
        self.hold(told)
        self.assertEqual((told["outcome"], told["normal"], len(told["polynomial"])), ("hit", [0, 0, 1], 4))
        half = math.atan(2 / 3 * math.tan(math.pi / 4))
        self.assertAlmostEqual(told["degrees"], math.degrees(2 * half), places=9)
        self.assertAlmostEqual(told["fraction"], told["degrees"] / 90, places=12)
        solid = self.data("impact", *screw, "--solid")
        self.assertEqual([solid[k] for k in ("outcome", "degrees", "kappa")], [told[k] for k in
                                                                             ("outcome", "degrees", "kappa")])
        self.assertRegex(self.good("impact", *screw), "^shape:cube screwing against shape:cube: hit\n")
        turn = self.data("impact", *screw[:-1], "--way=0,0,0")
        self.assertEqual(turn["outcome"], "miss")

    def test_a_bolt(self):
        bolt = ("impact", "shape:cube", "shape:cube", "--translate=0,0,4", "--axis=0,0,1", "--angle=1440",
                "--proportional")
        for solid in [], ["--solid"]:
            told = self.data(*bolt, "--way=0,0,-9", *solid)
            self.assertEqual(told["outcome"], "meets")
            # the cubes touch at a height of 1, after a third of the way
            self.assertTrue(480 - 1e-6 < told["degrees"][0] <= 480 <= told["degrees"][1] < 480 + 1e-6)
            self.assertTrue(told["fraction"][0] <= 1 / 3 <= told["fraction"][1])
            free = self.data(*bolt, "--way=0,0,-2.5", *solid)
            self.assertEqual((free["outcome"], free["degrees"], free["fraction"]), ("free", [1440, 1440], [1, 1]))
        self.assertRegex(self.good(*bolt, "--way=0,0,-9"),
                         r"^shape:cube screwing against shape:cube: meets\n  degrees +479\.9.* to 480\.0.*\n")
        slides = self.data("impact", "shape:cube", "shape:cube", "--translate=-3,1,0", "--way=6,0,0", "--proportional")
        self.assertEqual((slides["outcome"], "degrees" in slides), ("undecided", False))

    def test_solids_are_not_their_hulls(self):
        run = "impact", "shape:box?x=0.5&y=0.5&z=0.5", self.file("l.off", prism()), "--translate", "2.5,2.5,0.5"
        told = self.data(*run, "--way=-3,0,0", "--solid")
        self.assertEqual((told["outcome"], told["normal"], told["solid"]), ("hit", [1, 0, 0], True))
        self.assertAlmostEqual(told["fraction"], 1.25 / 3, places=9)
        self.assertEqual(len(told["pieces"]), 2)
        hull = self.data(*run, "--way=-3,0,0")
        self.assertAlmostEqual(hull["fraction"], 1 / 6, places=9)

    def test_text(self):
        text = self.good("impact", "shape:cube", "shape:cube", "--translate", "3,0,0", "--way=-4,0,0")
        self.assertRegex(text, r"^shape:cube going against shape:cube: hit\n  fraction +0.4999.*\n  normal +1, 0, 0\n"
                               r"  point +0.5, .*\n  planes +1\n  time ")
        text = self.good("impact", "shape:cube", "shape:cube", "--solid", "--axis", "0,0,1")
        self.assertRegex(text, r"^shape:cube turning against shape:cube, as solids: start inside\n  degrees +0\n")

    def test_refusals(self):
        pair = "impact", "shape:cube", "shape:cube"
        self.bad(*pair, says="no motion")
        self.bad(*pair, "--axis", "0,0,1", "--way", "1,0,0", says="below 180 degrees")
        self.bad(*pair, "--axis", "0,0,1", "--way", "1,0,0", "--angle=-180", says="below 180 degrees")
        self.bad(*pair, "--axis", "0,0,0", says="zero vector")
        self.bad(*pair, "--axis", "1e300,0,0", says="impact: ")
        self.bad(*pair, "--axis", "0,0,1", "--angle", "361", says="--angle")
        self.bad(*pair, "--axis", "0,0,1", "--angle", "0", says="--angle")
        self.bad(*pair, "--axis", "0,0,1", "--angle", "36001", "--proportional", says="from -36000 to 36000")
        self.bad(*pair, "--way", "1,0,0", "--pivot", "1,0,0", says="--pivot is for turns")
        self.bad(*pair, "--way", "1,0,0", "--quat", "0,0,0,0", says="zero quaternion")
        self.bad(*pair, "--way", "1,0,0", "--solid", "--merge", "1", says="--merge")
        segment = self.file("segment.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n")
        self.bad("impact", segment, "shape:cube", "--way", "1,0,0", says="dimension")


if __name__ == "__main__":
    main()
