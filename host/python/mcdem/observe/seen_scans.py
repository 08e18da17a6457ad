"""Some scans of one recording with the contacts of all of them in one table, from which observables are computed."""
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..experiment.container import lengths
from ..results.names import Wall
from ..results.recording import Bools, Box, Floats, Ints, Recording
from .contact_residuals import ContactResiduals, Material, contact_residuals


@dataclass(frozen=True, eq=False)
class SeenScans:
    """S scans of N grains with C contacts; reductions give one number for each scan."""

    recording: Recording
    numbers: Sequence[int]  # of the scans in the recording
    material: Material

    def __len__(self) -> int:
        return len(self.numbers)

    @property
    def box(self) -> Box:
        return self.recording.box

    @cached_property
    def diameter(self) -> Floats:
        """(N,) [m]"""
        return self.recording.diameter

    @cached_property
    def plate_z(self) -> Floats:
        """(S,) [m]"""
        return self.recording.scans.plate_z[self.numbers]

    @cached_property
    def top_force(self) -> Floats:
        """(S,) [N]"""
        return self.recording.scans.top_force[self.numbers]

    @cached_property
    def scan(self) -> Ints:
        """(C,) of each contact, from 0 to S - 1."""
        return np.repeat(np.arange(len(self)), [len(self.recording.scans.contacts[k]) for k in self.numbers])

    @cached_property
    def grain(self) -> Ints:
        """(C,)"""
        return np.concatenate([self.recording.scans.contacts[k].grain for k in self.numbers])

    @cached_property
    def partner(self) -> Ints:
        """(C,) a grain, or -1 - Wall."""
        return np.concatenate([self.recording.scans.contacts[k].partner for k in self.numbers])

    @cached_property
    def point(self) -> Floats:
        """(C, 3) [m]"""
        return np.concatenate([self.recording.scans.contacts[k].point for k in self.numbers])

    @cached_property
    def force(self) -> Floats:
        """(C, 3) on `grain` [N]."""
        return np.concatenate([self.recording.scans.contacts[k].force for k in self.numbers])

    @cached_property
    def overlap(self) -> Floats:
        """(C,) [m]; NaN in measured data."""
        return np.concatenate([self.recording.scans.contacts[k].overlap for k in self.numbers])

    @cached_property
    def magnitude(self) -> Floats:
        """(C,) of the force [N]."""
        return lengths(self.force)

    @cached_property
    def is_wall(self) -> Bools:
        """(C,)"""
        return self.partner < 0

    def at(self, wall: Wall) -> Bools:
        """(C,) whether a contact is one with this wall."""
        return np.equal(self.partner, -1 - wall)

    @cached_property
    def at_sides(self) -> Bools:
        """(C,)"""
        at_sides: Bools = self.is_wall & (self.partner > -1 - Wall.floor)
        return at_sides

    @cached_property
    def position(self) -> Floats:
        """(S, N, 3) [m]"""
        return np.stack([self.recording.scans.position[k] for k in self.numbers])

    def of_grain(self, grain: Ints) -> Ints:
        """(C,) numbers of these grains of the contacts among all S N grains of all scans."""
        return self.scan * len(self.diameter) + grain

    @cached_property
    def centre(self) -> Floats:
        """(C, 3) of `grain` [m]."""
        return self.position[self.scan, self.grain]

    @cached_property
    def residuals(self) -> ContactResiduals:
        return contact_residuals(self)

    # Reductions over the contacts of each scan; `where`: (C,) those that count.

    def sum(self, values: Floats, where: Bools | None = None) -> Floats:
        """(S,)"""
        chosen: Any = slice(None) if where is None else where
        return np.bincount(self.scan[chosen], values[chosen].astype(float), len(self)).astype(float)

    def count(self, where: Bools) -> Floats:
        """(S,)"""
        return np.bincount(self.scan[where], minlength=len(self)).astype(float)

    @cached_property
    def contacts(self) -> Floats:
        """(S,) number of contacts."""
        return np.bincount(self.scan, minlength=len(self)).astype(float)

    def mean(self, values: Floats, where: Bools | None = None) -> Floats:
        """(S,); NaN where there is no contact."""
        return self.sum(values, where) / (self.contacts if where is None else self.count(where))

    def fraction(self, values: Floats, low: Floats, high: Floats, where: Bools | None = None) -> Floats:
        """(S,) of the values that are at least `low` and below `high`, (S,) each."""
        inside = (values >= low[self.scan]) & (values < high[self.scan])
        return self.mean(inside.astype(float), where)

    def quantile(self, values: Floats, share: float, where: Bools | None = None) -> Floats:
        """(S,): the value below which a fraction `share` of the values lies; NaN where there is none."""
        chosen: Any = slice(None) if where is None else where
        scan, values = self.scan[chosen], values[chosen]
        ordered = values[np.lexsort((values, scan))]
        count = np.bincount(scan, minlength=len(self))
        place = np.cumsum(count) - count + (share * np.maximum(count - 1, 0)).astype(int)
        result = np.full(len(self), np.nan)
        result[count > 0] = ordered[place[count > 0]]
        return result
