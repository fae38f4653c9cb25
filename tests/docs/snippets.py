#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The C code of the pages, compiled as it stands there.

snippets.py SOURCE PAGE OUTPUT    writes SOURCE with each line `/* snippet N */` replaced by the N-th block of C in PAGE
snippets.py --unused PAGE...      fails where a page has blocks of C and no source of tests/docs
"""
import pathlib
import re
import sys

BLOCK = re.compile(r"^```c\n(.*?)^```$", re.M | re.S)
MARK = re.compile(r"^[ ]*/\* snippet (\d+) \*/$", re.M)


def source_of(page):
    return "snippets_" + re.sub(r"\W", "_", pathlib.Path(page).stem.lower()) + ".c"


def fill(source, page):
    """The source with the page's blocks in it, under their own line numbers; every block must be used once."""
    text = pathlib.Path(page).read_text(encoding="utf-8")
    blocks = [(text.count("\n", 0, found.start(1)) + 1, found[1]) for found in BLOCK.finditer(text)]
    template = pathlib.Path(source).read_text(encoding="utf-8")
    used = [int(n) for n in MARK.findall(template)]
    if sorted(used) != list(range(1, len(blocks) + 1)):
        sys.exit(f"{page} has {len(blocks)} blocks of C, {source} uses {used}")

    def put(mark):
        line, block = blocks[int(mark[1]) - 1]
        after = template.count("\n", 0, mark.end()) + 2
        return f'#line {line} "{page}"\n{block}#line {after} "{source}"'

    return MARK.sub(put, template)


def main(first, *rest):
    if first == "--unused":
        here = pathlib.Path(__file__).parent
        coded = [page for page in rest if BLOCK.search(pathlib.Path(page).read_text(encoding="utf-8"))]
        bare = [page for page in coded if not (here / source_of(page)).exists()]
        print(f"{len(rest)} pages", *(f"{page}: no {source_of(page)} compiles its code" for page in bare), sep="\n")
        sys.exit(1 if bare or len(rest) < 5 else 0)
    page, output = rest
    pathlib.Path(output).write_text(fill(first, page), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
