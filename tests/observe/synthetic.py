"""Recordings with known results: forces, contacts and averages are simple functions of the displacement."""
import pathlib
import sys
from dataclasses import dataclass, replace

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "host/python"))
from mcdem.results import NO_CONTACTS, Box, Contacts, ContainerShape, Failure, Recording, Run, Scans, Wall  # noqa: E402

FLOOR = -1 - Wall.floor


@dataclass(frozen=True)
class Law:
    """`levels`: scans per stroke, the last at full stroke; `hysteresis`: fraction of the force lost while unloading."""

    model: str = "mc_dem"
    seed: int = 1
    cycles: int = 1
    levels: int = 10
    stroke: float = 30e-3  # [m]
    top: float = 15.0  # top force at full stroke while loading [N]
    hysteresis: float = 0.1
    touch: float = 5e-3  # displacement at first contact [m]
    scatter: float = 0.0  # relative standard deviation of the force between seeds
    grains: int = 100
    contacts: int = 0  # in each scan, one in ten with the floor; 0: not recorded
    mean_force: float = 50e-3  # of the contact forces at full stroke, exponentially distributed [N]


def scans(count, **values):
    """Scans without forces, contacts and motion, but for the given values."""
    zeros = {name: np.zeros(count) for name in ("time", "plate_z", "kinetic_energy", "elastic_energy", "coordination_number",
                                                "mean_force", "packing_fraction", "branch_length")}
    unknown = {name: np.full(count, np.nan) for name in ("wall_work", "weight_work", "damping_loss", "friction_loss", "drag_loss",
                                                         "energy_error", "rate_error", "max_overlap")}
    given = dict(frame=np.arange(count), cycle=np.zeros(count, int), phase=np.zeros(count, int), settled=np.zeros(count, bool),
                 wall_force=np.zeros((count, 6, 3)), stress=np.full((count, 3, 3), np.nan), fabric=np.full((count, 3, 3), np.nan),
                 strain=np.zeros((count, 6)), contacts=(NO_CONTACTS,) * count, position=(np.zeros((0, 3)),) * count)
    return Scans(**zeros | unknown | given | values)


def contacts_of(grain, partner, force):
    """Contacts with these forces (C, 3)."""
    force = np.reshape(np.array(force, float), (-1, 3))
    return Contacts(np.array(grain), np.array(partner), np.zeros_like(force), force, np.zeros(len(force)))


def recording(law=None, **values):
    law = law or Law(**values)
    random = np.random.default_rng(law.seed * 7919 + 17)
    factor = 1 + law.scatter * random.standard_normal()
    steps = np.concatenate([np.arange(1, law.levels + 1), np.arange(law.levels - 1, -1, -1)])
    displacement = np.tile(law.stroke * steps / law.levels, law.cycles)
    phase = np.tile(np.repeat([0, 1], law.levels), law.cycles)
    strain = np.maximum(0, (displacement - law.touch) / (law.stroke - law.touch))
    force = law.top * factor * np.where(phase == 1, 1 - law.hysteresis, 1) * strain**1.5
    wall_force = np.zeros((len(phase), 6, 3))
    wall_force[:, Wall.plate, 2] = force
    z, phi, branch = 6 + 2 * strain, 0.6 + 0.1 * strain, 0.0215 - 0.001 * strain
    made = scans(len(phase), cycle=np.repeat(np.arange(law.cycles), 2 * law.levels), phase=phase, plate_z=0.17 - displacement,
                 wall_force=wall_force, coordination_number=z, packing_fraction=phi, branch_length=branch,
                 mean_force=0.1 * force / (z * phi * branch * 15))
    if law.contacts:
        made = replace(made, contacts=tuple(_contacts(law, one, random) for one in strain))
    parameters = {"contact.model": law.model, "packing.seed": str(law.seed)}
    return Recording(f"{law.model.strip(chr(34))} #{law.seed}", parameters, Box(), 0.17, np.full(law.grains, 0.0215), made)


def _contacts(law, strain, random):
    number = np.arange(law.contacts)
    partner = np.where(number % 10 == 9, FLOOR, (number + 1) % law.grains)
    force = np.zeros((law.contacts, 3))
    force[:, 2] = law.mean_force * (0.1 + 0.9 * strain) * random.exponential(size=law.contacts)
    return contacts_of(number % law.grains, partner, force)


def run(laws, replicas):
    """One run with `replicas` seeds of each setting."""
    return Run("synthetic", "", "test", "", "double",
               tuple(recording(replace(law, seed=seed)) for law in laws for seed in range(1, replicas + 1)))


def cell(model, seed=1, factor=1.0):
    """A cell of 0.1 m: compressed by 2 % along all axes, sheared by 10 % in the plane xz, and held.

    Its pressure p is 1 kPa times volume strain over 0.01; while sheared it has a shear stress of p/10.
    """
    axis, shear = np.array([0.01, 0.02, 0.02, 0.02]), np.array([0, 0, 0.1, 0.1])
    strain = np.column_stack([axis, axis, axis, 0 * axis, shear, 0 * axis])
    p = factor * 1e5 * (1 - (1 - axis) ** 3)
    stress = p[:, None, None] * np.eye(3)
    stress[:, 0, 2] = stress[:, 2, 0] = np.where(shear > 0, -0.1 * p, 0)
    parameters = {"contact.model": model, "packing.seed": str(seed), "programme.1.stage": '"move"', "programme.2.stage": '"move"',
                  "programme.3.stage": '"hold"'}
    made = scans(4, time=0.5 + np.arange(4), strain=strain, plate_z=0.1 * (1 - axis), stress=stress,
                 coordination_number=np.full(4, 6.0), packing_fraction=0.6 + axis, rate_error=np.full(4, 0.004))
    return Recording(f"{model} #{seed}", parameters, Box(0.1, 0.1, ContainerShape.cell, 0.1), 0.1, np.full(20, 0.02), made)


def changed(made, **values):
    """The recording with other values of its scans."""
    return replace(made, scans=replace(made.scans, **values))


def rows(made, which):
    """The recording with some of its scans."""
    kept = {}
    for name, values in vars(made.scans).items():
        kept[name] = tuple(np.array(values, object)[which]) if isinstance(values, tuple) and values else values
        if not isinstance(values, tuple):
            kept[name] = values[which]
    kept["contacts"] = tuple(made.scans.contacts[k] for k in np.arange(len(made.scans))[which])
    kept["position"], kept["rotation"] = (), ()
    return replace(made, scans=Scans(**kept))


def with_force(made, force):
    wall_force = made.scans.wall_force.copy()
    wall_force[:, Wall.plate, 2] = force
    return changed(made, wall_force=wall_force)


def stopped(made, count):
    return replace(rows(made, slice(count)), failure=Failure(4711, 42, "overlap past the limit"))


def with_parameters(made, **values):
    """Keys with a double underscore for the dot."""
    return replace(made, parameters=made.parameters | {key.replace("__", "."): value for key, value in values.items()})
