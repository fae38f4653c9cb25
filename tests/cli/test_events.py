#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette events."""
import math
import xml.etree.ElementTree as ElementTree
from fractions import Fraction

from command_test import CommandTest, main


def value(coefficients, kappa):
    c0, c1, c2 = (int(c) for c in coefficients)
    x = Fraction(kappa)
    return (c0 * x + c1) * x + c2


class Events(CommandTest):
    def hold(self, told, facets):
        """Holds a list of events to what every one keeps to, however it was asked for."""
        length, before = math.hypot(*told["axis"]), math.inf
        self.assertEqual(told["facets"], facets)
        for event in told["events"]:
            low, high = event["kappa"]
            self.assertTrue(low <= high <= before)
            before = low
            ends = [value(event["polynomial"], k) for k in (low, high)]
            self.assertTrue(ends[0] * ends[1] < 0 or 0 in ends)
            angle = math.degrees(2 * math.atan2(length, (low + high) / 2))
            self.assertTrue(event["angle"][0] - 1e-11 <= angle <= event["angle"][1] + 1e-11)
            self.assertTrue(event["lost"] or event["gained"])
            facets += len(event["gained"]) - len(event["lost"])
            self.assertEqual(event["facets"], facets)

    def test_a_box_on_a_table(self):
        told = self.data("events", "shape:cube", "shape:cube")
        self.hold(told, 10)
        self.assertEqual([e["kappa"] for e in told["events"]], [[1, 1], [0, 0], [-1, -1]])
        self.assertEqual([e["polynomial"] for e in told["events"]],
                         [["1", "0", "-1"], ["0", "1", "0"], ["1", "0", "-1"]])
        self.assertEqual([round(e["angle"][0]) for e in told["events"]], [90, 180, 270])
        first = told["events"][0]
        # of the four sides of each, which meet edges of the other one
        self.assertEqual({f["kind"] for f in first["lost"]}, {"fe", "ef"})
        self.assertEqual({(len(f["p"]), len(f["q"])) for f in first["gained"]}, {(4, 2), (2, 4)})

    def test_all_of_a_turn(self):
        told = self.data("events", "shape:cube", "shape:octahedron", "--axis", "1,2,3", "--quat", "0.1,0.2,-0.37,0.9")
        self.assertEqual(told["axis"], [1, 2, 3])
        self.assertEqual(told["quat"], [0.1, 0.2, -0.37, 0.9])
        self.assertIs(told["difference"], False)
        self.hold(told, told["facets"])
        self.assertGreater(len(told["events"]), 20)
        turned = self.data("sum", "shape:cube", "shape:octahedron", "--quat", "0.1,0.2,-0.37,0.9")
        self.assertEqual(turned["facets"], told["facets"])

    def test_the_difference(self):
        models = "shape:tetrahedron", "shape:tetrahedron", "--axis", "1,2,3"
        told, other = self.data("events", *models, "--difference"), self.data("events", *models)
        self.assertIs(told["difference"], True)
        self.hold(told, told["facets"])
        self.assertNotEqual([e["kappa"] for e in told["events"]], [e["kappa"] for e in other["events"]])

    def test_from_and_to(self):
        run = "events", "shape:cube", "shape:icosahedron", "--axis", "1,2,3"
        all_of_them = self.data(*run)
        some = self.data(*run, "--from", "100", "--to", "200")
        self.hold(some, some["facets"])
        self.assertEqual(some["events"], [e for e in all_of_them["events"] if 100 <= e["angle"][0] <= 200])
        # what is at the ends belongs to it
        told = self.data("events", "shape:cube", "shape:cube", "--from", "90", "--to", "180")
        self.assertEqual([e["kappa"] for e in told["events"]], [[1, 1], [0, 0]])

    def test_text_and_picture(self):
        picture = self.path / "turn.svg"
        text = self.good("events", "shape:cube", "shape:cube", "--plot", picture)
        self.assertRegex(text, r"(?m)^  90 +10 +8 +8\n  180 +10 +8 +8\n  270 +10 +8 +8\n"
                               r"  events +3, 10 facets before the first$")
        root = ElementTree.parse(picture).getroot()
        self.assertGreater(len(list(root.iter("{http://www.w3.org/2000/svg}path"))), 10)
        self.assertIn("3 events", picture.read_text())
        self.assertIn("shape:cube, turning, and shape:cube<", picture.read_text())
        drawn = self.good("events", "shape:cube", "shape:cube", "--plot", "-")
        self.assertEqual(drawn, picture.read_text())

    def test_refusals(self):
        pair = "events", "shape:cube", "shape:cube"
        self.bad(*pair, "--axis", "0,0,0", says="zero vector")
        self.bad(*pair, "--quat", "0,0,0,0", says="zero quaternion")
        self.bad(*pair, "--from", "20", "--to", "10", says="no range")
        self.bad(*pair, "--to", "361", says="no range")
        self.bad(*pair, "--plot", self.path / "turn.png", says=".svg")
        segment = self.path / "segment.off"
        segment.write_text("OFF\n2 0 0\n0 0 0\n1 0 0\n")
        self.bad("events", segment, "shape:cube", says="no facets to turn")


if __name__ == "__main__":
    main()
