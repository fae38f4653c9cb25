# SPDX-License-Identifier: MIT
"""Minkowski sums that follow a rotation."""
from __future__ import annotations

import math
from typing import Any, Callable, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import Bytes, Floats, Indices, pointer, quaternion, room, vectors
from ._check import Handle, check
from ._native import ffi, lib
from ._pictures import svg_of
from ._polytopes import Body, Mesh, Polytope, as_polytope
from ._turns import TurnEvent, TurnEvents


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
        made._difference = made._query = None
        return made

    def __copy__(self) -> "MinkowskiSum":
        found = ffi.new("pir_sum **")
        with self._held() as sum_:
            check(lib.pir_sum_clone(sum_, ffi.NULL, found), "copy")
        return self._of(found[0])

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
