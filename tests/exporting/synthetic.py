"""Shared by the tests of exports: a result file with all kinds of data (host/io/README.md), written by h5py, and its export."""
import pathlib
import sys
import tempfile
import unittest

import h5py
import numpy as np

sys.path.append(str(pathlib.Path(__file__).parents[1] / "results"))
import written  # noqa: E402

from mcdem import exporting  # noqa: E402
from mcdem.exporting import vtk, xyz  # noqa: E402, F401  for the tests

SPACING = 0.02  # [m]
SIDE = 3  # grains along each edge
GRAINS = SIDE ** 3
PLATE = 5
FLOOR = 4
CONTACT = np.dtype([("grain", "i4"), ("partner", "i4"), ("point", "f8", (3,)), ("force", "f8", (3,)), ("overlap", "f8")])


def contacts_of(*rows):
    return np.array(list(rows), CONTACT)


class Scan:
    """A scan; positions, rotations and contacts can be replaced, None means not recorded."""

    def __init__(self, replica, number, scans):
        half = max(scans // 2, 1)
        depth = number if number < half else scans - 1 - number
        grain = np.arange(GRAINS)
        lattice = np.stack([grain % SIDE, grain // SIDE % SIDE, grain // SIDE ** 2], axis=1)
        self.position = (lattice + 0.5) * SPACING - [0, 0, 1e-4 * depth]
        self.rotation = np.stack([0.01 * grain, 0 * grain - 0.02 * depth, 0 * grain + 0.1 / (1 + replica)], axis=1)
        self.row = np.zeros((), written.SCAN)
        self.row["frame"], self.row["phase"] = number, number >= half
        self.row["time"], self.row["plate_z"] = 0.1 * number, SIDE * SPACING - 1e-3 * depth
        self.row["wall_force"] = [[wall, number, 1 / (1 + wall)] for wall in range(6)]
        self.row["coordination_number"] = 2
        self.contacts = contacts_of(*(contact for i in grain for contact in self.contacts_above(i, depth)))

    def contacts_above(self, grain, depth):
        force = [1e-4 * grain, 0, 0.01 * (depth + 1) * (1 + np.sin(grain)) / 3]
        above = grain + SIDE ** 2
        yield grain, above if above < GRAINS else -1 - PLATE, self.position[grain] + [0, 0, SPACING / 2], force, 1e-4 * depth
        if grain < SIDE ** 2:
            yield grain, -1 - FLOOR, self.position[grain] * [1, 1, 0], force, 1e-4 * depth


class Replica:
    def __init__(self, number, scans):
        self.label = f"mc_dem, packing {number}"
        self.parameters = {"contact.model": '"mc_dem"', "grains.youngs_modulus": "23300"}
        self.shape, self.edges = "box", [SIDE * SPACING] * 3
        self.diameter = SPACING * (1 + 0.01 * (np.arange(GRAINS) % 3))
        self.species, self.species_names = (np.arange(GRAINS, dtype="i4") % 2, ["soft", "half stiff"]) if number % 2 else (None, [])
        self.scans = [Scan(number, scan, scans) for scan in range(scans)]


def make_run(replicas=1, scans=1):
    return [Replica(number, scans) for number in range(replicas)]


def texts(words):
    return np.char.encode(np.array(words), "utf-8")


def vectors(group, scans, what):
    seen = [k for k, scan in enumerate(scans) if getattr(scan, what) is not None]
    group[f"{what}/value"] = np.array([getattr(scans[k], what) for k in seen]).reshape(len(seen), len(group["diameter"]), 3)
    group[f"{what}/step"] = np.array(seen, int)


def write_run(file, run, first=0, last=None):
    """Scans first .. last - 1 of every replica."""
    with h5py.File(file, "w") as out:
        written.write_head(out, len(run))
        for number, replica in enumerate(run):
            name, scans = f"replica_{number:05}", replica.scans[first:last]
            out[f"parameters/{name}"] = texts(list(replica.parameters.items()))
            out[f"observables/{name}"] = np.array([scan.row for scan in scans], written.SCAN)
            particles = out.create_group(f"particles/{name}")
            particles.attrs["label"] = np.bytes_(replica.label.encode())
            particles.create_group("box").attrs.update(edges=replica.edges, shape=np.bytes_(replica.shape))
            particles["diameter"] = replica.diameter
            if replica.species is not None:
                particles["species"], particles["species_names"] = replica.species, texts(replica.species_names)
            for what in ("position", "rotation"):
                vectors(particles, scans, what)
            out[f"contacts/{name}/contact"] = np.concatenate([scan.contacts for scan in scans])
            out[f"contacts/{name}/offset"] = np.cumsum([0, *(len(scan.contacts) for scan in scans)])
    return file


FIRST, SECOND = "replica_00000_mc_dem_packing_0", "replica_00001_mc_dem_packing_1"


class Case(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory(prefix="mcdem-export-")
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.run, self.view = self.folder / "run", self.folder / "view"
        self.run.mkdir()
        self.view.mkdir()

    def export(self, run, form, replicas=(), scans=(), parts=()):
        """Writes the run, in segments of `parts` scans if given, and exports it; returns the number of files."""
        first = 0
        for number, count in enumerate(parts or [len(run[0].scans)]):
            write_run(self.run / f"segment-{number:06}.h5", run, first, first + count)
            first += count
        return exporting.export(self.run, self.view, [form], replicas, scans)

    def grid(self, name, replica=FIRST, scan=0):
        """Tables of an exported file by their names in it."""
        tables = {}
        with h5py.File(self.view / replica / f"{name}_{scan:06}.hdf") as file:
            file["VTKHDF"].visititems(lambda path, found: tables.update({path: found[:]} if isinstance(found, h5py.Dataset) else {}))
        return tables

    def points(self, *of, **more):
        return {path.split("/")[1]: table for path, table in self.grid(*of, **more).items() if path.startswith("PointData/")}
