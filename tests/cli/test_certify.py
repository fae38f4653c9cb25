#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette certify."""
from fractions import Fraction

from command_test import CommandTest, main


def box(low, high, first=0):
    """The lines of OBJ of a box, whose points are numbered from first + 1."""
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    facets = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [f"v {x} {y} {z}" for x, y, z in corners] + [
        "f " + " ".join(str(first + i + 1) for i in facet) for facet in facets]


def boxes(*bounds):
    """An OBJ text of a box each."""
    lines = []
    for i, (low, high) in enumerate(bounds):
        lines += [f"o box_{i}"] + box(low, high, 8 * i)
    return "\n".join(lines) + "\n"


class Certify(CommandTest):
    def volumes(self, pieces, model):
        told = self.data("certify", pieces, model)
        for name in ("solid", "added", "lost"):
            self.assertAlmostEqual(told[name]["volume"], float(Fraction(told[name]["exact"])), places=12)
        self.assertEqual(told["same"], told["added"]["exact"] == told["lost"]["exact"] == "0")
        return told["pieces"], Fraction(told["added"]["exact"]), Fraction(told["lost"]["exact"])

    def test_pieces_of_our_own_are_the_solid(self):
        solid = self.file("l.off", "OFF\n12 8 0\n0 0 0\n3 0 0\n3 1 0\n1 1 0\n1 3 0\n0 3 0\n0 0 1\n3 0 1\n3 1 1\n1 1 1\n"
                                   "1 3 1\n0 3 1\n6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n"
                                   "4 3 4 10 9\n4 4 5 11 10\n4 5 0 6 11\n")
        self.good("decompose", solid, "-o", self.path / "pieces")
        self.assertEqual(self.volumes(self.path / "pieces", solid), (2, 0, 0))
        self.assertEqual(self.volumes(solid, solid), (1, 2, 0))  # a piece is a hull
        self.assertIn("nothing", self.good("certify", self.path / "pieces", solid))

    def test_what_overlaps_counts_once(self):
        solid = self.file("solid.obj", boxes(((0, 0, 0), (4, 4, 4))))
        pieces = self.file("pieces.obj", boxes(((0, 0, 0), (3, 4, 4)), ((1, 0, 0), (5, 4, 4)), ((1, 0, 0), (5, 4, 3))))
        self.assertEqual(self.volumes(pieces, solid), (3, 16, 0))
        less = self.file("less.obj", boxes(((0, 0, 0), (1, 1, 1)), ((-1, 0, 0), (1, 1, 0.1))))
        self.assertEqual(self.volumes(less, solid), (2, Fraction(0.1), 63))

    def test_bad_input(self):
        solid = self.file("solid.obj", boxes(((0, 0, 0), (1, 1, 1))))
        self.bad("certify", self.path / "none", solid, says=("none",))
        self.bad("certify", solid, self.file("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
                 says=("open.off",))


if __name__ == "__main__":
    main()
