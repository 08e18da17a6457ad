"""What a result folder holds: run.h5 when the run is finished, before that its segments or parts."""
import os
import re
from collections.abc import Callable

from .. import look
from ..errors import InputError, RunError
from ..files import INTACT


def is_there(path: str) -> bool:
    """Whether there is anything, or where a link there leads. Raises RunError if the system refuses to tell."""
    return _looked(look.leads_somewhere, path)


def _looked(at: Callable[[str], bool], path: str) -> bool:
    try:
        return at(path)
    except OSError as error:
        raise RunError(f"{path}: cannot be looked at: {error.strerror}{INTACT}") from error


def result_files(path: str) -> list[str]:
    """The files that hold the run of a file or folder. Raises InputError if there is nothing, or no run."""
    if not is_there(path):
        raise InputError(f"{path}: must be a result folder or file, got nothing there")
    if not _looked(look.is_folder, path):
        return [path]
    if is_there(whole := os.path.join(path, "run.h5")):
        return [whole]
    if is_there(os.path.join(path, "parts")):
        raise InputError(f"{path}: holds parts of a run that are not merged yet: wait for the programs that compute them, or continue "
                         "with --resume (in Python resume=True)")
    segments = segment_files(path)
    if not segments:
        raise InputError(f"{path}: holds no run (neither run.h5 nor segment-000000.h5)")
    return segments


def segment_files(folder: str) -> list[str]:
    """The segments of an unfinished run, in order. Raises InputError if one is missing."""
    try:
        names = os.listdir(folder)
    except OSError as error:
        raise RunError(f"{folder}: its files cannot be listed: {error.strerror}{INTACT}") from error
    found = {int(match[1]): name for name in names if (match := re.fullmatch(r"segment-(\d{1,6})\.h5", name, re.ASCII))}
    for expected, index in enumerate(sorted(found)):
        if index != expected:
            missing = os.path.join(folder, f"segment-{expected:06}.h5")
            raise InputError(f"{missing}: is missing, though later segments are there")
    return [os.path.join(folder, found[index]) for index in sorted(found)]
