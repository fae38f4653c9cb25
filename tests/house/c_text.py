# SPDX-License-Identifier: MIT
"""What a C or C++ file declares, read from its text: functions with their parameters, macros, types, includes."""
import re
from typing import NamedTuple

NOT_CODE = re.compile(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", re.S)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.M)
MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)\(([^)]*)\)", re.M)
INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*([\"<])([^\">]+)[\">]")
# These braces hold declarations of the file's own level.
OUTER_BRACE = re.compile(r"(?:\bnamespace\b[^;{}()]*|\bextern\s*\"?\s*\"?)$")
NO_NAME = {"__attribute__", "alignas", "_Alignas", "sizeof", "decltype", "if", "for", "while", "switch", "return"}


class Function(NamedTuple):
    name: str
    line: int
    parameters: int
    defined: bool
    static: bool


def blank(match):
    """As many characters and line ends as the match has, so that places stay what they are."""
    return re.sub(r"[^\n]", " ", match.group())


def count_parameters(text):
    """How many parameters a list holds; commas within brackets are of one parameter."""
    if text.strip() in ("", "void"):
        return 0
    depth, count = 0, 1
    for character in text:
        if character in "([{<":
            depth += 1
        elif character in ")]}>":
            depth -= 1
        elif character == "," and depth == 0:
            count += 1
    return count


def parameter_lists(statement):
    """(name before it, text) of each pair of brackets at the outer level of a statement."""
    lists, depth, start = [], 0, 0
    for i, character in enumerate(statement):
        if character == "(":
            depth += 1
            if depth == 1:
                start = i
        elif character == ")":
            depth -= 1
            if depth == 0:
                name = re.search(r"(\w+)\s*$", statement[:start])
                lists.append((name.group(1) if name else "", statement[start + 1 : i]))
    return lists


def function_of(statement, line, defined):
    """The function that a statement of the outer level declares or defines, or None."""
    if re.match(r"\s*(?:typedef|using)\b", statement):
        return None
    if "=" in re.sub(r"\([^()]*\)", "", statement):
        return None
    lists = [found for found in parameter_lists(statement) if found[0] not in NO_NAME]
    if not lists or not lists[0][0]:
        return None
    # A name that a macro makes, NAME(scan)(a, b), has its parameters in the last list.
    return Function(lists[0][0], line, max(count_parameters(text) for _, text in lists), defined,
                    bool(re.search(r"\bstatic\b", statement)))


def functions(text):
    """The functions that a file declares or defines at its outer level, and its macros with parameters."""
    found = []
    for match in MACRO.finditer(NOT_CODE.sub(blank, text)):
        line = text.count("\n", 0, match.start()) + 1
        found.append(Function(match.group(1), line, count_parameters(match.group(2)), True, True))
    code = DIRECTIVE.sub(blank, NOT_CODE.sub(blank, text))
    depth, start = 0, 0
    for i, character in enumerate(code):
        if character not in "{};":
            continue
        statement = code[start:i]
        if depth == 0:
            line = code.count("\n", 0, start + len(statement) - len(statement.lstrip())) + 1
            if character == "{" and OUTER_BRACE.search(statement.rstrip()):
                start = i + 1
                continue
            function = function_of(statement, line, character == "{") if character != "}" else None
            if function:
                found.append(function)
        depth += {"{": 1, "}": -1, ";": 0}[character]
        if depth < 0:  # the end of a namespace
            depth = 0
        if depth == 0:
            start = i + 1
    return found


TAGGED = re.compile(r"(?:(?:typedef|static|const)\s+)*(?:struct|enum|union)\s+(\w+)$")
ALIAS = re.compile(r"typedef\b.*?(?:\(\s*\*\s*(\w+)\s*\)|(\w+))\s*(?:\[[^]]*\]|\([^)]*\))?$", re.S)
ATTRIBUTE = re.compile(r"__attribute__\s*\(\(.*\)\)", re.S)


def alias_of(statement):
    """The name that a typedef defines. None where there is none, or where it repeats a structure's tag, as
    `typedef struct pir_sum pir_sum` does: the name counts with the structure."""
    match = ALIAS.match(ATTRIBUTE.sub("", statement).strip())
    name = match and (match.group(1) or match.group(2))
    return None if name and re.match(rf"typedef\s+(?:struct|enum|union)\s+{name}\b", statement) else name


def types(text):
    """(name, line) of each structure, union, enumeration and typedef that a file defines at its outer level."""
    code = DIRECTIVE.sub(blank, NOT_CODE.sub(blank, text))
    found, depth, start, outer = [], 0, 0, ""  # outer: the statement at hand, without what is in braces
    for i, character in enumerate(code):
        if character not in "{};":
            continue
        if depth == 0:
            outer = (outer + code[start:i]).strip()
            match = TAGGED.match(outer) if character == "{" else None
            name = match.group(1) if match else alias_of(outer) if character == ";" else None
            if name:
                found.append((name, code.count("\n", 0, i) + 1))
        depth = max(0, depth + {"{": 1, "}": -1, ";": 0}[character])
        if depth == 0:
            start = i + 1
            outer = outer + "{} " if character == "}" and outer.startswith("typedef") else ""
    return found


def includes(text):
    """(line, whether in quotes, path) of each file that a text includes."""
    return [(number, match.group(1) == '"', match.group(2)) for number, line in enumerate(text.split("\n"), 1)
            if (match := INCLUDE.match(line))]
