"""What the checks of an experiment share: findings, and frames with positions or contacts."""
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from ..results.recording import Bools, Contacts, Floats, Ints, Recording

SETTINGS, PLATE, GRAINS, CONTACTS = "experiment.toml", "plate.csv", "grains.csv", "contacts.csv"


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


def note(about: str, text: str) -> Finding:
    return Finding(Severity.note, about, text)


def missing(about: str, text: str) -> Finding:
    return Finding(Severity.missing, about, text)


def odd(about: str, text: str) -> Finding:
    return Finding(Severity.odd, about, text)


class Tally:
    """Counts findings of one kind over the frames and keeps the first one as an example."""

    def __init__(self) -> None:
        self.count = self._frames = 0
        self._first = ""

    def add(self, frame: int, which: Bools, example: Callable[[int], str]) -> None:
        """The true ones of a frame's items; `example` gives the words for an item."""
        if which.any():
            self._first = self._first or f"first in frame {frame}: {example(int(which.argmax()))}"
            self.count += int(which.sum())
            self._frames += 1

    def add_parts(self, frame: int, parts: Iterable[tuple[Bools, Callable[[int], str]]]) -> None:
        """Those of a frame whose items come in several parts."""
        before = self._frames
        for which, example in parts:
            self.add(frame, which, example)
        self._frames = min(self._frames, before + 1)

    def add_frames(self, frames: Ints, which: Bools, example: Callable[[int], str]) -> None:
        """The true ones of several frames; `example` gives the words for one of them."""
        if which.any():
            row = int(which.argmax())
            self.add(int(frames[row]), which, lambda _: example(row))
            self._frames += int(which.sum()) - 1

    @property
    def text(self) -> str:
        """ "3 in 2 frames, first in frame 7: <example>" """
        return f"{self.count} in {self._frames} frame{'' if self._frames == 1 else 's'}, {self._first}"

    def odd(self, about: str, text: str) -> Findings:
        """The text and what was found, if anything was."""
        if self.count:
            yield odd(about, text + self.text)


@dataclass(frozen=True, eq=False)
class Frame:
    number: int
    plate_z: float  # [m]
    top_force: float  # [N]
    position: Floats  # (N, 3) [m]
    contacts: Contacts


def frames_of(recording: Recording) -> Iterator[Frame]:
    """Those with positions or contacts."""
    scans = recording.scans
    rows = zip(scans.frame.tolist(), scans.plate_z.tolist(), scans.top_force.tolist(), scans.position, scans.contacts)
    yield from (Frame(*row) for row in rows if len(row[3]) or len(row[4]))


def positions_of(recording: Recording) -> Iterator[Frame]:
    """Frames with positions."""
    return (frame for frame in frames_of(recording) if len(frame.position))


def contacts_of(recording: Recording) -> Iterator[Frame]:
    """Frames with contacts."""
    return (frame for frame in frames_of(recording) if len(frame.contacts))


def lengths(vectors: Floats) -> Floats:
    """(N,) of vectors (N, 3)."""
    return np.asarray(np.linalg.norm(vectors, axis=1))


def upper_median(values: Floats) -> float:
    """The upper one of the two middle values of an even number; NaN if there are none."""
    return float(np.partition(values, len(values) // 2)[len(values) // 2]) if len(values) else math.nan


def mean_diameter(recording: Recording) -> float:
    """[m]"""
    return float(recording.diameter.mean())
