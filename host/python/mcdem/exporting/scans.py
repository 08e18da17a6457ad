"""A replica of a run scan by scan, and sums over the contacts of each grain."""
import re

import numpy as np

from ..results.names import Phase, Wall
from ..results.run_file import whole_scans

MAX_LABEL_LENGTH = 80  # characters in the name of a file
PERIODIC = {"box": (), "cylinder": (), "periodic": (1, 0), "cell": (2, 1, 0)}  # axes; a cell may be tilted, so z is first


class Replica:
    """`header`: its recording without scans, which are in `files` one after another."""

    def __init__(self, number, files, header):
        self.number, self.files, self.header = number, files, header
        self.label, self.parameters, self.shape, self.is_cell = header.label, header.parameters, header.box.shape, header.box.is_cell
        self.edges = np.array([header.box.size_x, header.box.size_y, header.plate_start])  # the height is that at the start [m]
        self.diameter, self.species_names = header.diameter, header.species_names
        self.species = header.species.astype(np.int32) if len(header.species) else None

    @property
    def file_name(self):
        """The number and the label, in characters that are safe in all file systems and shells: replica_00003_mc_dem_friction=0.03_2."""
        words = re.sub(r"[^0-9A-Za-z.=+-]+", "_", self.label).lstrip("_")[:MAX_LABEL_LENGTH].rstrip("_.")
        return f"replica_{self.number:05}" + ("_" + words if words else "")

    def scans(self):
        for path in self.files:
            for scans in whole_scans(path, [self.number]):
                yield from (Scan(self, scans, number) for number in range(len(scans)))


class Scan:
    """One scan: positions [m] and rotations [rad], None if not recorded, and observables; `cell` has the current edges of the
    container as columns."""

    def __init__(self, replica, scans, number):
        self.replica = replica
        self.frame, self.cycle, self.phase = scans.frame[number], scans.cycle[number], Phase(scans.phase[number]).name
        self.time, self.plate_z, self.wall_force = scans.time[number], scans.plate_z[number], scans.wall_force[number]
        self.top_force, self.strain = self.wall_force[Wall.plate][2], scans.strain[number]
        x, y, z, xy, xz, yz = self.strain
        self.deformation = np.array([[1 - x, xy, xz], [0, 1 - y, yz], [0, 0, 1 - z]])
        self.cell = self.deformation * replica.edges if replica.is_cell else np.diag(replica.edges)
        self.position, self.rotation = (one[number] if len(one[number]) else None for one in (scans.position, scans.rotation))
        self.contacts, self.knows_contacts = Contacts(self, scans.contacts[number]), scans.knows_contacts[number]

    def nearest(self, vectors):
        """Vectors between points, to the nearest image."""
        for axis in PERIODIC[self.replica.shape]:
            vectors = vectors - np.rint(vectors[:, axis] / self.cell[axis, axis])[:, None] * self.cell[:, axis]
        return vectors


class Contacts:
    """Contacts of a scan in arrays, and sums over them for each grain."""

    def __init__(self, scan, contacts):
        self.scan, self.grain, self.partner = scan, contacts.grain.astype(np.int32), contacts.partner.astype(np.int32)
        self.point, self.force, self.overlap = contacts.point, contacts.force, contacts.overlap
        self.magnitude = np.linalg.norm(self.force, axis=1)
        self.is_pair = self.partner >= 0
        self._ends = np.concatenate([self.grain, self.partner[self.is_pair]])

    def _sums(self, grains, values):
        sums = np.zeros((len(self.scan.replica.diameter), *values.shape[1:]))
        np.add.at(sums, grains, values)
        return sums

    def coordination_number(self):
        return np.bincount(self._ends, minlength=len(self.scan.replica.diameter)).astype(np.int32)

    def force_magnitude(self):
        return self._sums(self._ends, np.concatenate([self.magnitude, self.magnitude[self.is_pair]]))

    def wall_force(self):
        return self._sums(self.grain[~self.is_pair], self.force[~self.is_pair])

    def stress(self):
        """Of each grain, compression positive [Pa]; row: branch from the centre to the contact, column: force (core/stress.h)."""
        force = np.concatenate([-self.force, self.force[self.is_pair]])
        point = np.concatenate([self.point, self.point[self.is_pair]])
        branch = self.scan.nearest(point - self.scan.position[self._ends])
        moments = self._sums(self._ends, branch[:, :, None] * force[:, None, :])
        return moments / (np.pi / 6 * self.scan.replica.diameter ** 3)[:, None, None]

    def partner_position(self):
        """The contact point at a wall [m]."""
        return np.where(self.is_pair[:, None], self.scan.position[np.maximum(self.partner, 0)], self.point)

    def normal_force(self):
        """Along the line from the grain's centre to that of its partner, or normal to the wall; positive in compression [N]."""
        line = self.scan.nearest(self.partner_position() - self.scan.position[self.grain])
        length = np.linalg.norm(line, axis=1)
        return -(self.force * line).sum(axis=1) / np.where(length > 0, length, 1)
