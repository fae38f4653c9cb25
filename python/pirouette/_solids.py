# SPDX-License-Identifier: MIT
"""Solids that need not be convex: pieces, exact sums, depths."""
from __future__ import annotations

from typing import Any, List, NamedTuple, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from ._arrays import Bytes, Floats, dtype_of, fail_at, indices, number, path_of, pointer, quaternion, rows, whole
from ._check import Handle, InputError, check
from ._native import ffi, lib
from ._pairs import pairs_of_poses
from ._polytopes import Mesh, Polytope


class Depths(NamedTuple):
    """How deep P is in Q at poses: `state` 0 outside, 1 touching, 2 overlapping; moving P by depth · normal is the
    shortest way out. All but the state is 0 where they do not overlap."""

    state: Bytes
    depth: Floats
    normal: Floats
    point_p: Floats
    point_q: Floats


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

    __slots__ = ("_pointer",)

    def __init__(self, vertices: Any, faces: Any = None) -> None:
        made, report = ffi.new("pir_solid **"), ffi.new("pir_report *")
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
            check(lib.pir_solid_create(facets, ffi.NULL, report, made), "vertices or faces", report)
        self._pointer = ffi.gc(made[0], lib.pir_solid_release)

    @classmethod
    def read(cls, path: Any) -> "Solid":
        report, found = ffi.new("pir_report *"), ffi.new("pir_solid **")
        check(lib.pir_solid_read(path_of(path), ffi.NULL, report, found), f"{path}", report)
        made = cls.__new__(cls)
        made._pointer = ffi.gc(found[0], lib.pir_solid_release)
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

    def __repr__(self) -> str:
        info = self._info()
        return f"<Solid: {info.vertices} vertices, {info.facets} facets, volume {info.volume:g}>"

    def __copy__(self) -> "Solid":
        return self

    def __deepcopy__(self, memo: Any) -> "Solid":
        return self


class SolidPair(Handle):
    """Two solids that are asked again and again: their pieces are made once."""

    def __init__(self, p: Union[Solid, Pieces], q: Union[Solid, Pieces]) -> None:
        pieces: Sequence[Pieces] = [x if isinstance(x, Pieces) else x.decompose() for x in (p, q)]
        made, scratch = ffi.new("pir_solid_query **"), ffi.new("pir_workspace **")
        with pieces[0]._held() as a:
            if pieces[0] is pieces[1]:
                check(lib.pir_solid_query_create(a, a, ffi.NULL, made), "SolidPair")
            else:
                with pieces[1]._held() as b:
                    check(lib.pir_solid_query_create(a, b, ffi.NULL, made), "SolidPair")
        super().__init__(made[0], lib.pir_solid_query_destroy)
        check(lib.pir_workspace_create(ffi.NULL, scratch), "SolidPair")
        self._workspace = ffi.gc(scratch[0], lib.pir_workspace_destroy)

    def depth(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None) -> Depths:
        """As of `Solid.depth`."""
        posed, shape = pairs_of_poses(poses_p, poses_q)
        count = len(posed)
        found = np.zeros(count, dtype_of("pir_solid_depth"))
        done = ffi.new("size_t *")
        with self._held() as query:
            status = lib.py_solid_depths(query, self._workspace, pointer(posed), count,
                                         pointer(found, "pir_solid_depth *"), done)
        fail_at(status, "poses_p or poses_q", done[0])
        found = found.reshape(shape)
        return Depths(found["state"].astype(np.uint8), found["depth"].copy(), found["normal"].copy(),
                      found["point_p"].copy(), found["point_q"].copy())

    def __repr__(self) -> str:
        return "<SolidPair>"
