"""A planted effect closes its gap on held-out data; without a gap, no effect reduces anything. gap_reduction_test.py"""
import unittest
from dataclasses import replace

import numpy as np
import synthetic_evidence
from synthetic_evidence import GRID

from mcdem.diagnosis.effect_fit import fit_effects
from mcdem.diagnosis.gap_reduction import HeldOutTest, PartialFit, fit_part, gap_sizes, refit_part, whole_placebo
from mcdem.diagnosis.gap_space import FreeParameter
from mcdem.observe.grid import bins_of
from mcdem.results.names import Phase


class Case(synthetic_evidence.Case):
    """Two effects, of which the first one has this amplitude, and a parameter."""

    def __init__(self, amplitude, seed=1):
        super().__init__(amplitude, seed=seed)
        self.adhesion, self.friction, self.modulus = (one.linear for one in self.effects + self.parameters)
        self.test = HeldOutTest.split(self.data, GRID)
        self.fitted, self.held_out = self.test.fitted, self.test.held_out

    def reduction(self, *candidates):
        return self.test.measured(candidates, 1)

    def fit(self, *candidates):
        return fit_part(self.data, self.fitted, self.data.gap, candidates)


class Splits(unittest.TestCase):
    def test_the_first_part_of_loading_is_fitted(self):
        case, bins = Case(0), bins_of(GRID)
        self.assertEqual(len(case.fitted) + len(case.held_out), 48)
        self.assertEqual(len(case.fitted), 6 * 3)  # three of four displacements are below 85 % of the stroke
        for bin in case.fitted:
            self.assertEqual(bins[bin].phase, Phase.load)
            self.assertLess(bins[bin].displacement, 0.85 * GRID.stroke)


class GapSizes(unittest.TestCase):
    def test_of_noise_it_is_zero_on_average(self):
        case, draws = Case(0), 2000
        noise = case.world.noise
        gaps = np.array([noise() - noise() for _ in range(draws)])
        # Thirty bins with a scatter of 2 sqrt 2: 0.4 over 2000 draws; variances from 32 replicates have an error of 0.25 per bin.
        self.assertAlmostEqual(gap_sizes(case.data, case.held_out, gaps, 1).mean(), 0, delta=5)
        gaps += [noise() for _ in gaps]
        self.assertAlmostEqual(gap_sizes(case.data, case.held_out, gaps, 1, 1).mean(), 0, delta=8)

    def test_of_a_gap_it_is_its_square_in_sigmas(self):
        case = Case(0)
        there = 3 * case.adhesion
        with_gap, without = (np.array([gap + case.world.noise() for _ in range(500)]) for gap in (there, 0))
        sizes = [gap_sizes(case.data, case.held_out, gaps, 0).mean() for gaps in (with_gap, without)]
        expected = (there[case.held_out]**2 / (case.data.noise[:, case.held_out]**2).mean(axis=0)).sum()
        self.assertAlmostEqual(sizes[0] - sizes[1], expected, delta=0.03 * expected)


class Reductions(unittest.TestCase):
    def test_a_planted_effect_closes_its_gap(self):
        case = Case(4)
        reduction = case.reduction(0)
        self.assertTrue(0.9 < reduction.fraction <= 1)
        self.assertAlmostEqual(reduction.fraction, min(1, 1 - reduction.after / reduction.before), 12)
        low, high = reduction.interval
        self.assertTrue(0.75 < low <= reduction.fraction <= high)
        self.assertEqual(case.test.reduction([0]), reduction.fraction)
        self.assertTrue(0 <= case.test.placebo(1) < 0.5)
        self.assertTrue(case.test.gap().shows())
        self.assertLess(case.reduction(1).fraction, 0.3)  # another effect does not close it

    def test_bins_that_an_effect_lacks_stay_as_they_are(self):
        case = Case(4)
        for lacking, low, high in ((case.data.bins[::2], 0.3, 0.7), (case.data.bins, 0, 0)):  # half of the bins, all with the same gap
            case.data.candidates[0] = replace(case.data.candidates[0], lacking=lacking)
            self.assertTrue(low <= case.reduction(0).fraction <= high)

    def test_without_a_gap_held_out_data_show_none(self):
        shown = sum(Case(0, seed).test.gap().shows() for seed in range(50, 90))
        self.assertLessEqual(shown, 8, "beyond two sigmas of a skewed distribution")

    def test_runs_that_agree_close_the_gap_whatever_the_signature_predicts(self):
        case = Case(4)

        def by_runs(runs, **more):
            return case.test.reduction_by_runs(case.evidence.observed, runs, **more)

        def runs_with(amplitude):
            runs = case.runs(amplitude * case.adhesion, 9)
            runs[3] = np.nan  # a failed run does not count
            return runs

        self.assertGreater(by_runs(runs_with(4)), 0.9)
        self.assertAlmostEqual(by_runs(runs_with(2)), 0.75, delta=0.15)
        self.assertAlmostEqual(by_runs(runs_with(0)), 0, delta=0.15)
        self.assertIsNone(by_runs(case.runs(np.nan)))
        some, lacking = runs_with(4), case.held_out[::2]
        some[:, lacking] = np.nan
        self.assertIsNone(by_runs(some))
        self.assertAlmostEqual(by_runs(some, lacking=lacking), 0.5, delta=0.15)

    def test_runs_correct_the_amplitude(self):
        case = Case(4)
        shape = case.adhesion.copy()
        case.adhesion *= 0.5  # of the effect's true size
        self.assertAlmostEqual(case.fit(0).amplitudes[0], 8, delta=2)
        left = case.data.gap - 3 * shape - 0.4 * case.modulus
        again = refit_part(case.data, case.fitted, left, [0], PartialFit([3], np.array([0.4])), 32)
        self.assertAlmostEqual(again.amplitudes[0], 3 + 2 * 1, delta=1.5)
        free = [case.data.free[0], FreeParameter(0.5 * shape, 20)]
        expected = case.data.space(case.fitted, free).fit_nuisances(case.data.gap - 3 * shape)[0]
        self.assertAlmostEqual(again.nuisances[0], expected, delta=1e-9)

    def test_nuisances_of_runs_stay_in_range(self):
        case = Case(4)
        farthest = 12 * case.data.free[0].sigma
        case.data.gap = case.data.gap + 1e6 * case.modulus
        first = case.fit(0)
        self.assertEqual(first.nuisances[0], farthest)
        again = refit_part(case.data, case.fitted, -case.data.gap, [0], first, 32)
        self.assertEqual(again.nuisances[0], -farthest)

    def test_two_effects_are_fitted_together(self):
        case = Case(4)
        case.data.gap = case.data.gap - 3 * case.friction
        both = case.reduction(0, 1)
        self.assertGreater(both.fraction, 0.9)
        self.assertTrue(both.interval[0] <= both.fraction <= both.interval[1])
        self.assertLess(case.reduction(0).fraction, 0.8)
        fit = case.fit(0, 1)
        np.testing.assert_allclose(fit.amplitudes, [4, -3], atol=1.2)  # 18 correlated bins with noise 1: 0.3 each
        self.assertEqual(len(fit.nuisances), 1)

    def test_of_noise_it_is_not_significant(self):
        covered = sum(Case(0, seed).reduction(0).interval[0] <= 0.1 for seed in range(50, 70))
        self.assertGreaterEqual(covered, 16)  # a 90 % interval of the fraction, whose true value is zero

    def test_it_is_zero_if_one_part_is_missing(self):
        case = Case(4)
        case.test = HeldOutTest(case.data, case.fitted, case.held_out[:0])
        reduction = case.reduction(0)
        self.assertEqual((reduction.fraction, reduction.before, case.test.reduction([0]), case.test.placebo(1)), (0, 0, 0, 0))

    def test_placebo_of_the_whole_gap(self):
        case = Case(4)
        score = fit_effects(case.space, case.data.candidates[:1], case.data.gap).score
        placebo = whole_placebo(case.space, case.data, score, 1)
        self.assertTrue(0 < placebo < 0.5)
        self.assertAlmostEqual(whole_placebo(case.space, case.data, 2 * score, 1), placebo / 2, 12)
        self.assertEqual(whole_placebo(case.space, case.data, 1e-9, 1), 1)


if __name__ == "__main__":
    unittest.main()
