# SPDX-License-Identifier: MIT
"""Slices, made here and read by h5py: rotations and planes of the file, held against those that the library gives.

Any program that reads HDF5 can do this. docs/slices.md has the form of the file. Needs h5py, and a package that was
built with HDF5.
"""
import pathlib
import sys
import tempfile

import numpy as np

import pirouette

try:
    import h5py
except ImportError:
    h5py = None
if h5py is None or not pirouette.HAS_SLICES:
    print("skipped: there is no h5py, or this package was built without HDF5")
    sys.exit()

robot, obstacle = pirouette.Polytope.shape("box?x=1&y=0.5&z=0.25"), pirouette.Polytope.shape("dodecahedron")
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / "space.h5"
    space = pirouette.CSpace.build(path, robot, obstacle, 0, planes=True)
    with h5py.File(path, "r") as file:
        rotations, counts = file["grid/rotation"][:], file["planes/count"][0]
        print(f"{np.bytes_(file.attrs['format']).decode()}, {len(rotations)} rotations, {counts.sum()} planes")
        # planes of a unit of slices stand together; the first unit begins at the begin
        first = file["planes/plane"][:counts[0]]
    assert np.array_equal(rotations, [space.rotation(i) for i in range(len(space))])
    assert np.array_equal(first, space.planes(0))

    # a translation is blocked where it is within all planes of its slice
    translations = np.random.default_rng(1).uniform(-2, 2, (2000, 3))
    within = (translations @ first[:, :3].T < first[:, 3] - 1e-9).all(axis=1)
    poses = np.hstack([np.tile(rotations[0], (2000, 1)), translations])
    states = pirouette.Pair(robot, obstacle).states(poses)
    print(f"{within.sum()} of 2000 translations are within all planes of slice 0")
    assert np.array_equal(within, states == pirouette.INSIDE)
    space.close()
print("done: slices_h5py")
