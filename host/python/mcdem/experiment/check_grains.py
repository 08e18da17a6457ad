"""Checks whether the grains fit into their box, and how they move."""
import math
from collections.abc import Callable, Iterator

import numpy as np

from ..results.recording import Bools, Recording
from .container import apart, floor_area, wall_distance, walls_of
from .experiment import Experiment
from .findings import GRAINS, Findings, Frame, Tally, lengths, odd, positions_of
from .near_pairs import near_pairs

MIN_FRACTION, MAX_FRACTION = 0.3, 0.95  # of a packing under load
MAX_OVERLAP = 0.3  # over the sum of radii; simulations lose their static solution at 0.5
MAX_JUMP = 0.75  # over the diameter, in addition to the plate's displacement
MAX_IN_WALL = 0.5  # over the radius


def check_grains(experiment: Experiment) -> Findings:
    recording = experiment.recording
    if len(recording.diameter):
        yield from _check_volume(recording)
        yield from _check_walls(recording)
        yield from _check_overlaps(recording)
        yield from _check_jumps(recording)


def _check_volume(recording: Recording) -> Findings:
    volume = (math.pi / 6 * recording.diameter**3).sum()
    fraction = volume / (floor_area(recording.box) * recording.scans.plate_z[0])
    if fraction < MIN_FRACTION:
        yield odd(GRAINS, f"the grains fill {fraction:.2g} of the box below the plate: are diameters radii, or grains left out?")
    if fraction > MAX_FRACTION:
        yield odd(GRAINS, f"the grains have {fraction:.3g} times the volume of the box below the plate: are diameters too large, or is the "
                          "box too small?")


def _check_walls(recording: Recording) -> Findings:
    box, radius, tally = recording.box, recording.diameter / 2, Tally()
    walls = walls_of(box)
    for frame in positions_of(recording):
        inside = radius[:, None] - np.stack([wall_distance(box, wall, frame.plate_z, frame.position) for wall in walls], axis=1)
        flat = inside.ravel()
        tally.add(frame.number, (inside > MAX_IN_WALL * radius[:, None]).ravel(),
                  lambda k: f"grain {k // len(walls)} by {1e3 * flat[k]:.3g} mm in {box.wall_name(walls[k % len(walls)])}")
    yield from tally.odd(GRAINS, "grains reach into a wall by more than half their radius: ")


def _overlapping(recording: Recording, frame: Frame) -> Iterator[tuple[Bools, Callable[[int], str]]]:
    """Blocks of pairs of grains: which overlap too much, and the words for one of them."""
    radius = recording.diameter / 2
    for i, j in near_pairs(frame.position, recording.box, frame.plate_z, float(recording.diameter.max())):
        together = radius[i] + radius[j]
        overlap = together - lengths(apart(recording.box, frame.position[j], frame.position[i]))
        first, second = np.minimum(i, j), np.maximum(i, j)

        def example(k: int) -> str:
            return f"grains {first[k]} and {second[k]} by {1e3 * overlap[k]:.3g} mm"

        yield overlap > MAX_OVERLAP * together, example


def _check_overlaps(recording: Recording) -> Findings:
    tally = Tally()
    for frame in positions_of(recording):
        tally.add_parts(frame.number, _overlapping(recording, frame))
    yield from tally.odd(GRAINS, f"grains overlap by more than {MAX_OVERLAP} of their radii together: ")


def _check_jumps(recording: Recording) -> Findings:
    """Loose grains move by up to half a diameter; a move to a neighbour's position indicates exchanged numbers."""
    tally, before = Tally(), None
    for frame in positions_of(recording):
        if before:
            jump, since = lengths(frame.position - before.position), before.number
            tally.add(frame.number, jump > MAX_JUMP * recording.diameter + abs(frame.plate_z - before.plate_z),
                      lambda k: f"grain {k} by {1e3 * jump[k]:.3g} mm since frame {since}")
        before = frame
    yield from tally.odd(GRAINS, "grains jump by most of a diameter from frame to frame, are they numbered consistently? ")
