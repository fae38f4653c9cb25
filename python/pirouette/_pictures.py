# SPDX-License-Identifier: MIT
"""Pictures of convex meshes, for notebooks: SVG that needs nothing else."""
from __future__ import annotations

from typing import List

import numpy as np

from ._arrays import Bytes, Floats
from ._polytopes import Mesh

SIZE, MARGIN = 360, 12
# hues of facets by what they came from: P, Q, an edge of each, several
HUES = (212, 28, 150, 280)


def _view() -> Floats:
    """The world's axes seen from (3, -2, 1.5): right, up, towards the eye."""
    eye = np.array([3, -2, 1.5])
    toward = eye / np.linalg.norm(eye)
    right = np.cross([0, 0, 1], toward)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(toward, right), toward])


def _normal(polygon: Floats) -> Floats:
    """Newell's, of unit length, or 0."""
    found = np.cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0)
    length = float(np.linalg.norm(found))
    unit: Floats = found / length if length > 0 else found
    return unit


def svg_of(mesh: Mesh, title: str) -> str:
    """The facets that are seen, shaded, as one SVG element of SIZE by SIZE. No number of the model but its shape and
    the title is in it."""
    seen = mesh.vertices @ _view().T
    low, high = (seen.min(axis=0), seen.max(axis=0)) if len(seen) else (np.zeros(3), np.ones(3))
    extent = float(max(high[0] - low[0], high[1] - low[1]))
    with np.errstate(over="ignore", invalid="ignore"):
        scale = (SIZE - 2 * MARGIN) / extent if extent > 0 else 1.0
        flat = (seen[:, :2] - (low[:2] + high[:2]) / 2) * [scale, -scale] + SIZE / 2
    parts = _parts(mesh, seen, np.nan_to_num(flat), mesh.kinds)
    text = title.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}" height="{SIZE}" viewBox="0 0 {SIZE} {SIZE}" '
            f'role="img"><title>{text}</title><g stroke="#222" stroke-width="0.8" stroke-linejoin="round">'
            f'{"".join(parts)}</g></svg>')


def _parts(mesh: Mesh, seen: Floats, flat: Floats, kinds: Bytes) -> List[str]:
    made = []
    for kind, corners in zip(kinds.tolist(), mesh.facets.polygons()):
        facing = _normal(seen[corners]) if len(corners) > 2 else np.array([0.0, 0, 1])
        if facing[2] <= 0:
            continue
        light = 42 + round(38 * max(0.0, float(facing @ [-0.3, 0.6, 0.74])))
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in flat[corners])
        made.append(f'<polygon points="{points}" fill="hsl({HUES[min(kind, 3)]},45%,{light}%)"/>')
    return made
