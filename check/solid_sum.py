#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks what `pirouette sum P Q --solid --certificate FILE` writes, in rationals, without anything of the library.

Usage: solid_sum.py FILE P Q   both solids in OFF
       solid_sum.py FILE       the pieces in FILE are taken as the solids

Prints `proven: ` and what is, or `refused: ` and why, and then exits with 1. It stands on plan.py and cells.py.

The sum S is the union of the sums of a piece of P, turned, and one of Q, all of which have an inside.
1. The pieces of a side have disjoint insides, and their union is its model.
2. A box has all these sums inside. Planes divide it into cells. A blocked cell is within a sum that it names; the
   inside of a free cell meets the inside of none, so it meets none. So S is the union of the closed blocked cells.
3. Each facet of the mesh is a polygon: what its loop goes round once, each point 0 times or once. Each of its points,
   but for a set without area, has a blocked cell just within and a free one just without, or the outside of the box. So
   it is in the boundary of S, turned the right way, and has no area inside a cell.
4. Each edge is walked as often one way as the other. So how often the mesh goes round a point does not change but where
   a facet is crossed. It is 0 beyond the box, and in a cell what it is at one point: 1 in each blocked one, 0 in each
   free one. So the mesh goes round S once and round nothing else: cavities, bodies in them, tunnels, and what touches
   along an edge or at a corner alone are as they should be, and facets cover the boundary once, as they all add there.
"""
import sys
from collections import Counter
from fractions import Fraction

from cells import Cell, integers, lowest
from plan import Model, Piece, cross, dot, half_space, main, need, sub, turned, vector


def above(plane, p):
    """The sign of a point X/W, Y/W, Z/W as integers: above 0 beyond the plane."""
    return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3] * p[3]


def halves(polygon, plane, sides):
    """The parts of a convex polygon on both sides of a plane; empty where no corner is strictly there."""
    parts = ([], [])
    for i, (p, u) in enumerate(zip(polygon, sides)):
        q, v = polygon[i - 1], sides[i - 1]
        both = [lowest([abs(v) * x + abs(u) * y for x, y in zip(p, q)])] if u * v < 0 else []
        for part, sign in zip(parts, (1, -1)):
            part += both + ([p] if u * sign <= 0 else [])
    return [part if any(side * sign < 0 for side in sides) else [] for part, sign in zip(parts, (1, -1))]


class Facet:
    """A planar polygon, perhaps with slits, as convex ones, `parts`: cut by lines through all corners, in a coordinate
    plane. Points of these are integers (X, Y, Z, W), for X/W, Y/W, Z/W with W > 0."""

    def __init__(self, points):
        normal = [sum(cross(a, b)[k] for a, b in zip(points, points[1:] + points[:1])) for k in range(3)]
        need(any(normal), "a facet has no area")
        height = dot(normal, points[0])
        need(all(dot(normal, p) == height for p in points), "a facet is not planar")
        axis = max(range(3), key=lambda k: abs(normal[k]))
        i, j = ((axis + 1) % 3, (axis + 2) % 3)[::1 if normal[axis] > 0 else -1]

        def lifted(x, y):
            known = {i: x, j: y, axis: (height - normal[i] * x - normal[j] * y) / normal[axis]}
            return integers((known[0], known[1], known[2], Fraction(1)))

        self.parts = [[lifted(*p) for p in part] for part in self.divided([(p[i], p[j]) for p in points])]
        self.plane, up = integers((*normal, -height)), 1 if normal[2] > 0 else -1
        self.walls = [[(up * (a[1] * b[3] - b[1] * a[3]), up * (b[0] * a[3] - a[0] * b[3]), 0,
                        up * (a[0] * b[1] - b[0] * a[1])) for a, b in zip(part, part[1:] + part[:1])]
                      for part in self.parts if normal[2]]
        self.bounds = [(min(p[k] for p in points), max(p[k] for p in points)) for k in range(3)]

    @staticmethod
    def divided(points):
        """What a loop in a plane goes round, between lines x = const, as convex polygons: once, and nothing else."""
        edges, lines, parts = list(zip(points, points[1:] + points[:1])), sorted({p[0] for p in points}), []
        for low, high in zip(lines, lines[1:]):
            across = sorted((*(a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]) for x in (low, high)),
                             1 if b[0] > a[0] else -1) for a, b in edges
                            if min(a[0], b[0]) <= low and max(a[0], b[0]) >= high)
            count = 0
            for (y, z, sign), (w, u, _) in zip(across, across[1:]):
                need(y <= w and z <= u, "edges of a facet cross")
                count += sign
                need((y, z) == (w, u) or count in (0, 1), "a facet goes round a point twice, or the wrong way")
                corners = [(low, y), (high, z), (high, u), (low, w)]
                if count and (y, z) != (w, u):
                    parts.append([p for k, p in enumerate(corners) if p != corners[k - 1]])
        return parts

    def winds(self, point, place):
        """How often a ray upwards goes out through it, from integers (X, Y, Z, W); None where it meets an edge."""
        if self.bounds[2][1] < place[2] or any(not b[0] <= x <= b[1] for b, x in zip(self.bounds[:2], place)):
            return 0
        if not self.walls:
            return None if above(self.plane, point) == 0 else 0
        up, count = 1 if self.plane[2] > 0 else -1, 0
        for walls in self.walls:
            sides = [above(wall, point) for wall in walls]
            if min(sides) >= 0:
                height = above(self.plane, point) * up
                if min(sides) == 0 or height == 0:
                    return None
                count += up * (height < 0)
        return count


class SolidSum:
    def __init__(self, told):
        need(told.get("pirouette_solid_sum") == 1, "not a certificate of a sum of solids, version 1")
        need(told["claim"] in ("sum", "difference"), "an unknown claim")
        self.told, q = told, vector(told["quat"], 4)
        self.p, self.q = ([Piece([vector(p) for p in piece["points"]], piece["facets"]) for piece in told[name]]
                          for name in ("p", "q"))
        need(any(q) and self.p and self.q, "no rotation or no pieces")
        stood = [Piece([turned(q, p) for p in piece.points], piece.facets) if told["claim"] == "sum"
                 else piece.opposite(q) for piece in self.p]
        self.sums = {(k, l): a.planes_of_sum(b) for k, a in enumerate(stood) for l, b in enumerate(self.q)}
        self.bounds = {(k, l): [tuple(end(p[i] for p in stood[k].points) + end(p[i] for p in self.q[l].points)
                                      for end in (min, max)) for i in range(3)] for k, l in self.sums}
        low, high = vector(told["low"]), vector(told["high"])
        need(all(low[i] < b[i][0] and b[i][1] < high[i] for b in self.bounds.values() for i in range(3)),
             "the box is too small")
        self.box, self.leaves = Cell.box(low, high), []
        self.bounds = {pair: [((x.numerator << 64) // x.denominator, -((-y.numerator << 64) // y.denominator))
                              for x, y in bounds] for pair, bounds in self.bounds.items()}

    def read_mesh(self):
        points, loops = [vector(p) for p in self.told["vertices"]], self.told["facets"]
        need(all(type(i) is int and 0 <= i < len(points) for f in loops for i in f), "no such vertex")
        walked = [list(zip(f, f[1:] + f[:1])) for f in loops]
        sides = Counter(side for own in walked for side in own)
        need(sides and all(i != k and n == sides[k, i] for (i, k), n in sides.items()), "the mesh is not closed")
        need(len({i for f in loops for i in f}) == len(set(points)) == len(points), "vertices at one place, or unused")
        need(all(self.box.has(p) for p in points), "the mesh leaves the box")
        self.facets = [Facet([points[i] for i in f]) for f in loops]
        edges = {frozenset(side) for own in walked for side in own if side[::-1] not in own}  # others are slits
        counts = [self.told[key] for key in ("vertex_count", "edge_count", "facet_count")]
        need(counts == [len(points), len(edges), len(loops)], "the counts are wrong")
        volume = sum(dot(points[f[0]], cross(points[i], points[k])) for f in loops for i, k in zip(f[1:], f[2:])) / 6
        return "{} vertices, {} edges, {} facets".format(*counts) + f", volume {volume}"

    def overlap(self, cell, pair):
        """Whether a cell and a sum share more than what bounds them."""
        for plane in self.sums[pair]:
            sides = cell.sides(plane)
            if min(sides) >= 0:
                return False
            cell = cell.split(plane)[0] if max(sides) > 0 else cell
        return True

    def check_leaf(self, node, part, cell, near, polygons):
        """near: sums whose bounds meet the cell's; polygons: of facets, with whether the cell is just within them."""
        need(part[0] in ("blocked", "free"), f"part {node}: an unknown word")
        blocked = part[0] == "blocked"
        need(all(within == blocked for _, _, within in polygons), f"part {node}: a facet is not on the boundary there")
        if blocked:
            need((part[1], part[2]) in self.sums, f"part {node}: no such pieces")
            need(all(max(cell.sides(plane)) <= 0 for plane in self.sums[part[1], part[2]]),
                 f"part {node}: not within the sum")
        else:
            need(not any(self.overlap(cell, pair) for pair in near), f"part {node}: a sum has some of it")
        self.check_winding(node, blocked, cell.vertices)

    def check_tree(self):
        tree, sides_of_facets = self.told["tree"], (True, False)
        todo = [(0, self.box, list(self.sums),
                 [(f, part, within) for f in self.facets for part in f.parts for within in sides_of_facets])]
        while todo:
            node, cell, near, polygons = todo.pop()
            part, own = tree[node], ([], [])
            near = [pair for pair in near
                    if all(low <= b[1] and high >= b[0] for b, (low, high) in zip(cell.bounds, self.bounds[pair]))]
            if part[0] != "split":
                self.check_leaf(node, part, cell, near, polygons)
                continue
            plane = half_space(part[1])
            need(len(part) == 4 and all(node < i for i in part[2:]), f"part {node}: two later parts are wanted")
            need(min(cell.sides(plane)) < 0 < max(cell.sides(plane)), f"part {node}: a plane that divides nothing")
            for facet, polygon, within in polygons:
                sides = [above(plane, p) for p in polygon]
                if not any(sides):
                    own[(dot(facet.plane, plane) > 0) != within].append((facet, polygon, within))
                    continue
                for some, half in zip(own, halves(polygon, plane, sides)):
                    some += [(facet, half, within)] if half else []
            todo += [(i, half.packed(), near, some) for i, half, some in zip(part[2:], cell.split(plane), own)]

    def check_winding(self, node, blocked, vertices):
        for trial in range(1, 100):
            weights = [1 + (i * 7919 + trial * 104729) % 997 for i in range(len(vertices))]
            place = [sum(w * Fraction(v[k], v[3]) for w, (v, _) in zip(weights, vertices)) / sum(weights)
                     for k in range(3)]
            counts = [facet.winds(integers((*place, Fraction(1))), place) for facet in self.facets]
            if None not in counts:
                return need(sum(counts) == blocked, f"part {node}: the mesh goes round it {sum(counts)} times")
        return need(False, f"part {node}: no ray misses all edges")

    def check(self, models=()):
        need(len(models) in (0, 2), "two models are wanted, or none")
        counts = self.read_mesh()
        for model, pieces in zip(models, (self.p, self.q)):
            Model(model).check(pieces)
        self.check_tree()
        return f"{self.told['claim']}, {counts}"


if __name__ == "__main__":
    sys.exit(main(SolidSum, *sys.argv[1:]) if len(sys.argv) > 1 else __doc__)
