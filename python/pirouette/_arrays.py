# SPDX-License-Identifier: MIT
"""Arrays in and out: what is float64 and in C order goes through as it is, anything else is converted once."""
from __future__ import annotations

from typing import Any, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._check import InputError, error
from ._native import ffi, lib

Floats = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]
Indices = npt.NDArray[np.uint32]
Bools = npt.NDArray[np.bool_]


def floats(name: str, value: Any) -> Floats:
    """`value` as float64 in C order, without a copy where it is so already."""
    try:
        array = np.asarray(value)
        if array.dtype.kind == "c":
            raise TypeError("it is complex")
        return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)
    except (TypeError, ValueError, OverflowError) as wrong:
        raise InputError(f"{name}: not an array of numbers: {wrong}") from None


def number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: not a number: {value!r}") from None


def whole(name: str, value: Any, least: int, most: int) -> int:
    try:
        plain = value.item() if isinstance(value, (np.ndarray, np.generic)) and value.ndim == 0 else value
        found = int(plain)
        if isinstance(plain, np.ndarray) or found != plain:
            raise ValueError
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: not a whole number: {value!r}") from None
    if not least <= found <= most:
        raise InputError(f"{name}: {found} is not in {least} to {most}")
    return found


def rows(name: str, value: Any, width: int) -> Floats:
    """`value` as an array of shape (n, width)."""
    array = floats(name, value)
    if array.ndim != 2 or array.shape[1] != width:
        if array.size == 0 and array.ndim <= 2:
            return np.empty((0, width))
        raise InputError(f"{name}: its shape is {array.shape}, not (n, {width})")
    return array


def vectors(name: str, value: Any, width: int) -> Tuple[Floats, Tuple[int, ...]]:
    """`value` as (n, width), of one vector or of several, and the shape of what comes back."""
    array = floats(name, value)
    if array.shape == (width,):
        return array.reshape(1, width), ()
    return rows(name, array, width), (int(rows(name, array, width).shape[0]),)


def indices(name: str, value: Any, width: Optional[int] = None) -> Indices:
    """`value` as numbers of things: whole, 0 or more."""
    try:
        array = np.asarray(value) if width is not None else np.atleast_1d(np.asarray(value))
    except (TypeError, ValueError) as wrong:
        raise InputError(f"{name}: not an array of whole numbers: {wrong}") from None
    if array.size == 0 and array.dtype.kind != "c":
        array = array.reshape((0,) if width is None else (0, width)).astype(np.uint32)
    if array.dtype.kind not in "iu":
        raise InputError(f"{name}: its numbers are {array.dtype}, not whole numbers")
    if array.ndim != (1 if width is None else 2) or (width is not None and array.shape[1] != width):
        raise InputError(f"{name}: its shape is {array.shape}, not {'(n,)' if width is None else f'(n, {width})'}")
    if array.size and (array.min() < 0 or array.max() >= 2**32):
        raise InputError(f"{name}: it has numbers below 0 or from 2^32 on")
    return np.ascontiguousarray(array, dtype=np.uint32)


def room(name: str, out: Optional[Floats], shape: Tuple[int, ...]) -> Floats:
    """The caller's array for results, or a new one."""
    if out is None:
        return np.empty(shape)
    if (not isinstance(out, np.ndarray) or out.dtype != np.float64 or out.shape != shape or
            not out.flags.c_contiguous or not out.flags.writeable):
        raise InputError(f"{name}: it is no writable float64 array in C order of shape {shape}")
    return out


def pointer(array: Optional[npt.NDArray[Any]], kind: str = "double *") -> Any:
    """Where an array begins; the caller keeps the array."""
    return ffi.NULL if array is None else ffi.cast(kind, array.ctypes.data)


def _quaternions(matrices: Floats) -> Floats:
    """Quaternions, x, y, z, w, of rotation matrices, by the largest of the four numbers."""
    m = matrices
    d0, d1, d2 = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    four = np.stack([1 + d0 - d1 - d2, 1 - d0 + d1 - d2, 1 - d0 - d1 + d2, 1 + d0 + d1 + d2], axis=1)
    xy, xz, yz = m[:, 0, 1] + m[:, 1, 0], m[:, 0, 2] + m[:, 2, 0], m[:, 1, 2] + m[:, 2, 1]
    xw, yw, zw = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    table = np.stack([four[:, 0], xy, xz, xw, xy, four[:, 1], yz, yw, xz, yz, four[:, 2], zw, xw, yw, zw,
                      four[:, 3]], axis=1).reshape(-1, 4, 4)
    found: Floats = table[np.arange(len(m)), np.argmax(four, axis=1)]
    return found


def _from_matrices(name: str, array: Floats) -> Floats:
    turn = array[:, :3, :3]
    with np.errstate(all="ignore"):
        off = np.abs(turn @ np.swapaxes(turn, 1, 2) - np.eye(3)).max(axis=(1, 2))
        good = (off <= 1e-6) & (np.linalg.det(np.nan_to_num(turn, posinf=0, neginf=0)) > 0)
        good &= (array[:, 3] == [0, 0, 0, 1]).all(axis=1)
        finite = np.isfinite(array).all(axis=(1, 2))
    if not (good | ~finite).all():
        raise InputError(f"{name}: matrix {int(np.argmin(good | ~finite))} is no rotation with a translation")
    made = np.empty((len(array), 7))
    made[:, :4] = _quaternions(np.where(finite[:, None, None], turn, np.nan))
    made[:, 4:] = array[:, :3, 3]
    return made


def poses(name: str, value: Any) -> Tuple[Floats, Tuple[int, ...]]:
    """Poses as (n, 7): x, y, z, w of the quaternion, then the translation; and the shape of what comes back: () of
    one pose, (n,) of several."""
    array = floats(name, value)
    if array.shape == (7,):
        return array.reshape(1, 7), ()
    if array.shape == (4, 4):
        return _from_matrices(name, array.reshape(1, 4, 4)), ()
    if array.ndim == 2 and array.shape[1] == 7:
        return array, (array.shape[0],)
    if array.ndim == 3 and array.shape[1:] == (4, 4):
        return _from_matrices(name, array), (array.shape[0],)
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 7)), (0,)
    raise InputError(f"{name}: its shape is {array.shape}, not (7,), (n, 7), (4, 4) or (n, 4, 4)")


def quaternion(name: str, value: Any) -> Any:
    """A rotation for the library."""
    array = floats(name, value)
    if array.shape == (3, 3):
        matrix = np.eye(4)
        matrix[:3, :3] = array
        array = _from_matrices(name, matrix.reshape(1, 4, 4))[0, :4]
    if array.shape != (4,):
        raise InputError(f"{name}: its shape is {array.shape}, not (4,), x, y, z, w, or (3, 3)")
    return {"x": array[0], "y": array[1], "z": array[2], "w": array[3]}


def vector(name: str, value: Any) -> Any:
    array = floats(name, value)
    if array.shape != (3,):
        raise InputError(f"{name}: its shape is {array.shape}, not (3,)")
    return {"x": array[0], "y": array[1], "z": array[2]}


def path_of(value: Any) -> bytes:
    import os
    try:
        return os.fsencode(value)
    except TypeError:
        raise InputError(f"path: not a path: {value!r}") from None


def _dtype(kind: Any) -> Any:
    if kind.kind == "primitive":
        name = kind.cname
        if name in ("double", "float"):
            return np.dtype(f"f{ffi.sizeof(kind)}")
        return np.dtype("?") if name == "_Bool" else np.dtype(f"{'i' if name[0] == 'i' else 'u'}{ffi.sizeof(kind)}")
    if kind.kind == "enum":
        return np.dtype("u4")
    if kind.kind == "pointer":
        return np.dtype("u8")
    if kind.kind == "array":
        return np.dtype((_dtype(kind.item), (kind.length,)))
    fields = kind.fields
    if [name for name, _ in fields] in (["x", "y", "z"], ["x", "y", "z", "w"]):
        return np.dtype((np.float64, (len(fields),)))
    return np.dtype({"names": [name for name, _ in fields], "formats": [_dtype(field.type) for _, field in fields],
                     "offsets": [field.offset for _, field in fields], "itemsize": ffi.sizeof(kind)})


def dtype_of(name: str) -> "np.dtype[Any]":
    """The dtype of a struct of the library, field by field; vectors are three numbers."""
    made: "np.dtype[Any]" = _dtype(ffi.typeof(name))
    return made


def fail_at(status: int, name: str, index: int) -> None:
    """Raises what element `index` of an argument has for its status."""
    if status != lib.PIR_OK:
        raise error(status, f"{name}[{index}]")
