"""Effects of simulated experiments that are in no library: a diagnosis should not name a library effect for them."""
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..diagnosis.model import Model
from ..results.names import Phase
from ..results.recording import Contacts, Recording


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


def _narrower_box(model: Model, amplitude: float) -> Model:
    """Part by which the box is narrower along x than stated."""
    size_x, size_y = (1 - amplitude) * model["box.size_x"], model["box.size_y"]
    return replace(model, base=model.scene._with_box(model["container.shape"], size_x, size_y), changes={})


def _stretched(recording: Recording, amplitude: float) -> Recording:
    """Part by which the heights of grains, not of the plate, are read too large."""
    factor, scans = np.array([1, 1, 1 + amplitude]), recording.scans
    contacts = tuple(Contacts(one.grain, one.partner, factor * one.point, one.force, one.overlap) for one in scans.contacts)
    return replace(recording, scans=replace(scans, position=tuple(factor * one for one in scans.position), contacts=contacts))


def _with_backlash(recording: Recording, amplitude: float) -> Recording:
    """By which the plate is read too high while it goes up [m]."""
    scans = recording.scans
    return replace(recording, scans=replace(scans, plate_z=scans.plate_z + np.where(scans.phase == Phase.unload, amplitude, 0)))


OUTSIDE_EFFECTS = (
    OutsideEffect("soft_walls", 0.5, 3, False, change_model=_soft_walls),
    OutsideEffect("vertical_stretch", 0.005, 0.015, True, change_reading=_stretched),
    OutsideEffect("box_error", 0.007, 0.02, False, change_model=_narrower_box),
    OutsideEffect("plate_backlash", 0.5e-3, 1.5e-3, True, change_reading=_with_backlash),
)


def find_outside_effect(name: str) -> OutsideEffect | None:
    return next((effect for effect in OUTSIDE_EFFECTS if effect.name == name), None)
