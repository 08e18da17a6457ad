"""A lattice of spheres in equilibrium, as an instrument measures it."""
import copy
import functools
from dataclasses import fields, replace

import numpy as np
from recordings import recording_of

from mcdem.experiment.experiment import MATERIALS, Experiment, Measurement
from mcdem.results import Box, Contacts, Scans, Wall

SIDE = 5
NUMBER = np.arange(SIDE**3).reshape(SIDE, SIDE, SIDE)  # of a grain, by layer, row and place
DIAMETER, WIDTH, DENSITY = 0.02, SIDE * 0.0193, 100
WEIGHT = 9.81 * DENSITY * np.pi / 6 * DIAMETER**3
ERRORS = Measurement(1e-4, 5e-5, 0.05, 13.5e-3)


def force_at(spacing):
    """Hertz force with E = 23.3 kPa and nu = 1/2."""
    return 4 / 3 * 23300 / 1.5 * np.sqrt(DIAMETER / 4) * (DIAMETER - spacing) ** 1.5


def centres(plate_z):
    z, y, x = np.indices(NUMBER.shape).reshape(3, -1) + 0.5
    return np.column_stack((x * WIDTH, y * WIDTH, z * plate_z)) / SIDE


def chains(axis, plate_z, more=0.0):
    """Spheres along an axis, pressed against each other and the walls; the force increases by `more` with each sphere from above."""
    spacing = (plate_z if axis == 2 else WIDTH) / SIDE
    along = np.moveaxis(NUMBER, 2 - axis, 0).reshape(SIDE, -1)
    low, high = (np.full_like(along[:1], -1 - (2 * axis + end)) for end in (0, 1))
    grain, partner = np.concatenate((along[:1], along)), np.concatenate((low, along[1:], high))
    sign = np.where(partner == low, 1, -1)
    size = sign * (force_at(spacing) + more * np.arange(SIDE, -1, -1)[:, None])
    unit = np.eye(3)[axis]
    point = centres(plate_z)[grain] - spacing / 2 * sign[..., None] * unit
    force = size[..., None] * unit
    return Contacts(grain.ravel(), partner.ravel(), point.reshape(-1, 3), force.reshape(-1, 3), np.full(grain.size, np.nan))


def joined(parts):
    return Contacts(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Contacts)))


def truth(heights):
    """At rest, first of loading and then of unloading."""
    contacts = [joined([chains(0, z), chains(1, z), chains(2, z, WEIGHT)]) for z in heights]
    return recording_of("lattice", Box(WIDTH, WIDTH), SIDE * 0.0194, np.full(SIDE**3, DIAMETER), plate_z=heights,
                        top_force=[SIDE**2 * force_at(z / SIDE) for z in heights], phase=np.arange(len(heights)) > np.argmin(heights),
                        position=map(centres, heights), contacts=dict(enumerate(contacts)))


def measured(recording, errors, random):
    """With noise of positions, diameters and forces, and without the contacts below the threshold."""
    positions, contacts = [], []
    for position, one in zip(recording.scans.position, recording.scans.contacts):
        positions.append(position + errors.position_error * random.standard_normal(position.shape))
        force = one.force * (1 + errors.force_error * random.standard_normal((len(one), 1)))
        seen = np.linalg.norm(force, axis=1) >= errors.force_threshold
        contacts.append(replace(one, force=force).rows(seen))
    diameter = recording.diameter + errors.diameter_error * random.standard_normal(len(recording.diameter))
    return replace(recording, diameter=diameter, scans=replace(recording.scans, position=tuple(positions), contacts=tuple(contacts)))


@functools.cache
def _lattice():
    recording = truth([SIDE * (0.0194 - 0.0005 * level) for level in (0, 1, 2, 3, 4, 3, 2, 1, 0)])
    materials = dict.fromkeys(MATERIALS, 0.1) | {"grains.youngs_modulus": 23300.0, "grains.poisson_ratio": 0.5,
                                                 "grains.excess_density": DENSITY}
    seen = measured(recording, ERRORS, np.random.default_rng(1))
    return Experiment("lattice", seen, materials, dict.fromkeys(MATERIALS, 0.01), ERRORS)


def lattice():
    """Five levels of loading and unloading; its arrays may be changed."""
    return copy.deepcopy(_lattice())


def with_scans(experiment, **changed):
    recording = experiment.recording
    return replace(experiment, recording=replace(recording, scans=replace(recording.scans, **changed)))


def with_recording(experiment, **changed):
    return replace(experiment, recording=replace(experiment.recording, **changed))


def with_measurement(experiment, **changed):
    return replace(experiment, measurement=replace(experiment.measurement, **changed))


def first_scans(experiment, count):
    every = experiment.recording.scans
    return with_scans(experiment, **{field.name: getattr(every, field.name)[:count] for field in fields(Scans)})


def without_contacts(experiment, unwanted, frames=range(9)):
    """`unwanted`: of Contacts, (C,) truths."""
    kept = [one.rows(~unwanted(one)) if s in frames else one for s, one in enumerate(experiment.recording.scans.contacts)]
    return with_scans(experiment, contacts=tuple(kept))
