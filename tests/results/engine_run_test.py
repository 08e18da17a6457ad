"""Runs of the compiled module as plain values: what it reads from a file and what h5py reads from it. engine_run_test.py"""
import dataclasses
import gc
import importlib.util
import pathlib
import tempfile
import unittest

import h5py
import numpy as np
import written

import mcdem
from mcdem.results import ContainerShape, Scans, read_run
from mcdem.results.engine_run import run_of

R = "replica_00000"


@unittest.skipUnless(importlib.util.find_spec("mcdem._engine"), "the Python module was not built")
class EngineRuns(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.file = pathlib.Path(kept.name) / "run.h5"
        written.write_run(self.file, replicas=2)
        rows = written.scans()
        for number, name in enumerate(written.SCAN.names):  # distinguishes the fields
            if name not in ("frame", "phase", "settled"):
                rows[name] += number
        with h5py.File(self.file, "r+") as run:
            run[f"observables/{R}"][...] = rows
            run[f"particles/{R}/rotation/value"][...] = run[f"particles/{R}/position/value"][()] / 100

    def change(self, change):
        with h5py.File(self.file, "r+") as run:
            change(run)

    def assert_same(self, one, other):
        """Values, and types of arrays."""
        self.assertIs(type(one), type(other))
        if isinstance(one, tuple):
            self.assertEqual(len(one), len(other))
            for a, b in zip(one, other, strict=True):
                self.assert_same(a, b)
        elif isinstance(one, np.ndarray):
            self.assertEqual(one.dtype, other.dtype)
            np.testing.assert_array_equal(one, other)
        elif dataclasses.is_dataclass(one):
            for field in dataclasses.fields(one):
                with self.subTest(field.name):
                    self.assert_same(getattr(one, field.name), getattr(other, field.name))
        else:
            self.assertEqual(one, other)

    def test_all_values_are_those_of_the_file(self):
        self.change(written.add_species_and_failure)
        for shape in ContainerShape:
            self.change(lambda run: run[f"particles/{R}/box"].attrs.__setitem__("shape", np.bytes_(shape)))
            self.assert_same(run_of(mcdem.read(self.file)), read_run(self.file, contacts=True, positions=True))
        self.assert_same(run_of(mcdem.read(self.file, what="observables")), read_run(self.file))

    def test_numbers_are_not_copied_and_stay_valid(self):
        run = mcdem.read(self.file)
        one, scans = run[0], run_of(run).recordings[0].scans
        for array, own in ((scans.time, one.scans), (scans.wall_force, one.wall_force), (scans.stress, one.stress),
                           (scans.position[2], one.positions(2)), (scans.rotation[0], one.rotations(0)),
                           (scans.contacts[2].force, one.contacts(2))):
            self.assertTrue(np.shares_memory(array, own))
        del run, one, own, array
        gc.collect()
        filler = [np.full(scans.wall_force.shape, 7.0) for _ in range(200)]  # would reuse freed memory
        expected = read_run(self.file, contacts=True, positions=True).recordings[0].scans
        self.assert_same(Scans(**vars(scans)), expected)
        self.assertEqual(len(filler), 200)

    def test_runs_only(self):
        plain = read_run(self.file)
        self.assertIs(run_of(plain), plain)
        for other in (None, str(self.file), mcdem.read(self.file)[0]):
            with self.assertRaisesRegex(TypeError, f"the run must be a Run, got {type(other).__name__}"):
                run_of(other)


if __name__ == "__main__":
    unittest.main()
