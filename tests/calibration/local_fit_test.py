"""Crossings of fits, compared with hand calculations. local_fit_test.py"""
import math
import unittest

import numpy as np
from numpy.testing import assert_array_equal

from mcdem.calibration.local_fit import crossing_of_fit, rising_fit

EXACT = 1e-12  # rounding of a fit of six points of order one


class RisingFit(unittest.TestCase):
    def test_pools_decreasing_values(self):
        for values, fit in (([1, 3, 2, 5], [1, 2.5, 2.5, 5]), ([3, 2, 1], [2, 2, 2]), ([1, 2], [1, 2]), ([2, 2, 5, 1], [2, 2, 3, 3]),
                            ([], [])):
            assert_array_equal(rising_fit(np.array(values, float)), fit)


class CrossingOfFit(unittest.TestCase):
    def crossing(self, x, y, low, high, target):
        return crossing_of_fit(np.array(x, float), np.array(y, float), low, high, target)

    def test_a_line_agrees_with_a_hand_calculation(self):
        crossing = self.crossing([0, 1, 2, 3], [0, 2, 4, 6], 0, 3, 3)
        self.assertAlmostEqual(crossing.x, 1.5, delta=EXACT)
        self.assertAlmostEqual(crossing.standard_error, 0, delta=EXACT)

    def test_error_at_the_middle_of_a_line_is_known(self):
        # Residuals +-1 about y = 2 x: scatter^2 = 4 / 2, variance at the middle scatter^2 / 4, slope 2.
        crossing = self.crossing([-3, -1, 1, 3], [-5, -3, 1, 7], -3, 3, 0)
        self.assertAlmostEqual(crossing.x, 0, delta=EXACT)
        self.assertAlmostEqual(crossing.standard_error, math.sqrt(2 / 4) / 2, delta=EXACT)
        self.assertAlmostEqual(crossing.slope, 2, delta=EXACT)

    def test_is_exact_for_a_parabola(self):
        x = np.arange(6) / 2
        crossing = self.crossing(x, x**2, 0, 2.5, 3)
        self.assertAlmostEqual(crossing.x, math.sqrt(3), delta=EXACT)
        self.assertAlmostEqual(crossing.slope, 2 * math.sqrt(3), delta=EXACT)

    def test_the_error_of_a_parabola_is_that_of_its_covariance(self):
        x, y = np.linspace(0, 1, 8), np.array([0.02, 0.1, 0.4, 0.41, 0.7, 0.79, 1.1, 1.4])
        crossing = self.crossing(x, y, 0, 1, 0.6)
        coefficients, covariance = np.polyfit(x, y, 2, cov=True)
        at = np.array([crossing.x**2, crossing.x, 1])
        self.assertAlmostEqual(at @ coefficients, 0.6, delta=EXACT)
        slope = 2 * coefficients[0] * crossing.x + coefficients[1]
        self.assertAlmostEqual(crossing.slope, slope, delta=1e-9)  # the normal equations lose digits
        self.assertAlmostEqual(crossing.standard_error, math.sqrt(at @ covariance @ at) / slope, delta=1e-9)

    def test_points_outside_of_the_window_are_ignored(self):
        crossing = self.crossing([0, 1, 2, 3, 9], [0, 2, 4, 6, -50], 0, 3, 3)
        self.assertAlmostEqual(crossing.x, 1.5, delta=EXACT)

    def test_is_nan_without_a_crossing(self):
        for case, arguments in {"out of the window": ([0, 1, 2], [0, 1, 2], 0, 2, 5), "decreasing": ([0, 1, 2], [2, 1, 0], 0, 2, 1),
                                "decreasing, at the middle": ([0, 2], [2, 0], 0, 2, 1), "flat": ([0, 1, 2], [1, 1, 1], 0, 2, 1),
                                "no points": ([0, 1], [0, 1], 5, 6, 1)}.items():
            with self.subTest(case):
                self.assertTrue(math.isnan(self.crossing(*arguments).x))
        self.assertAlmostEqual(self.crossing([0, 1], [0, 1], 0, 1, 0.5).x, 0.5, delta=EXACT)
        self.assertTrue(math.isnan(self.crossing([0, 1], [0, 1], 0, 1, 0.5).standard_error))


if __name__ == "__main__":
    unittest.main()
