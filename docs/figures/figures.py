#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts measured numbers into the pages, from the tables of bench/results and of docs/figures.

Usage: figures.py [--check] [ROOT]. Rewrites the pages in place; with --check it only says where a page differs.

Marks, which readers do not see, say which numbers are measured:

    <!-- figures: NAME -->        the next lines are the table NAME of tables.py
    <!-- tested: NAME -->         the numbers of the table in the next lines are held by the test NAME
    <!--=NAME-->1.5<!--/-->       a number of inline.py, or TABLE.machine, or TABLE.csv, a link to the table

A table with numbers, which stand at the right, has one of the first two marks. A time in prose has the last one.
"""
import difflib
import os
import pathlib
import re
import sys

from inline import FIGURES
from results import ROOT, Figures, Results
from tables import TABLES

PAGES = ("README.md", "docs/*.md")
MARKED = re.compile(r"<!--=([\w.]+)-->(.*?)<!--/-->")
OVER_TABLE = re.compile(r"^<!-- (figures|tested): (.+) -->$")
RIGHT = re.compile(r"^\|.*---:")
TIME = re.compile(r"\d[ \u00a0](?:ns|µs|ms)\b")
# Times that are no measurement: what a program is told, or a limit.
SET = {"docs/scale.md": ("every 0.2 ms",)}


def pages(root):
    return sorted(path for pattern in PAGES for path in root.glob(pattern))


def value(name, results, page):
    """The text of a mark in a line."""
    table, _, what = name.partition(".")
    if what == "machine":
        return getattr(results, table).machine
    if what == "csv":
        path = getattr(results, table).path
        return f"[{table}.csv]({os.path.relpath(path, pathlib.PurePath(page).parent)})"
    if name not in FIGURES:
        raise Figures(f"{page}: there is no figure {name}")
    return FIGURES[name](results)


def filled(text, results, page):
    """The page with all marked numbers as the tables have them."""
    out, lines, at = [], text.split("\n"), 0
    while at < len(lines):
        out.append(lines[at])
        mark = OVER_TABLE.match(lines[at])
        at += 1
        if not mark or mark[1] != "figures":
            continue
        if mark[2] not in TABLES:
            raise Figures(f"{page}: there is no table {mark[2]}")
        out += TABLES[mark[2]](results).split("\n")
        while at < len(lines) and lines[at].startswith("|"):
            at += 1
    return MARKED.sub(lambda m: f"<!--={m[1]}-->{value(m[1], results, page)}<!--/-->", "\n".join(out))


def unmarked(text, page):
    """Lines on numbers that look measured and have no mark, and on marks that a renderer would trip over."""
    lines = MARKED.sub("", text).split("\n")
    over, code = "", False
    for number, (line, raw) in enumerate(zip(lines, text.split("\n")), 1):
        code ^= line.startswith("```")
        if code:
            continue
        if RIGHT.match(line) and not over:
            yield f"{page}:{number}: a table of numbers without a mark"
        if not line.startswith("|"):
            over = OVER_TABLE.match(line)
            for found in TIME.finditer(line):
                if not any(known in line for known in SET.get(page, ())):
                    yield f"{page}:{number}: a time without a mark: {line[max(0, found.start() - 20):found.end()]}"
        if raw.startswith("<!--="):
            yield f"{page}:{number}: a mark at the beginning of a line ends the paragraph"


def untested(text, page, tests):
    """Lines on tables that name a test which is not there."""
    for number, line in enumerate(text.split("\n"), 1):
        mark = OVER_TABLE.match(line)
        if mark and mark[1] == "tested" and f"'{mark[2]}'" not in tests:
            yield f"{page}:{number}: there is no test {mark[2]}"


def tests_of(root):
    return "".join(path.read_text(encoding="utf-8") for path in sorted((root / "tests").rglob("meson.build")))


def differences(root):
    """(lines on all that is wrong, how many marks there are)."""
    results, tests, found, marks = Results(root), tests_of(root), [], 0
    for path in pages(root):
        page, text = path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")
        marks += len(MARKED.findall(text)) + sum(bool(OVER_TABLE.match(line)) for line in text.split("\n"))
        found += [*unmarked(text, page), *untested(text, page, tests)]
        new = filled(text, results, page)
        found += difflib.unified_diff(text.split("\n"), new.split("\n"), page, "the tables", n=0, lineterm="")
    return found, marks


def rewrite(root):
    results = Results(root)
    for path in pages(root):
        text = path.read_text(encoding="utf-8")
        new = filled(text, results, path.relative_to(root).as_posix())
        if new != text:
            path.write_text(new, encoding="utf-8")
            print(f"{path.relative_to(root)}: rewritten")


def main(*words):
    root = pathlib.Path(next((word for word in words if word != "--check"), ROOT)).resolve()
    if "--check" not in words:
        rewrite(root)
        return 0
    found, marks = differences(root)
    print(f"{marks} marks", *found, sep="\n")
    return 1 if found or marks < 50 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
