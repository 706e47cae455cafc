"""What the library's calls raise: one class for each result code."""

from __future__ import annotations

__all__ = [
    "Cancelled",
    "DeviceError",
    "Error",
    "FileError",
    "FormatError",
    "InternalError",
    "InvalidArgument",
    "InvalidHandle",
    "InvalidType",
    "LimitError",
    "OutOfMemory",
    "StateError",
]


class Error(RuntimeError):
    """A call failed. The message names file or argument, field, value and limit."""

    code: int = 0
    """The result code of lightband.h."""


class InvalidArgument(Error, ValueError):
    """An argument is not finite, out of range, of the wrong shape or of an unknown name."""

    code = 1


class InvalidType(InvalidArgument, TypeError):
    """An argument is of the wrong type, missing, of an unknown name or one too many."""


class InvalidHandle(Error, ValueError):
    """The object was closed."""

    code = 2


class StateError(Error):
    """The call came too early (no camera, no frame rendered) or from a callback."""

    code = 3


class FileError(Error, OSError):
    """A file cannot be opened, read, written or renamed."""

    code = 4


class FormatError(Error, ValueError):
    """A file is not what it says: truncated, corrupt, out of limits."""

    code = 5


class OutOfMemory(Error, MemoryError):
    """Host memory is exhausted."""

    code = 6


class DeviceError(Error):
    """There is no device, or OpenGL failed; the message lists every attempt."""

    code = 7


class LimitError(Error):
    """A size is beyond what the device or the library can hold."""

    code = 8


class Cancelled(Error):
    """The progress callback asked to stop."""

    code = 9


class InternalError(Error):
    """A defect of the library: please report the message."""

    code = 10


def class_of(code: int) -> type[Error]:
    """The class of a result code; Error itself for an unknown one."""
    return next((kind for kind in Error.__subclasses__() if kind.code == code), Error)
