#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What pages and comments point to is there: files by their names, functions and constants by theirs.

Usage: test_names.py ROOT
"""
import pathlib
import re
import sys

FOLDERS = ("include", "src", "tools", "check", "tests", "bench", "examples", "docs", "packaging")
SOURCES = (".c", ".h", ".cpp", ".hpp", ".py")
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
FILE = re.compile(r"(?<![\w.*/-])((?:[\w-]+/)*[\w-]+\.(?:c|h|cpp|hpp|py|md))(?![\w/])(?!\.)")
NAME = re.compile(r"\b(?:pir|PIR)_\w+")
# Names of files that the text speaks of without meaning one of the tree.
OTHERS = {"program.c", "gmp.h", "math.h", "string.h", "stdio.h", "stdlib.h"}
# The beginning of a family of names, as in `pir_query_batch_*`.
FAMILY = re.compile(r"_$")


def tree(root):
    return [path for folder in FOLDERS for path in sorted((root / folder).rglob("*"))
            if path.is_file() and "__pycache__" not in path.parts] + sorted(root.glob("*.md"))


def lines(text, start, pattern):
    """(line number, match) of each match in a piece of text that begins at line `start`."""
    return [(start + text.count("\n", 0, m.start()), m[0]) for m in pattern.finditer(text)]


def main(root):
    files = tree(root)
    paths = {path.relative_to(root).as_posix() for path in files}
    code = "\n".join(path.read_text(encoding="utf-8") for path in files if path.suffix in SOURCES)
    known = set(NAME.findall(code))
    gone = set(NAME.findall((root / "tests/headers/names-0.1.list").read_text(encoding="utf-8")))
    found, checked = [], 0

    def there(name):
        return name in OTHERS or any(("/" + path).endswith("/" + name) for path in paths)

    for path in files:
        own = path.relative_to(root).as_posix()
        if own.startswith(("tests/", "bench/results/")) or path.name == "CHANGELOG.md":
            continue
        text = path.read_text(encoding="utf-8") if path.suffix in (".md", *SOURCES) else ""
        pieces = [(1, text)] if path.suffix == ".md" else [
            (text.count("\n", 0, m.start()) + 1, m[0]) for m in COMMENT.finditer(text)] if path.suffix != ".py" else []
        for start, piece in pieces:
            for line, name in lines(piece, start, FILE):
                checked += 1
                if not there(name):
                    found.append(f"{own}:{line}: there is no {name}")
            if path.suffix == ".md":
                for line, name in lines(piece, start, NAME):
                    checked += 1
                    if name in gone and path.name == "upgrading.md":
                        continue
                    if name not in known and not (FAMILY.search(name) and any(k.startswith(name) for k in known)):
                        found.append(f"{own}:{line}: nothing is called {name}")
    print(f"{checked} names checked", *found, sep="\n")
    return 1 if found or checked < 300 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
