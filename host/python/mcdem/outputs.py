"""Outputs that a command writes again when it is run again, and folders for them.

mcdem replaces only files that it wrote itself with the same kind of content, recognised by their content, whatever the file name.
"""
import contextlib
import fcntl
import os
import pathlib
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass

from .errors import InputError, RunError
from .files import write_whole
from .look import Path, is_file, is_folder, is_link, is_there

HEAD = 1 << 16  # bytes of a file by which its kind is recognised


@dataclass(frozen=True)
class Kind:
    """What a file of this kind is, how it begins, and what its first `head` bytes hold."""
    what: str
    begins: bytes
    holds: bytes = b""
    head: int = HEAD


PAGE = Kind("a page of mcdem", b"<!doctype html>", b'<meta name="generator" content="mcdem">')
FIGURE = Kind("a figure of mcdem", b"", b"mcdem figure", 1 << 24)  # a PDF names its producer at the end
FIGURE_VALUES = Kind("the values of figures", b'{\n "mcdem_figures"')
CALIBRATION = Kind("a calibration", b"{\n", b'"target_top_force_N"', 1 << 24)  # keys are sorted: rounds and scene come before
WHAT_IF = Kind("a table of what-if", b"{\n", b'"what_if_target"', 1 << 24)
CONVERGENCE = Kind("a table of convergence", b"{\n", b'"deviations"')
DIAGNOSIS = Kind("a diagnosis", b"{\n", b'"p_omnibus"')

TEMPORARY = re.compile(r"(.+)\.[0-9a-f]{16}\.tmp", re.DOTALL)  # files.new_file and host/core/atomic_file.cpp


def expect_replaceable(file: Path, kind: Kind) -> None:
    """Raises InputError unless the path is free, or holds an empty file or a file of this kind."""
    problem = None
    if is_file(file):
        with open(file, "rb") as there:
            head = there.read(kind.head)
        if head and not (head.startswith(kind.begins) and kind.holds in head):
            problem = f"is not {kind.what}"
    elif is_there(file):
        problem = "exists and is not a regular file"
    if problem:
        raise InputError(f"{file}: {problem}; it is not replaced: give another path (--out), or remove it first")


def replace_own(file: Path, kind: Kind, content: bytes) -> None:
    """Writes the file atomically. Raises InputError as expect_replaceable, and RunError if it cannot be written."""
    expect_replaceable(file, kind)
    remove_temporaries_of(file)
    try:
        write_whole(file, content)
    except OSError as error:
        raise RunError(f"{file}: cannot be written: {error.strerror or error}") from error


def remove_temporaries(folder: Path, name: str | None = None) -> None:
    """Removes temporary files and folders of killed programs, of the file `name` or of all; running programs lock theirs."""
    with contextlib.suppress(OSError):
        for entry in list(os.scandir(folder)):
            found = TEMPORARY.fullmatch(entry.name)
            if found and name in (None, found[1]):
                _remove_if_abandoned(entry.path)


def remove_temporaries_of(file: Path) -> None:
    """Likewise, of one file."""
    remove_temporaries(pathlib.Path(file).parent, pathlib.Path(file).name)


def _remove_if_abandoned(path: str) -> None:
    with contextlib.suppress(OSError):
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if is_folder(path):
                shutil.rmtree(path, ignore_errors=True)
            else:
                os.unlink(path)
        finally:
            os.close(descriptor)


def make_folder(folder: Path) -> None:
    """Creates a folder and its parents if necessary. Raises RunError if that fails or it is not writable: before long work."""
    try:
        if not is_folder(folder):
            os.makedirs(folder)
    except OSError as error:
        if not isinstance(error, FileExistsError):
            raise RunError(f"{folder}: cannot be made: {error.strerror}") from error
        if is_link(folder):
            raise RunError(f"{folder}: must be a folder, is a link to nothing that is there: remove it") from error
        if not is_folder(folder):  # made by another program meanwhile
            raise RunError(f"{folder}: cannot be made: Not a directory") from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise RunError(f"{folder}: cannot be written to: Permission denied")


def make_folder_of(file: Path) -> None:
    make_folder(pathlib.Path(file).parent)


@contextlib.contextmanager
def output_folder(folder: Path, shared: bool = False) -> Iterator[pathlib.Path]:
    """Creates a folder if necessary and locks it against other programs, or shared with those that share it. Removes temporary files of
    killed programs in it, unless it is shared.

    Raises InputError for a file, for the folder of an experiment, and if another program uses the folder; RunError if it cannot be
    created or written.
    """
    _expect_no_experiment(folder)
    if is_file(folder):
        raise InputError(f"{folder}: is a file; give a folder for the results")
    make_folder(folder)
    with locked_folder(folder, shared):
        _expect_no_experiment(folder)  # may have been created by another program in the meantime
        yield pathlib.Path(folder)


@contextlib.contextmanager
def locked_folder(folder: Path, shared: bool = False) -> Iterator[None]:
    """The lock of output_folder on a folder that is there, with its errors."""
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError as error:
        raise RunError(f"{folder}: cannot be opened: {error.strerror}") from error
    try:
        _lock(descriptor, folder, shared)
        yield
    finally:
        os.close(descriptor)


def _expect_no_experiment(folder: Path) -> None:
    if is_there(pathlib.Path(folder) / "experiment.toml"):
        raise InputError(f"{folder}: is the folder of an experiment, into which nothing else is written: give another folder (--out)")


def _lock(descriptor: int, folder: Path, shared: bool) -> None:
    try:
        fcntl.flock(descriptor, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
        if not shared:
            remove_temporaries(folder)
        return
    except BlockingIOError:
        pass
    except OSError:  # some network file systems have no locks
        return
    raise InputError(f"{folder}: {_obstacle(descriptor, shared)}, or give another folder")


def _obstacle(descriptor: int, shared: bool) -> str:
    """Why the lock is not available, and a remedy."""
    if shared:
        return "another program is writing there alone, which cannot be shared: wait for it"
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return "other programs share work there: wait for them"
    except OSError:
        return "another program is writing there: wait for it"
