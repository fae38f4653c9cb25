#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Which fuzz targets, tests and benchmarks call each public function: docs/api-tests.md.

Usage: api_tests.py ROOT [--write | --called]

Compares the page with what the sources say, and ends with 1 where they differ; --write writes the page. --called looks
only whether each function has a caller among the tests, the fuzz targets, or the command, which has tests of its own. A
program counts for what its own files call, and for what the helpers beside it call.
"""
import pathlib
import re
import sys

DECLARED = re.compile(r"^PIR_API [^;(]*?\b(pir_\w+)\(", re.M)
CALLED = re.compile(r"\bpir_\w+")
# Helpers of fuzz targets, by the names of their sources in the table of tests/fuzz/meson.build.
TARGET = re.compile(r"'(\w+)': files\(([^)]*)\)")
PAGE = "docs/api-tests.md"
HEAD = """# What tests each function

Made by `tests/docs/api_tests.py` from the sources. For each public function: the fuzz targets (`tests/fuzz`) that call
it, the folders of `tests` with tests that do, and the folders of `bench` with benchmarks that do. The command, which is
on these functions alone, calls more of them from its own tests and fuzz target. [guarantees.md](guarantees.md) says
what is promised.
"""


def calls(path):
    """Every public name in a file, comments left out."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", path.read_text(encoding="utf-8"), flags=re.S)
    return set(CALLED.findall(text))


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".c", ".h", ".cpp", ".hpp", ".cc"))


def fuzz_targets(root):
    """The names that each fuzz target calls."""
    folder = root / "tests/fuzz"
    helpers = dict(TARGET.findall((folder / "meson.build").read_text(encoding="utf-8")))
    targets = {}
    for path in sorted(folder.glob("fuzz_*.c")):
        name = path.stem.removeprefix("fuzz_")
        beside = [folder / part for part in re.findall(r"'([^']+)'", helpers.get(name, ""))]
        targets[name] = set().union(*(calls(file) for file in [path, *beside]))
    return targets


def folders(root, below, without=()):
    """The names that each folder of `below` calls."""
    found = {}
    for path in sources(root / below):
        folder = path.relative_to(root / below).parts[0]
        if folder not in without and len(path.relative_to(root / below).parts) > 1:
            found.setdefault(folder, set()).update(calls(path))
    return found


def table(root):
    """Rows (header, function, fuzz targets, folders of tests, folders of benchmarks)."""
    columns = [fuzz_targets(root), folders(root, "tests", ("fuzz", "install")), folders(root, "bench", ("results",))]
    for header in sorted((root / "include/pirouette").glob("*.h")):
        for name in DECLARED.findall(header.read_text(encoding="utf-8")):
            yield header.name, name, *([key for key in sorted(column) if name in column[key]] for column in columns)


def page(rows):
    lines, last = [HEAD], None
    for header, name, *cells in rows:
        if header != last:
            lines.append(f"\n## {header}\n\n| function | fuzz targets | tests | benchmarks |\n")
            lines.append("| --- | --- | --- | --- |\n")
            last = header
        lines.append(f"| `{name}` | " + " | ".join(", ".join(cell) or "–" for cell in cells) + " |\n")
    return "".join(lines)


def main(arguments):
    root, mode = pathlib.Path(arguments[0]), arguments[1:]
    rows = list(table(root))
    command = set().union(*(calls(path) for path in sources(root / "tools")))
    untested = [name for _, name, targets, tests, _ in rows if not tests and not targets and name not in command]
    if mode == ["--write"]:
        (root / PAGE).write_text(page(rows), encoding="utf-8")
    elif mode == ["--called"]:
        print(f"{len(rows)} functions", *(f"{name} is called by no test" for name in untested), sep="\n")
        return 1 if untested or len(rows) < 200 else 0
    elif (root / PAGE).read_text(encoding="utf-8") != page(rows):
        print(f"{PAGE} is not what the sources say: run tests/docs/api_tests.py ROOT --write")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
