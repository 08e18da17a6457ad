"""Moves a finished experiment to the folder of --out: nothing of it is there, or all.

The files are first written to a temporary folder on the same file system. A new folder then appears by one rename. In a folder that exists
a journal lists the files while they are moved, so that the next command can remove those of a killed one; experiment.toml is moved last,
because it makes the folder an experiment.
"""
import contextlib
import fcntl
import hashlib
import os
import pathlib
import secrets
import shutil
from collections.abc import Iterator

from ..errors import InputError, RunError
from ..files import read_input, read_whole, unfinished
from ..look import is_file, is_folder, is_link, is_there, leads_somewhere
from ..outputs import locked_folder, make_folder_of, output_folder, remove_temporaries_of
from ..program import message_of
from .experiment import Experiment
from .read import read_experiment
from .write import ALL_TABLES, SETTINGS_FILE, sums_text, sync_folder, write_files

KEPT = "mapping.toml"  # the one that is there stays
JOURNAL = ".experiment-unfinished"  # SHA-256 and names of the files, as `sha256sum` writes them
DIGITS = 64  # of a SHA-256


def expect_free(out: str) -> None:
    """Removes what a killed `publish` has left in the folder, which is known by its SHA-256.

    Raises InputError if the folder contains another experiment or a run, or another program moves files there; RunError, OSError.
    """
    _remove_unfinished(pathlib.Path(out))
    _expect_no_other(out)


@contextlib.contextmanager
def work_folder(out: str) -> Iterator[pathlib.Path]:
    """A temporary folder on the file system of `out`, for this user alone, for as long as the context lasts.

    It is locked: the next command for `out` removes that of a killed program. Raises RunError.
    """
    whole = pathlib.Path(os.path.abspath(out))
    place = whole / "experiment" if is_there(whole) else whole
    make_folder_of(place)
    remove_temporaries_of(place)
    folder, lock = _new_folder(place)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)
        unfinished.discard(folder)


def read_back(work: pathlib.Path, out: str, heading: str) -> Experiment:
    """Reads an experiment before it is moved to `out`. Raises InputError that begins with the heading and names files as in `out`."""
    try:
        return read_experiment(work)
    except InputError as error:
        begin = str(work)
        raise InputError([heading, *(os.path.normpath(out) + problem.removeprefix(begin) if problem.startswith(begin) else problem
                                     for problem in error.problems)]) from None


def publish(work: pathlib.Path, out: str) -> None:
    """Moves all files of the folder `work`, which are on the disk, to the folder `out`. If that has a mapping.toml, it stays.

    After any failure nothing of the experiment is in `out`, unless the message says so. Raises RunError, OSError, and InputError as
    expect_free and output_folder do.
    """
    whole = pathlib.Path(os.path.abspath(out))
    if is_there(whole):
        _move_files(work, whole)
    else:
        _move_folder(work, whole)


def _new_folder(place: pathlib.Path) -> tuple[pathlib.Path, int]:
    """The folder `<place>.<16 hexadecimal digits>.tmp`, and the descriptor of its lock."""
    while True:
        folder = place.with_name(f"{place.name}.{secrets.token_hex(8)}.tmp")
        unfinished.add(folder)
        try:
            os.mkdir(folder, 0o700)
            with contextlib.suppress(FileNotFoundError):  # another program mistook it for an abandoned one and has removed it
                lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
                with contextlib.suppress(OSError):  # some network file systems have no locks
                    fcntl.flock(lock, fcntl.LOCK_EX)
                if os.fstat(lock).st_nlink > 0:
                    return folder, lock
                os.close(lock)
        except OSError as error:
            unfinished.discard(folder)
            raise RunError(f"{place}: cannot be written: {error.strerror}") from error
        unfinished.discard(folder)


def _remove_unfinished(out: pathlib.Path) -> None:
    if not (is_folder(out) and is_there(out / JOURNAL)):
        return
    with locked_folder(out):
        if is_there(out / JOURNAL):
            _remove_listed(out)


def _remove_listed(out: pathlib.Path) -> None:
    """Removes the files of the journal, as far as they are what it says, and the journal last."""
    for line in read_input(out / JOURNAL).split(b"\n"):
        digest, name = line[:DIGITS], line[DIGITS + 2:]
        if not name or b"\0" in name:
            continue
        file = out / os.path.basename(os.fsdecode(name))
        if is_file(file) and not is_link(file) and hashlib.sha256(read_whole(file)).hexdigest().encode() == digest:
            file.unlink()
    (out / JOURNAL).unlink()


def _expect_no_other(out: str) -> None:
    for taken in (SETTINGS_FILE, "run.h5", "checkpoint.h5"):
        if is_there(os.path.join(out, taken)):
            raise InputError(f"--out: {out} holds another experiment or run: name another folder")
    for name in (table + end for table in ALL_TABLES for end in ("", ".gz")):
        if is_there(os.path.join(out, name)):
            raise InputError(f"--out: {out} already contains {name}, which would become part of this experiment: choose another folder, "
                             "or remove the file first")
    path = os.path.join(os.getcwd(), out)
    while path != os.path.dirname(path):
        if leads_somewhere(path) and not is_folder(path):
            name = os.path.basename(path)
            where = "" if name == os.path.basename(out) else f" in its path, {name}"
            raise InputError(f"--out: {out} must be a folder, got a file{where}")
        path = os.path.dirname(path)


def _move(work: pathlib.Path, to: pathlib.Path) -> None:
    """One rename, which is on the disk afterwards. Raises RunError."""
    try:
        os.rename(work, to)
    except OSError as error:
        raise RunError(f"{to}: cannot be written: {error.strerror}") from error
    sync_folder(to.parent)


def _move_folder(work: pathlib.Path, out: pathlib.Path) -> None:
    """If the rename cannot be made durable, it is undone."""
    try:
        _move(work, out)
    except RunError as error:
        try:
            os.rename(out, work)  # also refused if it was not moved: `work` is not empty
        except OSError:
            if not is_there(work):
                raise RunError(f"{error}; the experiment is there, whole, but a power cut may remove it: check it by "
                               f"`mcdem experiment check {out}`") from error
        raise


def _names_in(work: pathlib.Path, out: pathlib.Path) -> list[str]:
    """The names of the files in the order in which they are moved."""
    names = set(os.listdir(work)) - ({KEPT} if is_there(out / KEPT) else set())
    return sorted(names, key=lambda name: (name == SETTINGS_FILE, name))


def _move_files(work: pathlib.Path, out: pathlib.Path) -> None:
    with output_folder(out):
        _expect_no_other(str(out))  # checked again
        names = _names_in(work, out)
        sums = sums_text({name: read_whole(work / name) for name in names})
        try:
            write_files(out, {JOURNAL: sums.encode()})
            for name in names:
                _move(work / name, out / name)
            (out / JOURNAL).unlink()
        except Exception as error:
            try:
                if is_there(out / JOURNAL):
                    _remove_listed(out)
            except Exception:
                raise RunError(f"{message_of(error)}; files of it are left in {out}: give the same command again, which removes "
                               "them") from error
            raise
