"""Checks the motion of the plate, its gauge, and the stated errors of measurement."""
import numpy as np

from ..results.names import Phase
from ..results.recording import Bools, Recording
from .experiment import Experiment
from .findings import PLATE, SETTINGS, Findings, Tally, contacts_of, mean_diameter, odd

CLEAR_LOAD = 10  # over the threshold of a contact
MAX_NOISE = 0.01  # of plate positions, over the stroke
FALLS = 0.5  # ratio of the force at the end of loading to the largest force before
MAX_ERROR = 0.05  # of positions and diameters, over the diameter


def check_plate(experiment: Experiment) -> Findings:
    yield from _check_course(experiment.recording)
    yield from _check_start(experiment.recording)
    yield from _check_gauge(experiment)


def held_frames(recording: Recording) -> Bools:
    """(S,) whether a frame was taken during a hold, in which the plate may move in both directions."""
    held = np.zeros(len(recording.scans), bool)
    if recording.has_programme:
        from .. import _engine
        of_scans = [place["held"] for place in _engine.scan_places(recording.parameters, recording.plate_start)]
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
    left_out, unload_first, wrong_way = Tally(), Tally(), Tally()
    left_out.add_frames(scans.frame, cycle > cycle_before + 1, lambda s: f"cycle {cycle[s]} follows {cycle_before[s]}")
    unload_first.add_frames(scans.frame, np.where(begins, unloads, unloads_before & ~unloads),
                            lambda s: f"{Phase(scans.phase[s]).name} of cycle {cycle[s]}")
    rise = np.diff(z, prepend=z[0])
    goes_on = ~begins & (unloads == unloads_before) & ~held_frames(recording)
    wrong_way.add_frames(scans.frame, goes_on & (np.where(unloads, -rise, rise) > noise),
                         lambda s: f"{z[s]:.6g} m after {z[s - 1]:.6g} m in phase {Phase(scans.phase[s]).name}")
    yield from wrong_way.odd(PLATE, "the plate goes against its phase: ")
    yield from unload_first.odd(PLATE, "a cycle is one loading and then one unloading: ")
    yield from left_out.odd(PLATE, "cycles are left out: ")


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
    force, pulls = scans.top_force, Tally()
    pulls.add_frames(scans.frame, force < 0, lambda s: f"{force[s]:.3g} N")
    yield from pulls.odd(PLATE, "the top force is negative, though the grains press the plate up: ")
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
