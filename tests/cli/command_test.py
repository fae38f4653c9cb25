# SPDX-License-Identifier: MIT
"""What the tests of the `pirouette` command share: models, exact rotations, runs that must succeed or fail."""
import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction
from pathlib import Path

TETRAHEDRON = """OFF
4 4 6
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
"""
# a square pyramid with rational corners, and a point inside that is no corner of the hull
PYRAMID = """OFF # comment
6 0 0
-1/3 -1/3 0
1/3 -1/3 0
1/3 1/3 0
-1/3 1/3 0
1/7 -1/11 5/7
0 0 1/5
"""


def rotation(quat):
    """The exact matrix of a quaternion of doubles."""
    x, y, z, w = (Fraction(c) for c in quat)
    n = x * x + y * y + z * z + w * w
    return [
        [1 - 2 * (y * y + z * z) / n, 2 * (x * y - z * w) / n, 2 * (x * z + y * w) / n],
        [2 * (x * y + z * w) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - x * w) / n],
        [2 * (x * z - y * w) / n, 2 * (y * z + x * w) / n, 1 - 2 * (x * x + y * y) / n],
    ]


def numbers(values):
    return ",".join(repr(float(v)) for v in values)


def read_terminal(terminal, seconds):
    """What comes from a terminal's other side within so many seconds; nothing when that side is closed."""
    if not select.select([terminal], [], [], seconds)[0]:
        return b""
    try:
        return os.read(terminal, 4096)
    except OSError:
        return b""  # how Linux tells that the other side is closed


def with_own_signals():
    """Run in a child that is to be sent signals: whoever runs the tests may have it ignore them, as nohup does."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


class CommandTest(unittest.TestCase):
    command = ""  # the path of the built command
    answers_program = ""  # the one that asks the library itself
    faulty = ""  # the command with faults, empty where the linker cannot put them in

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)
        self.tetrahedron = self.file("tetrahedron.off", TETRAHEDRON)
        self.pyramid = self.file("pyramid.off", PYRAMID)

    def file(self, name, text):
        path = self.path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def run_command(self, *args):
        return subprocess.run([self.command, *map(str, args)], capture_output=True, text=True, timeout=600)

    def good(self, *args):
        """stdout of a run that must succeed, with nothing on stderr."""
        done = self.run_command(*args)
        self.assertEqual((done.returncode, done.stderr), (0, ""), args)
        return done.stdout

    def data(self, *args):
        """The object that a run prints: strict JSON, whose times are seconds or end in _ns."""
        told = json.loads(self.good(*args, "--json"), parse_constant=self.fail)
        self.assertEqual({key for key in told if re.search("time|second|_[munp]?s$", key)} - {"seconds"},
                         {"update_ns", "create_ns", "rebuild_walk_ns", "rebuild_cgm_ns", "brute_ns"} & set(told))
        return told

    def answers(self, kind, *args, **keys):
        """The library's own answers: a list of the values of each key, and of each row under "row"."""
        given = [f"{key}={value if isinstance(value, (str, Path)) else numbers(value)}" for key, value in keys.items()]
        done = subprocess.run([self.answers_program, kind, *map(str, args), *given], capture_output=True, text=True,
                              timeout=600)
        self.assertEqual((done.returncode, done.stderr), (0, ""), (kind, args, keys))
        told = {"row": []}
        for line in done.stdout.splitlines():
            key, *values = line.split()
            values = [float.fromhex(v) for v in values]
            told["row"].append(values) if key == "row" else told.__setitem__(key, values)
        return told

    def fault(self, kind, number, *args):
        """A run of the command in which a call goes wrong; see faulty.c."""
        if not self.faulty:
            self.skipTest("the linker cannot put faults into this build")
        came = self.path / "fault"
        done = subprocess.run([self.faulty, *map(str, args)], capture_output=True, text=True, timeout=600,
                              preexec_fn=with_own_signals,
                              env={**os.environ, "PIROUETTE_FAULT": f"{kind}:{number}",
                                   "PIROUETTE_FAULT_CAME": str(came)})
        self.fault_came = came.exists()
        came.unlink(missing_ok=True)
        return done

    def open_terminal(self):
        """The two sides of a terminal."""
        try:
            master, slave = pty.openpty()
        except OSError:
            self.skipTest("no pseudo-terminal to be had here")
        self.addCleanup(os.close, master)
        return master, slave

    def bad(self, *args, says=()):
        """A run that must end with status 2 and one line on stderr, which holds every word of `says`."""
        done = self.run_command(*args)
        self.assertEqual(done.returncode, 2, (args, done.stdout, done.stderr))
        self.assertEqual(done.stdout, "", args)
        self.assertTrue(done.stderr.startswith("pirouette: "), (args, done.stderr))
        self.assertTrue(done.stderr.endswith("\n"), args)
        self.assertEqual(done.stderr.count("\n"), 1, (args, done.stderr))
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, done.stderr, args)


def main():
    """Runs the tests of a file as `test_X.py COMMAND ANSWERS FAULTY [CLASS...]`."""
    CommandTest.command, CommandTest.answers_program, CommandTest.faulty = (sys.argv.pop(1) for _ in range(3))
    unittest.main()
