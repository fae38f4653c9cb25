#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--certificate of pirouette query and sum, with the checker as users run it: as a program of its own."""
import json
import subprocess
import sys
from pathlib import Path

from command_test import CommandTest, main

CHECKER = Path(__file__).resolve().parents[2] / "check" / "check.py"
FRAME = ("OFF\n16 16 0\n" + "".join(f"{x} {y} {z}\n" for z in (0, 1) for n in (0, 1) for x, y in
                                   ((n, n), (3 - n, n), (3 - n, 3 - n), (n, 3 - n))) +
         "".join(f"4 {a} {b} {b + 8} {a + 8}\n4 {b + 4} {a + 4} {a + 12} {b + 12}\n"
                 f"4 {b} {a} {a + 4} {b + 4}\n4 {a + 8} {b + 8} {b + 12} {a + 12}\n"
                 for a, b in ((0, 1), (1, 2), (2, 3), (3, 0))))
# an L: all but a corner of a box
CORNER = """OFF
12 8 0
0 0 0
3 0 0
3 1 0
1 1 0
1 3 0
0 3 0
0 0 1
3 0 1
3 1 1
1 1 1
1 3 1
0 3 1
6 5 4 3 2 1 0
6 6 7 8 9 10 11
4 0 1 7 6
4 1 2 8 7
4 2 3 9 8
4 3 4 10 9
4 4 5 11 10
4 5 0 6 11
"""
CUBE = "OFF\n9 0 0\n1 1 1\n1 1 -1\n1 -1 1\n1 -1 -1\n-1 1 1\n-1 1 -1\n-1 -1 1 # a comment\n-1 -1 -1\n1/2 1/3 0\n"
OBJ = "v 0.1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1e0\nf 1 2 3\nf 1 2 4\n"


class Certificates(CommandTest):
    def setUp(self):
        super().setUp()
        self.cube, self.obj = self.file("cube.off", CUBE), self.file("corner.obj", OBJ)
        self.certificate, self.answer = self.path / "certificate.json", self.path / "answer.json"

    def check(self, *args, checker="check.py"):
        """Exit status and text of the checker, which says nothing on stderr."""
        done = subprocess.run([sys.executable, "-B", CHECKER.parent / checker, *map(str, args)], capture_output=True,
                              text=True)
        self.assertEqual(done.stderr, "", args)
        return done.returncode, done.stdout

    def ask(self, p, q, *options):
        told = self.good("query", p, q, "--certificate", self.certificate, "--json", *options)
        self.answer.write_text(told, encoding="utf-8")

    def test_answers_are_proven(self):
        for translate, prove, claim in (("4,0,0", "state", "apart"), ("4,0,0", "number", "distance"),
                                        ("2,0.5,0", "number", "touching"), ("1,0.5,0", "state", "overlap"),
                                        ("1,0.5,0", "number", "depth")):
            self.ask(self.cube, self.cube, f"--translate={translate}", "--prove", prove)
            status, text = self.check(self.certificate, self.cube, self.cube, self.answer)
            self.assertEqual((status, text.split(",")[0].strip()), (0, f"proven: {claim}"))
        for p, q in ((self.tetrahedron, self.obj), (self.obj, self.pyramid)):
            self.ask(p, q, "--translate=0.3,0.1,-5", "--quat=1,2,3,4")
            self.assertEqual(self.check(self.certificate, p, q, self.answer)[0], 0)

    def test_depth_and_distance_are_told_as_squares(self):
        self.ask(self.cube, self.cube, "--translate=5,5,0")
        self.assertEqual(self.check(self.certificate, self.cube, self.cube),
                         (0, "proven: distance, distance_squared 18\n"))
        self.ask(self.cube, self.cube, "--translate=1.5,0,0")
        self.assertEqual(self.check(self.certificate, self.cube, self.cube), (0, "proven: depth, depth_squared 1/4\n"))

    def test_sums_are_proven(self):
        for options, claim in (((), "sum"), (("--difference", "--axis=1,1,0", "--angle=30"), "difference")):
            self.good("sum", self.cube, self.pyramid, *options, "--certificate", self.certificate)
            self.assertEqual(self.check(self.certificate, self.cube, self.pyramid), (0, f"proven: {claim}\n"))

    def test_sums_of_solids_are_proven(self):
        frame = self.file("frame.off", FRAME)
        question = ("--solid", "--quat=0,0,1,2", "--certificate", self.certificate)
        for options, claim in (((), "sum"), (("--difference",), "difference")):
            told = self.good("sum", frame, frame, *question, "--json", *options)
            status, text = self.check(self.certificate, frame, frame, checker="solid_sum.py")
            counts = "{vertices} vertices, {edges} edges, {facets} facets".format(**json.loads(told))
            self.assertEqual((status, text.split(", volume")[0]), (0, f"proven: {claim}, {counts}"))
        status, text = self.check(self.certificate, frame, self.cube, checker="solid_sum.py")
        self.assertEqual((status, text.split()[0]), (1, "refused:"))
        text = self.good("sum", frame, frame, "--solid", "--certificate=-")
        self.certificate.write_text(text, encoding="ascii")
        self.assertEqual(self.check(self.certificate, checker="solid_sum.py")[0], 0)

    def test_solids_are_proven(self):
        corner, checker = self.file("corner.off", CORNER), "solids.py"
        for translate, prove, words in (("2,2,0", "state", "apart"), ("1,1,0", "number", "touching"),
                                        ("2,2.5,0", "number", "distance, distance_squared 1"),
                                        ("0.5,0.5,0", "number", "overlap")):
            self.ask(corner, corner, "--solid", f"--translate={translate}", "--prove", prove)
            self.assertEqual(self.check(self.certificate, corner, corner, self.answer, checker=checker),
                             (0, f"proven: {words}\n"))
            self.assertEqual(self.check(self.certificate, corner, self.tetrahedron, checker=checker)[0], 1)
        text = self.good("query", corner, corner, "--solid", "--translate=4,0,0", "--certificate=-")
        self.certificate.write_text(text, encoding="ascii")
        self.assertEqual(self.check(self.certificate, corner, corner, checker=checker)[0], 0)
        status, text = self.check(self.certificate, corner, corner, self.answer, checker=checker)
        self.assertEqual((status, text), (1, "refused: Refused: the answer has another translation\n"))

    def test_the_failing_line_is_named(self):
        self.ask(self.cube, self.cube, "--translate=1.5,0,0")
        lines = self.certificate.read_text(encoding="ascii").split("\n")
        first = lines.index('"facets": [') + 1
        for at, text in ((first + 2, lines[first + 2].replace(lines[first + 2][1], "7", 1)), (first + 4, None)):
            kept = [text if i == at else line for i, line in enumerate(lines) if i != at or text]
            self.certificate.write_text("\n".join(kept), encoding="ascii")
            status, told = self.check(self.certificate, self.cube, self.cube)
            self.assertEqual(status, 1)
            number = first if text is None else at + 1
            self.assertTrue(told.startswith(f"{self.certificate}:{number}: refused: \"facets\""), told)

    def test_another_question_is_refused(self):
        self.ask(self.cube, self.cube, "--translate=4,0,0")
        moved = self.file("moved.off", CUBE.replace("\n1 1 1\n", "\n1 1 2\n"))
        self.assertEqual(self.check(self.certificate, self.cube, self.pyramid)[0], 1)
        self.assertEqual(self.check(self.certificate, moved, self.cube, self.answer)[0], 0)  # no nearer than before
        nearer = self.file("nearer.off", CUBE.replace("-1 1 1\n", "-2 1 1\n"))
        self.assertEqual(self.check(self.certificate, nearer, self.cube, self.answer)[0], 1)
        answer = json.loads(self.answer.read_text(encoding="utf-8"))
        for change in ({"state": "inside", "penetration": {"depth": 2}}, {"distance": 2.0001}, {"quat": [0, 0, 1, 1]},
                       {"translation": [4, 0, 1]}):
            self.answer.write_text(json.dumps({**answer, **change}), encoding="utf-8")
            self.assertEqual(self.check(self.certificate, self.cube, self.cube, self.answer)[0], 1, change)

    def test_what_cannot_be_read(self):
        self.certificate.write_text("[]", encoding="ascii")
        for arguments in ((), (self.cube,), (self.certificate, self.cube, self.path / "none.off"),
                          (self.cube, self.cube, self.cube)):
            done = subprocess.run([sys.executable, "-B", CHECKER, *map(str, arguments)], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
            self.assertIn("usage: check.py", done.stderr)

    def test_standard_output(self):
        text = self.good("query", self.cube, self.cube, "--translate=4,0,0", "--certificate", "-")
        self.certificate.write_text(text, encoding="ascii")
        self.assertEqual(self.check(self.certificate, self.cube, self.cube)[0], 0)

    def test_no_certificate(self):
        query = ("query", self.cube, self.cube, "--translate=4,0,0")
        self.bad(*query, "--prove=state", says=("--prove", "--certificate"))
        self.bad(*query, "--certificate", self.certificate, "--prove=all", says="--prove")
        for option in ("--merge=0.1", "--radius-p=1", "--radius-q=1"):
            self.bad(*query, "--certificate", self.certificate, option, says=option.split("=")[0])
            self.bad(*query, "--certificate", self.certificate, option, "--solid", says=option.split("=")[0])
        self.bad(*query, "--certificate=-", "--json", says="--certificate")
        solid = ("query", self.tetrahedron, self.tetrahedron, "--solid", "--translate=4,0,0")
        self.bad(*solid, "--certificate=-", "--json", says="--certificate")
        self.bad(*solid, "--certificate", self.path / "none" / "file", says="none")
        self.bad(*query, "--certificate", self.path / "none" / "file", says="none")
        for options in (("--merge=0.1",), ("--solid", "--open"), ("--solid", "--merge=0.1")):
            self.bad("sum", self.cube, self.cube, "--certificate", self.certificate, *options, says=options[-1][:6])
        line = self.file("line.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n")
        self.bad("sum", line, line, "--certificate", self.certificate, says="segment")
        self.assertFalse(self.certificate.exists())


if __name__ == "__main__":
    main()
