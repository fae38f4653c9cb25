#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files of slices and of VTK in the hands of other programs: h5py, h5dump, VTK.

Usage: test_readers.py COMMAND PYTHON, where PYTHON has h5py and VTK. Ends with 77, skipped, where one is
missing.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

STEPS = 12
PAIRS = ("0,0", "0,1")

# Run by PYTHON: the cells of each slice of a VTKHDF file, and those of the exported OFF files.
READ = r"""
import json, sys
from vtkmodules.vtkIOHDF import vtkHDFReader
import vtkmodules.vtkCommonDataModel
path, count = sys.argv[1], int(sys.argv[2])
slices = []
for k in range(count):
    reader = vtkHDFReader()
    assert reader.CanReadFile(path)
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.UpdatePiece(k, count, 0)
    grid = reader.GetOutput()
    data = grid.GetCellData()
    cells = []
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        assert cell.GetClassName() == "vtkPolygon"
        ids = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        cells.append([[data.GetArray(name).GetValue(c) for name in ("robot", "obstacle", "kind")],
                      [list(grid.GetPoint(i)) for i in ids]])
    slices.append(cells)
print(json.dumps(slices))
"""
LOOK = r"""
import json, sys
import h5py
with h5py.File(sys.argv[1], "r") as file:
    names = []
    file.visititems(lambda name, thing: names.append([name, list(getattr(thing, "shape", []) or [])]))
    print(json.dumps({"format": file.attrs["format"] if isinstance(file.attrs["format"], str)
                      else file.attrs["format"].decode(), "version": int(file.attrs["version"]), "names": names,
                      "rotation": file["grid/rotation"][...].tolist()}))
"""
SECTIONS = r"""
import json, sys
import h5py
with h5py.File(sys.argv[1], "r") as file:
    group = file["planar"]
    axis = group.attrs["axis"]
    print(json.dumps({"axis": axis if isinstance(axis, str) else axis.decode(), "offset": float(group.attrs["offset"]),
                      "count": group["count"][...].tolist(), "corner": group["corner"][...].tolist()}))
"""


def main(command, python):
    for what, program in (("h5py and VTK", [python, "-c", "import h5py, vtkmodules.vtkIOHDF"]),
                          ("h5dump", ["h5dump", "-V"])):
        if not shutil.which(program[0]) or subprocess.run(program, capture_output=True).returncode != 0:
            print(f"no {what}")
            return 77

    def run(*args):
        done = subprocess.run([str(arg) for arg in args], check=True, timeout=600, stdout=subprocess.PIPE)
        return done.stdout.decode()

    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        (path / "q").mkdir()
        run(command, "shape", "octahedron", "-o", path / "q" / "0.off")
        run(command, "shape", "icosahedron", "-o", path / "q" / "1.off")
        slices = path / "s.h5"
        run(command, "slice", "shape:cube", path / "q", "-o", slices, "--axis", "1,2,3", "--steps", STEPS, "--planar",
            "z=0.25")

        seen = json.loads(run(python, "-c", LOOK, slices))
        names = dict(seen["names"])
        assert (seen["format"], seen["version"]) == ("pirouette slices", 3), seen
        assert names["grid/rotation"] == [STEPS, 4] and names["obstacle/1/vertex"] == [12, 3], names
        assert len(names["slices/bytes"]) == 1 and names["slices/length"] == [2, STEPS], names
        dump = run("h5dump", "-H", slices)
        for name in ("rotation", "bytes", "length", "off", "planar"):
            assert f'"{name}"' in dump, name

        run(command, "view", slices, "-o", path / "s.vtkhdf")
        read = json.loads(run(python, "-c", READ, path / "s.vtkhdf", STEPS))
        sections = json.loads(run(python, "-c", SECTIONS, slices))
        assert (sections["axis"], sections["offset"]) == ("z", 0.25)
        assert len(sections["count"]) == 2 * STEPS and sum(sections["count"]) == len(sections["corner"])
        corner = iter(sections["corner"])
        polygons = [[next(corner) for _ in range(count)] for count in sections["count"]]
        for k in range(STEPS):
            for number, pair in enumerate(PAIRS):
                run(command, "view", slices, "--slice", k, "--pair", pair, "-o", path / "one.off")
                lines = (path / "one.off").read_text().split("\n")
                vertices, facets = map(int, lines[1].split()[:2])
                points = [list(map(float, line.split())) for line in lines[2:2 + vertices]]
                exported = sorted([points[int(i)] for i in line.split()[1:]]
                                  for line in lines[2 + vertices:2 + vertices + facets])
                own = sorted(corners for (_, obstacle, kind), corners in read[k]
                             if obstacle == number and 0 <= kind < 4)
                assert own == exported, (k, pair)
                check_section(polygons[number * STEPS + k], points)
    print(f"{STEPS} slices of {len(PAIRS)} pairs read by VTK, h5py and h5dump")
    return 0


def check_section(polygon, points):
    """Each corner is at z = 0.25, and the polygon is the hull of where segments of vertices cross it."""
    assert all(corner[2] == 0.25 for corner in polygon)
    below, above = [p for p in points if p[2] <= 0.25], [p for p in points if p[2] > 0.25]
    assert bool(polygon) == bool(below and above)
    ring = list(zip(polygon, polygon[1:] + polygon[:1]))
    for p in below:
        for q in above:
            t = (0.25 - p[2]) / (q[2] - p[2])
            x, y = (p[k] + t * (q[k] - p[k]) for k in range(2))
            assert all((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > -1e-9 for a, b in ring)
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in ring)
    assert not polygon or area > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
