# SPDX-License-Identifier: MIT
"""Critical angles: when the sum changes while P makes a full turn about an axis."""
from __future__ import annotations

from typing import Any, Iterator, NamedTuple, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, dtype_of, number, pointer, quaternion, vector
from ._check import Handle, check
from ._native import ffi, lib
from ._polytopes import Body, Polytope, as_polytope


class TurnEvent(NamedTuple):
    """A change of the facets of the sum. `kappa` and `angle`, in degrees, are the doubles that hold the exact ones
    between them, (2,); `lost` and `gained` have the features of P and Q that make each facet, fields ``["p"]["kind"]``,
    1 a vertex, 2 an edge, 3 a facet, and ``["p"]["index"]``, likewise of ``["q"]``. `after` is the quaternion, (4,), of
    the shortest κ before the next event: at it the sum has the facets of the interval between. It is exact where
    axis and rotation have few bits, and None where no doubles
    lie between."""

    kappa: Tuple[float, float]
    angle: Tuple[float, float]
    lost: "npt.NDArray[Any]"
    gained: "npt.NDArray[Any]"
    after: Optional[Floats]


def _turned(axis: Floats, kappa: float, start: Floats) -> Floats:
    """The quaternion (axis, κ)·start."""
    u, v, w = axis, start[:3], start[3]
    with np.errstate(over="ignore", invalid="ignore"):
        return np.append(kappa * v + w * u + np.cross(u, v), kappa * w - u @ v)


class TurnEvents(Handle):
    """The events of one turn, in order: P starts at `rotation` and turns by 0 to 360 degrees about `axis`, counter-
    clockwise seen from where the axis points to. An iterator; all is decided exactly. κ is |axis|·cot(angle/2), which
    falls. Changes at one angle are one event; what lasts for a while, or only touches, is none.

    >>> cube = Polytope.shape("cube")
    >>> [round(event.angle[0], 6) for event in TurnEvents(cube, cube, axis=[1, 1, 1])]
    [120.0, 240.0]
    """

    def __init__(self, p: Body, q: Body, axis: npt.ArrayLike, rotation: npt.ArrayLike = (0, 0, 0, 1),
                 difference: bool = False) -> None:
        self.p: Polytope = as_polytope("p", p)
        self.q: Polytope = as_polytope("q", q)
        along, start = vector("axis", axis), quaternion("rotation", rotation)
        options = ffi.new("pir_events_options *", lib.pir_events_options_default())
        options.difference = bool(difference)
        made = ffi.new("pir_events **")
        check(lib.pir_events_create(self.p._pointer, self.q._pointer, start, along, options, made), "axis or rotation")
        super().__init__(made[0], lib.pir_events_destroy)
        self._axis = np.array([along[a] for a in "xyz"])
        self._start = np.array([start[a] for a in "xyzw"])

    def __iter__(self) -> Iterator[TurnEvent]:
        return self

    def __next__(self) -> TurnEvent:
        event, found = ffi.new("pir_event *"), ffi.new("bool *")
        with self._held() as events:
            check(lib.pir_events_next(events, event, found), "events")
            if not found[0]:
                raise StopIteration
            return self._told(events, event)

    def _told(self, events: Any, event: Any) -> TurnEvent:
        kappa, angle, between = ffi.new("double[2]"), ffi.new("double[2]"), ffi.new("double *")
        lib.pir_events_kappa(events, kappa)
        lib.pir_events_angle(events, angle)
        status = lib.pir_events_between(events, between)
        if status != lib.PIR_ERR_LIMIT:
            check(status, "events")
        after = _turned(self._axis, between[0], self._start) if status == lib.PIR_OK else None
        if after is not None and not np.isfinite(after).all():
            after = None
        return TurnEvent((kappa[0], kappa[1]), (angle[0], angle[1]), _features(event.lost, event.lost_count),
                         _features(event.gained, event.gained_count), after)

    def seek(self, kappa: float) -> None:
        """Goes to a κ, so that the next event is the first at a lesser κ; to infinity for the begin."""
        at = number("kappa", kappa)
        with self._held() as events:
            check(lib.pir_events_seek(events, at), "kappa")

    def facet_count(self) -> int:
        """How many facets the sum has just after the event that came last."""
        with self._held() as events:
            return int(lib.pir_events_facet_count(events))

    def __enter__(self) -> "TurnEvents":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<TurnEvents: {self.p!r}, {self.q!r}, about {self._axis.tolist()}>"


def _features(first: Any, count: int) -> "npt.NDArray[Any]":
    made = np.empty(count, dtype_of("pir_witness"))
    if count:
        ffi.memmove(pointer(made, "char *"), first, made.nbytes)
    return made
