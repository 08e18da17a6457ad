"""Atomic file writes, and protection of existing files."""
import contextlib
import fcntl
import os
import pathlib
import secrets
import shutil
import tempfile

from .errors import InputError
from .look import is_file, is_there

HEAD = 1 << 16  # bytes of a file by which its kind is recognised
unfinished: set[str | pathlib.Path] = set()  # paths of temporary files and folders


def remove_unfinished():
    """When the command is ended in the middle of its work (program.py)."""
    for path in list(unfinished):
        shutil.rmtree(path, ignore_errors=True)
        with contextlib.suppress(OSError):
            os.unlink(path)


@contextlib.contextmanager
def temporary_folder():
    """A folder of this user alone, for as long as the context lasts."""
    with tempfile.TemporaryDirectory(prefix="mcdem-") as folder:
        unfinished.add(folder)
        try:
            yield pathlib.Path(folder)
        finally:
            unfinished.discard(folder)


def read_whole(file):
    """The file's bytes. An OSError names the file, also one of reading."""
    try:
        return pathlib.Path(file).read_bytes()
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(file)) from error


@contextlib.contextmanager
def new_file(file):
    """A temporary file to write bytes to, which is then flushed to disk and renamed. An OSError names the file."""
    file = pathlib.Path(file)
    temporary = file.with_name(f"{file.name}.{secrets.token_hex(8)}.tmp")
    unfinished.add(temporary)
    try:
        with open(temporary, "xb") as out:
            # Others remove only unlocked files (host/core/atomic_file.cpp); some network file systems have no locks.
            with contextlib.suppress(OSError):
                fcntl.flock(out, fcntl.LOCK_EX)
            yield out
            out.flush()
            os.fsync(out.fileno())
        os.replace(temporary, file)
    except OSError as error:
        if error.errno is None or error.filename not in (None, str(temporary)):
            raise  # of another file
        raise OSError(error.errno, error.strerror, str(file)) from error
    finally:
        temporary.unlink(missing_ok=True)
        unfinished.discard(temporary)


def write_whole(file, content):
    """Writes bytes by new_file."""
    with new_file(file) as out:
        out.write(content)


def expect_replaceable(file, what, begins, holds=b""):
    """Raises InputError unless the path is free, or holds an empty file or `what` mcdem wrote, which has these marks in its head."""
    problem = None
    if is_file(file):
        with open(file, "rb") as there:
            head = there.read(HEAD)
        if head and not (head.startswith(begins) and holds in head):
            problem = f"is not {what}"
    elif is_there(file):
        problem = "exists and is not a regular file"
    if problem:
        raise InputError(f"{file}: {problem}; it is not replaced: give another path (--out), or remove it first")
