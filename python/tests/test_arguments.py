# SPDX-License-Identifier: MIT
"""Whatever comes as an argument, nothing crashes, and a message names the argument."""
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from hypothesis.extra import numpy as arrays

import pirouette
from bodies import CORNERS, hovering, sphere

PAIR = pirouette.Pair(CORNERS, CORNERS)
DTYPES = st.one_of(arrays.floating_dtypes(), arrays.integer_dtypes(), arrays.unsigned_integer_dtypes(),
                   arrays.boolean_dtypes(), arrays.complex_number_dtypes(), arrays.datetime64_dtypes(),
                   arrays.unicode_string_dtypes(max_len=3), st.just(np.dtype(object)))
SHAPES = st.one_of(arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=8),
                   st.sampled_from([(7,), (3, 7), (0, 7), (4, 4), (2, 4, 4), (8, 3), (0, 3), (3,)]))
ODD = st.one_of(DTYPES.flatmap(lambda d: arrays.arrays(d, SHAPES, **({"elements": st.integers(-3, 3)} if d == object
                                                                      else {}))),
                st.none(), st.text(), st.lists(st.one_of(st.floats(), st.lists(st.floats()), st.text())),
                st.dictionaries(st.text(), st.integers()))
FAST = settings(max_examples=100, database=None, deadline=None, suppress_health_check=list(HealthCheck))


def survives(name, call):
    """A call gives something, or raises an error of the package that names the argument."""
    try:
        call()
    except pirouette.Error as wrong:
        assert name in str(wrong), str(wrong)


@FAST
@given(ODD)
def test_odd_arrays(value):
    survives("points", lambda: pirouette.Polytope(value))
    survives("p", lambda: pirouette.Pair(value, CORNERS))
    survives("poses_p", lambda: PAIR.signed_distance(value))
    if value is not None:
        survives("poses_q", lambda: PAIR.signed_distance(hovering(3), value))
    survives("poses_p", lambda: PAIR.contacts(value))
    survives("rotation", lambda: pirouette.MinkowskiSum(CORNERS, CORNERS, value))
    survives("translations", lambda: pirouette.MinkowskiSum(CORNERS, CORNERS).depths(value))
    survives("vertices", lambda: pirouette.TriMesh(value, [[0, 1, 2]]))
    survives("faces", lambda: pirouette.TriMesh(CORNERS, value))
    survives("heights", lambda: pirouette.HeightField(value))
    survives("faces", lambda: pirouette.Solid(CORNERS, value))


@FAST
@given(ODD, st.sampled_from(["cutoff", "radius_p", "radius_q", "margin"]))
def test_odd_numbers(value, name):
    call = PAIR.contacts if name == "margin" else PAIR.signed_distance
    survives(name.split("_")[0], lambda: call(hovering(3), **{name: value}))


@FAST
@given(ODD)
def test_odd_scenes(value):
    scene = pirouette.Scene()
    body = scene.add(CORNERS)
    survives("body", lambda: scene.add(value))
    survives("pose", lambda: scene.add(CORNERS, pose=value))
    survives("bodies", lambda: scene.set_poses(value, np.zeros((len(np.atleast_1d(np.asarray(0))), 7))))
    survives("new", lambda: scene.set_poses([body], value))
    survives("origins", lambda: scene.rays(value, [0, 0, 1]))
    survives("ways", lambda: scene.rays([0, 0, 1], value))
    survives("data", lambda: scene.restore(value if isinstance(value, bytes) else b"xyz"))
    survives("", scene.update)


@FAST
@given(ODD)
def test_odd_values_of_the_rest(value):
    scene, cube = pirouette.Scene(), pirouette.Polytope(CORNERS)
    body, rest = scene.add(cube), [0, 0, 0, 1, 0, 0, 0]
    survives("axis", lambda: pirouette.MinkowskiSum(CORNERS, CORNERS).next_event(value))
    survives("axis", lambda: pirouette.MinkowskiSum(CORNERS, CORNERS).set_region(value, 1))
    survives("translations", lambda: pirouette.MinkowskiSum(CORNERS, CORNERS).penetrations(value))
    survives("kappa", lambda: pirouette.TurnEvents(CORNERS, CORNERS, [0, 0, 1]).seek(value))
    survives("pose", lambda: PAIR.active_gradients(value))
    survives("slack", lambda: PAIR.active_gradients(rest, slack=value))
    survives("poses_p", lambda: pirouette.Solid(cube).contacts(pirouette.Solid(cube), value))
    survives("", lambda: pirouette.plan(cube, cube, value, [3, 0, 0]))
    survives("", lambda: pirouette.plan(cube, cube, [4, 0, 0], [3, 0, 0], bounds=value, parts=100))
    survives("robot", lambda: pirouette.plan(value, cube, [4, 0, 0], [3, 0, 0]))
    survives("points", lambda: pirouette.Polytope.from_fractions(value))
    survives("radius", lambda: pirouette.Shape.ball(value))
    survives("", lambda: pirouette.Shape.capsule(value, [0, 0, 1], 1))
    survives("points", lambda: pirouette.Shape.hull(value))
    survives("parts", lambda: pirouette.Shape.compound([(pirouette.Shape.ball(1), value)]))
    survives("parts", lambda: pirouette.Shape.compound(value))
    survives("half", lambda: pirouette.Shape.box(value))
    survives("normal", lambda: pirouette.Shape.plane(value))
    survives("ignored", lambda: scene.rays([0, 0, 0], [0, 0, 1], ignored=value))
    survives("radius", lambda: scene.rays([0, 0, 0], [0, 0, 1], radius=value))
    survives("", lambda: scene.cast(cube, rest, value))
    survives("", lambda: scene.overlaps(cube, value))
    survives("", lambda: scene.cast_all(cube, rest, value))
    survives("", lambda: scene.in_box(value, [9, 9, 9]))
    survives("category", lambda: scene.set_filter(body, value, 1))
    survives("body", lambda: scene.disable(value))
    survives("user", lambda: scene.set_user(body, value))
    survives("", scene.update)


@FAST
@given(st.integers(1, 5), st.booleans(), st.booleans(), st.sampled_from(["f8", "f4", ">f8", "i8", "f2", "longdouble"]))
def test_layouts_give_the_same_answers(step, fortran, backwards, kind):
    poses = np.round(hovering(60) * 4).astype(kind)
    poses[~poses[:, :4].any(axis=1), 3] = 1
    plain = np.ascontiguousarray(poses, dtype=np.float64)[::step]
    given_ = np.asfortranarray(poses) if fortran else poses
    given_ = given_[::step]
    if backwards:
        given_, plain = given_[::-1], plain[::-1]
    assert np.array_equal(PAIR.signed_distance(given_).distance, PAIR.signed_distance(plain.copy()).distance)


def test_what_is_float64_in_order_is_not_copied():
    from pirouette._arrays import floats
    poses = hovering(4)
    assert floats("poses", poses) is poses or np.shares_memory(floats("poses", poses), poses)


@pytest.mark.parametrize("value, status", [(np.nan, "NOT_FINITE"), (np.inf, "NOT_FINITE"), (1e300, "LIMIT")])
def test_a_bad_pose_is_told_and_the_others_answered(value, status):
    poses = hovering(40)
    right = PAIR.signed_distance(poses)
    poses[17, 5] = value
    with pytest.raises(pirouette.InputError, match=r"poses_p\[17\]") as caught:
        PAIR.signed_distance(poses)
    assert caught.value.status == status
    a = PAIR.signed_distance(poses, bad="nan", gradient=True)
    others = np.arange(40) != 17
    assert np.isnan(a.distance[17]) and a.state[17] == pirouette.BAD and a.status[17] != 0
    assert np.array_equal(a.distance[others], right.distance[others])
    with pytest.raises(pirouette.InputError, match=r"poses_q\[17\]"):
        PAIR.signed_distance(hovering(40), poses)


def test_zero_quaternions():
    with pytest.raises(ValueError, match="zero quaternion") as caught:
        PAIR.signed_distance([0, 0, 0, 0, 1, 0, 0])
    assert caught.value.status == "ZERO_QUATERNION"


def test_out():
    out = np.empty(10)
    assert PAIR.signed_distance(hovering(10), out=out).distance is out
    for wrong in (np.empty(9), np.empty(10, np.float32), np.empty(20)[::2], [0.0] * 10, np.empty((10, 1))):
        with pytest.raises(ValueError, match="out"):
            PAIR.signed_distance(hovering(10), out=wrong)
    out.flags.writeable = False
    with pytest.raises(ValueError, match="out"):
        PAIR.signed_distance(hovering(10), out=out)


def test_nothing_is_an_answer():
    a = PAIR.signed_distance(np.empty((0, 7)))
    assert a.distance.shape == (0,) and a.normal.shape == (0, 3)
    assert PAIR.contacts([]).starts.tolist() == [0]
    assert pirouette.MinkowskiSum(CORNERS, CORNERS).depths(np.empty((0, 3))).shape == (0,)


def test_errors_are_of_their_kinds(tmp_path):
    with pytest.raises(OSError):
        pirouette.Polytope.read(tmp_path / "missing.off")
    path = tmp_path / "open.off"
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    with pytest.raises(pirouette.NotConvex, match="open.off"):
        pirouette.Polytope.read(path, require_convex=True)
    with pytest.raises(ValueError):
        pirouette.Polytope.read(path, require_convex=True)
    with pytest.raises(pirouette.NotConvex):
        pirouette.Solid(CORNERS, [[0, 1, 2]])
    with pytest.raises(pirouette.InputError, match="no rotation"):
        PAIR.signed_distance(np.diag([1.0, 1, -1, 1]))


def test_bodies_are_what_has_vertices():
    class Mesh:
        vertices = CORNERS.tolist()
        faces = np.array([[0, 1, 2]])
    assert len(pirouette.Pair(Mesh(), sphere(9)).p) == 8
    assert len(pirouette.TriMesh(Mesh())) == 1
