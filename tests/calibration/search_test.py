"""The search on responses with a known root; crossings of its fits compared with hand calculations. search_test.py"""
import math
import unittest

import numpy as np
from numpy.testing import assert_array_equal

from mcdem.calibration.search import SearchOptions, find_value
from mcdem.errors import InputError, RunError

EXACT = 1e-12  # rounding of a fit of six points of order one


def force(gamma):
    """Starts from Hertz at gamma = 0 and increases with increasing slope, like the real response."""
    return 6.7 * np.exp(0.5 * gamma + 0.2 * gamma**2)


class Simulator:
    """`noise`: relative standard deviation; `limit`: gammas from here on run away."""

    def __init__(self, noise=0.0, limit=math.inf, seed=1):
        self.noise, self.limit, self.random, self.calls = noise, limit, np.random.default_rng(seed), 0

    def __call__(self, gammas):
        self.calls += 1
        return np.where(gammas >= self.limit, np.nan, force(gammas) * (1 + self.noise * self.random.standard_normal(len(gammas))))


class Search(unittest.TestCase):
    def found(self, simulator, root, low, high, **options):
        return find_value(simulator, force(root), SearchOptions(low, high, **options))

    def test_finds_the_root_of_a_smooth_response(self):
        simulator = Simulator()
        found = self.found(simulator, 1.125, 0.5, 1.6, tolerance=1e-4)
        self.assertTrue(found.converged)
        self.assertAlmostEqual(found.value, 1.125, delta=2e-4)  # twice the tolerance
        self.assertLessEqual(found.standard_error, 1e-4)
        self.assertAlmostEqual(found.slope / (force(1.125) * (0.5 + 0.4 * 1.125)), 1, delta=0.01)  # a parabola in a window of 0.1
        self.assertEqual(len(found.rounds), simulator.calls)
        self.assertLessEqual(len(found.rounds), 6)
        assert_array_equal(found.rounds[0].values, 0.5 + 1.1 * np.arange(6) / 5)
        self.assertEqual((found.rounds[-1].root, found.rounds[-1].standard_error), (found.value, found.standard_error))
        self.assertTrue(math.isnan(found.runs_away_at))

    def test_the_standard_error_is_correct_under_noise(self):
        pulls = []
        for seed in range(1, 201):
            found = self.found(Simulator(0.01, seed=seed), 1.125, 0.5, 1.6, tolerance=0.004, batch=8, rounds=12)
            self.assertTrue(found.converged, seed)
            pulls.append((found.value - 1.125) / found.standard_error)
        # A search stops where its scatter looks small: 1.41 over many searches, with a standard deviation of 0.08 for 200 of them.
        self.assertAlmostEqual(np.sqrt(np.mean(np.square(pulls))), 1.4, delta=0.3)

    def test_a_runaway_above_the_root_is_harmless(self):
        found = self.found(Simulator(0.003, limit=1.2), 1.125, 0.4, 3.0, rounds=12)
        self.assertTrue(found.converged)
        self.assertAlmostEqual(found.value, 1.125, delta=4 * found.standard_error + 1e-3)
        self.assertGreaterEqual(found.runs_away_at, 1.2)

    def test_continues_below_a_runaway_without_repeating_simulations(self):
        found = self.found(Simulator(limit=1.2), 1.125, 1.0, 5.0)
        self.assertAlmostEqual(found.value, 1.125, delta=1e-3)
        self.assertTrue(math.isnan(found.rounds[0].root))
        self.assertTrue((found.rounds[1].values > 1.0).all())
        self.assertTrue((found.rounds[1].values < 1.8).all(), "the lowest of the first round that ran away")

    def test_results_above_a_runaway_are_ignored(self):
        def top_forces(gammas):
            return np.where(gammas > 1.3, np.where(gammas < 1.45, np.nan, 1.0), force(gammas))

        self.assertAlmostEqual(self.found(top_forces, 1.1, 0.5, 1.6, batch=12).value, 1.1, delta=1e-3)

    def test_every_round_stays_below_the_runaways_before_it(self):
        found = self.found(Simulator(0.01, limit=1.13), 1.125, 0.4, 1.6, tolerance=1e-4, rounds=12)
        lowest = math.inf
        for one in found.rounds:
            self.assertLess(one.values.max(), lowest)
            lowest = np.min(one.values[np.isnan(one.top_force)], initial=lowest)
        self.assertEqual(lowest, found.runs_away_at)
        self.assertEqual(len(found.rounds), 12)

    def test_exhausted_rounds_are_not_converged(self):
        found = self.found(Simulator(0.05), 1.1, 0.4, 1.6, tolerance=1e-5, rounds=3)
        self.assertFalse(found.converged)
        self.assertEqual(len(found.rounds), 3)
        self.assertAlmostEqual(found.value, 1.1, delta=0.1)


class Problems(unittest.TestCase):
    def message(self, error, *arguments):
        with self.assertRaises(error) as raised:
            find_value(*arguments)
        return str(raised.exception)

    def test_a_target_out_of_reach_is_reported(self):
        for limit, root, says in ((0.9, 1.1, "no gamma gives Rtop = 1"), (0.1, 1.1, "runs away already at gamma = 0.4"),
                                  (math.inf, 0.2, "starts lower, or check the modulus"), (math.inf, 2.0, "ends higher than 1.6")):
            with self.subTest(says):
                self.assertIn(says, self.message(RunError, Simulator(limit=limit), force(root), SearchOptions(0.4, 1.6)))
        self.assertIn("comes only to", self.message(RunError, Simulator(), force(2.0), SearchOptions(0.4, 1.6, rounds=1)))

    def test_all_input_problems_are_reported_at_once(self):
        told = self.message(InputError, lambda gammas: gammas, -1, SearchOptions(1.5, 0.5, 0, 1, 0))
        self.assertEqual(told.splitlines(), ["calibration: target top force must be > 0 [N], got -1",
                                             "calibration: high end of the bracket must be above its low end, got 0.5",
                                             "calibration: tolerance must be > 0, got 0",
                                             "calibration: batch must be at least 3 values per round, got 1",
                                             "calibration: rounds must be at least 1, got 0"])
        for bracket in (SearchOptions(-0.1, 1), SearchOptions(math.nan, 1)):
            self.assertIn("low end", self.message(InputError, lambda gammas: gammas, 1, bracket))

    def test_a_wrong_result_of_the_simulator_is_reported(self):
        self.assertIn("asked for 6 top forces, got 1", self.message(RunError, lambda _: np.ones(1), 10, SearchOptions()))


if __name__ == "__main__":
    unittest.main()
