"""A planted effect closes its gap on held-out data; without a gap, no effect reduces anything. gap_reduction_test.py"""
import unittest
from dataclasses import replace

import numpy as np
from synthetic_evidence import GRID, SyntheticWorld

from mcdem.diagnosis.decision import Proposal
from mcdem.diagnosis.effect_fit import fit_effects
from mcdem.diagnosis.evidence import gap_data
from mcdem.diagnosis.gap_reduction import (PartialFit, Split, fit_part, gap_size, held_out_gap, held_out_placebo, held_out_reduction,
                                           measure_reduction, reduction_by_runs, refit_part, split_cells, whole_placebo)
from mcdem.diagnosis.gap_space import FreeParameter, GapSpace
from mcdem.observe.grid import cells_of
from mcdem.results.names import Phase

REPLICATES = 32


class World:
    """Two effects, of which the first one has this amplitude, and a parameter."""

    def __init__(self, amplitude, seed=1):
        self.world = SyntheticWorld(6, seed)
        evidence = self.world.evidence(1, REPLICATES)
        self.world.add_effect(evidence, "adhesion", self.world.pattern(1))
        self.world.add_effect(evidence, "friction", self.world.pattern(1))
        self.world.add_nuisance(evidence, "modulus", self.world.pattern(0.5), 1)
        self.adhesion, self.friction = evidence.library.effects
        self.modulus = evidence.library.nuisances[0]
        evidence.observed = evidence.observed + amplitude * self.adhesion.linear
        self.evidence, self.data = evidence, gap_data(evidence)
        self.split = split_cells(self.data.cells, GRID)

    def reduction(self, *candidates):
        return measure_reduction(self.data, self.split, Proposal(list(candidates)), REPLICATES, 1)


class Splits(unittest.TestCase):
    def test_the_first_part_of_loading_is_fitted(self):
        split = World(0).split
        self.assertEqual(len(split.fitted) + len(split.held_out), 48)
        self.assertEqual(len(split.fitted), 6 * 3)  # three of four displacements are below 85 % of the stroke
        cells = cells_of(GRID)
        for cell in split.fitted:
            self.assertEqual(cells[cell].phase, Phase.load)
            self.assertLess(cells[cell].displacement, 0.85 * GRID.stroke)


class GapSizes(unittest.TestCase):
    def test_of_noise_it_is_zero_on_average(self):
        world = World(0)
        noise, draws = world.world.noise, 2000
        gaps = [noise() - noise() for _ in range(draws)]
        # Thirty cells with a scatter of 2 sqrt 2: 0.4 over 2000 draws; variances from 32 replicates have an error of 0.25 per cell.
        self.assertAlmostEqual(np.mean([gap_size(world.data, world.split.held_out, gap, 1) for gap in gaps]), 0, delta=5)
        twice = [gap_size(world.data, world.split.held_out, gap + noise(), 1, 1) for gap in gaps]
        self.assertAlmostEqual(np.mean(twice), 0, delta=8)

    def test_of_a_gap_it_is_its_square_in_sigmas(self):
        world = World(0)
        held_out, noise, there = world.split.held_out, world.world.noise, 3 * world.adhesion.linear
        sizes = [gap_size(world.data, held_out, there + noise(), 0) - gap_size(world.data, held_out, noise(), 0) for _ in range(500)]
        expected = (there[held_out]**2 / (world.data.noise[:, held_out]**2).mean(axis=0)).sum()
        self.assertAlmostEqual(np.mean(sizes), expected, delta=0.03 * expected)


class Reductions(unittest.TestCase):
    def test_a_planted_effect_closes_its_gap(self):
        world = World(4)
        reduction = world.reduction(0)
        self.assertTrue(0.9 < reduction.fraction <= 1)
        self.assertAlmostEqual(reduction.fraction, min(1, 1 - reduction.after / reduction.before), 12)
        low, high = reduction.interval
        self.assertTrue(0.75 < low <= reduction.fraction <= high)
        self.assertEqual(held_out_reduction(world.data, world.split, [0], REPLICATES), reduction.fraction)
        self.assertTrue(0 <= held_out_placebo(world.data, world.split, REPLICATES, 1) < 0.5)
        self.assertTrue(held_out_gap(world.data, world.split, REPLICATES).shows())

    def test_fits_of_many_gaps_are_those_of_each(self):
        world = World(4)
        for candidates in ([0], [0, 1]):
            chosen = [world.data.candidates[c] for c in candidates]
            space = GapSpace(world.data.noise, REPLICATES, world.split.fitted, world.data.free)
            for gap in (world.data.gap, world.data.gap + world.data.noise[3]):
                alone = fit_effects(space, chosen, gap).amplitudes
                fit = fit_part(world.data, world.split.fitted, gap, candidates, REPLICATES)
                np.testing.assert_allclose(fit.amplitudes, alone, rtol=1e-6)

    def test_cells_that_an_effect_lacks_stay_as_they_are(self):
        world = World(4)
        lacking = world.data.cells[::2]
        world.data.candidates[0] = replace(world.data.candidates[0], lacking=lacking)
        half = world.reduction(0).fraction
        self.assertTrue(0.3 < half < 0.7)  # half of the cells, all with the same gap
        world.data.candidates[0] = replace(world.data.candidates[0], lacking=world.data.cells)
        self.assertEqual(world.reduction(0).fraction, 0)

    def test_without_a_gap_held_out_data_show_none(self):
        worlds = [World(0, seed) for seed in range(50, 90)]
        shown = sum(held_out_gap(world.data, world.split, REPLICATES).shows() for world in worlds)
        self.assertLessEqual(shown, 8, "beyond two sigmas of a skewed distribution")

    def test_runs_that_agree_close_the_gap_whatever_the_signature_predicts(self):
        world = World(4)
        centre = world.evidence.baseline.mean(axis=0)

        def by_runs(runs, **more):
            return reduction_by_runs(world.data, world.split, world.evidence.observed, runs, REPLICATES, **more)

        def runs_with(amplitude):
            runs = np.array([centre + amplitude * world.adhesion.linear + world.world.noise() for _ in range(9)])
            runs[3] = np.nan  # a failed run does not count
            return runs

        self.assertGreater(by_runs(runs_with(4)), 0.9)
        self.assertAlmostEqual(by_runs(runs_with(2)), 0.75, delta=0.15)
        self.assertAlmostEqual(by_runs(runs_with(0)), 0, delta=0.15)
        self.assertIsNone(by_runs(np.full((9, len(centre)), np.nan)))
        some = runs_with(4)
        some[:, world.split.held_out[::2]] = np.nan
        self.assertIsNone(by_runs(some))
        self.assertAlmostEqual(by_runs(some, lacking=world.split.held_out[::2]), 0.5, delta=0.15)

    def test_runs_correct_the_amplitude(self):
        world = World(4)
        shape = world.adhesion.linear.copy()
        world.adhesion.linear *= 0.5  # of the effect's true size
        self.assertAlmostEqual(fit_part(world.data, world.split.fitted, world.data.gap, [0], REPLICATES).amplitudes[0], 8, delta=2)
        left = world.data.gap - 3 * shape - 0.4 * world.modulus.linear
        again = refit_part(world.data, world.split.fitted, left, [0], PartialFit([3], np.array([0.4])), REPLICATES)
        self.assertAlmostEqual(again.amplitudes[0], 3 + 2 * 1, delta=1.5)
        free = [world.data.free[0], FreeParameter(0.5 * shape, 20)]
        expected = GapSpace(world.data.noise, REPLICATES, world.split.fitted, free).fit_nuisances(world.data.gap - 3 * shape)[0]
        self.assertAlmostEqual(again.nuisances[0], expected, delta=1e-9)

    def test_nuisances_of_runs_stay_in_range(self):
        world = World(4)
        farthest = 12 * world.data.free[0].sigma
        world.data.gap = world.data.gap + 1e6 * world.modulus.linear
        first = fit_part(world.data, world.split.fitted, world.data.gap, [0], REPLICATES)
        self.assertEqual(first.nuisances[0], farthest)
        again = refit_part(world.data, world.split.fitted, -world.data.gap, [0], first, REPLICATES)
        self.assertEqual(again.nuisances[0], -farthest)

    def test_another_effect_does_not_close_the_gap(self):
        self.assertLess(World(4).reduction(1).fraction, 0.3)

    def test_two_effects_are_fitted_together(self):
        world = World(4)
        world.data.gap = world.data.gap - 3 * world.friction.linear
        both = world.reduction(0, 1)
        self.assertGreater(both.fraction, 0.9)
        self.assertTrue(both.interval[0] <= both.fraction <= both.interval[1])
        self.assertLess(world.reduction(0).fraction, 0.8)
        fit = fit_part(world.data, world.split.fitted, world.data.gap, [0, 1], REPLICATES)
        np.testing.assert_allclose(fit.amplitudes, [4, -3], atol=1.2)  # 18 correlated cells with noise 1: 0.3 each
        self.assertEqual(len(fit.nuisances), 1)

    def test_of_noise_it_is_not_significant(self):
        covered = sum(World(0, seed).reduction(0).interval[0] <= 0.1 for seed in range(50, 70))
        self.assertGreaterEqual(covered, 16)  # a 90 % interval of the fraction, whose true value is zero

    def test_it_is_zero_if_one_part_is_missing(self):
        world = World(4)
        world.split = Split(world.split.fitted, world.split.held_out[:0])
        reduction = world.reduction(0)
        self.assertEqual((reduction.fraction, reduction.before), (0, 0))
        self.assertEqual(held_out_reduction(world.data, world.split, [0], REPLICATES), 0)
        self.assertEqual(held_out_placebo(world.data, world.split, REPLICATES, 1), 0)

    def test_placebo_of_the_whole_gap(self):
        world = World(4)
        space = GapSpace(world.data.noise, REPLICATES, world.data.cells, world.data.free)
        score = fit_effects(space, world.data.candidates[:1], world.data.gap).score
        placebo = whole_placebo(space, world.data, score, 1)
        self.assertTrue(0 < placebo < 0.5)
        self.assertAlmostEqual(whole_placebo(space, world.data, 2 * score, 1), placebo / 2, 12)
        self.assertEqual(whole_placebo(space, world.data, 1e-9, 1), 1)


if __name__ == "__main__":
    unittest.main()
