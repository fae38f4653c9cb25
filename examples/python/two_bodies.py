# SPDX-License-Identifier: MIT
"""Two bodies that both move: a pair by need, which is what most loops want.

A box flies by over a plate that spins, and touches it on the way. Both poses of all frames are asked in one call; a
loop that knows them one by one asks one by one, and the pair remembers what its last answer needed.
"""
import numpy as np

import pirouette

FRAMES, SHOW_EVERY = 200, 10
CUTOFF, MARGIN = 1.25, 0.02  # farther apart than this is all the same; contacts are asked for up to a margin
box, plate = pirouette.Polytope.shape("box?x=1&y=0.6&z=0.4"), pirouette.Polytope.shape("box?x=2&y=2&z=0.5")
pair = pirouette.Pair(box, plate)
time = np.arange(FRAMES + 1) / 60
zero = np.zeros_like(time)
poses_box = np.stack([np.sin(time / 2), zero, zero, np.cos(time / 2), 3 - 2 * time, zero + 0.25, zero + 0.6], axis=1)
poses_plate = np.stack([zero, zero, np.sin(time), np.cos(time), zero, zero, zero], axis=1)

answers = pair.signed_distance(poses_box, poses_plate, cutoff=CUTOFF)
counts = np.diff(pair.contacts(poses_box, poses_plate, margin=MARGIN).starts)
for frame in range(0, FRAMES + 1, SHOW_EVERY):
    if answers.distance[frame] == CUTOFF:
        print(f"frame {frame:3d}: farther apart than {CUTOFF:g}")
    else:
        print("frame {:3d}: distance {:.9f}, normal {:.9f} {:.9f} {:.9f}, {} contacts".format(
            frame, answers.distance[frame], *answers.normal[frame], counts[frame]))
print("done: two_bodies")
