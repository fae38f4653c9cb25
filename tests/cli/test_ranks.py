#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette slice as ranks of MPI: the same file from any number of them, and after ranks were killed.

Usage: test_ranks.py COMMAND [CLASS...]. Ends with 77, skipped, where mpirun is missing.
"""
import hashlib
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


if __name__ == "__main__":
    COMMAND = sys.argv.pop(1)
    if not shutil.which("mpirun"):
        print("no mpirun")
        sys.exit(77)
    unittest.main()
