# SPDX-License-Identifier: MIT
"""The path of a bar around a post, bent by the gradient of the signed distance: turns too.

The path is a row of poses. Its first and last stay; the others begin on the straight line between them, where the bar
runs through the post. Each step moves them against the gradient of

    sum of the squared ways and turns from pose to pose  +  PUSH · sum of max(0, MARGIN − distance)²
"""
import numpy as np

import pirouette

POSES, STEPS, MARGIN, PUSH, STEP = 13, 800, 0.1, 30.0, 0.02
bar, post = pirouette.Polytope.shape("box?x=1.6&y=0.2&z=0.2"), pirouette.Polytope.shape("box?x=0.4&y=0.4&z=4")
pair = pirouette.Pair(bar, post)


def product(a, b):
    """Of quaternions x, y, z, w."""
    v, w = a[:, :3], a[:, 3:]
    return np.hstack([w * b[:, :3] + b[:, 3:] * v + np.cross(v, b[:, :3]),
                      w * b[:, 3:] - (v * b[:, :3]).sum(axis=1, keepdims=True)])


def steps_between(path):
    """Ways and turns from each pose to the next, (n - 1, 6), turns to second order in the world."""
    a, b = path[:-1], path[1:]
    turn = product(b[:, :4], a[:, :4] * [-1, -1, -1, 1])
    return np.hstack([b[:, 4:] - a[:, 4:], np.where(turn[:, 3:] < 0, -2, 2) * turn[:, :3]])


def moved(path, by):
    """Poses after small motions (v, w): moved by v, and turned about their origins by w."""
    angle = np.linalg.norm(by[:, 3:], axis=1, keepdims=True)
    turn = np.hstack([by[:, 3:] * np.sinc(angle / (2 * np.pi)) / 2, np.cos(angle / 2)])
    turned = product(turn, path[:, :4])
    return np.hstack([turned / np.linalg.norm(turned, axis=1, keepdims=True), path[:, 4:] + by[:, :3]])


path = np.zeros((POSES, 7))
path[:, 3], path[:, 4], path[:, 5:] = 1, 3 * np.arange(POSES) / (POSES - 1) - 1.5, [0.125, 0.0625]
path[-1, :4] = [0, 0, 0.28, 0.96]  # the bar arrives turned by 33°
for step in range(STEPS + 1):
    answers = pair.signed_distance(path[1:-1], gradient=True)
    if step % (STEPS // 4) == 0:
        print(f"step {step}: least distance {answers.distance.min():+.6f}")
    steps = steps_between(path)
    slope = steps[:-1] - steps[1:] - PUSH * np.maximum(0, MARGIN - answers.distance)[:, None] * answers.gradient
    if step < STEPS:
        path[1:-1] = moved(path[1:-1], -STEP * slope)
for number, (x, y, z, w, *place) in enumerate(path):
    print("pose {}: {:.17g} {:.17g} {:.17g} turned {:.17g} {:.17g} {:.17g} {:.17g}".format(number, *place, x, y, z, w))
print("done: bend_path")
