"""False alarms and power of the two tests, with random synthetic experiments. gap_tests_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
from synthetic_evidence import SyntheticWorld, evidence_of

from mcdem.diagnosis.evidence import OWN_PACKING, CandidateRange, gap_data
from mcdem.diagnosis.gap_tests import NullDistribution, gap_statistics, highest_pattern, statistics_of


def with_effects(world, evidence, planted=0.0):
    """Two effects, of which the first is planted, and a modulus that is off."""
    world.add_effect(evidence, "adhesion", world.pattern(0.5))
    world.add_effect(evidence, "friction", world.pattern(0.5))
    world.add_nuisance(evidence, "modulus", world.pattern(1), 2)
    evidence.observed += planted * evidence.library.effects[0].linear + 2 * world.normal() * evidence.library.nuisances[0].linear
    return evidence


def p_values(evidence):
    """Of the omnibus and of the directed test."""
    data = gap_data(evidence)
    null, s = NullDistribution(data, 1), gap_statistics(data.space(), data, data.gap)
    return null.p_value("omnibus", s.omnibus), null.p_value("directed", s.directed)


def p_of_experiments(packings, replicates, planted, known=4, seeds=range(100, 200)):
    """(experiments, 2); every experiment has evidence and a library of its own."""
    worlds = [SyntheticWorld(known, seed) for seed in seeds]
    return np.array([p_values(with_effects(world, world.evidence(packings, replicates), planted)) for world in worlds])


def other_packings(world, spread, own, planted=0.0):
    """An experiment with eight replicates of its packing, and a library of twelve other packings with four replicates each. The scatter of a
    packing is one times a log-normal factor; `spread` is the standard deviation of its logarithm. `own`: factor of the experiment's packing,
    or 0 to draw it like the others."""
    def factor():
        return math.exp(spread * world.normal())

    rows = []
    for _ in range(12):
        centre, scale = world.noise(3), factor()
        rows += [centre + world.noise(scale) for _ in range(4)]
    centre, scale = world.noise(3), own or factor()
    baseline = np.array([centre + world.noise(scale) for _ in range(8)])
    evidence = evidence_of(centre + world.noise(scale), baseline, np.array(rows), [row // 4 for row in range(48)])
    evidence.library_is_own = False
    return with_effects(world, evidence, planted)


def claimed(p, spread, own, planted=0.0):
    """Fraction of 100 such experiments with a gap at these p (smaller p of the two tests, doubled)."""
    worlds = [SyntheticWorld(20, seed) for seed in range(900, 1000)]
    smaller = np.array([2 * min(p_values(other_packings(world, spread, own, planted))) for world in worlds])
    return [float((smaller < one).mean()) for one in p]


class FalseAlarms(unittest.TestCase):
    def test_one_in_twenty(self):
        # Two replicates of a packing are mirror images of each other about their mean: the null distribution must leave out both together.
        # Of 100 experiments 5 % +- 2.2 % give a false alarm; the null distribution from 32 replicates adds about as much again.
        for packings, replicates in ((1, 32), (16, 2)):
            shares = (p_of_experiments(packings, replicates, 0) < 0.05).mean(axis=0)
            self.assertTrue(np.all((shares >= 0.005) & (shares <= 0.12)), (packings, shares))

    def test_p_is_uniform_with_the_fewest_replicates(self):
        # The number of bins of a complete experiment.
        p = p_of_experiments(1, 8, 0, known=20, seeds=range(700, 950))
        for level in (0.01, 0.05, 0.2, 0.5):
            error = math.sqrt(level * (1 - level) / len(p))
            np.testing.assert_allclose((p < level).mean(axis=0), level, atol=3.5 * error)

    def test_packings_that_scatter_differently(self):
        one, five = claimed((0.01, 0.05), 0.3, 0)  # three standard errors above the nominal levels
        self.assertLessEqual(one, 0.04)
        self.assertLessEqual(five, 0.115)

    def test_a_packing_that_scatters_more_than_the_library(self):
        self.assertLessEqual(claimed([0.01], 0.3, 1.8)[0], 0.04)


class Power(unittest.TestCase):
    def test_of_a_packing_that_scatters_less_than_the_library(self):
        self.assertGreaterEqual(claimed([0.01], 0.3, 0.6, 1.2)[0], 0.9)

    def test_for_a_planted_effect(self):
        # 2.5 times a signature of 0.5 in each of 32 bins with noise 1: about 6 sigma without correlations.
        omnibus, directed = (p_of_experiments(1, 32, 2.5) < 0.05).mean(axis=0)
        self.assertGreater(directed, 0.9)
        self.assertGreater(omnibus, 0.3)


class Statistics(unittest.TestCase):
    def test_of_one_gap(self):
        world = SyntheticWorld(3, 1)
        evidence = with_effects(world, world.evidence(1, 30))
        data = gap_data(evidence)
        space, friction, modulus = data.space(), evidence.library.effects[1].linear, evidence.library.nuisances[0].linear
        gap = data.gap + 4 * friction + 3 * modulus
        s = gap_statistics(space, data, gap)
        self.assertEqual([data.name(k) for k in range(len(s.fits))], ["adhesion", "friction", "modulus"])  # the modulus beyond its prior
        self.assertEqual((s.best, data.effects, s.directed), (1, 2, s.fits[1].score))
        np.testing.assert_allclose(s.omnibus, (space.whiten(gap) ** 2).sum(), 1e-9)
        left = gap - s.fits[1].amplitude * friction
        np.testing.assert_allclose(s.remainder, (space.whiten(left) ** 2).sum(), 1e-6)
        np.testing.assert_allclose(s.pattern_left, highest_pattern(space, left), 1e-12)
        shift = float(space.fit_nuisances(data.gap + 3 * modulus)[0] - space.fit_nuisances(data.gap)[0])
        self.assertAlmostEqual(shift, 3, delta=0.2)
        refitted = gap - space.fit_nuisances(gap)[0] * modulus
        np.testing.assert_allclose(s.highest_refitted, np.abs(refitted[data.bins] / space.sigma).max(), 1e-12)

    def test_of_many_gaps_are_those_of_each(self):
        world = SyntheticWorld(3, 1)
        evidence = with_effects(world, world.evidence(1, 24), 3)
        evidence.library.effects[0].curvature[:] = 0.3 * world.pattern(1)
        evidence.library.effects[0].reach = 0.5
        evidence.library.effects[1].linear[8:12] = np.nan
        data = gap_data(evidence)
        null, space = NullDistribution(data, 1), data.space()
        of_draws = null.draws()[0]
        self.assertEqual({len(values) for values in of_draws.values()}, {3 * 24})
        gaps = np.array([scale * data.gap for scale in (0.1, 1, 3)])
        for gap, values in zip(gaps, zip(*statistics_of(space, data, gaps).values())):
            s = gap_statistics(space, data, gap)
            np.testing.assert_allclose(values, [s.omnibus, s.directed, s.remainder, s.highest_refitted, s.pattern_left], 1e-6)


def correlated_size(weights):
    """Sigma of a weighted sum of the noise of SyntheticWorld."""
    places = np.arange(len(weights))
    return math.sqrt(weights @ 0.5 ** np.abs(places[:, None] - places) @ weights)


class Patterns(unittest.TestCase):
    def test_of_one_observable_are_detected(self):
        world = SyntheticWorld(3, 5)
        data = gap_data(world.evidence(1, 2000, 0))
        space = data.space(free=[], mean_of=0)
        # In the plate's order: the first four while it moves down; the last four, listed by displacement, while it moves up.
        trend = np.array([-3.5, -2.5, -1.5, -0.5, 3.5, 2.5, 1.5, 0.5])
        even, one = np.ones(8), 7.0 * (np.arange(8) == 2)
        # 2000 replicates determine variances to 3 %; the smallest correlations are removed by shrinkage.
        for values, size in ((trend, trend @ trend / correlated_size(trend)), (even, 8 / correlated_size(even)), (one, 7)):
            gap = np.zeros_like(data.mean)
            gap[8:16] = values
            np.testing.assert_allclose(highest_pattern(space, gap), size, 0.06)

    def test_misfit_detects_a_pattern_that_the_sum_does_not_show(self):
        even, thin = 0, 0
        for seed in range(300, 400):
            data = gap_data(SyntheticWorld(20, seed).evidence(1, 32))
            space, null = data.space(free=[]), NullDistribution(data, 1)
            even += null.misfit_p(space, data.gap) < 0.05
            left = data.gap.copy()
            left[8:16] += 3  # one of twenty observables: chi-square 160 +- 18, plus 24
            thin += null.misfit_p(space, left) < 0.05
        self.assertLessEqual(even, 14)  # 5 +- 2.2 of them, and the null's own error
        self.assertGreaterEqual(thin, 70)


class Null(unittest.TestCase):
    def test_quantile_is_the_inverse_of_p(self):
        world = SyntheticWorld(3, 2)
        data = gap_data(with_effects(world, world.evidence(1, 24)))
        null = NullDistribution(data, 1)
        self.assertEqual(list(null.draws()), [0])
        for p in (0.5, 0.05, 0.001):
            np.testing.assert_allclose(null.p_value("highest_refitted", null.quantile("highest_refitted", p)), p, 1e-7)
        self.assertEqual(null.p_value("directed", 0), 1)
        # Equal numbers of draws above and below the median: 72 draws, 4 sigma.
        above = (null.draws()[0]["omnibus"] > null.quantile("omnibus", 0.5)).sum()
        self.assertAlmostEqual(above, 36, delta=17)

    def test_depends_only_on_its_seed(self):
        world = SyntheticWorld(2, 3)
        data = gap_data(with_effects(world, world.evidence(1, 16)))
        one, same, other = (NullDistribution(data, seed).p_value("highest_refitted", 3) for seed in (1, 1, 2))
        self.assertEqual(one, same)
        self.assertNotEqual(one, other)


class GapData(unittest.TestCase):
    def test_folds_do_not_split_packings(self):
        world = SyntheticWorld(1, 4)
        self.assertEqual(gap_data(world.evidence(9, 3)).fold.tolist(), [r // 3 % 8 for r in range(27)])
        self.assertEqual(gap_data(world.evidence(1, 12)).fold.tolist(), [r % 8 for r in range(12)])

    def test_own_replicates_join_the_noise_of_a_library_of_other_packings(self):
        evidence = other_packings(SyntheticWorld(20, 5), 0.3, 0)
        data, own = gap_data(evidence), evidence.baseline
        self.assertEqual(len(data.noise), 48 + 8)
        self.assertEqual(data.group[48:].tolist(), 8 * [OWN_PACKING])
        self.assertEqual(data.fold[48:].tolist(), list(range(8, 16)))
        np.testing.assert_allclose(data.noise[48:, 3], (own[:, 3] - own[:, 3].mean()) * math.sqrt(8 / 7), atol=1e-12)
        self.assertEqual(list(NullDistribution(data, 1).draws()), [OWN_PACKING, *range(12)])
        few = [packing % 7 for packing in evidence.library.packing]  # the experiment's own packing may be among them
        for changed in (replace(evidence, library_is_own=True), replace(evidence, library=replace(evidence.library, packing=few)),
                        replace(evidence, baseline=own[:3])):  # too few to be used
            self.assertEqual(len(gap_data(changed).noise), 48)

    def test_gap_is_observed_minus_the_baselines_mean(self):
        evidence = SyntheticWorld(1, 5).evidence(2, 3)
        evidence.baseline[1, 4] = np.nan
        data = gap_data(evidence)
        self.assertAlmostEqual(data.gap[0], evidence.observed[0] - evidence.baseline[:, 0].mean(), 12)
        self.assertAlmostEqual(data.gap[4], evidence.observed[4] - 0.5 * (evidence.baseline[0, 4] + evidence.baseline[2, 4]), 12)
        self.assertEqual(data.bins.tolist(), list(range(8)))

    def test_every_name_requires_a_signature(self):
        evidence = SyntheticWorld(1, 6).evidence(1, 8)
        evidence.candidates.append(CandidateRange("adhesion", "", 0, 1))
        with self.assertRaises(LookupError):
            gap_data(evidence)


if __name__ == "__main__":
    unittest.main()
