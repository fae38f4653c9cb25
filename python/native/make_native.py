# SPDX-License-Identifier: MIT
"""Writes the C of the module `_native`, by cffi, from the public headers as the C preprocessor reads them.

Usage: make_native.py LOOPS... OUTPUT INCLUDE COMPILER...   LOOPS are loops.h and those beside it, which include the
public headers that the module is to have; OUTPUT is a .c file; INCLUDE holds pirouette/.

What cffi is told is what the compiler sees, so it cannot drift from the headers: a struct or a function that differs
does not compile.
"""
import pathlib
import re
import subprocess
import sys

import cffi

LINE = re.compile(r'# (\d+) "([^"]*)"')
CONSTANT = re.compile(r"#define (PIR_\w+) +(\(?[-+\w<() ]+\)?)$")
# cffi writes no C for a pointer to an array of constants; as the last field of a struct it is left out
CONSTANT_ARRAY = re.compile(r"const \w+ \(\*\w+\)\[\d+\];\s*(?=})")
NUMBER = re.compile(r"\(?(\d+|UINT8_MAX|UINT32_MAX|0x[0-9a-fA-F]+)[uUlL]*\)?$")


def seen(include, loops, compiler):
    """The lines of the public headers after the preprocessor, and the macros that are whole numbers."""
    source = "".join(re.findall("#include <pirouette/.*\n", "".join(loops)))
    text = subprocess.run([*compiler, "-E", "-dD", f"-I{include}", "-x", "c", "-"], input=source, text=True, check=True,
                          stdout=subprocess.PIPE).stdout
    ours, lines, constants = False, [], []
    root = str(pathlib.Path(include) / "pirouette")
    for line in text.split("\n"):
        mark = LINE.match(line)
        if mark:
            ours = mark[2].startswith(root)
        elif ours and line.startswith("#"):
            constant = CONSTANT.match(line)
            if constant and NUMBER.match(constant[2].strip()):
                constants.append(constant[1])
        elif ours:
            lines.append(line)
    return "\n".join(lines), constants


def without_bodies(text):
    """Inline functions as declarations."""
    result, at = [], 0
    for found in re.finditer(r"static inline ([^;{]*?\))\s*\{", text):
        if found.start() < at:
            continue
        result.append(text[at:found.start()] + found[1] + ";")
        depth, at = 1, found.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[at], 0)
            at += 1
    return "".join(result) + text[at:]


def declarations(include, loops, compiler):
    text, constants = seen(include, loops, compiler)
    text = re.sub(r"__attribute__\s*\(\((?:[^()]|\([^()]*\))*\)\)", "", without_bodies(text))
    text = CONSTANT_ARRAY.sub("...; ", text)
    own = "".join(header.split("/* cffi: begin */")[1].split("/* cffi: end */")[0] for header in loops)
    return text + own + "".join(f"#define {name} ...\n" for name in constants)


def main(arguments):
    at = next(i for i, argument in enumerate(arguments) if argument.endswith(".c"))
    headers = [pathlib.Path(argument) for argument in arguments[:at]]
    output, include, *compiler = arguments[at:]
    ffi = cffi.FFI()
    ffi.cdef(declarations(include, [header.read_text(encoding="utf-8") for header in headers], compiler))
    ffi.set_source("pirouette._native", "".join(f'#include "{header.name}"\n' for header in headers))
    ffi.emit_c_code(output)


if __name__ == "__main__":
    main(sys.argv[1:])
