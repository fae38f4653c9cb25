#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the tables of docs/figures, which do not depend on the machine, from what long runs of tests print.

Usage: record.py BUILD [TABLE...], with a build folder of the tests and the names of tables, without ending; all where
none are named. Some take minutes.
"""
import csv
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def lines_of(build, program, **environment):
    """What a program of the tests prints, line by line; it has to succeed."""
    told = subprocess.run([build / "tests" / program], env={**os.environ, **environment}, check=True,
                          capture_output=True, text=True).stdout
    return told.splitlines()


def found(lines, pattern):
    return [match for match in map(re.compile(pattern).search, lines) if match]


def cells(lines, columns):
    """Rows of a printed table: a name, then so many numbers, each after blanks."""
    pattern = r"^(\S.*?)" + r"\s+([-+.\de]+)" * columns + r"\s*$"
    return [match.groups() for match in found(lines, pattern)]


def extremes(build):
    rows = {}
    for seed in ("1", "2", "3"):
        told = lines_of(build, "extremes/extremes_situations", PIR_TEST_POSES="60", PIR_TEST_SEED=seed)
        for name, poses, vertex, number, turned, _ in cells(told, 5):
            before = rows.get(name, (0, "0", "0", "0"))
            worst = [max(pair, key=float) for pair in zip(before[1:], (vertex, number, turned))]
            rows[name] = (before[0] + int(poses), *worst)
    return "situation,poses,vertex,number,turned", [(name, *row) for name, row in rows.items()]


def histories(build):
    told = lines_of(build, "extremes/extremes_motions")
    return "history,frames,compared,wrong", [row[:4] for row in cells(told, 4)]


def large(build):
    told = lines_of(build, "extremes/extremes_large", PIR_TEST_SIZE="100")
    return "sum,size,pairs,facets,bytes,seconds", [row for row in cells(told, 5) if not row[0].startswith("in nine")]


def grid(build):
    turns = found(lines_of(build, "cspace/cspace_grid_order", PIR_TEST_LEVEL="6"),
                  r"level (\d+): (\d+) rotations, turns in spacings: mean ([\d.]+), most ([\d.]+)")
    away = found(lines_of(build, "cspace/cspace_grid"),
                 r"level (\d+): dispersion at least ([\d.]+)°, at most ([\d.]+)°")
    return ("level,rotations,mean_turn,most_turn,least_dispersion,most_dispersion",
            [(*a.groups(), *b.groups()[1:]) for a, b in zip(turns, away)])


def coverage(build):
    told = subprocess.run([sys.executable, "-B", HERE.parents[1] / "tests/docs/coverage.py",
                           build / "coverage/coverage.json"], cwd=HERE.parents[1], capture_output=True, text=True)
    rows = found(told.stdout.splitlines(), r"^(\w+): (\d+) of (\d+) lines")
    return "part,reached,lines", [row.groups() for row in rows]


TABLES = {function.__name__: function for function in (extremes, histories, large, grid, coverage)}


def main(build, *names):
    for name in names or TABLES:
        head, rows = TABLES[name](pathlib.Path(build).resolve())
        if not rows:
            sys.exit(f"record: no row for {name}")
        with (HERE / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(head.split(","))
            writer.writerows(rows)
        print(f"{name}: {len(rows)} rows")


if __name__ == "__main__":
    main(*sys.argv[1:])
