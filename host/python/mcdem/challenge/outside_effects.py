"""Effects of simulated experiments that are in no library: a diagnosis should not name a library effect for them."""
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..diagnosis.model import Model
from ..experiment.container import lengths
from ..results.names import Phase
from ..results.recording import Contacts, Floats, Recording


@dataclass(frozen=True)
class OutsideEffect:
    name: str
    low: float  # range of amplitudes, log-uniform
    high: float
    both_signs: bool
    change_model: Callable[[Model, float], Model] | None = None  # before the simulation
    change_reading: Callable[[Recording, float], Recording] | None = None  # after it, before the instrument's noise


def _soft_walls(model: Model, amplitude: float) -> Model:
    """Young's modulus of the walls over that of the grains."""
    return model.with_keys({"walls.youngs_modulus": amplitude * model["grains.youngs_modulus"]})


def _barrel(recording: Recording, amplitude: float) -> Recording:
    """Part by which lateral distances from the axis are read too large at the middle of a side; inside it falls with their square."""
    box, scans = recording.box, recording.scans
    axis = 0.5 * np.array([box.size_x, box.size_y])

    def read(point: Floats) -> Floats:
        out = point[:, :2] - axis
        part = amplitude * (out**2).sum(axis=1, keepdims=True) / axis[0] ** 2
        return np.column_stack([axis + (1 + part) * out, point[:, 2]])

    contacts = tuple(replace(one, point=read(one.point)) for one in scans.contacts)
    return replace(recording, scans=replace(scans, position=tuple(map(read, scans.position)), contacts=contacts))


def _mixed_forces(recording: Recording, amplitude: float) -> Recording:
    """Part of each contact's force that is read as the mean over the contacts of its grains."""
    count = len(recording.diameter)

    def read(one: Contacts) -> Contacts:
        size, grains = lengths(one.force), one.partner >= 0
        owner = np.concatenate([one.grain, one.partner[grains]])
        number = np.bincount(owner, minlength=count)
        mean = np.bincount(owner, np.concatenate([size, size[grains]]), count) / np.maximum(number, 1)
        around = np.where(grains, 0.5 * (mean[one.grain] + mean[one.partner]), mean[one.grain])
        factor = 1 + amplitude * (around / np.where(size > 0, size, np.inf) - 1)
        return replace(one, force=factor[:, np.newaxis] * one.force)

    return replace(recording, scans=replace(recording.scans, contacts=tuple(map(read, recording.scans.contacts))))


def _with_backlash(recording: Recording, amplitude: float) -> Recording:
    """By which the plate is read too high while it goes up [m]."""
    scans = recording.scans
    return replace(recording, scans=replace(scans, plate_z=scans.plate_z + np.where(scans.phase == Phase.unload, amplitude, 0)))


OUTSIDE_EFFECTS = (
    OutsideEffect("soft_walls", 0.5, 3, False, change_model=_soft_walls),
    OutsideEffect("barrel", 0.005, 0.02, True, change_reading=_barrel),
    OutsideEffect("mixed_forces", 0.1, 0.4, False, change_reading=_mixed_forces),
    OutsideEffect("plate_backlash", 0.5e-3, 1.5e-3, True, change_reading=_with_backlash),
)


def find_outside_effect(name: str) -> OutsideEffect | None:
    return next((effect for effect in OUTSIDE_EFFECTS if effect.name == name), None)
