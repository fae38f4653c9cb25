# SPDX-License-Identifier: MIT
"""Slices of a configuration space: which poses of a robot among obstacles are free."""
from __future__ import annotations

from typing import Any, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Bytes, Floats, dtype_of, path_of, pointer, poses, rows, vector, whole
from ._check import Error, Handle, InputError, check, error
from ._native import ffi, lib
from ._pairs import pairs_of_poses, set_poses
from ._polytopes import Body, Mesh, Polytope, as_polytope
from ._solids import Pieces, Solid

UNKNOWN, FREE, BLOCKED = 0, 1, 2
HAS_SLICES: bool = hasattr(lib, "pir_cspace_open")

Bodies = Union[Body, Solid, Pieces, Sequence[Polytope]]


class Configurations(NamedTuple):
    """Answers at poses, exact: `verdict` is 1 free, 2 blocked, 255 of a bad pose. Where the rotation is one of the
    grid, `on_grid`, `state` is 0 outside, 1 touching, 2 overlapping. `robot` and `obstacle` tell which pieces it rests
    on, `slice` the nearest rotation, `turn` the radians from there to the pose."""

    verdict: Bytes
    state: Bytes
    on_grid: Bools
    turn: Floats
    robot: "npt.NDArray[np.uint32]"
    obstacle: "npt.NDArray[np.uint32]"
    slice: "npt.NDArray[np.uint64]"


class Segments(NamedTuple):
    """Answers for motions: `verdict` of each whole, 1 free all along, 2 blocked somewhere, 0 unknown; `begin` and `end`
    of the first stretch that is not proven free, parts of the motion."""

    verdict: Bytes
    begin: Floats
    end: Floats


def _needed() -> None:
    if not HAS_SLICES:
        raise Error("CSpace: this build has no slices, for it was made without HDF5; from the sources: "
                    "pip install . --config-settings=setup-args=-Dhdf5=enabled", "NOT_BUILT")


def _pieces(name: str, body: Any) -> List[Polytope]:
    if isinstance(body, Solid):
        body = body.decompose()
    if isinstance(body, Pieces):
        return body.polytopes()
    if isinstance(body, (list, tuple)) and body and all(isinstance(piece, Polytope) for piece in body):
        return list(body)
    return [as_polytope(name, body)]


def _grid(rotations: Any, axis: Any) -> Any:
    made = ffi.new("pir_grid **")
    if axis is not None:
        check(lib.pir_grid_axis(vector("axis", axis), whole("rotations", rotations, 1, 2**32), ffi.NULL, made),
              "rotations or axis")
    elif np.ndim(rotations) == 0:
        check(lib.pir_grid_hopf(whole("rotations", rotations, 0, 8), ffi.NULL, made), "rotations")
    else:
        array = rows("rotations", rotations, 4)
        check(lib.pir_grid_list(pointer(array, "pir_quat *"), len(array), False, ffi.NULL, made),
              "rotations")
    return ffi.gc(made[0], lib.pir_grid_destroy)


class CSpace(Handle):
    """A file of slices, open: the configuration space of a robot that turns among obstacles. The package has slices
    where it was built with HDF5, `HAS_SLICES`; without, these calls raise an Error whose status is "NOT_BUILT"."""

    def __init__(self, path: Any) -> None:
        _needed()
        made, report = ffi.new("pir_cspace **"), ffi.new("pir_report *")
        check(lib.pir_cspace_open(path_of(path), ffi.NULL, report, made), f"{path}", report)
        super().__init__(made[0], lib.pir_cspace_destroy)
        info = lib.pir_cspace_get_info(made[0])
        self._counts: Tuple[int, int] = (info.robot_count, info.obstacle_count)
        self._slices = int(info.grid.count)

    @classmethod
    def open(cls, path: Any) -> "CSpace":
        """Opens a file of slices; what is read of it is checked."""
        return cls(path)

    @classmethod
    def build(cls, path: Any, robot: Bodies, obstacles: Bodies, rotations: Any, *, axis: Optional[npt.ArrayLike] = None,
              threads: int = 1, planes: bool = False, vertices: bool = False, resume: bool = False) -> "CSpace":
        """Makes a file of slices and opens it. A file that stands at `path` stays until the new one is whole.

        robot, obstacles  convex bodies, solids, or lists of polytopes.
        rotations         a level of the grid of all rotations (Hopf, 72·8^level of them); quaternions, (n, 4); or with
                          `axis` how many steps a full turn about it has.
        planes, vertices  whether those of all slices are in the file too, for other programs.
        resume            whether to go on from the parts of an earlier run that ended.
        """
        _needed()
        bodies = ffi.new("pir_cspace_bodies *")
        kept = _pieces("robot", robot), _pieces("obstacles", obstacles)
        arrays = [ffi.new("pir_polytope *[]", [piece._pointer for piece in pieces]) for pieces in kept]
        bodies.robot, bodies.robot_count = arrays[0], len(kept[0])
        bodies.obstacle, bodies.obstacle_count = arrays[1], len(kept[1])
        grid, options = _grid(rotations, axis), ffi.new("pir_cspace_options *", lib.pir_cspace_options_default())
        options.threads, options.resume = whole("threads", threads, 1, 64), bool(resume)
        options.planes, options.vertices = bool(planes), bool(vertices)
        made, report = ffi.new("pir_cspace_job **"), ffi.new("pir_report *")
        check(lib.pir_cspace_job_create(bodies, grid, path_of(path), options, report, made), f"{path}", report)
        job = ffi.gc(made[0], lib.pir_cspace_job_destroy)
        check(lib.pir_cspace_job_run(job, report), f"{path}", report)
        check(lib.pir_cspace_job_assemble(job, report), f"{path}", report)
        ffi.release(job)
        return cls(path)

    @staticmethod
    def check(path: Any) -> None:
        """Raises where a byte of a file of slices is not what was written."""
        _needed()
        report = ffi.new("pir_report *")
        check(lib.pir_cspace_check(path_of(path), ffi.NULL, report), f"{path}", report)

    def verdicts(self, poses_: npt.ArrayLike, *, bad: str = "raise") -> Bytes:
        """Whether the robot is free at poses: 1 free, 2 blocked. The nearest rotation is not looked for, so that this
        costs less than `classify`.

        bad  ``"raise"`` for an error at the first pose that is none, ``"nan"`` for the verdict 255.
        """
        array, shape = poses("poses", poses_)
        verdict, to = np.empty(len(array), np.uint8), ffi.new("pir_cspace_arrays *")
        to.verdict = pointer(verdict, "uint8_t *")
        self._classify(array, to, bad)
        return verdict.reshape(shape)

    def _classify(self, array: Floats, to: Any, bad: str) -> None:
        if bad not in ("raise", "nan"):
            raise InputError(f'bad: it is {bad!r}, not "raise" or "nan"')
        asked, report = ffi.new("pir_pose_array *"), ffi.new("pir_report *")
        summary = ffi.new("pir_pair_batch_summary *")
        set_poses(asked, array, False)
        with self._held() as cspace:
            check(lib.pir_cspace_classify_many(cspace, asked, len(array), to, report, summary), "poses", report)
        if summary.bad and bad == "raise":
            raise error(summary.first_status, f"poses[{summary.first_bad}]")

    def classify(self, poses_: npt.ArrayLike, *, bad: str = "raise") -> Configurations:
        """Whether the robot is free at poses, and what it rests on; in order of a motion they cost least.

        bad  ``"raise"`` for an error at the first pose that is none, ``"nan"`` for the verdict 255 and a NaN turn.
        """
        array, shape = poses("poses", poses_)
        count = len(array)
        found = Configurations(np.empty(count, np.uint8), np.empty(count, np.uint8), np.empty(count, np.bool_),
                               np.empty(count), np.empty(count, np.uint32), np.empty(count, np.uint32),
                               np.empty(count, np.uint64))
        to = ffi.new("pir_cspace_arrays *")
        for name, kind in (("verdict", "uint8_t *"), ("state", "uint8_t *"), ("on_grid", "uint8_t *"),
                           ("turn", "double *"), ("robot", "uint32_t *"), ("obstacle", "uint32_t *"),
                           ("slice", "uint64_t *")):
            setattr(to, name, pointer(getattr(found, name), kind))
        self._classify(array, to, bad)
        return Configurations(*(values.reshape(shape) for values in found))

    def segment(self, a: npt.ArrayLike, b: npt.ArrayLike) -> Segments:
        """Whether the robot is free all along motions from poses `a` to poses `b`: straight, turning evenly the shorter
        way. One pose stands for as many as the other has."""
        array, shape = pairs_of_poses(a, b)
        found, done = np.empty(len(array), dtype_of("pir_cspace_motion")), ffi.new("size_t *")
        report = ffi.new("pir_report *")
        with self._held() as cspace:
            status = lib.py_cspace_segments(cspace, pointer(array), len(array), report,
                                            pointer(found, "pir_cspace_motion *"), done)
        if status != lib.PIR_OK:
            raise error(status, f"a or b[{done[0]}]", report)
        found = found.reshape(shape)
        return Segments(found["verdict"].astype(np.uint8), found["from"].copy(), found["to"].copy())

    def rotation(self, slice_: int) -> Floats:
        """The rotation of a slice, a quaternion."""
        at = whole("slice_", slice_, 0, self._slices - 1)
        with self._held() as cspace:
            q = lib.pir_grid_rotation(lib.pir_cspace_grid(cspace), at)
        return np.array([q.x, q.y, q.z, q.w])

    def _place(self, slice_: int, robot: int, obstacle: int) -> Any:
        return {"slice": whole("slice_", slice_, 0, self._slices - 1),
                "robot": whole("robot", robot, 0, self._counts[0] - 1),
                "obstacle": whole("obstacle", obstacle, 0, self._counts[1] - 1)}

    def mesh(self, slice_: int, robot: int = 0, obstacle: int = 0, exact: bool = False) -> Mesh:
        """The boundary of the difference of two pieces at a slice: where the robot's origin must not be."""
        place, report, made = self._place(slice_, robot, obstacle), ffi.new("pir_report *"), ffi.new("pir_mesh **")
        with self._held() as cspace:
            check(lib.pir_cspace_mesh(cspace, place, lib.PIR_EXACT if exact else lib.PIR_DOUBLE, report, made),
                  "mesh", report)
        return Mesh(made[0])

    def planes(self, slice_: int, robot: int = 0, obstacle: int = 0) -> Floats:
        """Half-spaces a·x + b·y + c·z ≤ d that bound that difference, (n, 4)."""
        place, report = self._place(slice_, robot, obstacle), ffi.new("pir_report *")
        found, count = ffi.new("pir_halfspace **"), ffi.new("uint32_t *")
        with self._held() as cspace:
            check(lib.pir_cspace_planes(cspace, place, report, found, count), "planes", report)
            made = np.empty((count[0], 4))
            if count[0]:
                ffi.memmove(pointer(made, "char *"), found[0], made.nbytes)
        return made

    @property
    def robot(self) -> List[Polytope]:
        """The pieces of the robot."""
        with self._held() as cspace:
            return [_again(lib.pir_cspace_robot(cspace, i)) for i in range(self._counts[0])]

    @property
    def obstacles(self) -> List[Polytope]:
        with self._held() as cspace:
            return [_again(lib.pir_cspace_obstacle(cspace, i)) for i in range(self._counts[1])]

    def __len__(self) -> int:
        """How many rotations there are."""
        return self._slices

    def __enter__(self) -> "CSpace":
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<CSpace: {self._slices} rotations, {self._counts[0]} pieces among {self._counts[1]}>"


def _again(polytope: Any) -> Polytope:
    return Polytope._of(lib.pir_polytope_retain(ffi.cast("pir_polytope *", polytope)))
