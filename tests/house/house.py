# SPDX-License-Identifier: MIT
"""The rules of the house: the rooms that ARCHITECTURE.md lists and the arrows between them, and the sizes of things.

Usage: house.py ROOT. Names each breach as FILE:LINE: RULE: REASON, one a line, and exits with 1 when there is one.
"""
import ast
import pathlib
import re
import sys
from typing import NamedTuple

import c_text

MAX_LINES = 900
MAX_WIDTH = 120  # bytes of UTF-8
MAX_PARAMETERS = 7
MAX_DECLARED = 2  # .c files whose functions one header declares

C_FILES = (".c", ".h", ".cc", ".cpp", ".hpp")
WRITTEN = C_FILES + (".py", ".md", ".build", ".bash", ".in", ".txt", ".css", ".js", ".sh")
FOLDERS = ("include", "src", "tools", "check", "tests", "bench", "examples", "docs", "packaging", "fuzz")
ROOT_FILES = ("README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "meson.build",
              "meson_options.txt", "dev", ".ci/run")
# What machines wrote: inputs of fuzzing, models, results of benchmarks.
MACHINE_MADE = ("tests/fuzz/corpus/", "bench/results/", "examples/models/")
# A benchmark of internals, which links the static library.
INTERNAL_BENCHMARKS = ("bench/dymsum/bench_kernels.c", "bench/solid/stages.c")


class Breach(NamedTuple):
    rule: str
    file: str
    line: int
    reason: str

    def __str__(self):
        return f"{self.file}:{self.line}: {self.rule}: {self.reason}"


class Tree:
    """The written files of a source tree, by their paths within it."""

    def __init__(self, root):
        self.texts = {}
        paths = [root / name for name in ROOT_FILES]
        for folder in FOLDERS:
            paths += sorted((root / folder).rglob("*"))
        for path in paths:
            name = path.relative_to(root).as_posix()
            made = name.startswith(MACHINE_MADE) and path.suffix not in (".py", ".build")
            if path.is_file() and not made and (path.suffix in WRITTEN or name in ROOT_FILES):
                self.texts[name] = path.read_text()

    def code(self, *folders):
        return {name: text for name, text in self.texts.items()
                if name.endswith(C_FILES) and (not folders or name.startswith(folders))}


def folder_of(name):
    return name.rpartition("/")[0]


def listed_rooms(tree):
    """The rooms of src in their order, each with its line: the block that ARCHITECTURE.md opens with ```rooms."""
    rooms, inside = {}, False
    for number, line in enumerate(tree.texts["ARCHITECTURE.md"].split("\n"), 1):
        if line.startswith("```"):
            inside = line.strip() == "```rooms"
        elif inside and line.strip():
            rooms[line.split()[0].rstrip("/")] = number
    return rooms


def check_rooms(tree):
    """Each folder of src with C files is a listed room, and each listed room is such a folder."""
    rooms = listed_rooms(tree)
    present = {folder_of(name): name for name in tree.code("src/")}
    for room, name in sorted(present.items()):
        if room not in rooms:
            yield Breach("rooms", name, 1, f"{room} is not in the list of rooms of ARCHITECTURE.md")
    for room, line in rooms.items():
        if room not in present:
            yield Breach("rooms", "ARCHITECTURE.md", line, f"{room} has no C file")


def check_arrows(tree):
    """A room includes itself and the rooms listed before it; what is outside of src includes public headers only."""
    order = list(listed_rooms(tree))
    for name, text in tree.code().items():
        for line, quoted, path in c_text.includes(text):
            reason = arrow_reason(tree, order, name, quoted, path)
            if reason:
                yield Breach("arrows", name, line, reason)


def arrow_reason(tree, order, name, quoted, path):
    """Why a file may not include a path, or None."""
    inside = f"src/{path}"
    is_internal = quoted and inside in tree.texts and f"{folder_of(name)}/{path}" not in tree.texts
    part = name.split("/")[0]
    if part == "src":
        if not quoted:
            return None
        if not is_internal:
            return f"{path} is no header of src, named from there"
        room, other = folder_of(name), folder_of(inside)
        if room in order and other in order and order.index(other) > order.index(room):
            return f"{other} comes after {room} in the list of rooms"
        return None
    if part == "include":
        return f"a public header includes public headers alone, not {path}" if quoted else None
    if is_internal:
        if name.startswith("tests/oracle/"):
            return f"the oracle knows nothing of the library's insides, not {path}"
        if part == "tests" or name in INTERNAL_BENCHMARKS:
            return None
        return f"{part} includes public headers alone, not src/{path}"
    return None


def check_declares(tree):
    """A header of src declares functions of at most two .c files, which are of its own room."""
    sources = tree.code("src/")
    defined = {}
    for name, text in sources.items():
        if name.endswith(".c"):
            for function in c_text.functions(text):
                if function.defined and not function.static:
                    defined.setdefault(function.name, name)
    for name, text in sources.items():
        if name.endswith(".h"):
            files = sorted({defined[function.name] for function in c_text.functions(text)
                            if not function.defined and function.name in defined})
            elsewhere = [file for file in files if folder_of(file) != folder_of(name)]
            if len(files) > MAX_DECLARED:
                yield Breach("declares", name, 1,
                             f"declares functions of {len(files)} files: " + ", ".join(files))
            elif elsewhere:
                yield Breach("declares", name, 1,
                             "declares functions of another room: " + ", ".join(elsewhere))


def check_lines(tree):
    """No file is too long, and no line too wide; the rows of tables in Markdown are exempt."""
    for name, text in tree.texts.items():
        lines = text.split("\n")
        count = len(lines) - (lines[-1] == "")
        if count > MAX_LINES:
            yield Breach("length", name, MAX_LINES + 1, f"{count} lines, more than {MAX_LINES}")
        for number, line in enumerate(lines, 1):
            width = len(line.encode())
            if width > MAX_WIDTH and not (name.endswith(".md") and line.startswith("|")):
                yield Breach("width", name, number, f"{width} bytes, more than {MAX_WIDTH}")


def check_parameters(tree):
    """No function has too many parameters."""
    for name, text in tree.texts.items():
        if name.endswith(C_FILES):
            found = [(function.name, function.line, function.parameters) for function in c_text.functions(text)]
        elif name.endswith(".py"):
            found = [(node.name, node.lineno, len(node.args.posonlyargs + node.args.args + node.args.kwonlyargs))
                     for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
        else:
            continue
        for function, line, count in found:
            if count > MAX_PARAMETERS:
                yield Breach("parameters", name, line,
                             f"{function} has {count} parameters, more than {MAX_PARAMETERS}")


def check_names(tree):
    """No two modules, a .c file with its header, have one name within src, nor within tools."""
    for part in ("src/", "tools/"):
        seen = {}
        for name in sorted(tree.code(part)):
            stem = name.rpartition("/")[2].rpartition(".")[0]
            folder = seen.setdefault(stem, folder_of(name))
            if folder != folder_of(name):
                yield Breach("names", name, 1, f"{folder} has a file of the name {stem} as well")


def check_types(tree):
    """No two types of the public headers and of src have one name; tags within a .c file count as well."""
    seen = {}
    for file, text in sorted(tree.code("include/", "src/").items()):
        for name, line in c_text.types(text):
            where = seen.setdefault(name, file)
            if where != file:
                yield Breach("types", file, line, f"{where} has a type of the name {name} as well")


def check_marks(tree):
    """In a public header a comment behind a member is one that the reference shows: it begins with `/**<`."""
    for name, text in tree.code("include/").items():
        for number, line in enumerate(text.split("\n"), 1):
            if re.search(r"/\* ?<", line):
                yield Breach("marks", name, number, "the reference shows a comment that begins with /**<, not this one")


def check_comments(tree):
    """A comment of src, tools and include names its noun: none begins with "What" or "The same"."""
    for name, text in tree.code("src/", "tools/", "include/").items():
        for number, line in enumerate(text.split("\n"), 1):
            if re.match(r"\s*/?\*+ (?:What|The same)\b", line):
                yield Breach("comments", name, number, "the comment begins with no noun")


CHECKS = (check_rooms, check_arrows, check_declares, check_lines, check_parameters, check_names, check_types,
          check_marks, check_comments)


def breaches(root):
    tree = Tree(root)
    return [breach for check in CHECKS for breach in check(tree)]


def main(root):
    found = breaches(root)
    for breach in found:
        print(breach)
    print(f"{len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
