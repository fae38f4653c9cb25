#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Writes scenes as a table in C, by their names: name, title, what there is to see, and the text as an array.

Usage: embed_scenes.py OUTPUT SCENE.json...
"""
import json
import pathlib
import sys


def main(output, *scenes):
    arrays, rows = [], []
    for path in sorted(map(pathlib.Path, scenes)):
        data = path.read_bytes()
        scene = json.loads(data)
        bytes_of = [", ".join(str(byte) for byte in (data + b"\0")[i:i + 24]) for i in range(0, len(data) + 1, 24)]
        arrays.append(f"static const char scene_{path.stem}[] = {{\n    " + ",\n    ".join(bytes_of) + ",\n};\n")
        texts = ", ".join(json.dumps(text) for text in (path.stem, scene["title"], scene["about"]))
        rows.append(f"    {{{texts}, scene_{path.stem}}},\n")
    table = "static const struct {\n    const char *name, *title, *about, *text;\n} scenes_data[] = {\n"
    pathlib.Path(output).write_text("".join(arrays) + table + "".join(rows) + "};\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
