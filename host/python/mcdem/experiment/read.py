"""Reads experiment folders (host/python/mcdem/experiment/README.md) into the form of simulations."""
import contextlib
import math
import os
import pathlib
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..errors import InputError, RunError
from ..files import INTACT
from ..look import Path, is_file, is_folder, is_there, leads_somewhere
from ..problems import Problems
from ..results.recording import Recording
from .contact_averages import with_contact_averages
from .contacts import read_contacts
from .experiment import Experiment
from .grains import read_grains
from .plate import read_plate
from .settings import read_settings
from .table import LARGEST_TABLE, find_table
from .topology import read_topology

LARGEST_SETTINGS = 1_000_000  # [bytes]


def read_experiment(folder: Path, largest: int = LARGEST_TABLE) -> Experiment:
    """The measurements in a folder. Z, <f> and <b> are computed from the contacts at or above the force threshold.

    `largest`: maximum size of a table, uncompressed [bytes]. Raises InputError with all problems, the first 20 in words: file, line and
    remedy; RunError if the system refuses.
    """
    folder, problems = pathlib.Path(folder), Problems()
    with np.errstate(all="ignore"):  # numbers in files can be huge
        with _refusal(folder, "looked at"):
            _expect_experiment(folder)
        with _refusal(folder, "read"):
            settings = read_settings(folder / "experiment.toml", problems)
            recording = _with_tables(folder, settings.recording, settings.materials.get("grains.youngs_modulus", math.inf), problems, largest)
        problems.report()
        if math.isnan(recording.plate_start):
            recording = replace(recording, plate_start=float(recording.scans.plate_z.max()))
        topology = np.zeros((0, 3), int)
        with _refusal(folder, "read"):
            if (file := find_table(folder, "topology.csv", largest, problems)) is not None:
                topology = read_topology(file, recording, problems, largest)
        problems.report()
        averaged = with_contact_averages(recording.scans, recording.box, len(recording.diameter), settings.measurement.force_threshold)
        return replace(settings, topology=topology, recording=replace(recording, scans=averaged))


def read_experiments(folders: Sequence[Path], option: str) -> list[Experiment]:
    """Packings of one experiment; several are named by their folders. Raises InputError, which names the option, if there is none or one
    is given twice; RunError."""
    paths, experiments = [pathlib.Path(folder) for folder in folders], list[Experiment]()
    for path in paths:
        if paths.count(path) > 1:
            raise InputError(f"{option}: {path} is given twice")
        experiment = read_experiment(path)
        experiments.append(replace(experiment, name=str(path)) if len(paths) > 1 else experiment)
    if not experiments:
        raise InputError(f"{option}: must name one folder or more, got none")
    return experiments


@contextlib.contextmanager
def _refusal(folder: pathlib.Path, what: str) -> Iterator[None]:
    """An OSError becomes a RunError: it says nothing about the data."""
    try:
        yield
    except OSError as error:
        raise RunError(f"{error.filename or folder}: cannot be {what}: {error.strerror or error}{INTACT}") from error


def _expect_experiment(folder: pathlib.Path) -> None:
    settings = folder / "experiment.toml"
    if not leads_somewhere(folder):
        raise InputError(f"{folder}: must be an experiment's folder, got nothing there")
    if not is_folder(folder):
        raise InputError(f"{folder}: must be an experiment's folder, got a file")
    if not is_there(settings):
        raise InputError(f"{folder}: is not an experiment: it contains no experiment.toml")
    if not is_file(settings) or os.stat(settings).st_size > LARGEST_SETTINGS:
        raise InputError(f"{settings}: must be a text of at most 1 MB that can be read")


def _with_tables(folder: pathlib.Path, recording: Recording, modulus: float, problems: Problems, largest: int) -> Recording:
    before = problems.count
    with _refusal(folder, "looked at"):
        plate, grains, contacts = (find_table(folder, name, largest, problems) for name in ("plate.csv", "grains.csv", "contacts.csv"))
    if problems.count > before:
        return recording
    if plate is None:
        problems.add(str(folder), "must hold plate.csv or plate.csv.gz: the plate's position and force by frame")
        return recording
    recording = read_plate(plate, modulus, recording, problems, largest)
    if not len(recording.scans):
        return recording
    if grains is not None:
        recording = read_grains(grains, recording, problems, largest)
    if contacts is not None and grains is None:
        problems.add(str(contacts), "needs grains.csv with the grains of frame 0: contacts name them")
    if contacts is None or not len(recording.diameter):  # which is a problem where there are contacts
        return recording
    return read_contacts(contacts, modulus, recording, problems, largest)
