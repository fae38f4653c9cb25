#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Writes a page as an array of characters in C, ended by a zero. `@SCRIPT@` and `@STYLE@` in it stand for what pages
share: the parts that end in .js and in .css.

Usage: embed.py PAGE PART... NAME OUTPUT
"""
import pathlib
import sys


def main(page, *parts, name, output):
    data = pathlib.Path(page).read_bytes() + b"\0"
    for mark, ending in ((b"@SCRIPT@\n", ".js"), (b"@STYLE@\n", ".css")):
        data = data.replace(mark, b"".join(pathlib.Path(part).read_bytes() for part in parts if part.endswith(ending)))
    rows = [", ".join(str(byte) for byte in data[i:i + 24]) for i in range(0, len(data), 24)]
    pathlib.Path(output).write_text(f"static const char {name}[] = {{\n    " + ",\n    ".join(rows) + ",\n};\n")


if __name__ == "__main__":
    main(*sys.argv[1:-2], name=sys.argv[-2], output=sys.argv[-1])
