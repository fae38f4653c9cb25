# SPDX-License-Identifier: MIT
"""First contacts, sweeps and critical maps against states at single poses, and what geometry says of them."""
import numpy as np
import pytest

import pirouette
from bodies import CORNERS, sphere

AT_REST = [0.0, 0, 0, 1, 0, 0, 0]


def screwed(angle, end, axis, way):
    """Where a screw is that ends at an angle, in radians, about an axis of length 1 through the origin."""
    part = np.tan(angle / 2) / np.tan(end / 2)
    return np.concatenate([np.sin(angle / 2) * np.array(axis), [np.cos(angle / 2)], part * np.array(way)])


@pytest.mark.parametrize("way", [[0, 0, 0], [0, 0, -4], [-2, 1, -3]])
def test_states_before_and_behind_a_first_contact(way):
    p, q = pirouette.Polytope(sphere(14).vertices + [2, 0, 0]), sphere(18)
    pair, axis, degrees, hits = pirouette.Pair(p, q), [0, 0.6, 0.8], 120.0, 0
    for x in np.linspace(-3, 3, 13):
        stands = [0, 0, 0, 1, x, 2, -1]
        hit = pair.first_contact(AT_REST, stands, axis=axis, degrees=degrees, way=way)
        start = pair.states(AT_REST, stands)
        assert (hit.outcome == "inside") == (start == pirouette.INSIDE)
        if start != pirouette.OUTSIDE:
            continue
        end = np.radians(hit.degrees if hit.outcome == "hit" else degrees)
        path = np.array([screwed(a, np.radians(degrees), axis, way) for a in np.linspace(0, end * (1 - 1e-9), 60)])
        assert (pair.states(path, np.array([stands] * 60)) == pirouette.OUTSIDE).all()
        if hit.outcome == "hit":
            hits += 1
            touch = pair.signed_distance(screwed(end, np.radians(degrees), axis, way), stands)
            assert abs(touch.distance) < 1e-8 and np.allclose(touch.normal, hit.normal, atol=1e-6)
            assert hit.kappa[0] <= 1 / np.tan(end / 2) + 1e-9 and hit.time == pytest.approx(hit.degrees / degrees)
        else:
            assert hit.outcome == "miss" and hit.time == 1
    assert hits > 2


def test_solids_and_scenes_have_the_contacts_of_their_pieces():
    cube, peg = pirouette.Polytope.shape("cube"), [0, 0, 0, 1, 0, 0, 3]
    screw = {"axis": [0, 0, 1], "degrees": 90, "way": [0, 0, -1.5]}
    of_pair = pirouette.Pair(cube, cube).first_contact(peg, axis=[0, 0, 1], degrees=90, way=[0, 0, -3])
    assert of_pair.outcome == "hit" and of_pair.normal.tolist() == [0, 0, 1]
    assert of_pair.degrees == pytest.approx(np.degrees(2 * np.arctan(2 / 3)))
    block = pirouette.Solid.prism([[-1, -1], [1, -1], [1, 1], [-1, 1]], 1)
    of_solid = pirouette.SolidPair(block, block).first_contact([0, 0, 0, 1, 0, 0, 2], **screw)
    assert of_solid.kappa[0] <= 1.5 <= of_solid.kappa[1] and of_solid.outcome == "hit"
    scene = pirouette.Scene()
    floor, tool = scene.add(cube, kind="static"), scene.add(cube, peg)
    other, contact = scene.first_contact(tool, axis=[0, 0, 1], degrees=90, way=[0, 0, -3])
    assert other == floor and contact.kappa == of_pair.kappa and contact.time == of_pair.time
    assert scene.first_contact(tool, way=[0, 0, 1])[0] == -1
    assert pirouette.Pair(cube, cube).first_contact(peg, way=[0, 0, -4]).time == pytest.approx(0.5)


def test_sweeps_are_free_or_meet():
    pair, half = pirouette.Pair(CORNERS, CORNERS), np.sqrt(0.5)
    over = pair.sweep([0, 0, 0, 1, -3, 0, 1.5], [0, 0, half, half, 3, 0, 1.5])
    assert over == ("free", 1, 1)
    through = pair.sweep([0, 0, 0, 1, -3, 0, 0], [0, 0, 0, 1, 3, 0, 0])
    assert through.outcome == "meets" and through.start <= 1 / 3 <= through.end < 1 / 3 + 1e-6
    away = pair.sweep([0, 0, 0, 1, -3, 0, 0], [0, 0, 0, 1, 3, 0, 0], AT_REST, [0, 0, 0, 1, 6, 9, 0])
    assert away.outcome == "free"
    block = pirouette.Solid.prism([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], 1)
    solids = pirouette.SolidPair(block, block)
    assert solids.sweep([0, 0, 0, 1, 1.25, 1.25, 0], [0, 0, 0, 1, 1.25, 1.25, 5]).outcome == "free"
    assert solids.sweep([0, 0, 0, 1, 1.25, 1.25, 0], [0, 0, 0, 1, 0, 0, 0]).outcome == "meets"


def test_screws_go_as_bolts_do():
    block = pirouette.Solid.prism([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], 1)
    for both in pirouette.Pair(CORNERS, CORNERS), pirouette.SolidPair(block, block):
        down = dict(axis=[0, 0, 2], degrees=1800, pivot=[0.25, 0.25, 0])
        meets = both.sweep_screw([0, 0, 0, 1, 0, 0, 4], way=[0, 0, -9], **down)
        assert meets.outcome == "meets" and meets.start <= 1 / 3 <= meets.end < 1 / 3 + 1e-9
        assert both.sweep_screw([0, 0, 0, 1, 0, 0, 4], way=[0, 0, -2], **down) == ("free", 1, 1)
        with pytest.raises(pirouette.InputError):
            both.sweep_screw([0, 0, 0, 1, 0, 0, 4], axis=[0, 0, 1], degrees=1e6)


def test_a_map_has_the_state_at_every_angle():
    p, q, axis = sphere(12), pirouette.Polytope.shape("cube"), np.array([0, 0, 1.0])
    made, pair = pirouette.CriticalMap(p, q, axis), pirouette.Pair(p, q)
    random = np.random.default_rng(5)
    kappas, places = random.normal(size=200), random.normal(size=(200, 3))
    turned = np.hstack([np.tile(axis, (200, 1)), kappas[:, None], places])
    assert np.array_equal(made.states(kappas, places), pair.states(turned))
    assert (np.diff(made.events[:, 0]) >= 0).all() and len(made.events) > 10
    changes = 0
    for place in places[:40]:
        contacts, between = made.around(place)
        changes += len(contacts)
        edges = np.concatenate([[0], contacts.mean(axis=1), [360]])
        middle = np.radians((edges[1:] + edges[:-1]) / 4)
        poses = np.hstack([np.sin(middle)[:, None] * axis, np.cos(middle)[:, None], np.tile(place, (len(middle), 1))])
        assert np.array_equal(pair.states(poses), between)
    assert changes > 10


def test_wrong_motions_are_told():
    pair = pirouette.Pair(CORNERS, CORNERS)
    far = [0, 0, 0, 1, 5, 0, 0]
    for motion in ({"degrees": 90}, {"degrees": 180, "axis": [0, 0, 1], "way": [1, 0, 0]}, {"way": [np.nan, 0, 0]},
                   {"way": [1, 0]}, {"degrees": "x"}):
        with pytest.raises(pirouette.InputError):
            pair.first_contact(far, **motion)
    for poses in (([0] * 7, far), ([far, far], far), (far, [0] * 7)):
        with pytest.raises(pirouette.InputError):
            pair.sweep(*poses)
    with pytest.raises(pirouette.InputError):
        pair.sweep(far, AT_REST, budget=-1)
    turn = pirouette.CriticalMap(sphere(8), CORNERS, [0, 0, 1])
    with pytest.raises(pirouette.InputError):
        turn.states([1.0, 2.0], [[0, 0, 0]])
    with pytest.raises(pirouette.InputError):
        turn.state(np.nan, [0, 0, 0])
    with pytest.raises(pirouette.InputError):
        pirouette.CriticalMap(CORNERS, CORNERS, [0, 0, 0])
