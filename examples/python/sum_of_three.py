# SPDX-License-Identifier: MIT
"""Three boxes, each turned its own way, added exactly, and whether points are inside.

A sum in rationals is a polytope like any other, so a sum of three is one of two and the third.
"""
import pirouette

boxes = [pirouette.Polytope.shape(f"box?x={x}&y={y}&z={z}") for x, y, z in ((30, 30, 30), (15, 30, 45), (78, 39, 39))]
total = boxes[0]
for box, rotation in zip(boxes[1:], ([1, 2, 3, 4], [2, 1, -3, 5])):
    total = pirouette.Polytope.from_fractions(pirouette.MinkowskiSum(box, total, rotation).mesh(exact=True).exact)
print(f"vertices {len(total.vertices)}, edges {len(total.edges)}, facets {len(total.normals)}")

points = [[0, 0, 0], [60, 40, 0], [45, 60, 0], [41.5, 65.5, 32], [41.5, 65.5, 32.0625]]
pair = pirouette.Pair([[0, 0, 0]], total)
for point, state in zip(points, pair.states([[0, 0, 0, 1, *point] for point in points])):
    print("({:g}, {:g}, {:g})".format(*point), ("outside", "boundary", "inside")[state])
print("done: sum_of_three")
