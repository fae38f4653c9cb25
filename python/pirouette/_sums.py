# SPDX-License-Identifier: MIT
"""Minkowski sums that follow a rotation."""
from __future__ import annotations

import math
from typing import Any, Callable, Dict, NamedTuple, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import (Bytes, Floats, Indices, dtype_of, fail_at, number, pointer, quaternion, room, vector, vectors)
from ._check import Handle, check
from ._native import ffi, lib
from ._pictures import svg_of
from ._polytopes import Body, Facets, Mesh, Polytope, as_polytope
from ._turns import TurnEvent, TurnEvents


class Penetrations(NamedTuple):
    """`state` 0 outside, 1 touching, 2 overlapping; moving P by depth · normal is the shortest way out."""

    state: Bytes
    depth: Floats
    normal: Floats
    point_p: Floats
    point_q: Floats


class MinkowskiSum(Handle):
    """The exact sum of P, turned, and Q, kept up to date while P turns; and where P may stand beside Q.

    >>> cube = Polytope.shape("cube")
    >>> sum_ = MinkowskiSum(cube, cube)
    >>> sum_.mesh()
    <Mesh: 8 vertices, 6 facets>
    >>> sum_.rotate([0, 0, 0.5, 1])
    >>> sum_.mesh()
    <Mesh: 16 vertices, 10 facets>
    >>> sum_.depths([[0.0, 0, 0.5], [0, 0, 9]]).tolist()
    [0.5, 0.0]
    """

    def __init__(self, p: Body, q: Body, rotation: npt.ArrayLike = (0, 0, 0, 1)) -> None:
        self.p: Polytope = as_polytope("p", p)
        self.q: Polytope = as_polytope("q", q)
        turned = quaternion("rotation", rotation)
        made = ffi.new("pir_sum **")
        check(lib.pir_sum_create(self.p._pointer, self.q._pointer, turned, ffi.NULL, made), "rotation")
        super().__init__(made[0], lib.pir_sum_destroy)
        self._difference: Any = None
        self._query: Any = None
        self._region: Any = None

    def rotate(self, rotation: npt.ArrayLike) -> None:
        """Brings the sum to a rotation of P, (4,) x, y, z, w of any length, or (3, 3): what changed is repaired."""
        turned = quaternion("rotation", rotation)
        with self._held() as sum_:
            check(lib.pir_sum_rotate(sum_, turned, lib.PIR_METHOD_AUTO), "rotation")

    @property
    def rotation(self) -> Floats:
        with self._held() as sum_:
            q = lib.pir_sum_rotation(sum_)
        return np.array([q.x, q.y, q.z, q.w])

    # --- turning on ---

    def events(self, axis: npt.ArrayLike) -> TurnEvents:
        """The changes of the sum while P makes a full turn about `axis` from the present rotation, in order."""
        return TurnEvents(self.p, self.q, axis, self.rotation)

    def next_event(self, axis: npt.ArrayLike) -> Optional[TurnEvent]:
        """The first of them, or None where the sum stays the same for a full turn."""
        with self.events(axis) as events:
            return next(events, None)

    # --- the pairing ---

    @property
    def fv(self) -> Indices:
        """The vertex of Q that each facet of P meets."""
        with self._held() as sum_:
            made = np.empty(lib.pir_polytope_facet_count(self.p._pointer), np.uint32)
            ffi.memmove(pointer(made, "char *"), lib.pir_sum_fv(sum_), made.nbytes)
        return made

    @property
    def vf(self) -> Indices:
        """The vertex of P that each facet of Q meets."""
        with self._held() as sum_:
            made = np.empty(lib.pir_polytope_facet_count(self.q._pointer), np.uint32)
            ffi.memmove(pointer(made, "char *"), lib.pir_sum_vf(sum_), made.nbytes)
        return made

    @property
    def ee(self) -> Indices:
        """Pairs of an edge of P and an edge of Q, (n, 2)."""
        with self._held() as sum_:
            made = np.empty((lib.pir_sum_ee_count(sum_), 2), np.uint32)
            lib.py_sum_ee(sum_, pointer(made, "uint32_t *"))
        return made

    def mesh(self, exact: bool = False) -> Mesh:
        """The boundary of the sum, with maximal facets; `exact` keeps rationals beside the doubles, for `write`."""
        made = ffi.new("pir_mesh **")
        with self._held() as sum_:
            check(lib.pir_sum_mesh(sum_, lib.PIR_EXACT if exact else lib.PIR_DOUBLE, made), "mesh")
        return Mesh(made[0])

    # --- where P may stand ---

    def _asked(self, sum_: Any) -> Any:
        """A query on the difference, at the rotation of the sum."""
        turned = lib.pir_sum_rotation(sum_)
        if self._query is None:
            options = ffi.new("pir_sum_options *", lib.pir_sum_options_default())
            options.difference = True
            made, query = ffi.new("pir_sum **"), ffi.new("pir_query **")
            check(lib.pir_sum_create(self.p._pointer, self.q._pointer, turned, options, made), "MinkowskiSum")
            difference = ffi.gc(made[0], lib.pir_sum_destroy)
            if self._region is not None:
                check(lib.pir_sum_set_region(difference, *self._region), "MinkowskiSum")
            check(lib.pir_query_create(difference, query), "MinkowskiSum")
            self._difference, self._query = difference, ffi.gc(query[0], lib.pir_query_destroy)
        else:
            check(lib.pir_sum_rotate(self._difference, turned, lib.PIR_METHOD_AUTO), "rotation")
        return self._query

    def _batch(self, call: Any, translations: npt.ArrayLike, out: Optional[Floats]) -> Floats:
        array, shape = vectors("translations", translations, 3)
        made = room("out", out, shape)
        with self._held() as sum_:
            check(call(self._asked(sum_), pointer(array, "pir_vec3 *"), len(array), pointer(made), ffi.NULL),
                  "translations")
        return made

    def depths(self, translations: npt.ArrayLike, out: Optional[Floats] = None) -> Floats:
        """How deep P, turned and moved by each translation, is in Q: 0 where they do not overlap."""
        return self._batch(lib.pir_query_batch_depths, translations, out)

    def distances(self, translations: npt.ArrayLike, out: Optional[Floats] = None) -> Floats:
        """The signed distance of P, turned and moved by each translation, from Q."""
        return self._batch(lib.pir_query_batch_distances, translations, out)

    def states(self, translations: npt.ArrayLike) -> Bytes:
        """The exact state at each translation: 0 outside, 1 touching, 2 overlapping."""
        array, shape = vectors("translations", translations, 3)
        found = np.empty(shape, np.uint32)
        with self._held() as sum_:
            check(lib.pir_query_batch_states(self._asked(sum_), pointer(array, "pir_vec3 *"), len(array),
                                             pointer(found, "pir_state *")), "translations")
        return found.astype(np.uint8)

    def penetrations(self, translations: npt.ArrayLike) -> Penetrations:
        """How deep P is in Q at translations, the ways out and the points; of a sum with a region by its facets."""
        array, shape = vectors("translations", translations, 3)
        found, done = np.empty(len(array), dtype_of("pir_query_result")), ffi.new("size_t *")
        with self._held() as sum_:
            status = lib.py_query_penetrations(self._asked(sum_), pointer(array), len(array),
                                               pointer(found, "pir_query_result *"), done)
        fail_at(status, "translations", done[0])
        found = found.reshape(shape)
        return Penetrations(found["state"].astype(np.uint8), np.maximum(-found["distance"], 0.0),
                            found["normal"].copy(), found["point_p"].copy(), found["point_q"].copy())

    # --- parts, and pictures that follow ---

    def set_region(self, axis: npt.ArrayLike, half_angle: float) -> None:
        """Keeps only what facets with normals within `half_angle` of `axis` need, of the sum and of the difference that
        is asked: `penetrations` answers from these facets then, with the depth or more. It may follow every frame."""
        along, angle = vector("axis", axis), number("half_angle", half_angle)
        with self._held() as sum_:
            check(lib.pir_sum_set_region(sum_, along, angle), "axis or half_angle")
            self._region = (along, angle)
            if self._difference is not None:
                check(lib.pir_sum_set_region(self._difference, along, angle), "axis or half_angle")

    def clear_region(self) -> None:
        """The whole sum again."""
        with self._held() as sum_:
            self._region = None
            check(lib.pir_sum_clear_region(sum_), "MinkowskiSum")
            if self._difference is not None:
                check(lib.pir_sum_clear_region(self._difference), "MinkowskiSum")

    def statistics(self) -> Dict[str, int]:
        """Counters of the sum's work: `updates`, `checked` certificates that expired, `repaired` pairs, and others."""
        with self._held() as sum_:
            found = lib.pir_sum_get_statistics(sum_)
        return {name: int(getattr(found, name)) for name, _ in ffi.typeof("pir_sum_statistics").fields}

    def live(self) -> "LiveMesh":
        """A mesh that follows the sum: what changed is rewritten, the rest stays in its place."""
        return LiveMesh(self)

    # --- Python's own ---

    def _close(self) -> None:
        self._query = self._difference = None
        super()._close()

    def serialise(self) -> bytes:
        """The sum in bytes that any machine reads."""
        with self._held() as sum_:
            size = lib.pir_sum_serialised_size(sum_)
            data = ffi.new("char[]", size)
            check(lib.pir_sum_serialise(sum_, data, size), "serialise")
        return bytes(ffi.buffer(data, size))

    @classmethod
    def restore(cls, data: bytes) -> "MinkowskiSum":
        """A sum from such bytes, which are not trusted."""
        report, found = ffi.new("pir_report *"), ffi.new("pir_sum **")
        check(lib.pir_sum_restore(bytes(data), len(data), ffi.NULL, report, found), "data", report)
        return cls._of(found[0])

    @classmethod
    def _of(cls, pointer_: Any) -> "MinkowskiSum":
        made = cls.__new__(cls)
        Handle.__init__(made, pointer_, lib.pir_sum_destroy)
        made.p = Polytope._of(lib.pir_polytope_retain(ffi.cast("pir_polytope *", lib.pir_sum_p(pointer_))))
        made.q = Polytope._of(lib.pir_polytope_retain(ffi.cast("pir_polytope *", lib.pir_sum_q(pointer_))))
        made._difference = made._query = made._region = None
        return made

    def __copy__(self) -> "MinkowskiSum":
        found = ffi.new("pir_sum **")
        with self._held() as sum_:
            check(lib.pir_sum_clone(sum_, ffi.NULL, found), "copy")
        made = self._of(found[0])
        made._region = self._region
        return made

    def __deepcopy__(self, memo: Any) -> "MinkowskiSum":
        return self.__copy__()

    def __reduce__(self) -> Tuple[Callable[[bytes], "MinkowskiSum"], Tuple[bytes]]:
        return MinkowskiSum.restore, (self.serialise(),)

    def __enter__(self) -> "MinkowskiSum":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        with self._held() as sum_:
            pairs = lib.pir_sum_ee_count(sum_)
        return f"<MinkowskiSum: {self.p!r} + {self.q!r}, {pairs} pairs of edges>"

    def _repr_html_(self) -> str:
        """A picture of the sum in a notebook, as SVG that needs nothing else. Facets of P are blue, of Q orange, of
        edges green, of several of these violet."""
        return svg_of(self.mesh(), repr(self))

    def turned(self, axis: npt.ArrayLike, angle: float) -> None:
        """Brings the sum to the rotation about an axis by an angle in radians, from rest."""
        along = np.asarray(axis, float)
        half = angle / 2
        self.rotate(np.append(along / np.linalg.norm(along) * math.sin(half), math.cos(half)))


class LiveMesh(Handle):
    """The facets of a sum that turns, in slots: `refresh` rewrites those that changed.

    >>> cube = Polytope.shape("cube")
    >>> sum_ = MinkowskiSum(cube, cube)
    >>> live = sum_.live()
    >>> sum_.rotate([0, 0, 0.5, 1])
    >>> live.refresh()
    >>> len(live.facets.starts) - 1 == live.slots
    True
    """

    def __init__(self, sum_: MinkowskiSum) -> None:
        made = ffi.new("pir_live_mesh **")
        with sum_._held() as pointer_:
            check(lib.pir_live_mesh_create(pointer_, made), "LiveMesh")
        self._sum = sum_
        super().__init__(made[0], lib.pir_live_mesh_destroy)

    def refresh(self) -> None:
        """Brings the facets to the sum as it stands now."""
        with self._held() as live, self._sum._held():
            check(lib.pir_live_mesh_refresh(live), "LiveMesh")

    @property
    def slots(self) -> int:
        """How many facets there is room for, empty ones included."""
        with self._held() as live:
            return int(lib.pir_live_mesh_facet_slots(live))

    @property
    def rewritten(self) -> Indices:
        """The slots of facets that the last refresh rewrote or emptied."""
        count = ffi.new("uint32_t *")
        with self._held() as live:
            first = lib.pir_live_mesh_rewritten(live, count)
            made = np.empty(count[0], np.uint32)
            if count[0]:
                ffi.memmove(pointer(made, "char *"), first, made.nbytes)
        return made

    @property
    def facets(self) -> Facets:
        """Of each slot the corners, slots of vertices; an empty slot has none."""
        with self._held() as live:
            starts = np.empty(lib.pir_live_mesh_facet_slots(live) + 1, np.uint32)
            lib.py_live_mesh_starts(live, pointer(starts, "uint32_t *"))
            corners = np.empty(starts[-1], np.uint32)
            lib.py_live_mesh_corners(live, pointer(corners, "uint32_t *"))
        return Facets(starts, corners)

    @property
    def vertices(self) -> Floats:
        """Of each slot of a vertex where it is at the sum's rotation."""
        with self._held() as live, self._sum._held():
            made = np.zeros((lib.pir_live_mesh_vertex_slots(live), 3))
            lib.pir_live_mesh_vertices(live, pointer(made, "pir_vec3 *"))
        return made

    def __repr__(self) -> str:
        return f"<LiveMesh: {self.slots} slots of {self._sum!r}>"
