# SPDX-License-Identifier: MIT
"""Solids that need not be convex: pieces, exact sums, depths."""
from __future__ import annotations

import contextlib
import functools
from typing import Any, Callable, Iterator, List, NamedTuple, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._arrays import (Bytes, Floats, Indices, dtype_of, fail_at, indices, number, path_of, pointer, quaternion, rows,
                      whole)
from ._check import Handle, InputError, check
from ._motions import FirstContact, Sweep, exact_motion, first_contact_of, input_at, sweep_by
from ._native import ffi, lib
from ._pairs import both, pairs_of_poses, set_poses
from ._polytopes import Mesh, Polytope


class Depths(NamedTuple):
    """How deep P is in Q at poses: `state` 0 outside, 1 touching, 2 overlapping; moving P by depth · normal is the
    shortest way out. All but the state is 0 where they do not overlap."""

    state: Bytes
    depth: Floats
    normal: Floats
    point_p: Floats
    point_q: Floats


class SolidContacts(NamedTuple):
    """Contacts of solids at n poses: those of pose i are the elements ``starts[i]:starts[i + 1]`` of the others, the
    deepest first. `normal` is a unit vector from Q to P; pieces are those of the solids' decompositions."""

    starts: "npt.NDArray[np.int64]"
    point_p: Floats
    point_q: Floats
    normal: Floats
    distance: Floats
    piece_p: Indices
    piece_q: Indices
    facet_q: Indices
    id: "npt.NDArray[np.uint64]"


def _facets_of(faces: Any) -> "tuple[npt.NDArray[np.uint32], npt.NDArray[np.uint32]]":
    """Faces of one size as an array, or of any sizes as a list of lists, as starts and corners."""
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        corners = indices("faces", faces, faces.shape[1] if faces.ndim == 2 else 3)
        return np.arange(len(corners) + 1, dtype=np.uint32) * np.uint32(corners.shape[1]), corners.reshape(-1)
    try:
        lists = [indices(f"faces[{i}]", face) for i, face in enumerate(faces)]
    except TypeError:
        raise InputError("faces: not a sequence of faces") from None
    starts = np.concatenate([[0], np.cumsum([len(face) for face in lists])]).astype(np.uint32)
    return starts, np.concatenate(lists) if lists else np.empty(0, np.uint32)


def _of_facets(points: Any, starts: Any, corners: Any) -> "Solid":
    return Solid(points, [corners[a:b] for a, b in zip(starts[:-1], starts[1:])])


class Pieces(Handle):
    """The convex pieces of a solid; `error` bounds how far they reach out of it."""

    def __init__(self, pointer_: Any, error: float) -> None:
        super().__init__(pointer_, lib.pir_pieces_destroy)
        self.error = error

    def polytopes(self) -> List[Polytope]:
        with self._held() as pieces:
            return [self._one(pieces, i) for i in range(lib.pir_pieces_count(pieces))]

    @staticmethod
    def _one(pieces: Any, index: int) -> Polytope:
        made = ffi.new("pir_polytope **")
        check(lib.pir_pieces_polytope(pieces, index, made), "pieces")
        return Polytope._of(made[0])

    def __getitem__(self, index: int) -> Polytope:
        with self._held() as pieces:
            count = lib.pir_pieces_count(pieces)
            at = index + count if index < 0 else index
            if not 0 <= at < count:
                raise IndexError(f"there are {count} pieces")
            return self._one(pieces, at)

    def __len__(self) -> int:
        with self._held() as pieces:
            return int(lib.pir_pieces_count(pieces))

    def __repr__(self) -> str:
        return f"<Pieces: {len(self)}, within {self.error:g} of the solid>"


class Solid:
    """A body bounded by closed surfaces: `vertices` (n, 3), `faces` an array (m, k) or lists of corners,
    counter-clockwise from outside. Immutable. What bounds nothing is refused, with the place named.

    >>> step = Solid.prism([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], 1.0)
    >>> step.volume
    3.0
    >>> len(step.decompose())
    2
    >>> cube = Solid(Polytope.shape("cube"))
    >>> float(step.depth(cube, [0, 0, 0, 1, 0, 0, 0]).depth)
    0.5
    """

    __slots__ = ("_pointer", "_made")

    def __init__(self, vertices: Any, faces: Any = None) -> None:
        made, report = ffi.new("pir_solid **"), ffi.new("pir_report *")
        self._made: Tuple[Any, ...] = (Solid, vertices)
        if faces is None and isinstance(vertices, Polytope):
            check(lib.pir_solid_from_polytope(vertices._pointer, ffi.NULL, made), "vertices")
        else:
            if faces is None:
                if not (hasattr(vertices, "vertices") and hasattr(vertices, "faces")):
                    raise InputError("faces: missing, and vertices has no .vertices and .faces")
                vertices, faces = vertices.vertices, vertices.faces
            points = rows("vertices", vertices, 3)
            starts, corners = _facets_of(faces)
            facets = ffi.new("pir_solid_facets *")
            facets.points, facets.point_count = pointer(points, "pir_vec3 *"), len(points)
            facets.starts, facets.facet_count = pointer(starts, "uint32_t *"), len(starts) - 1
            facets.corners = pointer(corners, "uint32_t *")
            self._made = _of_facets, points.copy(), starts, corners.copy()
            check(lib.pir_solid_create(facets, ffi.NULL, report, made), "vertices or faces", report)
        self._pointer = ffi.gc(made[0], lib.pir_solid_release)

    @classmethod
    def read(cls, path: Any) -> "Solid":
        """The solid of an OFF, OBJ, STL or PLY file."""
        name = path_of(path)
        try:
            with open(name, "rb") as file:
                return cls.from_bytes(file.read(), name)
        except OSError:
            report, found = ffi.new("pir_report *"), ffi.new("pir_solid **")
            check(lib.pir_solid_read(name, ffi.NULL, report, found), f"{path}", report)
            raise

    @classmethod
    def from_bytes(cls, data: bytes, name: Union[str, bytes]) -> "Solid":
        """The solid of the bytes of a file; the ending of `name` tells the format."""
        report, found, file = ffi.new("pir_report *"), ffi.new("pir_solid **"), ffi.new("pir_file_bytes *")
        told = name.encode() if isinstance(name, str) else name
        kept = ffi.from_buffer(data), ffi.new("char[]", told)
        file.bytes, file.size, file.name = kept[0], len(data), kept[1]
        check(lib.pir_solid_read_bytes(file, ffi.NULL, report, found), "data or name", report)
        made = cls.__new__(cls)
        made._pointer = ffi.gc(found[0], lib.pir_solid_release)
        made._made = Solid.from_bytes, bytes(data), told
        return made

    @classmethod
    def prism(cls, outline: npt.ArrayLike, height: float) -> "Solid":
        """A polygon, counter-clockwise, raised from z = 0 to `height`."""
        flat = rows("outline", outline, 2)
        n = len(flat)
        points = np.zeros((2 * n, 3))
        points[:n, :2] = points[n:, :2] = flat
        points[n:, 2] = number("height", height)
        sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
        return cls(points, [list(range(n - 1, -1, -1)), list(range(n, 2 * n)), *sides])

    def _info(self) -> Any:
        info = ffi.new("pir_solid_info *")
        lib.pir_solid_describe(self._pointer, info)
        return info

    @property
    def volume(self) -> float:
        return float(self._info().volume)

    @property
    def genus(self) -> int:
        return int(self._info().genus)

    @property
    def shells(self) -> int:
        return int(self._info().shells)

    @property
    def bounds(self) -> Floats:
        info = self._info()
        return np.array([[v.x, v.y, v.z] for v in (info.low, info.high)])

    def decompose(self, tolerance: float = 0.0, pieces: int = 0) -> Pieces:
        """Convex pieces whose union is the solid; with a tolerance, or a number of pieces, fewer that hold it."""
        options = ffi.new("pir_decompose_options *", lib.pir_decompose_options_default())
        options.tolerance = number("tolerance", tolerance)
        options.pieces = whole("pieces", pieces, 0, 2**32 - 1)
        report, info, made = ffi.new("pir_report *"), ffi.new("pir_decompose_info *"), ffi.new("pir_pieces **")
        options.report = report
        status = lib.pir_solid_decompose(self._pointer, options, info, made)
        check(status, "tolerance or pieces", report)
        return Pieces(made[0], info.error)

    def minkowski_sum(self, other: "Solid", rotation: npt.ArrayLike = (0, 0, 0, 1), exact: bool = False) -> Mesh:
        """The exact sum of this solid, turned, and another, as a mesh."""
        if not isinstance(other, Solid):
            raise InputError(f"other: not a Solid: {other!r}")
        made, mesh = ffi.new("pir_solid_sum **"), ffi.new("pir_mesh **")
        check(lib.pir_solid_sum_create(self._pointer, other._pointer, quaternion("rotation", rotation), ffi.NULL, made),
              "rotation")
        sum_ = ffi.gc(made[0], lib.pir_solid_sum_destroy)
        check(lib.pir_solid_sum_mesh(sum_, lib.PIR_EXACT if exact else lib.PIR_DOUBLE, mesh), "minkowski_sum")
        return Mesh(mesh[0])

    def depth(self, other: "Solid", poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None) -> Depths:
        """How deep this solid, at `poses_p`, is in another, at `poses_q`: the least over all ways out, exactly."""
        if not isinstance(other, Solid):
            raise InputError(f"other: not a Solid: {other!r}")
        return SolidPair(self, other).depth(poses_p, poses_q)

    def contacts(self, other: "Solid", poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None, *,
                 margin: float = 0.0) -> SolidContacts:
        """Contacts of this solid, at `poses_p`, and another, at `poses_q`, up to `margin` apart, without those that
        seams between pieces and inner walls would give."""
        if not isinstance(other, Solid):
            raise InputError(f"other: not a Solid: {other!r}")
        return SolidPair(self, other).contacts(poses_p, poses_q, margin=margin)

    def __repr__(self) -> str:
        info = self._info()
        return f"<Solid: {info.vertices} vertices, {info.facets} facets, volume {info.volume:g}>"

    def __copy__(self) -> "Solid":
        return self

    def __deepcopy__(self, memo: Any) -> "Solid":
        return self

    def __reduce__(self) -> "Tuple[Callable[..., Solid], Tuple[Any, ...]]":
        """By what it was made of, exactly."""
        return self._made[0], self._made[1:]


class SolidPair(Handle):
    """Two solids that are asked again and again: their pieces are made once."""

    def __init__(self, p: Union[Solid, Pieces], q: Union[Solid, Pieces]) -> None:
        self._pieces: Tuple[Pieces, Pieces] = (_cut(p), _cut(q))
        made, scratch = ffi.new("pir_solid_query_batch **"), ffi.new("pir_workspace **")
        with self._both() as (a, b):
            check(lib.pir_solid_query_batch_create(a, b, ffi.NULL, made), "SolidPair")
        super().__init__(made[0], lib.pir_solid_query_batch_destroy)
        check(lib.pir_workspace_create(ffi.NULL, scratch), "SolidPair")
        self._workspace = ffi.gc(scratch[0], lib.pir_workspace_destroy)
        self._contacts: Any = None
        self._query: Any = None

    @contextlib.contextmanager
    def _both(self) -> Iterator[Tuple[Any, Any]]:
        """The pieces of both, this thread's for a while; they may be the same."""
        with self._pieces[0]._held() as a:
            if self._pieces[0] is self._pieces[1]:
                yield a, a
            else:
                with self._pieces[1]._held() as b:
                    yield a, b

    def depth(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None) -> Depths:
        """As of `Solid.depth`."""
        p, q, shape = both(poses_p, poses_q)
        count = shape[0] if shape else 1
        found = Depths(np.empty(count, np.uint8), np.empty(count), *(np.empty((count, 3)) for _ in range(3)))
        asked = ffi.new("pir_pair_batch_input *", lib.pir_pair_batch_input_default())
        set_poses(asked.poses_p, p, len(p) != count)
        if q is not None:
            set_poses(asked.poses_q, q, len(q) != count)
        to, summary = ffi.new("pir_solid_query_batch_arrays *"), ffi.new("pir_pair_batch_summary *")
        to.state, to.distance = pointer(found.state, "uint8_t *"), pointer(found.depth)
        for name in ("normal", "point_p", "point_q"):
            setattr(to, name, pointer(getattr(found, name), "double(*)[3]"))
        with self._held() as batch:
            check(lib.pir_solid_query_batch_depth(batch, asked, count, to, summary), "depth")
        if summary.bad:
            fail_at(summary.first_status, "poses_p or poses_q", summary.first_bad)
        return Depths(*(values.reshape(shape + values.shape[1:]) for values in found))

    def contacts(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None, *,
                 margin: float = 0.0) -> SolidContacts:
        """As of `Solid.contacts`."""
        posed, shape = pairs_of_poses(poses_p, poses_q)
        limit, counts, made = number("margin", margin), np.zeros(len(posed), np.uint64), []
        at, capacity = 0, 256
        with self._held():
            self._make_contacts()
            while at < len(posed):
                found = np.empty(capacity, dtype_of("pir_solid_contact"))
                room = ffi.new("py_contact_room *", [capacity, pointer(found, "pir_solid_contact *"),
                                                     pointer(counts[at:], "uint64_t *"), 0])
                status = lib.py_solid_contacts(self._contacts, self._workspace, pointer(posed[at:]), len(posed) - at,
                                               limit, room)
                fail_at(status, "poses_p or poses_q", at + room.done)
                made.append(found[:int(counts[at:at + room.done].sum())].copy())
                at += room.done
                capacity = max(min(2 * capacity, 2**16), int(counts[at]) if at < len(posed) else 0)
        starts = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        all_ = np.concatenate([np.empty(0, dtype_of("pir_solid_contact")), *made])
        return SolidContacts(starts, *(all_[name].copy() for name in SolidContacts._fields[1:]))

    @contextlib.contextmanager
    def _single(self) -> Iterator[Any]:
        """The query of single poses, this thread's for a while."""
        with self._held():
            if self._query is None:
                made = ffi.new("pir_solid_query **")
                with self._both() as (a, b):
                    check(lib.pir_solid_query_create(a, b, ffi.NULL, made), "SolidPair")
                self._query = ffi.gc(made[0], lib.pir_solid_query_destroy)
            yield self._query

    def first_contact(self, pose_p: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
                      axis: npt.ArrayLike = (0, 0, 0), degrees: float = 0.0, pivot: npt.ArrayLike = (0, 0, 0),
                      way: npt.ArrayLike = (0, 0, 0)) -> FirstContact:
        """As of `Pair.first_contact`."""
        asked, motion = input_at("pose_p", pose_p, "pose_q", pose_q), exact_motion(axis, degrees, pivot, way)
        found = ffi.new("pir_exact_impact *")
        with self._single() as query:
            check(lib.pir_solid_query_impact(query, self._workspace, asked, motion, found), "poses or motion")
        return first_contact_of(found)

    def sweep(self, a: npt.ArrayLike, b: npt.ArrayLike, a_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0),
              b_q: Optional[npt.ArrayLike] = None, *, budget: int = 0) -> Sweep:
        """As of `Pair.sweep`."""
        first, second = input_at("a", a, "a_q", a_q), input_at("b", b, "b_q", a_q if b_q is None else b_q)
        with self._single() as query:
            return sweep_by(functools.partial(lib.pir_solid_query_sweep, query, self._workspace), first, second, budget)

    def sweep_screw(self, pose_p: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
                    axis: npt.ArrayLike = (0, 0, 0), degrees: float = 0.0, pivot: npt.ArrayLike = (0, 0, 0),
                    way: npt.ArrayLike = (0, 0, 0), budget: int = 0) -> Sweep:
        """As of `Pair.sweep_screw`."""
        asked, motion = input_at("pose_p", pose_p, "pose_q", pose_q), exact_motion(axis, degrees, pivot, way)
        with self._single() as query:
            return sweep_by(functools.partial(lib.pir_solid_query_sweep_screw, query, self._workspace), asked, motion,
                            budget)

    def _make_contacts(self) -> None:
        if self._contacts is None:
            made = ffi.new("pir_solid_contacts **")
            with self._both() as (a, b):
                check(lib.pir_solid_contacts_create(a, b, ffi.NULL, made), "SolidPair")
            self._contacts = ffi.gc(made[0], lib.pir_solid_contacts_destroy)

    def _close(self) -> None:
        self._contacts = self._query = None
        super()._close()

    def __enter__(self) -> "SolidPair":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return "<SolidPair>"


def _cut(body: Union[Solid, Pieces]) -> Pieces:
    return body if isinstance(body, Pieces) else body.decompose()
