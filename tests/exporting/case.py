"""Shared by the tests of exports: a temporary folder, and readers of what is written there."""
import pathlib
import tempfile
import unittest

import synthetic
from synthetic import h5py

from mcdem import export

FIRST, SECOND = "replica_00000_mc_dem_packing_0", "replica_00001_mc_dem_packing_1"


class Case(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory(prefix="mcdem-export-")
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)

    def export(self, run, out="view", **how):
        """Writes the run and exports it; returns the number of files."""
        synthetic.write_run(self.folder / "run.h5", run)
        return export(self.folder / "run.h5", self.folder / out, **how)

    def refused(self, words, run, kind=ValueError, **how):
        with self.assertRaisesRegex(kind, words):
            export(self.folder / run, self.folder / "view", **(how or {"vtk": True}))

    def grid(self, name, replica=FIRST, scan=0):
        """Tables of an exported file by their names in it."""
        tables = {}
        with h5py.File(self.folder / "view" / replica / f"{name}_{scan:06}.hdf") as file:
            file["VTKHDF"].visititems(lambda path, found: tables.update({path: found[:]} if isinstance(found, h5py.Dataset) else {}))
        return tables

    def points(self, *of, **more):
        return {path.split("/")[1]: table for path, table in self.grid(*of, **more).items() if path.startswith("PointData/")}
