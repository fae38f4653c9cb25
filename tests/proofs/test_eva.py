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

TOLD = ["tests/proofs/eva/told_integers.c", "tests/proofs/eva/told_memory.c"]

# Functions whose ways out have to be told apart: what one of them has set is not set by the others.
SPLIT = "-eva-split-return-function"

READ = "src/polytope/read/"
LOW = ["0", "-eva-split-return", "auto", "-eva-slevel"]

# Why some alarms of readers cannot be.
MIXED = "Eva mixes facets that are written at places it does not know"
OWN_ROOM = "there are 3 rationals a vertex, all set, and no more points than vertices; Eva keeps no such relation"
NAME = "a name has 24 characters and '...' at most, in room for 28; Eva takes names to have no end"

# Of each analysis: its sources, its precision and further options, and the statements with an alarm
# and why none can be.
ANALYSES = [
    ("integers", ["src/exact/integer.c"], ["8"], {
        "PIR_ASSERT(shift > -64 && (mantissa & (((uint64_t)1 << -shift) - 1)) == 0);":
            "the unit is that of the lowest bit; Eva does not know how that and the double belong together",
    }),
    ("signs", TOLD + ["src/exact/sign.c", "src/exact/rotation.c", "src/exact/relative_turn.c"],
     ["3", SPLIT, "pir_signs_reserve:0,small_vector:0,bring_near_one:0"], {
         "PIR_ASSERT(sign != 0);": "that a perturbed tie has a sign is shown at the top of sign.c",
     }),
    ("vectors", TOLD + ["src/exact/vectors.c"], ["6"], {
        "//@ assert length == 0 || \\valid(dst->limb + (0 .. length - 1));":
            "a copy's block is taken for as many limbs as the integer has; Eva knows both numbers only apart",
        "dst->limb[i] = any_limb();": "as above",
    }),
    ("tokens", ["src/polytope/read/text.c"], ["7"], {}),
    ("readers_models", [READ + "read.c", READ + "model_make.c", "src/polytope/file/file_name.c"],
     ["2", "-eva-split-return", "auto"], {}),
    ("readers_stl", [READ + "read_stl.c", READ + "text.c"], LOW + ["10"], {}),
    ("readers_obj", [READ + "read_obj.c", READ + "text.c"], LOW + ["10"], {
        "if (model->corner[i] >= model->point_count)": "a facet starts at a corner that is there; " + MIXED,
    }),
    ("readers_off", [READ + "read_off.c", READ + "text.c"], LOW + ["10"], {
        'if (length > 3 && length < 8 && memcmp(text->end - 3, "OFF", 3) == 0)':
            "the token has more than 3 bytes; Eva does not know that its ends are as far apart as it is long",
        "mpq_init(model->exact[i]);": OWN_ROOM,
        "mpq_set_d(model->exact[3 * v], model->points[v].x);": OWN_ROOM,
        "mpq_set_d(model->exact[3 * v + 1], model->points[v].y);": OWN_ROOM,
        "mpq_set_d(model->exact[3 * v + 2], model->points[v].z);": OWN_ROOM,
        "mpq_set(exact, scratch[axis]);": OWN_ROOM,
        "mpq_set_d(exact, numbers[axis].value);": OWN_ROOM,
        "mpz_lcm(reader->common, reader->common, mpq_denref(exact));": OWN_ROOM,
    }),
    ("readers_header", [READ + "ply_header.c", READ + "text.c"], LOW + ["3"], {
        "if (strcmp(header->property[i].name, property->name) == 0)": NAME,
        "if (property->role != PLY_PASSED_OVER && property->is_list != (property->role == PLY_CORNERS))": NAME,
        'header->vertex = strcmp(element->name, "vertex") == 0 ? element : header->vertex;': NAME,
        'face = strcmp(element->name, "face") == 0 ? element : face;': NAME,
        "seen |= 1u << header->property[i].role;": NAME,
    }),
    ("readers_ply", [READ + "read_ply.c", READ + "text.c"], LOW + ["3"], {
        "value = value << 8 | (unsigned char)bytes[big ? k : size - 1 - k];":
            "the bytes of a number are there when it is decoded; Eva does not know that both sizes are of one type",
    }),
]


def alarms_of(frama_c, name, sources, options):
    """The lines with an alarm, and the summary."""
    command = [frama_c, "-c11", "-machdep", "gcc_x86_64", "-warn-special-float", "none", "-eva",
               "-eva-domains", "equality,symbolic-locations,gauges", "-eva-precision", *options,
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
    for name, sources, options, known in ANALYSES:
        lines, text = alarms_of(frama_c, name, sources, options)
        if lines is None:
            print(f"{name}: not analysed\n{text[-2000:]}")
            wrong += 1
            continue
        for line in sorted(lines ^ set(known)):
            print(f"{name}: {'no alarm any more' if line in known else 'an alarm'}: {line}")
        wrong += lines != set(known)
        for line, reason in known.items():
            print(f"{name}: alarm at `{line}`: {reason}")
        reached = re.search(r"(\d+) statements reached \(out of (\d+)\)", text)
        print(f"{name}: {len(lines)} alarms, {reached.group(1)} of {reached.group(2)} statements reached")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
