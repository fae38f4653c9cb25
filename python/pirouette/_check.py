# SPDX-License-Identifier: MIT
"""Errors, and objects of the library that belong to one thread at a time."""
from __future__ import annotations

import threading
from types import TracebackType
from typing import Any, Optional, Type

from ._native import ffi, lib


class Error(Exception):
    """A call that failed. `status` is the name of the library's status, such as ``"ZERO_QUATERNION"``."""

    status: str

    def __init__(self, message: str, status: str = "ARGUMENT") -> None:
        super().__init__(message)
        self.status = status


class InputError(Error, ValueError):
    """An argument that the call cannot take."""


class NotConvex(InputError):
    """A model that is not convex, or not closed, where a convex one is required."""


class OutOfMemory(Error, MemoryError):
    """Memory ran out."""


class FileError(Error, OSError):
    """A file that cannot be opened, read or written."""

    def __str__(self) -> str:
        return str(self.args[0])


class InUse(Error, RuntimeError):
    """An object that is used by two threads at once."""


_KINDS = {
    lib.PIR_ERR_ARGUMENT: ("ARGUMENT", InputError),
    lib.PIR_ERR_NOT_FINITE: ("NOT_FINITE", InputError),
    lib.PIR_ERR_ZERO_QUATERNION: ("ZERO_QUATERNION", InputError),
    lib.PIR_ERR_MEMORY: ("MEMORY", OutOfMemory),
    lib.PIR_ERR_EMPTY: ("EMPTY", InputError),
    lib.PIR_ERR_FILE: ("FILE", FileError),
    lib.PIR_ERR_FORMAT: ("FORMAT", InputError),
    lib.PIR_ERR_NOT_CLOSED: ("NOT_CLOSED", NotConvex),
    lib.PIR_ERR_NOT_CONVEX: ("NOT_CONVEX", NotConvex),
    lib.PIR_ERR_LIMIT: ("LIMIT", InputError),
    lib.PIR_ERR_NOT_BUILT: ("NOT_BUILT", Error),
    lib.PIR_ERR_REGION: ("REGION", Error),
    lib.PIR_ERR_VERSION: ("VERSION", InputError),
    lib.PIR_ERR_INTERNAL: ("INTERNAL", Error),
}


def status_text(status: int) -> str:
    return str(ffi.string(lib.pir_status_text(status)).decode())


def error(status: int, what: str, report: Any = None) -> Error:
    """The exception of a status, which names what was asked for and has the report's text where there is one."""
    name, kind = _KINDS.get(status, ("INTERNAL", Error))
    text = ffi.string(report.text).decode("utf-8", "replace") if report is not None else ""
    text = text or status_text(status)
    made: Error = kind(text if what in text else f"{what}: {text}", name)
    return made


def check(status: int, what: str, report: Any = None) -> None:
    if status != lib.PIR_OK:
        raise error(status, what, report)


class Handle:
    """An object of the library, given back when it is dropped, used by one thread at a time."""

    _pointer: Any = None

    def __init__(self, pointer: Any, destroy: Any) -> None:
        self._pointer = ffi.gc(pointer, destroy)
        self._lock = threading.Lock()

    def _held(self) -> "_Held":
        return _Held(self)

    def close(self) -> None:
        """Gives the memory back now. Later calls raise."""
        with self._held():
            self._close()

    def _close(self) -> None:
        ffi.release(self._pointer)
        self._pointer = None


class _Held:
    """While it is entered the object is this thread's."""

    __slots__ = ("_handle",)

    def __init__(self, handle: Handle) -> None:
        self._handle = handle

    def __enter__(self) -> Any:
        handle = self._handle
        if not handle._lock.acquire(blocking=False):
            raise InUse(f"this {type(handle).__name__} is used by another thread", "ARGUMENT")
        if handle._pointer is None:
            handle._lock.release()
            raise InputError(f"this {type(handle).__name__} is closed")
        return handle._pointer

    def __exit__(self, kind: Optional[Type[BaseException]], value: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self._handle._lock.release()
