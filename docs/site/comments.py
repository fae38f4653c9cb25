#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Doxygen's input filter: a public header's comments in the form that Doxygen reads.

The headers keep to plain text. Here a line `name   what it is` in a comment becomes a @param, what begins with `Errors`
or `Cost:` a paragraph of that name, the first comment of a header one of the file, and a declaration that follows
another without a comment of its own gets the one before it, as a reader takes it.

Usage: comments.py HEADER
"""
import pathlib
import re
import sys

COMMENT = re.compile(r"/\*\*(?!<)(.*?)\*/\n", re.S)
PARAMETERS = re.compile(r"^((?:\w+, )*\w+)  +(?=\S)")
SECTION = re.compile(r"(?:^|(?<=[.!)] ))(Errors|Cost)(?=:| as )")


def lines_of(comment):
    """The comment's text, without stars, as lines."""
    lines = [re.sub(r"^ ?\* ?", "", line.strip() if i == 0 else line).rstrip()
             for i, line in enumerate(comment.split("\n"))]
    while lines and not lines[-1]:
        lines.pop()
    while lines and not lines[0]:
        lines.pop(0)
    return lines


def names_of(declaration):
    """The names that stand in a declaration's list of parameters."""
    inside = declaration[declaration.find("(") + 1:]
    return set(re.findall(r"\w+", inside))


def marked(lines, names):
    """The lines with commands of Doxygen."""
    out, column = [], 0
    for line in lines:
        found = PARAMETERS.match(line)
        if found and set(found[1].split(", ")) <= names:
            column = found.end()
            out.append(f"@param {found[1].replace(', ', ',')} {line[column:]}")
            continue
        if column and line.startswith(" " * column):
            out.append("    " + line.strip())
            continue
        if column:
            out += [""] if line else []
            column = 0
        out.append(line)
    text = "\n".join(out)
    # A section lasts to the end of its paragraph, or to the next section.
    paragraphs = []
    for paragraph in text.split("\n\n"):
        if paragraph.startswith("    "):
            paragraphs.append(paragraph)
            continue
        joined = paragraph if "@param" in paragraph else re.sub(r"\n(?! *[-*] )", " ", paragraph)
        paragraphs.append(SECTION.sub(lambda m: f"\n\n@par {m[1]}\n", joined).replace("\n: ", "\n").strip("\n"))
    return "\n\n".join(paragraphs)


def filtered(text):
    out, at, first, last = [], 0, True, ""
    text = re.sub(r"\A/\* SPDX[^\n]*\n", "\n", text)
    for found in COMMENT.finditer(text):
        out.append(repeated(text[at:found.start()], last))
        declaration = re.split(r"[;{]", text[found.end():], maxsplit=1)[0]
        body = marked(lines_of(found[1]), names_of(declaration))
        last = "" if first or found[1].count("---") > 1 else body
        out.append("/**\n" + ("@file\n" if first else "") + body + "\n*/\n")
        first, at = False, found.end()
    out.append(repeated(text[at:], last))
    return "".join(out)


def repeated(code, comment):
    """Code after a comment: the comment again before each declaration that follows the first without an empty line."""
    head, gap, rest = code.partition("\n\n")
    declarations = re.split(r"(?<=;\n)(?=PIR_API )", head + "\n")
    return (f"/**\n{comment}\n*/\n".join(declarations))[:-1] + gap + rest if comment else code


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")
    print(filtered(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")), end="")
