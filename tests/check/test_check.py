#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Certificates of many answers, and tampered ones: test_check.py WRITER.

The checker accepts every certificate that the library writes, and finds the answers' numbers right. It refuses each one
in which a digit, a sign or a line was changed, or whose model is another one. PIR_TEST_ANSWERS says how many answers
(2000), PIR_TEST_TAMPERED how many tampered ones (1000), PIR_TEST_JOBS by how many processes (2).
"""
import collections
import multiprocessing
import os
import pathlib
import random
import re
import subprocess
import sys
from fractions import Fraction

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "check"))
import check  # noqa: E402  (the checker, beside the project's sources)

STATES = ["outside", "boundary", "inside"]
REFUSALS = (check.Refused, ValueError, KeyError, TypeError, ZeroDivisionError, IndexError)


class Case:
    def __init__(self, stream, header):
        p, q, size, is_sum, state = (int(n) for n in header[:5])
        numbers = [float(n) for n in header[5:]]
        self.p, self.q = (self.points(stream, count) for count in (p, q))
        self.text = stream.read(size).decode("ascii")
        self.answer = None
        if not is_sum:
            self.answer = {"quat": numbers[1:5], "translation": numbers[5:], "state": STATES[state]}
            inside = {"penetration": {"depth": -numbers[0]}}
            self.answer.update(inside if state == 2 else {"distance": numbers[0]})

    @staticmethod
    def points(stream, count):
        return [tuple(Fraction(float(c)) for c in stream.readline().split()) for _ in range(count)]

    def check(self, text=None, p=None, q=None):
        return check.check(text or self.text, p or self.p, q or self.q, self.answer)


def change_digit(chance, case):
    """Another digit anywhere in the text behind its version."""
    places = [m.start() for m in re.finditer(r"\d", case.text)][1:]
    at = chance.choice(places)
    other = chance.choice([d for d in "0123456789" if d != case.text[at]])
    return {"text": case.text[:at] + other + case.text[at + 1:]}


def change_sign(chance, case):
    """The sign of a number that is not 0."""
    match = chance.choice(list(re.finditer(r'"-?(?!0")\d', case.text)))
    text = match.group()
    text = text.replace("-", "") if "-" in text else text.replace('"', '"-')
    return {"text": case.text[:match.start()] + text + case.text[match.end():]}


def lose_line(chance, case):
    """A line less: a vertex, a pair, a facet or another entry."""
    lines = case.text.split("\n")
    at = chance.choice([i for i, line in enumerate(lines) if line.startswith("[") or ":" in line])
    kept = lines[:at] + lines[at + 1:]
    if lines[at].startswith("[") and not lines[at].endswith(","):
        kept[at - 1] = kept[at - 1].rstrip(",")
    return {"text": "\n".join(kept)}


def change_model(chance, case):
    """Another model: a vertex that the certificate lists stands elsewhere."""
    data = check.check(case.text, case.p, case.q)
    vertex = tuple(Fraction(int(c), int(data["unit"])) for c in chance.choice(data["q"]))
    axis = chance.randrange(3)
    by = Fraction(chance.choice([-1, 1]), chance.choice([1, 2, 1 << 40]))
    moved = tuple(c + by if k == axis else c for k, c in enumerate(vertex))
    return {"q": [moved if point == vertex else point for point in case.q]}


CHANGES = [change_digit, change_digit, change_sign, lose_line, change_model]


def still_true(case, changed):
    """Whether a change of the text leaves a true statement: P turned onto itself, or another normal at a corner.

    A sum has no answer that its quaternion is held against; at a corner on an axis a normal may have many signs.
    """
    before = dict(re.findall(r'"(quat|normal)": \[(.*)\]', case.text))
    after = dict(re.findall(r'"(quat|normal)": \[(.*)\]', changed.get("text", "")))
    if case.answer is None and before["quat"] != after.get("quat"):
        a, b = ([Fraction(n.strip(' "')) for n in text.split(",")] for text in (before["quat"], after["quat"]))
        one, other = (set(check.place(case.p, quat, (0, 0, 0), 1)) for quat in (a, b))
        return one == other
    return "normal" in before and before["normal"].replace("-", "") == after["normal"].replace("-", "")


def run(job):
    """Checks the cases of one process: how many of each claim, how many changes were refused, what went wrong."""
    writer, answers, tampered, first, stride = job
    chance = random.Random(first)
    claims, wrong, kept = collections.Counter(), [], []
    process = subprocess.Popen([writer, str(answers), str(first), str(stride)], stdout=subprocess.PIPE)
    mine, each = -(-tampered // stride), max(1, -(-tampered // (answers * 7 // 8)))
    refused = 0
    with process:
        while header := process.stdout.readline().split():
            case = Case(process.stdout, header)
            try:
                claims[case.check()["claim"]] += 1
            except REFUSALS as error:
                wrong.append(f"refused: {error!r}\n{case.p}\n{case.q}\n{case.answer}\n{case.text}")
                continue
            for _ in range(each if refused < mine and len(case.text) < 100000 else 0):
                changed = chance.choice(CHANGES)(chance, case)
                try:
                    case.check(**changed)
                except REFUSALS:
                    refused += 1
                else:
                    if not still_true(case, changed):
                        wrong.append(f"accepted: {changed}\n{case.p}\n{case.q}\n{case.answer}\n{case.text}")
    if process.returncode != 0:
        wrong.append(f"the writer ended with {process.returncode}")
    return claims, refused, wrong


def main(writer):
    answers = int(os.environ.get("PIR_TEST_ANSWERS", "2000"))
    tampered = int(os.environ.get("PIR_TEST_TAMPERED", "1000"))
    jobs = int(os.environ.get("PIR_TEST_JOBS", "2"))
    # cases are of one kind by their number modulo 48: each process has some of every kind
    while jobs > 1 and (jobs % 2 == 0 or jobs % 3 == 0):
        jobs += 1
    work = [(writer, answers, tampered, first, jobs) for first in range(jobs)]
    claims, refused, wrong = collections.Counter(), 0, []
    with multiprocessing.Pool(min(jobs, 2)) as pool:
        for some, changes, mistakes in pool.imap_unordered(run, work):
            claims += some
            refused += changes
            wrong += mistakes
    print(f"accepted {sum(claims.values())}: {dict(sorted(claims.items()))}; tampered and refused: {refused}")
    for mistake in wrong[:3]:
        print(mistake)
    missing = set(check.CLAIMS) - set(claims)
    if wrong or missing or refused < tampered:
        print(f"FAILED: {len(wrong)} mistakes, claims that did not occur: {missing}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
