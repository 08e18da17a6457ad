"""Atomic file writes, and protection of existing files."""
import contextlib
import fcntl
import os
import pathlib
import re
import secrets

from .errors import InputError

HEAD = 1 << 16  # bytes of a file by which its kind is recognised
TEMPORARY = re.compile(r".+\.[0-9a-f]{16}\.tmp")


@contextlib.contextmanager
def new_file(file):
    """A temporary file to write bytes to, which is then flushed to disk and renamed. An OSError names the file."""
    file = pathlib.Path(file)
    temporary = file.with_name(f"{file.name}.{secrets.token_hex(8)}.tmp")
    try:
        with open(temporary, "xb") as out:
            lock(out)  # others remove only unlocked files (host/core/atomic_file.cpp)
            yield out
            out.flush()
            os.fsync(out.fileno())
        os.replace(temporary, file)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(file)) from error
    finally:
        temporary.unlink(missing_ok=True)


def write_whole(file, content):
    """Writes bytes by new_file."""
    with new_file(file) as out:
        out.write(content)


def lock(file):
    """Locks an open file or folder; False if another program has locked it. Some network file systems have no locks."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True


def remove_temporaries(folder):
    """Removes files that killed programs have left; others are locked."""
    for file in pathlib.Path(folder).iterdir():
        if TEMPORARY.fullmatch(file.name) and file.is_file():
            with contextlib.suppress(OSError), open(file, "rb") as left:
                if lock(left):
                    file.unlink()


def expect_no_experiment(folder):
    if os.path.lexists(folder / "experiment.toml"):
        raise InputError(f"{folder}: is the folder of an experiment, into which nothing else is written: give another folder (--out)")


@contextlib.contextmanager
def output_folder(folder):
    """A folder for this program alone, which is created. Raises InputError if it is an experiment or others write there."""
    folder = pathlib.Path(folder)
    expect_no_experiment(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as error:
        raise InputError(f"{folder}: must be a folder, got something else there") from error
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        if not lock(descriptor):
            raise InputError(f"{folder}: another program is writing there: wait for it, or give another folder")
        expect_no_experiment(folder)  # may have been created by another program in the meantime
        remove_temporaries(folder)
        yield folder
    finally:
        os.close(descriptor)


def expect_replaceable(file, what, begins, holds=b""):
    """Raises InputError unless the path is free, or holds an empty file, or one of mcdem: `what`, with these marks in its head."""
    def refuse(problem):
        raise InputError(f"{file}: {problem}, and is not replaced: give another place (--out), or remove it first")

    if not os.path.lexists(file):
        return
    if not os.path.isfile(file):
        refuse("is there, but is no file")
    with open(file, "rb") as there:
        head = there.read(HEAD)
    if head and not (head.startswith(begins) and holds in head):
        refuse(f"is not {what}")
