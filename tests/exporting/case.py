"""Shared by the tests of exports: a temporary folder, and readers of what is written there."""
import pathlib
import tempfile
import unittest

import synthetic
from synthetic import h5py

from mcdem import exporting
from mcdem.exporting import vtk, xyz  # noqa: F401  for the tests

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
            synthetic.write_run(self.run / f"segment-{number:06}.h5", run, first, first + count)
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
