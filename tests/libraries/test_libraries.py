# SPDX-License-Identifier: MIT
"""What the libraries and the command load, by ldd, and the names that they give, by nm.

Usage: test_libraries.py FOLDER [COMMAND SLICES]. FOLDER has the shared libraries; COMMAND is `pirouette`, SLICES
`pirouette-slices`.
"""
import os
import re
import subprocess
import sys
import time
import unittest

# of every program, and of what sanitizers and coverage add to one
SYSTEM = re.compile(r"linux-vdso|linux-gate|ld-linux|lib(c|m|pthread|gcc_s|dl|rt)\.so|lib(a|ub|t|l)san|libclang_rt"
                    r"|libstdc")
CORE = {"libgmp"}
FOLDER, PROGRAMS = "", []


def loads(path):
    """The names of the libraries that a file loads in the end, without those of every program and our own."""
    said = subprocess.run(["ldd", path], capture_output=True, text=True, check=True).stdout
    names = [line.split()[0].rpartition("/")[2] for line in said.splitlines() if line.strip()]
    assert "not found" not in said, said
    return {name.split(".so")[0] for name in names if not SYSTEM.match(name)
            and not name.startswith("libpirouette")}, {name.split(".so")[0] for name in names}


def gives(path):
    said = subprocess.run(["nm", "-D", "--defined-only", path], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1] for line in said.splitlines()}


class Libraries(unittest.TestCase):
    def library(self, name):
        return os.path.join(FOLDER, f"lib{name}.so")

    def test_a_game_loads_gmp_and_libm(self):
        others, every = loads(self.library("pirouette"))
        self.assertEqual(others, CORE)
        self.assertIn("libm", every)

    def test_the_libraries_beside_load_the_core_and_their_own(self):
        others, every = loads(self.library("pirouette-ccd"))
        self.assertLessEqual(others, CORE | {"libccd"})
        self.assertEqual("libpirouette" in every, "libccd" in every)
        others, every = loads(self.library("pirouette-cspace"))
        self.assertIn("libpirouette", every)
        self.assertFalse({"libccd", "libassimp"} & others, others)

    def test_the_command_loads_what_answers_alone(self):
        if not PROGRAMS:
            self.skipTest("no command in this build")
        others, every = loads(PROGRAMS[0])
        self.assertLessEqual(others, CORE | {"libcjson", "libpng16", "libz"})
        self.assertNotIn("libpirouette-cspace", every)
        self.assertIn("libpirouette-cspace", loads(PROGRAMS[1])[1])

    def test_no_two_libraries_give_one_name(self):
        given = {name: gives(self.library(name)) for name in ("pirouette", "pirouette-cspace", "pirouette-ccd")}
        for name, names in given.items():
            ours = {word for word in names if not word.startswith("_")}
            self.assertFalse({word for word in ours if not word.startswith("pir_")}, name)
            self.assertTrue(ours, name)
        self.assertFalse(given["pirouette"] & given["pirouette-cspace"])
        self.assertFalse(given["pirouette"] & given["pirouette-ccd"])
        self.assertFalse(given["pirouette-cspace"] & given["pirouette-ccd"])
        for name, mine in (("pirouette-cspace", ("pir_cspace_", "pir_grid_")),
                           ("pirouette-ccd", ("pir_ccd_", "pir_support_"))):
            self.assertFalse([word for word in given[name] if not word.startswith(mine)], name)

    def test_the_command_starts_within_five_milliseconds(self):
        """More than an empty program takes, the least of many starts of each: others may keep the processor busy."""
        if not PROGRAMS or os.environ.get("PIR_SANITIZED"):
            self.skipTest("no command in this build, or one that is watched")
        least = [1e9, 1e9]
        for _ in range(200):
            for k, command in enumerate((["true"], [PROGRAMS[0], "--version"])):
                begun = time.perf_counter()
                done = subprocess.run(command, capture_output=True, check=True)
                least[k] = min(least[k], time.perf_counter() - begun)
        self.assertTrue(done.stdout.startswith(b"pirouette "))
        self.assertLess(least[1] - least[0], 0.005)


if __name__ == "__main__":
    FOLDER, *PROGRAMS = sys.argv[1:]
    del sys.argv[1:]
    unittest.main()
