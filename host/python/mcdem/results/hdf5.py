"""Reads HDF5 files that may be damaged or foreign: every failure is an error that names the file and the object.

InputError for wrong content, RunError if the system refuses to read. HDF5 checks the checksums (host/io/README.md).
"""
import contextlib
import errno
import io
import math
import os
import re
import traceback
from collections.abc import Iterator
from types import TracebackType
from typing import Any, NoReturn

os.environ.setdefault("HDF5_PLUGIN_PRELOAD", "::")  # a file must not name programs to load
import h5py  # noqa: E402
import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..errors import InputError, RunError
from ..files import INTACT, expect_regular

DAMAGED = "; the file is damaged or was not written by this program: restore it from a copy or run again"
ELSEWHERE = ": lies outside this file: mcdem never writes external links; use a file that contains all its data"
MAX_NUMBERS, MAX_TEXT_SIZE = 1000, 1 << 20  # of an attribute; a larger one indicates damage
# Deflate compresses at most 1032:1. A table that claims more than its file can contain is damaged.
MAX_BYTES_PER_BYTE, SMALL_TABLE = 1100, 1 << 20


def fail(where: str, what: str, error: Exception | None = None, reasoned: bool = True) -> NoReturn:
    """Raises the error with its reason: that of the system, otherwise (`reasoned`) the innermost one of the library."""
    text = str(error or "")
    system = errno.ENOMEM if isinstance(error, MemoryError) or "memory allocation failed" in text else getattr(error, "errno", None)
    if system:
        raise RunError(f"{where}: {what}: {os.strerror(system)}{INTACT}") from error
    reason = re.search(r"\((.*)\)", text, re.DOTALL) if reasoned else None
    raise InputError(f"{where}: {what}{f' ({reason[1]})' if reason else ''}{DAMAGED}") from error


class _Bytes(io.FileIO):
    """What HDF5 reads from. HDF5 itself crashes at its end where the system refuses to close a file, and does not tell h5py why a read failed."""

    error: OSError | None = None  # of the first read that the system refused

    def readinto(self, buffer: Any) -> int:
        """Fills the buffer; less at the end of the file."""
        rest, filled = memoryview(buffer), 0
        try:
            while filled < len(rest) and (count := super().readinto(rest[filled:])):
                filled += count
        except OSError as error:
            self.error = self.error or error
            raise
        return filled


class File:
    """An open file; use it in a `with`."""

    def __init__(self, path: str) -> None:
        expect_regular(path)
        self.path = path
        try:
            self._bytes = _Bytes(path)
        except OSError as error:
            fail(path, "cannot be opened", error)
        try:
            with self._failing(path, "cannot be opened as HDF5"):
                self._file: Any = h5py.File(self._bytes, "r")
                self._size = os.fstat(self._bytes.fileno()).st_size
        except BaseException:
            self._close()
            raise

    @contextlib.contextmanager
    def _failing(self, where: str, what: str, reasoned: bool = True) -> Iterator[None]:
        """Damaged files raise exceptions of many types in h5py."""
        try:
            yield
        except (InputError, RunError):
            raise
        except Exception as error:
            traceback.clear_frames(error.__traceback__)  # what they hold of HDF5 must be closed before Python ends
            fail(where, what, self._bytes.error or error, reasoned)

    def __enter__(self) -> "File":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._file.close()
        self._close()

    def _close(self) -> None:
        with contextlib.suppress(OSError):  # nothing was written
            self._bytes.close()

    def where(self, name: str) -> str:
        return f"{self.path}: {name}"

    def _link(self, name: str) -> Any:
        """None if nothing is there."""
        with self._failing(self.where(name), "cannot be looked for"):
            return self._file.get(name, getlink=True)

    def exists(self, name: str) -> bool:
        return all(self._link(part) is not None for part in _with_parents(name))

    def _object(self, name: str) -> Any:
        """Refuses links to other objects, inside or outside the file."""
        for part in _with_parents(name):
            link = self._link(part)
            if link is None:
                break
            if not isinstance(link, h5py.HardLink):
                raise InputError(self.where(part) + ELSEWHERE)
        with self._failing(self.where(name), "cannot be found"):
            return self._file[name]

    def count(self, group: str) -> int:
        """Number of the objects in a group."""
        with self._failing(self.where(group), "cannot be listed"):
            return len(list(self._object(group)))

    def has_attribute(self, name: str, attribute: str) -> bool:
        if not self.exists(name):
            return False
        found = self._object(name)
        with self._failing(self.where(name), "cannot be looked for"):
            return attribute in found.attrs

    def _attribute(self, name: str, attribute: str) -> tuple[Any, int, Any]:
        """Its type, number of values, and values."""
        found, where = self._object(name), self.where(name)
        with self._failing(where, f"attribute '{attribute}' cannot be found"):
            handle = found.attrs.get_id(attribute)
            kind, count = handle.get_type(), handle.get_space().get_simple_extent_npoints()
        if count > MAX_NUMBERS or kind.get_size() > MAX_TEXT_SIZE:
            fail(where, f"attribute '{attribute}' is too long")
        with self._failing(where, f"attribute '{attribute}' cannot be read"):
            return kind, count, found.attrs[attribute] if count else ()

    def text_attribute(self, name: str, attribute: str) -> str:
        kind, count, value = self._attribute(name, attribute)
        if not isinstance(kind, h5py.h5t.TypeStringID) or kind.is_variable_str() or count != 1:
            fail(self.where(name), f"attribute '{attribute}' must be a text")
        return _text(np.ravel(value)[0])

    def numbers_attribute(self, name: str, attribute: str) -> list[float]:
        kind, _, value = self._attribute(name, attribute)
        if not isinstance(kind, (h5py.h5t.TypeIntegerID, h5py.h5t.TypeFloatID)):
            fail(self.where(name), f"attribute '{attribute}' must hold numbers")
        return [float(number) for number in np.ravel(value)]

    def integer_attribute(self, name: str, attribute: str) -> int:
        kind, count, value = self._attribute(name, attribute)
        if not isinstance(kind, h5py.h5t.TypeIntegerID) or count != 1:
            fail(self.where(name), f"attribute '{attribute}' must be an integer")
        return int(np.ravel(value)[0])

    def table(self, name: str, row: tuple[int, ...] | None = ()) -> NDArray[Any]:
        """All values as stored. `row`: the shape of each row; None: any."""
        found, where = self._object(name), self.where(name)
        if not isinstance(found, h5py.Dataset):
            fail(where, "cannot be found")
        with self._failing(where, "has no type"):
            elsewhere, kind, shape = bool(found.external) or found.is_virtual, found.dtype, found.shape
        if elsewhere:
            raise InputError(where + ELSEWHERE)
        if not shape:
            fail(where, "must be a table of rows")
        if math.prod(shape) * kind.itemsize > SMALL_TABLE + MAX_BYTES_PER_BYTE * self._size:
            fail(where, "claims to hold more than the file can")
        if row is not None and shape[1:] != row:
            fail(where, "has rows of another size than expected")
        if kind.hasobject:
            fail(where, "must hold texts of fixed length" if h5py.check_string_dtype(kind) else "cannot be read")
        with self._failing(where, "cannot be read", reasoned=False):
            values: NDArray[Any] = found[()]
        return values

    def numbers(self, name: str, kind: DTypeLike, row: tuple[int, ...] = ()) -> NDArray[Any]:
        return self.converted(name, self.table(name, row), kind, row)

    def converted(self, name: str, values: NDArray[Any], kind: DTypeLike, row: tuple[int, ...]) -> NDArray[Any]:
        """Numbers of a table, or of a field of one, as another type."""
        if values.dtype.kind not in "iufb" or values.shape[1:] != row:
            fail(self.where(name), "cannot be read")
        with np.errstate(invalid="ignore", over="ignore"):
            return values.astype(kind)

    def fields(self, name: str) -> NDArray[Any]:
        """A table of named fields."""
        rows = self.table(name)
        if not rows.dtype.names:
            fail(self.where(name), "must be a table of named fields")
        return rows

    def texts(self, name: str) -> list[str]:
        values = self.table(name, None)
        if values.dtype.kind != "S":
            fail(self.where(name), "must hold texts of fixed length")
        return [_text(value) for value in values.ravel()]


def _with_parents(name: str) -> list[str]:
    """ "/a", "/a/b" for "/a/b"."""
    parts = name.strip("/").split("/")
    return ["/" + "/".join(parts[:k + 1]) for k in range(len(parts))]


def _text(value: bytes) -> str:
    return bytes(value).split(b"\0")[0].decode("utf-8", "surrogateescape")
