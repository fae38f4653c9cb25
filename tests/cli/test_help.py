#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Holds the help of the `pirouette` command against what it takes: test_help.py COMMAND SOURCES [CLASS]"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

COMMAND = ""
SOURCES = Path()


def run(*args, **how):
    return subprocess.run([COMMAND, *args], capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL, **how)


def subcommands():
    """The names that the help lists."""
    listed = run("--help").stdout.split("subcommands:\n")[1].split("\n\n")[0]
    return re.findall(r"^  ([a-z]+) ", listed, re.M)


def help_options(text):
    """The names of options that a help text lists, with what stands for their values."""
    listed = text.split("options:\n")[1].split("\n\n")[0]
    options = {}
    for names, value in re.findall(r"^  ((?:-[a-z-]+, )*-[a-z-]+)(?: (\S+))?(?=  |$)", listed, re.M):
        options.update(dict.fromkeys(names.split(", "), value))
    return options


class Help(unittest.TestCase):
    def help(self, *args):
        result = run(*args)
        self.assertEqual((result.returncode, result.stderr), (0, ""), args)
        return result.stdout

    def test_every_way_to_ask_for_help_answers_on_stdout(self):
        self.assertEqual(subcommands()[0], "info")
        general = self.help("--help")
        self.assertEqual(general, self.help("-h"))
        self.assertEqual(general, self.help("help"))
        for name in subcommands():
            text = self.help(name, "--help")
            self.assertTrue(text.startswith(f"usage: pirouette {name} "), name)
            self.assertEqual(text, self.help(name, "-h"))
            self.assertEqual(text, self.help("help", name))
            # help also comes when the arguments before it make no sense
            self.assertEqual(text, self.help(name, "--json", "-h", "--nosuch") if name != "help" else text)

    def test_help_of_what_does_not_exist_is_refused(self):
        for args, named in ((["help", "nosuch"], "nosuch"), (["help", "sum", "track"], "track"), (["help", "-x"], "-x"),
                            (["sum", "--help=3"], "--help"), (["sum", "-h=3"], "-h"), (["-x"], "-x")):
            result = run(*args)
            self.assertEqual((result.returncode, result.stdout), (2, ""), args)
            self.assertEqual(result.stderr.count("\n"), 1)
            self.assertIn(named, result.stderr)

    def test_no_line_of_help_is_longer_than_a_terminal(self):
        for args in (["--help"], *(["help", name] for name in subcommands())):
            for line in self.help(*args).splitlines():
                # an example is one word to copy, and is not broken
                self.assertTrue(len(line) <= 80 or line.startswith("  pirouette "), line)

    def test_the_parser_takes_the_options_of_the_help_and_no_others(self):
        written = set()
        for source in SOURCES.glob("*.c"):
            for literal in re.findall(r'"((?:-[a-z-]*[a-z](?:, )?)+)"', source.read_text()):
                written.update(literal.split(", "))
        self.assertIn("--quat", written)
        for name in subcommands():
            listed = help_options(self.help("help", name))
            self.assertLessEqual({"-h", "--help"}, set(listed))
            for option in written | set(listed):
                result = run(name, option)
                self.assertEqual("unknown option" in result.stderr, option not in listed, f"{name} {option}")
                # at the end of the line an option that takes a value misses it
                self.assertEqual("has no value" in result.stderr, bool(listed.get(option)), f"{name} {option}")

    def test_the_examples_of_the_help_run(self):
        count = 0
        for name in subcommands():
            for line in re.findall(r"^  pirouette (.*)$", self.help("help", name).split("examples:\n")[1], re.M):
                count += 1
                with tempfile.TemporaryDirectory() as folder:
                    result = subprocess.run(["/bin/sh", "-c", f'"$0" {line}', COMMAND], cwd=folder, capture_output=True,
                                            text=True, timeout=60)
                    self.assertEqual((result.returncode, result.stderr), (0, ""), line)
                    for written in re.findall(r"(?:-o|--plot|--dump) (\S+)", line):
                        self.assertTrue((Path(folder) / written).exists(), line)
        self.assertGreaterEqual(count, len(subcommands()))


if __name__ == "__main__":
    COMMAND = str(Path(sys.argv[1]).resolve())
    SOURCES = Path(sys.argv[2])
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
