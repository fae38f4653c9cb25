# SPDX-License-Identifier: MIT
"""Paths by translations alone, decided exactly."""
from __future__ import annotations

from typing import Any, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Floats, path_of, quaternion, rows, vector, whole
from ._check import InputError, check
from ._native import ffi, lib
from ._polytopes import Polytope
from ._solids import Solid

Solids = Union[Solid, Polytope, Sequence[Union[Solid, Polytope]]]


class Plan:
    """Whether there is a path, and the path. True where there is one.

    found              whether there is a path.
    points, is_exact   (n, 3), where the robot's origin goes through in straight motions, and whether each is exact as
                       it stands: others are rationals, rounded.
    components, parts  of free space within the bounds, and of its division.
    bounds             (2, 3): those given, or of a box around all sums and both places.
    """

    def __init__(self, pointer_: Any) -> None:
        self._pointer = ffi.gc(pointer_, lib.pir_path_plan_destroy)
        info, point, exact = ffi.new("pir_path_plan_info *"), ffi.new("pir_vec3 *"), ffi.new("bool *")
        lib.pir_path_plan_describe(pointer_, info)
        self.found: bool = info.answer == lib.PIR_PLAN_PATH
        self.points: Floats = np.empty((info.points, 3))
        self.is_exact: Bools = np.empty(info.points, np.bool_)
        for i in range(info.points):
            check(lib.pir_path_plan_waypoint(pointer_, i, point, exact), "Plan")
            self.points[i], self.is_exact[i] = (point.x, point.y, point.z), exact[0]
        self.components, self.parts, self.sums = int(info.components), int(info.parts), int(info.sums)
        self.bounds: Floats = np.array([[v.x, v.y, v.z] for v in (info.low, info.high)])

    def write(self, path: Any) -> None:
        """Writes the plan with its proof as JSON in rationals, which check/plan.py of the sources checks."""
        check(lib.py_plan_write(self._pointer, path_of(path)), f"{path}")

    def __bool__(self) -> bool:
        return self.found

    def __repr__(self) -> str:
        return f"<Plan: {f'a path of {len(self.points)} points' if self.found else 'no path'}>"


def _solids(name: str, bodies: Any) -> List[Solid]:
    given = list(bodies) if isinstance(bodies, (list, tuple)) else [bodies]
    for i, body in enumerate(given):
        if not isinstance(body, (Solid, Polytope)):
            raise InputError(f"{name}[{i}]: neither a Solid nor a Polytope: {body!r}")
    return [body if isinstance(body, Solid) else Solid(body) for body in given]


def _array(solids: List[Solid]) -> Any:
    return ffi.new("pir_solid *[]", [solid._pointer for solid in solids])


def plan(robot: Solids, obstacles: Solids, start: npt.ArrayLike, goal: npt.ArrayLike, *,
         rotation: npt.ArrayLike = (0, 0, 0, 1), bounds: Optional[npt.ArrayLike] = None, open: bool = False,
         parts: int = 0) -> Plan:
    """Whether the robot, turned by `rotation`, can be moved from the translation `start` to `goal` between obstacles
    without being turned: decided exactly, with the path, or the proof that there is none.

    robot, obstacles  solids or polytopes, one or several; they may overlap each other.
    bounds            (2, 3), low and high, of the translation; None for none.
    open              whether bodies may touch: then a passage counts that the robot fits exactly.
    parts             the most parts that space may be divided into; 0 for what memory allows.

    >>> box, wall = Polytope.shape("cube"), Polytope.shape("box?x=1&y=9&z=9")
    >>> way = plan(box, wall, [-3, 0, 0], [3, 0, 0])
    >>> way.found, way.points[0].tolist(), way.points[-1].tolist()
    (True, [-3.0, 0.0, 0.0], [3.0, 0.0, 0.0])
    >>> bool(plan(box, wall, [-3, 0, 0], [3, 0, 0], bounds=[[-4, -4, -4], [4, 4, 4]]))
    False
    """
    bodies = _solids("robot", robot), _solids("obstacles", obstacles)
    arrays: Tuple[Any, Any] = (_array(bodies[0]), _array(bodies[1]))
    asked = ffi.new("pir_path_plan_input *")
    asked.robot, asked.robot_count = arrays[0], len(bodies[0])
    asked.obstacles, asked.obstacle_count = arrays[1], len(bodies[1])
    asked.rotation = quaternion("rotation", rotation)
    setattr(asked, "from", vector("start", start))
    asked.to = vector("goal", goal)
    options, report = ffi.new("pir_path_plan_options *", lib.pir_path_plan_options_default()), ffi.new("pir_report *")
    options.report, options.open, options.parts = report, bool(open), whole("parts", parts, 0, 2**32 - 1)
    if bounds is not None:
        box = rows("bounds", bounds, 3)
        if len(box) != 2:
            raise InputError(f"bounds: its shape is {box.shape}, not (2, 3)")
        options.bounded, options.low, options.high = True, vector("bounds", box[0]), vector("bounds", box[1])
    made = ffi.new("pir_path_plan **")
    check(lib.pir_path_plan_translate(asked, options, made), "plan", report)
    return Plan(made[0])
