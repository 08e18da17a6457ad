"""Atomic file writes."""
import contextlib
import errno
import fcntl
import os
import pathlib
import secrets
import shutil
import stat
import tempfile
from collections.abc import Iterator
from typing import BinaryIO

from .errors import InputError, RunError
from .look import Path, is_there

INTACT = "; the file may be intact: remove the cause and try again"
NO_LINKS = errno.EPERM, errno.ENOSYS, errno.EOPNOTSUPP  # errors of file systems without links
unfinished: set[str | pathlib.Path] = set()  # paths of temporary files and folders


def remove_unfinished() -> None:
    """When the command is ended in the middle of its work (program.py)."""
    for path in list(unfinished):
        shutil.rmtree(path, ignore_errors=True)
        with contextlib.suppress(OSError):
            os.unlink(path)


@contextlib.contextmanager
def temporary_folder() -> Iterator[pathlib.Path]:
    """A folder of this user alone, for as long as the context lasts."""
    with tempfile.TemporaryDirectory(prefix="mcdem-") as folder:
        unfinished.add(folder)
        try:
            yield pathlib.Path(folder)
        finally:
            unfinished.discard(folder)


def read_whole(file: Path) -> bytes:
    """The file's bytes. An OSError names the file, also one of reading."""
    try:
        return pathlib.Path(file).read_bytes()
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(file)) from error


@contextlib.contextmanager
def new_file(file: Path) -> Iterator[BinaryIO]:
    """A temporary file to write bytes to, which is then flushed to disk and renamed. An OSError names the file."""
    file = pathlib.Path(file)
    temporary, opened = file.with_name(f"{file.name}.{secrets.token_hex(8)}.tmp"), None
    try:
        while opened is None:
            unfinished.add(temporary)
            opened = _locked_file(temporary)
        with opened as out:
            yield out
            out.flush()
            os.fsync(out.fileno())
            os.replace(temporary, file)  # still locked: nobody takes it for abandoned
    except OSError as error:
        if error.errno is None or error.filename not in (None, str(temporary)):
            raise  # of another file
        raise OSError(error.errno, error.strerror, str(file)) from error
    finally:
        temporary.unlink(missing_ok=True)
        unfinished.discard(temporary)


def _locked_file(temporary: pathlib.Path) -> BinaryIO | None:
    """A new file; None if another process took it for abandoned before it was locked. Others remove only unlocked files
    (host/core/atomic_file.cpp); some network file systems have no locks."""
    out = open(temporary, "xb")
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(out, fcntl.LOCK_EX)
        if os.fstat(out.fileno()).st_nlink:
            return out
    except BaseException:
        out.close()
        raise
    out.close()
    return None


def write_whole(file: Path, content: bytes) -> None:
    """Writes bytes by new_file."""
    with new_file(file) as out:
        out.write(content)


def create_whole(file: Path, content: bytes) -> bool:
    """Writes the complete file or nothing. Returns False if the file exists; it is not replaced. Raises RunError."""
    try:
        with new_file(file) as out:
            out.write(content)
            out.flush()
            os.fsync(out.fileno())
            _expect_new(out.name, file)
    except FileExistsError:
        return False
    except OSError as error:
        raise RunError(f"{file}: cannot be written: {error.strerror or error}") from error
    return True


def _expect_new(temporary: str, file: Path) -> None:
    """Links the file to the temporary one, which then takes its place. Raises FileExistsError."""
    try:
        os.link(temporary, file)
    except OSError as error:
        if isinstance(error, FileExistsError) and os.stat(temporary).st_nlink == 2:
            return  # a network file system made the link and lost the reply
        # File systems without links: two programs at the same moment may both create the file.
        if error.errno not in NO_LINKS:
            raise
        if is_there(file):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), temporary) from error


def expect_regular(path: str) -> None:
    """Without waiting for the writer of a pipe."""
    try:
        mode = os.stat(path).st_mode
        if stat.S_ISREG(mode):
            os.close(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC))
            return
    except (FileNotFoundError, NotADirectoryError):
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise RunError(f"{path}: cannot be opened: {error.strerror}{INTACT}") from error
    if stat.S_ISSOCK(mode):
        raise InputError(f"{path}: is a socket or device; give a file")
    raise InputError(f"{path}: is a folder; give a file" if stat.S_ISDIR(mode) else f"{path}: is a pipe or device; give a file")


def read_input(file: Path) -> bytes:
    """The bytes of a file that the user names. Raises InputError if it is not there or no file, RunError if it cannot be opened, and
    OSError with its name if it cannot be read."""
    expect_regular(os.fspath(file))
    return read_whole(file)
