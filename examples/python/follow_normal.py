# SPDX-License-Identifier: MIT
"""Only the part of a difference that the next answer needs: a cone about the last contact normal.

One solid turns and slides inside another, so the least depth moves slowly from facet to facet, and the cone follows it.
The cone's answer is the least depth of all as long as that has its normal in the cone. The example asks the whole
difference as well, and turns the cone there when the least depth has left it; a game would do so once in a while.
"""
import copy
import math

import pirouette

FRAMES, SHOW_EVERY, HALF_ANGLE = 40, 5, 0.5
body = pirouette.Polytope.shape("icosahedron")
whole = pirouette.MinkowskiSum(body, body)
cone, axis = copy.copy(whole), None
for frame in range(FRAMES + 1):
    half = 0.01 * frame
    rotation = [0.3 * math.sin(half), math.sin(half), 0.2 * math.sin(half), math.cos(half)]
    place = [0.5 - 0.002 * frame, 0.3, 0.01 * frame]
    whole.rotate(rotation)
    truth = whole.penetrations(place)
    # the first axis comes from the whole difference, each later one from the cone's own answer
    axis = truth.normal if axis is None else axis
    cone.set_region(axis, HALF_ANGLE)
    cone.rotate(rotation)
    answer = cone.penetrations(place)
    if answer.depth > truth.depth:
        print(f"frame {frame:2d}: depth {truth.depth:.9f}, outside the cone; the cone has {answer.depth:.9f}")
        axis = truth.normal
        continue
    if frame % SHOW_EVERY == 0:
        off = math.acos(min(1.0, float(axis @ answer.normal)))
        print(f"frame {frame:2d}: depth {answer.depth:.9f}, {off:.4f} from the axis, {len(cone.ee)} of {len(whole.ee)} "
              "edge pairs kept")
    axis = answer.normal
print("done: follow_normal")
