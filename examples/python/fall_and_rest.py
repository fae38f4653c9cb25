# SPDX-License-Identifier: MIT
"""A game loop: a box falls on a table while it tips level, and comes to rest on the contacts that the loop finds."""
import math

import numpy as np

import pirouette

FRAMES, LEVEL_AT, SHOW_EVERY, STEP, GRAVITY, MARGIN = 48, 40, 4, 1 / 60, -9.81, 0.01
pair = pirouette.Pair(pirouette.Polytope.shape("box?x=1&y=0.6&z=0.4"), pirouette.Polytope.shape("box?x=8&y=8&z=1"))
place, speed = np.array([0.0, 0, 2]), 0.0
for frame in range(FRAMES + 1):
    # the box tips about (1, 1, 0), from 0.8 radians to none; quaternions of any length will do
    half = 0.4 * (LEVEL_AT - frame) / LEVEL_AT if frame < LEVEL_AT else 0.0
    turn = [math.sin(half), math.sin(half), 0, math.sqrt(2) * math.cos(half)]
    answer = pair.signed_distance([*turn, *place])
    if answer.state == pirouette.INSIDE:
        # the normal points from the table to the box, and the distance is minus the depth
        place -= answer.distance * answer.normal
        speed = 0.0
        answer = pair.signed_distance([*turn, *place])
    count = len(pair.contacts([*turn, *place], margin=max(MARGIN, float(answer.distance))).distance)
    if frame % SHOW_EVERY == 0:
        print(f"frame {frame:2d}: height {place[2]:.6f}, distance {answer.distance:.6f}, {count} contacts")
    speed += GRAVITY * STEP
    place[2] += speed * STEP
print("done: fall_and_rest")
