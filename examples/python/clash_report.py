# SPDX-License-Identifier: MIT
"""A report of clashes in a small storey: which solids run into each other, how deep, and how far to move one out.

With pandas the report is a table, grouped by the kinds that clash; without, lines.
"""
import itertools

import numpy as np

import pirouette

REST = [0, 0, 0, 1, 0, 0, 0]


def prism(outline, low, high):
    """A solid of decimetres, extruded along z."""
    made = pirouette.Solid.prism(outline, high - low)
    return made, [0, 0, 0, 1, 0, 0, low]


def box(x0, x1, y0, y1, z0, z1):
    return prism([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], z0, z1)


storey = {
    "slab": prism([[0, 0], [80, 0], [80, 50], [50, 50], [50, 80], [0, 80]], 0, 3),
    "wall 1": box(0, 80, 20, 23, 3, 30),
    "wall 2": box(30, 33, 23, 80, 3, 30),
    "wall 3": box(29, 32, 40, 60, 3, 30),  # stands there nearly twice
    "pipe 1": prism([[10, 10], [12, 10], [12, 60], [40, 60], [40, 62], [10, 62]], 20, 22),  # with a bend, through two
    "duct 1": box(60, 66, 30, 36, 0, 40),  # a riser, through the slab
    "duct 2": box(60, 66, 60, 66, 5, 30),  # over the notch of the slab
}
rows = []
for (name_p, (p, at_p)), (name_q, (q, at_q)) in itertools.combinations(storey.items(), 2):
    found = pirouette.SolidPair(p, q).depth(at_p, at_q)
    if found.state == pirouette.INSIDE:
        out = found.depth * found.normal
        rows.append({"kinds": "-".join(sorted((name_p.split()[0], name_q.split()[0]))), "p": name_p, "q": name_q,
                     "depth": float(found.depth), "out": " ".join(f"{x:+g}" for x in np.round(out, 9) + 0.0)})
try:
    import pandas
except ImportError:
    for row in sorted(rows, key=lambda row: -row["depth"]):
        print("{kinds:10} {p} in {q}: {depth:g} deep, out by {out}".format(**row))
else:
    table = pandas.DataFrame(rows).sort_values("depth", ascending=False)
    print(table.to_string(index=False))
    print(table.groupby("kinds")["depth"].agg(["count", "max"]).to_string())
clashes = {(row["p"], row["q"]): row["depth"] for row in rows}
assert clashes[("wall 2", "wall 3")] == 2 and ("slab", "duct 2") not in clashes and len(clashes) == 4
print("done: clash_report")
