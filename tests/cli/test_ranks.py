#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette slice and plan as ranks of MPI: the same file from any number of them, and after ranks were killed.

Usage: test_ranks.py COMMAND [CLASS...]. Ends with 77, skipped, where mpirun is missing.
"""
import hashlib
import importlib.util
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

COMMAND = ""
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
# MPI does not free all that it takes, in plug-ins that are gone by the time leaks are looked for
RANKS = {**ENVIRONMENT, "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"}
JOB = ("shape:cube", "shape:gs2", "--grid", "hopf", "--level", "1")
LONG = ("shape:gs2", "shape:gs3", "--grid", "hopf", "--level", "2")


def launch(ranks, *args):
    return ["mpirun", "--oversubscribe", "-n", str(ranks), COMMAND, "slice", *map(str, args)]


def launch_plan(ranks, *args):
    return ["mpirun", "--oversubscribe", "-n", str(ranks), COMMAND, "plan", *map(str, args)]


def run(arguments, **keys):
    environment = RANKS if arguments[0] == "mpirun" else ENVIRONMENT
    return subprocess.run(arguments, capture_output=True, text=True, timeout=1800, env=environment, **keys)


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class Ranks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)

    def slice(self, name, *job):
        path = self.path / name
        done = run([COMMAND, "slice", *job, "-o", str(path)])
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return digest(path)


class Same(Ranks):
    def test_one_thread_two_and_ranks_make_the_same_file(self):
        expected = self.slice("one.h5", *JOB)
        self.assertEqual(self.slice("two.h5", *JOB, "--threads", "2"), expected)
        for ranks in (1, 2, 4):
            path = self.path / f"ranks{ranks}.h5"
            done = run(launch(ranks, *JOB, "-o", path, "--json"))
            self.assertEqual(done.returncode, 0, done.stderr)
            told = json.loads(done.stdout)  # of rank 0 alone
            self.assertEqual((told["slices"], told["resumed"]), (576, 0))
            self.assertEqual(digest(path), expected, f"{ranks} ranks")
        self.assertEqual(sorted(p.suffix for p in self.path.iterdir()), [".h5"] * 5)

    def test_a_file_that_is_there_is_made_anew_or_left(self):
        expected = self.slice("one.h5", *JOB)
        path = self.path / "one.h5"
        for more, resumed in (([], 0), (["--resume"], 576)):
            done = run(launch(2, *JOB, "-o", path, "--json", *more))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(json.loads(done.stdout)["resumed"], resumed)
            self.assertEqual(digest(path), expected)

    def test_ranks_of_several_threads(self):
        path = self.path / "threads.h5"
        done = run(launch(2, *JOB, "-o", path, "--threads", 2))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(digest(path), self.slice("one.h5", *JOB))

    def test_what_is_wrong_ends_all_ranks(self):
        done = run(launch(2, "shape:cube", "shape:nosuch", "--grid", "hopf", "--level", "0", "-o", self.path / "x.h5"))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("nosuch", done.stderr)
        done = run(launch(2, *JOB, "-o", self.path / "none" / "x.h5"))
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(list(self.path.iterdir()), [])


class Killed(Ranks):
    def ranks_of(self, launcher):
        """The processes of the command that the launcher has started."""
        found = []
        for stat in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = stat.read_text().rsplit(")", 1)[1].split()
                if int(fields[1]) == launcher and "pirouette" in os.readlink(stat.parent / "exe"):
                    found.append(int(stat.parent.name))
            except (OSError, IndexError):
                pass  # it has ended
        return sorted(found)

    def parts(self, path):
        return sum(part.stat().st_size for part in path.parent.glob(path.name + ".part*"))

    def test_a_rank_that_is_killed_loses_little(self):
        expected = self.slice("whole.h5", *LONG)
        whole = (self.path / "whole.h5").stat().st_size
        rng = random.Random(1)
        for moment in range(5):
            path = self.path / f"killed{moment}.h5"
            wanted, kept = rng.random() * 0.8 * whole, 0
            with subprocess.Popen(launch(2, *LONG, "-o", path), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  env=RANKS) as job:
                while job.poll() is None and self.parts(path) < wanted:
                    time.sleep(0.002)
                ranks = self.ranks_of(job.pid)
                if ranks:
                    kept = self.parts(path)
                    os.kill(rng.choice(ranks), signal.SIGKILL)
                self.assertNotEqual(job.wait(timeout=600), 0, "a rank was killed")
            self.assertFalse(path.exists())
            self.assertGreater(kept, 0)
            done = run(launch(2, *LONG, "-o", path, "--resume", "--json"))
            self.assertEqual(done.returncode, 0, done.stderr)
            # of what was there, each rank may lose the unit that it was appending
            self.assertGreater(json.loads(done.stdout)["resumed"], 0)
            self.assertEqual(digest(path), expected, f"moment {moment}, at {wanted:.0f} of {whole} bytes")


class Plans(Ranks):
    """By any motion: boxes of rotations are dealt, and the texts of the proof."""
    ENDS = ("--bounds=-1,-1,-2,1,1,2", "--from=0,0,-1.5", "--to=0,0,1.5", "--boxes-alone")

    def models(self, diameter, sides):
        path = Path(__file__).resolve().parents[2] / "examples" / "plan" / "make_models.py"
        spec = importlib.util.spec_from_file_location("make_models", path)
        models = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(models)
        robot, window = self.path / "robot.off", self.path / f"window-{sides}.off"
        robot.write_text(models.tetrahedron())
        window.write_text(models.window(diameter, sides))
        return robot, window

    def plan(self, job, name, ranks, *more):
        path = self.path / name
        arguments = launch_plan(ranks, *job) if ranks else [COMMAND, "plan", *map(str, job)]
        done = run([*arguments, "-o", str(path), "--json", *more])
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertFalse((self.path / (name + ".part")).exists() and json.loads(done.stdout)["answer"] != "unknown")
        return json.loads(done.stdout), path.read_bytes()

    def test_ranks_write_the_same_proof(self):
        job = (*self.models(.3, 3), *self.ENDS)  # some boxes are divided
        told, proof = self.plan(job, "one.json", 0)
        self.assertEqual(told["answer"], "no path")
        self.assertEqual(self.plan(job, "two.json", 2)[1], proof)
        # what was kept of 32 boxes by one process
        self.assertEqual(self.plan(job, "part.json", 0, "--boxes=32")[0]["answer"], "unknown")
        self.assertEqual(self.plan(job, "part.json", 3, "--resume", "--threads=2")[1], proof)

    def test_ranks_find_the_same_openings(self):
        job = (*self.models(.3, 3), *self.ENDS[:3])
        told, proof = self.plan(job, "one.json", 0)
        self.assertEqual((told["answer"], told["boxes"], told["cells"] > 0), ("no path", 0, True))
        self.assertEqual(self.plan(job, "two.json", 2, "--threads=2")[1], proof)

    def test_ranks_find_the_same_path(self):
        job = (*self.models(1.1, 8), *self.ENDS)
        told = [self.plan(job, "path.json", ranks)[0] for ranks in (0, 2)]
        self.assertEqual(told[0]["answer"], "path")
        self.assertEqual(*({**one, "seconds": 0} for one in told))

    def test_what_is_wrong_ends_all_ranks(self):
        robot, window = self.models(1.1, 8)
        for job, says in (((robot, window, *self.ENDS[:2], "--to=0,0,9"), "outside of the bounds"),
                          ((robot, self.path / "none.off", *self.ENDS), "none.off"),
                          ((robot, window, *self.ENDS, "-o", self.path / "none" / "a.json"), "none")):
            done = run(launch_plan(2, *job))
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(says, done.stderr)

    def test_ranks_are_killed_and_resumed(self):
        job = (*self.models(.2, 4), *self.ENDS)
        proof, part = self.plan(job, "one.json", 0)[1], self.path / "two.json.part"
        with subprocess.Popen(launch_plan(2, *job, "-o", self.path / "two.json"), stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, env=RANKS) as launched:
            while launched.poll() is None and not (part.exists() and part.stat().st_size > 16):
                time.sleep(0.002)
            launched.terminate()
            launched.wait(timeout=600)
        self.assertEqual(self.plan(job, "two.json", 2, "--resume")[1], proof)


if __name__ == "__main__":
    COMMAND = sys.argv.pop(1)
    if not shutil.which("mpirun"):
        print("no mpirun")
        sys.exit(77)
    unittest.main()
