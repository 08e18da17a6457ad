"""Checks contacts against positions, the plate's gauge, the stated threshold and the stiffness."""
import math

import numpy as np

from ..results.names import Wall
from ..results.recording import Contacts, Floats, Recording
from .container import apart, towards_wall, wall_distance, walls_of
from .experiment import Experiment
from .findings import CONTACTS, Findings, Frame, Tally, contacts_of, lengths, mean_diameter, odd, upper_median

MAX_APART = 0.15  # gap over the mean diameter, as in the contact search of simulations
MAX_PULLING = 0.2  # fraction of the contacts that are not weak
GAUGE_RANGE = 1.5  # force of plate contacts over that of the gauge, or the inverse
CLEAR_SUM = 4  # in multiples of the threshold times the number of plate contacts
MIN_PAIRS = 20  # for a typical force
CLEAR_OVERLAP = 0.02  # over R*
HERTZ_RANGE = 5  # force over that of Hertz's law, or the inverse: indicates a wrong modulus or unit, not an effect
GAP_IN_FORCES = 1.5  # weakest force over the threshold
MANY_CONTACTS = 1000


def check_contacts(experiment: Experiment) -> Findings:
    recording, threshold = experiment.recording, experiment.measurement.force_threshold
    yield from _check_threshold(recording, threshold)
    yield from _check_gauge(recording, threshold)
    if len(recording.diameter):
        yield from _check_places(recording)
        yield from _check_signs(recording, threshold)
        yield from _check_stiffness(experiment)


def _names(recording: Recording, contacts: Contacts, k: int) -> str:
    grain, partner = int(contacts.grain[k]), int(contacts.partner[k])
    return f"grain {grain} and {recording.box.wall_name(Wall(-1 - partner))}" if partner < 0 else f"grains {grain} and {partner}"


def _check_threshold(recording: Recording, threshold: float) -> Findings:
    below, count, weakest = Tally(), 0, math.inf
    for frame in contacts_of(recording):
        force, contacts = lengths(frame.contacts.force), frame.contacts
        count, weakest = count + len(force), min(weakest, float(force.min()))
        below.add(frame.number, force < threshold, lambda k: f"{_names(recording, contacts, k)}, {1e3 * force[k]:.3g} mN")
    yield from below.odd(CONTACTS, f"forces below the stated threshold of {1e3 * threshold:.3g} mN: ")
    if threshold > 0 and count >= MANY_CONTACTS and weakest > GAP_IN_FORCES * threshold:
        yield odd(CONTACTS, f"of {count} contacts the weakest has {1e3 * weakest:.3g} mN: the threshold is higher than the stated "
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


def _check_places(recording: Recording) -> Findings:
    distant, off = Tally(), Tally()
    diameter = mean_diameter(recording)
    for frame in contacts_of(recording):
        if not len(frame.position):
            continue
        contacts, gap = frame.contacts, _gaps(recording, frame)
        away = lengths(apart(recording.box, frame.position[contacts.grain], contacts.point))
        distant.add(frame.number, gap > MAX_APART * diameter, lambda k: f"{_names(recording, contacts, k)}, {1e3 * gap[k]:.3g} mm")
        off.add(frame.number, away > 0.75 * recording.diameter[contacts.grain],
                lambda k: f"{_names(recording, contacts, k)}, {1e3 * away[k]:.3g} mm from the centre of grain {contacts.grain[k]}")
    yield from distant.odd(CONTACTS, "contacts of grains that do not touch, are grains and frames numbered as in grains.csv? ")
    yield from off.odd(CONTACTS, "contact points away from their grain: ")


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
    pulls, count = Tally(), 0
    for frame in contacts_of(recording):
        if not len(frame.position):
            continue
        contacts, force = frame.contacts, lengths(frame.contacts.force)
        strong = force >= 3 * threshold
        count += int(strong.sum())
        pulls.add(frame.number, strong & (_pulls(recording, frame) > 0), lambda k: f"{_names(recording, contacts, k)}, {force[k]:.3g} N")
    if pulls.count > MAX_PULLING * count:
        yield odd(CONTACTS, f"of {count} contacts above three thresholds many pull their grain: the force must be that on `grain`, by "
                            f"`partner`: {pulls.text}")


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
    frames = [frame for frame in contacts_of(experiment.recording) if len(frame.position)]
    if modulus is None or not frames:
        return
    ratio = _force_over_hertz(experiment.recording, max(frames, key=lambda frame: frame.top_force), modulus, nu)
    if ratio < 1 / HERTZ_RANGE or ratio > HERTZ_RANGE:
        yield odd(CONTACTS, f"at the highest load forces are {ratio:.3g} times those of Hertz at the measured overlaps: are "
                            "grains.youngs_modulus [Pa], the forces [N] and the diameters [m] in these units?")
