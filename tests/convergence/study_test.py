"""Steps of a study whose simulations are made up: what is simulated, on which packings, and what is refused. study_test.py"""
import types
import unittest
from dataclasses import replace

import numpy as np
from refinements_test import PARAMETERS

from mcdem.convergence.convergence_types import Limits
from mcdem.convergence.converge import Study, converge
from mcdem.observe.grid import Grid, bins_of
from mcdem.observe.observables import observables
from mcdem.errors import InputError

GRID = Grid([0.01, 0.02], 0.002, 0.02)
BINS = bins_of(Grid([0.01, 0.02], 0.002, 0.02))
FIRST = [observables()[bin.observable].name for bin in BINS].index
REPLICAS = 8


class Simulated:
    """As Simulator. All observables increase with the speed of the plate; `scatter` is that between copies."""

    def __init__(self, scatter=0.1, draws_packings=True, grid=GRID):
        self.draws_packings, self.grid, self.drawn, self.asked, self.lost = draws_packings, grid, False, [], {}
        self._random = np.random.default_rng(3)
        self.packing = self._random.normal(0, scatter, (REPLICAS, len(BINS)))

    def find_grid(self, progress=None):
        return self.grid

    def observe(self, changes, progress=None):
        progress(0.5)
        self.asked.append(dict(changes))
        observed = self.packing + changes.get("plate.speed", 0.1)
        for (row, bin) in self.lost:
            observed[row, bin] = np.nan
        return observed

    def draw_packings(self):
        self.drawn, self.packing = True, self._random.normal(0, 0.1, self.packing.shape)


class Studies(unittest.TestCase):
    def study(self, simulated, jitter=0.0, **parameters):
        self.told = []
        scene = types.SimpleNamespace(name="small", parameters=[PARAMETERS | parameters])
        return Study(scene, simulated, jitter, Limits(), lambda stage, fraction: self.told.append((stage, fraction))).run()

    def test_simulates_the_scene_and_every_refinement_of_it(self):
        simulated = Simulated()
        made = self.study(simulated)
        self.assertEqual([len(changes) for changes in simulated.asked], [0, 2, 2, 2, 1, 1, 1])
        self.assertEqual(self.told, [(stage, 0.5) for stage in ("the scene as it stands", *["plate speed"] * 3, "inertia", "time step",
                                                                "list margin")])
        self.assertEqual((made.scene, made.replicas, made.copies, simulated.drawn), ("small", 8, "jittered copies of one packing", False))
        speed, *others = made.causes
        self.assertEqual({round(bin.error, 12) for bin in speed.errors}, {0.1})
        self.assertEqual({bin.error for cause in others for bin in cause.errors}, {0})
        self.assertEqual(made.words[0], "Not converged.")
        self.assertRegex(made.words[1], "^plate speed: top_force is 10 .* within the limit with plate.speed = 0.1 / 20")
        self.assertEqual(made.words[2:], tuple(f"{cause}: no influence in these runs" for cause in ("inertia", "time step", "list margin")))

    def test_new_packings_are_drawn_if_copies_hardly_differ(self):
        for options, jitter, drawn, copies in (
                ({}, 0, True, "new random packings, because jittered copies of one hardly differ"),
                ({}, 1e-3, False, "jittered copies of one packing"),
                ({"draws_packings": False}, 0, False, "jittered copies of one packing, which hardly differ; a packing.file has no random "
                                                      "copies: a larger --jitter makes them")):
            simulated = Simulated(scatter=0, **options)
            made = self.study(simulated, jitter)
            self.assertEqual((simulated.drawn, made.copies), (drawn, copies))
            self.assertEqual(("new random packings", 0.5) in self.told, drawn)
            self.assertEqual(made.causes[0].errors[0].standard_deviation > 0.01, drawn)

    def test_four_replicas_must_press(self):
        simulated = Simulated()
        simulated.lost = {(row, FIRST("top_force")) for row in range(4)}
        self.study(simulated)
        simulated.lost.add((4, FIRST("top_force")))
        with self.assertRaisesRegex(InputError, "^small: 3 of 8 replicas reach the first compared displacement with a force on the plate, "
                                                "and 4 are needed: `mcdem run` with the same settings says why$"):
            self.study(simulated)
        self.assertEqual(self.told, [("the scene as it stands", 0.5)])

    def test_where_forces_are_set_displacements_count(self):
        simulated = Simulated(grid=replace(GRID, force=[0.5, 1.0], force_width=0.1))
        simulated.lost = {(row, FIRST("top_force")) for row in range(8)}
        self.assertEqual(len(self.study(simulated).causes), 4)
        simulated.lost = {(row, FIRST("displacement")) for row in range(8)}
        with self.assertRaisesRegex(InputError, "0 of 8 replicas"):
            self.study(simulated)

    def test_arguments_are_checked_together(self):
        with self.assertRaises(InputError) as refused:
            converge(None, "/nowhere", replicas=7, force_limit=0, sd_limit=-1, jitter=2)
        self.assertEqual(refused.exception.problems, ["replicas: must be 8 or more, got 7", "force_limit: must be above 0, got 0",
                                                      "sd_limit: must be above 0, got -1", "jitter: must be between 0 and 1, got 2"])


if __name__ == "__main__":
    unittest.main()
