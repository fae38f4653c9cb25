#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette plan by any motion, killed and gone on with: the same file; and journals that were changed.

PIR_TEST_KILLS says how often a run is killed (4), PIR_TEST_SEED when.
"""
import json
import os
import random
import re
import signal
import struct
import subprocess
import sys
import time
import unittest

from command_test import main, read_terminal, with_own_signals
from test_plan import MODELS, PlanTest

KILLS = int(os.environ.get("PIR_TEST_KILLS", "4"))
BOUNDS = ("--bounds=-1,-1,-2,1,1,2", "--from=0,0,-1.5", "--to=0,0,1.5")
MASK = 2 ** 64 - 1


def hashed(number, at, data):
    """FNV-1a over words of eight bytes, as a journal has it."""
    told = 0xcbf29ce484222325
    for word in (number, len(data), at, *(int.from_bytes(data[i:i + 8], "little") for i in range(0, len(data), 8))):
        told = (told ^ word) * 0x100000001b3 & MASK
    return told


def blocks(journal):
    """Number, place and bytes of each block."""
    at = 16
    while at < len(journal):
        number, size, told = struct.unpack_from("=QQQ", journal, at)
        data = journal[at + 24:at + 24 + size]
        assert len(data) == size and told == hashed(number, at, data)
        yield number, at, data
        at += 24 + size


def journal_of(header, made):
    """A journal of blocks, numbers and bytes, with hashes that match."""
    journal = header
    for number, data in made:
        journal += struct.pack("=QQQ", number, len(data), hashed(number, len(journal), data)) + data
    return journal


def number_of(chart, octant, middle):
    """The number of the block of one of the first boxes."""
    number = (4 * middle + chart) << 5 | 1
    for k in range(3):
        number = number << 18 | octant >> k & 1
    return number


# before the parts of a box: the hash of no translations that it is asked to block, and a list of no sums
UNASKED = struct.pack("=QQIIII", 0xcbf29ce484222325, 0, 0, 0, 0, 0)


def block_of(*cells):
    """A block of cells that are boxes, each a part of its own, at the middle of a box of rotations."""
    packed = struct.pack("=dIIII", 0, len(cells), 8 * len(cells), len(cells), 1)
    for part, (low, high) in enumerate(cells):
        packed += struct.pack("=ddddddII", *low, *high, 8, part)
    for low, high in cells:
        for i in range(8):
            packed += struct.pack("=ddd", *((high if i >> k & 1 else low)[k] for k in range(3)))
    return packed


class Resumed(PlanTest):
    def setUp(self):
        super().setUp()
        self.window(.2, 4)  # decided with the first 32 boxes
        self.out, self.part = self.path / "a.json", self.path / "a.json.part"

    def window(self, diameter, sides):
        model = self.file(f"window-{diameter}-{sides}.off", MODELS.window(diameter, sides))
        # each box by itself, so that a run takes a while
        self.job = [self.command, "plan", str(self.model("tetrahedron")), str(model), "--asymmetric", "--boxes-alone",
                    *BOUNDS]

    def start(self, *options):
        return subprocess.Popen([*self.job, "-o", str(self.out), *options], stdout=subprocess.DEVNULL,
                                preexec_fn=with_own_signals)

    def run_job(self, *options, job=None, out=None):
        return subprocess.run([*(job or self.job), "-o", str(out or self.out), *options], capture_output=True,
                              text=True, check=False)

    def whole(self):
        begun, path = time.monotonic(), self.path / "whole.json"
        run = self.run_job(out=path)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertFalse((self.path / "whole.json.part").exists())
        return path.read_bytes(), time.monotonic() - begun

    def wait_for(self, run, size):
        """Waits until a run has written so many bytes into its journal."""
        while run.poll() is None and not (self.part.exists() and self.part.stat().st_size >= size):
            time.sleep(0.001)

    def journal(self, size):
        """The journal of a run that is killed."""
        self.part.unlink(missing_ok=True)
        with self.start() as run:
            self.wait_for(run, size)
            run.kill()
        self.assertFalse(self.out.exists())
        return self.part.read_bytes()

    def finish(self, whole, *options):
        run = self.run_job("--resume", *options)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertEqual(self.out.read_bytes(), whole)
        self.assertFalse(self.part.exists())
        self.out.unlink()

    def test_runs_that_are_killed_lose_nothing(self):
        self.window(.3, 3)  # some boxes are divided
        whole, seconds = self.whole()
        seed = os.environ.get("PIR_TEST_SEED", "1")
        print("seed", seed)
        moments = random.Random(seed)
        for kill in range(KILLS):
            kept = self.part.stat().st_size if self.part.exists() else 0
            with self.start(*(["--threads=2"] if kill % 2 else []), *(["--resume"] if kill else [])) as run:
                try:
                    run.wait(moments.uniform(0.02, 0.4 * seconds))
                except subprocess.TimeoutExpired:
                    run.kill()
            if self.out.exists():  # it was faster
                self.assertEqual(self.out.read_bytes(), whole)
                self.out.unlink()
            elif kept:
                # the last block may not have been whole
                self.assertGreater(self.part.stat().st_size, kept - 2 ** 20)
        self.finish(whole)

    def test_an_interrupted_run_can_be_gone_on_with(self):
        whole, _ = self.whole()
        with self.start() as run:
            self.wait_for(run, 2000)
            run.send_signal(signal.SIGINT)
        self.assertEqual(sorted(p.name for p in self.path.glob("a.json*")), ["a.json.part"])
        self.finish(whole, "--threads=2")

    def test_an_unknown_answer_goes_on_with_more_boxes(self):
        self.window(.3, 3)
        run = self.run_job("--boxes=32")
        self.assertRegex(run.stdout,
                         "^unknown, .*\n  ended by +boxes .*: --boxes .*\n  kept +all boxes; --resume goes on")
        kept = self.part.stat().st_size
        for options, ended in ((["--boxes=40"], "boxes"), (["--memory=1"], "memory"), (["--budget=9"], "parts")):
            told = json.loads(self.run_job("--resume", *options, "--json").stdout)
            self.assertEqual((told["answer"], told["ended"]), ("unknown", ended))
            self.assertGreater(self.part.stat().st_size, kept)

    def test_a_journal_is_not_begun_anew_unasked(self):
        whole, _ = self.whole()
        journal = self.journal(2000)
        run = self.run_job()
        self.assertEqual((run.returncode, run.stdout, self.out.exists(), self.part.read_bytes()),
                         (2, "", False, journal))
        self.assertRegex(run.stderr, r"a\.json\.part: an earlier run has left this; --resume goes on .* remove it\n$")
        self.assertEqual(self.data(*self.job[1:], "--dry-run", "-o", self.out)["boxes"], 65536)  # keeps nothing
        self.finish(whole)
        self.assertEqual((self.run_job().returncode, self.out.read_bytes()), (0, whole))

    def test_a_damaged_journal_is_as_good_as_its_beginning(self):
        whole, _ = self.whole()
        journal, rng = self.journal(60000), random.Random(2)
        self.assertGreater(len(list(blocks(journal))), 1)
        for how in range(3):
            at = rng.randrange(16, len(journal))
            changed = bytearray(journal[:at] if how == 1 else journal)
            if how != 1:
                changed[at] ^= 1 << rng.randrange(8)
            self.part.write_bytes(changed + rng.randbytes(rng.randrange(3)))
            self.finish(whole)
        self.part.write_bytes(journal[:15])
        self.finish(whole)

    def test_a_journal_of_another_question_is_refused(self):
        journal = self.journal(20)
        other = self.file("other.off", MODELS.window(.25, 4))
        for job, part in (([*self.job[:-1], "--to=0,0,1.25"], journal), (self.job, b"x" * 20),
                          ([*self.job[:3], str(other), *self.job[4:]], journal)):
            self.part.write_bytes(part)
            run = self.run_job("--resume", job=job)
            self.assertEqual((run.returncode, self.out.exists(), self.part.read_bytes()), (2, False, part))
            self.assertRegex(run.stderr, r"a\.json\.part: it is of another question")

    def test_a_forged_journal_proves_nothing(self):
        first = [(chart, octant) for chart in range(4) for octant in range(8)]
        # boxes that say that start and goal are apart, but by other cells
        header = self.journal(16)[:16]
        apart = block_of(((-1, -1, -2), (1, 1, -1)), ((-1, -1, 1), (1, 1, 2)))
        self.part.write_bytes(journal_of(header, [(number_of(*box, 0), UNASKED + apart) for box in first]))
        run = self.run_job("--resume")
        self.assertRegex(run.stderr, "a.json.part: it has a box that is not the same again")
        self.assertEqual((run.returncode, self.out.exists()), (2, False))
        # boxes and middles that say that all is free
        free = block_of(((-1, -1, -2), (1, 1, 2)))
        self.part.write_bytes(journal_of(header, [(number_of(*box, middle), (b"" if middle else UNASKED) + free)
                                                  for box in first for middle in (0, 1)]))
        told = self.data(*self.job[1:], "-o", self.out, "--resume", "--boxes=32")
        self.assertEqual(told["answer"], "unknown")

    def test_two_processes_do_not_write_one_journal(self):
        whole, _ = self.whole()
        with self.start() as first:
            self.wait_for(first, 16)
            first.send_signal(signal.SIGSTOP)
            second = self.run_job("--resume")
            first.send_signal(signal.SIGCONT)
            self.assertRegex(second.stderr, r"a\.json\.part: another process is writing to it")
            self.assertEqual(first.wait(), 0)
        self.assertEqual(self.out.read_bytes(), whole)

    def test_a_terminal_shows_boxes_made_and_written(self):
        self.window(.4, 3)
        master, slave = self.open_terminal()
        with subprocess.Popen([*self.job, "-o", str(self.out)], stdout=subprocess.DEVNULL, stderr=slave) as run:
            os.close(slave)
            shown = b""
            while more := read_terminal(master, 60):
                shown += more
            self.assertEqual(run.wait(), 0)
        for total in (65536, 312):
            done = [int(n) for n in re.findall(rb"(\d+) of %d, [0-9.e+]+ a second" % total, shown)]
            self.assertEqual(done, sorted(done))
        self.assertRegex(shown, rb"\r\[")

    def test_what_is_wrong_is_told(self):
        job = self.job[1:]
        self.bad(*job, "--resume", says=("--resume", "-o"))
        self.bad(*job, "--resume", "-o", "-", says=("--resume", "-o"))
        job.remove("--asymmetric")
        job.remove("--boxes-alone")
        self.bad(*job, "--translate-only", "--resume", says=("--resume",))


if __name__ == "__main__":
    main()
