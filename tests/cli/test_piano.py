#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The examples piano and piano_ompl find a way that is free at 10,000 points, and draw it.

The path that piano prints is asked again here, by the separating axes of its boxes. Usage: test_piano.py PROGRAM
"""
import itertools
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

# Boxes of the robot and of the wall, as corners; place.c has them too.
ROBOT = [((-1, -.15, -.2), (1, .15, .2)), ((.7, .15, -.2), (1, .75, .2))]
WALL = [((-.1, .4, -2), (.1, 4, 2)), ((-.1, -4, -2), (.1, -.4, 2))]


def corners(box):
    return list(itertools.product(*zip(*box)))


def placed(points, x, y, z, turn):
    c, s = math.cos(turn), math.sin(turn)
    return [(c * p[0] - s * p[1] + x, s * p[0] + c * p[1] + y, p[2] + z) for p in points]


def apart(a, b, turn):
    """Boxes that are turned about the vertical alone: five axes decide."""
    c, s = math.cos(turn), math.sin(turn)
    for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (c, s, 0), (-s, c, 0)):
        of_a = [sum(u * v for u, v in zip(axis, p)) for p in a]
        of_b = [sum(u * v for u, v in zip(axis, p)) for p in b]
        if max(of_a) < min(of_b) or max(of_b) < min(of_a):
            return True
    return False


def check_path(path):
    assert path[0] == (-2, 0, 0, 0) and path[-1] == (2, -.3, 0, 1.5), path
    walls = [corners(box) for box in WALL]
    for a, b in zip(path, path[1:]):
        for i in range(301):
            x, y, z, turn = (u + (v - u) * i / 300 for u, v in zip(a, b))
            for box in ROBOT:
                here = placed(corners(box), x, y, z, turn)
                assert all(apart(here, wall, turn) for wall in walls), (x, y, z, turn)
    # the gap is narrower than the robot, which cannot go straight
    assert any(math.cos(a[3]) < 0.99 for a in path)


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        done = subprocess.run([program, path / "slices.h5", path / "path.svg"], capture_output=True, text=True,
                              timeout=600)
        assert (done.returncode, done.stderr) == (0, ""), (done.returncode, done.stderr, done.stdout)
        assert "10000 points asked, 0 overlap" in done.stdout, done.stdout
        spots = [tuple(map(float, line.split())) for line in done.stdout.split("\n") if line.startswith("  ")]
        if spots or not pathlib.Path(program).name.startswith("piano_"):
            check_path(spots)
        drawing = xml.etree.ElementTree.parse(path / "path.svg").getroot()
        polygons = [e for e in drawing if e.tag.endswith("polygon")]
        assert len(polygons) == 40 * 2 + 3, len(polygons)
        assert all(len(re.findall(r"-?[\d.]+,-?[\d.]+", e.get("points"))) >= 4 for e in polygons)


if __name__ == "__main__":
    main(*sys.argv[1:])
