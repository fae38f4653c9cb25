# SPDX-License-Identifier: MIT
"""The committed results of benchmarks, and how their numbers are written in pages."""
import csv
import decimal
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Folders of bench/results, the first of which that holds a table counts, and how a page names the machine.
MACHINES = {
    "amd-epyc-2-cores": "an AMD EPYC at 2.6 GHz with 2 cores",
    "intel-r-xeon-r-processor-2-cores": "an Intel Xeon at 2.6 GHz with 2 cores",
}
# Figures that do not depend on the machine, which record.py takes from tests.
RECORDED = "docs/figures"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Figures(Exception):
    """A page or a table that does not hold what it should."""


class Table:
    """One CSV: rows as dictionaries of text, found by the values of some columns."""

    def __init__(self, path, root):
        self.path = path.relative_to(root).as_posix()
        self.machine = MACHINES.get(path.parent.name, "any machine")
        with path.open(encoding="utf-8", newline="") as file:
            self.rows = list(csv.DictReader(file))

    def all(self, **keys):
        return [row for row in self.rows if all(row[key] == str(value) for key, value in keys.items())]

    def one(self, **keys):
        found = self.all(**keys)
        if len(found) != 1:
            raise Figures(f"{self.path} has {len(found)} rows of {keys}")
        return found[0]

    def number(self, column, **keys):
        return float(self.one(**keys)[column])

class Results:
    """All tables, by name without ending."""

    def __init__(self, root=ROOT):
        self.root, self.tables = pathlib.Path(root), {}

    def __getattr__(self, name):
        if name not in self.tables:
            folders = [*(f"bench/results/{machine}" for machine in MACHINES), RECORDED]
            paths = [self.root / folder / f"{name}.csv" for folder in folders]
            there = [path for path in paths if path.is_file()]
            if not there:
                raise Figures(f"no folder of results holds {name}.csv")
            self.tables[name] = Table(there[0], self.root)
        return self.tables[name]


def short(x):
    """Two digits, or all before the point."""
    if abs(x) < 0.995:
        return f"{x:.2f}"
    return f"{x:.1f}" if abs(x) < 9.95 else f"{x:,.0f}"


def two(x):
    """Two digits without zeros behind."""
    return f"{x:.2g}" if abs(x) < 99.5 else f"{x:,.0f}"


def count(x):
    return f"{float(x):,.0f}"


def percent(x, digits=0):
    return f"{100 * x:.{digits}f} %"


def power(text, digits=1):
    """A number as text, as 2.3·10⁻¹⁶."""
    mantissa, _, exponent = f"{decimal.Decimal(text):.{digits}e}".partition("e")
    return "0" if float(text) == 0 else f"{mantissa}·10{str(int(exponent)).translate(SUPERSCRIPTS)}"


def between(values, form=short):
    """`2 to 5`, or one value where both ends are written alike."""
    low, high = form(min(values)), form(max(values))
    return low if low == high else f"{low} to {high}"


def both(row, median, mean):
    """`median / mean` of nanoseconds in microseconds, or the median where the table has no mean."""
    value = short(float(row[median]) / 1e3)
    return f"{value} / {short(float(row[mean]) / 1e3)}" if row.get(mean) else value


def slope(x, y):
    """The exponent of y as a power of x, fitted by least squares."""
    x, y = [math.log(v) for v in x], [math.log(v) for v in y]
    at, above = sum(x) / len(x), sum(y) / len(y)
    return sum((a - at) * (b - above) for a, b in zip(x, y)) / sum((a - at) ** 2 for a in x)


def markdown(head, rows):
    """A table; of a column named with an arrow before it, `>`, cells stand at the right."""
    lines = ["| " + " | ".join(cell.lstrip(">") for cell in head) + " |",
             "| " + " | ".join("---:" if cell.startswith(">") else "---" for cell in head) + " |"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]).replace("|  |", "| |")
