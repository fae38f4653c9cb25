# SPDX-License-Identifier: MIT
"""Every benchmark writes the tables that bench/results keeps, of a few frames each, which say nothing about speed.

Usage: smoke.py RESULTS [PROGRAM [ARGUMENT...] --]...   RESULTS is bench/results; an argument FOLDER stands for
the folder to write to.
"""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile

# Measured once, of ways that were worse and that the library does without.
ONCE = {"mesh_index.csv"}


def commands(words):
    """The words before each mark `--`."""
    command = []
    for word in words:
        if word != "--":
            command.append(word)
            continue
        yield command
        command = []


def wrong_with(path):
    """What is wrong with a table or a page, or None."""
    text = path.read_text()
    if path.suffix == ".csv":
        rows = list(csv.reader(text.splitlines()))
        if len(rows) < 2 or not rows[0]:
            return "holds no row"
        if any(len(row) != len(rows[0]) for row in rows):
            return "has rows of another length than its head"
    return None if text.strip() else "is empty"


def main(results, words):
    expected = {path.name for path in pathlib.Path(results).glob("*/*")}
    environment = dict(os.environ, PIR_BENCH_SMOKE="1")
    with tempfile.TemporaryDirectory() as folder:
        for command in commands(words):
            command = [folder if word == "FOLDER" else word for word in command]
            subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
        written = {path.name: path for path in pathlib.Path(folder).glob("*/*")}
        failures = [f"{name} {wrong_with(path)}" for name, path in sorted(written.items()) if wrong_with(path)]
    missing = sorted(expected - ONCE - set(written))
    failures += [f"bench/results keeps {name}, which no benchmark writes" for name in missing]
    print(f"{len(written)} files written by {len(list(commands(words)))} benchmarks")
    print(*failures, sep="\n")
    return 1 if failures or not written else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
