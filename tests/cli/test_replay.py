#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette replay."""
import os
import subprocess

from command_test import CommandTest, main


class Replay(CommandTest):
    def history(self):
        path = self.path / "wrong.history"
        subprocess.run([os.environ["PIR_WRITE_HISTORY"], path], check=True, timeout=600)
        return path

    def test_a_history_is_run(self):
        path = self.history()
        told = self.data("replay", path)
        self.assertEqual((told["calls"], told["refused"]), (11, 1))
        self.assertEqual([step["call"] for step in told["steps"]], ["pair"] + 10 * ["ask"])
        self.assertEqual(told["steps"][10]["refused"], "zero quaternion")
        self.assertEqual(told, self.data("replay", path))
        lines = self.good("replay", path).splitlines()
        self.assertEqual(len(lines), 12)
        self.assertIn("zero quaternion", lines[10])
        self.assertTrue(lines[11].endswith(f"11 calls, 1 refused, hash {told['hash']}"))

    def test_what_is_no_history_is_refused(self):
        path = self.history()
        whole = path.read_bytes()
        path.write_bytes(whole[:-1])
        self.bad("replay", path, says="cut, or changed")
        path.write_bytes(whole[:8] + b"\x01" + whole[9:])
        self.bad("replay", path, says="version 1")
        path.write_bytes(b"OFF\n")
        self.bad("replay", path, says=f"{path}: not a history")
        self.bad("replay", self.path / "none", says="none")
        self.bad("replay", says="FILE")


if __name__ == "__main__":
    main()
