# SPDX-License-Identifier: MIT
"""A sum that turns, drawn without making its mesh anew: a live mesh rewrites the facets that changed.

In place of a picture, each line gives the volume that the live facets enclose, and how many of them were rewritten.
"""
import math

import numpy as np

import pirouette

FRAMES, SHOW_EVERY = 60, 10
sum_ = pirouette.MinkowskiSum(*(pirouette.Polytope.shape(f"box?x={x}&y={y}&z={z}")
                                for x, y, z in ((1, 2, 3), (2, 1, 1))))
live, total = sum_.live(), 0
for frame in range(FRAMES + 1):
    half = 0.02 * frame
    sum_.rotate([0.6 * math.sin(half), 0.64 * math.sin(half), 0.48 * math.sin(half), math.cos(half)])
    live.refresh()
    total += len(live.rewritten)
    if frame % SHOW_EVERY == 0:
        a, b, c = live.vertices[live.facets.triangles()].swapaxes(0, 1)
        volume = (a * np.cross(b, c)).sum() / 6  # of the pyramids from the origin over all facets
        print(f"frame {frame:2d}: volume {volume:.12f}, {live.slots} facet slots, {total} rewritten so far")
print("done: redraw")
