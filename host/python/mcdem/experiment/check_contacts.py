"""Checks contacts against positions, the plate's gauge, the stated threshold and the stiffness, and the balance of forces on grains."""
import math
from collections.abc import Iterator

import numpy as np

from ..results.names import Wall
from ..results.recording import Bools, Floats, Ints, Recording
from .container import apart, lengths, towards_wall, wall_distance, walls_of
from .experiment import Experiment
from .findings import (CONTACTS, Findings, Frame, Part, Tally, contacts_of, mean_diameter, note, odd, odd_items,
                       placed_contacts_of, upper_median)

MAX_APART = 0.15  # gap over the mean diameter, as in the contact search of simulations
MAX_PULLING = 0.2  # fraction of the contacts that are not weak
GAUGE_RANGE = 1.5  # force of plate contacts over that of the gauge, or the inverse
CLEAR_SUM = 4  # in multiples of the threshold times the number of plate contacts
MIN_PAIRS = 20  # for a typical force
CLEAR_OVERLAP = 0.02  # over R*
HERTZ_RANGE = 5  # force over that of Hertz's law, or the inverse: indicates a wrong modulus or unit, not an effect
GAP_IN_FORCES = 1.5  # weakest force over the threshold
MANY_CONTACTS = 1000
# Of the balance:
GRAVITY = 9.81  # [m/s2]
NEAR_WALL = 1.25  # in radii; closer centres may touch a wall
MIN_ERROR = 0.02  # of a force, if none is stated
UNSEEN_CONTACTS = 2  # per grain, each up to the threshold
MAX_UNBALANCED = 3  # in multiples of the expected error
MIN_GRAINS = 5


def check_contacts(experiment: Experiment) -> Findings:
    recording, threshold = experiment.recording, experiment.measurement.force_threshold
    yield from odd_items(CONTACTS, f"forces below the stated threshold of {1e3 * threshold:.3g} mN: ", _below(recording, threshold))
    yield from _check_threshold(recording, threshold)
    yield from _check_gauge(recording, threshold)
    if len(recording.diameter):
        yield from odd_items(CONTACTS, "contacts of grains that do not touch, are grains and frames numbered as in grains.csv? ",
                             _distant(recording))
        yield from odd_items(CONTACTS, "contact points away from their grain: ", _misplaced(recording))
        yield from _check_signs(recording, threshold)
        yield from _check_stiffness(experiment)


def _names(recording: Recording, frame: Frame, k: int) -> str:
    grain, partner = int(frame.contacts.grain[k]), int(frame.contacts.partner[k])
    return f"grain {grain} and {recording.box.wall_name(Wall(-1 - partner))}" if partner < 0 else f"grains {grain} and {partner}"


def _below(recording: Recording, threshold: float) -> Iterator[Part]:
    for frame in contacts_of(recording):
        force = lengths(frame.contacts.force)
        yield frame.number, force < threshold, lambda k: f"{_names(recording, frame, k)}, {1e3 * force[k]:.3g} mN"


def _check_threshold(recording: Recording, threshold: float) -> Findings:
    force = np.concatenate([np.zeros(0), *(lengths(frame.contacts.force) for frame in contacts_of(recording))])
    weakest = force.min(initial=math.inf)
    if threshold > 0 and len(force) >= MANY_CONTACTS and weakest > GAP_IN_FORCES * threshold:
        yield odd(CONTACTS, f"of {len(force)} contacts the weakest has {1e3 * weakest:.3g} mN: the threshold is higher than the stated "
                            f"{1e3 * threshold:.3g} mN")


def _check_gauge(recording: Recording, threshold: float) -> Findings:
    ratios = []
    for frame in contacts_of(recording):
        mine = frame.contacts.partner == -1 - Wall.plate
        unseen = threshold * int(mine.sum())
        if unseen > 0 and frame.top_force > CLEAR_SUM * unseen:
            ratios.append(-frame.contacts.force[mine, 2].sum() / frame.top_force)
    ratio = upper_median(np.array(ratios))
    if ratio < 1 / GAUGE_RANGE or ratio > GAUGE_RANGE:
        yield odd(CONTACTS, f"the contacts with the plate add up to {ratio:.3g} times the top force: are the units or signs the same, are "
                            "contacts left out?")


def _gaps(recording: Recording, frame: Frame) -> Floats:
    """(C,) between the surfaces of the contacts [m]."""
    contacts, box, radius = frame.contacts, recording.box, recording.diameter / 2
    gap, centre, pairs = np.zeros(len(contacts)), frame.position[contacts.grain], ~contacts.is_wall
    for wall in walls_of(box):
        mine = contacts.partner == -1 - wall
        gap[mine] = wall_distance(box, wall, frame.plate_z, centre[mine])
    partner = contacts.partner[pairs]
    gap[pairs] = lengths(apart(box, centre[pairs], frame.position[partner]))
    gap -= radius[contacts.grain]
    gap[pairs] -= radius[partner]
    return gap


def _distant(recording: Recording) -> Iterator[Part]:
    largest = MAX_APART * mean_diameter(recording)
    for frame in placed_contacts_of(recording):
        gap = _gaps(recording, frame)
        yield frame.number, gap > largest, lambda k: f"{_names(recording, frame, k)}, {1e3 * gap[k]:.3g} mm"


def _misplaced(recording: Recording) -> Iterator[Part]:
    for frame in placed_contacts_of(recording):
        grain = frame.contacts.grain
        away = lengths(apart(recording.box, frame.position[grain], frame.contacts.point))
        yield (frame.number, away > 0.75 * recording.diameter[grain],
               lambda k: f"{_names(recording, frame, k)}, {1e3 * away[k]:.3g} mm from the centre of grain {grain[k]}")


def _pulls(recording: Recording, frame: Frame) -> Floats:
    """(C,) the parts of the forces against the direction in which the contacts repel their grains, over a positive length."""
    contacts, box = frame.contacts, recording.box
    inward, centre, pairs = np.zeros_like(contacts.force), frame.position[contacts.grain], ~contacts.is_wall
    for wall in walls_of(box):
        mine = contacts.partner == -1 - wall
        inward[mine] = towards_wall(box, wall, centre[mine])
    inward[pairs] = apart(box, centre[pairs], frame.position[contacts.partner[pairs]])
    return np.asarray((contacts.force * inward).sum(axis=1))


def _check_signs(recording: Recording, threshold: float) -> Findings:
    strong_count = 0

    def pulling() -> Iterator[Part]:
        nonlocal strong_count
        for frame in placed_contacts_of(recording):
            force = lengths(frame.contacts.force)
            strong = force >= 3 * threshold
            strong_count += int(strong.sum())
            yield frame.number, strong & (_pulls(recording, frame) > 0), lambda k: f"{_names(recording, frame, k)}, {force[k]:.3g} N"

    pulls = Tally(pulling())
    if pulls.count > MAX_PULLING * strong_count:
        yield odd(CONTACTS, f"of {strong_count} contacts above three thresholds many pull their grain: the force must be that on `grain`, "
                            f"by `partner`: {pulls.text}")


def _force_over_hertz(recording: Recording, frame: Frame, modulus: float, nu: float) -> float:
    """Typical force over that of Hertz's law at the typical overlap, for the stronger half of the contacts; 1 if it is not known.

    At the largest load overlaps are significant, and the selection by force is not biased by errors of positions.
    """
    pairs, diameter = ~frame.contacts.is_wall, recording.diameter
    a, b = diameter[frame.contacts.grain[pairs]] / 2, diameter[frame.contacts.partner[pairs]] / 2
    force, overlap, reduced = lengths(frame.contacts.force[pairs]), -_gaps(recording, frame)[pairs], a * b / (a + b)
    stronger = np.argsort(force, kind="stable")[len(force) // 2:]
    force_m, overlap_m, radius_m = (upper_median(values[stronger]) for values in (force, overlap, reduced))
    if len(stronger) < MIN_PAIRS or overlap_m < CLEAR_OVERLAP * radius_m:
        return 1
    return float(np.divide(force_m, 4 / 3 * modulus / (2 * (1 - nu * nu)) * math.sqrt(radius_m) * overlap_m**1.5))


def _check_stiffness(experiment: Experiment) -> Findings:
    modulus, nu = experiment.materials.get("grains.youngs_modulus"), experiment.materials.get("grains.poisson_ratio", 0.5)
    frames = list(placed_contacts_of(experiment.recording))
    if modulus is None or not frames:
        return
    ratio = _force_over_hertz(experiment.recording, max(frames, key=lambda frame: frame.top_force), modulus, nu)
    if ratio < 1 / HERTZ_RANGE or ratio > HERTZ_RANGE:
        yield odd(CONTACTS, f"at the highest load forces are {ratio:.3g} times those of Hertz at the measured overlaps: are "
                            "grains.youngs_modulus [Pa], the forces [N] and the diameters [m] in these units?")


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
    """Of grains at rest contact forces and weight cancel, except for errors and missing contacts of the instrument."""
    typical = list[float]()

    def unbalanced() -> Iterator[Part]:
        for frame in placed_contacts_of(experiment.recording):
            relative, in_errors = _imbalance(experiment, frame)
            if len(relative) >= MIN_GRAINS:
                typical.append(upper_median(relative))
                errors = upper_median(in_errors)
                yield (frame.number, np.array([errors > MAX_UNBALANCED]),
                       lambda _: f"{errors:.2g} times what the errors explain, {100 * typical[-1]:.0f} % of the forces")

    found = list(odd_items(CONTACTS, "forces on the grains do not cancel, was the packing at rest, are contacts left out? Frames: ",
                           unbalanced()))
    if typical:
        yield note(CONTACTS, f"of the forces on a grain in the bulk, {100 * upper_median(np.array(typical)):.2g} % do not cancel (median)")
    yield from found
