# SPDX-License-Identifier: MIT
"""Prints which lines tests do not reach, and the share that they do, of the library and of the command.

Usage: coverage.py FILE, which gcovr wrote with --json, from the root of the project.

A line counts once, however many programs hold it. Exit status 1 where less than 97 % of either are reached.
"""
import json
import pathlib
import sys

LEAST = 97


def reached(entry):
    """How often each line of a file was run, the most over all programs."""
    lines = {}
    for line in entry["lines"]:
        if not line.get("gcovr/noncode"):
            number = line["line_number"]
            lines[number] = max(lines.get(number, 0), line["count"])
    return lines


def main():
    totals = {"src": [0, 0], "tools": [0, 0]}
    for entry in sorted(json.loads(pathlib.Path(sys.argv[1]).read_text())["files"], key=lambda e: e["file"]):
        name, lines = entry["file"], reached(entry)
        total = totals[name.split("/")[0]]
        total[0] += sum(count > 0 for count in lines.values())
        total[1] += len(lines)
        text = pathlib.Path(name).read_text().splitlines()
        for number in sorted(n for n, count in lines.items() if count == 0):
            print(f"{name}:{number}: {text[number - 1].strip()}")
    status = 0
    for part, (run, all_lines) in totals.items():
        share = 100 * run / all_lines
        print(f"{part}: {run} of {all_lines} lines, {share:.1f} %")
        status = 1 if share < LEAST else status
    return status


if __name__ == "__main__":
    sys.exit(main())
