# SPDX-License-Identifier: MIT
"""Scenes: many bodies, of which only what is asked for is computed."""
from __future__ import annotations

from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Bytes, Floats, Indices, dtype_of, fail_at, indices, number, pointer, poses, vectors, whole
from ._check import Handle, InputError, check, error
from ._motions import FirstContact, exact_motion, first_contact_of
from ._native import ffi, lib
from ._pairs import Impact, impact_of, motion_between
from ._polytopes import Body, Polytope, as_polytope
from ._shapes import Shape
from ._solids import Pieces, Solid
from ._surfaces import HeightField, TriMesh, segments

BEGAN, PERSISTED, ENDED = 0, 1, 2
Form = Union[Body, Shape, Solid, Pieces, TriMesh, HeightField, Sequence[Polytope]]

_KINDS = {"moving": lib.PIR_BODY_MOVING, "kinematic": lib.PIR_BODY_KINEMATIC, "static": lib.PIR_BODY_STATIC}
_DETAILS = {"states": lib.PIR_SCENE_STATES, "depths": lib.PIR_SCENE_DEPTHS, "manifolds": lib.PIR_SCENE_MANIFOLDS}


class Events(NamedTuple):
    """The findings of an update, an element for each two pieces: `kind` 0 began, 1 persisted, 2 ended. Contacts of
    event i are the elements ``starts[i]:starts[i + 1]`` of the `contact_` arrays. `error` is how far bodies have moved
    since what is told was found: 0 but in a scene with `reuse`."""

    kind: Bytes
    body_p: Indices
    body_q: Indices
    piece_p: Indices
    piece_q: Indices
    sensor: Bools
    state: Bytes
    distance: Floats
    normal: Floats
    starts: "npt.NDArray[np.uint64]"
    contact_point_p: Floats
    contact_point_q: Floats
    contact_distance: Floats
    contact_id: "npt.NDArray[np.uint64]"
    user_p: "npt.NDArray[np.uint64]"
    user_q: "npt.NDArray[np.uint64]"
    error: Floats


class SceneImpacts(NamedTuple):
    """What fast bodies have met first on the way to the poses of the last update, an element for each that did: the
    `body`, what it met, and at which part of the way."""

    body: Indices
    met: Indices
    piece: Indices
    time: Floats
    point: Floats
    normal: Floats


class BodyState(NamedTuple):
    """All that a scene knows of a body; `pieces` is 0 of a surface."""

    kind: str
    pose: Floats
    radius: float
    pieces: int
    category: int
    mask: int
    sensor: bool
    disabled: bool
    user: int


class SceneHits(NamedTuple):
    """The first body on each segment: `hit` whether there is one, `body` and `piece` which."""

    hit: Bools
    body: Indices
    piece: Indices
    time: Floats
    point: Floats
    normal: Floats


class Scene(Handle):
    """Bodies that move, and their contacts.

    >>> scene = Scene()
    >>> floor = scene.add(TriMesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]]), kind="static")
    >>> box = scene.add(Polytope.shape("cube"), pose=[0, 0, 0, 1, 0, 0, 5])
    >>> scene.set_poses([box], [[0, 0, 0, 1, 0, 0, 0.25]])
    >>> events = scene.update()
    >>> events.kind.tolist(), events.distance.tolist(), len(events.contact_distance)
    ([0], [-0.25], 4)
    >>> scene.rays([0, 0, 9], [0, 0, -20]).body.tolist() == box
    True
    """

    def __init__(self, detail: str = "manifolds", margin: float = 0.0, threads: int = 1, unions: bool = False,
                 reuse: float = 0.0) -> None:
        if detail not in _DETAILS:
            raise InputError(f"detail: it is {detail!r}, not one of {', '.join(_DETAILS)}")
        options = ffi.new("pir_scene_options *", lib.pir_scene_options_default())
        options.detail, options.margin = _DETAILS[detail], number("margin", margin)
        options.threads, options.unions = whole("threads", threads, 1, 64), bool(unions)
        options.reuse = number("reuse", reuse)
        self._report = ffi.new("pir_report *")
        options.report = self._report
        made = ffi.new("pir_scene **")
        check(lib.pir_scene_create(options, made), "Scene", self._report)
        super().__init__(made[0], lib.pir_scene_destroy)
        self._moves: Dict[int, Floats] = {}

    def add(self, body: Form, pose: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), kind: str = "moving", *,
            radius: Optional[float] = None, category: int = 1, mask: int = 2**32 - 1, sensor: bool = False,
            disabled: bool = False, user: int = 0, fast: float = 0.0) -> int:
        """Adds a body and gives its id, which no other body of the scene ever has. A list of polytopes, `Pieces` or a
        `Solid` is one body of several pieces; a `TriMesh` or a `HeightField` is static or kinematic; a `Shape` has its
        own radius.

        category, mask  bits: of what it is, of what it meets. Both of two bodies have to match.
        sensor          told of what overlaps it, without contacts; disabled: meets nothing, and no query sees it.
        user            a number of yours, which events and `state` tell.
        fast            above 0, updates tell what it meets on its way within this tolerance: `impacts`.
        """
        if kind not in _KINDS:
            raise InputError(f"kind: it is {kind!r}, not one of {', '.join(_KINDS)}")
        at, shape = poses("pose", pose)
        if shape:
            raise InputError("pose: it is not one pose")
        options = ffi.new("pir_body_options *", lib.pir_body_options_default())
        options.kind, options.radius = _KINDS[kind], number("radius", 0 if radius is None else radius)
        options.category, options.mask = whole("category", category, 0, 2**32 - 1), whole("mask", mask, 0, 2**32 - 1)
        options.sensor, options.disabled = bool(sensor), bool(disabled)
        options.user, options.fast = whole("user", user, 0, 2**64 - 1), number("fast", fast)
        ffi.memmove(ffi.addressof(options, "pose"), pointer(at, "char *"), 56)
        kept = self._set_form(options, body, radius)
        number_ = ffi.new("uint32_t *")
        with self._held() as scene:
            check(lib.pir_scene_add(scene, options, number_), "body or pose", self._report)
        del kept
        return int(number_[0])

    @staticmethod
    def _set_form(options: Any, body: Any, radius: Optional[float]) -> List[Any]:
        """Sets the pieces or the surface, and gives what must live until the call."""
        if isinstance(body, Shape):
            form = lib.pir_body_shape_options(body._pointer)
            options.pieces, options.piece_count = form.pieces, form.piece_count
            options.mesh, options.field = form.mesh, form.field
            if radius is None:
                options.radius = form.radius
            return [body]
        if isinstance(body, TriMesh):
            options.mesh = body._mesh
            return [body]
        if isinstance(body, HeightField):
            options.field = body._field
            return [body]
        if isinstance(body, Solid):
            body = body.decompose()
        if isinstance(body, Pieces):
            pieces = body.polytopes()
        elif isinstance(body, (list, tuple)) and body and all(isinstance(piece, Polytope) for piece in body):
            pieces = list(body)
        else:
            pieces = [as_polytope("body", body)]
        array = ffi.new("pir_polytope *[]", [piece._pointer for piece in pieces])
        options.pieces, options.piece_count = array, len(pieces)
        return [*pieces, array]

    def remove(self, body: int) -> None:
        at = whole("body", body, 0, 2**32 - 1)
        with self._held() as scene:
            check(lib.pir_scene_remove(scene, at), "body", self._report)
        self._moves.pop(at, None)

    # --- bodies that change ---

    def _change(self, call: Any, body: int, *values: Any) -> None:
        at = whole("body", body, 0, 2**32 - 1)
        with self._held() as scene:
            check(call(scene, at, *values), "body", self._report)

    def set_filter(self, body: int, category: int, mask: int) -> None:
        """What a body is, and what it meets. Contacts that are no more have ended with the next update."""
        bits = whole("category", category, 0, 2**32 - 1), whole("mask", mask, 0, 2**32 - 1)
        self._change(lib.pir_scene_set_filter, body, *bits)

    def set_sensor(self, body: int, sensor: bool = True) -> None:
        self._change(lib.pir_scene_set_sensor, body, bool(sensor))

    def disable(self, body: int) -> None:
        """It keeps its id and may be moved, meets nothing, and no query sees it."""
        self._change(lib.pir_scene_set_disabled, body, True)

    def enable(self, body: int) -> None:
        self._change(lib.pir_scene_set_disabled, body, False)

    def set_user(self, body: int, user: int) -> None:
        """Gives a body another number of yours."""
        self._change(lib.pir_scene_set_user, body, whole("user", user, 0, 2**64 - 1))

    def state(self, body: int) -> BodyState:
        """All that the scene knows of a body, as of the last update."""
        found, pose = ffi.new("pir_body_state *"), self.pose(body)
        self._change(lib.pir_scene_get_body, body, found)
        kind = next(name for name, value in _KINDS.items() if value == found.kind)
        return BodyState(kind, pose, found.radius, found.piece_count, found.category, found.mask, bool(found.sensor),
                         bool(found.disabled), found.user)

    def pose(self, body: int) -> Floats:
        """Where a body is since the last update, (7,)."""
        found, made = ffi.new("pir_pose *"), np.empty(7)
        with self._held() as scene:
            check(lib.pir_scene_pose(scene, whole("body", body, 0, 2**32 - 1), found), "body", self._report)
        ffi.memmove(pointer(made, "char *"), found, 56)
        return made

    def set_poses(self, bodies: npt.ArrayLike, new: npt.ArrayLike) -> None:
        """Poses that the next update brings the bodies to; of a body that comes twice the last counts."""
        numbers, (array, _) = indices("bodies", bodies), poses("new", new)
        if len(numbers) != len(array):
            raise InputError(f"new: {len(array)} poses of {len(numbers)} bodies")
        with self._held() as scene:
            for body in numbers.tolist():
                if not lib.pir_scene_has(scene, body):
                    raise InputError(f"bodies: there is no body {body}")
        self._moves.update(zip(numbers.tolist(), array.copy()))

    def update(self) -> Events:
        """Brings the bodies to their new poses and tells what happened. Where it fails all stays as it was, and the
        poses that were set are forgotten."""
        moves = np.empty(len(self._moves), dtype_of("pir_scene_move"))
        if self._moves:
            numbers, array = zip(*self._moves.items())
            stacked = np.array(array)
            moves["body"] = numbers
            moves["pose"]["rotation"], moves["pose"]["translation"] = stacked[:, :4], stacked[:, 4:]
        self._moves = {}
        with self._held() as scene:
            check(lib.pir_scene_update(scene, pointer(moves, "pir_scene_move *"), len(moves)), "update", self._report)
            return self._events(scene)

    @staticmethod
    def _events(scene: Any) -> Events:
        count = ffi.new("size_t *")
        first = lib.pir_scene_events(scene, count)
        found = np.empty(count[0], dtype_of("pir_scene_event"))
        if count[0]:
            ffi.memmove(pointer(found, "char *"), first, found.nbytes)
        starts = np.zeros(count[0] + 1, np.uint64)
        contacts = np.empty(lib.py_scene_contact_count(scene), dtype_of("pir_contact"))
        lib.py_scene_contacts(scene, pointer(starts, "uint64_t *"), pointer(contacts, "pir_contact *"))
        plain = {name: found[name].astype(kind) for name, kind in (
            ("kind", np.uint8), ("body_p", np.uint32), ("body_q", np.uint32), ("piece_p", np.uint32),
            ("piece_q", np.uint32), ("sensor", np.bool_), ("state", np.uint8), ("distance", float), ("normal", float),
            ("user_p", np.uint64), ("user_q", np.uint64), ("error", float))}
        return Events(**plain, starts=starts, contact_point_p=contacts["point_p"].copy(),
                      contact_point_q=contacts["point_q"].copy(), contact_distance=contacts["distance"].copy(),
                      contact_id=contacts["id"].copy())

    def impacts(self) -> SceneImpacts:
        """What the fast bodies that the last update moved have met on their way."""
        count = ffi.new("size_t *")
        with self._held() as scene:
            first = lib.pir_scene_impacts(scene, count)
            found = np.empty(count[0], dtype_of("pir_scene_impact"))
            if count[0]:
                ffi.memmove(pointer(found, "char *"), first, found.nbytes)
        way = found["impact"]
        return SceneImpacts(found["body"].astype(np.uint32), way["body"].astype(np.uint32),
                            way["piece_q"].astype(np.uint32), way["time"].copy(), way["point"].copy(),
                            way["normal"].copy())

    # --- questions ---

    def rays(self, origins: npt.ArrayLike, ways: npt.ArrayLike, mask: int = 2**32 - 1, *, radius: float = 0.0,
             ignored: npt.ArrayLike = (), both_sides: bool = False) -> SceneHits:
        """The first body that each segment from an origin along a way, to its end, meets; with a radius, that a ball
        meets which goes along it: `point` is then where it touches. Bodies whose ids are `ignored` are left out."""
        rays, shape = segments(origins, ways)
        options = ffi.new("pir_scene_ray_options *", lib.pir_scene_ray_options_default())
        options.mask, options.radius = whole("mask", mask, 0, 2**32 - 1), number("radius", radius)
        options.sides = lib.PIR_RAY_BOTH if both_sides else lib.PIR_RAY_AS_SURFACE
        out = indices("ignored", ignored)
        options.filter = left_out = _filter(out)
        found = np.empty(len(rays), dtype_of("pir_impact"))
        with self._held() as scene:
            status = lib.pir_scene_ray_batch(scene, pointer(rays, "pir_scene_segment *"), len(rays), options,
                                             pointer(found, "pir_impact *"))
        del left_out
        if status == lib.PIR_ERR_NOT_FINITE and not np.isfinite(rays).all():
            fail_at(status, "origins or ways", int(np.isfinite(rays).all(axis=1).argmin()))
        check(status, "origins, ways or radius", self._report)
        return _hits_of(found.reshape(shape))

    def cast(self, shape: Body, a: npt.ArrayLike, b: npt.ArrayLike, *, tolerance: float = 1e-6, radius: float = 0.0,
             mask: int = 2**32 - 1, ignored: npt.ArrayLike = ()) -> "tuple[int, Impact]":
        """The first body that a shape comes within `tolerance` of, moved from pose `a` to pose `b` at constant speed:
        its id, -1 for none, and the impact."""
        asked, motion, kept = _way(shape, a, b, radius, mask, ignored)
        found = ffi.new("pir_impact *")
        with self._held() as scene:
            check(lib.pir_scene_cast(scene, asked, motion, number("tolerance", tolerance), found),
                  "shape, pose or tolerance", self._report)
        del kept
        return (-1 if found.body == lib.PIR_SCENE_NONE else int(found.body)), impact_of(found)

    def cast_all(self, shape: Body, a: npt.ArrayLike, b: npt.ArrayLike, *, tolerance: float = 1e-6,
                 radius: float = 0.0, mask: int = 2**32 - 1, ignored: npt.ArrayLike = ()) -> SceneHits:
        """All pieces of bodies that a shape comes within `tolerance` of, moved from pose `a` to pose `b`, each as if
        the others were not there: first the one that `cast` tells, then by time."""
        asked, motion, kept = _way(shape, a, b, radius, mask, ignored)
        found = _all("pir_impact", lambda capacity, room, count: self._check(
            lib.pir_scene_cast_all, "shape, pose or tolerance", asked, motion, number("tolerance", tolerance),
            capacity, room, count))
        del kept
        return _hits_of(found)

    def in_box(self, low: npt.ArrayLike, high: npt.ArrayLike, *, mask: int = 2**32 - 1,
               ignored: npt.ArrayLike = ()) -> "tuple[Indices, Indices]":
        """Ids and pieces of all bodies whose boxes along the axes meet the box between two corners: nothing else of
        them is looked at. Corners may be infinite."""
        (least, _), (most, _), out = vectors("low", low, 3), vectors("high", high, 3), indices("ignored", ignored)
        if len(least) != 1 or len(most) != 1:
            raise InputError("low or high: it is not one point")
        corners = np.concatenate([least, most])
        left_out = _filter(out)
        box = ffi.new("pir_scene_box *", {"mask": whole("mask", mask, 0, 2**32 - 1), "except": lib.PIR_SCENE_NONE,
                                          "filter": left_out})
        ffi.memmove(box, pointer(corners, "char *"), 48)
        found = _all("pir_scene_part", lambda capacity, room, count: self._check(
            lib.pir_scene_in_box, "low or high", box, capacity, room, count))
        del left_out
        return found["body"].astype(np.uint32), found["piece"].astype(np.uint32)

    def first_contact(self, body: int, *, axis: npt.ArrayLike = (0, 0, 0), degrees: float = 0.0,
                      pivot: npt.ArrayLike = (0, 0, 0), way: npt.ArrayLike = (0, 0, 0)) -> "tuple[int, FirstContact]":
        """When a body first touches another that it may meet, all others at rest, exactly, as of `Pair.first_contact`:
        the id of the other one, -1 for none, and the contact."""
        motion, found = exact_motion(axis, degrees, pivot, way), ffi.new("pir_exact_impact *")
        mover = whole("body", body, 0, 2**32 - 1)
        with self._held() as scene:
            check(lib.pir_scene_first_contact(scene, mover, motion, found), "body or motion", self._report)
        other = found.impact.body
        return (-1 if other == lib.PIR_SCENE_NONE else int(other)), first_contact_of(found)

    def overlaps(self, shape: Body, pose: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *, radius: float = 0.0,
                 mask: int = 2**32 - 1, ignored: npt.ArrayLike = ()) -> "tuple[Indices, Indices]":
        """Ids and pieces of all bodies that share a point with a shape."""
        (at, _), out = poses("pose", pose), indices("ignored", ignored)
        asked, kept = _shape(shape, at, radius, mask, out)
        found = _all("pir_scene_hit", lambda capacity, room, count: self._check(
            lib.pir_scene_overlap, "shape or pose", asked, capacity, room, count))
        del kept
        return found["body"].astype(np.uint32), found["piece"].astype(np.uint32)

    def nearest(self, shape: Body, pose: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), cutoff: float = np.inf,
                most: int = 1, *, radius: float = 0.0, mask: int = 2**32 - 1,
                ignored: npt.ArrayLike = ()) -> "list[tuple[int, int, float]]":
        """The bodies nearest to a shape: id, piece and signed distance, nearest first."""
        (at, _), out = poses("pose", pose), indices("ignored", ignored)
        asked, kept = _shape(shape, at, radius, mask, out)
        room = whole("most", most, 1, 2**20)
        found, count = ffi.new("pir_scene_near[]", room), ffi.new("size_t *")
        with self._held() as scene:
            check(lib.pir_scene_nearest(scene, asked, number("cutoff", cutoff), room, found, count), "shape",
                  self._report)
        del kept
        return [(n.body_q, n.piece_q, n.result.distance) for n in found[0:count[0]]]

    def _check(self, call: Any, where: str, *arguments: Any) -> None:
        with self._held() as scene:
            check(call(scene, *arguments), where, self._report)

    # --- states in bytes ---

    def snapshot(self) -> bytes:
        """Which bodies there are, where they are and what is in contact, in bytes that any machine reads. Ids and
        shapes' hashes are in it, not the shapes."""
        with self._held() as scene:
            size = lib.pir_scene_serialised_size(scene)
            data = ffi.new("char[]", size)
            check(lib.pir_scene_serialise(scene, data, size), "snapshot", self._report)
        return bytes(ffi.buffer(data, size))

    def restore(self, data: bytes) -> None:
        """Brings the scene to a snapshot: bodies that it has not are removed, those that are missing are made of the
        shapes that other bodies have or that were kept by `keep`. The bytes are not trusted."""
        self._moves = {}
        report = ffi.new("pir_report *")
        with self._held() as scene:
            status = lib.pir_scene_restore(scene, bytes(data), len(data), report)
            if status != lib.PIR_OK:
                raise error(status, "data", report)

    def keep(self, body: Form) -> None:
        """Keeps a shape without adding a body, so that a snapshot with it can be restored."""
        options = ffi.new("pir_body_options *", lib.pir_body_options_default())
        kept = self._set_form(options, body, None)
        with self._held() as scene:
            check(lib.pir_scene_keep(scene, options), "body", self._report)
        del kept

    def __len__(self) -> int:
        with self._held() as scene:
            return int(lib.pir_scene_get_statistics(scene).bodies)

    def __contains__(self, body: object) -> bool:
        if not isinstance(body, (int, np.integer)) or not 0 <= body < 2**32:
            return False
        with self._held() as scene:
            return bool(lib.pir_scene_has(scene, int(body)))

    def __iter__(self) -> Iterator[int]:
        """Ids by number, as the scene is when it is asked."""
        found, at = [], lib.PIR_SCENE_NONE
        with self._held() as scene:
            while (at := lib.pir_scene_next(scene, at)) != lib.PIR_SCENE_NONE:
                found.append(int(at))
        return iter(found)

    def __enter__(self) -> "Scene":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Scene: {len(self)} bodies>"



def _all(kind: str, ask: Any) -> Any:
    """All that a call with a capacity finds, an element each: `ask(capacity, room, count)`, again while there is more
    than room for it."""
    capacity, count = 64, ffi.new("size_t *")
    while True:
        found = np.empty(capacity, dtype_of(kind))
        ask(capacity, pointer(found, kind + " *"), count)
        if count[0] <= capacity:
            return found[:count[0]]
        capacity = count[0]


def _hits_of(found: Any) -> SceneHits:
    hit = np.asarray(found["body"] != lib.PIR_SCENE_NONE)
    return SceneHits(hit, found["body"].astype(np.uint32), found["piece_q"].astype(np.uint32),
                     np.where(hit, found["time"], np.nan), np.where(hit[..., None], found["point"], np.nan),
                     np.where(hit[..., None], found["normal"], np.nan))


def _way(shape: Any, a: npt.ArrayLike, b: npt.ArrayLike, radius: float, mask: int,
         ignored: npt.ArrayLike) -> Tuple[Any, Any, Any]:
    """A shape that goes from pose to pose, its motion, and what must live as long."""
    (at, _), (to, _), out = poses("a", a), poses("b", b), indices("ignored", ignored)
    if len(at) != 1 or len(to) != 1 or not np.isfinite(to).all() or not at[0, :4].any() or not to[0, :4].any():
        raise InputError("a or b: it is not one pose")
    asked, kept = _shape(shape, at, radius, mask, out)
    return asked, ffi.new("pir_motion *", motion_between(at[0], to[0])), kept


def _filter(ignored: Indices) -> Any:
    """A filter of bodies that are left out, or NULL; the array is the caller's to keep."""
    if not len(ignored):
        return ffi.NULL
    return ffi.new("pir_query_filter *", {"ignored": pointer(ignored, "uint32_t *"), "ignored_count": len(ignored)})


def _shape(shape: Any, pose: Floats, radius: float, mask: int, ignored: Indices) -> Tuple[Any, List[Any]]:
    """A shape to be asked about, and what must live as long."""
    if len(pose) != 1:
        raise InputError(f"pose: {len(pose)} poses, not one")
    polytope, left_out = as_polytope("shape", shape), _filter(ignored)
    asked = ffi.new("pir_scene_shape *", lib.pir_scene_shape_default(polytope._pointer))
    ffi.memmove(ffi.addressof(asked, "pose"), pointer(pose, "char *"), 56)
    asked.radius, asked.mask = number("radius", radius), whole("mask", mask, 0, 2**32 - 1)
    asked.filter = left_out
    return asked, [polytope, left_out, ignored, pose]
