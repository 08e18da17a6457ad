"""Checks whether the grains fit into their box, and how they move."""
import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ..results.recording import Recording
from .container import apart, floor_area, lengths, wall_distance, walls_of
from .experiment import Experiment
from .findings import GRAINS, Findings, Part, odd, odd_items, positions_of
from .near_pairs import near_pairs

MIN_FRACTION, MAX_FRACTION = 0.3, 0.95  # of a packing under load
MAX_OVERLAP = 0.3  # over the sum of radii; simulations lose their static solution at 0.5
MAX_JUMP = 0.75  # over the diameter, in addition to the plate's displacement
MAX_IN_WALL = 0.5  # over the radius


def check_grains(experiment: Experiment) -> Findings:
    recording = experiment.recording
    if len(recording.diameter):
        yield from _check_volume(recording)
        yield from odd_items(GRAINS, "grains reach into a wall by more than half their radius: ", _in_walls(recording))
        yield from odd_items(GRAINS, f"grains overlap by more than {MAX_OVERLAP} of their radii together: ", _overlapping(recording))
        yield from odd_items(GRAINS, "grains jump by most of a diameter from frame to frame, are they numbered consistently? ",
                             _jumping(recording))


def _check_volume(recording: Recording) -> Findings:
    volume = (math.pi / 6 * recording.diameter**3).sum()
    fraction = volume / (floor_area(recording.box) * recording.scans.plate_z[0])
    if fraction < MIN_FRACTION:
        yield odd(GRAINS, f"the grains fill {fraction:.2g} of the box below the plate: are diameters radii, or grains left out?")
    if fraction > MAX_FRACTION:
        yield odd(GRAINS, f"the grains have {fraction:.3g} times the volume of the box below the plate: are diameters too large, or is the "
                          "box too small?")


def _in_walls(recording: Recording) -> Iterator[Part]:
    """The items are the walls of each grain."""
    box, radius = recording.box, recording.diameter[:, None] / 2
    walls = walls_of(box)
    for frame in positions_of(recording):
        inside = radius - np.stack([wall_distance(box, wall, frame.plate_z, frame.position) for wall in walls], axis=1)
        yield (frame.number, (inside > MAX_IN_WALL * radius).ravel(),
               lambda k: f"grain {k // len(walls)} by {1e3 * inside.flat[k]:.3g} mm in {box.wall_name(walls[k % len(walls)])}")


def _overlapping(recording: Recording) -> Iterator[Part]:
    """The items are blocks of pairs of neighbours."""
    radius = recording.diameter / 2
    for frame in positions_of(recording):
        for i, j in near_pairs(frame.position, recording.box, frame.plate_z, float(recording.diameter.max())):
            together = radius[i] + radius[j]
            overlap = together - lengths(apart(recording.box, frame.position[j], frame.position[i]))
            yield (frame.number, overlap > MAX_OVERLAP * together,
                   lambda k: f"grains {min(i[k], j[k])} and {max(i[k], j[k])} by {1e3 * overlap[k]:.3g} mm")


def _jumping(recording: Recording) -> Iterator[Part]:
    """Loose grains move by up to half a diameter; a move to a neighbour's position indicates exchanged numbers."""
    for before, frame in pairwise(positions_of(recording)):
        jump = lengths(frame.position - before.position)
        yield (frame.number, jump > MAX_JUMP * recording.diameter + abs(frame.plate_z - before.plate_z),
               lambda k: f"grain {k} by {1e3 * jump[k]:.3g} mm since frame {before.number}")
