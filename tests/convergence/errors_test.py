"""Known errors of numerics are found, and are distinguished from chaotic scatter. errors_test.py"""
import unittest

import numpy as np
from numpy.testing import assert_allclose

from mcdem.convergence.convergence_types import RELATIVE, Limits
from mcdem.convergence.errors import Baseline, cause_errors, errors_of, mean_and_error
from mcdem.observe.grid import Grid, bins_of
from mcdem.observe.observables import observables
from mcdem.observe.estimate import mean_over_replicas

BINS = bins_of(Grid([0.01], 0.002, 0.02))
REPLICAS = 64


class Made:
    """Replicas with a scatter of their own; each step adds a scatter of `chaos`.

    `left`: fraction of the error in a refined run, from the fraction that should remain.
    """

    def __init__(self, remaining, error, chaos, left=lambda part: part):
        random = np.random.default_rng(7)
        packing = random.normal(0, 0.1, (REPLICAS, len(BINS)))
        self.base = packing + error
        self.remaining = remaining
        self.refined = [packing + random.normal(0, chaos, packing.shape) + error * left(part) for part in remaining]

    def baseline(self):
        return Baseline(BINS, self.base, Limits())

    def errors(self):
        return errors_of(self.base, self.remaining, self.refined)

    def bins(self):
        return cause_errors("plate speed", self.baseline(), self.errors()).errors


class Errors(unittest.TestCase):
    def test_of_the_expected_order_are_found(self):
        errors = Made([0.5, 0.25, 0.125], 0.03, 0.01).errors()
        self.assertTrue(errors.follows_order.all())
        missed = np.abs(errors.value - 0.03) > 2 * errors.standard_error
        self.assertLess(missed.mean(), 0.15)  # two standard errors are exceeded by chance in 1 of 20 bins
        self.assertGreater(missed.sum(), 0, "standard errors are no larger than the scatter")

    def test_of_another_order_are_lower_limits(self):
        errors = Made([0.5, 0.25, 0.125], 0.1, 0.005, lambda part: 0.2 if part < 0.2 else 1.0).errors()
        self.assertFalse(errors.follows_order.any())
        self.assertTrue((np.abs(errors.value - 0.08) < 5 * errors.standard_error).all())

    def test_are_the_least_squares_of_the_steps(self):
        """Differences from the scene are the error times 1 - remaining."""
        made = Made([0.5, 0.25], 0.03, 0.01)
        differences = np.array([(made.base - observed)[:, 3] for observed in made.refined])
        fitted = np.linalg.lstsq(np.array([[0.5], [0.75]]), differences, rcond=None)[0][0]
        errors = made.errors()
        self.assertAlmostEqual(errors.value[3], fitted.mean(), 14)
        self.assertAlmostEqual(errors.standard_error[3], fitted.std(ddof=1) / 8, 14)

    def test_a_failed_replica_is_left_out_alone(self):
        made = Made([0.5, 0.25], 0.03, 0.001)
        made.refined[1][3] = np.nan
        errors = made.errors()
        self.assertTrue((np.abs(errors.value - 0.03) < 5 * errors.standard_error).all())

    def test_of_bins_without_values_are_left_out(self):
        made = Made([0.5], 0.03, 0.001)
        made.base[:, 1] = np.nan
        made.refined[0][1:, 2] = np.nan  # one replica has no standard error
        bins = made.bins()
        self.assertEqual(len(bins), len(BINS) - 1)
        self.assertEqual((bins[1].observable, bins[1].phase), (observables()[1].name, "load"))
        self.assertTrue(np.isnan(bins[1].standard_error) and not bins[1].beyond)


class Limited(unittest.TestCase):
    def test_only_large_and_significant_errors_are_beyond(self):
        for error, chaos, beyond in ((0.002, 1e-5, False), (0.2, 0.001, True), (0.2, 1.0, False)):
            bins = Made([0.5], error, chaos).bins()
            self.assertEqual({bin.beyond for bin in bins}, {beyond}, (error, chaos))

    def test_forces_relatively_and_all_else_in_standard_deviations(self):
        for bin in Made([0.5], 0.01, 0.01).bins():
            if bin.observable in RELATIVE:
                self.assertEqual(bin.limit, 0.005)
            else:
                self.assertAlmostEqual(bin.limit, 0.5 * 0.1, delta=0.02)  # the deviation of 64 replicas is known to 9 %

    def test_a_difference_below_the_resolution_is_allowed(self):
        """If copies hardly rearrange, their scatter is tiny."""
        made = Made([0.5], 1e-4, 0)
        made.base[:], made.refined[0][:] = 1 + 1e-4, 1 + 0.5e-4
        resolution = {one.name: one.resolution for one in observables()}
        for bin in made.bins():
            if not bin.is_relative:
                self.assertEqual((bin.limit, bin.beyond), (resolution[bin.observable], False))

    def test_replicas_hardly_differ_where_they_scatter_less_than_the_resolution(self):
        made = Made([0.5], 0.01, 0.01)
        self.assertFalse(made.baseline().hardly_differ())
        made.base[:, :len(BINS) // 2] = 1
        self.assertFalse(made.baseline().hardly_differ(), "half of the bins scatter")
        made.base[:, :len(BINS) // 2 + 1] = 1
        self.assertTrue(made.baseline().hardly_differ())
        made.base[:, 1:len(BINS) // 2 + 1] = np.nan
        self.assertFalse(made.baseline().hardly_differ(), "unknown bins do not count")


class Means(unittest.TestCase):
    def test_are_those_over_replicas(self):
        values = np.random.default_rng(1).normal(3, 1, (6, 4))
        values[1:4, 1], values[1:, 2], values[:, 3] = (np.nan, np.inf, -np.inf), np.nan, np.nan
        means = np.array(mean_and_error(values)).T
        for column, mean in zip(values.T, means):
            wanted = mean_over_replicas(column)
            assert_allclose(mean, (wanted.value, wanted.standard_error, wanted.count), rtol=1e-14)


if __name__ == "__main__":
    unittest.main()
