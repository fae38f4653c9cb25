# SPDX-License-Identifier: MIT
"""Turns, second derivatives, contacts of solids, plans, shapes, and scenes whose bodies change."""
import copy
import json
import pickle
import xml.etree.ElementTree
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pirouette
from bodies import CORNERS, SEED, hovering, sphere
from test_answers import multiplied

STEP = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]


def facets_of(sum_):
    """The facets of the true sum by the vertices of their planes, as a set."""
    mesh = sum_.mesh()
    return len(mesh), sorted(mesh.kinds.tolist())


def test_events_of_a_turn_change_the_facets_that_they_tell():
    p, q, axis = sphere(12), sphere(14, 5), [1, 2, -1]
    sum_ = pirouette.MinkowskiSum(p, q)
    events = sum_.events(axis)
    found, angles, facets = 0, [], len(sum_.mesh())
    for event in events:
        found += 1
        facets += len(event.gained) - len(event.lost)
        assert event.kappa[0] <= event.kappa[1] and event.angle[1] - event.angle[0] < 1e-11
        angles.append(event.angle[0])
        if event.after is not None:
            sum_.rotate(event.after)
            assert len(sum_.mesh()) == facets == events.facet_count()
    assert found > 20 and angles == sorted(angles)
    first = pirouette.MinkowskiSum(p, q).next_event(axis)
    events.seek(np.inf)
    assert next(events).kappa == first.kappa and first.angle[0] == angles[0]
    events.seek(first.kappa[0])
    assert next(events).angle[0] == angles[1]


def test_a_sum_that_stays_has_no_event():
    square = pirouette.Polytope([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    assert pirouette.MinkowskiSum(square, square).next_event([0, 0, 1]) is None
    assert pirouette.MinkowskiSum(CORNERS, CORNERS).next_event([0, 0, 1]).angle[0] == pytest.approx(90)
    with pytest.raises(pirouette.InputError, match="axis"):
        pirouette.MinkowskiSum(CORNERS, CORNERS).next_event([0, 0, 0])


def test_rationals_go_in_and_out():
    third = [[Fraction(1, 3), 0, 0], [0, "2/7", 0], [0, 0, 1.5], [0, 0, 0]]
    body = pirouette.Polytope.from_fractions(third)
    assert sorted(body.exact) == sorted(tuple(map(Fraction, point)) for point in third)
    assert np.allclose(sorted(body.vertices.tolist()), sorted([float(Fraction(x)) for x in point] for point in third))
    sum_ = pirouette.MinkowskiSum(body, body)
    assert set(sum_.mesh(exact=True).exact) == {tuple(2 * x for x in point) for point in body.exact}
    with pytest.raises(pirouette.InputError, match="exact"):
        sum_.mesh().exact
    for wrong in ([[1, 2]], [["x", 0, 0]], [[0, 0, float("nan")]], [["1/0", 0, 0]], [3], 3, [[1, 2, None]]):
        with pytest.raises(pirouette.InputError, match="points"):
            pirouette.Polytope.from_fractions(wrong)
    with pytest.raises(pirouette.InputError):
        pirouette.Polytope.from_fractions([])


def test_penetrations_are_those_of_pairs():
    p, q, poses = sphere(20), sphere(30), hovering(200, reach=1.2)
    turn = [1, 2, 3, 4]
    poses[:, :4] = turn
    sum_, pair = pirouette.MinkowskiSum(p, q, turn), pirouette.Pair(p, q).signed_distance(poses)
    found = sum_.penetrations(poses[:, 4:])
    inside = pair.state == pirouette.INSIDE
    assert inside.sum() > 20 and np.array_equal(found.state, pair.state)
    assert np.allclose(found.depth, np.maximum(-pair.distance, 0), atol=1e-12)
    assert np.allclose(found.normal[inside], pair.normal[inside], atol=1e-9)
    # a cone about a normal answers with the depth there, without it with more
    at = int(np.argmin(pair.distance))
    sum_.set_region(found.normal[at], 0.2)
    assert sum_.penetrations(poses[at, 4:]).depth == pytest.approx(found.depth[at])
    assert len(sum_.ee) < len(pirouette.MinkowskiSum(p, q, turn).ee)
    other = copy.copy(sum_)
    other.set_region(-found.normal[at], 0.2)
    assert other.penetrations(poses[at, 4:]).depth > found.depth[at]
    with pytest.raises(pirouette.Error) as told:
        sum_.distances(poses[:, 4:])
    assert told.value.status == "REGION"
    sum_.clear_region()
    assert np.array_equal(sum_.penetrations(poses[:, 4:]).depth, found.depth)
    assert sum_.statistics()["rebuilds"] >= 0
    with pytest.raises(pirouette.InputError, match="axis"):
        sum_.set_region([0, 0, 0], 1)


def test_a_live_mesh_is_the_mesh():
    sum_ = pirouette.MinkowskiSum(sphere(12), sphere(15, 3))
    live = sum_.live()
    for i in range(20):
        sum_.rotate([0.02 * i, 0.01 * i, 0, 1])
        live.refresh()
        a, b, c = live.vertices[live.facets.triangles()].swapaxes(0, 1)
        mesh = sum_.mesh()
        d, e, f = mesh.vertices[mesh.faces].swapaxes(0, 1)
        assert np.isclose((a * np.cross(b, c)).sum(), (d * np.cross(e, f)).sum())
    assert set(live.rewritten.tolist()) <= set(range(live.slots)) and "LiveMesh" in repr(live)
    sum_.close()
    with pytest.raises(pirouette.InputError, match="closed"):
        live.refresh()


def test_a_notebook_shows_a_picture_of_a_sum():
    for p, q in ((sphere(12), CORNERS), (CORNERS, [[0, 0, 0], [1, 0, 0], [0, 1, 0]]),
                 ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]), (CORNERS * 1e-200, CORNERS)):
        sum_ = pirouette.MinkowskiSum(p, q, [1, 2, 3, 4])
        root = xml.etree.ElementTree.fromstring(sum_._repr_html_())
        mesh, found = sum_.mesh(), root.findall(".//{*}polygon")
        assert root.find("{*}title").text == repr(sum_) and 1 <= len(found) <= len(mesh)
        for polygon in found:
            points = np.array([point.split(",") for point in polygon.get("points").split()], float)
            assert points.min() >= 11.9 and points.max() <= 348.1
    assert len(found) < len(mesh)


def moved(poses, axis, by):
    """Poses after a small motion along one of the six numbers (v, w)."""
    made = poses.copy()
    if axis < 3:
        made[:, 4 + axis] += by
    else:
        turn = np.zeros(4)
        turn[axis - 3], turn[3] = np.sin(by / 2), np.cos(by / 2)
        made[:, :4] = multiplied(turn, poses[:, :4])
    return made


def test_hessians_are_those_of_differences():
    pair, poses = pirouette.Pair(sphere(20), sphere(30)), hovering(120)
    answers = pair.signed_distance(poses, gradient=True, hessian=True)
    assert answers.hessian.shape == (120, 12, 12) and answers.turning.shape == (120, 3, 12)
    assert np.array_equal(answers.hessian, np.swapaxes(answers.hessian, 1, 2), equal_nan=True)
    h = 1e-6
    for axis in range(6):
        more, less = (pair.signed_distance(moved(poses, axis, by), gradient=True) for by in (h, -h))
        normals = (more.normal - less.normal) / (2 * h)
        assert np.nanmedian(np.abs(normals - answers.turning[:, :, axis])) < 1e-7
        slopes = (more.gradient - less.gradient) / (2 * h)
        if axis < 3:
            assert np.nanmedian(np.abs(slopes[:, :3] - answers.hessian[:, axis, :3])) < 1e-7
    one = pair.signed_distance(poses[3], hessian=True)
    assert np.array_equal(one.hessian, answers.hessian[3], equal_nan=True) and one.hessian.shape == (12, 12)
    poses[5] = np.nan
    bad = pair.signed_distance(poses, hessian=True, bad="nan")
    assert np.isnan(bad.hessian[5]).all() and np.array_equal(bad.hessian[6], answers.hessian[6], equal_nan=True)


def test_gradients_of_a_tie():
    tie = pirouette.Pair(CORNERS, CORNERS).active_gradients([0, 0, 0, 1, 0, 0, 0.75])
    assert set(tie.facet.tolist()) == {0} and len(tie.facet) == 4 and (tie.distance == -0.25).all()
    assert (tie.gradient[:, :3] == [0, 0, 1]).all() and np.array_equal(tie.gradient[:, :3], -tie.gradient[:, 6:9])
    # a small turn changes the depth by the least over the corners
    pair, pose = pirouette.Pair(CORNERS, CORNERS), moved(np.array([[0, 0, 0, 1, 0, 0, 0.75]]), 3, 1e-6)
    change = float(pair.signed_distance(pose[0]).distance) + 0.25
    assert change == pytest.approx(1e-6 * tie.gradient[:, 3].min(), rel=1e-4)


def test_contacts_of_solids():
    step, cube = pirouette.Solid.prism(STEP, 1.0), pirouette.Solid(pirouette.Polytope(CORNERS))
    poses = np.tile([0.0, 0, 0, 1, 0, 0, 0], (300, 1))
    poses[:, 4:6], poses[:, 6] = [1, 0.5], np.linspace(1.6, 1.4, 300)
    found = cube.contacts(step, poses, margin=0.05)
    counts = np.diff(found.starts)
    assert (counts[poses[:, 6] > 1.551] == 0).all() and (counts[poses[:, 6] < 1.549] == 4).all()
    # above the seam between pieces of the step there is no contact along another normal
    assert np.allclose(found.normal, [0, 0, 1])
    assert np.allclose(found.distance, np.repeat(poses[:, 6], counts) - 1.5)
    assert np.allclose(found.point_p - found.point_q, found.normal * found.distance[:, None])
    pair = pirouette.SolidPair(cube, step)
    again = pair.contacts(poses, margin=0.05)
    assert np.array_equal(again.id, found.id) and len(again.starts) == 301
    with pytest.raises(pirouette.InputError, match=r"poses_p.*\[1\]"):
        pair.contacts([[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0]])
    assert pair.contacts(np.empty((0, 7))).starts.tolist() == [0]


def test_plans(tmp_path):
    def slab(x, y, z, at):
        return pirouette.Polytope.shape(f"box?x={x}&y={y}&z={z}").moved(at)

    wall = [slab(1, 4, 1.5, (0, 0, 1.25)), slab(1, 4, 1.5, (0, 0, -1.25)), slab(1, 1, 4, (0, 1.5, 0)),
            slab(1, 1, 4, (0, -1.5, 0))]  # a window 2 wide and 1 high
    box, bounds = pirouette.Polytope(CORNERS), [[-3, -1, -1], [3, 1, 1]]
    ends = [-2, 0.5, 0.25], [2, -0.5, 0]
    shut = pirouette.plan(box, wall, *ends, bounds=bounds)
    assert not shut and len(shut.points) == 0 and shut.components == 2 and repr(shut) == "<Plan: no path>"
    for robot, opened in ((box, True), (box.scaled(0.75), False)):
        way = pirouette.plan(robot, wall, *ends, bounds=bounds, open=opened)
        assert way and np.array_equal(way.points[[0, -1]], ends) and way.bounds.tolist() == bounds
        dense = np.concatenate([np.linspace(a, b, 50) for a, b in zip(way.points[:-1], way.points[1:])])
        poses = np.hstack([np.tile([0.0, 0, 0, 1], (len(dense), 1)), dense])
        least = min(pirouette.Pair(robot, part).signed_distance(poses).distance.min() for part in wall)
        assert least > -1e-9
    way.write(tmp_path / "plan.json")
    assert json.loads((tmp_path / "plan.json").read_text())
    for wrong, match in (({"start": [0, 0, 9]}, "."), ({"goal": [2, 0]}, "goal"), ({"bounds": [[1, 1, 1]]}, "bounds"),
                         ({"robot": 3}, "robot"), ({"rotation": [0, 0, 0, 0]}, ".")):
        asked = {"robot": box, "obstacles": wall, "start": ends[0], "goal": ends[1], "bounds": bounds, **wrong}
        with pytest.raises(pirouette.InputError, match=match):
            pirouette.plan(**asked)
    with pytest.raises(pirouette.FileError):
        way.write(tmp_path / "no" / "plan.json")


def test_solids_meshes_and_shapes_are_pickled(tmp_path):
    step = pirouette.Solid.prism(STEP, 0.1)
    path = tmp_path / "step.off"
    step.minkowski_sum(pirouette.Solid(pirouette.Polytope(CORNERS)), exact=True).write(path, exact=True)
    for solid in (step, pirouette.Solid(pirouette.Polytope(CORNERS).moved([0.1, 0, 0], [1, 2, 3, 4])),
                  pirouette.Solid.read(path)):
        again = pickle.loads(pickle.dumps(solid))
        assert repr(again) == repr(solid) and again.volume == solid.volume
        assert np.array_equal(again.bounds, solid.bounds)
    ball = sphere(30)
    mesh = pirouette.TriMesh(ball.vertices, ball.faces, two_sided=True)
    again = pickle.loads(pickle.dumps(mesh))
    assert np.array_equal(again.triangles, mesh.triangles) and again.two_sided and again.closed == mesh.closed
    shapes = [pirouette.Shape.ball(2), pirouette.Shape.capsule([0, 0, 0], [1, 0, 0], 0.5),
              pirouette.Shape.box([1, 2, 3], 0.25), pirouette.Shape.cylinder(1, 2), pirouette.Shape.cone(1, 2, 8),
              pirouette.Shape.plane([0, 0, 1]), pirouette.Shape.hull(CORNERS, 0.1), pirouette.Shape.mesh(mesh)]
    shapes.append(pirouette.Shape.compound([(shapes[3], [0, 0, 0, 1, 0, 0, 1]), (shapes[4], [0, 0, 0, 1, 0, 0, 0])]))
    for shape in shapes:
        assert repr(pickle.loads(pickle.dumps(shape))) == repr(shape)


def test_shapes_fall_as_they_are_named():
    assert pirouette.Shape.ball(0.5).mass.volume == pytest.approx(np.pi / 6)
    scene = pirouette.Scene()
    scene.add(pirouette.Shape.plane([0, 0, 1]), kind="static")
    ball = scene.add(pirouette.Shape.ball(0.5), pose=[0, 0, 0, 1, 0, 0, 0.25], user=7)
    events = scene.update()
    assert events.distance.tolist() == [-0.25] and 7 in (events.user_p[0], events.user_q[0])
    state = scene.state(ball)
    assert (state.radius, state.user, state.kind, state.pieces) == (0.5, 7, "moving", 1)
    with pytest.raises(pirouette.InputError, match="Shape.ball"):
        pirouette.Shape()
    with pytest.raises(pirouette.InputError, match="radius"):
        pirouette.Shape.ball(-1)
    with pytest.raises(pirouette.InputError, match=r"parts\[0\]"):
        pirouette.Shape.compound([(3, [0, 0, 0, 1, 0, 0, 0])])


def test_bodies_of_a_scene_change():
    scene, cube = pirouette.Scene(), pirouette.Polytope(CORNERS)
    a, b = scene.add(cube), scene.add(cube, pose=[0, 0, 0, 1, 0, 0, 0.5])
    assert scene.update().kind.tolist() == [pirouette.BEGAN]
    scene.disable(a)
    assert scene.update().kind.tolist() == [pirouette.ENDED] and scene.state(a).disabled
    assert not scene.rays([0, 0, -9], [0, 0, 9]).hit or scene.rays([0, 0, -9], [0, 0, 9]).body == b
    scene.enable(a)
    assert scene.update().kind.tolist() == [pirouette.BEGAN]
    scene.set_filter(a, 2, 2)
    assert scene.update().kind.tolist() == [pirouette.ENDED] and scene.state(a)[4:6] == (2, 2)
    scene.set_filter(a, 1, 1)
    scene.set_sensor(a)
    events = scene.update()
    assert events.sensor.tolist() == [True] and len(events.contact_distance) == 0
    scene.set_user(a, 2**63)
    scene.remove(b)
    assert scene.update().kind.tolist() == [pirouette.ENDED] and list(scene) == [a] and b not in scene
    again = scene.add(cube)
    assert again != b and len(scene) == 2 and scene.state(a).user == 2**63
    rest = [[0, 0, 0, 1, 0, 0, 0]]
    for call in (lambda: scene.disable(b), lambda: scene.pose(b), lambda: scene.set_poses([b], rest)):
        with pytest.raises(pirouette.InputError, match="bod"):
            call()


def test_questions_to_a_scene_leave_bodies_out():
    scene, cube = pirouette.Scene(), pirouette.Polytope(CORNERS)
    bodies = [scene.add(cube, pose=[0, 0, 0, 1, 2 * i, 0, 0], category=1 << i) for i in range(4)]
    hits = scene.rays([-5, 0, 0], [20, 0, 0], ignored=bodies[:2])
    assert hits.body == bodies[2] and hits.time == pytest.approx(8.5 / 20)
    assert scene.rays([-5, 0, 0], [20, 0, 0], mask=8).body == bodies[3]
    ball = scene.rays([[-5, 0.7, 0], [-5, 0.8, 0]], [20, 0, 0], radius=0.25)
    assert ball.hit.tolist() == [True, False]
    assert ball.time[0] * 20 == pytest.approx(4.5 - np.sqrt(0.25**2 - 0.2**2))
    at, impact = scene.cast(cube, [0, 0, 0, 1, -5, 0, 0], [0, 0, 0, 1, 15, 0, 0], ignored=bodies[:1])
    assert at == bodies[1] and impact.outcome == "hit" and impact.time == pytest.approx(6 / 20, abs=1e-6)
    assert scene.cast(cube, [0, 0, 0, 1, -5, 3, 0], [0, 0, 0, 1, 15, 3, 0])[0] == -1
    hits = scene.cast_all(cube, [0, 0, 0, 1, -5, 0, 0], [0, 0, 0, 1, 15, 0, 0], ignored=bodies[2:3])
    assert hits.body.tolist() == [bodies[0], bodies[1], bodies[3]]
    assert hits.time * 20 == pytest.approx([4, 6, 10], abs=1e-5) and hits.hit.all()
    ids, pieces = scene.in_box([1, -np.inf, 0], [4, np.inf, 0], mask=7)
    assert ids.tolist() == bodies[1:3] and pieces.tolist() == [0, 0]
    with pytest.raises(pirouette.InputError, match="the low corner is at 4, the high one at 1"):
        scene.in_box([4, 0, 0], [1, 0, 0])
    ids, pieces = scene.overlaps(pirouette.Polytope.shape("box?x=9&y=1&z=1"), ignored=[bodies[1]])
    assert ids.tolist() == [bodies[0], bodies[2]] and pieces.tolist() == [0, 0]
    assert scene.nearest(cube, ignored=bodies[:1], most=9)[0][0] == bodies[1]
    with pytest.raises(pirouette.InputError, match=r"\[1\]"):
        scene.rays([[0, 0, 0], [0, np.nan, 0]], [1, 0, 0])
    with pytest.raises(pirouette.InputError, match="ignored"):
        scene.rays([0, 0, 0], [1, 0, 0], ignored=[0.5])


def test_fast_bodies_pass_nothing():
    scene = pirouette.Scene()
    wall = scene.add(pirouette.Polytope.shape("box?x=0.01&y=9&z=9"), kind="static")
    bullet = scene.add(pirouette.Shape.ball(0.1), pose=[0, 0, 0, 1, -5, 0, 0], fast=1e-6)
    scene.update()
    scene.set_poses([bullet], [[0, 0, 0, 1, 5, 0, 0]])
    assert len(scene.update().kind) == 0
    met = scene.impacts()
    assert met.body.tolist() == [bullet] and met.met.tolist() == [wall]
    assert met.time[0] == pytest.approx((5 - 0.105) / 10, abs=1e-6)


def test_snapshots_bring_bodies_back():
    scene, cube = pirouette.Scene(), pirouette.Polytope(CORNERS)
    bodies = [scene.add(cube, pose=[0, 0, 0, 1, 0.9 * i, 0, 0]) for i in range(5)]
    scene.update()
    data = scene.snapshot()
    scene.remove(bodies[1])
    extra = scene.add(cube)
    scene.set_poses([bodies[0]], [[0, 0, 0, 1, 50, 0, 0]])
    scene.update()
    scene.restore(data)
    assert list(scene) == bodies and extra not in scene and scene.snapshot() == data
    scene.set_poses([bodies[0]], [[0, 0, 0, 1, 0, 0, 0]])
    assert scene.update().kind.tolist() == [pirouette.PERSISTED]
    other = pirouette.Scene()
    with pytest.raises(pirouette.InputError):
        other.restore(data)
    other.keep(cube)
    other.restore(data)
    assert list(other) == bodies and other.snapshot() == data
    with pytest.raises(pirouette.Error, match="data"):
        other.restore(data[:40])


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(["add", "remove", "disable", "enable", "move", "update", "filter", "sensor"]),
                          st.integers(0, 5), st.integers(0, 3)), max_size=25))
def test_a_scene_bears_any_order_of_changes(steps):
    scene, cube = pirouette.Scene(), pirouette.Polytope(CORNERS)
    ids, gone = [], []
    for step, which, value in steps:
        body = ids[which % len(ids)] if ids else 0
        if step == "add":
            ids.append(scene.add(cube, pose=[0, 0, 0, 1, 0.6 * value, 0, 0]))
        elif step == "update":
            scene.update()
        elif not ids:
            with pytest.raises(pirouette.InputError):
                scene.disable(body)
        elif step == "remove":
            scene.remove(body)
            ids.remove(body)
            gone.append(body)
        elif step == "move":
            scene.set_poses([body], [[0, 0, 0, 1, value, 0, 0]])
        elif step == "filter":
            scene.set_filter(body, value, 3)
        elif step == "sensor":
            scene.set_sensor(body, value > 1)
        else:
            getattr(scene, step)(body)
    scene.update()
    assert sorted(scene) == sorted(ids) and len(scene) == len(ids) and not any(body in scene for body in gone)
