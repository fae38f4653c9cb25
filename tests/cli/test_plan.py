#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette plan: verdicts on models whose answers are known, their proofs, which check/plan.py takes, and proofs that
were tampered with, which it refuses."""
import base64
import importlib.util
import json
import random
import re
import subprocess
import sys
from pathlib import Path

from command_test import CommandTest, main
from test_certify import boxes

ROOT = Path(__file__).resolve().parents[2]
CHECKER = ROOT / "check" / "plan.py"


def example_models():
    spec = importlib.util.spec_from_file_location("make_models", ROOT / "examples" / "plan" / "make_models.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


MODELS = example_models()


class PlanTest(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.text = MODELS.models()

    def model(self, name):
        suffix = ".off" if self.text[name].startswith("OFF") else ".obj"
        path = self.path / ("plan-" + name + suffix)
        if not path.exists():
            path.write_text(self.text[name])
        return path

    def check(self, *args):
        run = subprocess.run([sys.executable, "-B", str(CHECKER), *map(str, args)], capture_output=True, text=True,
                             check=False)
        self.assertEqual(run.returncode, 0 if run.stdout.startswith("proven: ") else 1, run.stderr)
        return run.returncode == 0

    def plan(self, robot, obstacles, start, goal, *options, checks=True):
        """The answer, whose proof holds."""
        models = [self.model(name) for name in (robot, *obstacles)]
        proof = self.path / "plan.json"
        told = self.data("plan", *models, "--translate-only", f"--from={start}", f"--to={goal}", "-o", proof, *options)
        self.assertTrue(not checks or self.check(proof, *models), told)
        self.assertEqual(json.loads(proof.read_text())["answer"], told["answer"])
        self.assertEqual("path" in told, told["answer"] == "path")
        return told["answer"]


class Plan(PlanTest):
    def test_window(self):
        turn = ",".join(map(repr, MODELS.WINDOW_TURN))
        for name, answer in (("window-24-9020", "no path"), ("window-96-9020", "path"), ("window-96-9010", "no path")):
            models = self.model("tetrahedron"), self.model(name)
            told = self.data("plan", *models, "--translate-only", f"--from=0,0,2,{turn}", f"--to=0,0,-2,{turn}",
                             "--bounds=-1,-1,-3,1,1,3")
            self.assertEqual(told["answer"], answer, name)

    def test_trap(self):
        self.assertEqual(self.plan("bug", ["trap"], "1.5,1.5,1.5", "20,20,20"), "path")
        self.assertEqual(self.plan("bug-large", ["trap"], "1.5,1.5,1.5", "20,20,20"), "no path")

    def test_burr(self):
        for seed, count, free in ((1, 2, {1, 2}), (4, 6, {2})):
            names = [f"burr-{seed}-{i}" for i in range(1, 7)]
            for i, name in enumerate(names[:count]):
                others = names[:i] + names[i + 1:]
                answer = self.plan(name, others, "0,0,0", "20,20,20", "--open", checks=seed == 4 and i == 1)
                self.assertEqual(answer, "path" if i + 1 in free else "no path", name)

    def test_bad_input(self):
        bug, trap = self.model("bug"), self.model("trap")
        good = ["plan", bug, trap, "--translate-only", "--from=1.5,1.5,1.5"]
        self.bad(*good, "--to=0,0,0", says=("to", "not free", "obstacle 0"))
        self.bad(*good, "--to=1,1,1", says=("to", "touches"))
        self.good(*good, "--to=1,1,1", "--open")
        self.bad(*good, says=("--to",))
        self.bad(*good, "--to=nan,1,1", says=("--to",))
        self.bad(*good, "--to=1,1", says=("--to",))
        self.bad(*good, "--to=20,20,20,0,0,0,0", says=("--to", "quaternion"))
        self.bad(*good, "--to=20,20,20,0,0,1,1", says=("turn",))
        self.bad(*good, "--to=20,20,20", "--bounds=0,0,0,9,9,9", says=("to", "bounds"))
        self.bad(*good, "--to=2,2,1.5", "--bounds=0,0,0,9,9,0", says=("bounds",))
        self.bad(*good, "--to=20,20,20", "--budget", "5", says=("more than 5 parts",))
        self.bad("plan", bug, trap, "--from=1.5,1.5,1.5", "--to=2,2,1.5", says=("--translate-only",))
        self.bad("plan", bug, self.path / "none.off", *good[3:], "--to=20,20,20", says=("none.off",))
        self.bad(*good, "--to=20,20,20", "-o", self.path / "no" / "plan.json", says=("plan.json",))

    def page(self, *args):
        """What the page of a plan holds: its data, and the proof or None."""
        page = self.path / "plan.html"
        self.good("plan", *args, "--page", page)
        text = page.read_text()
        return [json.loads(re.search(f'<script id="{name}" type="application/json">(.*?)</script>', text, re.S)[1])
                for name in ("data", "proof")]

    def test_pages(self):
        """The path, or the proof, is that of -o, with the bodies as they were read."""
        proof, out = self.path / "plan.json", [self.model("bug"), self.model("trap"), "--translate-only"]
        data, none = self.page(*out, "--from=1.5,1.5,1.5", "--to=4.5,4.5,13", "-o", proof)
        self.assertIsNone(none)
        self.assertEqual([pose[:3] for pose in data["poses"]], json.loads(proof.read_text())["path"])
        self.assertEqual((len(data["robot"]), len(data["obstacles"]), data["about"]),
                         (1, 1, "A path, by translations alone."))
        self.assertEqual(len(base64.b64decode(data["robot"][0]["points"])), 8 * 12)
        data, tree = self.page(self.model("bug-large"), *out[1:], "--from=1.5,1.5,1.5", "--to=4.5,4.5,13", "-o", proof)
        self.assertEqual((tree, data["poses"]), (json.loads(proof.read_text()), []))
        self.assertTrue(self.check(proof, self.model("bug-large"), self.model("trap")))
        peg = [self.model("peg-loose"), self.model("plate"), "--axis=0,1,0", "--bounds=0.5,0,-9,5.5,5,9"]
        data, none = self.page(*peg, "--from=1,2.5,4,90", "--to=1,2.5,-2,90")
        self.assertIsNone(none)
        self.assertTrue(len(data["poses"]) > 4 and data["ends"][0][:3] == [1, 2.5, 4])
        for a, b in zip(data["poses"], data["poses"][1:]):  # each goes or turns, not both
            self.assertTrue(a[:3] == b[:3] or a[3:] == b[3:], (a, b))
        large = [self.model("peg-large"), *peg[1:], "--from=1,2,5,0", "--to=1,2,-6,0"]
        data, tree = self.page(*large)
        self.good("plan", *large, "-o", proof)
        self.assertEqual((tree, data["poses"]), (json.loads(proof.read_text()), []))
        self.bad("plan", *large, "--page", self.path / "plan.pdf", says=("--page", ".html"))
        self.bad("plan", *large, "--page", proof, "-o", proof, says=(".html",))
        self.bad("plan", *large, "--page", "-", "--json", says=("--page - and --json",))
        self.assertTrue(self.good("plan", *large, "--page", "-").startswith("<!DOCTYPE html>"))

    def test_turns(self):
        """A bar and a plate with a slot: through, not, and files that say so."""
        bar = self.file("bar.obj", boxes(((-0.5, -2, -0.5), (0.5, 2, 0.5))))
        for width, answer in ((1.5, "path"), (0.9, "no path")):
            x = width / 2
            walls = ((-9, -9, -1), (-x, 9, 1)), ((x, -9, -1), (9, 9, 1)), ((-x, -9, -1), (x, -2.2, 1)), \
                    ((-x, 2.2, -1), (x, 9, 1))
            plate, proof = self.file("plate.obj", boxes(*walls)), self.path / "turns.json"
            told = self.data("plan", bar, plate, "--axis=0,0,2", "--bounds=-4,-4,-4,4,4,4", "--from=0,0,-3,-90",
                             "--to=0,0,3,30", "-o", proof)
            self.assertEqual((told["answer"], told["obstacle_pieces"], "ended" in told), (answer, 4, False))
            run = subprocess.run([sys.executable, "-B", ROOT / "check" / "turns.py", proof], capture_output=True,
                                 text=True, check=False)
            if answer == "path":
                self.assertEqual(json.loads(proof.read_text())["path"], told["path"])
                self.assertEqual((told["path"][0]["at"], told["path"][-1]["at"]), ([0, 0, -3], [0, 0, 3]))
            self.assertRegex(run.stdout, "proven: a path of" if answer == "path" else "proven: no path", run.stderr)
        good = ["plan", bar, plate, "--axis=0,0,1", "--from=0,0,-3", "--to=0,0,3,30"]
        tight = self.file("tight.obj", boxes(*(((a, b, -1), (c, d, 1)) for a, b, c, d in (
            (-9, -9, -.5, 9), (.5, -9, 9, 9), (-.5, -9, .5, -2.2), (-.5, 2.2, .5, 9)))))
        for options, ended, named in ((["--budget=9"], "parts", "--budget"), (["--arcs=8"], "arcs", "--arcs")):
            ask = [*good[:2], tight, *good[3:], "--bounds=-4,-4,-4,4,4,4", *options]
            told = self.data(*ask)
            self.assertEqual((told["answer"], told["ended"]), ("unknown", ended))
            self.assertRegex(self.good(*ask), f"^unknown, .*\n  ended by +{ended} .*: {named} allows more\n")
        self.bad(*good, says=("--bounds",))
        good.append("--bounds=-4,-4,-4,4,4,4")
        self.bad(*good, "--translate-only", says=("--translate-only",))
        self.bad(*good, "--open", says=("--open",))
        self.bad(*good, "--arcs=9", says=("arcs",))
        self.bad("plan", bar, plate, "--axis=0,0,0", *good[4:], says=("axis",))
        self.bad("plan", bar, plate, "--axis=0,0,1", "--from=0,0,0", *good[5:], says=("meets an obstacle",))
        self.bad("plan", bar, plate, "--translate-only", "--arcs=8", "--from=0,0,-3", "--to=0,0,3", says=("--arcs",))

    def test_any_motion(self):
        """A bar across a slot turns and goes through; a tetrahedron with a ball wider than the slot does not."""
        walls = ((-9, -9, -0.5), (-1, 9, 0.5)), ((1, -9, -0.5), (9, 9, 0.5)), ((-1, -9, -0.5), (1, -1, 0.5)), \
                ((-1, 1, -0.5), (1, 9, 0.5))
        plate, proof = self.file("plate.obj", boxes(*walls)), self.path / "motions.json"
        bar = self.file("bar.obj", boxes(((-2, -0.5, -0.5), (2, 0.5, 0.5))))
        told = self.data("plan", bar, plate, "--bounds=-1,-1,-4,1,1,4", "--from=0,0,-3", "--to=0,0,3,0,1,0,0.5",
                         "--threads=2", "-o", proof)
        self.assertEqual((told["answer"], told["obstacle_pieces"]), ("path", 4))
        self.assertEqual(json.loads(proof.read_text())["path"], told["path"])
        self.assertEqual((told["path"][0]["at"], told["path"][-1]["at"]), ([0, 0, -3], [0, 0, 3]))
        run = subprocess.run([sys.executable, "-B", ROOT / "check" / "motions.py", proof], capture_output=True,
                             text=True, check=False)
        self.assertRegex(run.stdout, "^proven: a path of", run.stderr)
        solid = self.file("solid.off", "OFF\n4 4 6\n9 9 9\n9 -9 -9\n-9 9 -9\n-9 -9 9\n"
                          "3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n")
        good = ["plan", solid, plate, "--from=0,0,-17", "--to=0,0,17"]
        for options, made, kind in (((), 0, "openings"), (("--boxes-alone",), 32, "motions")):
            told = self.data(*good, "--bounds=-1,-1,-18,1,1,18", *options, "-o", proof)
            self.assertEqual((told["answer"], told["boxes"], told["cells"] > 0), ("no path", made, not options))
            self.assertIn(kind, json.loads(proof.read_text()))
            run = subprocess.run([sys.executable, "-B", ROOT / "check" / "motions.py", proof], capture_output=True,
                                 text=True, check=False)
            self.assertTrue(run.stdout.startswith("proven: no path"), run.stdout + run.stderr)
        self.bad(*good, "--bounds=-1,-1,-18,1,1,18", "-o", "/dev/full", "--boxes-alone", says=("/dev/full: cannot",))
        self.bad(*good, "--bounds=-1,-1,-18,1,1,18", "-o", "/dev/full", says=("/dev/full: cannot write: No space",))
        self.bad(*good, says=("--bounds",))
        good.append("--bounds=-1,-1,-18,1,1,18")
        self.bad(*good, "--open", says=("--open",))
        self.bad(*good, "--arcs=8", says=("--arcs",))
        self.bad(*good, "--boxes=31", says=("--boxes",))
        self.bad(*good, "--threads=0", says=("--threads",))
        told = self.data(*good, "--dry-run", "--boxes=64", "-o", self.path / "dry.json")
        self.assertEqual((told["boxes"], told["robot_pieces"], told["obstacle_pieces"]), (64, 1, 4))
        self.assertTrue(told["seconds"] > 0 and not (self.path / "dry.json").exists())
        self.bad(*good, "--translate-only", "--dry-run", says=("--dry-run",))
        self.bad(*good, "--memory=0", says=("--memory",))
        self.bad(*good, "--axis=0,0,1", "--memory=9", says=("--memory", "--axis"))
        self.bad("plan", solid, plate, "--from=0,0,0", *good[4:], says=("from", "meets an obstacle"))
        self.bad("plan", solid, plate, "--from=0,0,-17,0,0,0,0", *good[4:], says=("--from", "quaternion"))
        self.bad(*good, "--translate-only", "--threads=2", says=("--threads",))

    def test_alphas_come_apart(self):
        """Two tubes that hang in each other, by turns and not by translations."""
        start, goal = (f"{x}," + ",".join(map(str, MODELS.ALPHA_LINKED[1:])) for x in (MODELS.ALPHA_LINKED[0], -3))
        for name in ("alpha-30", "alpha-50"):
            asked = "plan", self.model(name), self.model(name), f"--from={start}", f"--to={goal}"
            told = self.data(*asked, "--bounds=-4,-2,-2,2,2,2", "--boxes=32")
            self.assertEqual((told["answer"], told["robot_pieces"], told["obstacle_pieces"]), ("path", 10, 10), name)
        self.assertEqual(self.data(*asked, "--translate-only")["answer"], "no path")


class Proofs(PlanTest):
    def test_peg(self):
        bounds = "--bounds=0,0,-9,4,4,9"
        for peg, options, answer in (("tight", ["--open"], "path"), ("tight", [], "no path"), ("loose", [], "path"),
                                     ("large", ["--open"], "no path")):
            self.assertEqual(self.plan("peg-" + peg, ["plate"], "1,2,3", "1,2,-7", bounds, *options), answer, peg)
        # without bounds there is a way round the plate
        self.assertEqual(self.plan("peg-large", ["plate"], "1,2,3", "1,2,-7"), "path")

    def test_sets_of_solids_move_together(self):
        plate, peg = self.model("plate"), ((2, 2, 3), (3, 3, 4))
        proof = self.path / "sets.json"
        for other, answer in ((((3, 3, 5), (3.5, 3.5, 6)), "path"), (((5, 2, 3), (6, 3, 4)), "no path")):
            robot = self.file("robot.obj", boxes(peg, other))
            told = self.data("plan", robot, plate, "--translate-only", "--from=0.25,0.25,0", "--to=0.25,0.25,-9", "-o",
                             proof, "--bounds=-1,-1,-99,1,1,99")
            self.assertEqual((told["answer"], told["robot_pieces"]), (answer, 2))
            self.assertTrue(self.check(proof))
        self.assertTrue(self.good("plan", plate, robot, "--translate-only", "--from=0,0,0", "--to=0,0,99"))

    @staticmethod
    def tamper(rng, how, bad):
        piece = rng.choice(bad[rng.choice(["robot", "obstacles"])])
        if how == 0:  # a corner elsewhere
            rng.choice(piece["points"])[rng.randrange(3)] = "22/7"
        elif how == 1:  # a facet is missing
            piece["facets"].pop()
        elif bad["answer"] == "path":
            if how == 2:  # another end
                bad["to"][rng.randrange(3)] = "7"
            else:  # through the plate
                bad["path_exact"].insert(1, ["1/3", "2", "0"])
        elif how == 2:  # a free part is not blocked
            rng.choice([part for part in bad["tree"] if part[0] in ("start", "other")])[:] = ["blocked", 0, 0]
        else:  # all free parts are on one side
            for part in bad["tree"]:
                part[0] = "other" if part[0] == "start" else part[0]

    def test_tampered_proofs_are_refused(self):
        rng = random.Random(1)
        for robot, obstacle, start, goal, options in (
                ("peg-loose", "plate", "1,2,3", "1,2,-7", []),
                ("peg-tight", "plate", "1,2,3", "1,2,-7", ["--bounds=0,0,-9,4,4,9"]),
                ("peg-large", "plate", "1,2,3", "1,2,-7", ["--bounds=0,0,-9,4,4,9", "--open"])):
            models = [self.model(robot), self.model(obstacle)]
            self.plan(robot, [obstacle], start, goal, *options)
            proof = self.path / "plan.json"
            for number in range(4):
                bad = json.loads(proof.read_text())
                self.tamper(rng, number % 4, bad)
                wrong = self.path / "wrong.json"
                wrong.write_text(json.dumps(bad))
                self.assertFalse(self.check(wrong, *models), f"{robot}, {number}")
            self.assertFalse(self.check(proof, models[0], self.model("trap")))


if __name__ == "__main__":
    main()
