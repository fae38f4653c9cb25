#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette clash: a building against an oracle that knows boxes of voxels alone; models that are no solids.

The oracle divides space by the coordinates of two solids, whose facets are parallel to the axes, and finds by parity
which of the boxes between are in which: volumes, parts and what is shared are then counted box by box.
"""
import os
import subprocess
import xml.etree.ElementTree as ElementTree
from fractions import Fraction

from command_test import CommandTest, main
from test_certify import boxes

KINDS = ("apart", "touching", "protrusion", "piercing", "envelope", "duplicate")


def read_objects(text):
    """Facets as lists of corners, by name."""
    points, found = [], {}
    for word, *rest in (line.split() for line in text.splitlines() if line.strip()):
        if word == "v":
            points.append(tuple(int(x) for x in rest))
        elif word == "o":
            found[rest[0]] = []
        elif word == "f":
            found[list(found)[-1]].append([points[int(i) - 1] for i in rest])
    return found


class Voxels:
    """Which boxes between the coordinates of a solid are in it."""

    def __init__(self, facets):
        self.at = [sorted({p[k] for f in facets for p in f}) for k in range(3)]
        self.level = [f for f in facets if len({p[2] for p in f}) == 1]
        self.full = {(i, j, k) for i in range(len(self.at[0]) - 1) for j in range(len(self.at[1]) - 1)
                     for k in range(len(self.at[2]) - 1) if self.holds(i, j, k)}

    def holds(self, *place):
        x, y, z = ((self.at[k][i] + self.at[k][i + 1]) / 2 for k, i in enumerate(place))
        below = 0
        for facet in self.level:
            if facet[0][2] < z:
                inside = False
                for (ax, ay, _), (bx, by, _) in zip(facet, facet[1:] + facet[:1]):
                    if ax == bx and ax > x and min(ay, by) < y < max(ay, by):
                        inside = not inside
                below += inside
        return below % 2 == 1

    def among(self, at):
        """The same by coordinates that include its own."""
        index = [[sum(x <= value for x in self.at[k]) - 1 for value in at[k]] for k in range(3)]
        return {(i, j, k) for i in range(len(at[0]) - 1) for j in range(len(at[1]) - 1) for k in range(len(at[2]) - 1)
                if (index[0][i], index[1][j], index[2][k]) in self.full}


def parts(boxes_of):
    """Into how many parts that faces join boxes fall."""
    left, count = set(boxes_of), 0
    while left:
        count += 1
        stack = [left.pop()]
        while stack:
            i, j, k = stack.pop()
            for near in ((i - 1, j, k), (i + 1, j, k), (i, j - 1, k), (i, j + 1, k), (i, j, k - 1), (i, j, k + 1)):
                if near in left:
                    left.remove(near)
                    stack.append(near)
    return count


def verdict(a, b):
    """Kind, what is shared, volume."""
    at = [sorted(set(a.at[k]) | set(b.at[k])) for k in range(3)]
    own, other = a.among(at), b.among(at)
    both = own & other
    if not both:
        dimension = max((3 - abs(x) - abs(y) - abs(z) for i, j, k in own for x in (-1, 0, 1) for y in (-1, 0, 1)
                         for z in (-1, 0, 1) if (i + x, j + y, k + z) in other), default=-1)
        return ("apart", "touching")[dimension >= 0], ("nothing", "points", "edges", "facets")[dimension + 1], 0
    volume = sum((at[0][i + 1] - at[0][i]) * (at[1][j + 1] - at[1][j]) * (at[2][k + 1] - at[2][k]) for i, j, k in both)
    if both in (own, other):
        return ("envelope", "duplicate")[own == other], "volume", volume
    cut = parts(own - other) > parts(own) or parts(other - own) > parts(other)
    return ("protrusion", "piercing")[cut], "volume", volume


class Clash(CommandTest):
    def building(self, solids, seed):
        text = subprocess.run([os.environ["PIR_BUILDING"], str(solids), str(seed)], capture_output=True, text=True,
                              timeout=60, check=True).stdout
        return self.file("building.obj", text), read_objects(text)

    def test_building(self):
        solids = int(os.environ.get("PIR_TEST_SOLIDS", "120"))
        path, objects = self.building(solids, 1)
        told = self.data("clash", path)
        self.assertEqual((told["solids"], told["refused"]), (solids, []))
        found = {(pair["a"], pair["b"]): pair for pair in told["pairs"]}
        voxels = {name: Voxels(facets) for name, facets in objects.items()}
        counts, names = dict.fromkeys(KINDS, 0), list(voxels)
        for i, a in enumerate(names):
            for b in names[i + 1:]:
                if any(voxels[a].at[k][-1] < voxels[b].at[k][0] or voxels[b].at[k][-1] < voxels[a].at[k][0]
                       for k in range(3)):
                    self.assertNotIn((a, b), found)
                    continue
                kind, shared, volume = verdict(voxels[a], voxels[b])
                counts[kind] += kind != "apart"
                if kind == "apart":
                    self.assertNotIn((a, b), found)
                    continue
                pair = found[a, b]
                self.assertEqual((pair["kind"], pair["shared"]), (kind, shared), (a, b))
                self.assertEqual(Fraction(pair.get("volume_exact", "0")), volume, (a, b))
        self.assertEqual(told["counts"], counts)
        self.assertTrue(all(counts[kind] > 0 for kind in KINDS[1:]), counts)

    def test_walls_on_one_line(self):
        # they overlap by 50 mm, with all other faces aligned
        walls = self.file("walls.obj", boxes(((0, 0, 0), (4, 0.2, 3)), ((3.95, 0, 0), (8, 0.2, 3)),
                                             ((8, 0, 0), (9, 0.2, 3)), ((9.25, 0, 0), (10, 0.2, 3))))
        told = self.data("clash", walls, "--within", "0.25")
        kinds = {(pair["a"][-1], pair["b"][-1]): pair for pair in told["pairs"]}
        self.assertEqual({key: pair["kind"] for key, pair in kinds.items()},
                         {("0", "1"): "protrusion", ("1", "2"): "touching", ("2", "3"): "apart"})
        self.assertEqual(Fraction(kinds["0", "1"]["volume_exact"]), (4 - Fraction(3.95)) * Fraction(0.2) * 3)
        self.assertAlmostEqual(kinds["0", "1"]["depth"], 0.05, places=12)
        self.assertEqual(kinds["0", "1"]["direction"], [-1, 0, 0])
        self.assertEqual(kinds["2", "3"]["distance"], 0.25)

    def test_two_models(self):
        self.assertEqual(self.data("clash", "shape:cube", "shape:cube")["counts"]["duplicate"], 1)
        small = self.file("a.obj", boxes(((0, 0, 0), (1, 1, 1))))
        large = self.file("b.obj", boxes(((3, 0, 0), (4, 1, 1))))
        pair = self.data("clash", small, large)["pairs"][0]
        self.assertEqual((pair["kind"], pair["distance"], pair["point_a"][0], pair["point_b"][0]), ("apart", 2, 1, 3))
        self.assertIn("by 2\n", self.good("clash", small, large))

    def test_tolerance_ranks_only(self):
        of = self.file("of.obj", boxes(((0, 0, 0), (2, 2, 2)), ((1.5, 1, 1), (3.5, 3, 3)), ((9, 0, 0), (11, 2, 2)),
                                       ((10, 1, 1), (12, 3, 3))))
        plain, ranked = self.data("clash", of), self.data("clash", of, "--tolerance", "0.5")
        self.assertEqual(plain["counts"], ranked["counts"])
        self.assertEqual([pair["depth"] for pair in plain["pairs"]], [1, 0.5])
        self.assertEqual([pair["minor"] for pair in ranked["pairs"] if "minor" in pair], [False, True])

    def test_picture(self):
        path, _ = self.building(60, 2)
        self.good("clash", path, "-o", self.path / "clash.svg")
        picture = ElementTree.parse(self.path / "clash.svg").getroot()
        words = [text.text for text in picture.iter("{http://www.w3.org/2000/svg}text")]
        self.assertEqual(words, ["no clash", "protrusion", "piercing", "envelope", "duplicate"])
        self.assertGreater(len(list(picture.iter("{http://www.w3.org/2000/svg}path"))), 150)

    def test_what_is_no_solid_is_named_and_the_others_are_answered(self):
        folder = self.path / "folder"
        folder.mkdir()
        for i in range(2):
            (folder / f"wall{i}.obj").write_text(boxes(((i, 0, 0), (i + 1, 1, 1))))
        (folder / "open.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        (folder / "none.off").symlink_to(folder / "gone.off")
        (folder / "empty.obj").write_text("")
        done = self.run_command("clash", folder, "--json")
        self.assertEqual(done.returncode, 2)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 3)
        for name in ("empty.obj", "none.off", "open.off"):
            self.assertTrue(any(name in line for line in lines), (name, lines))
        self.assertIn('"touching":\t1', done.stdout)
        self.assertIn('"refused":\t[{', done.stdout)
        self.bad("clash", self.path / "nowhere", says=("nowhere", "No such file"))
        self.bad("clash", folder / "wall0.obj", "shape:cube", "--within", "-1", says=("--within",))


if __name__ == "__main__":
    main()
