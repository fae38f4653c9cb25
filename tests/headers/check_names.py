# SPDX-License-Identifier: MIT
"""Every function that a header declares has a user: a public one in tests, examples or tools, an internal one in src
itself.

Usage: check_names.py ROOT. Names each function without a user, one a line, and exits with 1 when there is one.
"""
import collections
import pathlib
import re
import sys

NAME = re.compile(r"\bpir_\w+")
# A declaration or a static inline definition starts at the margin; what stands further right is its text.
DECLARED = re.compile(r"^(PIR_API |static inline )?[a-z][\w ]*[ *](pir_\w+)\(", re.M)


def text_of(path):
    """The file without its comments."""
    return re.sub(r"/\*.*?\*/|//[^\n]*", " ", path.read_text(), flags=re.S)


def files_in(root, *folders):
    return [path for folder in folders for path in sorted((root / folder).rglob("*"))
            if path.suffix in (".c", ".h", ".cpp")]


def count_names(paths):
    return collections.Counter(name for path in paths for name in NAME.findall(text_of(path)))


def main(root):
    inside = count_names(files_in(root, "src", "include"))
    outside = count_names(files_in(root, "tests", "examples", "tools"))
    checked, unused = 0, []
    for header in files_in(root, "include", "src"):
        if header.suffix != ".h":
            continue
        for kind, name in DECLARED.findall(text_of(header)):
            checked += 1
            # an internal function is written once where it is inline, else declared and defined
            own = 1 if kind.startswith("static") else 2
            is_public = "include" in header.relative_to(root).parts
            used = (is_public and outside[name] > 0) or (not kind.startswith("PIR_API") and inside[name] > own)
            if not used:
                unused.append(f"{header.relative_to(root)}: nothing uses {name}")
    print(f"{checked} functions declared, {len(unused)} without a user")
    for line in unused:
        print(line)
    return 1 if unused or checked < 100 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
