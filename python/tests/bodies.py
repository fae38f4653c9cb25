# SPDX-License-Identifier: MIT
"""Bodies and poses to test with."""
import numpy as np

import pirouette

SEED = 20261127


def sphere(count, seed=1):
    """A polytope of points of the unit sphere."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return pirouette.Polytope(points / np.linalg.norm(points, axis=1)[:, None])


def hovering(count, seed=2, reach=1.6):
    """Poses of a motion about contact of two bodies of size 1, (n, 7)."""
    random = np.random.default_rng(seed)
    axis = random.normal(size=3)
    half = np.arange(count) * (np.pi / 500)
    made = np.empty((count, 7))
    made[:, :3] = axis / np.linalg.norm(axis) * np.sin(half)[:, None]
    made[:, 3] = np.cos(half)
    way = random.normal(size=3)
    made[:, 4:] = way / np.linalg.norm(way) * (reach + 0.4 * np.sin(np.arange(count) / 90))[:, None]
    return made


CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
EXAMPLES = "PIROUETTE_SOURCE"
