#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The command when memory runs out or the library errs."""
import json
import os
import re
import signal
import subprocess

from command_test import CommandTest, TETRAHEDRON, main


class MemoryTest(CommandTest):
    def left(self):
        return sorted(str(p.relative_to(self.path)) for p in self.path.rglob("*") if p.is_file() and not p.is_symlink())

    def exhaust(self, *args):
        """
        Lets each call that takes memory fail in turn, until none is left; a run that fails leaves no half file. Of the
        many for the parts of a JSON text, which all take one way, every seventh does.
        """
        before, number, step = self.left(), 0, 1
        self.assertEqual(self.run_command(*args).returncode, 0)
        whole = {name: (self.path / name).read_bytes() for name in set(self.left()) - set(before)}
        while True:
            for name in set(self.left()) - set(before):
                (self.path / name).unlink()
            number += step
            done = self.fault("memory", number, *args)
            step = 7 if "JSON text" in done.stderr else 1
            if not self.fault_came:
                break
            self.assertEqual((done.returncode, done.stdout), (2, ""), (number, args, done.stderr))
            self.assertRegex(done.stderr, r"^pirouette: [^\n]*(out of memory|Cannot allocate memory)[^\n]*\n$",
                             (number, args))
            for name in set(self.left()) - set(before):
                # the times of a chart are others in each run
                same = (self.path / name).read_bytes() == whole.get(name)
                self.assertTrue(same or (name == "chart.svg" and (self.path / name).read_text().endswith("</svg>\n")),
                                (name, number))
        self.assertEqual((done.returncode, done.stderr, sorted(set(self.left()) - set(before))),
                         (0, "", sorted(whole)))
        return number - step


class Memory(MemoryTest):
    def test_info_shape_and_sum(self):
        self.assertGreater(self.exhaust("info", self.tetrahedron, "--json"), 20)
        self.exhaust("info", "shape:cube")
        self.exhaust("shape", "cube", "--json", "-o", self.path / "a.off")
        (self.path / "link.off").symlink_to("sub.off")
        self.exhaust("sum", self.tetrahedron, self.pyramid, "--exact", "-o", self.path / "link.off")
        self.exhaust("sum", "shape:cube", self.pyramid, "--method", "hull")
        self.exhaust("sum", "shape:cube", self.pyramid, "--method", "object")
        self.exhaust("sum", "shape:cube", self.pyramid, "--method", "cgm", "--difference")

    def test_standard_input(self):
        if not self.faulty:
            self.skipTest("the linker cannot put faults into this build")
        for number in range(1, 20):
            done = subprocess.run([self.faulty, "info", "-"], input=TETRAHEDRON, capture_output=True, text=True,
                                  timeout=600,
                                  env={**os.environ, "PIROUETTE_FAULT": f"memory:{number}"})
            if done.returncode == 0:
                break
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, r"^pirouette: standard input: out of memory\n$")
        self.assertGreater(number, 2)


class MemoryOfRuns(MemoryTest):
    def test_cgm_and_query(self):
        self.exhaust("cgm", self.tetrahedron, self.pyramid, "--difference", "-o", self.path / "a.svg")
        for place in ("0,0,0", "3,0,0"):
            self.exhaust("query", "shape:cube", self.pyramid, f"--translate={place}", "--direction=1,0,0",
                         "--cast=-9,0,0", "-o",
                         self.path / "a.svg")
        places = self.file("places.csv", "1,2,3\n4,5,6\n")
        self.exhaust("query", "shape:cube", self.pyramid, "--batch", places, "-o", self.path / "a.csv")

    def test_json_of_a_query(self):
        self.exhaust("query", "shape:cube", self.pyramid, "--translate=3,0,0", "--direction=-1,0,0", "--cast=-9,0,0",
                     "--json")

    def test_track(self):
        self.exhaust("track", self.tetrahedron, self.pyramid, "--frames=2", "--verify", "--brute", "--tolerance=0.1",
                     "--plot",
                     self.path / "chart.svg")
        self.exhaust("track", self.tetrahedron, self.pyramid, "--frames=2", "--axis=0,0,1", "--verify", "--dump",
                     self.path / "dump")


class Mismatch(CommandTest):
    """A wrong sum is noticed, whichever comparison shows it; so is a comparison that comes out wrong."""

    def track(self, kind, number, *extra):
        args = ["track", "shape:gs2", self.pyramid, "--frames=40", *extra]
        done = self.fault(kind, number, *args, "--json")
        told = json.loads(done.stdout)
        text = self.fault(kind, number, *args)
        self.assertEqual((done.stderr, text.stderr), ("", ""))
        self.assertEqual(done.returncode, 1 if told["mismatches"] else 0)
        self.assertEqual(text.returncode, done.returncode)
        first = re.search(r"first difference +frame (\d+)\n", text.stdout)
        self.assertEqual(bool(first), bool(told["mismatches"]))
        if told["verified"]:
            self.assertIn(f"{told['verified']} frames, {told['mismatches']} differ from a rebuild\n", text.stdout)
        return told["mismatches"], int(first.group(1)) if first else None, told["verified"]

    def test_nothing_differs_without_a_fault(self):
        self.assertEqual(self.track("update", 1000, "--verify"), (0, None, 40))

    def test_a_tracked_sum_gone_astray(self):
        for extra in ([], ["--axis=0,0,1", "--steps=7"], ["--method=update"], ["--difference"]):
            for frame in (0, 17, 39):
                self.assertEqual(self.track("update", frame + 1, "--verify", *extra), (1, frame, 40), extra)

    def test_a_rebuilt_sum_gone_astray(self):
        self.assertEqual(self.track("walk", 12, "--verify"), (1, 11, 40))
        # of 40 frames every second is rebuilt by CGM, too
        self.assertEqual(self.track("cgm", 7, "--verify"), (1, 12, 40))

    def test_pairing_and_mesh_count_each(self):
        # two comparisons of pairings in an even frame, one in an odd one
        self.assertEqual(self.track("pairing", 1, "--verify"), (1, 0, 40))
        self.assertEqual(self.track("pairing", 2, "--verify"), (1, 0, 40))
        self.assertEqual(self.track("pairing", 3, "--verify"), (1, 1, 40))
        self.assertEqual(self.track("pairing", 4, "--verify"), (1, 2, 40))
        self.assertEqual(self.track("mesh", 6, "--verify"), (1, 5, 40))

    def test_a_region_and_a_tolerance_are_compared_too(self):
        self.assertEqual(self.track("update", 9, "--verify", "--region=0,0,1,60"), (1, 8, 40))
        self.assertEqual(self.track("update", 9, "--verify", "--tolerance=1e-9"), (1, 8, 40))
        # a pairing that stays behind is held against one of the rotation that it stayed at
        self.assertEqual(self.track("pairing", 30, "--verify", "--tolerance=0.5", "--steps=5000")[0], 1)
        self.assertEqual(self.track("walk", 70, "--verify", "--tolerance=0.5", "--steps=5000")[0], 1)

    def test_only_frames_that_are_looked_at_are_found_wrong(self):
        self.assertEqual(self.track("update", 11, "--verify-every=5"), (1, 10, 8))
        self.assertEqual(self.track("update", 12, "--verify-every=5"), (0, None, 8))
        self.assertEqual(self.track("update", 11), (None, None, 0))


class Interrupt(CommandTest):
    ARGS = ["track", "shape:gs2", "shape:cube", "--frames=40", "--verify-every=3"]

    def test_a_run_ends_after_the_frame_in_which_a_signal_came(self):
        for number in (1, 2, 31, 39, 40):
            done = self.fault("signal", number, *self.ARGS, "--json")
            told = json.loads(done.stdout)
            self.assertEqual((done.returncode, done.stderr), (-signal.SIGINT, ""))
            self.assertEqual((told["frames"], told["interrupted"]), (number, number < 40))
            self.assertEqual((told["updates"] + told["rebuilds"], told["verified"]), (number, (number + 2) // 3))
            self.assertEqual(told["mismatches"], 0)
            # what is told of these frames is what a run of so many tells
            whole = self.data(*self.ARGS[:3], f"--frames={number}", "--verify-every=3")
            for key in ("checked_per_frame", "repaired_per_frame", "signs"):
                self.assertEqual(told[key], whole[key])
            text = self.fault("signal", number, *self.ARGS)
            self.assertIn(f" {number} frames, 500 steps to a turn", text.stdout)
            self.assertEqual("\n  interrupted, 40 frames were asked for\n" in text.stdout, number < 40)
            self.assertNotIn("nan", text.stdout)

    def test_a_second_signal_does_not_wait(self):
        chart = self.path / "chart.svg"
        done = self.fault("signals", 9, *self.ARGS, "--plot", chart)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (-signal.SIGINT, "", ""))
        self.assertEqual(sorted(p.name for p in self.path.iterdir()), ["pyramid.off", "tetrahedron.off"])


if __name__ == "__main__":
    main()
