#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Writes a page as an array of characters in C, ended by a zero. `@SCRIPT@` in it stands for what pages share.

Usage: embed.py PAGE SCRIPT... NAME OUTPUT
"""
import pathlib
import sys


def main(page, *scripts, name, output):
    shared = b"".join(pathlib.Path(script).read_bytes() for script in scripts)
    data = pathlib.Path(page).read_bytes().replace(b"@SCRIPT@\n", shared) + b"\0"
    rows = [", ".join(str(byte) for byte in data[i:i + 24]) for i in range(0, len(data), 24)]
    pathlib.Path(output).write_text(f"static const char {name}[] = {{\n    " + ",\n    ".join(rows) + ",\n};\n")


if __name__ == "__main__":
    main(*sys.argv[1:-2], name=sys.argv[-2], output=sys.argv[-1])
