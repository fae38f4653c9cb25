# SPDX-License-Identifier: MIT
"""First contacts of turns, ways and screws, exactly; sweeps; and the difference at every angle of a turn."""
from __future__ import annotations

from typing import Any, NamedTuple, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import Bytes, Floats, floats, number, poses, quaternion, vector, vectors, whole
from ._check import Handle, InputError, check
from ._native import ffi, lib
from ._polytopes import Body, Polytope, as_polytope


class FirstContact(NamedTuple):
    """The first contact of a turn, a way or a screw, exactly: `outcome` is ``"hit"``, ``"miss"``, ``"receding"``,
    ``"inside"`` or ``"at rest"``; `time` and `degrees` are rounded down; `kappa` are doubles around the κ of a hit,
    |axis|·cot(angle/2), of a way 1/time. `normal`, from Q to P, and `point` are of the contact, in the world."""

    outcome: str
    time: float
    degrees: float
    kappa: Tuple[float, float]
    normal: Floats
    point: Floats


class Sweep(NamedTuple):
    """Knowledge of a motion, never wrong: `outcome` is ``"free"``, ``"meets"`` or ``"undecided"``. Before `start` the
    bodies share no point. When they meet, they share one at `end`."""

    outcome: str
    start: float
    end: float


OUTCOMES = {
    lib.PIR_CAST_HIT: "hit", lib.PIR_CAST_MISS: "miss", lib.PIR_CAST_RECEDING: "receding",
    lib.PIR_CAST_START_INSIDE: "inside", lib.PIR_CAST_AT_REST: "at rest", lib.PIR_CAST_STEP_LIMIT: "step limit",
}
_SWEEPS = {lib.PIR_SWEEP_FREE: "free", lib.PIR_SWEEP_MEETS: "meets", lib.PIR_SWEEP_UNDECIDED: "undecided"}


def exact_motion(axis: npt.ArrayLike, degrees: float, pivot: npt.ArrayLike, way: npt.ArrayLike) -> Any:
    return ffi.new("pir_exact_motion *", {"axis": vector("axis", axis), "degrees": number("degrees", degrees),
                                          "pivot": vector("pivot", pivot), "way": vector("way", way)})


def input_at(name_p: str, pose_p: npt.ArrayLike, name_q: str, pose_q: npt.ArrayLike) -> Any:
    """A pair at one pose of each."""
    made = ffi.new("pir_pair_input *", lib.pir_pair_input_default())
    for field, name, value in (("pose_p", name_p, pose_p), ("pose_q", name_q, pose_q)):
        array, _ = poses(name, value)
        if len(array) != 1:
            raise InputError(f"{name}: {len(array)} poses, not one")
        setattr(made, field, {"rotation": dict(zip("xyzw", array[0, :4])),
                              "translation": dict(zip("xyz", array[0, 4:]))})
    return made


def first_contact_of(found: Any) -> FirstContact:
    hit = found.impact
    return FirstContact(OUTCOMES[hit.outcome], hit.time, found.degrees, (found.kappa[0], found.kappa[1]),
                        np.array([hit.normal.x, hit.normal.y, hit.normal.z]),
                        np.array([hit.point.x, hit.point.y, hit.point.z]))


def sweep_by(call: Any, first: Any, second: Any, budget: int) -> Sweep:
    """What a call of the library tells of a motion; `call` has all arguments but the last four."""
    found, most = ffi.new("pir_sweep_result *"), whole("budget", budget, 0, 2**32 - 1)
    check(call(first, second, most, found), "poses, motion or budget")
    return Sweep(_SWEEPS[found.outcome], getattr(found, "from"), found.to)


class CriticalMap(Handle):
    """The difference of P and Q at every angle of a full turn of P about an axis, from `rotation` on: where P moved by
    a translation is free, touches or overlaps, exactly, at events too.

    >>> cube = Polytope.shape("cube")
    >>> turn = CriticalMap(cube, cube, axis=[0, 0, 1])
    >>> turn.state(1.0, [1.1, 0, 0]), turn.state(0.25, [1.1, 0, 0]), len(turn.events)
    (0, 2, 3)
    """

    def __init__(self, p: Body, q: Body, axis: npt.ArrayLike, rotation: npt.ArrayLike = (0, 0, 0, 1)) -> None:
        self.p: Polytope = as_polytope("p", p)
        self.q: Polytope = as_polytope("q", q)
        made = ffi.new("pir_critical_map **")
        check(lib.pir_critical_map_create(self.p._pointer, self.q._pointer, quaternion("rotation", rotation),
                                          vector("axis", axis), ffi.NULL, made), "axis or rotation")
        super().__init__(made[0], lib.pir_critical_map_destroy)

    @property
    def events(self) -> Floats:
        """The angles in degrees at which the facets change, (n, 2), rounded outwards."""
        angle = ffi.new("pir_critical_angle *")
        with self._held() as made:
            found = np.empty((lib.pir_critical_map_event_count(made), 2))
            for i in range(len(found)):
                check(lib.pir_critical_map_event(made, i, angle), "events")
                found[i] = angle.degrees[0], angle.degrees[1]
        return found

    def state(self, kappa: float, translation: npt.ArrayLike) -> int:
        """0 free, 1 touching, 2 overlapping: at one κ, |axis|·cot(angle/2), infinity for the start."""
        return int(self.states([kappa], [floats("translation", translation)])[0])

    def states(self, kappas: npt.ArrayLike, translations: npt.ArrayLike) -> Bytes:
        """As `state`, at each of n κ and n translations, (n, 3)."""
        at = floats("kappas", kappas)
        to, _ = vectors("translations", translations, 3)
        if at.shape != (len(to),):
            raise InputError(f"kappas: its shape is {at.shape}, not ({len(to)},), as of the translations")
        found, state = np.empty(len(to), np.uint8), ffi.new("pir_state *")
        with self._held() as made:
            for i, (kappa, place) in enumerate(zip(at, to)):
                check(lib.pir_critical_map_state(made, kappa, dict(zip("xyz", place)), state), f"kappas[{i}]")
                found[i] = state[0]
        return found

    def around(self, translation: npt.ArrayLike) -> Tuple[Floats, Bytes]:
        """All contacts of a translation around the turn: their angles in degrees, (n, 2), rounded outwards, and the
        n + 1 states between them."""
        made, angle, state = ffi.new("pir_critical_states **"), ffi.new("pir_critical_angle *"), ffi.new("pir_state *")
        to = vector("translation", translation)
        with self._held() as map_:
            check(lib.pir_critical_states_create(ffi.new("pir_critical_map *[1]", [map_]), 1, to, ffi.NULL, made),
                  "translation")
        states = ffi.gc(made[0], lib.pir_critical_states_destroy)
        count = lib.pir_critical_states_count(states)
        contacts, between = np.empty((count, 2)), np.empty(count + 1, np.uint8)
        for i in range(count + 1):
            check(lib.pir_critical_states_after(states, i, state), "translation")
            between[i] = state[0]
        for i in range(count):
            check(lib.pir_critical_states_contact(states, i, angle), "translation")
            contacts[i] = angle.degrees[0], angle.degrees[1]
        return contacts, between

    def __enter__(self) -> "CriticalMap":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<CriticalMap: {self.p!r}, {self.q!r}>"
