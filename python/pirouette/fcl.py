# SPDX-License-Identifier: MIT
"""The calls of python-fcl that trimesh's CollisionManager makes, on Pirouette: ``import pirouette.fcl as fcl``.

States and nearest triangles are exact. Where it differs from FCL: `min_distance` of convex bodies that overlap is minus
their depth, and that of meshes that meet is 0; a contact of two triangles lies in the middle of what they share, and
its depth is the least length by which one passes through the plane of the other. A body within a closed mesh, or within
a convex body, collides with it, and has one contact. Of geometries there are `BVHModel`, `Convex` and `Box`.

>>> box = CollisionObject(Box(1, 1, 1), Transform([0.75, 0, 0]))
>>> result = CollisionResult()
>>> collide(CollisionObject(Box(1, 1, 1)), box, CollisionRequest(num_max_contacts=9, enable_contact=True), result)
4
>>> sorted({round(contact.penetration_depth, 12) for contact in result.contacts})
[0.25]
"""
from __future__ import annotations

from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, floats
from ._check import InputError
from ._pairs import Pair
from ._polytopes import Polytope
from ._surfaces import MeshPair, TriMesh


# How many pairs a manager keeps from call to call.
PAIRS_KEPT = 4096


class CollisionGeometry:
    """A body: triangles, and where it is convex a polytope."""

    _mesh: Optional[TriMesh] = None
    _polytope: Optional[Polytope] = None
    _corners: Floats

    def _set(self, vertices: Any, triangles: Any, polytope: Optional[Polytope]) -> None:
        self._mesh, self._polytope = TriMesh(vertices, triangles, two_sided=True), polytope
        self._corners = floats("vertices", vertices)[np.asarray(triangles)]
        self._low, self._high = self._corners.min(axis=(0, 1)), self._corners.max(axis=(0, 1))


class BVHModel(CollisionGeometry):
    """Triangles, of which nothing is asked: they need not bound anything."""

    def beginModel(self, num_tris_: int = 0, num_vertices_: int = 0) -> None:
        self._parts: List[Tuple[Floats, npt.NDArray[np.int64]]] = []

    def addSubModel(self, verts: npt.ArrayLike, triangles: npt.ArrayLike) -> None:
        self._parts.append((floats("verts", verts), np.asarray(triangles, np.int64)))

    def addVertex(self, x: float, y: float, z: float) -> None:
        self._parts.append((np.array([[x, y, z]]), np.empty((0, 3), np.int64)))

    def addTriangle(self, v1: npt.ArrayLike, v2: npt.ArrayLike, v3: npt.ArrayLike) -> None:
        self._parts.append((floats("v1, v2, v3", [v1, v2, v3]), np.array([[0, 1, 2]])))

    def endModel(self) -> None:
        starts = np.cumsum([0, *(len(vertices) for vertices, _ in self._parts)])
        triangles = np.concatenate([part + start for (_, part), start in zip(self._parts, starts)])
        self._set(np.concatenate([vertices for vertices, _ in self._parts]), triangles, None)


class Convex(CollisionGeometry):
    """The hull of vertices. `faces` has the count of corners before each face's, as FCL wants them."""

    def __init__(self, vertices: npt.ArrayLike, num_faces: int = 0, faces: Optional[npt.ArrayLike] = None) -> None:
        polytope = Polytope(vertices)
        self._set(polytope.vertices, polytope.faces, polytope)


class Box(Convex):
    def __init__(self, x: float, y: float, z: float) -> None:
        super().__init__([[i * x / 2, j * y / 2, k * z / 2] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])


class Transform:
    """A rotation, a matrix or a quaternion w, x, y, z as FCL has it, and a translation; either alone too."""

    def __init__(self, *args: Any) -> None:
        self._pose = np.array([0.0, 0, 0, 1, 0, 0, 0])
        for arg in args:
            if isinstance(arg, Transform):
                self._pose = arg._pose.copy()
                continue
            array = floats("rotation or translation", arg)
            if array.shape == (3,):
                self._pose[4:] = array
            else:
                self.setRotation(array)

    def setRotation(self, rotation: npt.ArrayLike) -> None:
        array = floats("rotation", rotation)
        if array.shape == (4,):
            self._pose[:4] = np.roll(array, -1)
        elif array.shape == (3, 3):
            from ._arrays import poses
            matrix = np.eye(4)
            matrix[:3, :3] = array
            self._pose[:4] = poses("rotation", matrix)[0][0, :4]
        else:
            raise InputError(f"rotation: its shape is {array.shape}, not (3, 3) or (4,)")

    def setTranslation(self, translation: npt.ArrayLike) -> None:
        self._pose[4:] = floats("translation", translation)

    def setQuatRotation(self, quaternion: npt.ArrayLike) -> None:
        self.setRotation(quaternion)

    def getRotation(self) -> Floats:
        x, y, z, w = self._pose[:4] / np.linalg.norm(self._pose[:4])
        return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])

    def getQuatRotation(self) -> Floats:
        return np.roll(self._pose[:4], 1)

    def getTranslation(self) -> Floats:
        return self._pose[4:].copy()


class CollisionObject(Transform):
    """A geometry in its place."""

    def __init__(self, geom: CollisionGeometry, tf: Optional[Transform] = None) -> None:
        if not isinstance(geom, CollisionGeometry) or geom._mesh is None:
            raise InputError(f"geom: not a finished geometry: {geom!r}")
        super().__init__(*([] if tf is None else [tf]))
        self._geom = geom

    def setTransform(self, tf: Transform) -> None:
        self._pose = tf._pose.copy()

    def getTransform(self) -> Transform:
        return Transform(self)

    def _box(self) -> Tuple[Floats, Floats]:
        """A box around it in the world, a little larger than need be."""
        turn, geom = self.getRotation(), self._geom
        middle = turn @ ((geom._low + geom._high) / 2) + self._pose[4:]
        reach = np.abs(turn) @ ((geom._high - geom._low) / 2)
        more = 1e-9 * (np.abs(middle).max() + reach.max())
        return middle - reach - more, middle + reach + more

    def _triangle(self, index: int) -> Floats:
        made: Floats = self._geom._corners[index] @ self.getRotation().T + self._pose[4:]
        return made


class CollisionRequest:
    def __init__(self, num_max_contacts: int = 1, enable_contact: bool = False, *args: Any, **others: Any) -> None:
        self.num_max_contacts, self.enable_contact = num_max_contacts, enable_contact


class Contact:
    """`o1`, `o2` are geometries, `b1`, `b2` triangles; `normal` points from the first body to the second."""

    def __init__(self, objects: Tuple[CollisionObject, CollisionObject], triangles: Tuple[int, int], pos: Floats,
                 normal: Floats, depth: float) -> None:
        self.o1, self.o2 = objects[0]._geom, objects[1]._geom
        self.b1, self.b2 = triangles
        self.pos, self.normal, self.penetration_depth = pos, normal, depth


class CollisionResult:
    def __init__(self) -> None:
        self.is_collision = False
        self.contacts: List[Contact] = []


class DistanceRequest:
    def __init__(self, enable_nearest_points: bool = False, *args: Any, **others: Any) -> None:
        self.enable_nearest_points = enable_nearest_points


class DistanceResult:
    def __init__(self, min_distance_: float = float("inf")) -> None:
        self.min_distance = min_distance_
        self.o1: Optional[CollisionGeometry] = None
        self.o2: Optional[CollisionGeometry] = None
        self.b1 = self.b2 = -1
        self.nearest_points: List[Floats] = []


class CollisionData:
    def __init__(self, request: Optional[CollisionRequest] = None, result: Optional[CollisionResult] = None) -> None:
        self.request = CollisionRequest() if request is None else request
        self.result = CollisionResult() if result is None else result
        self.done = False


class DistanceData:
    def __init__(self, request: Optional[DistanceRequest] = None, result: Optional[DistanceResult] = None) -> None:
        self.request = DistanceRequest() if request is None else request
        self.result = DistanceResult() if result is None else result
        self.done = False


# --- two bodies ---


def _crossings(a: Floats, b: Floats) -> Iterator[Floats]:
    """The points where sides of triangle a cross triangle b."""
    n = np.cross(b[1] - b[0], b[2] - b[0])
    above = (a - b[0]) @ n
    for i in range(3):
        j = (i + 1) % 3
        if above[i] * above[j] < 0:
            at = a[i] + (a[j] - a[i]) * (above[i] / (above[i] - above[j]))
            if all(np.cross(b[(k + 1) % 3] - b[k], at - b[k]) @ n >= -1e-12 * (n @ n) for k in range(3)):
                yield at


def _unit(n: Floats) -> Floats:
    length = float(np.linalg.norm(n))
    return n / length if length > 0 else n


def _triangle_contact(objects: Tuple[CollisionObject, CollisionObject], p: int, q: int) -> Contact:
    a, b = objects[0]._triangle(p), objects[1]._triangle(q)
    found = [*_crossings(a, b), *_crossings(b, a)]
    pos = np.mean(found, axis=0) if found else (a.mean(axis=0) + b.mean(axis=0)) / 2
    ways = []
    for one, other, sign in ((a, b, -1.0), (b, a, 1.0)):
        n = _unit(np.cross(other[1] - other[0], other[2] - other[0]))
        ways.append((max(0.0, -float(((one - other[0]) @ n).min())), sign * n))
    depth, normal = min(ways, key=lambda way: way[0])
    return Contact(objects, (p, q), pos, normal, depth)


def _pair_of(cache: Dict[Any, Any], kind: Any, a: Any, b: Any) -> Any:
    key = (id(a), id(b))  # pairs hold their bodies, so no other body has these
    if key not in cache:
        if len(cache) >= PAIRS_KEPT:
            cache.clear()
        cache[key] = kind(a, b)
    return cache[key]


def _collide(a: CollisionObject, b: CollisionObject, most: int, cache: Dict[Any, Any]) -> Tuple[bool, List[Contact]]:
    """Whether two bodies share a point, and contacts, `most` of them at most."""
    p, q = a._geom, b._geom
    if p._polytope is not None and q._polytope is not None:
        pair = _pair_of(cache, Pair, p._polytope, q._polytope)
        if pair.states(a._pose, b._pose) == 0:
            return False, []
        found = pair.contacts(a._pose, b._pose) if most else None
        return True, [] if found is None else [
            Contact((a, b), (0, 0), (x + y) / 2, -found.normal[0], -float(d))
            for x, y, d in zip(found.point_p[:most], found.point_q[:most], found.distance[:most])]
    pair = _pair_of(cache, MeshPair, p._mesh, q._mesh)
    near = pair.nearest(a._pose, b._pose)
    if near.state == 0:
        return False, []
    if not most:
        return True, []
    if near.state == 1:
        return True, [_triangle_contact((a, b), int(i), int(j)) for i, j in pair.within(a._pose, b._pose)[:most]]
    way = _unit(near.point_q - near.point_p)
    return True, [Contact((a, b), (int(near.triangle_p), int(near.triangle_q)), near.point_p, way,
                          float(near.distance))]


def collide(o1: CollisionObject, o2: CollisionObject, request: Optional[CollisionRequest] = None,
            result: Optional[CollisionResult] = None) -> int:
    """Fills the result, and gives the number of contacts; without contacts 1 where the bodies share a point."""
    data = CollisionData(request, result)
    before = len(data.result.contacts)
    defaultCollisionCallback(o1, o2, data, {})
    return len(data.result.contacts) - before or int(data.result.is_collision)


def distance(o1: CollisionObject, o2: CollisionObject, request: Optional[DistanceRequest] = None,
             result: Optional[DistanceResult] = None) -> float:
    data = DistanceData(request, result)
    defaultDistanceCallback(o1, o2, data, {})
    return data.result.min_distance


def defaultCollisionCallback(o1: CollisionObject, o2: CollisionObject, cdata: CollisionData,
                             cache: Optional[Dict[Any, Any]] = None) -> bool:
    """Adds what two bodies have to the result; true where nothing more is wanted."""
    request, result = cdata.request, cdata.result
    room = max(0, request.num_max_contacts - len(result.contacts))
    meets, contacts = _collide(o1, o2, room if request.enable_contact else 0, {} if cache is None else cache)
    result.is_collision = result.is_collision or meets
    result.contacts += contacts
    cdata.done = result.is_collision and (not request.enable_contact or
                                          len(result.contacts) >= request.num_max_contacts)
    return cdata.done


def defaultDistanceCallback(o1: CollisionObject, o2: CollisionObject, ddata: DistanceData,
                            cache: Optional[Dict[Any, Any]] = None) -> Tuple[bool, float]:
    """Takes the distance of two bodies where it is less than what there was."""
    p, q, result = o1._geom, o2._geom, ddata.result
    pairs = {} if cache is None else cache
    found: Any
    if p._polytope is not None and q._polytope is not None:
        found = _pair_of(pairs, Pair, p._polytope, q._polytope).signed_distance(o1._pose, o2._pose)
        least, triangles = float(found.distance), (0, 0)
    else:
        found = _pair_of(pairs, MeshPair, p._mesh, q._mesh).nearest(o1._pose, o2._pose)
        least = 0.0 if found.state else float(found.distance)
        triangles = (int(found.triangle_p), int(found.triangle_q))
    if least < result.min_distance:
        result.min_distance, result.o1, result.o2 = least, p, q
        result.b1, result.b2 = triangles
        if ddata.request.enable_nearest_points:
            result.nearest_points = [np.array(found.point_p), np.array(found.point_q)]
    return ddata.done, result.min_distance


# --- many bodies ---


class DynamicAABBTreeCollisionManager:
    """Bodies, asked among themselves, against one, or against those of another manager."""

    def __init__(self) -> None:
        self._objects: List[CollisionObject] = []
        self._cache: Dict[Any, Any] = {}

    def setup(self) -> None:
        """There is nothing to set up."""

    def update(self, arg: Any = None) -> None:
        """There is nothing to update: boxes are made when they are asked for."""

    def registerObject(self, obj: CollisionObject) -> None:
        self._objects.append(obj)

    def registerObjects(self, other_objs: List[CollisionObject]) -> None:
        self._objects += other_objs

    def unregisterObject(self, obj: CollisionObject) -> None:
        self._objects = [one for one in self._objects if one is not obj]
        self._cache.clear()

    def clear(self) -> None:
        self._objects, self._cache = [], {}

    def getObjects(self) -> List[CollisionObject]:
        return list(self._objects)

    def empty(self) -> bool:
        return not self._objects

    def size(self) -> int:
        return len(self._objects)

    def _pairs(self, other: Any) -> Iterator[Tuple[CollisionObject, CollisionObject, float]]:
        """All pairs to be asked about, with the distance of their boxes, the nearest boxes first."""
        if other is None:
            first, second = np.triu_indices(len(self._objects), 1)
            others = self._objects
        else:
            others = [other] if isinstance(other, CollisionObject) else other._objects
            first, second = (index.ravel() for index in np.indices((len(self._objects), len(others))))
        if len(first) == 0:
            return
        low_p, high_p = (np.array(x) for x in zip(*(obj._box() for obj in self._objects)))
        low_q, high_q = (np.array(x) for x in zip(*(obj._box() for obj in others)))
        gap = np.maximum(0, np.maximum(low_q[second] - high_p[first], low_p[first] - high_q[second]))
        apart = np.linalg.norm(gap, axis=1)
        for i in np.argsort(apart, kind="stable"):
            a, b = self._objects[first[i]], others[second[i]]
            yield a, b, float(apart[i])

    def collide(self, *args: Any) -> None:
        """`collide(data, callback)`, `collide(object, data, callback)` or `collide(manager, data, callback)`."""
        other, data, callback = (None, *args) if len(args) == 2 else args
        for a, b, apart in self._pairs(other):
            if apart > 0 or _called(callback, defaultCollisionCallback, a, b, data, self._cache):
                return

    def distance(self, *args: Any) -> None:
        """`distance(data, callback)`, `distance(object, data, callback)` or `distance(manager, data, callback)`."""
        other, data, callback = (None, *args) if len(args) == 2 else args
        for a, b, apart in self._pairs(other):
            if apart > data.result.min_distance or (apart > 0 and data.result.min_distance <= 0):
                return
            if _called(callback, defaultDistanceCallback, a, b, data, self._cache)[0]:
                return


def _called(callback: Callable[..., Any], known: Callable[..., Any], a: CollisionObject, b: CollisionObject,
            data: Any, cache: Dict[Any, Any]) -> Any:
    """Our own callbacks use the pairs that a manager keeps."""
    return known(a, b, data, cache) if callback is known else callback(a, b, data)

