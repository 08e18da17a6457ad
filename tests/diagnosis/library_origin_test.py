"""A library is accepted only with the scene, instrument and program from which it was made. library_origin_test.py"""
import math
import unittest

import numpy as np
from synthetic_evidence import GRID, SyntheticWorld

from mcdem.diagnosis.library import Library
from mcdem.diagnosis.library_origin import expect_alike_loads, expect_library_of, expect_origin
from mcdem.observe.grid import Grid, bins_of
from mcdem.observe.observables import observables
from mcdem.errors import InputError
from mcdem.results.names import Phase

ORIGIN = {"contact.model": "elastic_sphere", "grains.friction": "0.03", "plate.start": "0.06", "plate.end": "0.05", "grains": "100",
          "protocol.scans_per_stroke": "3", "box.size_x": "0.08", "container.size_y": "0.08", "mean diameter": "0.0215",
          "measurement.force_error": "0.01", "numerics.precision": "single", "program": "0.2.0", "kernels": "abc", "packing.seed": "1"}
# Value that is needed, whether the library is accepted.
NEEDED = (
    ("contact.model", "point_force_on_sphere", False),
    ("grains.friction", "0.9", False),
    ("measurement.force_error", "0.03", False),
    ("numerics.precision", "double", False),
    ("program", "99.0", False),
    ("kernels", "others", False),
    ("packing.seed", "2", True),  # data of the experiment
    ("plate.start", "0.061", True),
    ("plate.end", "0.051", True),
    ("protocol.scans_per_stroke", "4", True),
    ("box.size_x", "0.084", True),
    ("box.size_x", "0.089", False),
    ("container.size_y", "0.076", True),
    ("container.size_y", "0.071", False),
    ("mean diameter", "0.0204", True),
    ("mean diameter", "0.043", False),
    ("mean diameter", "unknown", False),
    ("grains", "105", True),
    ("grains", "150", False),
)


class Origin(unittest.TestCase):
    def problems(self, needed, made=None):
        """Of a library whose origin is `made`."""
        library = Library(GRID, np.zeros((0, 0)), [], origin=ORIGIN if made is None else made)
        with self.assertRaises(InputError) as caught:
            expect_origin(library, needed, "file.json")
        return caught.exception.problems

    def test_is_the_same_but_for_data_of_the_experiment(self):
        expect_origin(Library(GRID, np.zeros((0, 0)), [], origin=ORIGIN), ORIGIN, "file.json")
        for name, value, accepted in NEEDED:
            with self.subTest(name, needed=value):
                needed = ORIGIN | {name: value}
                if accepted:
                    expect_origin(Library(GRID, np.zeros((0, 0)), [], origin=ORIGIN), needed, "file.json")
                else:
                    problem, advice = self.problems(needed)
                    self.assertEqual(problem, f"file.json: was made with {name} = {ORIGIN[name]}, needed is {value}")
                    self.assertIn("give another file name for --library", advice)

    def test_all_differences_are_named(self):
        told = self.problems(ORIGIN | {"contact.model": "mc_dem", "grains.friction": "0.9"})
        self.assertEqual([problem.split()[4] for problem in told[:-1]], ["contact.model", "grains.friction"])

    def test_missing_names_are_refused_on_both_sides(self):
        self.assertIn("file.json: was made with grains.friction = nothing, needed is 0.03", self.problems(ORIGIN, {}))
        self.assertEqual(self.problems({}, {"kernels": "abc"})[0], "file.json: was made with kernels = abc, needed is nothing")


class Contents(unittest.TestCase):
    def setUp(self):
        world = SyntheticWorld(2, 1)
        evidence = world.evidence(1, 2)
        world.add_effect(evidence, "adhesion", world.pattern(1))
        world.add_nuisance(evidence, "modulus", world.pattern(1), 1)
        self.library = evidence.library

    def problems(self, grid=GRID, candidates=("adhesion",), nuisances=("modulus",)):
        try:
            expect_library_of(self.library, grid, candidates, nuisances, "file.json")
        except InputError as error:
            return error.problems
        return []

    def test_signatures_of_all_candidates_and_nuisances(self):
        self.assertEqual(self.problems(), [])
        told = self.problems(candidates=("adhesion", "friction"), nuisances=("gamma",))
        self.assertEqual([problem.split(":")[1] for problem in told], [" has no signature of friction", " has no signature of gamma"])
        self.assertIn("or leave gamma out of --candidates", told[1].lower())

    def test_stroke_of_the_experiment(self):
        for stroke, refused in ((0.0275, False), (0.0333, False), (0.026, True), (0.035, True)):
            told = self.problems(Grid(GRID.displacement, GRID.width, stroke))
            self.assertEqual(told, [f"file.json: was made for a stroke of 30 mm, the experiment has {1e3 * stroke:.4g} mm"] * refused)
        self.library.grid = Grid(GRID.displacement, GRID.width, GRID.stroke, [0.1] * len(GRID.displacement), 0.1)
        self.assertEqual(self.problems(Grid(GRID.displacement, GRID.width, 0.035)), [])  # forces are prescribed


class Loads(unittest.TestCase):
    def test_packings_have_the_load_of_the_experiments(self):
        grid = Grid([0.01, 0.02], 0.005, 0.022)
        names, bins = [observable.name for observable in observables()], bins_of(grid)
        library = Library(grid, np.full((3, len(bins)), 0.5), [0] * 3)

        def at_times_the_load(times):
            baseline = library.baseline.copy()
            for k, bin in enumerate(bins):
                if names[bin.observable] == "top_force":
                    baseline[:, k] += math.log(times) if bin.phase == Phase.load else 3
            baseline[0, 0] = math.nan
            expect_alike_loads(library, baseline, "file.json")

        for times in (0.8, 1.0, 1.3):
            at_times_the_load(times)
        with self.assertRaisesRegex(InputError, "^file.json: at the same displacements .* carries 1.90 times the load"):
            at_times_the_load(1.9)
        with self.assertRaises(InputError):
            at_times_the_load(0.5)

    def test_prescribed_forces_are_not_compared(self):
        grid = Grid([0.01, 0.02], 0.005, 0.022, [0.1, 0.2], 0.1)
        forces = [observables()[bin.observable].name == "top_force" for bin in bins_of(grid)]
        library = Library(grid, np.where(forces, math.nan, np.full((3, len(forces)), 0.5)), [0] * 3)  # not observed under given forces
        expect_alike_loads(library, library.baseline, "file.json")


if __name__ == "__main__":
    unittest.main()
