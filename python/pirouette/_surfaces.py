# SPDX-License-Identifier: MIT
"""Triangle meshes and height fields."""
from __future__ import annotations

import math
from typing import Any, Callable, NamedTuple, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import (Bools, Bytes, Floats, Indices, dtype_of, fail_at, floats, indices, number, path_of, pointer, rows,
                      vectors)
from ._check import Handle, InputError, check
from ._native import ffi, lib
from ._pairs import both, pairs_of_poses, set_poses


class RayHits(NamedTuple):
    """The first triangle on each segment: `hit` whether there is one; `triangle` 2^32 - 1 where there is none."""

    hit: Bools
    triangle: Indices
    time: Floats
    point: Floats
    normal: Floats
    back: Bools


class Nearest(NamedTuple):
    """The nearest point of a surface to each point."""

    triangle: Indices
    distance: Floats
    point: Floats


def segments(origins: npt.ArrayLike, ways: npt.ArrayLike) -> Tuple[Floats, Tuple[int, ...]]:
    """Rays as (n, 6); one origin or one way stands for as many as the other has."""
    (a, shape_a), (b, shape_b) = vectors("origins", origins, 3), vectors("ways", ways, 3)
    if shape_a and shape_b and shape_a != shape_b:
        raise InputError(f"ways: there are {len(b)} of them, and {len(a)} origins")
    shape = shape_a or shape_b
    made = np.empty((shape[0] if shape else 1, 6))
    made[:, :3], made[:, 3:] = a, b
    return made, shape


class Surface:
    """What a mesh and a height field have in common."""

    _mesh: Any = None
    _field: Any = None

    def _both(self) -> Tuple[Any, Any]:
        return (ffi.NULL if self._mesh is None else self._mesh, ffi.NULL if self._field is None else self._field)

    def rays(self, origins: npt.ArrayLike, ways: npt.ArrayLike, both_sides: bool = False) -> RayHits:
        """The first triangle that each segment from an origin along a way, to its end, meets; exact."""
        rays, shape = segments(origins, ways)
        found = np.empty(len(rays), dtype_of("pir_ray_hit"))
        done = ffi.new("size_t *")
        sides = lib.PIR_RAY_BOTH if both_sides else lib.PIR_RAY_AS_SURFACE
        status = lib.py_surface_rays(*self._both(), pointer(rays), sides, len(rays), pointer(found, "pir_ray_hit *"),
                                     done)
        fail_at(status, "origins or ways", done[0])
        found = found.reshape(shape)
        triangle = found["triangle"].astype(np.uint32)
        hit = np.asarray(triangle != lib.PIR_TRIANGLE_NONE)
        return RayHits(hit, triangle, np.where(hit, found["time"], math.nan),
                       np.where(hit[..., None], found["point"], math.nan),
                       np.where(hit[..., None], found["normal"], math.nan), hit & found["back"])

    def nearest(self, points: npt.ArrayLike, cutoff: float = math.inf) -> Nearest:
        """The nearest point of the surface to each point; which triangle that is, is exact."""
        array, shape = vectors("points", points, 3)
        found = np.empty(len(array), dtype_of("pir_surface_nearest"))
        done = ffi.new("size_t *")
        status = lib.py_surface_nearest(*self._both(), pointer(array), number("cutoff", cutoff), len(array),
                                        pointer(found, "pir_surface_nearest *"), done)
        fail_at(status, "points", done[0])
        found = found.reshape(shape)
        none = found["triangle"] == lib.PIR_TRIANGLE_NONE
        return Nearest(found["triangle"].astype(np.uint32), np.where(none, math.inf, found["distance"]),
                       np.where(none[..., None], math.nan, found["point"]))


class TriMesh(Surface):
    """Triangles as they are: they need not bound anything.

    >>> mesh = TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> mesh
    <TriMesh: 3 vertices, 1 triangles>
    >>> mesh.rays([0.2, 0.2, 1], [0, 0, -2]).time.tolist()
    0.5
    """

    def __init__(self, vertices: Any, faces: Optional[npt.ArrayLike] = None, two_sided: bool = False) -> None:
        if faces is None:
            if not (hasattr(vertices, "vertices") and hasattr(vertices, "faces")):
                raise InputError("faces: missing, and vertices has no .vertices and .faces")
            vertices, faces = vertices.vertices, vertices.faces
        points, triangles = rows("vertices", vertices, 3), indices("faces", faces, 3)
        arrays = ffi.new("pir_trimesh_arrays *")
        arrays.vertices, arrays.vertex_count = pointer(points, "void *"), len(points)
        arrays.triangles, arrays.triangle_count = pointer(triangles, "uint32_t *"), len(triangles)
        options = ffi.new("pir_trimesh_options *", lib.pir_trimesh_options_default())
        options.two_sided = bool(two_sided)
        report, made = ffi.new("pir_report *"), ffi.new("pir_trimesh **")
        check(lib.pir_trimesh_create(arrays, options, report, made), "vertices or faces", report)
        self._mesh = ffi.gc(made[0], lib.pir_trimesh_release)
        self.two_sided = bool(two_sided)

    @classmethod
    def read(cls, path: Any, two_sided: bool = False) -> "TriMesh":
        options = ffi.new("pir_trimesh_options *", lib.pir_trimesh_options_default())
        options.two_sided = bool(two_sided)
        report, found = ffi.new("pir_report *"), ffi.new("pir_trimesh **")
        check(lib.pir_trimesh_read(path_of(path), options, report, found), f"{path}", report)
        made = cls.__new__(cls)
        made._mesh = ffi.gc(found[0], lib.pir_trimesh_release)
        made.two_sided = bool(two_sided)
        return made

    def _info(self) -> Any:
        info = ffi.new("pir_trimesh_info *")
        lib.pir_trimesh_describe(self._mesh, info)
        return info

    @property
    def closed(self) -> bool:
        return bool(self._info().closed)

    def triangle(self, number_: int) -> Floats:
        """The corners of a triangle, (3, 3)."""
        corners = ffi.new("pir_triangle_corners *")
        if not 0 <= number_ < len(self):
            raise InputError(f"number_: there is no triangle {number_}")
        check(lib.pir_trimesh_triangle(self._mesh, number_, corners), "number_")
        return np.array([[c.x, c.y, c.z] for c in corners.corner])

    @property
    def triangles(self) -> Floats:
        """The corners of all triangles as given, (n, 3, 3)."""
        corners, materials = np.empty((len(self), 3, 3)), np.empty(len(self), np.uint32)
        lib.py_trimesh_triangles(self._mesh, pointer(corners), pointer(materials, "uint32_t *"))
        return corners

    def __len__(self) -> int:
        return int(self._info().triangles)

    def __repr__(self) -> str:
        info = self._info()
        return f"<TriMesh: {info.vertices} vertices, {info.triangles} triangles>"

    def __copy__(self) -> "TriMesh":
        return self

    def __deepcopy__(self, memo: Any) -> "TriMesh":
        return self

    def __reduce__(self) -> "tuple[Callable[..., TriMesh], tuple[Floats, Indices, bool]]":
        """Vertices of one place are one in the copy, those of no triangle are left out; triangles keep numbers."""
        corners = self.triangles
        vertices, at = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
        return TriMesh, (vertices, at.reshape(-1, 3).astype(np.uint32), self.two_sided)


class MeshDistances(NamedTuple):
    """How two meshes stand: `state` 0 apart, 1 they share a point, 2 a part of P is within Q, 3 the reverse."""

    state: Bytes
    distance: Floats
    triangle_p: Indices
    triangle_q: Indices
    point_p: Floats
    point_q: Floats


class MeshPair(Handle):
    """Two triangle meshes at poses. It keeps from pose to pose what bounds can bear, so poses in the order of a motion
    cost least.

    >>> mesh = TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> pair = MeshPair(mesh, mesh)
    >>> pair.nearest([[0, 0, 0, 1, 0, 0, 2], [0, 0, 0, 1, 0, 0, 0]]).distance.tolist()
    [2.0, 0.0]
    >>> pair.within([0, 0, 0, 1, 0, 0, 2], distance=2.5).tolist()
    [[0, 0]]
    """

    def __init__(self, p: TriMesh, q: TriMesh) -> None:
        for name, mesh in (("p", p), ("q", q)):
            if not isinstance(mesh, TriMesh):
                raise InputError(f"{name}: not a TriMesh: {mesh!r}")
        made = ffi.new("pir_trimesh_pair **")
        check(lib.pir_trimesh_pair_create(p._mesh, q._mesh, ffi.NULL, made), "MeshPair")
        super().__init__(made[0], lib.pir_trimesh_pair_destroy)
        many = ffi.new("pir_trimesh_pair_batch **")
        check(lib.pir_trimesh_pair_batch_create(p._mesh, q._mesh, ffi.NULL, many), "MeshPair")
        self._many = ffi.gc(many[0], lib.pir_trimesh_pair_batch_destroy)
        self.p, self.q = p, q

    def nearest(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None) -> MeshDistances:
        """States, least distances, and the triangles and points that have them; which these are is exact."""
        p, q, shape = both(poses_p, poses_q)
        count = shape[0] if shape else 1
        found = MeshDistances(np.empty(count, np.uint8), np.empty(count), np.empty(count, np.uint32),
                              np.empty(count, np.uint32), np.empty((count, 3)), np.empty((count, 3)))
        asked = ffi.new("pir_trimesh_pair_batch_input *")
        set_poses(asked.poses_p, p, len(p) != count)
        if q is not None:
            set_poses(asked.poses_q, q, len(q) != count)
        to, summary = ffi.new("pir_trimesh_pair_batch_arrays *"), ffi.new("pir_pair_batch_summary *")
        for name, kind in (("state", "uint8_t *"), ("distance", "double *"), ("triangle_p", "uint32_t *"),
                           ("triangle_q", "uint32_t *"), ("point_p", "double(*)[3]"), ("point_q", "double(*)[3]")):
            setattr(to, name, pointer(getattr(found, name), kind))
        with self._held():
            check(lib.pir_trimesh_pair_batch_nearest(self._many, asked, count, to, summary), "nearest")
        if summary.bad:
            fail_at(summary.first_status, "poses_p or poses_q", summary.first_bad)
        return MeshDistances(*(values.reshape(shape + values.shape[1:]) for values in found))

    def within(self, pose_p: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
               distance: float = 0.0) -> Indices:
        """All pairs of triangles that are at most `distance` apart, (n, 2); of 0 those that share a point."""
        posed, shape = pairs_of_poses(pose_p, pose_q)
        if shape:
            raise InputError(f"pose_p or pose_q: {len(posed)} poses, not one")
        asked = ffi.new("pir_within_input *", {"distance": number("distance", distance)})
        ffi.memmove(asked, pointer(posed, "char *"), posed.nbytes)
        count, capacity = ffi.new("size_t *"), 256
        with self._held() as pair:
            while True:
                found = np.empty((capacity, 2), np.uint32)
                check(lib.pir_trimesh_pair_within(pair, asked, capacity, pointer(found, "pir_triangle_pair *"), count),
                      "distance or pose")
                if count[0] <= capacity:
                    return found[:count[0]].copy()
                capacity = count[0]

    def __enter__(self) -> "MeshPair":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<MeshPair: {self.p!r}, {self.q!r}>"


class HeightField(Surface):
    """A grid of heights over z = 0, (rows, columns), `step` apart.

    >>> HeightField([[0, 0, 1], [0, 1, 1]], step=0.5)
    <HeightField: 2 by 3 heights>
    """

    def __init__(self, heights: npt.ArrayLike, step: Any = 1.0, two_sided: bool = False) -> None:
        array = floats("heights", heights)
        if array.ndim != 2:
            raise InputError(f"heights: its shape is {array.shape}, not (rows, columns)")
        steps = np.broadcast_to(floats("step", step), (2,)) if np.size(step) in (1, 2) else None
        if steps is None:
            raise InputError("step: not one number, nor two")
        self._heights, self._step, self._two_sided = array.copy(), (float(steps[0]), float(steps[1])), bool(two_sided)
        samples = ffi.new("pir_height_samples *")
        samples.heights, (samples.rows, samples.columns) = pointer(array, "void *"), array.shape
        samples.step_x, samples.step_y = self._step
        options = ffi.new("pir_height_options *", lib.pir_height_options_default())
        options.two_sided = self._two_sided
        report, made = ffi.new("pir_report *"), ffi.new("pir_height_field **")
        check(lib.pir_height_field_create(samples, options, report, made), "heights", report)
        self._field = ffi.gc(made[0], lib.pir_height_field_release)

    @property
    def heights(self) -> Floats:
        return self._heights.copy()

    def __repr__(self) -> str:
        return f"<HeightField: {self._heights.shape[0]} by {self._heights.shape[1]} heights>"

    def __reduce__(self) -> Tuple[Callable[..., "HeightField"], Tuple[Floats, Tuple[float, float], bool]]:
        return HeightField, (self._heights, self._step, self._two_sided)

    def __copy__(self) -> "HeightField":
        return self

    def __deepcopy__(self, memo: Any) -> "HeightField":
        return self
