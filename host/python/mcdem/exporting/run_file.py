"""Reads a run scan by scan from run.h5, or from the segments of an unfinished run (host/io/README.md)."""
import contextlib
import functools
import hashlib
import re

import h5py
import numpy as np

from ..errors import InputError, RunError

FORMAT = 1  # layout of the result files
OPEN_FILES = 100  # most of them at the same time
BLOCK = 1 << 22  # bytes of a table that are read at once
MOST_OF_LABEL = 80  # characters in the name of a file
PHASES = ("load", "unload")
WALLS = 6
PLATE = 5
PERIODIC = {"box": (), "cylinder": (), "periodic": (1, 0), "cell": (2, 1, 0)}  # axes; a cell may be tilted, so z is first
DAMAGED = "; the file is damaged or was not written by this program: restore it from a copy or run again"


@contextlib.contextmanager
def reading(path):
    """Errors of HDF5, and of tables that are not as they must be, name the file."""
    try:
        yield
    except InputError:
        raise
    except OSError as error:
        if error.errno:
            raise RunError(f"{path}: cannot be read: {error.strerror}") from error
        raise InputError(f"{path}: {error}{DAMAGED}") from error
    except (AttributeError, IndexError, KeyError, RuntimeError, TypeError, ValueError) as error:
        raise InputError(f"{path}: {error}{DAMAGED}") from error


def result_files(path):
    """The files of a run, in the order of its scans."""
    if not path.exists():
        raise InputError(f"{path}: must be a result folder or file, got nothing there")
    if not path.is_dir():
        return [path]
    if (path / "run.h5").exists():
        return [path / "run.h5"]
    if (path / "parts").exists():
        raise InputError(f"{path}: holds parts of a run that are not merged yet: wait for the programs that compute them, or go on "
                         "with --resume (in Python resume=True)")
    segments = sorted(file for file in path.iterdir() if re.fullmatch(r"segment-\d{6}\.h5", file.name))
    for number, file in enumerate(segments):
        if file.name != f"segment-{number:06}.h5":
            raise InputError(f"{path}/segment-{number:06}.h5: is missing, though later segments are there")
    if not segments and any(path.glob("checkpoint.*")):
        raise InputError(f"{path}: holds a run that was stopped before it wrote results: go on with --resume (in Python resume=True)")
    if not segments:
        raise InputError(f"{path}: holds no run (neither run.h5 nor segment-000000.h5)")
    return segments


def text(word):
    return word.decode("utf-8", "surrogateescape") if isinstance(word, bytes) else str(word)


def type_text(dtype):
    """As it is in the digest: "f8", "(6,3)f8", "{frame:i4,cycle:i4,..}"."""
    if dtype.subdtype:
        return f"({','.join(map(str, dtype.shape))}){type_text(dtype.base)}"
    if dtype.names:
        return "{" + ",".join(f"{name}:{type_text(dtype[name])}" for name in dtype.names) + "}"
    return ("i" if dtype.kind == "b" else dtype.kind) + str(dtype.itemsize)


class ResultFile:
    def __init__(self, path):
        self.path = path
        with reading(path):
            self.file = h5py.File(path, "r")
            attributes = self.file["parameters"].attrs if "parameters" in self.file else {}
            if "format" not in attributes:
                raise InputError(f"{path}: is HDF5 but not a result of this program: give a run.h5 or the folder of a run")
            if not 1 <= attributes["format"] <= FORMAT:
                raise InputError(f"{path}: has layout {attributes['format']}, this program reads up to {FORMAT}: use a newer version")
            self.replicas = int(attributes["replicas"])
            self.unchecked = {text(name).lstrip("/"): text(digest) for name, digest in self.file["digests"][:]} if "digests" in self.file else {}

    def attributes(self, group):
        return self.file[group].attrs

    def table(self, name):
        """The table; its digest is checked the first time."""
        found = self.file[name]
        if found.is_virtual or found.external or found.file.filename != self.file.filename:
            raise InputError(f"{self.path}: /{name}: lies outside this file, and is not followed")
        if name in self.unchecked:
            digest, step = hashlib.sha256(), max(1, BLOCK // max(1, found.nbytes // max(1, len(found))))
            for first in range(0, len(found), step):
                digest.update(found[first:first + step].tobytes())
            digest.update(f"{type_text(found.dtype)} {'x'.join(map(str, found.shape))}".encode())
            if digest.hexdigest() != self.unchecked.pop(name):
                raise InputError(f"{self.path}: /{name}: does not have the digest that it was written with; the file is damaged: restore it from "
                                 "a copy or run again")
        return found


class RunFiles:
    """A run, of which only what is asked for is read."""

    def __init__(self, path):
        paths = result_files(path)
        opened = functools.lru_cache(OPEN_FILES)(ResultFile)  # without references to the run, with which its files are closed
        self.replicas = [Replica(number, paths, opened) for number in range(opened(paths[0]).replicas)]

    def varying_keys(self):
        """Scene keys that are not the same in all replicas."""
        every = [replica.parameters for replica in self.replicas]
        return sorted(key for key in set().union(*every) if len({one.get(key, "") for one in every}) > 1)


class Replica:
    def __init__(self, number, paths, opened):
        self.number, self.name, self._paths, self._opened = number, f"replica_{number:05}", paths, opened
        file = opened(paths[0])
        with reading(file.path):
            self.label = self.label_in(file)
            self.parameters = {text(key): text(value) for key, value in file.table(f"parameters/{self.name}")[:]}
            box = file.attributes(f"particles/{self.name}/box")
            self.shape = text(box.get("shape", b"box"))
            self.edges = np.array(box["edges"], float)  # along x and y, and the initial height of the plate or the cell [m]
            if self.shape not in PERIODIC or self.edges.shape != (3,) or not (self.edges > 0).all():
                raise InputError(f"{file.path}: /particles/{self.name}/box: must be a known shape with 3 edges > 0 [m]{DAMAGED}")
            self.diameter = file.table(f"particles/{self.name}/diameter")[:]
            self.species, self.species_names = None, []
            if f"particles/{self.name}/species" in file.file:
                self.species = file.table(f"particles/{self.name}/species")[:]
                self.species_names = [text(name) for name in file.table(f"particles/{self.name}/species_names")[:]]

    def label_in(self, file):
        return text(file.attributes(f"particles/{self.name}")["label"])

    @property
    def is_cell(self):
        return self.shape == "cell"

    @property
    def file_name(self):
        """The number and the label, in characters that are safe in all file systems and shells: replica_00003_mc_dem_friction=0.03_2."""
        words = re.sub(r"[^0-9A-Za-z.=+-]+", "_", self.label).lstrip("_")[:MOST_OF_LABEL].rstrip("_.")
        return self.name + ("_" + words if words else "")

    def scans(self):
        """All scans; their positions and contacts are read when they are used."""
        for path in self._paths:
            file = self._opened(path)
            with reading(path):
                if file.replicas != self._opened(self._paths[0]).replicas or self.label_in(file) != self.label:
                    raise InputError(f"{path}: belongs to another run than the segments before it")
                rows = file.table(f"observables/{self.name}")[:]
            for number, row in enumerate(rows):
                yield Scan(self, file, number, row)


class Scan:
    """One scan: positions [m], rotations [rad], contacts and observables; `cell` has the current edges of the container as columns."""

    def __init__(self, replica, file, number, row):
        self.replica, self._file, self._number = replica, file, number
        with reading(file.path):
            self.frame, self.cycle, self.phase = int(row["frame"]), int(row["cycle"]), PHASES[row["phase"]]
            self.time, self.plate_z, self.wall_force = float(row["time"]), float(row["plate_z"]), row["wall_force"]
            self.strain = row["strain"] if "strain" in row.dtype.names else np.zeros(6)
            self.has_contacts = row["coordination_number"] > 0
            x, y, z, xy, xz, yz = self.strain
        self.deformation = np.array([[1 - x, xy, xz], [0, 1 - y, yz], [0, 0, 1 - z]])
        self.cell = self.deformation * replica.edges if replica.is_cell else np.diag(replica.edges)

    @property
    def top_force(self):
        return float(self.wall_force[PLATE][2])

    def _vectors(self, what):
        """A vector for each grain; None if not recorded."""
        group = f"particles/{self.replica.name}/{what}"
        with reading(self._file.path):
            if group not in self._file.file:
                return None
            row = np.flatnonzero(self._file.table(f"{group}/step")[:] == self._number)
            if row.size == 0:
                return None
            vectors = self._file.table(f"{group}/value")[row[0]].astype(float)
        if vectors.shape != (len(self.replica.diameter), 3) or not np.isfinite(vectors).all():
            raise InputError(f"{self._file.path}: /{group}: must be 3 numbers for each grain{DAMAGED}")
        return vectors

    @functools.cached_property
    def position(self):
        return self._vectors("position")

    @functools.cached_property
    def rotation(self):
        return self._vectors("rotation")

    def read_contacts(self):
        group = f"contacts/{self.replica.name}"
        with reading(self._file.path):
            first, last = self._file.table(f"{group}/offset")[self._number:self._number + 2]
            rows = self._file.table(f"{group}/contact")[first:last]
            grain, partner, grains = rows["grain"], rows["partner"], len(self.replica.diameter)
            if not ((grain >= 0) & (grain < grains) & (partner >= -WALLS) & (partner < grains)).all():
                raise InputError(f"{self._file.path}: /{group}: must be contacts of grains and walls that are there{DAMAGED}")
        return rows

    def nearest(self, vectors):
        """Vectors between points, to the nearest image."""
        for axis in PERIODIC[self.replica.shape]:
            vectors = vectors - np.rint(vectors[:, axis] / self.cell[axis, axis])[:, None] * self.cell[:, axis]
        return vectors


class Contacts:
    """Contacts of a scan in arrays, and sums over them for each grain."""

    def __init__(self, scan):
        rows = scan.read_contacts()
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
