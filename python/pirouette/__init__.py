# SPDX-License-Identifier: MIT
"""Pirouette: exact Minkowski sums and placement queries of bodies that move. Arrays in, arrays out.

Rotations are quaternions x, y, z, w of any length, or matrices; poses are (n, 7), a quaternion and a translation, or
(n, 4, 4). float64 arrays in C order go through without a copy, anything else is converted. The library runs without
Python's lock, so threads run at once, each on objects of its own; an object that two threads use at once raises
`InUse`. Polytopes, solids and surfaces are immutable, and shared.
"""
from __future__ import annotations

from ._check import Error, FileError, InputError, InUse, NotConvex, OutOfMemory
from ._cspaces import BLOCKED, FREE, HAS_SLICES, UNKNOWN, Configurations, CSpace, Segments
from ._motions import CriticalMap, FirstContact, Sweep
from ._native import ffi as _ffi
from ._native import lib as _lib
from ._pairs import BAD, BOUNDARY, INSIDE, OUTSIDE, ActiveGradients, ActiveSet, Contacts, Distances, Impact, Pair
from ._plans import Plan, plan
from ._polytopes import Facets, Mass, Mesh, Polytope
from ._scenes import BEGAN, ENDED, PERSISTED, BodyState, Events, Scene, SceneHits, SceneImpacts
from ._shapes import Shape
from ._solids import Depths, Pieces, Solid, SolidContacts, SolidPair
from ._sums import LiveMesh, MinkowskiSum, Penetrations
from ._surfaces import HeightField, MeshDistances, MeshPair, Nearest, RayHits, TriMesh
from ._turns import TurnEvent, TurnEvents

__version__: str = _ffi.string(_lib.pir_version()).decode()

__all__ = [
    "ActiveGradients", "ActiveSet", "BAD", "BEGAN", "BLOCKED", "BOUNDARY", "BodyState", "CSpace",
    "Configurations", "Contacts", "CriticalMap", "Depths", "Distances", "ENDED", "Error", "Events", "FREE",
    "Facets", "FileError", "FirstContact", "HAS_SLICES", "HeightField", "INSIDE", "Impact", "InUse",
    "InputError", "LiveMesh", "Mass", "Mesh", "MeshDistances", "MeshPair", "MinkowskiSum", "Nearest",
    "NotConvex", "OUTSIDE", "OutOfMemory", "PERSISTED", "Pair", "Penetrations", "Pieces", "Plan",
    "Polytope", "RayHits", "Scene", "SceneHits", "SceneImpacts", "Segments", "Shape", "Solid",
    "SolidContacts", "SolidPair", "Sweep", "TriMesh", "TurnEvent", "TurnEvents", "UNKNOWN", "plan",
]

# Errors are told by the package's name.
for _kind in (Error, FileError, InputError, InUse, NotConvex, OutOfMemory):
    _kind.__module__ = "pirouette"
del _kind
