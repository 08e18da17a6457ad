"""What the checks of an experiment share: findings, and frames with positions or contacts."""
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from functools import partial

import numpy as np

from ..results.recording import Bools, Contacts, Floats, Ints, Recording

SETTINGS, PLATE, GRAINS, CONTACTS, TOPOLOGY = "experiment.toml", "plate.csv", "grains.csv", "contacts.csv", "topology.csv"


class Severity(IntEnum):
    note = 0  # available data
    missing = 1  # missing data, and what could be diagnosed with them
    odd = 2  # implausible data: an error in the tables, or a packing that the model does not describe


@dataclass(frozen=True)
class Finding:
    severity: Severity
    about: str  # file
    text: str


Findings = Iterator[Finding]
note, missing, odd = (partial(Finding, severity) for severity in Severity)  # of a file and a text

# The number of a frame, or of the frame of each item; which items count; the words for an item.
Part = tuple[int | Ints, Bools, Callable[[int], str]]


class Tally:
    """Counts findings of one kind over the frames and keeps the first one as an example."""

    def __init__(self, parts: Iterable[Part]) -> None:
        self.count, frames, first = 0, set[int](), ""
        for frame, which, example in parts:
            if which.any():
                items = np.flatnonzero(which)
                numbers = np.broadcast_to(frame, which.shape)[items]
                first = first or f"first in frame {numbers[0]}: {example(int(items[0]))}"
                self.count += len(items)
                frames.update(np.unique(numbers).tolist())
        # "3 in 2 frames, first in frame 7: <example>"
        self.text = f"{self.count} in {len(frames)} frame{'' if len(frames) == 1 else 's'}, {first}"


def odd_items(about: str, text: str, parts: Iterable[Part]) -> Findings:
    """The text and what was found, if anything was."""
    tally = Tally(parts)
    if tally.count:
        yield odd(about, text + tally.text)


@dataclass(frozen=True, eq=False)
class Frame:
    number: int
    plate_z: float  # [m]
    top_force: float  # [N]
    position: Floats  # (N, 3) [m]
    contacts: Contacts


def frames_of(recording: Recording) -> Iterator[Frame]:
    scans = recording.scans
    return map(Frame, scans.frame.tolist(), scans.plate_z.tolist(), scans.top_force.tolist(), scans.position, scans.contacts)


def positions_of(recording: Recording) -> Iterator[Frame]:
    """Frames with positions."""
    return (frame for frame in frames_of(recording) if len(frame.position))


def contacts_of(recording: Recording) -> Iterator[Frame]:
    """Frames with contacts."""
    return (frame for frame in frames_of(recording) if len(frame.contacts))


def placed_contacts_of(recording: Recording) -> Iterator[Frame]:
    """Frames with contacts and positions."""
    return (frame for frame in contacts_of(recording) if len(frame.position))


def upper_median(values: Floats) -> float:
    """The upper one of the two middle values of an even number; NaN if there are none."""
    return float(np.partition(values, len(values) // 2)[len(values) // 2]) if len(values) else math.nan


def mean_diameter(recording: Recording) -> float:
    """[m]"""
    return float(recording.diameter.mean())
