"""Checks the motion of the plate, its gauge, the overlaps of the grains below it, and the stated errors of measurement."""
import numpy as np
from numpy.typing import NDArray

from ..results.names import Phase
from ..results.recording import Bools, Recording
from .experiment import Experiment
from .findings import PLATE, SETTINGS, Findings, contacts_of, mean_diameter, odd, odd_items, positions_of, upper_median
from .plate import scan_places

CLEAR_LOAD = 10  # over the threshold of a contact
MAX_NOISE = 0.01  # of plate positions, over the stroke
FALLS = 0.5  # ratio of the force at the end of loading to the largest force before
REST = 0.005  # of the stroke: frame 0 is at plate.start
MAX_AT_REST = 0.05  # of the largest force, in frame 0 at plate.start
MAX_ERROR = 0.05  # of positions and diameters, over the diameter
LOADED, UNLOADED = 0.3, 0.02  # of the maximum top force
GAP_UNDER_LOAD = 0.1  # over the diameter: tilt, contacts by surface displacement
MAX_FORCE_RATIO = 4  # to Hertz's law: strong compression, errors of the modulus
MAX_ERROR_FOR_HERTZ = 0.02  # of positions, over the diameter
# Of a frame with positions: number, height of the plate and force on it, top of the highest grain [m], and the force on the plate for a
# modulus of 1 Pa and independent contacts [N].
LOAD = np.dtype([("number", "i8"), ("plate_z", "f8"), ("top_force", "f8"), ("top", "f8"), ("hertz", "f8")])
Loads = NDArray[np.void]  # of F frames


def check_plate(experiment: Experiment) -> Findings:
    yield from _check_course(experiment.recording)
    yield from _check_start(experiment.recording)
    yield from _check_gauge(experiment)


def held_frames(recording: Recording) -> Bools:
    """(S,) whether a frame was taken during a hold, in which the plate may move in both directions."""
    held = np.zeros(len(recording.scans), bool)
    if recording.has_programme:
        of_scans = [place["held"] for place in scan_places(recording)]
        held[1:] = (of_scans + [False] * len(held))[:len(held) - 1]
    return held


def _check_course(recording: Recording) -> Findings:
    scans = recording.scans
    z, cycle, unloads = scans.plate_z, scans.cycle, scans.phase == Phase.unload
    noise = MAX_NOISE * (z.max() - z.min())
    cycle_before = np.append(-1, cycle[:-1])
    unloads_before = np.append(False, unloads[:-1])
    begins = cycle != cycle_before
    begins[0] = True
    rise = np.diff(z, prepend=z[0])
    goes_on = ~begins & (unloads == unloads_before) & ~held_frames(recording)
    yield from odd_items(PLATE, "the plate goes against its phase: ", [(
        scans.frame, goes_on & (np.where(unloads, -rise, rise) > noise),
        lambda s: f"{z[s]:.6g} m after {z[s - 1]:.6g} m in phase {Phase(scans.phase[s]).name}")])
    yield from odd_items(PLATE, "a cycle is one loading and then one unloading: ", [(
        scans.frame, np.where(begins, unloads, unloads_before & ~unloads), lambda s: f"{Phase(scans.phase[s]).name} of cycle {cycle[s]}")])
    yield from odd_items(PLATE, "cycles are left out: ", [(
        scans.frame, cycle > cycle_before + 1, lambda s: f"cycle {cycle[s]} follows {cycle_before[s]}")])


def _check_start(recording: Recording) -> Findings:
    z, start = recording.scans.plate_z, recording.plate_start
    highest = z.max()
    stroke = highest - z.min()
    if highest > start + 1e-3 * stroke:
        yield odd(SETTINGS, f"plate.start, {start:.6g} m, is below the plate of frame {recording.scans.frame[z.argmax()]}, {highest:.6g} m")
    elif start > highest + max(stroke, 0.01 * highest):
        yield odd(SETTINGS, f"plate.start, {start:.6g} m, is more than the whole stroke above the plate's highest position, "
                            f"{highest:.6g} m")


def _check_gauge(experiment: Experiment) -> Findings:
    scans = experiment.recording.scans
    force = scans.top_force
    yield from odd_items(PLATE, "the top force is negative, though the grains press the plate up: ",
                         [(scans.frame, force < 0, lambda s: f"{force[s]:.3g} N")])
    at_rest = scans.plate_z[0] >= experiment.recording.plate_start - REST * np.ptp(scans.plate_z)
    if at_rest and force[0] > MAX_AT_REST * force.max() and not len(experiment.recording.diameter):  # with grains their overlaps tell it
        yield odd(PLATE, f"frame 0, at plate.start, carries {100 * force[0] / force.max():.2g} % of the largest top force, {force[0]:.3g} N: is "
                         "plate.start the height at which the plate first touches, and is the gauge's zero taken off?")
    loading = force[(scans.phase == Phase.load) & (scans.cycle == scans.cycle[0])]
    largest, last = loading.max(initial=0), loading[-1] if len(loading) else 0
    if last < FALLS * largest and largest > CLEAR_LOAD * experiment.measurement.force_threshold:
        yield odd(PLATE, f"the top force falls before loading ends, from {largest:.3g} to {last:.3g} N")


def check_errors(experiment: Experiment) -> Findings:
    errors = experiment.measurement
    needed = ["position_error", "diameter_error"] if len(experiment.recording.diameter) else []
    if any(contacts_of(experiment.recording)):
        needed += ["force_error", "force_threshold"]
    if zero := [name for name in needed if getattr(errors, name) == 0]:
        yield odd(SETTINGS, f"{', '.join(zero)} {'is' if len(zero) == 1 else 'are'} zero: noise that is not stated is taken for a gap")
    if not len(experiment.recording.diameter):
        return
    part = max(errors.position_error, errors.diameter_error) / mean_diameter(experiment.recording)
    if part > MAX_ERROR:
        yield odd(SETTINGS, f"positions or diameters are known to {part:.2g} of a diameter only: overlaps are not larger")


def check_plate_load(experiment: Experiment) -> Findings:
    """The force on the plate and the overlaps of the grains below it disagree if frames of the grains belong to other rows of the plate, or
    if plate.start, the origin or the unit of force is wrong."""
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
    gap, force = loads["plate_z"] - loads["top"], loads["top_force"]
    tolerance = GAP_UNDER_LOAD * mean_diameter(experiment.recording) + 4 * experiment.measurement.position_error
    yield from odd_items(PLATE, "the plate carries a force above the highest grain: is plate.start right, and do these frames of the "
                                "grains belong to these rows of the plate? ", [(
        loads["number"], (force > UNLOADED * largest) & (gap > tolerance),
        lambda k: f"{1e3 * gap[k]:.3g} mm, at a top force of {force[k]:.3g} N")])


def _check_force(experiment: Experiment, loads: Loads, largest: float) -> Findings:
    modulus, nu = experiment.materials.get("grains.youngs_modulus"), experiment.materials.get("grains.poisson_ratio", 0.5)
    if modulus is None or experiment.measurement.position_error > MAX_ERROR_FOR_HERTZ * mean_diameter(experiment.recording):
        return
    hertz, force = modulus / (1 - nu * nu) * loads["hertz"], loads["top_force"]
    yield from odd_items(PLATE, "the plate overlaps with grains as under load, but measures hardly any force: are plate.start and the "
                                "height of the grains right? ", [(
        loads["number"], (force < UNLOADED * largest) & (hertz > LOADED * largest), lambda k: f"{force[k]:.3g} N")])
    known = (force > LOADED * largest) & (hertz > 0)
    ratio = upper_median(force[known] / hertz[known])
    if ratio > MAX_FORCE_RATIO or ratio < 1 / MAX_FORCE_RATIO:
        yield odd(PLATE, f"the top force is {ratio:.2g} times that of Hertz's law from the overlaps with the plate: are its unit, "
                         "plate.start, the height of the grains and their modulus right, and do the frames of the grains belong to these "
                         "rows of the plate?")
