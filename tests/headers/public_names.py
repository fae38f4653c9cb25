# SPDX-License-Identifier: MIT
"""The public names of the headers with what they are, one a line, and what docs/upgrading.md must say of those of 0.1.

Usage: public_names.py ROOT [--list]. --list prints the names as the headers have them: a function with its declaration,
a type, a member of a struct with its type, an enumerator, a macro. Without it, each name of names-0.1.list that is gone
or declared otherwise must stand in docs/upgrading.md between backticks; those that do not are printed, and the exit
status is 1 where there are any.
"""
import pathlib
import re
import sys

LISTED = "tests/headers/names-0.1.list"
PAGE = "docs/upgrading.md"
FUNCTION = re.compile(r"^(?:PIR_API|static inline)\s+([^;{]*?\b(pir_\w+)\([^;{]*\))\s*[;{]", re.M)
STRUCT = re.compile(r"^typedef struct (pir_\w+) \{(.*?)^\} \1;", re.M | re.S)
ENUM = re.compile(r"^typedef enum (pir_\w+) \{(.*?)\}", re.M | re.S)
OTHER = re.compile(r"^typedef (?:struct (pir_\w+) pir_\w+;|\w[^;{]*?\b\*?(pir_\w+)\()", re.M)
MACRO = re.compile(r"^#define (PIR_\w+)", re.M)


def plain(text):
    """The text with single blanks, none beside parentheses and stars."""
    return re.sub(r"\s*([*(),;])\s*", r"\1", " ".join(text.split()))


def members(body):
    """Pairs (name, type) of the members that a struct declares."""
    for declaration in plain(body).split(";"):
        pointer = re.match(r"(.*?)\(\*(\w+)\)([(\[].*)$", declaration)  # to a function or an array
        if pointer:
            yield pointer[2], pointer[1] + pointer[3]
            continue
        first, *more = declaration.split(",")
        found = re.match(r"(.*?[ *])(\w+)((?:\[\w+\])*)$", first)
        if found:
            kind = found[1].strip()
            yield found[2], kind + found[3]
            for name in more:
                yield name.lstrip("*"), kind
        elif declaration:
            raise ValueError(f"a member that is not understood: {declaration}")


def names_of(text):
    """Names of a header's text, without its comments, with what they are."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    text = re.sub(r"^[ \t]+(?=PIR_API|typedef)", "", text, flags=re.M)
    found = {name: plain(declaration) for declaration, name in FUNCTION.findall(text)}
    for name, body in STRUCT.findall(text):
        found[name] = "struct"
        found |= {f"{name}.{member}": kind for member, kind in members(body)}
    for name, body in ENUM.findall(text):
        found[name] = "enum"
        found |= {value: name for value in re.findall(r"\bPIR_\w+", body)}
    for opaque, callback in OTHER.findall(text):
        found.setdefault(opaque or callback, "opaque" if opaque else "callback")
    guards = re.findall(r"^#ifndef (PIROUETTE_\w+)", text, re.M)
    found |= {name: "macro" for name in MACRO.findall(text) if name not in guards and name != "PIR_API"}
    return found


def public_names(root):
    found = {}
    for header in sorted((root / "include/pirouette").glob("*.h")):
        found |= names_of(header.read_text(encoding="utf-8"))
    return found


def listed(root):
    lines = (root / LISTED).read_text(encoding="utf-8").splitlines()
    return dict(line.split(": ", 1) for line in lines if line)


def is_told(name, told):
    """Whether the page has the name; a member counts with its struct where that is gone too."""
    return name in told or name.partition(".")[0] in told and "." in name


def main(arguments):
    root = pathlib.Path(arguments[0])
    now = public_names(root)
    if arguments[1:] == ["--list"]:
        print(*(f"{name}: {kind}" for name, kind in sorted(now.items())), sep="\n")
        return 0
    before = listed(root)
    changed = [name for name, kind in before.items() if now.get(name) != kind]
    told = set(re.findall(r"\b(?:pir|PIR)_\w+(?:\.\w+)?", (root / PAGE).read_text(encoding="utf-8")))
    untold = [name for name in changed if not is_told(name, told)]
    print(f"{len(before)} names of 0.1, {len(changed)} gone or changed, {len(untold)} of these not in {PAGE}")
    print(*untold, sep="\n")
    return 1 if untold or len(before) < 500 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
