# SPDX-License-Identifier: MIT
"""Slices: never wrong beside pairs, exact on the grid; and what a build without them says."""
import numpy as np
import pytest

import pirouette
from bodies import SEED, sphere

needs_slices = pytest.mark.skipif(not pirouette.HAS_SLICES, reason="built without HDF5")


def test_without_slices_it_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("pirouette._cspaces.HAS_SLICES", False)
    for call in (lambda: pirouette.CSpace.open(tmp_path / "a.h5"), lambda: pirouette.CSpace.check(tmp_path / "a.h5"),
                 lambda: pirouette.CSpace.build(tmp_path / "a.h5", sphere(8), sphere(8), 0)):
        with pytest.raises(pirouette.Error, match="HDF5") as told:
            call()
        assert told.value.status == "NOT_BUILT"


@pytest.fixture(scope="module")
def space(tmp_path_factory):
    path = tmp_path_factory.mktemp("slices") / "space.h5"
    walls = [sphere(10, 4).moved([1.5, 0, 0]), sphere(12, 5).moved([-1.5, 0.2, 0])]
    return path, pirouette.CSpace.build(path, sphere(9, 3), walls, 1, threads=2)


def least_states(space, poses):
    """The most overlapping state of each pose, and the least distance, by pairs."""
    pairs = [pirouette.Pair(p, q) for p in space.robot for q in space.obstacles]
    answers = [pair.signed_distance(poses) for pair in pairs]
    return np.max([a.state for a in answers], axis=0), np.min([a.distance for a in answers], axis=0)


@needs_slices
def test_classified_poses_are_never_wrong(space):
    path, space = space
    print("seed", SEED)
    random = np.random.default_rng(SEED)
    poses = np.hstack([random.normal(size=(1500, 4)), random.uniform(-3, 3, (1500, 3))])
    poses[::5, :4] = [space.rotation(int(i)) for i in random.integers(0, len(space), 300)]
    found = space.classify(poses)
    states, _ = least_states(space, poses)
    assert np.array_equal(found.verdict == pirouette.FREE, states == pirouette.OUTSIDE)
    assert found.on_grid[::5].all() and np.array_equal(found.state[::5], states[::5])
    assert set(found.verdict.tolist()) == {pirouette.FREE, pirouette.BLOCKED}
    one = space.classify(poses[7])
    assert one.verdict.shape == () and one.verdict == found.verdict[7]
    with pytest.raises(pirouette.InputError, match=r"poses\[1\]"):
        space.classify([[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0]])
    assert np.array_equal(space.verdicts(poses), found.verdict)
    poses[[3, 8], [0, 5]] = np.nan
    rest, some = np.delete(np.arange(len(poses)), [3, 8]), space.classify(poses, bad="nan")
    assert (some.verdict[[3, 8]] == 255).all() and np.isnan(some.turn[[3, 8]]).all()
    assert np.array_equal(some.verdict, space.verdicts(poses, bad="nan"))
    for before, now in zip(found, some):
        assert np.array_equal(before[rest], now[rest])
    with pytest.raises(pirouette.InputError, match=r"poses\[3\]"):
        space.verdicts(poses)
    with pytest.raises(pirouette.InputError, match="bad"):
        space.verdicts(poses, bad="none")


@needs_slices
def test_free_motions_are_free(space):
    path, space = space
    random = np.random.default_rng(SEED + 1)
    a, b = (np.hstack([random.normal(size=(40, 4)), random.uniform(-4, 4, (40, 3))]) for _ in range(2))
    for poses in (a, b):
        poses[:, :4] /= np.linalg.norm(poses[:, :4], axis=1)[:, None]
    found = space.segment(a, b)
    assert 1 in found.verdict and 2 in found.verdict
    for i in np.flatnonzero(found.verdict == pirouette.FREE):
        other = b[i] if a[i, :4] @ b[i, :4] >= 0 else b[i] * [-1, -1, -1, -1, 1, 1, 1]
        angle, s = np.arccos(a[i, :4] @ other[:4]), np.linspace(0, 1, 60)[:, None]
        way = np.hstack([np.sin((1 - s) * angle) * a[i, :4] + np.sin(s * angle) * other[:4],
                         (1 - s) * a[i, 4:] + s * other[4:]])
        assert (least_states(space, way)[0] == pirouette.OUTSIDE).all()


@needs_slices
def test_a_file_of_slices_is_opened_again(space, tmp_path):
    path, space = space
    pirouette.CSpace.check(path)
    again = pirouette.CSpace.open(path)
    assert repr(again) == repr(space) == "<CSpace: 576 rotations, 1 pieces among 2>"
    assert np.array_equal(again.robot[0].vertices, sphere(9, 3).vertices)
    planes, mesh = again.planes(5, obstacle=1), again.mesh(5, obstacle=1)
    assert (mesh.vertices @ planes[:, :3].T <= planes[:, 3] + 1e-9).all()
    turned = pirouette.Polytope(space.robot[0].vertices).moved([0, 0, 0], again.rotation(5))
    wall = space.obstacles[1].vertices
    assert np.allclose(mesh.vertices.max(axis=0), wall.max(axis=0) - turned.vertices.min(axis=0))
    with pytest.raises(pirouette.InputError, match="slice"):
        again.mesh(10**6)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    (tmp_path / "bad.h5").write_bytes(data)
    for call in (pirouette.CSpace.check, pirouette.CSpace.open):
        with pytest.raises(pirouette.Error, match="bad.h5"):
            call(tmp_path / "bad.h5").classify(np.tile([0.0, 0, 0, 1, 0, 0, 0], (1, 1)))
    with pytest.raises(pirouette.FileError):
        pirouette.CSpace.open(tmp_path / "none.h5")


@needs_slices
def test_grids_of_other_kinds(tmp_path):
    about = pirouette.CSpace.build(tmp_path / "a.h5", sphere(8), sphere(8, 2), 12, axis=[0, 0, 1])
    assert len(about) == 12 and np.allclose(about.rotation(3)[:2], 0)
    some = pirouette.CSpace.build(tmp_path / "b.h5", sphere(8), sphere(8, 2), [[0, 0, 0, 1], [0, 0, 1, 1]])
    assert len(some) == 2 and some.classify([0, 0, 2, 2, 9, 0, 0]).on_grid
    for wrong in ({"rotations": 99}, {"rotations": [[0, 0]]}, {"rotations": 3, "axis": [0, 0, 0]}):
        with pytest.raises(pirouette.InputError, match="rotations"):
            pirouette.CSpace.build(tmp_path / "c.h5", sphere(8), sphere(8, 2), **wrong)
