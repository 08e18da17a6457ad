"""Reads a run scan by scan from run.h5, or from the segments of an unfinished run (host/io/README.md)."""
import contextlib
import re

import h5py
import numpy as np

from ..errors import RunError

MAX_LABEL_LENGTH = 80  # characters in the name of a file
PHASES = ("load", "unload")
PLATE = 5  # number of the wall
PERIODIC = {"box": (), "cylinder": (), "periodic": (1, 0), "cell": (2, 1, 0)}  # axes; a cell may be tilted, so z is first


def text(word):
    return word.decode("utf-8", "surrogateescape") if isinstance(word, bytes) else str(word)


@contextlib.contextmanager
def reading(path):
    """What h5py raises becomes an error that names the file: a failed read is a KeyError or RuntimeError, or an OSError without a name."""
    try:
        yield
    except FileNotFoundError:
        raise
    except (KeyError, OSError, RuntimeError, TypeError, ValueError) as error:
        cause = re.search("error message = '(.*?)'", str(error))  # of HDF5, of a failed system call
        raise RunError(f"{path}: cannot be read: {cause[1] if cause else ' '.join(str(error).split())}") from error


def read_replicas(files):
    with reading(files[0]), h5py.File(files[0], locking=False) as file:
        return [Replica(number, files, file) for number in range(file["parameters"].attrs["replicas"])]


class Replica:
    def __init__(self, number, files, file):
        self.number, self.name, self.files = number, f"replica_{number:05}", files
        particles = file[f"particles/{self.name}"]
        self.label = text(particles.attrs["label"])
        self.parameters = {text(key): text(value) for key, value in file[f"parameters/{self.name}"][:]}
        self.shape = text(particles["box"].attrs.get("shape", "box"))
        self.edges = np.array(particles["box"].attrs["edges"])  # along x and y, and the initial height of the plate or the cell [m]
        self.diameter = particles["diameter"][:]
        self.species = particles["species"][:] if "species" in particles else None
        self.species_names = [text(name) for name in particles["species_names"][:]] if "species" in particles else []

    @property
    def is_cell(self):
        return self.shape == "cell"

    @property
    def file_name(self):
        """The number and the label, in characters that are safe in all file systems and shells: replica_00003_mc_dem_friction=0.03_2."""
        words = re.sub(r"[^0-9A-Za-z.=+-]+", "_", self.label).lstrip("_")[:MAX_LABEL_LENGTH].rstrip("_.")
        return self.name + ("_" + words if words else "")

    def scans(self):
        """All scans; contacts are read by Contacts, until the next scan."""
        for path in self.files:
            with contextlib.ExitStack() as stack:
                with reading(path):
                    file = stack.enter_context(h5py.File(path, locking=False))
                    rows = file[f"observables/{self.name}"][:]
                for number, row in enumerate(rows):
                    with reading(path):
                        scan = Scan(self, file, path, number, row)
                    yield scan


class Scan:
    """One scan: positions [m], rotations [rad] and observables; `cell` has the current edges of the container as columns."""

    def __init__(self, replica, file, path, number, row):
        self.replica, self.file, self.path, self.number = replica, file, path, number
        self.frame, self.cycle, self.phase = row["frame"], row["cycle"], PHASES[row["phase"]]
        self.time, self.plate_z, self.wall_force = row["time"], row["plate_z"], row["wall_force"]
        self.top_force = self.wall_force[PLATE][2]
        self.strain = row["strain"] if "strain" in row.dtype.names else np.zeros(6)  # files of earlier versions have none
        self.has_contacts = row["coordination_number"] > 0
        x, y, z, xy, xz, yz = self.strain
        self.deformation = np.array([[1 - x, xy, xz], [0, 1 - y, yz], [0, 0, 1 - z]])
        self.cell = self.deformation * replica.edges if replica.is_cell else np.diag(replica.edges)
        self.position, self.rotation = self.vectors("position"), self.vectors("rotation")

    def vectors(self, what):
        """A vector for each grain; None if not recorded."""
        group = self.file.get(f"particles/{self.replica.name}/{what}")
        row = np.flatnonzero(group["step"][:] == self.number) if group else []
        return group["value"][row[0]].astype(float) if len(row) else None

    def nearest(self, vectors):
        """Vectors between points, to the nearest image."""
        for axis in PERIODIC[self.replica.shape]:
            vectors = vectors - np.rint(vectors[:, axis] / self.cell[axis, axis])[:, None] * self.cell[:, axis]
        return vectors


class Contacts:
    """Contacts of a scan in arrays, and sums over them for each grain."""

    def __init__(self, scan):
        with reading(scan.path):
            group = scan.file[f"contacts/{scan.replica.name}"]
            first, last = group["offset"][scan.number:scan.number + 2]
            rows = group["contact"][first:last]
        self.scan, self.grain, self.partner = scan, rows["grain"], rows["partner"]
        self.point, self.force, self.overlap = (rows[name].astype(float) for name in ("point", "force", "overlap"))
        self.magnitude = np.linalg.norm(self.force, axis=1)
        self.is_pair = self.partner >= 0
        self.are_known = self.grain.size > 0 or not scan.has_contacts  # otherwise not recorded
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
