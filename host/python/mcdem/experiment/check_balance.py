"""Force balance of grains at rest: contact forces and weight must cancel, except for errors and missing contacts of the instrument."""
import math

import numpy as np

from ..results.recording import Bools, Floats, Ints, Recording
from .container import wall_distance, walls_of
from .experiment import Experiment
from .findings import CONTACTS, Findings, Frame, Tally, contacts_of, lengths, note, upper_median

GRAVITY = 9.81  # [m/s2]
NEAR_WALL = 1.25  # in radii; closer centres may touch a wall
MIN_ERROR = 0.02  # of a force, if none is stated
UNSEEN_CONTACTS = 2  # per grain, each up to the threshold
MAX_UNBALANCED = 3  # in multiples of the expected error
MIN_GRAINS = 5


def _loads(frame: Frame) -> tuple[Floats, Floats, Ints]:
    """Of the contacts of each grain: the sum of their forces (N, 3) [N], the sum of their squares (N,) [N2], and their number (N,)."""
    contacts, grains = frame.contacts, len(frame.position)
    side = np.stack((contacts.grain, contacts.partner), axis=1).ravel()
    force = np.stack((contacts.force, -contacts.force), axis=1).reshape(-1, 3)[side >= 0]
    side = side[side >= 0]
    *total, squares = (np.bincount(side, of_contact, grains) for of_contact in (*force.T, (force**2).sum(axis=1)))
    return np.column_stack(total), np.asarray(squares, float), np.bincount(side, minlength=grains)


def _in_bulk(recording: Recording, frame: Frame) -> Bools:
    """(N,) whether a grain is away from all walls."""
    distances = [wall_distance(recording.box, wall, frame.plate_z, frame.position) for wall in walls_of(recording.box)]
    return np.asarray(~(np.array(distances) < NEAR_WALL * recording.diameter / 2).any(axis=0))


def _imbalance(experiment: Experiment, frame: Frame) -> tuple[Floats, Floats]:
    """Unbalanced force on the grains of the bulk, over the root of the sum of squares and over its error."""
    errors, diameter = experiment.measurement, experiment.recording.diameter
    total, squares, contacts = _loads(frame)
    total[:, 2] -= GRAVITY * experiment.materials.get("grains.excess_density", 0) * math.pi / 6 * diameter**3
    inner = (contacts >= 2) & _in_bulk(experiment.recording, frame)
    rest, squares = lengths(total[inner]), squares[inner]
    force_error, unseen = max(errors.force_error, MIN_ERROR), UNSEEN_CONTACTS * errors.force_threshold**2
    return rest / np.sqrt(squares), rest / np.sqrt(force_error**2 * squares + unseen)


def check_balance(experiment: Experiment) -> Findings:
    unbalanced, typical = Tally(), []
    for frame in contacts_of(experiment.recording):
        relative, in_errors = _imbalance(experiment, frame) if len(frame.position) else (np.zeros(0), np.zeros(0))
        if len(relative) < MIN_GRAINS:
            continue
        typical.append(upper_median(relative))
        errors = upper_median(in_errors)
        unbalanced.add(frame.number, np.array([errors > MAX_UNBALANCED]),
                       lambda _: f"{errors:.2g} times what the errors explain, {100 * typical[-1]:.0f} % of the forces")
    if typical:
        yield note(CONTACTS, f"of the forces on a grain in the bulk, {100 * upper_median(np.array(typical)):.2g} % do not cancel (median)")
    yield from unbalanced.odd(CONTACTS, "forces on the grains do not cancel, was the packing at rest, are contacts left out? Frames: ")
