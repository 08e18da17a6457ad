"""The force on the plate and the overlaps of the grains below it.

They disagree if frames of the grains belong to other rows of the plate, or if plate.start, the origin or the unit of force is wrong.
"""
import numpy as np
from numpy.typing import NDArray

from ..results.recording import Recording
from .experiment import Experiment
from .findings import PLATE, Findings, Tally, mean_diameter, odd, positions_of, upper_median

LOADED, UNLOADED = 0.3, 0.02  # of the maximum top force
GAP_UNDER_LOAD = 0.1  # over the diameter: tilt, contacts by surface displacement
MAX_FORCE_RATIO = 4  # to Hertz's law: strong compression, errors of the modulus
MAX_ERROR = 0.02  # of positions, over the diameter
# Of a frame with positions: number, height of the plate and force on it, top of the highest grain [m], and the force on the plate for a
# modulus of 1 Pa and independent contacts [N].
LOAD = np.dtype([("number", "i8"), ("plate_z", "f8"), ("top_force", "f8"), ("top", "f8"), ("hertz", "f8")])
Loads = NDArray[np.void]  # of F frames


def check_plate_load(experiment: Experiment) -> Findings:
    recording = experiment.recording
    if not len(recording.diameter):
        return
    loads, largest = _loads(recording), float(recording.scans.top_force.max(initial=0))
    yield from _check_touch(experiment, loads, largest)
    yield from _check_force(experiment, loads, largest)


def _loads(recording: Recording) -> Loads:
    radius, rows = recording.diameter / 2, []
    for frame in positions_of(recording):
        top = frame.position[:, 2] + radius
        overlap = np.maximum(top - frame.plate_z, 0)
        rows.append((frame.number, frame.plate_z, frame.top_force, top.max(initial=0), (4 / 3 * np.sqrt(radius) * overlap**1.5).sum()))
    return np.array(rows, LOAD)


def _check_touch(experiment: Experiment, loads: Loads, largest: float) -> Findings:
    gap, force, above = loads["plate_z"] - loads["top"], loads["top_force"], Tally()
    tolerance = GAP_UNDER_LOAD * mean_diameter(experiment.recording) + 4 * experiment.measurement.position_error
    above.add_frames(loads["number"], (force > UNLOADED * largest) & (gap > tolerance),
                     lambda k: f"{1e3 * gap[k]:.3g} mm, at a top force of {force[k]:.3g} N")
    yield from above.odd(PLATE, "the plate carries a force above the highest grain: is plate.start right, and do these frames of the "
                                "grains belong to these rows of the plate? ")


def _check_force(experiment: Experiment, loads: Loads, largest: float) -> Findings:
    modulus, nu = experiment.materials.get("grains.youngs_modulus"), experiment.materials.get("grains.poisson_ratio", 0.5)
    if modulus is None or experiment.measurement.position_error > MAX_ERROR * mean_diameter(experiment.recording):
        return
    hertz, force, pressed = modulus / (1 - nu * nu) * loads["hertz"], loads["top_force"], Tally()
    pressed.add_frames(loads["number"], (force < UNLOADED * largest) & (hertz > LOADED * largest), lambda k: f"{force[k]:.3g} N")
    yield from pressed.odd(PLATE, "the plate overlaps with grains as under load, but measures hardly any force: are plate.start and the "
                                  "height of the grains right? ")
    known = (force > LOADED * largest) & (hertz > 0)
    ratio = upper_median(force[known] / hertz[known])
    if ratio > MAX_FORCE_RATIO or ratio < 1 / MAX_FORCE_RATIO:
        yield odd(PLATE, f"the top force is {ratio:.2g} times that of Hertz's law from the overlaps with the plate: are its unit, "
                         "plate.start, the height of the grains and their modulus right, and do the frames of the grains belong to these "
                         "rows of the plate?")
