#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Where results go, and what is left when that fails."""
import os
import subprocess
import unittest

from command_test import CommandTest, main


class BadOutputs(CommandTest):
    def leaves_nothing(self, before):
        self.assertEqual(sorted(os.listdir(self.path)), before)

    def test_files_that_cannot_be_written(self):
        before = sorted(os.listdir(self.path))
        pair = [self.tetrahedron, self.pyramid]
        self.bad("sum", *pair, "-o", self.path / "none" / "sum.off", says="sum.off")
        self.bad("sum", *pair, "-o", self.path / "sum.xyz", says="sum.xyz")
        self.bad("sum", *pair, "--exact", "-o", self.path / "sum.svg", says="sum.svg")
        self.bad("shape", "cube", "-o", self.path / "none" / "cube.off", says="cube.off")
        self.bad("shape", "cube", "-o", "", says="")
        self.bad("track", *pair, "--plot", self.path / "none" / "plot.svg", says="plot.svg")
        self.bad("track", *pair, "--plot", self.path / "plot.png", says=["plot.png", ".svg"])
        self.bad("track", *pair, "--dump", self.path / "none" / "dump", says="dump")
        self.bad("track", *pair, "--dump", self.tetrahedron, says="tetrahedron.off")
        self.bad("track", *pair, "--every", "5", says="--dump")
        self.leaves_nothing(before)

    def test_a_plot_over_a_folder_leaves_no_other_file(self):
        (self.path / "plot.svg").mkdir()
        before = sorted(os.listdir(self.path))
        self.bad("track", self.tetrahedron, self.pyramid, "--frames", "3", "--plot", self.path / "plot.svg",
                 says="plot.svg")
        self.leaves_nothing(before)

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full here")
    def test_a_full_device(self):
        for args in (["info", "shape:cube"], ["info", "shape:cube", "--json"], ["--help"], ["sum", "--help"],
                     ["track", "shape:cube", "shape:cube", "--frames", "2"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([self.command, *args], stdout=full, stderr=subprocess.PIPE,
                                      text=True, timeout=600)
            self.assertEqual(done.returncode, 2, args)
            self.assertRegex(done.stderr, r"^pirouette: standard output: [^\n]+\n$")

    def test_a_reader_that_went_away(self):
        reader, writer = os.pipe()
        os.close(reader)
        with os.fdopen(writer, "w") as pipe:
            done = subprocess.run([self.command, "shape", "--list"], stdout=pipe, stderr=subprocess.PIPE, text=True,
                                  timeout=600)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^pirouette: standard output: [^\n]+\n$")


if __name__ == "__main__":
    main()
