# SPDX-License-Identifier: MIT
"""Objects as Python has them: copies, pickles, contexts, threads, memory."""
import copy
import pickle
import resource
import subprocess
import sys
import threading

import numpy as np
import pytest

import pirouette
from bodies import CORNERS, hovering, sphere


def test_polytopes_are_pickled_exactly(tmp_path):
    third = pirouette.Polytope(CORNERS).moved([0.1, 0.2, 0.3], [1, 2, 3, 4])
    again = pickle.loads(pickle.dumps(third))
    for body in (third, again):
        body.write(tmp_path / f"{body is third}.off", exact=True)
    assert (tmp_path / "True.off").read_text() == (tmp_path / "False.off").read_text()
    assert "/" in (tmp_path / "True.off").read_text()
    assert np.array_equal(third.vertices, again.vertices) and np.array_equal(third.edges, again.edges)
    assert copy.copy(third) is third and copy.deepcopy(third) is third


def test_pairs_and_sums_are_pickled_and_copied():
    pair = pirouette.Pair(sphere(12), sphere(20), threads=2)
    for other in (pickle.loads(pickle.dumps(pair)), copy.copy(pair), copy.deepcopy(pair)):
        assert other.threads == 2
        assert np.array_equal(other.signed_distance(hovering(50)).distance, pair.signed_distance(hovering(50)).distance)
    sum_ = pirouette.MinkowskiSum(sphere(12), sphere(20), [1, 2, 3, 4])
    sum_.depths([[0, 0, 0]])
    for other in (pickle.loads(pickle.dumps(sum_)), copy.copy(sum_), copy.deepcopy(sum_)):
        assert np.array_equal(other.ee, sum_.ee) and np.array_equal(other.rotation, sum_.rotation)
        assert np.array_equal(other.distances(hovering(9)[:, 4:]), sum_.distances(hovering(9)[:, 4:]))
        other.rotate([0, 0, 1, 5])
    assert sum_.rotation.tolist() == [1, 2, 3, 4]
    field = pirouette.HeightField(np.arange(6.0).reshape(2, 3), step=(1, 2))
    assert np.array_equal(pickle.loads(pickle.dumps(field)).heights, field.heights)


def test_files(tmp_path):
    body = sphere(30)
    for ending in ("off", "obj", "ply"):
        path = tmp_path / f"body.{ending}"
        body.write(path)
        again = pirouette.Polytope.read(path)
        assert sorted(map(tuple, again.vertices)) == sorted(map(tuple, body.vertices))
    assert len(pirouette.TriMesh.read(path)) == len(body.faces)
    assert np.isclose(pirouette.Solid.read(path).volume, body.volume)
    pirouette.MinkowskiSum(body, CORNERS).mesh(exact=True).write(tmp_path / "sum.off", exact=True)


def test_what_is_closed_raises():
    for made in (pirouette.Pair(CORNERS, CORNERS), pirouette.MinkowskiSum(CORNERS, CORNERS), pirouette.Scene()):
        with made:
            pass
        with pytest.raises(pirouette.InputError, match="closed"):
            made.close()
    with pytest.raises(pirouette.InputError, match="closed"):
        repr_of = pirouette.MinkowskiSum(CORNERS, CORNERS)
        repr_of.close()
        repr_of.rotate([0, 0, 0, 1])


def test_reprs():
    assert repr(pirouette.Polytope(CORNERS)) == "<Polytope: 8 vertices, 12 edges, 6 facets>"
    assert repr(pirouette.Scene()) == "<Scene: 0 bodies>"
    assert "Polytope" in repr(pirouette.Pair(CORNERS, CORNERS)) + repr(pirouette.MinkowskiSum(CORNERS, CORNERS))


def test_an_object_is_of_one_thread_at_a_time():
    pair, poses = pirouette.Pair(sphere(300), sphere(300, 9)), hovering(20000)
    right, told = pair.signed_distance(poses).distance, []

    def ask():
        for _ in range(5):
            try:
                told.append(np.array_equal(pair.signed_distance(poses).distance, right))
            except pirouette.InUse:
                told.append(None)

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert False not in told and True in told and None in told


def test_threads_with_pairs_of_their_own():
    p, q, poses = sphere(40), sphere(60), hovering(5000)
    right, told = pirouette.Pair(p, q).signed_distance(poses).distance, []

    def ask():
        told.append(np.array_equal(pirouette.Pair(p, q).signed_distance(poses).distance, right))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert told == [True] * 4


def made_and_dropped(count):
    poses = hovering(3)
    for i in range(count):
        cube = pirouette.Polytope(CORNERS)
        kind = i % 8
        if kind == 0:
            pirouette.Pair(cube, cube).signed_distance(poses, hessian=True)
        elif kind == 1:
            pirouette.MinkowskiSum(cube, cube).mesh(exact=True).exact
        elif kind == 2:
            pirouette.Scene().add(pirouette.Shape.compound([(pirouette.Shape.box([1, 1, 1]), [0, 0, 0, 1, 0, 0, 0])]))
        elif kind == 3:
            pirouette.TriMesh(CORNERS, [[0, 1, 2]])
        elif kind == 4:
            pirouette.MinkowskiSum(cube, cube).next_event([1, 2, 3])
        elif kind == 5:
            pirouette.MinkowskiSum(cube, cube).live().facets
        elif kind == 6:
            pirouette.Solid(cube).contacts(pirouette.Solid(cube), poses)
        else:
            pirouette.plan(cube, cube, [3, 0, 0], [4, 0, 0])


def test_objects_leave_nothing_behind():
    made_and_dropped(2000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    made_and_dropped(12000)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 2000


USER = '''
import numpy as np
import numpy.typing as npt
import pirouette


def closest(points: npt.NDArray[np.float64], poses: npt.NDArray[np.float64]) -> float:
    with pirouette.Pair(points, pirouette.Polytope.shape("cube")) as pair:
        answers = pair.signed_distance(poses, gradient=True)
    assert answers.gradient is not None
    lowest: int = int(answers.distance.argmin())
    return float(answers.distance[lowest]) + float(answers.gradient[lowest, 0])


def depth(a: pirouette.Solid, b: pirouette.Solid) -> npt.NDArray[np.float64]:
    return a.depth(b, np.zeros((1, 7))).depth


mesh: pirouette.Mesh = pirouette.MinkowskiSum(np.eye(3), np.eye(3)).mesh()
faces: npt.NDArray[np.uint32] = mesh.faces
events: pirouette.Events = pirouette.Scene().update()
turn = pirouette.MinkowskiSum(np.eye(3), np.eye(3)).next_event([0, 0, 1])
angle: float = turn.angle[0] if turn is not None else 0.0
way: pirouette.Plan = pirouette.plan(pirouette.Polytope.shape("cube"), [pirouette.Polytope.shape("cube")], [0, 0, 3],
                                     [3, 0, 0], bounds=[[-4, -4, -4], [4, 4, 4]])
points: npt.NDArray[np.float64] = way.points
body: int = pirouette.Scene().add(pirouette.Shape.ball(1.0), fast=1e-6)
'''


def test_types(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "user.py").write_text(USER)
    found = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"),
                            str(tmp_path / "user.py")], cwd=tmp_path, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr
