#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench/cspace/schedule.py: what it simulates holds together, and docs/scale.md shows what it prints.

Usage: test_schedule.py ROOT
"""
import contextlib
import io
import pathlib
import random
import re
import shlex
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path[:0] = [str(ROOT / "bench" / "cspace")]
import schedule  # noqa: E402


def job_of(rng):
    return schedule.make_job(rng.randint(1, 400), rng.randint(1, 12), rng.randint(1, 40), rng.uniform(0.01, 2),
                             rng.uniform(1, 4), rng)


def calm(count, rng=None):
    """Cores of one node that none is lost of."""
    speeds = [rng.uniform(0.25, 1) if rng else 1.0 for _ in range(count)]
    return schedule.Machine(speeds, count, [], 0.0)


class Schedule(unittest.TestCase):
    def test_one_core_makes_one_unit_after_another(self):
        for seed in range(20):
            job = job_of(random.Random(seed))
            self.assertAlmostEqual(schedule.dealt(job, calm(1))[0], schedule.ideal(job, calm(1)), places=6)
            self.assertAlmostEqual(schedule.static(job, calm(1)), schedule.ideal(job, calm(1)), places=6)

    def test_the_mean_cost_is_what_was_asked_for(self):
        job = schedule.make_job(1000, 5, 10, 0.5, 3, random.Random(1))
        self.assertAlmostEqual(sum(cost for _, cost in job.units) / 5000, 0.5, delta=0.02)
        self.assertEqual(len(job.units), 500)

    def test_dealing_is_between_the_ideal_and_a_late_unit_more(self):
        for seed in range(60):
            rng = random.Random(seed)
            job, machine = job_of(rng), calm(rng.randint(1, 16), rng)
            best, longest = schedule.ideal(job, machine), max(cost for _, cost in job.units) / min(machine.speeds)
            took, lost, wasted = schedule.dealt(job, machine)
            self.assertGreaterEqual(took, best - 1e-9, seed)
            self.assertLessEqual(took, best + 2 * longest + 3, seed)
            self.assertEqual((lost, wasted), (0, 0.0))
            self.assertGreaterEqual(schedule.static(job, machine), best - 1e-9)

    def test_what_losses_cost(self):
        for seed in range(60):
            rng = random.Random(seed)
            job = schedule.make_job(400, 6, 10, 0.2, 2, rng)
            best = schedule.ideal(job, calm(8))
            losses = sorted((rng.uniform(0, best), rng.randrange(4)) for _ in range(3))
            took, lost, wasted = schedule.dealt(job, schedule.Machine([1.0] * 8, 2, losses, 5.0))
            longest = max(cost for _, cost in job.units)
            self.assertTrue(1 <= lost <= 3, seed)
            # each loss costs the restart, at most a unit of each core, and the node
            self.assertLessEqual(wasted, lost * 8 * longest + 1e-9, seed)
            self.assertGreaterEqual(took, best + 5.0 * lost - 1e-9, seed)
            self.assertLessEqual(took, 8 * best / (8 - 2 * lost) + lost * (5 + 3 * longest) + 2 * longest + 3, seed)

    def test_the_same_seed_gives_the_same_table(self):
        options = schedule.parse("--seconds 1e-4 --bytes 9 --pairs 20 --rotations 50000 --slices-per-unit 500 "
                                 "--nodes 1,3 --mtbf 1".split())
        self.assertEqual(schedule.plan(options), schedule.plan(options))
        self.assertEqual([row[0] for row in schedule.plan(options)], [1, 3])

    def test_the_page_shows_what_is_printed(self):
        page = (ROOT / "docs" / "scale.md").read_text(encoding="utf-8")
        blocks = re.findall(r"    python3 bench/cspace/schedule\.py (.*)\n\n([^|\n]+)\n\n<!--.*\n((?:\|.*\n)+)",
                            page)
        self.assertGreaterEqual(len(blocks), 1)
        for arguments, first, table in blocks:
            told, before = io.StringIO(), sys.argv
            sys.argv = ["schedule.py", *shlex.split(arguments)]
            with contextlib.redirect_stdout(told):
                schedule.main()
            sys.argv = before
            self.assertEqual(told.getvalue(), f"{first}\n{table}")


if __name__ == "__main__":
    unittest.main()
