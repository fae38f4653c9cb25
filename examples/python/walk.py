# SPDX-License-Identifier: MIT
"""A capsule walks over hills that are a height field, and stops before a wall, as a character in a game does.

It is no body: it asks the scene what it would meet. Balls that lie about are left out of its questions.
"""
import numpy as np

import pirouette

SIDE, RADIUS, STEP, WALL = 65, 0.4, 0.1, 50.0
x, y = np.meshgrid(np.arange(SIDE), np.arange(SIDE))
heights = 1.2 * np.sin(0.35 * x) * np.cos(0.27 * y)
scene = pirouette.Scene()
hills = scene.add(pirouette.HeightField(heights), kind="static")
wall = scene.add(pirouette.Polytope.shape("box?x=1&y=64&z=20"), kind="static", pose=[0, 0, 0, 1, WALL, 32, 0])
random = np.random.default_rng(1)
balls = [scene.add(pirouette.Shape.ball(0.3), pose=[0, 0, 0, 1, *random.uniform(2, 62, 2), 2]) for _ in range(100)]
scene.update()

body = pirouette.Polytope([[0, 0, -0.5], [0, 0, 0.5]])  # with a radius a capsule
place, walked = np.array([5.0, 32, 5]), 0.0
for _ in range(1000):
    # down to the ground, up to where there is room, then ahead as far as it is free
    below = place - [0, 0, 20]
    met, down = scene.cast(body, [0, 0, 0, 1, *place], [0, 0, 0, 1, *below], radius=RADIUS, ignored=balls)
    assert met == hills
    place[2] -= 20 * down.time
    raised = place + [0, 0, 0.25]
    met, ahead = scene.cast(body, [0, 0, 0, 1, *raised], [0, 0, 0, 1, *(raised + [STEP, 0, 0])], radius=RADIUS,
                            ignored=balls)
    place = raised + [STEP * ahead.time, 0, 0]
    walked += STEP * ahead.time
    if met == wall:
        break
print(f"walked {walked:.2f}, stopped {WALL - 0.5 - place[0]:.2f} before the wall by its radius")
assert met == wall and abs(place[0] - (WALL - 0.5 - RADIUS)) < 1e-3
print("done: walk")
