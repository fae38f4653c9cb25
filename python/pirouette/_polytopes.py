# SPDX-License-Identifier: MIT
"""Polytopes, and meshes of their boundaries and of sums."""
from __future__ import annotations

from fractions import Fraction
from typing import Any, Callable, Iterable, NamedTuple, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._arrays import Bytes, Floats, Indices, number, path_of, pointer, quaternion, rows, vector
from ._check import InputError, check
from ._native import ffi, lib


class Facets(NamedTuple):
    """Polygons: facet f has the corners ``corners[starts[f]:starts[f + 1]]``, counter-clockwise from outside."""

    starts: Indices
    corners: Indices

    def triangles(self) -> Indices:
        """All facets cut into triangles from their first corners, (m, 3)."""
        fans = [self.corners[a:b] for a, b in zip(self.starts[:-1], self.starts[1:])]
        made = [np.stack([np.full(len(f) - 2, f[0]), f[1:-1], f[2:]], axis=1) for f in fans if len(f) > 2]
        all_: Indices = np.concatenate([np.empty((0, 3), np.uint32), *made]).astype(np.uint32)
        return all_

    def polygons(self) -> "list[Indices]":
        """A list with the corners of each facet."""
        return [self.corners[a:b] for a, b in zip(self.starts[:-1], self.starts[1:])]


class Mass(NamedTuple):
    """A body of density 1. Each number is the double nearest to the exact one."""

    volume: float
    centroid: Floats
    inertia: Floats


def _fractions(call: Any, pointer_: Any, vertex: int) -> "tuple[Fraction, Fraction, Fraction]":
    length = call(pointer_, vertex, 0, ffi.NULL)
    if length < 0:
        raise InputError("exact: this mesh has no rationals; mesh(exact=True) keeps them")
    text = ffi.new("char[]", length + 1)
    call(pointer_, vertex, length + 1, text)
    x, y, z = ffi.string(text).decode().split()
    return Fraction(x), Fraction(y), Fraction(z)


def _three(point: Sequence[Any]) -> Sequence[Any]:
    if len(point) != 3:
        raise ValueError(f"a point has {len(point)} numbers")
    return point


def mass_of(found: Any) -> Mass:
    inertia = np.array([[found.inertia[i][j] for j in range(3)] for i in range(3)])
    return Mass(found.volume, np.array([found.centroid.x, found.centroid.y, found.centroid.z]), inertia)


class Mesh:
    """The boundary of a polytope or a sum: `vertices` (n, 3), `facets`, and which features each facet came from."""

    def __init__(self, pointer_: Any) -> None:
        self._pointer = ffi.gc(pointer_, lib.pir_mesh_destroy)

    @property
    def vertices(self) -> Floats:
        count = lib.pir_mesh_vertex_count(self._pointer)
        made = np.empty((count, 3))
        ffi.memmove(pointer(made), lib.pir_mesh_vertices(self._pointer), made.nbytes)
        return made

    @property
    def exact(self) -> "list[tuple[Fraction, Fraction, Fraction]]":
        """The vertices in rationals, of a mesh that was made with `exact`."""
        count = lib.pir_mesh_vertex_count(self._pointer)
        return [_fractions(lib.py_mesh_vertex_text, self._pointer, v) for v in range(count)]

    @property
    def facets(self) -> Facets:
        starts = np.empty(lib.pir_mesh_facet_count(self._pointer) + 1, np.uint32)
        lib.py_mesh_starts(self._pointer, pointer(starts, "uint32_t *"))
        corners = np.empty(starts[-1], np.uint32)
        lib.py_mesh_corners(self._pointer, pointer(corners, "uint32_t *"))
        return Facets(starts, corners)

    @property
    def kinds(self) -> Bytes:
        """Of each facet: 0 a facet of P, 1 one of Q, 2 an edge of each, 3 several coplanar ones."""
        made = np.empty(lib.pir_mesh_facet_count(self._pointer), np.uint8)
        lib.py_mesh_kinds(self._pointer, pointer(made, "uint8_t *"))
        return made

    @property
    def faces(self) -> Indices:
        """Triangles, as most programs want them: those of `facets`."""
        return self.facets.triangles()

    def write(self, path: Any, exact: bool = False) -> None:
        """Writes an OFF, OBJ, STL, PLY or SVG file, by the ending of `path`; `exact` writes rationals, in OFF."""
        report = ffi.new("pir_report *")
        check(lib.pir_mesh_write(self._pointer, path_of(path), bool(exact), report), f"{path}", report)

    def __len__(self) -> int:
        return int(lib.pir_mesh_facet_count(self._pointer))

    def __repr__(self) -> str:
        return f"<Mesh: {lib.pir_mesh_vertex_count(self._pointer)} vertices, {len(self)} facets>"


class Polytope:
    """The exact convex hull of points, (n, 3). Immutable; threads may share it.

    >>> cube = Polytope([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    >>> cube
    <Polytope: 8 vertices, 12 edges, 6 facets>
    >>> cube.volume
    1.0
    >>> Polytope([[0, 0, float("nan")]])
    Traceback (most recent call last):
        ...
    pirouette.InputError: points: not a finite number
    """

    __slots__ = ("_pointer",)

    def __init__(self, points: npt.ArrayLike, merge_tolerance: float = 0.0) -> None:
        array = rows("points", points, 3)
        options = ffi.new("pir_polytope_options *", lib.pir_polytope_options_default())
        options.merge_tolerance = number("merge_tolerance", merge_tolerance)
        made = ffi.new("pir_polytope **")
        check(lib.pir_polytope_create(pointer(array, "pir_vec3 *"), len(array), options, made), "points")
        self._pointer = ffi.gc(made[0], lib.pir_polytope_release)

    @classmethod
    def from_fractions(cls, points: Iterable[Sequence[Any]]) -> "Polytope":
        """The hull of points in rationals: of Fractions, or whatever a Fraction is made of."""
        try:
            numbers = [Fraction(number) for point in points for number in _three(point)]
        except (TypeError, ValueError, OverflowError, ZeroDivisionError) as wrong:
            raise InputError(f"points: not rationals: {wrong}") from None
        text, made = "".join(f"{number}\0" for number in numbers).encode(), ffi.new("pir_polytope **")
        check(lib.py_polytope_of_text(text, len(numbers) // 3, made), "points")
        return cls._of(made[0])

    @property
    def exact(self) -> "list[tuple[Fraction, Fraction, Fraction]]":
        """The vertices in rationals."""
        count = lib.pir_polytope_vertex_count(self._pointer)
        return [_fractions(lib.py_polytope_vertex_text, self._pointer, v) for v in range(count)]

    @classmethod
    def _of(cls, pointer_: Any) -> "Polytope":
        made = cls.__new__(cls)
        made._pointer = ffi.gc(pointer_, lib.pir_polytope_release)
        return made

    @classmethod
    def read(cls, path: Any, require_convex: bool = False, merge_tolerance: float = 0.0) -> "Polytope":
        """The hull of the points of an OFF, OBJ, STL or PLY file."""
        options = ffi.new("pir_read_options *", lib.pir_read_options_default())
        options.require_convex = bool(require_convex)
        options.merge_tolerance = number("merge_tolerance", merge_tolerance)
        report, made = ffi.new("pir_report *"), ffi.new("pir_polytope **")
        check(lib.pir_polytope_read(path_of(path), options, report, ffi.NULL, made), f"{path}", report)
        return cls._of(made[0])

    @classmethod
    def shape(cls, name: str) -> "Polytope":
        """A body by its name, such as ``"cube"`` or ``"geodesic?level=20"``.

        >>> len(Polytope.shape("icosahedron"))
        12
        """
        if not isinstance(name, str):
            raise InputError(f"name: not a string: {name!r}")
        report, made = ffi.new("pir_report *"), ffi.new("pir_polytope **")
        check(lib.pir_shape_create(name.encode(), ffi.NULL, report, made), "name", report)
        return cls._of(made[0])

    def write(self, path: Any, exact: bool = False) -> None:
        """Writes the boundary to a file, by its ending; `exact` writes rationals, in OFF."""
        report = ffi.new("pir_report *")
        check(lib.py_polytope_write(self._pointer, path_of(path), bool(exact), report), f"{path}", report)

    # --- structure ---

    @property
    def dimension(self) -> int:
        return int(lib.pir_polytope_dimension(self._pointer))

    @property
    def vertices(self) -> Floats:
        made = np.empty((len(self), 3))
        lib.py_polytope_vertices(self._pointer, pointer(made, "pir_vec3 *"))
        return made

    @property
    def edges(self) -> Indices:
        """The two vertices of each edge, (m, 2)."""
        made = np.empty((lib.pir_polytope_edge_count(self._pointer), 2), np.uint32)
        lib.py_polytope_edges(self._pointer, pointer(made, "uint32_t *"))
        return made

    @property
    def facets(self) -> Facets:
        starts = np.empty(lib.pir_polytope_facet_count(self._pointer) + 1, np.uint32)
        lib.py_polytope_starts(self._pointer, pointer(starts, "uint32_t *"))
        corners = np.empty(starts[-1], np.uint32)
        lib.py_polytope_corners(self._pointer, pointer(corners, "uint32_t *"))
        return Facets(starts, corners)

    @property
    def faces(self) -> Indices:
        """Triangles, as most programs want them: those of `facets`."""
        return self.facets.triangles()

    @property
    def normals(self) -> Floats:
        """The outward unit normal of each facet, (m, 3)."""
        made = np.empty((lib.pir_polytope_facet_count(self._pointer), 3))
        lib.py_polytope_normals(self._pointer, pointer(made, "pir_vec3 *"))
        return made

    @property
    def bounds(self) -> Floats:
        """Least and greatest coordinates, (2, 3)."""
        made = np.empty((2, 3))
        lib.pir_polytope_bounds(self._pointer, pointer(made, "pir_vec3 *"), pointer(made[1], "pir_vec3 *"))
        return made

    # --- mass ---

    @property
    def mass(self) -> Mass:
        """Volume, centroid and inertia about the centroid, of density 1."""
        found = ffi.new("pir_mass *")
        check(lib.pir_polytope_mass(self._pointer, found), "mass")
        return mass_of(found)

    @property
    def volume(self) -> float:
        return float(lib.pir_polytope_volume(self._pointer))

    @property
    def centroid(self) -> Floats:
        return self.mass.centroid

    @property
    def inertia(self) -> Floats:
        return self.mass.inertia

    # --- others made of it ---

    def scaled(self, factor: float) -> "Polytope":
        made = ffi.new("pir_polytope **")
        check(lib.pir_polytope_scale(self._pointer, number("factor", factor), made), "factor")
        return self._of(made[0])

    def moved(self, translation: npt.ArrayLike, rotation: npt.ArrayLike = (0, 0, 0, 1)) -> "Polytope":
        """The polytope in a pose, exactly: its coordinates may be rationals then."""
        pose = {"rotation": quaternion("rotation", rotation), "translation": vector("translation", translation)}
        made = ffi.new("pir_polytope **")
        check(lib.pir_polytope_transform(self._pointer, pose, made), "translation or rotation")
        return self._of(made[0])

    def mesh(self) -> Mesh:
        made = ffi.new("pir_mesh **")
        check(lib.pir_mesh_from_polytope(self._pointer, made), "mesh")
        return Mesh(made[0])

    # --- Python's own ---

    def __len__(self) -> int:
        return int(lib.pir_polytope_vertex_count(self._pointer))

    def __repr__(self) -> str:
        edges, facets = lib.pir_polytope_edge_count(self._pointer), lib.pir_polytope_facet_count(self._pointer)
        return f"<Polytope: {len(self)} vertices, {edges} edges, {facets} facets>"

    def __copy__(self) -> "Polytope":
        return self

    def __deepcopy__(self, memo: Any) -> "Polytope":
        return self

    def __reduce__(self) -> Tuple[Callable[[bytes], "Polytope"], Tuple[bytes]]:
        return _restored, (_serialised(self),)


def _serialised(polytope: Polytope) -> bytes:
    """Exact coordinates: those of a sum with a point, which keeps them."""
    point = Polytope([[0.0, 0.0, 0.0]])
    made = ffi.new("pir_sum **")
    straight = {"x": 0, "y": 0, "z": 0, "w": 1}
    check(lib.pir_sum_create(polytope._pointer, point._pointer, straight, ffi.NULL, made), "polytope")
    sum_ = ffi.gc(made[0], lib.pir_sum_destroy)
    size = lib.pir_sum_serialised_size(sum_)
    room = ffi.new("char[]", size)
    check(lib.pir_sum_serialise(sum_, room, size), "polytope")
    return bytes(ffi.buffer(room, size))


def _restored(data: bytes) -> Polytope:
    report, made = ffi.new("pir_report *"), ffi.new("pir_sum **")
    check(lib.pir_sum_restore(data, len(data), ffi.NULL, report, made), "data", report)
    sum_ = ffi.gc(made[0], lib.pir_sum_destroy)
    return Polytope._of(lib.pir_polytope_retain(ffi.cast("pir_polytope *", lib.pir_sum_p(sum_))))


Body = Union[Polytope, npt.ArrayLike, Any]


def as_polytope(name: str, body: Body) -> Polytope:
    """A polytope as it is, or the hull of an array of points, or of the `.vertices` of anything else."""
    if isinstance(body, Polytope):
        return body
    try:
        return Polytope(getattr(body, "vertices", body))
    except InputError as wrong:
        raise type(wrong)(f"{name}: {str(wrong)}", wrong.status) from None
