#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Runs that write one output at the same time, runs that are killed, at a random moment or between two steps of their work
on files, and file systems without locks: an output is always whole or as it was before, a run that ends well has put
its own there, and nothing is left that the next run does not remove.

PIR_TEST_ROUNDS says how many rounds (10), PIR_TEST_SEED what their random numbers begin with.
"""
import hashlib
import os
import random
import re
import signal
import subprocess
import time
import unittest

from command_test import CommandTest, main, with_own_signals

ROUNDS = int(os.environ.get("PIR_TEST_ROUNDS", "10"))
SEED = os.environ.get("PIR_TEST_SEED", "1")
STAGES = os.environ.get("PIR_STAGES", "")  # stages.c, built
REFUSED = (r"is making it|another process is writing to it|it is of another job|cannot write into it: another run does|"
           r"ended after \d+ of \d+ slices, which are kept")
SCENE = """{"seconds": 0.1, "shapes": {"box": {"model": "shape:cube"}},
"bodies": [{"shape": "box", "kind": "moving", "position": [0, 0, 1]}]}"""


def digest(path):
    """The bytes of a file in few words, or None where there is none."""
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else None


class Race(CommandTest):
    def setUp(self):
        super().setUp()
        self.random = random.Random(f"{SEED} {self.id()}")
        self.spent = 0.1  # seconds of a run that is left alone

    def slicing(self, model, level=0):
        return ["slice", "shape:cube", model, "--grid", "hopf", "--level", level, "--slices-per-unit", 16, "-o"]

    def start(self, args, **environment):
        run = subprocess.Popen([self.command, *map(str, args)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True, preexec_fn=with_own_signals,
                               env={**os.environ, **environment})
        self.addCleanup(self.end, run)
        return run

    @staticmethod
    def end(run):
        run.kill()
        run.wait()
        run.stderr.close()

    def tell(self, run):
        """The status of a run and what it said."""
        said = run.communicate(timeout=300)[1]
        return run.returncode, said

    def alone(self, args, output):
        """What an undisturbed run writes."""
        began = time.monotonic()
        self.good(*args, output)
        self.spent = time.monotonic() - began
        made = digest(output)
        output.unlink()
        return made

    def left(self, output):
        return sorted(os.listdir(output.parent))

    def race(self, jobs, output):
        """Runs two or three of the jobs at once, some killed; the index of each run's job and its status."""
        runs = []
        for _ in range(self.random.choice((2, 2, 3))):
            job = self.random.randrange(len(jobs))
            more = [word for word in jobs[job][1] if self.random.random() < 0.5]
            runs.append((job, self.start([*jobs[job][0], output, *more])))
            time.sleep(self.random.choice((0, self.random.uniform(0, self.spent))))
        for _, run in runs:
            if self.random.random() < 0.4:
                time.sleep(self.random.uniform(0, self.spent))
                run.send_signal(self.random.choice((signal.SIGKILL, signal.SIGTERM)))
        return [(job, *self.tell(run)) for job, run in runs]

    def put_old(self, output, jobs):
        """What stands there before: nothing, another file, or what one of the jobs makes."""
        kind = self.random.randrange(2 + len(jobs))
        if kind == 1:
            output.write_bytes(b"old")
        elif kind > 1:
            self.good(*jobs[kind - 2][0], output)
        return digest(output)

    def rounds(self, jobs, output, rounds):
        """`jobs`: for each its arguments and words that it may have."""
        print(f"{self.id()}: {rounds} rounds, PIR_TEST_SEED={SEED}")
        made = [self.alone(job[0], output) for job in jobs]
        for number in range(rounds):
            where = f"round {number} of {self.id()}, seed {SEED}"
            old = self.put_old(output, jobs)
            ended = self.race(jobs, output)
            self.check(where, ended, old, made, output)
            last = self.random.randrange(len(jobs))
            resume = [word for word in jobs[last][1] if word == "--resume" and len(jobs) == 1 and old in (None, *made)]
            done = self.run_command(*jobs[last][0], output, *resume)
            self.assertEqual((done.returncode, done.stderr), (0, ""), where)
            self.assertEqual(digest(output), made[last], where)
            self.assertEqual(self.left(output), [output.name], f"{where}: after {ended}")
            output.unlink()

    def check(self, where, ended, old, made, output):
        """`old`: what is there where no run has ended well."""
        there = digest(output)
        self.assertIn(there, [old, *made], f"{where}: neither whole nor as it was, after {ended}")
        for job, status, said in ended:
            self.assertIn(status, (0, 2, -signal.SIGKILL, -signal.SIGTERM), (where, said))
            if status == 2:
                self.assertRegex(said, REFUSED, where)
        good = {job for job, status, _ in ended if status == 0}
        ended_early = {job for job, status, _ in ended if status < 0}  # it may have been after the rename
        if good:
            self.assertIn(there, [made[job] for job in good | ended_early], f"{where}: after {ended}")

    def folder_of(self, name):
        (self.path / "out").mkdir()
        return self.path / "out" / name


class Rounds(Race):
    def test_slices_of_one_job(self):
        self.rounds([(self.slicing("shape:gs2"), ["--resume", "--threads=2"])], self.folder_of("a.h5"), ROUNDS)

    def test_slices_of_two_jobs(self):
        self.rounds([(self.slicing("shape:gs2"), ["--resume", "--threads=2"]),
                     (self.slicing("shape:octahedron"), ["--threads=2"])], self.folder_of("a.h5"), (ROUNDS + 2) // 3)

    def test_slices_with_sections(self):
        self.rounds([([*self.slicing("shape:gs2")[:-1], "--planar", "z=0.1", "-o"], ["--resume"])],
                    self.folder_of("a.h5"), (ROUNDS + 4) // 5)

    def test_outputs_of_other_subcommands(self):
        slices, scene = self.path / "slices.h5", self.file("scene.json", SCENE)
        self.good(*self.slicing("shape:cube"), slices)
        places = self.file("places.csv", "".join(f"{k},0,0\n" for k in range(4000)))
        writers = [(".off", ["sum", "shape:gs4", "shape:gs3", "-o"], ["sum", "shape:gs4", "shape:gs4", "-o"]),
                   (".stl", ["shape", "geodesic?level=30", "-o"], ["shape", "geodesic?level=31", "-o"]),
                   (".csv", ["query", "shape:gs2", "shape:gs2", "--batch", places, "-o"],
                    ["query", "shape:gs2", "shape:cube", "--batch", places, "-o"]),
                   (".svg", ["cgm", "shape:gs2", "-o"], ["view", slices, "-o"]),
                   (".html", ["view", slices, "-o"], ["simulate", scene, "-o"]),
                   (".obj", ["decompose", "shape:gs2", "-o"], ["shape", "gs2", "-o"]),
                   (".vtkhdf", ["view", slices, "-o"], ["view", slices, "--every", 2, "-o"])]
        output = self.folder_of("a")
        for ending, *jobs in writers:
            self.rounds([(job, []) for job in jobs], output.with_suffix(ending), (ROUNDS + 6) // 7)


class Holder(Race):
    """A run that is stopped in the middle of its work, so that it holds what it holds for as long as others take."""

    def hold(self, run, path):
        while not path.exists():
            self.assertIsNone(run.poll())
            time.sleep(0.002)
        run.send_signal(signal.SIGSTOP)

    def test_who_makes_the_file_is_named(self):
        output = self.folder_of("a.h5")
        first = self.start([*self.slicing("shape:gs3", 2), output])
        self.hold(first, output.parent / "a.h5.part0")
        self.bad(*self.slicing("shape:gs2"), output,
                 says=f"a.h5: process {first.pid} on {os.uname().nodename} is making it")
        first.kill()
        first.wait()
        self.assertEqual(self.left(output), ["a.h5.lock", "a.h5.part0"])
        self.good(*self.slicing("shape:gs2"), output)
        self.assertEqual(self.left(output), ["a.h5"])

    def test_a_folder_is_written_by_one_run(self):
        frames = ["track", self.tetrahedron, self.pyramid, "--dump", self.path / "out", "--frames"]
        first = self.start([*frames, 1000000])
        self.hold(first, self.path / "out" / "frame-000001.off")
        for args in ([*frames, 2], ["decompose", self.tetrahedron, "-o", self.path / "out"]):
            self.bad(*args, says="out: cannot write into it: another run does")
        first.kill()
        first.wait()
        self.good(*frames, 2)


@unittest.skipUnless(STAGES, "nothing can be preloaded here")
class Stages(Race):
    """The command with stages.c preloaded."""

    def preloaded(self, args, **environment):
        return self.tell(self.start(args, LD_PRELOAD=STAGES, ASAN_OPTIONS="verify_asan_link_order=0",
                                    **{f"PIROUETTE_{name}": str(value) for name, value in environment.items()}))

    def each_stage(self, args, output, old, resume):
        """Kills a run before each of its steps, or before some of them, until one is not reached."""
        made = self.alone(args, output)
        stride = 1 if ROUNDS >= 100 else 7
        stage = self.random.randrange(1, stride + 1)
        while True:
            where = f"stage {stage} of {args[0]}, seed {SEED}"
            if old:
                output.write_bytes(b"old")
            before = digest(output)
            number = self.random.choice((signal.SIGKILL, signal.SIGTERM))
            status, said = self.preloaded([*args, output], STAGE=stage, SIGNAL=int(number))
            self.assertIn(status, (0, -number, 2), (where, said))
            there = digest(output)
            self.assertIn(there, (before, made) if status else (made,), where)
            again = ["--resume"] if resume and self.random.random() < 0.5 and not old else []
            self.good(*args, output, *again)
            self.assertEqual(digest(output), made, where)
            self.assertEqual(self.left(output), [output.name], where)
            output.unlink()
            if status == 0:
                return stage
            stage += stride

    def test_a_run_that_is_killed_between_two_steps(self):
        output = self.folder_of("a.h5")
        self.assertGreater(self.each_stage(self.slicing("shape:cube"), output, False, True), 30)
        self.assertGreater(self.each_stage(self.slicing("shape:cube"), output, True, True), 30)
        for ending, args in ((".off", ["sum", self.tetrahedron, self.pyramid, "-o"]),
                             (".svg", ["cgm", "shape:gs2", "-o"])):
            self.assertGreater(self.each_stage(args, output.with_suffix(ending), True, False), 4)

    def test_without_locks(self):
        output = self.folder_of("a.h5")
        made = self.alone(self.slicing("shape:cube"), output)
        self.assertEqual(self.preloaded([*self.slicing("shape:cube"), output], NO_LOCKS=1), (0, ""))
        self.assertEqual((digest(output), self.left(output)), (made, ["a.h5"]))
        # a run that was killed has left its lock, which no one can tell from that of a run at work
        self.preloaded([*self.slicing("shape:cube"), output], NO_LOCKS=1, STAGE=20)
        for more in ([], ["--resume"]):
            status, said = self.preloaded([*self.slicing("shape:cube"), output, *more], NO_LOCKS=1)
            self.assertEqual(status, 2)
            self.assertRegex(said, r"a\.h5\.lock: process \d+ on \S+ has left it or is at work, and this file system "
                                   r"has no locks; remove it when no run is\n$")
        (output.parent / "a.h5.lock").unlink()
        self.assertEqual(self.preloaded([*self.slicing("shape:cube"), output], NO_LOCKS=1), (0, ""))
        self.assertEqual((digest(output), self.left(output)), (made, ["a.h5"]))
        # a temporary file of another run is passed over
        args = ["sum", self.tetrahedron, self.pyramid, "-o", output.with_suffix(".off")]
        for number in range(2):
            self.preloaded(args, NO_LOCKS=1, STAGE=3)
        self.assertEqual(self.preloaded(args, NO_LOCKS=1), (0, ""))
        self.assertEqual(len([name for name in self.left(output) if ".pirouette-" in name]), 2)
        self.good(*args)
        self.assertEqual(self.left(output), ["a.h5", "a.off"])


class WithoutMpi(Race):
    """A build without MPI, started as one of several ranks."""

    def test_several_ranks_are_refused(self):
        output = self.folder_of("a.h5")
        for name, value in (("OMPI_COMM_WORLD_SIZE", "3"), ("PMI_SIZE", "2"), ("PMIX_RANK", "1")):
            done = subprocess.run([self.command, *map(str, self.slicing("shape:cube")), output], capture_output=True,
                                  text=True, env={**os.environ, name: value})
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, rf"^pirouette: {name} is {value}, .* no MPI: .*-Dmpi=enabled.*\n$")
            self.assertEqual(self.left(output), [])
        done = subprocess.run([self.command, *map(str, self.slicing("shape:cube")), output], capture_output=True,
                              text=True, env={**os.environ, "OMPI_COMM_WORLD_SIZE": "1", "PMIX_RANK": "0"})
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    main()
