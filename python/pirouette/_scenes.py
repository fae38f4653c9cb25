# SPDX-License-Identifier: MIT
"""Scenes: many bodies, of which only what is asked for is computed."""
from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Sequence, Set, Union

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Bytes, Floats, Indices, dtype_of, fail_at, indices, number, pointer, poses, whole
from ._check import Handle, InputError, check, error
from ._native import ffi, lib
from ._polytopes import Body, Polytope, as_polytope
from ._solids import Pieces, Solid
from ._surfaces import HeightField, TriMesh, segments

BEGAN, PERSISTED, ENDED = 0, 1, 2

_KINDS = {"moving": lib.PIR_BODY_MOVING, "kinematic": lib.PIR_BODY_KINEMATIC, "static": lib.PIR_BODY_STATIC}
_DETAILS = {"states": lib.PIR_SCENE_STATES, "depths": lib.PIR_SCENE_DEPTHS, "manifolds": lib.PIR_SCENE_MANIFOLDS}


class Events(NamedTuple):
    """The findings of an update, an element for each two pieces: `kind` 0 began, 1 persisted, 2 ended. Contacts of
    event i are the elements ``starts[i]:starts[i + 1]`` of the `contact_` arrays."""

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

    def __init__(self, detail: str = "manifolds", margin: float = 0.0, threads: int = 1, unions: bool = False) -> None:
        if detail not in _DETAILS:
            raise InputError(f"detail: it is {detail!r}, not one of {', '.join(_DETAILS)}")
        options = ffi.new("pir_scene_options *", lib.pir_scene_options_default())
        options.detail, options.margin = _DETAILS[detail], number("margin", margin)
        options.threads, options.unions = whole("threads", threads, 1, 64), bool(unions)
        self._report = ffi.new("pir_report *")
        options.report = self._report
        made = ffi.new("pir_scene **")
        check(lib.pir_scene_create(options, made), "Scene", self._report)
        super().__init__(made[0], lib.pir_scene_destroy)
        self._moves: Dict[int, Floats] = {}
        self._bodies: Set[int] = set()

    def add(self, body: Union[Body, Solid, Pieces, TriMesh, HeightField, Sequence[Polytope]],
            pose: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), kind: str = "moving", *, radius: float = 0.0,
            category: int = 1, mask: int = 2**32 - 1, sensor: bool = False) -> int:
        """Adds a body and gives its number. A list of polytopes, `Pieces` or a `Solid` is one body of several
        pieces; a `TriMesh` or a `HeightField` is static or kinematic."""
        if kind not in _KINDS:
            raise InputError(f"kind: it is {kind!r}, not one of {', '.join(_KINDS)}")
        at, shape = poses("pose", pose)
        if shape:
            raise InputError("pose: it is not one pose")
        options = ffi.new("pir_body_options *", lib.pir_body_options_default())
        options.kind, options.radius = _KINDS[kind], number("radius", radius)
        options.category, options.mask = whole("category", category, 0, 2**32 - 1), whole("mask", mask, 0, 2**32 - 1)
        options.sensor = bool(sensor)
        ffi.memmove(ffi.addressof(options, "pose"), pointer(at, "char *"), 56)
        kept = self._set_form(options, body)
        number_ = ffi.new("uint32_t *")
        with self._held() as scene:
            check(lib.pir_scene_add(scene, options, number_), "body", self._report)
        del kept
        self._bodies.add(int(number_[0]))
        return int(number_[0])

    @staticmethod
    def _set_form(options: Any, body: Any) -> List[Any]:
        """Sets the pieces or the surface, and gives what must live until the call."""
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
        self._bodies.discard(at)

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
        for body in numbers.tolist():
            if body not in self._bodies:
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
            ("piece_q", np.uint32), ("sensor", np.bool_), ("state", np.uint8), ("distance", float), ("normal", float))}
        return Events(**plain, starts=starts, contact_point_p=contacts["point_p"].copy(),
                      contact_point_q=contacts["point_q"].copy(), contact_distance=contacts["distance"].copy(),
                      contact_id=contacts["id"].copy())

    def rays(self, origins: npt.ArrayLike, ways: npt.ArrayLike, mask: int = 2**32 - 1) -> SceneHits:
        """The first body that each segment from an origin along a way, to its end, meets."""
        rays, shape = segments(origins, ways)
        found, done = np.empty(len(rays), dtype_of("pir_impact")), ffi.new("size_t *")
        with self._held() as scene:
            status = lib.py_scene_rays(scene, pointer(rays), whole("mask", mask, 0, 2**32 - 1), len(rays),
                                       pointer(found, "pir_impact *"), done)
        fail_at(status, "origins or ways", done[0])
        found = found.reshape(shape)
        hit = np.asarray(found["body"] != lib.PIR_SCENE_NONE)
        return SceneHits(hit, found["body"].astype(np.uint32), found["piece_q"].astype(np.uint32),
                         np.where(hit, found["time"], np.nan), np.where(hit[..., None], found["point"], np.nan),
                         np.where(hit[..., None], found["normal"], np.nan))

    def nearest(self, shape: Body, pose: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), cutoff: float = np.inf,
                most: int = 1) -> "list[tuple[int, int, float]]":
        """The bodies nearest to a shape: number, piece and signed distance, nearest first."""
        polytope, (at, _) = as_polytope("shape", shape), poses("pose", pose)
        asked = ffi.new("pir_scene_shape *", lib.pir_scene_shape_default(polytope._pointer))
        ffi.memmove(ffi.addressof(asked, "pose"), pointer(at, "char *"), 56)
        room = whole("most", most, 1, 2**20)
        found, count = ffi.new("pir_scene_near[]", room), ffi.new("size_t *")
        with self._held() as scene:
            check(lib.pir_scene_nearest(scene, asked, number("cutoff", cutoff), room, found, count), "shape",
                  self._report)
        return [(n.body_q, n.piece_q, n.result.distance) for n in found[0:count[0]]]

    def snapshot(self) -> bytes:
        """Poses and contacts in bytes, for `restore` of this scene or one with the same bodies."""
        with self._held() as scene:
            size = lib.pir_scene_serialised_size(scene)
            data = ffi.new("char[]", size)
            check(lib.pir_scene_serialise(scene, data, size), "snapshot", self._report)
        return bytes(ffi.buffer(data, size))

    def restore(self, data: bytes) -> None:
        report = ffi.new("pir_report *")
        with self._held() as scene:
            status = lib.pir_scene_restore(scene, bytes(data), len(data), report)
            if status != lib.PIR_OK:
                raise error(status, "data", report)

    def __len__(self) -> int:
        return len(self._bodies)

    def __contains__(self, body: object) -> bool:
        return body in self._bodies

    def __iter__(self) -> Any:
        return iter(sorted(self._bodies))

    def __enter__(self) -> "Scene":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Scene: {len(self)} bodies>"

