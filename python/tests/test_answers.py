# SPDX-License-Identifier: MIT
"""Answers from arrays are those of single calls of the library, bit for bit, and those that geometry has."""
import numpy as np
import pytest

import pirouette
from bodies import CORNERS, hovering, sphere
from pirouette._native import ffi, lib


def by_single_calls(p, q, poses):
    """Distances, states, normals and points of a pair that is made for each pose."""
    rows = []
    for pose in poses:
        made, scratch, found = ffi.new("pir_pair **"), ffi.new("pir_workspace **"), ffi.new("pir_query_result *")
        assert lib.pir_pair_create(p._pointer, q._pointer, ffi.NULL, made) == 0
        assert lib.pir_workspace_create(ffi.NULL, scratch) == 0
        asked = ffi.new("pir_pair_input *", lib.pir_pair_input_default())
        asked.pose_p = {"rotation": dict(zip("xyzw", pose[:4])), "translation": dict(zip("xyz", pose[4:]))}
        assert lib.pir_pair_signed_distance(made[0], scratch[0], asked, found) == 0
        rows.append([found.distance, found.state] +
                    [getattr(v, a) for v in (found.normal, found.point_p, found.point_q) for a in "xyz"])
        lib.pir_pair_destroy(made[0])
        lib.pir_workspace_destroy(scratch[0])
    return np.array(rows)


@pytest.mark.parametrize("vertices", [8, 60, 200])
@pytest.mark.parametrize("threads", [1, 2])
def test_answers_have_the_bits_of_single_calls(vertices, threads):
    p, q, poses = sphere(vertices, 3), sphere(vertices, 4), hovering(700)
    answers = pirouette.Pair(p, q, threads).signed_distance(poses)
    single = by_single_calls(p, q, poses)
    assert np.array_equal(answers.distance, single[:, 0])
    assert np.array_equal(answers.state, single[:, 1])
    assert np.array_equal(np.hstack([answers.normal, answers.point_p, answers.point_q]), single[:, 2:])
    assert {0, 2} <= set(answers.state.tolist())


def test_points_and_normals_fit_together():
    pair, poses = pirouette.Pair(sphere(40), CORNERS), hovering(300)
    a = pair.signed_distance(poses)
    assert np.allclose(a.point_p - a.point_q, a.normal * a.distance[:, None], atol=1e-12)
    assert np.allclose(np.linalg.norm(a.normal, axis=1), 1)
    assert np.array_equal(a.distance > 0, a.state == pirouette.OUTSIDE)
    assert np.array_equal(pair.states(poses), a.state)
    assert np.array_equal(pair.overlap(poses), a.state == pirouette.INSIDE)
    near = pair.signed_distance(poses, cutoff=0.05)
    assert np.array_equal(near.distance, np.minimum(a.distance, 0.05))


def test_gradients_are_those_of_differences():
    pair, poses = pirouette.Pair(sphere(20), sphere(30)), hovering(200)
    a = pair.signed_distance(poses, gradient=True)
    h = 1e-6
    for axis in range(3):
        more, less = poses.copy(), poses.copy()
        more[:, 4 + axis] += h
        less[:, 4 + axis] -= h
        slope = (pair.signed_distance(more).distance - pair.signed_distance(less).distance) / (2 * h)
        assert np.median(np.abs(slope - a.gradient[:, axis])) < 1e-7
        turn = np.zeros(4)
        turn[axis], turn[3] = h / 2, 1
        more, less = poses.copy(), poses.copy()
        for array, sign in ((more, 1), (less, -1)):
            array[:, :4] = multiplied(turn * [sign, sign, sign, 1], poses[:, :4])
        slope = (pair.signed_distance(more).distance - pair.signed_distance(less).distance) / (2 * h)
        assert np.median(np.abs(slope - a.gradient[:, 3 + axis])) < 1e-7


def multiplied(a, b):
    v, w = np.cross(a[:3], b[:, :3]) + a[3] * b[:, :3] + b[:, 3:] * a[:3], a[3] * b[:, 3] - b[:, :3] @ a[:3]
    return np.hstack([v, w[:, None]])


def test_matrices_are_poses():
    poses = hovering(100)
    pair = pirouette.Pair(sphere(20), sphere(30))
    x, y, z, w = poses[:, :4].T
    matrices = np.zeros((100, 4, 4))
    matrices[:, :3, :3] = np.moveaxis(np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]), 2, 0)
    matrices[:, :3, 3], matrices[:, 3, 3] = poses[:, 4:], 1
    assert np.allclose(pair.signed_distance(matrices).distance, pair.signed_distance(poses).distance, atol=1e-13)
    assert float(pair.signed_distance(matrices[3]).distance) == pair.signed_distance(matrices).distance[3]


def test_poses_of_both_and_one_for_all():
    pair, poses = pirouette.Pair(CORNERS, CORNERS), hovering(50)
    both = pair.signed_distance(poses, poses).distance
    assert np.allclose(both, -1)
    one = pair.signed_distance(poses, [0, 0, 0, 1, 0, 0, 0.25]).distance
    assert np.array_equal(one, pair.signed_distance(poses, np.tile([0, 0, 0, 1, 0, 0, 0.25], (50, 1))).distance)
    other = pair.signed_distance([0, 0, 0, 1, 0, 0, 0.25], poses).distance
    assert np.allclose(other, one)


def test_contacts():
    pair = pirouette.Pair(CORNERS, CORNERS)
    poses = np.array([[0, 0, 0, 1, 0, 0, 0.75], [0, 0, 0, 1, 0, 0, 3], [0, 0, 0, 1, 0.5, 0.5, 1.0]])
    c = pair.contacts(poses)
    assert c.starts.tolist() == [0, 4, 4, 8]
    assert np.allclose(c.distance, [-0.25] * 4 + [0] * 4)
    assert len(np.unique(c.id[:4])) == 4
    assert np.diff(pair.contacts(poses, margin=2.5).starts).min() == 4
    many = pirouette.Pair(pirouette.Polytope.shape("prism?sides=40"), pirouette.Polytope.shape("prism?sides=40"))
    bounds = many.p.bounds
    stacked = [0, 0, 0, 1, 0, 0, bounds[1, 2] - bounds[0, 2]]
    assert len(many.contacts(stacked).distance) >= 40


def test_time_of_impact():
    pair = pirouette.Pair(CORNERS, CORNERS)
    hit = pair.time_of_impact([0, 0, 0, 1, 5, 0, 0], [0, 0, 0, 1, -5, 0, 0], tolerance=1e-9)
    assert hit.outcome == "hit" and abs(hit.time - 0.4) < 1e-8
    assert pair.time_of_impact([0, 0, 0, 1, 5, 0, 9], [0, 0, 0, 1, -5, 0, 9]).outcome == "miss"
    half = np.sqrt(0.5)
    spun = pair.time_of_impact([0, 0, 0, 1, 1.2, 0, 0], [0, 0, half, half, 1.2, 0, 0], tolerance=1e-9)
    # a corner is .7 from the middle at 45 degrees: the gap of .2 is closed where cos + sin = 1.4
    assert spun.outcome == "hit" and abs(spun.time - (np.pi / 4 - np.arccos(1.4 / np.sqrt(2))) / (np.pi / 2)) < 1e-6


def test_sums():
    p, q = sphere(20), sphere(30)
    sum_ = pirouette.MinkowskiSum(p, q)
    for angle in np.linspace(0, 1, 5):
        sum_.turned([1, 2, 3], angle)
        again = pirouette.MinkowskiSum(p, q, sum_.rotation)
        assert np.array_equal(sum_.fv, again.fv) and np.array_equal(sum_.vf, again.vf)
        assert np.array_equal(sum_.ee, again.ee)
        mesh = sum_.mesh()
        assert np.array_equal(mesh.vertices, again.mesh().vertices)
        assert len(mesh) == len(mesh.facets.starts) - 1 == len(mesh.kinds)
        poses = hovering(40)
        poses[:, :4] = sum_.rotation
        by_pair = pirouette.Pair(p, q).signed_distance(poses)
        assert np.array_equal(sum_.distances(poses[:, 4:]), by_pair.distance)
        assert np.array_equal(sum_.states(poses[:, 4:]), by_pair.state)
        assert np.array_equal(sum_.depths(poses[:, 4:]), np.where(by_pair.state == 2, -by_pair.distance, 0))


def test_solids():
    step = pirouette.Solid.prism([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], 1)
    cube = pirouette.Solid(pirouette.Polytope(CORNERS))
    pieces = step.decompose()
    assert len(pieces) == 2 and pieces.error == 0
    assert sum(piece.volume for piece in pieces.polytopes()) == step.volume == 3
    mesh = step.minkowski_sum(cube)
    assert np.allclose(mesh.vertices.min(0), [-0.5, -0.5, -0.5]) and np.allclose(mesh.vertices.max(0), [2.5, 2.5, 1.5])
    depths = step.depth(cube, [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 9, 0, 0], [0, 0, 0, 1, -1.5, -1.5, 0]])
    assert depths.state.tolist() == [2, 0, 1] and depths.depth[1] == 0
    moved = np.array([0, 0, 0, 1, *(depths.depth[0] * depths.normal[0])])
    assert step.depth(cube, moved).state in (1, 2) and step.depth(cube, moved).depth < 1e-12


def test_surfaces():
    field = pirouette.HeightField(np.zeros((4, 5)), step=(0.5, 0.25))
    mesh = pirouette.TriMesh([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], [[0, 1, 2], [0, 2, 3]])
    origins = np.random.default_rng(5).uniform(0.1, 0.7, size=(100, 3)) + [0, 0, 1]
    for surface in (field, mesh):
        hits = surface.rays(origins, [0, 0, -4])
        assert hits.hit.all() and np.allclose(hits.point[:, 2], 0) and np.allclose(hits.time, origins[:, 2] / 4)
        assert not surface.rays(origins, [0, 0, 4]).hit.any()
        near = surface.nearest(origins)
        assert np.allclose(near.distance, origins[:, 2])
        assert np.isinf(surface.nearest(origins, cutoff=0.5).distance).all()


def test_active_sets():
    pair = pirouette.Pair(CORNERS, CORNERS)
    out = pair.active_set([0, 0, 0, 1, 0.25, 0.25, 0.5])
    assert np.allclose(out.depth, 0.5) and out.normal.tolist() == [[0, 0, 1]]
    assert len(pair.active_set([0, 0, 0, 1, 0.25, 0.25, 0.25]).depth) == 3
    assert len(pair.active_set([0, 0, 0, 1, 0, 0, 0], slack=1e-9).depth) == 6
    assert len(pair.active_set([0, 0, 0, 1, 0, 0, 2]).depth) == 0
    ball = pirouette.Pair(sphere(200), sphere(200))
    every = ball.active_set([0, 0, 0, 1, 0.1, 0, 0], slack=10)
    assert len(every.depth) > 200 and -ball.signed_distance([0, 0, 0, 1, 0.1, 0, 0]).distance == every.depth.min()


def test_pairs_of_meshes():
    """Two cubes as meshes are as far apart as the polytopes that they bound, where they do not overlap."""
    cube, poses = pirouette.Polytope(CORNERS), hovering(200)
    pair, mesh = pirouette.Pair(cube, cube), pirouette.TriMesh(cube)
    a, b = pirouette.MeshPair(mesh, mesh).nearest(poses), pair.signed_distance(poses)
    assert np.allclose(a.distance, np.maximum(b.distance, 0), atol=1e-12)
    assert np.array_equal(a.state == 1, b.state != 0)
    apart = b.state == 0
    assert np.allclose(np.linalg.norm(a.point_p - a.point_q, axis=1)[apart], a.distance[apart])
    near = pirouette.MeshPair(mesh, mesh).within(poses[0], distance=float(a.distance[0]) + 1e-9)
    assert [int(a.triangle_p[0]), int(a.triangle_q[0])] in near.tolist()
    assert len(pirouette.MeshPair(mesh, mesh).within(poses[0], distance=9)) == 144


def test_scenes_tell_manifolds_again():
    cube = pirouette.Polytope(CORNERS)
    for reuse in (0, 0.01):
        scene = pirouette.Scene(reuse=reuse)
        bodies = [scene.add(cube, pose=[0, 0, 0, 1, 0.75 * i, 0, 0]) for i in range(2)]
        first = scene.update()
        assert first.error.tolist() == [0]
        scene.set_poses([bodies[1]], [[0, 0, 0, 1, 0.752, 0, 0]])
        events = scene.update()
        assert events.kind.tolist() == [pirouette.PERSISTED] and 0 <= events.error[0] <= reuse
        assert (events.error[0] > 0.0019) == (reuse > 0)
        # contacts move with the bodies
        assert np.allclose(events.contact_distance, first.contact_distance + 0.002)
        assert (events.contact_id == first.contact_id).all()
    with pytest.raises(pirouette.InputError):
        pirouette.Scene(reuse=-1)


def test_scenes():
    scene, cube = pirouette.Scene(), pirouette.Polytope(CORNERS)
    bodies = [scene.add(cube, pose=[0, 0, 0, 1, 3 * i, 0, 0]) for i in range(5)]
    floor = scene.add(pirouette.HeightField(np.zeros((2, 2)), step=50), kind="static", pose=[0, 0, 0, 1, -9, -9, -9])
    assert len(scene) == 6 and list(scene) == sorted([*bodies, floor]) and floor in scene
    assert len(scene.update().kind) == 0
    scene.set_poses([bodies[1]], [[0, 0, 0, 1, 0.75, 0, 0]])
    events = scene.update()
    assert events.kind.tolist() == [pirouette.BEGAN] and np.allclose(events.distance, -0.25)
    assert events.starts.tolist() == [0, 4] and np.allclose(events.contact_distance, -0.25)
    state = scene.snapshot()
    scene.set_poses([bodies[1]], [[0, 0, 0, 1, 9.75, 0, 0]])
    assert sorted(scene.update().kind.tolist()) == [pirouette.BEGAN, pirouette.ENDED]
    scene.restore(state)
    assert scene.pose(bodies[1])[4] == 0.75
    hits = scene.rays([[0, 0, 5], [6, 0, 5], [100, 0, 5]], [0, 0, -5])
    assert hits.body[:2].tolist() == [bodies[0], bodies[2]] and hits.hit.tolist() == [True, True, False]
    assert scene.nearest(cube, [0, 0, 0, 1, 12, 2, 0])[0][0] == bodies[4]
    scene.remove(bodies[0])
    with pytest.raises(pirouette.Error, match="body"):
        scene.set_poses([bodies[0]], [[0, 0, 0, 1, 0, 0, 0]])


def test_mass():
    box = pirouette.Polytope(CORNERS * [2, 4, 6] + [1, 1, 1])
    assert box.volume == 48 and box.centroid.tolist() == [1, 1, 1]
    assert np.allclose(np.diag(box.inertia), np.array([16 + 36, 4 + 36, 4 + 16]) * 48 / 12)
    assert len(box.facets.polygons()) == 6 and box.faces.shape == (12, 3) and box.edges.shape == (12, 2)
    corners = box.vertices[box.faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert np.isclose(volume, 48)
