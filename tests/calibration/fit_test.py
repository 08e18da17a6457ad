"""The fit of several keys on responses with known minima. fit_test.py"""
import math
import unittest

import numpy as np

from mcdem.calibration.fit import End, Fit, Ranges, Target

TRUTH = np.array([1.3, 0.4])
PLACES = np.linspace(0.1, 1, 12)


def response(x):
    """(trials, values) a curve for each trial, of which one key is the size and the other the shape."""
    return x[:, [0]] * PLACES ** (1 + x[:, [1]])


def fitted(noise=0.0, seed=1, rounds=12, tolerance=1e-3, beyond=math.inf, low=(0.1, 0.0)):
    """`noise`: standard deviation; trials of which the first key is `beyond` stop early."""
    random, sigma = np.random.default_rng(seed), np.full(len(PLACES), 0.02)
    ranges = Ranges(np.array(low), np.array([5.0, 3.0]), np.array([0.85, 0.7]), np.array([1.15, 1.3]), np.full(2, tolerance))
    fit, count = Fit(Target(response(TRUTH[None])[0], sigma), ranges, 6), 0
    while fit.end is None and count < rounds:
        y = response(fit.values) + noise * random.standard_normal((len(fit.values), len(PLACES)))
        fit.add(fit.values, np.where(fit.values[:, [0]] > beyond, np.nan, y))
        count += 1
    return fit


class SeveralKeys(unittest.TestCase):
    def test_the_minimum_of_a_curved_response_is_found(self):
        fit = fitted()
        self.assertIs(fit.end, End.converged)
        np.testing.assert_allclose(fit.minimum.x, TRUTH, atol=5e-3)  # five times the tolerance: two rounds without progress end the fit
        slope = (response(TRUTH[None] + [[1e-6, 0]]) - response(TRUTH[None]))[0] / 1e-6
        np.testing.assert_allclose(fit.minimum.slope[:, 0], slope, atol=0.01)  # third order of the response in the window

    def test_the_standard_error_is_correct_under_noise(self):
        fits = [fitted(noise=0.01, seed=seed, tolerance=1e-9, rounds=4) for seed in range(100)]
        pulls = np.array([(fit.minimum.x - TRUTH) / fit.minimum.standard_error for fit in fits])
        # 1 but for the curvature that the polynomial leaves, with a standard deviation of 0.07 for 100 fits
        np.testing.assert_allclose(np.sqrt((pulls**2).mean(0)), 1.1, atol=0.35)

    def test_trials_that_stop_early_are_avoided(self):
        fit = fitted(beyond=1.32)
        np.testing.assert_allclose(fit.minimum.x, TRUTH, atol=0.01)
        edge = fitted(beyond=1.1)  # below the minimum
        self.assertTrue(1.08 < edge.minimum.x[0] <= 1.1, edge.minimum.x)
        self.assertIs(fitted(beyond=0.0).end, End.no_data)

    def test_a_minimum_at_a_limit_is_found(self):
        fit = fitted(low=(0.1, 0.6))
        self.assertAlmostEqual(fit.minimum.x[1], 0.6, delta=1e-12)
        # Least squares of the size alone, with the exponent 1.6.
        shape = PLACES**1.6
        self.assertAlmostEqual(fit.minimum.x[0], float(shape @ response(TRUTH[None])[0] / (shape @ shape)), delta=5e-3)

    def test_each_round_tries_the_centre_and_both_sides_of_every_key(self):
        np.testing.assert_allclose(Fit(Target(np.zeros(1), np.ones(1)), Ranges(*np.array([[0, 0], [9, 9], [1, 2], [3, 6], [1, 1]], float)), 6).values,
                                   [[2, 4], [3, 4], [2, 6], [1, 4], [2, 2]])


if __name__ == "__main__":
    unittest.main()
