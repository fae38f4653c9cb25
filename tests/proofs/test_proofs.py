#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Bounds of filters, proven by gappa: test_proofs.py GAPPA FILE.g... See README.md. Skipped where GAPPA is empty.

Of each file: gappa proves all its goals; it proves none with half the bound, so that no goal is empty; each line
"# proves:" names a text that the source has, the bound there, and the goal that is at most that.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # what meson takes for a test that cannot run here
PROVES = re.compile(r'# proves: (\S+) "(.*)" ([\d.]+) >= ([\d.]+)(?: of 2\^-(\d+))?')
# A bound of a goal: 62b-53, 0x5.4p-53, or a plain number.
BOUND = re.compile(r"(?:<= |in \[0, )(0x[\da-f.]+p-?\d+|\d+b-\d+|\d+)")


def value(text):
    """The number of u that a bound of gappa's is, or the number itself."""
    if "b-" in text:
        return float(text.split("b-")[0]), int(text.split("b-")[1])
    if "p-" in text:
        return float.fromhex(text.split("p-")[0] + "p0"), int(text.split("p-")[1])
    return float(text), 0


def is_proven(gappa, text):
    done = subprocess.run([gappa, "-Eprecision=200"], input=text, capture_output=True, text=True, timeout=600)
    return done.returncode == 0


def plain(text):
    """Words of a source, without the stars and slashes of comments and without breaks."""
    return " ".join(re.sub(r"\n\s*(?:\*|//) ?", " ", text).split())


def check_source(line, goals):
    """What is wrong with a line "# proves:", or None."""
    found = PROVES.fullmatch(line)
    if not found:
        return "is not in the form: # proves: FILE \"TEXT\" BOUND >= GOAL"
    file, text, bound, goal, unit = found.groups()
    unit = int(unit or 53)
    source = ROOT / file
    if not source.is_file() or text not in plain(source.read_text(encoding="utf-8")):
        return f"{file} does not have it"
    told = [float(n) for n in re.findall(r"\d+\.?\d*", text)]
    told += [int(times or 1) * 2.0 ** (unit - int(power))
             for times, power in re.findall(r"(?:(\d+)·)?(?:0x1p|2\^)-(\d+)", text)]
    if float(bound) not in told:
        return f"{bound} is not its bound"
    if float(goal) > float(bound):
        return "the goal is above the bound"
    if not any(abs(number - float(goal)) < 0.01 and power in (0, unit) for number, power in goals):
        return f"no goal is {goal}"
    return None


def halves(text):
    """The file with each goal alone, its bound halved."""
    start = text.rindex("->") + 2
    for goal in text[start:text.rindex("}")].split("/\\"):
        found = BOUND.search(goal)
        number, power = value(found.group(1))
        half = (number / 2).hex() if power == 0 else f"{int(number * 512)}b-{power + 10}"
        yield found.group(1), text[:start] + goal[:found.start(1)] + half + goal[found.end(1):] + "}"


def check(gappa, path):
    text = path.read_text(encoding="ascii" if path.read_bytes().isascii() else "utf-8")
    mistakes = []
    goals = [value(number) for number in BOUND.findall(text[text.rindex("->"):])]
    lines = [line for line in text.split("\n") if line.startswith("# proves:")]
    if not lines or not goals:
        mistakes.append("has no line that says what it proves, or no goal")
    mistakes += [f"{line}: {wrong}" for line in lines if (wrong := check_source(line, goals))]
    formulas = "\n".join(line for line in text.split("\n") if not line.startswith("#"))
    if not is_proven(gappa, formulas):
        mistakes.append("gappa does not prove it")
    for bound, tighter in halves(formulas):
        if is_proven(gappa, tighter):
            mistakes.append(f"half of the bound {bound} would do")
    return [f"{path.name}: {mistake}" for mistake in mistakes], len(goals)


def main(gappa, files):
    if not gappa:
        print("no gappa here")
        return SKIPPED
    wrong, count = [], 0
    for file in files:
        mistakes, goals = check(gappa, pathlib.Path(file))
        wrong += mistakes
        count += goals
    print("\n".join(wrong))
    print(f"{len(files)} files, {count} bounds, {len(wrong)} mistakes")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
