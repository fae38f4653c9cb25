#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the two example bodies, mug.off and gamepad.off, next to this file.

Both are drawn here from a few measures, in millimetres, as closed triangle shells; where shells overlap (a handle that
ends inside a wall) the body is their union, of which Pirouette takes the convex hull. Coordinates are rounded to a
micrometre, as a scan or a drawing would be, so nothing is exactly round or exactly symmetric. Only the standard library
is used, and nothing of the build depends on this script: the files it writes are kept beside it.
"""

import math
import os


class Body:
    """Vertices and triangles of a union of closed shells."""

    def __init__(self):
        self.points, self.triangles = [], []

    def add(self, x, y, z):
        # Round to a micrometre; + 0.0 turns -0 into 0.
        self.points.append(tuple(round(c, 3) + 0.0 for c in (x, y, z)))
        return len(self.points) - 1

    def shell(self, first, rings, last):
        """A closed shell from pole `first` through rings of equal length to pole `last`: points outward when rings turn
        counter-clockwise seen from beyond `last`."""
        n = len(rings[0])
        a = self.add(*first)
        index = [[self.add(*p) for p in ring] for ring in rings]
        b = self.add(*last)
        for i in range(n):
            j = (i + 1) % n
            self.triangles.append((a, index[0][j], index[0][i]))
            for low, high in zip(index, index[1:]):
                self.triangles.append((low[i], low[j], high[j]))
                self.triangles.append((low[i], high[j], high[i]))
            self.triangles.append((b, index[-1][i], index[-1][j]))

    def check(self):
        """Each directed edge once and its reverse once."""
        edges = [(t[i], t[(i + 1) % 3]) for t in self.triangles for i in range(3)]
        seen = set(edges)
        assert len(seen) == len(edges) and all((b, a) in seen for a, b in edges)

    def write(self, name, comment):
        self.check()
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), name)
        with open(path, "w", encoding="ascii") as out:
            out.write("OFF\n")
            for line in comment:
                out.write(f"# {line}\n")
            out.write(f"{len(self.points)} {len(self.triangles)} 0\n")
            for p in self.points:
                out.write(" ".join(f"{c:.3f}".rstrip("0").rstrip(".") for c in p) + "\n")
            for t in self.triangles:
                out.write("3 " + " ".join(map(str, t)) + "\n")


def circle(n, radius, z, phase=0.0):
    turn = [2 * math.pi * (i + phase) / n for i in range(n)]
    return [(radius * math.cos(t), radius * math.sin(t), z) for t in turn]


def mug():
    body = Body()
    n = 26
    # The profile, radius and height: foot, a slightly bellied wall, a rounded lip, the inner wall down to the inner
    # floor.
    outer = [(31.0, 0.0), (34.2, 1.1), (36.6, 6.5), (38.9, 20.0), (40.3, 36.0), (41.0, 52.0), (41.1, 66.0),
             (40.7, 80.0)]
    lip = [(40.0, 91.5), (39.0, 93.6), (37.2, 94.0), (36.0, 92.6)]
    inner = [(36.4, 80.0), (36.8, 60.0), (36.0, 30.0), (33.5, 10.0), (28.0, 6.0)]
    rings = [circle(n, r, z, 0.5 * (i % 2)) for i, (r, z) in enumerate(outer + lip + inner)]
    body.shell((0, 0, 0), rings, (0, 0, 5.5))

    # The handle: an oval tube swept along a bent path in the plane y = 0, both ends inside the wall.
    path = [(38.0, 78.0), (50.0, 80.5), (62.0, 78.0), (69.5, 69.5), (71.5, 58.0), (69.0, 45.0), (61.5, 33.5),
            (50.0, 26.5),
            (38.0, 24.0)]
    tube = []
    for i, (x, z) in enumerate(path):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        dx, dz = after[0] - before[0], after[1] - before[1]
        length = math.hypot(dx, dz)
        nx, nz = -dz / length, dx / length  # across the path, in its plane; y is the other way across
        ring = []
        for k in range(10):
            t = 2 * math.pi * (k + 0.5) / 10
            across, wide = 4.2 * math.cos(t), 6.8 * math.sin(t)
            ring.append((x + across * nx, wide, z + across * nz))
        # (path direction) × (across) is -y, so rings that turn from across to +y turn clockwise seen from ahead:
        # reverse.
        tube.append(ring[::-1])
    body.shell((path[0][0], 0, path[0][1]), tube, (path[-1][0], 0, path[-1][1]))
    return body


def blob(body, centre, axes, radii, n, latitudes, power=1.0):
    """A (super)ellipsoid shell with the given orthonormal axes; power below 1 makes it boxier."""

    def bend(c):
        return math.copysign(abs(c) ** power, c)

    def place(u, v, w):
        return tuple(centre[i] + u * axes[0][i] + v * axes[1][i] + w * axes[2][i] for i in range(3))

    rings = []
    for k, latitude in enumerate(latitudes):
        c, s = bend(math.cos(math.radians(latitude))), bend(math.sin(math.radians(latitude)))
        turn = [2 * math.pi * (i + 0.5 * (k % 2)) / n for i in range(n)]
        rings.append([place(radii[0] * c * bend(math.cos(t)), radii[1] * c * bend(math.sin(t)), radii[2] * s)
                      for t in turn])
    body.shell(place(0, 0, -radii[2]), rings, place(0, 0, radii[2]))


def tilted(yaw, pitch):
    """Right-handed axes whose third points along the given direction: yaw about z from -y, pitch below the horizon."""
    yaw, pitch = math.radians(yaw), math.radians(pitch)
    w = (math.sin(yaw) * math.cos(pitch), -math.cos(yaw) * math.cos(pitch), -math.sin(pitch))
    u = (math.cos(yaw), math.sin(yaw), 0.0)
    v = (w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0])
    return u, v, w


def gamepad():
    body = Body()
    level = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    # The slab between the hands: wide, boxy, its middle at the origin; x to the right, y away from the player, z up.
    blob(body, (0, 0, 0), level, (58.0, 34.0, 19.0), 24, (-62, -38, -14, 10, 34, 58), 0.8)
    for side in (-1, 1):
        # A grip, tapering towards the player and down.
        blob(body, (side * 56.0, -26.0, -6.0), tilted(side * 17.0, 22.0), (20.5, 18.0, 46.0), 14,
             (-60, -38, -16, 6, 28, 50, 70))
        # A trigger beyond the far edge.
        blob(body, (side * 47.0, 31.0, -3.0), tilted(180.0 - side * 12.0, 14.0), (15.0, 9.0, 13.0), 10,
             (-50, -10, 25, 55), 0.9)
        # A thumb stick: stem, then a cap that is slightly domed.
        x, y = (-40.0, 9.0) if side < 0 else (22.0, -14.0)
        stick = [(5.5, 12.0), (5.5, 24.0), (8.8, 25.5), (9.0, 28.0), (6.0, 29.4)]
        rings = [[(x + a, y + b, z) for a, b, _ in circle(12, r, 0, 0.5)] for r, z in stick]
        body.shell((x, y, 11.0), rings, (x, y, 29.6))
    return body


def main():
    mug().write("mug.off", ["A coffee mug with its handle, standing on z = 0; millimetres.",
                            "Written by make_models.py."])
    gamepad().write("gamepad.off", ["A game controller: slab, two grips, triggers and thumb sticks; millimetres.",
                                    "Written by make_models.py."])


if __name__ == "__main__":
    main()
