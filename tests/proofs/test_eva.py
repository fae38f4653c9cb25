#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs of Frama-C's Eva: test_eva.py FRAMA_C. See README.md. Skipped where FRAMA_C is empty.

Each analysis must raise the alarms that are listed here and no other, so that docs/proofs.md says what is left.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EVA = ROOT / "tests/proofs/eva"
SKIPPED = 77  # what meson takes for a test that cannot run here

# Of each analysis: its sources, its precision, and the statements with an alarm.
ANALYSES = [
    ("integers", ["src/exact/integer.c"], 8, []),
    # that a token is of so many bytes, and where in the text it is, are not known together
    ("tokens", ["src/polytope/read/text.c"], 7, [
        "memcpy(text->buffer, text->token, text->length);",
        "ret_shown[i] = text->token[i] > ' ' && text->token[i] <= '~' ? text->token[i] : '?';",
        "char c = digits[i];",
        "return text->length == strlen(word) && memcmp(text->token, word, text->length) == 0;",
    ]),
]


def alarms_of(frama_c, name, sources, precision):
    """The lines with an alarm, and the summary."""
    command = [frama_c, "-c11", "-machdep", "gcc_x86_64", "-warn-special-float", "none", "-eva",
               "-eva-precision", str(precision), "-eva-domains", "equality,symbolic-locations,gauges",
               f"-cpp-extra-args=-I{EVA} -I{ROOT}/src -I{ROOT}/include", str(EVA / f"{name}.c")]
    done = subprocess.run(command + [str(ROOT / source) for source in sources], capture_output=True, text=True,
                          cwd=ROOT, timeout=600)
    if done.returncode != 0 or "ANALYSIS SUMMARY" not in done.stdout:
        return None, done.stdout + done.stderr
    places = set(re.findall(r"\[eva:alarm\] (\S+):(\d+): Warning", done.stdout))
    lines = {(ROOT / file).read_text(encoding="utf-8").split("\n")[int(line) - 1].strip() for file, line in places}
    return lines, done.stdout


def main(frama_c):
    if not frama_c:
        print("no Frama-C here")
        return SKIPPED
    wrong = 0
    for name, sources, precision, known in ANALYSES:
        lines, text = alarms_of(frama_c, name, sources, precision)
        if lines is None:
            print(f"{name}: not analysed\n{text[-2000:]}")
            wrong += 1
            continue
        for line in sorted(lines ^ set(known)):
            print(f"{name}: {'no alarm any more' if line in known else 'an alarm'}: {line}")
        wrong += lines != set(known)
        reached = re.search(r"(\d+) statements reached \(out of (\d+)\)", text)
        print(f"{name}: {len(lines)} alarms, {reached.group(1)} of {reached.group(2)} statements reached")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
