"""Reads complete runs."""
import os
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..errors import InputError, RunError
from .folder import result_files
from .recording import Recording, Run, Scans
from .run_file import Chosen, read_file


def read_run(path: str | os.PathLike[str], contacts: bool = False, positions: Chosen = False) -> Run:
    """The run in a result file, or in a result folder: its run.h5, otherwise the segments of an unfinished run.

    Averages of scans are always read; contacts and positions, which are most of the data, on request: positions of all replicas, or of
    those with these numbers.
    Raises InputError for what is no run or damaged, RunError if the system refuses to read.
    """
    run: Run | None = None
    for file in result_files(os.fspath(path)):
        try:
            part = read_file(file, contacts, positions)
        except MemoryError:
            raise RunError(f"{file}: not enough memory; read it scan by scan, or on a larger machine") from None
        run = _joined(run, part, file) if run else part
    assert run
    return run


def _joined(run: Run, part: Run, file: str) -> Run:
    """Everything of the first file, with the scans and failures of the next."""
    def identity(one: Run) -> list[tuple[str, int]]:
        return [(recording.label, len(recording.diameter)) for recording in one.recordings]

    if identity(run) != identity(part):
        raise InputError(f"{file}: belongs to another run than the segments before it")
    return replace(run, recordings=tuple(_extended(one, more) for one, more in zip(run.recordings, part.recordings, strict=True)))


def _extended(recording: Recording, more: Recording) -> Recording:
    values: dict[str, Any] = {}
    for name in (field.name for field in fields(Scans)):
        before, after = getattr(recording.scans, name), getattr(more.scans, name)
        values[name] = before + after if isinstance(before, tuple) else np.concatenate([before, after])
    return replace(recording, scans=Scans(**values), failure=more.failure or recording.failure)
