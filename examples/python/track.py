# SPDX-License-Identifier: MIT
"""The sum of two bodies while the first turns once about the z axis; writes the last one.

    track.py [P.off Q.off SUM.off]

The sum is carried from frame to frame; what the frames cost shows in its counters.
"""
import math
import pathlib
import sys

import pirouette

STEPS, SHOW_EVERY = 3600, 600
models = pathlib.Path(__file__).resolve().parents[1] / "models"
given = sys.argv[1:] or [models / "gamepad.off", models / "mug.off", "track.off"]
sum_ = pirouette.MinkowskiSum(*(pirouette.Polytope.read(path) for path in given[:2]))
before = sum_.statistics()
print("frame  ee pairs  looked at  repaired")
for frame in range(1, STEPS + 1):
    half = math.pi * frame / STEPS
    sum_.rotate([0, 0, math.sin(half), math.cos(half)])
    if frame % SHOW_EVERY == 0:
        now = sum_.statistics()
        checked, repaired = ((now[name] - before[name]) / SHOW_EVERY for name in ("checked", "repaired"))
        print(f"{frame:5d}  {len(sum_.ee):8d}  {checked:9.1f}  {repaired:8.1f}")
        before = now
mesh = sum_.mesh()
mesh.write(given[2])
print(f"{given[2]}: {len(mesh.vertices)} vertices, {len(mesh)} facets")
print("done: track")
