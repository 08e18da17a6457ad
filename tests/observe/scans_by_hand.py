"""Scans with given grains and contact forces."""
import numpy as np
from synthetic import contacts_of, scans

from mcdem.observe.contact_residuals import Material
from mcdem.observe.seen_scans import SeenScans
from mcdem.results import Box, Contacts, Recording, Wall

# The walls are not much stiffer than the grains, so that their compliance matters.
SOFT = Material(youngs_modulus=20e3, poisson_ratio=0.5, wall_youngs_modulus=60e3, wall_poisson_ratio=0.3, friction=0.03)
EDGE, PUSH = 0.02, 0.01  # of a lattice [m], [N]


def at(wall):
    return -1 - wall


def contacts(rows):
    """Of rows (grain, partner, point, force)."""
    grain, partner, point, force = zip(*rows)
    made = contacts_of(grain, partner, force)
    return Contacts(made.grain, made.partner, np.array(point, float).reshape(-1, 3), made.force, made.overlap)


def seen(rows, position=None, *, box=Box(0.2, 0.1), diameter=(), plate_z=0.15, top_force=0.0, material=SOFT, before=None):
    """One scan with the contacts `rows`; `before`: positions of the first scan of the recording."""
    found = rows if isinstance(rows, Contacts) else contacts(rows)
    diameter = np.array(diameter, float) if len(diameter) else np.full(1 + max(*found.grain, *found.partner), 0.02)
    position = np.zeros((len(diameter), 3)) if position is None else np.array(position, float)
    wall_force = np.zeros((2, 6, 3))
    wall_force[:, Wall.plate, 2] = top_force
    made = scans(2, plate_z=np.full(2, float(plate_z)), wall_force=wall_force, contacts=(found,) * 2,
                 position=(position if before is None else np.array(before, float), position))
    return SeenScans(Recording("by hand", {}, box, 0.2, diameter, made), [1], material)


class Lattice:
    """`n`^3 grains on a cubic lattice between the walls, with contacts to all neighbours and walls: all contacts have 10 mN, and the plate's
    force is their sum."""

    def __init__(self, n, diameter=1.02 * EDGE):
        self.n, self.box, self.plate_z = n, Box(n * EDGE, n * EDGE), n * EDGE
        self.diameter = np.full(n**3, diameter)
        z, y, x = np.indices((n, n, n)).reshape(3, -1)
        self.position = EDGE * (np.column_stack([x, y, z]) + 0.5)
        rows = []
        for grain, place in enumerate(zip(x, y, z)):
            for axis in range(3):
                unit = np.eye(3)[axis]
                half = 0.5 * EDGE * unit
                if place[axis] == 0:
                    rows.append((grain, -1 - 2 * axis, self.position[grain] - half, PUSH * unit))
                partner = -2 - 2 * axis if place[axis] == n - 1 else grain + n**axis
                rows.append((grain, partner, self.position[grain] + half, -PUSH * unit))
        self.contacts = contacts(rows)
        self.top_force = n * n * PUSH

    def at(self, wall):
        return self.contacts.partner == at(wall)

    def recording(self, count=1, **values):
        wall_force = np.zeros((count, 6, 3))
        wall_force[:, Wall.plate, 2] = self.top_force
        given = dict(plate_z=np.full(count, float(self.plate_z)), wall_force=wall_force, contacts=(self.contacts,) * count,
                     position=(self.position,) * count)
        return Recording("lattice", {}, self.box, self.plate_z, self.diameter, scans(count, **given | values))

    def seen(self, material=SOFT):
        return SeenScans(self.recording(), [0], material)
