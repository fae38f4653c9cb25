# SPDX-License-Identifier: MIT
"""Pairs: states, distances and contacts of two polytopes at many poses."""
from __future__ import annotations

import functools
import math
from typing import Any, Callable, NamedTuple, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Bytes, Floats, dtype_of, fail_at, number, pointer, poses, room, whole
from ._check import Handle, InputError, check, error
from ._motions import OUTCOMES, FirstContact, Sweep, exact_motion, first_contact_of, input_at, sweep_by
from ._native import ffi, lib
from ._polytopes import Body, Polytope, as_polytope

OUTSIDE, BOUNDARY, INSIDE, BAD = 0, 1, 2, 255


class Distances(NamedTuple):
    """Answers at poses: of n poses arrays whose first axis is n, of one pose arrays without that axis.

    `state` is 0 outside, 1 touching, 2 overlapping (exact), 255 bad; `distance` is the separation, or minus the depth;
    `normal` is a unit vector from Q to P; `point_p` and `point_q` are the nearest or deepest points in the world;
    `gradient` is the derivative of the distance by P's translation and by its turn about its own origin, in the world;
    `status` is 0, or why the pose is bad; `hessian`, (n, 12, 12), has the second derivatives of the distance, and
    `turning`, (n, 3, 12), the derivatives of the normal, both by the translation and the turn of P, then of Q, in the
    world; NaN where they are not known. What was not asked for is None.
    """

    state: Bytes
    distance: Floats
    normal: Optional[Floats]
    point_p: Optional[Floats]
    point_q: Optional[Floats]
    gradient: Optional[Floats]
    witness: Optional["npt.NDArray[Any]"]
    status: Bytes
    hessian: Optional[Floats] = None
    turning: Optional[Floats] = None


class Contacts(NamedTuple):
    """Contact manifolds at n poses: those of pose i are the elements ``starts[i]:starts[i + 1]`` of the others."""

    starts: "npt.NDArray[np.int64]"
    point_p: Floats
    point_q: Floats
    distance: Floats
    id: "npt.NDArray[np.uint64]"
    normal: Floats
    """Of each pose, not of each contact; zeros where there is none."""


class Impact(NamedTuple):
    """The first meeting of a motion: `outcome` is ``"hit"``, ``"miss"``, ``"inside"`` or ``"step limit"``."""

    outcome: str
    time: float
    normal: Floats
    point: Floats


def impact_of(found: Any) -> Impact:
    normal, point = found.normal, found.point
    return Impact(OUTCOMES[found.outcome], found.time, np.array([normal.x, normal.y, normal.z]),
                  np.array([point.x, point.y, point.z]))


def motion_between(a: Floats, b: Floats) -> Any:
    """The motion at constant speed from a pose to another, by the shorter turn."""
    (x, y, z, w), (i, j, k, r) = a[:4], b[:4]
    turn = np.array([i * w - r * x - j * z + k * y, j * w - r * y - k * x + i * z, k * w - r * z - i * y + j * x])
    real = r * w + i * x + j * y + k * z
    if real < 0:
        turn, real = -turn, -real
    length = float(np.linalg.norm(turn))
    along = turn * (2 * math.atan2(length, real) / length) if length > 0 else np.zeros(3)
    way = b[4:] - a[4:]
    return {"way": dict(zip("xyz", way)), "turn": dict(zip("xyz", along)), "held": 0.0}


def _badness(pose: Floats) -> float:
    """What is greater is more likely to be the reason that a pose is refused."""
    if not np.isfinite(pose).all() or not pose[:4].any():
        return math.inf
    return float(np.abs(pose[4:]).max())


def set_poses(array: Any, values: Floats, is_one: bool) -> None:
    array.rotations = pointer(values)
    array.translations = array.rotations + 4
    array.rotation_stride = array.translation_stride = 56
    array.is_one = is_one


def both(poses_p: Any, poses_q: Any) -> Tuple[Floats, Optional[Floats], Tuple[int, ...]]:
    """The poses of both, and the shape of what comes back. One pose of either stands for as many as the other has."""
    p, shape_p = poses("poses_p", poses_p)
    if poses_q is None:
        return p, None, shape_p
    q, shape_q = poses("poses_q", poses_q)
    if shape_p and shape_q and shape_p != shape_q:
        raise InputError(f"poses_q: there are {len(q)} of them, and {len(p)} of poses_p")
    return p, q, shape_p or shape_q


def pairs_of_poses(poses_p: Any, poses_q: Any) -> Tuple[Floats, Tuple[int, ...]]:
    """The poses of both side by side, (n, 14), and the shape of what comes back."""
    p, q, shape = both(poses_p, poses_q)
    made = np.empty((shape[0] if shape else 1, 14))
    made[:, :7], made[:, 7:] = p, np.array([[0.0, 0, 0, 1, 0, 0, 0]]) if q is None else q
    return made, shape


class ActiveGradients(NamedTuple):
    """The gradients at a tie. Corners of one facet of the difference, or of the polygon of nearest points, have one
    number in `facet`; `gradient`, (n, 12), is by the translation and the turn of P, then of Q, in the world. Along a
    small motion m the distance changes by the greatest over facets of the least over their corners of gradient · m."""

    facet: "npt.NDArray[np.uint32]"
    distance: Floats
    normal: Floats
    point_p: Floats
    point_q: Floats
    gradient: Floats
    witness: "npt.NDArray[Any]"


class ActiveSet(NamedTuple):
    """Ways out of an overlap: depths, unit normals from Q to P, and the features whose facet of the sum it is."""

    depth: Floats
    normal: Floats
    witness: "npt.NDArray[Any]"


class Pair(Handle):
    """Two polytopes, asked at poses. A pair keeps what its last answers needed, so poses in the order of a motion
    cost least. `p` and `q` are polytopes, arrays of points, or anything with `.vertices`.

    A pose is x, y, z, w of a quaternion of any length, then the translation; or a 4 by 4 matrix.

    >>> import numpy as np
    >>> cube = Polytope.shape("cube")
    >>> pair = Pair(cube, cube)
    >>> poses = np.tile([0.0, 0, 0, 1, 0, 0, 0], (3, 1))
    >>> poses[:, 4] = [2, 1, 0.5]
    >>> answers = pair.signed_distance(poses)
    >>> answers.distance.tolist(), answers.state.tolist()
    ([1.0, 0.0, -0.5], [0, 1, 2])
    >>> float(pair.signed_distance([0, 0, 0, 1, 0, 0, 5]).distance)
    4.0
    """

    def __init__(self, p: Body, q: Body, threads: int = 1) -> None:
        self.p: Polytope = as_polytope("p", p)
        self.q: Polytope = as_polytope("q", q)
        self.threads = whole("threads", threads, 1, 64)
        options = ffi.new("pir_pair_batch_options *", lib.pir_pair_batch_options_default())
        options.threads = self.threads
        made = ffi.new("pir_pair_batch **")
        check(lib.pir_pair_batch_create(self.p._pointer, self.q._pointer, options, made), "Pair")
        super().__init__(made[0], lib.pir_pair_batch_destroy)
        self._one: Optional[Tuple[Any, Any]] = None

    def _ask(self, call: Any, given: Tuple[Floats, Optional[Floats], int], arrays: Any, settings: Tuple[float, ...],
             bad: str) -> None:
        if bad not in ("raise", "nan"):
            raise InputError(f'bad: it is {bad!r}, not "raise" or "nan"')
        p, q, count = given
        asked = ffi.new("pir_pair_batch_input *", lib.pir_pair_batch_input_default())
        set_poses(asked.poses_p, p, len(p) == 1)
        if q is not None:
            set_poses(asked.poses_q, q, len(q) == 1)
        asked.cutoff, asked.margin, asked.radius_p, asked.radius_q = settings
        summary = ffi.new("pir_pair_batch_summary *")
        with self._held() as batch:
            check(call(batch, asked, count, arrays, summary), "cutoff, margin or radius")
        if summary.bad and bad == "raise":
            raise self._wrong(p, q, summary)

    @staticmethod
    def _wrong(p: Floats, q: Optional[Floats], summary: Any) -> Exception:
        """The error of the first bad pose, by the argument that has it."""
        name, at = "poses_p", summary.first_bad
        if q is not None:
            one, other = p[at if len(p) > 1 else 0], q[at if len(q) > 1 else 0]
            if _badness(other) > _badness(one):
                name = "poses_q"
        if len(p if name == "poses_p" else q) == 1:  # type: ignore[arg-type]
            at = 0
        return error(summary.first_status, f"{name}[{at}]")

    def signed_distance(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None, *,
                        cutoff: float = math.inf, points: bool = True, gradient: bool = False, witness: bool = False,
                        hessian: bool = False, radius_p: float = 0.0, radius_q: float = 0.0,
                        out: Optional[Floats] = None, bad: str = "raise") -> Distances:
        """Separations where the bodies are apart, minus the depths where they overlap.

        cutoff    distances above it are the cutoff, without points.
        points    whether normals and points are wanted.
        gradient  whether derivatives are wanted; witness: the features that attain each answer.
        hessian   whether second derivatives and those of the normal are: a second query a pose.
        out       an array for the distances.
        bad       ``"raise"`` for an error at the first pose that is none, ``"nan"`` for NaN and its `status`.
        """
        p, q, shape = both(poses_p, poses_q)
        count = shape[0] if shape else 1
        arrays = ffi.new("pir_pair_batch_arrays *")
        distance = room("out", out, shape)
        state, status = np.empty(shape, np.uint8), np.empty(shape, np.uint8)
        normal, point_p, point_q = (np.empty(shape + (3,)) if points else None for _ in range(3))
        slopes = np.empty(shape + (6,)) if gradient else None
        features = np.empty(shape, dtype_of("pir_witness")) if witness else None
        arrays.distance, arrays.state = pointer(distance), pointer(state, "uint8_t *")
        arrays.status = pointer(status, "uint8_t *")
        arrays.normal = pointer(normal, "double(*)[3]")
        arrays.point_p, arrays.point_q = pointer(point_p, "double(*)[3]"), pointer(point_q, "double(*)[3]")
        arrays.gradient = pointer(slopes, "double(*)[6]")
        arrays.witness = pointer(features, "pir_witness *")
        settings = (number("cutoff", cutoff), 0.0, number("radius_p", radius_p), number("radius_q", radius_q))
        self._ask(lib.pir_pair_batch_signed_distance, (p, q, count), arrays, settings, bad)
        found = Distances(state, distance, normal, point_p, point_q, slopes, features, status)
        if not hessian:
            return found
        second, turning = self._curvatures(p, q, status, (settings[0], *settings[2:]))
        return found._replace(hessian=second, turning=turning)

    def _curvatures(self, p: Floats, q: Optional[Floats], status: Bytes,
                    settings: Tuple[float, float, float]) -> Tuple[Floats, Floats]:
        """Second derivatives, and those of the normal, of poses whose status is 0; NaN where they are not known."""
        posed = np.empty((status.size, 14))
        posed[:, :7], posed[:, 7:] = p, np.array([[0.0, 0, 0, 1, 0, 0, 0]]) if q is None else q
        found, done = np.empty(status.size, dtype_of("pir_curvature")), ffi.new("size_t *")
        asked = ffi.new("py_posed *", [pointer(posed), pointer(status, "uint8_t *"), status.size, *settings])
        with self._held():
            pair, workspace = self._single()
            code = lib.py_pair_curvatures(pair, workspace, asked, pointer(found, "pir_curvature *"), done)
        fail_at(code, "poses_p or poses_q", done[0])
        known = found["is_known"][:, None, None]
        return (np.where(known, found["hessian"], math.nan).reshape(status.shape + (12, 12)),
                np.where(known, found["normal"], math.nan).reshape(status.shape + (3, 12)))

    def states(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None, *,
               bad: str = "raise") -> Bytes:
        """The exact states: 0 outside, 1 touching, 2 overlapping; 255 of a bad pose."""
        p, q, shape = both(poses_p, poses_q)
        arrays = ffi.new("pir_pair_batch_arrays *")
        state = np.empty(shape, np.uint8)
        arrays.state = pointer(state, "uint8_t *")
        self._ask(lib.pir_pair_batch_overlap, (p, q, shape[0] if shape else 1), arrays, (math.inf, 0.0, 0.0, 0.0), bad)
        return state

    def overlap(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None) -> Bools:
        """Whether the insides of the bodies meet, exactly: bodies that only touch do not overlap."""
        return np.asarray(self.states(poses_p, poses_q) == INSIDE)

    def contacts(self, poses_p: npt.ArrayLike, poses_q: Optional[npt.ArrayLike] = None, *,
                 margin: float = 0.0) -> Contacts:
        """Contact manifolds, of bodies that touch, overlap, or are apart by at most `margin`."""
        p, q, shape = both(poses_p, poses_q)
        count, capacity, limit = shape[0] if shape else 1, 8, number("margin", margin)
        distance, normal, counts = np.empty(count), np.empty((count, 3)), np.empty(count, np.uint32)
        while True:
            found = np.empty((count, capacity), dtype_of("pir_contact"))
            arrays = ffi.new("pir_pair_batch_arrays *")
            arrays.distance, arrays.normal = pointer(distance), pointer(normal, "double(*)[3]")
            arrays.contacts, arrays.contact_capacity = pointer(found, "pir_contact *"), capacity
            arrays.contact_counts = pointer(counts, "uint32_t *")
            self._ask(lib.pir_pair_batch_signed_distance, (p, q, count), arrays, (max(limit, 0.0), limit, 0.0, 0.0),
                      "raise")
            most = int(counts.max(initial=0))
            if most <= capacity:
                break
            capacity = most
        # the manifold of bodies that are apart by more than the margin is a nearest point, not a contact
        counts = np.where(distance <= limit, counts, 0)
        starts = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        flat = found[np.arange(capacity) < counts[:, None]]
        return Contacts(starts, flat["point_p"].copy(), flat["point_q"].copy(), flat["distance"].copy(),
                        flat["id"].copy(), normal)

    def time_of_impact(self, a: npt.ArrayLike, b: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
                       tolerance: float = 1e-6) -> Impact:
        """When P, moved from pose `a` to pose `b` at constant speed, first comes within `tolerance` of Q."""
        (p, _), (to, _), (q, _) = poses("a", a), poses("b", b), poses("pose_q", pose_q)
        for name, array in (("a", p), ("b", to), ("pose_q", q)):
            if len(array) != 1:
                raise InputError(f"{name}: {len(array)} poses, not one")
        if not (np.isfinite(p).all() and np.isfinite(to).all() and p[0, :4].any() and to[0, :4].any()):
            raise InputError("a or b: not a pose")
        motion = ffi.new("pir_motion *", motion_between(p[0], to[0]))
        found, limit = ffi.new("pir_impact *"), number("tolerance", tolerance)
        with self._held():
            pair, workspace = self._single()
            check(lib.py_pair_impact(pair, workspace, pointer(p), pointer(q), motion, limit, found),
                  "tolerance or pose")
        return impact_of(found)

    def first_contact(self, pose_p: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
                      axis: npt.ArrayLike = (0, 0, 0), degrees: float = 0.0, pivot: npt.ArrayLike = (0, 0, 0),
                      way: npt.ArrayLike = (0, 0, 0)) -> FirstContact:
        """When P at `pose_p` first touches Q at `pose_q`, exactly: in a turn by `degrees` about the axis through
        `pivot`, on a way, or in a screw, which is both, by less than 180 degrees, the way as the tangent of half the
        angle."""
        asked, motion = input_at("pose_p", pose_p, "pose_q", pose_q), exact_motion(axis, degrees, pivot, way)
        found = ffi.new("pir_exact_impact *")
        with self._held():
            pair, workspace = self._single()
            check(lib.pir_pair_impact(pair, workspace, asked, motion, found), "poses or motion")
        return first_contact_of(found)

    def sweep(self, a: npt.ArrayLike, b: npt.ArrayLike, a_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0),
              b_q: Optional[npt.ArrayLike] = None, *, budget: int = 0) -> Sweep:
        """Whether a motion of P from pose `a` to `b`, and of Q from `a_q` to `b_q`, is free, proven. Without `b_q` Q
        rests. At most `budget` distances are asked for, 0 for 512."""
        first, second = input_at("a", a, "a_q", a_q), input_at("b", b, "b_q", a_q if b_q is None else b_q)
        with self._held():
            pair, workspace = self._single()
            return sweep_by(functools.partial(lib.pir_pair_sweep, pair, workspace), first, second, budget)

    def sweep_screw(self, pose_p: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
                    axis: npt.ArrayLike = (0, 0, 0), degrees: float = 0.0, pivot: npt.ArrayLike = (0, 0, 0),
                    way: npt.ArrayLike = (0, 0, 0), budget: int = 0) -> Sweep:
        """Whether a turn, a way or a screw of P is free, proven: through up to 36,000 degrees, the way proportional to
        the angle. `start` and `end` are fractions of the angle."""
        asked, motion = input_at("pose_p", pose_p, "pose_q", pose_q), exact_motion(axis, degrees, pivot, way)
        with self._held():
            pair, workspace = self._single()
            return sweep_by(functools.partial(lib.pir_pair_sweep_screw, pair, workspace), asked, motion, budget)

    def active_set(self, pose_p: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
                   slack: float = 0.0) -> ActiveSet:
        """Every way out of an overlap that is at most `slack` longer than the depth: what a solver may choose among.
        There are none unless the bodies overlap."""
        found = self._all_of(lib.py_pair_escapes, "pir_escape", pose_p, pose_q, slack)
        return ActiveSet(found["depth"].copy(), found["normal"].copy(), found["witness"].copy())

    def active_gradients(self, pose_p: npt.ArrayLike, pose_q: npt.ArrayLike = (0, 0, 0, 1, 0, 0, 0), *,
                         slack: float = 0.0) -> ActiveGradients:
        """The gradients of all features that tie for the distance, decided exactly; of bodies that overlap also those
        of facets whose depth is at most `slack` greater. The first is that of `signed_distance`."""
        found = self._all_of(lib.py_pair_active, "pir_active", pose_p, pose_q, slack)
        gradient = np.hstack([found[body][part] for body in "pq" for part in ("force", "torque")])
        return ActiveGradients(found["facet"].copy(), found["distance"].copy(), found["normal"].copy(),
                               found["point_p"].copy(), found["point_q"].copy(), gradient, found["features"].copy())

    def _all_of(self, call: Any, kind: str, pose_p: Any, pose_q: Any, slack: float) -> "npt.NDArray[Any]":
        """All structs that a question about one pose is answered by, however many they are."""
        posed, shape = pairs_of_poses(pose_p, pose_q)
        if shape:
            raise InputError(f"pose_p or pose_q: {len(posed)} poses, not one")
        limit, count, capacity = number("slack", slack), ffi.new("size_t *"), 16
        with self._held():
            pair, workspace = self._single()
            while True:
                found = np.empty(capacity, dtype_of(kind))
                check(call(pair, workspace, pointer(posed), limit, capacity, pointer(found, f"{kind} *"), count),
                      "slack or pose")
                if count[0] <= capacity:
                    return found[:count[0]]
                capacity = count[0]

    def _single(self) -> Tuple[Any, Any]:
        """A pair for questions about one pose, with its workspace."""
        if self._one is None:
            made, scratch = ffi.new("pir_pair **"), ffi.new("pir_workspace **")
            check(lib.pir_pair_create(self.p._pointer, self.q._pointer, ffi.NULL, made), "Pair")
            pair = ffi.gc(made[0], lib.pir_pair_destroy)
            check(lib.pir_workspace_create(ffi.NULL, scratch), "Pair")
            self._one = pair, ffi.gc(scratch[0], lib.pir_workspace_destroy)
        return self._one

    def _close(self) -> None:
        self._one = None
        super()._close()

    def __enter__(self) -> "Pair":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Pair: {self.p!r}, {self.q!r}>"

    def __copy__(self) -> "Pair":
        return Pair(self.p, self.q, self.threads)

    def __deepcopy__(self, memo: Any) -> "Pair":
        return self.__copy__()

    def __reduce__(self) -> Tuple[Callable[..., "Pair"], Tuple[Polytope, Polytope, int]]:
        return Pair, (self.p, self.q, self.threads)

