"""A library from simulations with known signatures. library_simulations_test.py"""
import os
import pathlib
import tempfile
import unittest
from dataclasses import replace

import numpy as np
from synthetic_evidence import GRID

from mcdem.diagnosis.library import write_library
from mcdem.diagnosis.library_simulations import build_library, fitting_library
from mcdem.observe.grid import bins_of
from mcdem.errors import InputError

BINS = len(bins_of(GRID))
# The last ones are parameters, of which one has the name of an effect.
PROBES = ("force_bias", -0.1, 0.2), ("plate_tilt", -0.015, 0.015), ("modulus", -500, 500), ("friction", -0.01, 0.01)


class KnownSimulations:
    """As Simulations: two packings with three replicates, two of which are repeated with every probe. A probe changes a bin by
    linear a + curvature a^2."""

    device, origin = "a device", {"grains.friction": "0.03"}

    def __init__(self):
        random = np.random.default_rng(1)
        self.runs = random.normal(size=(6, BINS))
        self.linear, self.curvature = random.normal(size=(2, len(PROBES), BINS))
        self.curvature[1:] = 0
        self.grid = GRID
        self.candidates = ["force_bias", "plate_tilt"]

    def facts(self):
        return {"packings": 2, "replicates": 3, "paired_rows": [0, 1, 3, 4], "probes": PROBES,
                "candidates": [(name, "", -1, 1) for name in self.candidates], "nuisances": [("modulus", "Pa", 500), ("friction", "", 0.01)]}

    def library(self, progress):
        rows = [self.runs]
        for k, (_, *amplitudes) in enumerate(PROBES):
            rows += [self.runs[[0, 1, 3, 4]] + a * self.linear[k] + a * a * self.curvature[k] for a in amplitudes]
        progress(1)
        return np.concatenate(rows)


class Build(unittest.TestCase):
    def test_contains_baseline_effects_and_nuisances(self):
        simulations, shown = KnownSimulations(), []
        library = build_library(simulations, shown.append)
        np.testing.assert_array_equal(library.baseline, simulations.runs)
        self.assertEqual((library.packing, library.grid, library.origin), ([0, 0, 0, 1, 1, 1], GRID, simulations.origin))
        self.assertEqual((set(library.provenance), library.provenance["device"], shown), ({"program", "device"}, "a device", [1]))
        self.assertEqual([one.name for one in library.effects], ["force_bias", "plate_tilt"])
        self.assertEqual([one.name for one in library.nuisances], ["modulus", "friction"])
        for k, signature in enumerate(library.effects + library.nuisances):
            self.assertEqual((signature.reach, signature.pairs()), (PROBES[k][2], 4))
            np.testing.assert_allclose(signature.linear, simulations.linear[k], atol=1e-9)
            np.testing.assert_allclose(signature.curvature, simulations.curvature[k], atol=1e-9)


class Fitting(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "library.json"
        self.simulations = KnownSimulations()

    def write(self):
        write_library(self.file, build_library(self.simulations, lambda _: None))

    def test_is_none_without_a_file(self):
        self.assertIsNone(fitting_library(self.simulations, None))
        self.assertIsNone(fitting_library(self.simulations, self.file))

    def test_is_that_of_the_file_without_remnants_of_an_interruption(self):
        self.write()
        os.link(self.file, f"{self.file}.0123456789abcdef.tmp")
        library = fitting_library(self.simulations, self.file)
        np.testing.assert_array_equal(library.baseline, self.simulations.runs)
        self.assertEqual(os.listdir(self.file.parent), [self.file.name])

    def test_is_refused_if_it_does_not_fit(self):
        self.write()
        changes = (({"origin": {"grains.friction": "0.9"}}, "was made with grains.friction = 0.03, needed is 0.9"),
                   ({"candidates": ["adhesion"]}, "has no signature of adhesion"),
                   ({"grid": replace(self.simulations.grid, stroke=0.04)}, "was made for a stroke of 30 mm, the experiment has 40 mm"))
        for change, problem in changes:
            simulations = KnownSimulations()
            vars(simulations).update(change)
            with self.assertRaisesRegex(InputError, f"{self.file}: {problem}"):
                fitting_library(simulations, self.file)


if __name__ == "__main__":
    unittest.main()
