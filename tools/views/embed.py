#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a text as an array of characters in C, ended by a zero. Usage: embed.py TEXT NAME OUTPUT"""
import pathlib
import sys


def main(text, name, output):
    data = pathlib.Path(text).read_bytes() + b"\0"
    rows = [", ".join(str(byte) for byte in data[i:i + 24]) for i in range(0, len(data), 24)]
    pathlib.Path(output).write_text(f"static const char {name}[] = {{\n    " + ",\n    ".join(rows) + ",\n};\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
