"""Missing data, and what they would show."""
import math

import numpy as np

from ..results.names import Phase, Wall
from ..results.recording import Floats, Recording
from .container import apart, lengths, towards_wall, walls_of
from .experiment import MATERIALS, Experiment
from .findings import CONTACTS, GRAINS, PLATE, SETTINGS, Findings, contacts_of, mean_diameter, missing, upper_median

REST = 0.005  # fraction of the stroke: beyond it frame 0 is under load
MIN_FRAMES = 4  # per stroke
MIN_TILT = 1e-3  # angle of forces to the line of centres that indicates tangential components
FITTED = ("grains.youngs_modulus", "grains.friction", "walls.friction")  # by a diagnosis
TOLD_BY = {Wall.floor: "the part of the load that reaches the floor: wall friction, buoyancy",
           Wall.plate: "tilt of the plate, and whether contact forces agree with the plate's own gauge"}
WHAT_GRAINS_TELL = "overlaps, local packing fractions and displacements of grains"
TOLD_BY_SIDES = "the side force and the friction of the walls"


def find_missing(experiment: Experiment) -> Findings:
    recording = experiment.recording
    yield from _frames(recording)
    yield from _positions(experiment)
    yield from _contacts(experiment)
    yield from _tangential(experiment)
    yield from _settings(experiment)


def _frames(recording: Recording) -> Findings:
    of_phase = np.bincount(recording.scans.phase, minlength=len(Phase))
    if not of_phase[Phase.unload]:
        yield missing(PLATE, "unloading: viscoelasticity, plasticity and friction show in the loop that it closes")
    for phase in Phase:
        if 0 < of_phase[phase] < MIN_FRAMES:
            yield missing(PLATE, f"frames of {phase.name}ing, there are only {of_phase[phase]}: the displacement at which a gap opens "
                                 "cannot be determined")
    first = recording.displacement[0]
    if first > REST * recording.displacement.max(initial=0):
        yield missing(GRAINS if len(recording.diameter) else PLATE,
                      f"the packing at rest before the first stroke: frame 0 is {1e3 * first:.3g} mm below plate.start. A simulation that "
                      "starts there has other contacts from then on, top forces differ by some per cent (simulated runs: "
                      "protocol.scan_at_start)")


def _positions(experiment: Experiment) -> Findings:
    recording = experiment.recording
    without, seen = sum(not len(position) for position in recording.scans.position), any(map(len, recording.scans.position[1:]))
    if not len(recording.diameter):
        yield missing(GRAINS, "diameters and positions: a diagnosis then compares the curve with packings that the scene generates, whose "
                              "scatter hides small effects. Without positions no overlap can be assigned to a force, which is needed to "
                              "distinguish stiffness, cross-contact effects and adhesion")
    elif without and not seen:
        yield missing(GRAINS, f"positions in {without} of {len(recording.scans)} frames: simulations start from those of frame 0, and only the "
                              "top force is compared; positions under load would also tell who touches, overlaps, packing fractions and motion")
    elif without:
        yield missing(GRAINS, f"positions in {without} of {len(recording.scans)} frames: {WHAT_GRAINS_TELL} are compared in the others only")


def _contacts(experiment: Experiment) -> Findings:
    recording = experiment.recording
    scans, listed = recording.scans, [frame.contacts for frame in contacts_of(recording)]
    if experiment.has_grains_alone:
        who = "who touches (as listed)" if len(experiment.topology) else "who touches (by overlap)"
        yield missing(CONTACTS, f"contact forces: of the packing the top force is compared, {who}, {WHAT_GRAINS_TELL}, and the forces that Hertz's law "
                                "gives these overlaps; measured forces would also tell friction from other effects, adhesion, and errors of "
                                "sizes from those of forces")
    elif not listed:
        yield missing(CONTACTS, "contact forces: of the packing only the top force is left, on which stiffness, cross-contact effects and "
                                "an offset of the plate have similar effects; friction, adhesion, scatter among the grains, buoyancy and "
                                "tilt have little influence on it")
    if not listed:
        return
    empty = sum(not len(contacts) and force > 0 for contacts, force in zip(scans.contacts, scans.top_force.tolist()))
    if empty:
        yield missing(CONTACTS, f"contacts in {empty} of {len(scans)} frames under load: forces are compared in the others only")
    for wall in walls_of(recording.box):
        if not any((contacts.partner == -1 - wall).any() for contacts in listed):
            yield missing(CONTACTS, f"contacts with {recording.box.wall_name(wall)}: {TOLD_BY.get(wall, TOLD_BY_SIDES)}")


def _sines(a: Floats, b: Floats) -> Floats:
    """(N,) of the angles between vectors (N, 3)."""
    return lengths(np.cross(a, b)) / (lengths(a) * lengths(b))


def _tilts(recording: Recording) -> tuple[Floats, Floats]:
    """Sines of the angles between force and normal at walls, which is known exactly, and between grains, from their positions."""
    at_walls, between_grains = [np.zeros(0)], [np.zeros(0)]
    for frame in contacts_of(recording):
        contacts = frame.contacts
        for wall in walls_of(recording.box):
            mine = contacts.partner == -1 - wall
            at_walls.append(_sines(contacts.force[mine], towards_wall(recording.box, wall, contacts.point[mine])))
        if len(frame.position):
            pairs = ~contacts.is_wall
            grain, partner = (frame.position[of[pairs]] for of in (contacts.grain, contacts.partner))
            between_grains.append(_sines(contacts.force[pairs], apart(recording.box, grain, partner)))
    return np.concatenate(at_walls), np.concatenate(between_grains)


def _tangential(experiment: Experiment) -> Findings:
    at_walls, between_grains = _tilts(experiment.recording)
    if upper_median(at_walls) < MIN_TILT:
        yield missing(CONTACTS, "tangential forces at walls: friction of walls")
    if not len(between_grains):
        return
    # Median of the angle caused by errors of both ends, with a margin of a fifth.
    by_error = 1.2 * 1.18 * math.sqrt(2) * experiment.measurement.position_error / mean_diameter(experiment.recording)
    if upper_median(between_grains) < max(MIN_TILT, by_error):
        yield missing(CONTACTS, "tangential forces between grains, all point along the line of centres as well as that is known: friction, "
                                "rolling resistance")


def _settings(experiment: Experiment) -> Findings:
    if unknown := [key for key in MATERIALS if key not in experiment.materials]:
        yield missing(SETTINGS, f"{', '.join(unknown)}: a diagnosis warns if a stated value is not that of the scene, which it simulates")
    if exact := [key for key in FITTED if key in experiment.materials and key not in experiment.uncertainty]:
        yield missing(SETTINGS, f"[uncertainty] of {', '.join(exact)}: how far each may be from the truth says whether a gap is an effect "
                                "or a calibration")
