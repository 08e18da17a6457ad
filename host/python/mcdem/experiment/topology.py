"""topology.csv: which grains and walls touch in a frame, where no forces were measured."""
import pathlib
from dataclasses import replace

import numpy as np

from ..problems import Problems
from ..results.recording import Contacts, Ints, Recording
from .contacts import partner_kind
from .experiment import Experiment
from .row_problems import RowProblems, known_frames
from .table import WHOLE, read_table

TOPOLOGY_COLUMNS = ("frame", "grain", "partner")


def read_topology(file: pathlib.Path, recording: Recording, problems: Problems, largest: int) -> Ints:
    """(N, 3) frame, grain and partner (a grain, or a wall as -1 - wall). Raises InputError, RunError, OSError."""
    table = read_table(file, {"frame": WHOLE, "grain": WHOLE, "partner": partner_kind(recording.box)}, {}, largest, problems)
    if table is None:
        return np.zeros((0, 3), int)
    found, grains = RowProblems(table), len(recording.diameter)
    frame, grain, partner = (table[column] for column in TOPOLOGY_COLUMNS)
    known_frames(found, len(recording.scans), table.valid("grain", "partner"))
    found.add_wrong("grain", "partner")
    found.add((grain >= grains) | (partner >= grains), lambda row: f"grain and partner must be grains of grains.csv, 0 to {grains - 1}, or a wall, got "
                                                                   f"{grain[row]} and {partner[row]}")
    found.add(grain == partner, lambda row: f"grain {grain[row]} cannot touch itself")
    found.report(problems)
    return np.column_stack([frame, grain, partner])


def with_listed_contacts(experiment: Experiment) -> Recording:
    """The experiment's recording; without contact forces, with the contacts that topology.csv lists, each once, whose forces are NaN."""
    recording, listed = experiment.recording, experiment.topology
    if not len(listed) or not experiment.has_grains_alone:
        return recording
    frame, grain, partner = listed.T
    between = partner >= 0
    first = np.where(between, np.minimum(grain, partner), grain)
    rows = np.unique(np.column_stack([frame, first, np.where(between, np.maximum(grain, partner), partner)]), axis=0)
    unknown = np.full((len(rows), 3), np.nan)
    every = Contacts(rows[:, 1], rows[:, 2], unknown, unknown, unknown[:, 0])
    ends = np.searchsorted(rows[:, 0], np.arange(len(recording.scans) + 1))
    contacts = tuple(every.rows(slice(begin, end)) for begin, end in zip(ends, ends[1:]))
    return replace(recording, scans=replace(recording.scans, contacts=contacts))
