# SPDX-License-Identifier: MIT
"""The calls of python-fcl that trimesh's CollisionManager makes, as its documentation has them."""
import numpy as np
import pytest

import pirouette
import pirouette.fcl as fcl
from bodies import CORNERS, hovering, sphere

CUBE = pirouette.Polytope(CORNERS)


def model(vertices=None, faces=None):
    vertices, faces = (CUBE.vertices, CUBE.faces) if vertices is None else (vertices, faces)
    made = fcl.BVHModel()
    made.beginModel(num_tris_=len(faces), num_vertices_=len(vertices))
    made.addSubModel(verts=vertices, triangles=faces)
    made.endModel()
    return made


def convex():
    faces = np.concatenate((np.full((12, 1), 3), CUBE.faces), axis=1).flatten()
    return fcl.Convex(CUBE.vertices.copy(), 12, faces)


def at(geometry, *translation):
    return fcl.CollisionObject(geometry, fcl.Transform(np.eye(3), np.array(translation, float)))


KINDS = pytest.mark.parametrize("kind", [model, convex, lambda: fcl.Box(1, 1, 1)])


@KINDS
def test_two_bodies(kind):
    a, b = kind(), kind()
    for x, meets, gap in ((3, False, 2), (1, True, 0), (0.75, True, None)):
        result, told = fcl.CollisionResult(), fcl.DistanceResult()
        assert bool(fcl.collide(at(a, 0, 0, 0), at(b, x, 0, 0), fcl.CollisionRequest(), result)) == meets
        assert result.is_collision == meets and result.contacts == []
        found = fcl.distance(at(a, 0, 0, 0), at(b, x, 0, 0), fcl.DistanceRequest(enable_nearest_points=True), told)
        assert found == told.min_distance and (found <= 0 if gap is None else np.isclose(found, gap))
        if gap:
            assert np.isclose(np.linalg.norm(told.nearest_points[0] - told.nearest_points[1]), gap)


@KINDS
def test_contacts(kind):
    a, b = at(kind(), 0, 0, 0), at(kind(), 0.1, 0.2, 0.75)
    data = fcl.CollisionData(request=fcl.CollisionRequest(num_max_contacts=100000, enable_contact=True))
    manager = fcl.DynamicAABBTreeCollisionManager()
    manager.registerObject(b)
    manager.setup()
    manager.collide(a, data, fcl.defaultCollisionCallback)
    assert data.result.is_collision and len(data.result.contacts) >= 4
    for contact in data.result.contacts:
        assert {contact.o1, contact.o2} == {a._geom, b._geom}
        assert np.all(np.abs(contact.pos - [0.05, 0.1, 0.375]) <= [0.451, 0.401, 0.126])
        assert np.isclose(np.linalg.norm(contact.normal), 1)
        assert 0 <= contact.penetration_depth <= 0.9 + 1e-12
    few = fcl.CollisionData(request=fcl.CollisionRequest(num_max_contacts=2, enable_contact=True))
    manager.collide(a, few, fcl.defaultCollisionCallback)
    assert len(few.result.contacts) == 2


def test_convex_bodies_have_depths():
    result = fcl.CollisionResult()
    fcl.collide(at(convex(), 0, 0, 0), at(convex(), 0, 0, 0.75), fcl.CollisionRequest(9, True), result)
    assert {round(c.penetration_depth, 12) for c in result.contacts} == {0.25}
    # from the first to the second
    assert all(np.allclose(c.normal, [0, 0, 1]) for c in result.contacts)
    assert np.isclose(fcl.distance(at(convex(), 0, 0, 0), at(convex(), 0, 0, 0.75)), -0.25)


def test_a_body_inside_a_closed_mesh_collides():
    result = fcl.CollisionResult()
    small = model(CUBE.vertices / 4, CUBE.faces)
    assert fcl.collide(at(model(), 0, 0, 0), at(small, 0.1, 0, 0), fcl.CollisionRequest(9, True), result) == 1
    assert np.isclose(result.contacts[0].penetration_depth, 0.275)


def test_managers_ask_as_loops_do():
    random = np.random.default_rng(8)
    geometries = [model(), convex(), model(sphere(20).vertices, sphere(20).faces)]
    one = [fcl.CollisionObject(geometries[i % 3], fcl.Transform(*poses)) for i, poses in enumerate(
        zip(random.normal(size=(12, 4)), random.uniform(-2, 2, size=(12, 3))))]
    two = [fcl.CollisionObject(geometries[i % 3], fcl.Transform(*poses)) for i, poses in enumerate(
        zip(random.normal(size=(9, 4)), random.uniform(1, 5, size=(9, 3))))]
    managers = []
    for objects in (one, two):
        managers.append(fcl.DynamicAABBTreeCollisionManager())
        managers[-1].registerObjects(objects)
        managers[-1].setup()
    cases = [((), [(a, b) for i, a in enumerate(one) for b in one[i + 1:]]), ((managers[1],), [
        (a, b) for a in one for b in two])] + [((b,), [(a, b) for a in one]) for b in two]
    for asked, pairs in cases:
        data, told = fcl.CollisionData(), fcl.DistanceData()
        managers[0].collide(*asked, data, fcl.defaultCollisionCallback)
        managers[0].distance(*asked, told, fcl.defaultDistanceCallback)
        meets = [bool(fcl.collide(a, b)) for a, b in pairs]
        assert data.result.is_collision == any(meets)
        gaps = [fcl.distance(a, b) for a, b in pairs]
        assert np.isclose(told.result.min_distance, min(gaps)) or (min(gaps) <= 0 and told.result.min_distance <= 0)
        every = fcl.CollisionData(fcl.CollisionRequest(num_max_contacts=100000, enable_contact=True))
        managers[0].collide(*asked, every, fcl.defaultCollisionCallback)
        known = {frozenset((id(c.o1), id(c.o2))) for c in every.result.contacts}
        assert known == {frozenset((id(a._geom), id(b._geom))) for (a, b), meet in zip(pairs, meets) if meet}


def test_bodies_that_move_and_leave():
    manager = fcl.DynamicAABBTreeCollisionManager()
    a, b = at(convex(), 0, 0, 0), at(model(), 3, 0, 0)
    manager.registerObjects([a, b])
    assert manager.size() == 2

    def meets():
        data = fcl.CollisionData()
        manager.collide(data, fcl.defaultCollisionCallback)
        return data.result.is_collision

    assert not meets()
    b.setTranslation([0.9, 0, 0])
    manager.update(b)
    assert meets()
    b.setTransform(fcl.Transform([0.9, 0.9, 0.9]))
    b.setRotation(np.eye(3))
    assert meets()
    manager.unregisterObject(b)
    assert not meets() and not manager.empty()


def test_transforms():
    pose = hovering(30)[17]
    turned = fcl.Transform(np.roll(pose[:4], 1), pose[4:])
    again = fcl.Transform(turned.getRotation(), turned.getTranslation())
    assert np.allclose(again.getRotation(), turned.getRotation()) and np.allclose(turned.getQuatRotation()[0], pose[3])
    with pytest.raises(pirouette.InputError, match="rotation"):
        turned.setRotation(np.zeros(5))
    with pytest.raises(pirouette.InputError, match="geom"):
        fcl.CollisionObject(fcl.BVHModel())
