"""Covariances, whitening and fitted nuisances, compared with explicit formulas. gap_space_test.py"""
import unittest

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
from synthetic_evidence import SyntheticWorld

from mcdem._engine import Random
from mcdem.diagnosis.gap_space import FreeParameter, GapSpace, lacking_bins, resolutions, shrunk_covariance, usable_bins, without
from mcdem.observe.observables import observables

ALL = 8 * len(observables())


def noise_rows(rows, known, seed):
    world = SyntheticWorld(known, seed)
    return np.array([world.noise(1 + r % 2 * 0.5) for r in range(rows)])


def by_double_loop(x):
    """Ledoit & Wolf 2004, as sums over rows and pairs of bins, for standardised columns."""
    n, p = x.shape
    sigma = np.sqrt((x**2).sum(axis=0) / n)
    z = x / sigma
    r = np.array([[z[:, i] @ z[:, j] / n for j in range(p)] for i in range(p)])
    sampling = sum(((z[:, i] * z[:, j] - r[i, j]) ** 2).sum() / n / n for i in range(p) for j in range(p))
    signal = sum(r[i, j] ** 2 for i in range(p) for j in range(p) if i != j)
    shrink = min(1, sampling / signal)
    return np.where(np.eye(p, dtype=bool), 1, (1 - shrink) * r) * np.outer(sigma, sigma)


class ShrunkCovariances(unittest.TestCase):
    def test_agree_with_ledoit_and_wolf(self):
        for rows in (6, 30):
            x = 1e-3 * noise_rows(rows, 2, 5)[:, :12]
            expected = by_double_loop(x)
            assert_allclose(shrunk_covariance(x), expected, rtol=0, atol=1e-13 * np.linalg.norm(expected))

    def test_are_hardly_shrunk_for_many_rows(self):
        x = noise_rows(5000, 1, 6)
        x = x[:, :8]
        sample, found = x.T @ x / 5000, shrunk_covariance(x)
        self.assertLess(np.linalg.norm(found - sample), 0.01 * np.linalg.norm(sample))
        self.assertAlmostEqual(found[3, 4] / found[3, 3], 0.5, delta=0.05)

    def test_are_positive_definite_for_few_rows(self):
        x = noise_rows(5, 10, 7)[:, :80]
        found = shrunk_covariance(x)
        self.assertGreater(np.linalg.eigvalsh(found).min(), 0.01)
        assert_allclose(found.diagonal(), (x**2).sum(axis=0) / 5)  # variances are not changed


class Bins(unittest.TestCase):
    def test_usable_ones_are_finite_in_all_rows_and_vary(self):
        world = SyntheticWorld(2, 8)
        baseline, observed = noise_rows(6, 2, 8), world.noise()
        effect, nuisance = (world.signature(name, world.pattern(1)) for name in ("adhesion", "modulus"))
        baseline[:, 2], baseline[3, 5] = 0.5, np.nan
        effect.curvature[7], nuisance.linear[9], observed[11] = np.nan, np.inf, np.nan
        assert_array_equal(usable_bins(baseline, [effect, nuisance], observed), [0, 1, 3, 4, 6, 8, 10, 12, 13, 14, 15])
        assert_array_equal(lacking_bins(effect), [7])
        assert_array_equal(without(np.array([1, 3, 4]), np.array([0, 3])), [1, 4])

    def test_resolutions_are_those_of_the_observables(self):
        first, second = (observable.resolution for observable in observables()[:2])
        assert_array_equal(resolutions(np.array([0, 7, 8, 15]), ALL), [first, first, second, second])


class GapSpaces(unittest.TestCase):
    """A space with two nuisances, an extra variance and a mean of four, and its matrices."""

    def setUp(self):
        world = SyntheticWorld(2, 9)
        self.bins, noise, extra = np.array([0, 2, 3, 5, 8, 9, 13]), noise_rows(20, 2, 10), np.linspace(0, 5, ALL)
        self.priors = np.array([1.5, 0.4])
        free = [FreeParameter(world.pattern(size), prior) for size, prior in zip((0.7, 2), self.priors)]
        self.covariance = 1.25 * shrunk_covariance(noise[:, self.bins])
        self.covariance += np.diag(resolutions(self.bins, ALL) ** 2 + extra[self.bins])
        self.directions = np.array([one.direction[self.bins] for one in free]).T
        self.total = self.covariance + self.directions @ np.diag(self.priors**2) @ self.directions.T
        self.gap = world.noise(2)
        self.chosen = self.gap[self.bins]
        self.space = GapSpace(noise, 4, self.bins, free, extra)

    def test_nuisances_are_marginalised(self):
        expected = self.chosen @ np.linalg.inv(self.total) @ self.chosen
        self.assertAlmostEqual((self.space.whiten(self.gap) ** 2).sum() / expected, 1, 9)

    def test_standard_deviations_are_shrunk_towards_their_observable(self):
        own = self.covariance.diagonal()
        mean = np.repeat([own[:4].mean(), own[4:].mean()], [4, 3])
        assert_allclose(self.space.sigma**2, (20 * own + 8 * mean) / 28)  # twenty replicates, and eight more for the mean

    def test_log_likelihood_is_the_normal_density(self):
        expected = -0.5 * (self.chosen @ np.linalg.inv(self.total) @ self.chosen + np.log(np.linalg.det(self.total)))
        self.assertAlmostEqual(self.space.log_likelihood(self.gap), expected, 9)

    def test_log_likelihood_with_a_constant_direction(self):
        bins, noise = np.arange(4), Random(5, "challenge").normals(50 * ALL).reshape(50, ALL)
        space = GapSpace(noise, 4, bins, [FreeParameter(np.full(ALL, 2.0), 1.5)], np.full(ALL, 0.3))
        covariance = 1.25 * shrunk_covariance(noise[:, :4]) + np.diag(resolutions(bins, ALL) ** 2 + 0.3) + (2 * 1.5) ** 2
        gap = np.linspace(0.5, 60, ALL)
        expected = -0.5 * (gap[:4] @ np.linalg.inv(covariance) @ gap[:4] + np.log(np.linalg.det(covariance)))
        self.assertAlmostEqual(space.log_likelihood(gap), expected, 9)

    def test_nuisances_are_fitted_as_by_ridge_regression(self):
        """|L^-1 (gap - S shift)|^2 + |shift / prior|^2 as one least-squares system."""
        factor = np.linalg.cholesky(self.covariance)
        system = np.vstack([np.linalg.solve(factor, self.directions), np.diag(1 / self.priors)])
        shifts = np.linalg.lstsq(system, np.append(np.linalg.solve(factor, self.chosen), [0, 0]), rcond=None)[0]
        assert_allclose(self.space.fit_nuisances(self.gap), shifts, rtol=0, atol=1e-10)
        assert_allclose(self.space.refitted(self.gap), self.chosen - self.directions @ shifts, rtol=0, atol=1e-9)
        assert_allclose(self.space.nuisance_errors(), np.sqrt(np.linalg.inv(system.T @ system).diagonal()), rtol=1e-9)

    def test_sigma_of_a_sum_is_that_without_nuisances(self):
        weights = np.arange(7) - 2.0
        self.assertAlmostEqual(self.space.sigma_of(weights) ** 2 / (weights @ self.covariance @ weights), 1, 12)

    def test_many_differences_at_once_are_as_one_by_one(self):
        gaps = np.array([self.gap, -3 * self.gap])
        for of in (self.space.whiten, self.space.log_likelihood, self.space.fit_nuisances, self.space.refitted):
            assert_allclose(of(gaps), [of(gap) for gap in gaps], rtol=1e-12)

    def test_the_part_without_lacking_bins_has_their_rows_and_columns_removed(self):
        part = self.space.lacking(np.array([0, 1, 9]))
        kept = np.array([1, 2, 3, 4, 6])
        assert_array_equal(part.bins, self.bins[kept])
        assert_array_equal(part.sigma, self.space.sigma[kept])
        expected = self.chosen[kept] @ np.linalg.inv(self.total[np.ix_(kept, kept)]) @ self.chosen[kept]
        self.assertAlmostEqual((part.whiten(self.gap) ** 2).sum() / expected, 1, 9)
        self.assertIs(self.space.lacking(np.array([0, 1, 9])), part)
        self.assertIs(self.space.lacking(np.array([1])), self.space)

    def test_no_bins_tell_nothing(self):
        for nothing in (self.space.lacking(self.bins), GapSpace(noise_rows(20, 2, 10), 4, self.bins[:0], [])):
            self.assertEqual(nothing.whiten(self.gap).shape, (0,))
            self.assertEqual(nothing.log_likelihood(self.gap), 0)
            assert_array_equal(nothing.fit_nuisances(self.gap), np.zeros(len(nothing.nuisance_errors())))
        assert_allclose(self.space.lacking(self.bins).nuisance_errors(), self.priors)

    def test_square_of_whitened_noise_is_the_number_of_bins(self):
        world, draws = SyntheticWorld(2, 11), 3000
        noise = np.array([world.noise() for _ in range(2000)])
        free = FreeParameter(world.pattern(1), 2)
        space = GapSpace(noise, 1, np.arange(16), [free])
        gaps = np.array([world.noise() - world.noise() for _ in range(draws)]) + np.outer(2 * world.random.normals(draws), free.direction)
        # Chi-square of 16: 3000 draws determine the mean to 0.10, 2000 rows of noise the covariance to 1 %.
        self.assertAlmostEqual((space.whiten(gaps) ** 2).sum() / draws, 16, delta=0.5)


if __name__ == "__main__":
    unittest.main()
