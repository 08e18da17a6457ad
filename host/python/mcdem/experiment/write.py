"""Writes experiment folders."""
import errno
import hashlib
import os
import pathlib
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..errors import RunError
from ..files import write_whole
from ..look import Path
from ..number_text import shortest
from ..outputs import make_folder
from ..results.names import Phase, Wall
from ..results.recording import Floats, Recording
from .contacts import CONTACT_COLUMNS
from .experiment import Experiment
from .grains import GRAIN_COLUMNS
from .plate import PLATE_COLUMNS, set_forces
from .settings import settings_text

SETTINGS_FILE = "experiment.toml"
SUMS_FILE = "SHA256SUMS"
TABLES = ("contacts.csv", "grains.csv", "plate.csv")
ALL_TABLES = (*TABLES, "topology.csv")
WINDOW_OF_GZIP = 15 + 16  # of zlib: the header has no time stamp
NO_SYNC = errno.EINVAL, errno.EROFS  # errors of file systems that cannot flush


def experiment_files(experiment: Experiment, gzip: bool) -> dict[str, bytes]:
    """Contents of the files of an experiment by name, in alphabetical order. Tables without rows are left out."""
    files = dict[str, bytes]()
    for name, lines in zip(TABLES, (_contact_lines, _grain_lines, _plate_lines), strict=True):
        header, *rows = lines(experiment.recording)
        if rows:
            table = "".join([header, *rows]).encode()
            files |= {f"{name}.gz": _packed(table)} if gzip else {name: table}
    return dict(sorted({**files, SETTINGS_FILE: settings_text(experiment).encode(errors="surrogateescape")}.items()))


def sums_text(files: Mapping[str, bytes]) -> str:
    """SHA-256 and name of each file, in the format of `sha256sum --check`."""
    return "".join(f"{hashlib.sha256(content).hexdigest()}  {name}\n" for name, content in files.items())


def write_experiment(folder: Path, experiment: Experiment, gzip: bool = False) -> None:
    """Writes the folder so that read_experiment returns the same content, with exact numbers. Tables of an earlier experiment are removed.

    Raises RunError, OSError.
    """
    make_folder(folder)
    files = experiment_files(experiment, gzip)
    settings = {SETTINGS_FILE: files.pop(SETTINGS_FILE)}
    for name in (table + end for table in ALL_TABLES for end in ("", ".gz")):
        if name not in files:
            pathlib.Path(folder, name).unlink(missing_ok=True)
    write_files(folder, files)
    write_files(folder, settings)  # last, because it makes the folder an experiment


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Writes each file atomically; they are on the disk afterwards. Raises RunError."""
    for name, content in files.items():
        try:
            write_whole(pathlib.Path(folder, name), content)
        except OSError as error:
            raise RunError(f"{pathlib.Path(folder, name)}: cannot be written: {error.strerror or error}") from error
    sync_folder(folder)


def sync_folder(folder: Path) -> None:
    """Flushes the names in the folder to the disk. Raises RunError."""
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
    except OSError as error:
        if error.errno not in NO_SYNC:
            raise RunError(f"{folder}: cannot be written: {error.strerror}") from error


def _packed(table: bytes) -> bytes:
    packer = zlib.compressobj(6, zlib.DEFLATED, WINDOW_OF_GZIP)
    return packer.compress(table) + packer.flush()


def _lines(columns: Sequence[Iterable[str]]) -> Iterator[str]:
    return (",".join(row) + "\n" for row in zip(*columns, strict=True))


def _texts(values: Floats) -> list[str]:
    return [shortest(value) for value in values.tolist()]


def _wholes(values: NDArray[np.int64]) -> list[str]:
    return [str(value) for value in values.tolist()]


def _contact_lines(recording: Recording) -> Iterator[str]:
    yield ",".join(CONTACT_COLUMNS) + "\n"
    walls = {str(-1 - wall): recording.box.wall_name(wall) for wall in Wall}
    for scan, contacts in enumerate(recording.scans.contacts):
        partner = [walls.get(word, word) for word in _wholes(contacts.partner)]
        yield from _lines([[str(scan)] * len(contacts), _wholes(contacts.grain), partner, *map(_texts, contacts.point.T),
                           *map(_texts, contacts.force.T)])


def _grain_lines(recording: Recording) -> Iterator[str]:
    yield ",".join(GRAIN_COLUMNS) + "\n"
    diameter = _texts(recording.diameter)
    for scan, position in enumerate(recording.scans.position):
        if grains := len(position):
            yield from _lines([[str(scan)] * grains, map(str, range(grains)), *map(_texts, position.T), diameter])


def _plate_lines(recording: Recording) -> Iterator[str]:
    scans = recording.scans
    columns = dict(zip(PLATE_COLUMNS, ([str(scan) for scan in range(len(scans))], _wholes(scans.cycle),
                                       [Phase(phase).name for phase in scans.phase.tolist()], _texts(scans.plate_z),
                                       _texts(scans.top_force)), strict=True))
    set_force = set_forces(recording) if recording.has_programme else []
    if any(force is not None for force in set_force):
        columns["set_force_N"] = ["" if force is None else shortest(force) for force in set_force]
    if recording.has_programme:
        columns["time_s"] = _texts(scans.time)
    yield ",".join(columns) + "\n"
    yield from _lines(list(columns.values()))
