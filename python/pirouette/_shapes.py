# SPDX-License-Identifier: MIT
"""Shapes of bodies as people name them."""
from __future__ import annotations

from typing import Any, Callable, List, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, floats, number, pointer, poses, rows, vector, whole
from ._check import InputError, check
from ._native import ffi, lib
from ._polytopes import Mass, mass_of
from ._surfaces import HeightField, TriMesh

# named in the messages of calls that fail
_ARGUMENTS = {
    "ball": "radius", "capsule": "a, b, radius", "box": "half, radius", "cylinder": "radius, height, sides",
    "cone": "radius, height, sides", "plane": "normal, offset, reach", "hull": "points, radius", "compound": "parts",
    "mesh": "surface, radius", "field": "surface, radius",
}

Parts = Sequence[Tuple["Shape", npt.ArrayLike]]


class Shape:
    """A ball, a capsule, a rounded box, …: what a body of a scene is made of, with its rounding radius and its mass.
    Made by the class methods, immutable.

    >>> Shape.capsule([0, 0, -0.5], [0, 0, 0.5], 0.3)
    <Shape: capsule of radius 0.3, 1 between the centres of its ends>
    >>> round(Shape.ball(0.5).mass.volume, 12) == round(np.pi / 6, 12)
    True
    """

    __slots__ = ("_pointer", "_made")
    _pointer: Any
    _made: Tuple[Any, ...]

    def __init__(self) -> None:
        raise InputError("Shape: made by Shape.ball, .capsule, .box, .cylinder, .cone, .plane, .hull, .compound, "
                         ".mesh or .field")

    @classmethod
    def _of(cls, name: str, call: Any, arguments: Tuple[Any, ...], *given: Any) -> "Shape":
        found, report = ffi.new("pir_body_shape **"), ffi.new("pir_report *")
        check(call(*given, ffi.NULL, report, found), f"{name}({_ARGUMENTS[name]})", report)
        made = cls.__new__(cls)
        made._pointer = ffi.gc(found[0], lib.pir_body_shape_release)
        made._made = (name, arguments)
        return made

    @classmethod
    def ball(cls, radius: float) -> "Shape":
        """A ball about the origin."""
        r = number("radius", radius)
        return cls._of("ball", lib.pir_body_shape_ball, (r,), r)

    @classmethod
    def capsule(cls, a: npt.ArrayLike, b: npt.ArrayLike, radius: float) -> "Shape":
        """All that is within a radius of the segment from a to b."""
        r = number("radius", radius)
        ends = floats("a", a).copy(), floats("b", b).copy()
        return cls._of("capsule", lib.pir_body_shape_capsule, (*ends, r), vector("a", a), vector("b", b), r)

    @classmethod
    def box(cls, half: npt.ArrayLike, radius: float = 0.0) -> "Shape":
        """A box about the origin; `half` of its edges, of which `radius` rounds the corners, counts in."""
        r = number("radius", radius)
        return cls._of("box", lib.pir_body_shape_box, (floats("half", half).copy(), r), vector("half", half), r)

    @classmethod
    def cylinder(cls, radius: float, height: float, sides: int = 32) -> "Shape":
        """About the z axis, its corners on the round one."""
        given = number("radius", radius), number("height", height), whole("sides", sides, 3, 1024)
        return cls._of("cylinder", lib.pir_body_shape_cylinder, given, *given)

    @classmethod
    def cone(cls, radius: float, height: float, sides: int = 32) -> "Shape":
        """About the z axis, its base at -height/4, its apex at 3/4 height."""
        given = number("radius", radius), number("height", height), whole("sides", sides, 3, 1024)
        return cls._of("cone", lib.pir_body_shape_cone, given, *given)

    @classmethod
    def plane(cls, normal: npt.ArrayLike, offset: float = 0.0, reach: float = 1000.0) -> "Shape":
        """The half-space of all x with normal · x ≤ offset, as far as `reach`."""
        n, d, r = floats("normal", normal).copy(), number("offset", offset), number("reach", reach)
        return cls._of("plane", lib.pir_body_shape_plane, (n, d, r), vector("normal", n), d, r)

    @classmethod
    def hull(cls, points: npt.ArrayLike, radius: float = 0.0) -> "Shape":
        """The hull of points, (n, 3), grown by a radius."""
        array, r = rows("points", points, 3), number("radius", radius)
        return cls._of("hull", lib.pir_body_shape_hull, (array.copy(), r), pointer(array, "pir_vec3 *"), len(array), r)

    @classmethod
    def compound(cls, parts: Parts) -> "Shape":
        """Shapes of one radius put together, each with its pose: [(shape, pose), …]."""
        kept: List[Tuple[Shape, Floats]] = []
        try:
            given_ = [(shape, at) for shape, at in parts]
        except (TypeError, ValueError):
            raise InputError("parts: not a sequence of shapes and poses") from None
        for i, (shape, at) in enumerate(given_):
            array, one = poses(f"parts[{i}]", at)
            if not isinstance(shape, Shape) or one:
                raise InputError(f"parts[{i}]: not a Shape and one pose")
            kept.append((shape, array[0].copy()))
        given = ffi.new("pir_body_part[]", len(kept))
        for part, (shape, at_) in zip(given, kept):
            part.shape = shape._pointer
            ffi.memmove(ffi.addressof(part, "pose"), pointer(at_, "char *"), 56)
        return cls._of("compound", lib.pir_body_shape_compound, (tuple(kept),), given, len(kept))

    @classmethod
    def mesh(cls, surface: TriMesh, radius: float = 0.0) -> "Shape":
        """A mesh, for bodies that are static or kinematic."""
        if not isinstance(surface, TriMesh):
            raise InputError(f"surface: not a TriMesh: {surface!r}")
        r = number("radius", radius)
        return cls._of("mesh", lib.pir_body_shape_mesh, (surface, r), surface._mesh, r)

    @classmethod
    def field(cls, surface: HeightField, radius: float = 0.0) -> "Shape":
        """A height field, for bodies that are static or kinematic."""
        if not isinstance(surface, HeightField):
            raise InputError(f"surface: not a HeightField: {surface!r}")
        r = number("radius", radius)
        return cls._of("field", lib.pir_body_shape_field, (surface, r), surface._field, r)

    @property
    def mass(self) -> Mass:
        """Of density 1, the radius counted; a surface has none."""
        found = ffi.new("pir_mass *")
        check(lib.pir_body_shape_mass(self._pointer, found), "mass")
        return mass_of(found)

    def __repr__(self) -> str:
        return f"<Shape: {ffi.string(lib.pir_body_shape_text(self._pointer)).decode()}>"

    def __copy__(self) -> "Shape":
        return self

    def __deepcopy__(self, memo: Any) -> "Shape":
        return self

    def __reduce__(self) -> Tuple[Callable[..., "Shape"], Tuple[Union[str, Any], ...]]:
        return _again, (self._made[0], *self._made[1])


def _again(name: str, *arguments: Any) -> Shape:
    made: Shape = getattr(Shape, name)(*arguments)
    return made
