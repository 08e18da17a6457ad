"""Amplitudes and scores from synthetic gaps, compared with closed-form solutions. effect_fit_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
from synthetic_evidence import SyntheticWorld

from mcdem.diagnosis.effect_fit import Candidate, draw_error, fit_effect, fit_effects, lacking_bins
from mcdem.diagnosis.gap_space import FreeParameter, GapSpace


class Setting(unittest.TestCase):
    """Sixteen bins with the noise of forty replicates, and an uncertain parameter."""

    def setUp(self):
        self.world = SyntheticWorld(2, 1)
        noise = np.array([self.world.noise() for _ in range(40)])
        self.free = FreeParameter(self.world.pattern(1), 1.0)
        self.space = GapSpace(noise, 0, np.arange(16), [self.free])
        self.signature = self.world.signature("adhesion", self.world.pattern(0.5))
        self.linear = self.signature.linear

    def fit(self, gap, low, high):
        return fit_effect(self.space, Candidate(self.signature, low, high), gap)


class Fits(Setting):
    def test_a_linear_signature_agrees_with_the_closed_form(self):
        gap = 3 * self.linear + self.world.noise()
        l, g = self.space.whiten(self.linear), self.space.whiten(gap)
        fit = self.fit(gap, -8, 8)
        self.assertAlmostEqual(fit.amplitude, l @ g / (l @ l), delta=1e-4)  # 20 bits of the range
        self.assertAlmostEqual(fit.error, 1 / np.linalg.norm(l), 9)
        self.assertAlmostEqual(fit.score / (0.5 * (l @ g) ** 2 / (l @ l)), 1, 6)
        self.assertAlmostEqual(fit.amplitude, 3, delta=4 * fit.error)

    def test_the_error_is_the_scatter_of_the_amplitudes(self):
        pulls = []
        for shift in self.world.random.normals(400):
            fit = self.fit(2 * self.linear + self.world.noise() + shift * self.free.direction, -20, 20)
            pulls.append((fit.amplitude - 2) / fit.error)
        self.assertAlmostEqual(np.mean(np.square(pulls)), 1, delta=0.4)  # 400 draws: 0.07; the covariance from 40 rows: about 0.2

    def test_a_curved_signature_is_fitted(self):
        self.signature = replace(self.signature, curvature=self.world.pattern(0.4), reach=1.5)
        for amplitude in (-1.2, 0.4, 1.5, 3.7):  # the last one is beyond the reach
            self.assertAlmostEqual(self.fit(self.signature.at(amplitude), -2, 4).amplitude, amplitude, delta=1e-4)
        # With noise, the best of many amplitudes within the reach and beyond it.
        tried = np.linspace(-2, 4, 6001)
        for amplitude in (-1.2, 0.4, 3.0):
            gap = self.signature.at(amplitude) + self.world.noise(2)
            best = tried[(self.space.whiten(gap - self.signature.at(tried)) ** 2).sum(axis=1).argmin()]
            self.assertAlmostEqual(self.fit(gap, -2, 4).amplitude, best, delta=1e-3)
        # The error follows from the slope of the signature at the amplitude, not from its linear part.
        fit = self.fit(self.signature.at(0.4), -2, 4)
        self.assertAlmostEqual(fit.error, 1 / np.linalg.norm(self.space.whiten(self.signature.slope(fit.amplitude))), 9)

    def test_stays_within_its_bounds(self):
        for low, high, times, amplitude in ((0, 2, 5, 2), (0, 2, -5, 0), (-1, 2, -5, -1)):
            fit = self.fit(times * self.linear, low, high)
            self.assertAlmostEqual(fit.amplitude, amplitude, delta=2e-3)
            self.assertEqual(fit.amplitude == 0 and fit.score == 0, amplitude == 0)

    def test_an_effect_without_a_trace_has_an_infinite_error(self):
        self.signature = replace(self.signature, linear=np.zeros_like(self.linear))
        fit = self.fit(self.world.noise(), -1, 1)
        self.assertEqual((fit.amplitude, fit.error, fit.score), (0, math.inf, 0))

    def test_lacking_bins_are_left_out(self):
        known = np.arange(16) >= 5
        gap = self.world.noise()
        of = Candidate(self.signature, -8, 8, np.flatnonzero(~known))
        part = self.space.lacking(of.lacking)
        l, g = part.whiten(self.linear), part.whiten(gap)
        self.assertEqual(len(l), 11)
        fit = fit_effect(self.space, of, gap)
        self.assertAlmostEqual(fit.amplitude, l @ g / (l @ l), delta=1e-4)
        self.assertAlmostEqual(fit.error, 1 / np.linalg.norm(l), 9)
        assert_array_equal(lacking_bins([of, Candidate(self.signature, 0, 1), replace(of, lacking=np.array([2, 9]))]), [0, 1, 2, 3, 4, 9])
        self.assertEqual(len(lacking_bins([])), 0)


class JointFits(Setting):
    def test_two_signatures_agree_with_the_closed_form(self):
        """Least squares: amplitudes, errors and gain, even for a correlation of 0.98."""
        for apart in (3.0, 0.2):
            second = self.world.signature("friction", self.linear + self.world.pattern(0.5 * apart))
            gap = 3 * self.linear - 2 * second.linear + self.world.noise()
            columns = self.space.whiten(np.array([self.linear, second.linear])).T
            covariance = np.linalg.inv(columns.T @ columns)
            moment = columns.T @ self.space.whiten(gap)
            fit = fit_effects(self.space, [Candidate(self.signature, -60, 60), Candidate(second, -60, 60)], gap)
            assert_allclose(fit.errors, np.sqrt(covariance.diagonal()), rtol=1e-6)
            assert_allclose(fit.amplitudes, covariance @ moment, rtol=0, atol=0.05 * min(fit.errors))  # tolerance of the search
            assert_allclose(fit.score, 0.5 * moment @ covariance @ moment, rtol=2e-3)

    def test_two_identical_signatures_have_no_amplitudes(self):
        """Their sum is determined, they are not."""
        one = Candidate(self.signature, -8, 8)
        fit = fit_effects(self.space, [one, one], 3 * self.linear)
        self.assertAlmostEqual(sum(fit.amplitudes), 3, delta=1e-3)
        self.assertEqual(fit.errors, [math.inf, math.inf])

    def test_no_signatures_explain_nothing(self):
        fit = fit_effects(self.space, [], self.linear)
        self.assertEqual((fit.amplitudes, fit.errors, fit.score), ([], [], 0))


class DrawErrors(Setting):
    def test_are_the_scatter_between_pairs(self):
        """Pairs whose responses differ by a tenth, more than by chaos."""
        def error(reach, slopes, amplitude=3):
            signature = replace(self.signature, reach=reach, slopes=slopes)
            return draw_error(self.space, Candidate(signature, 0, 8), amplitude)

        slopes = np.outer([0.9, 1.1, 1.1, 0.9], self.linear)
        self.assertAlmostEqual(error(1e3, slopes, -3), 3 * math.sqrt(0.04 / 3 * (1 + 1 / 4)), delta=1e-4)  # chaos is negligible
        self.assertEqual(error(1e-3, slopes), 0)
        self.assertEqual(error(1e3, slopes[:1]), 0)
        self.assertEqual(error(1e-3, slopes[:0]), 0)


if __name__ == "__main__":
    unittest.main()
