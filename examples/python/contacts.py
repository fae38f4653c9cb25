# SPDX-License-Identifier: MIT
"""A cube is lowered onto a table while it turns level: where they touch in each frame.

A solver would put an impulse at each contact; the ids tell it which contact of the frame before is the same.
"""
import numpy as np

import pirouette

FRAMES, MARGIN = 8, 0.05  # contacts are asked for before the bodies meet; farther away, nothing
pair = pirouette.Pair(pirouette.Polytope.shape("cube"), pirouette.Polytope.shape("box?x=4&y=4&z=0.1"))
frames = np.arange(FRAMES)
half = 0.02 * (1 - frames / (FRAMES - 1))  # half the angle by which the cube is tilted
poses = np.zeros((FRAMES, 7))
poses[:, 0], poses[:, 3], poses[:, 6] = np.sin(half), np.cos(half), 0.62 - 0.02 * frames

distances = pair.signed_distance(poses, cutoff=MARGIN).distance
contacts = pair.contacts(poses, margin=MARGIN)
for frame, (a, b) in enumerate(zip(contacts.starts[:-1], contacts.starts[1:])):
    print(f"frame {frame}: distance {distances[frame]:+.4f}, {b - a} contacts")
    for i in range(a, b):
        print("  {:016x} at ({:+.3f}, {:+.3f}, {:+.3f}), {:+.4f} apart".format(
            contacts.id[i], *contacts.point_q[i], contacts.distance[i]))
print("done: contacts")
