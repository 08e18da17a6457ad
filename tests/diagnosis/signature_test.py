"""Signatures from paired runs: parabolas are found, noise is shrunk to zero. signature_test.py"""
import unittest

import numpy as np
from numpy.testing import assert_allclose

from mcdem._engine import Random
from mcdem.diagnosis.signature import Signature, continued_from, learn_signature

LINEAR, CURVATURE = np.array([1, -0.5, 2]), np.array([0.3, 0.4, -0.7])
NAN = np.nan


def parabola(a):
    return a * LINEAR + a * a * CURVATURE


def pairs_of(a, pairs=4):
    """Identical rows without noise."""
    return np.tile(parabola(a), (pairs, 1))


def noise(pairs, bins, seed):
    return Random(seed, "challenge").normals(pairs * bins).reshape(pairs, bins)


class Signatures(unittest.TestCase):
    def test_parabola_through_exact_data_is_exact(self):
        for first, second in ((0.5, 1.0), (-0.7, 2.5), (-0.2, 0.2)):
            s = learn_signature("adhesion", first, second, pairs_of(first), pairs_of(second))
            self.assertEqual((s.name, s.reach, s.pairs()), ("adhesion", second, 4))
            a = 0.6 * second
            for found, expected in ((s.linear, LINEAR), (s.curvature, CURVATURE), (s.spread(), 0), (s.at(a), parabola(a)),
                                    (s.slope(a), LINEAR + 2 * a * CURVATURE)):
                assert_allclose(found, np.broadcast_to(expected, 3), rtol=0, atol=1e-11)

    def test_is_linear_beyond_its_reach(self):
        s = Signature("", 2, LINEAR, CURVATURE)
        for side in (-1, 1):
            end, slope = parabola(side * 2), LINEAR + side * 4 * CURVATURE
            assert_allclose(s.at(side * 2), end, rtol=1e-13, atol=1e-14)
            assert_allclose(s.at(side * 3.5), end + side * 1.5 * slope, rtol=1e-13, atol=1e-14)
            assert_allclose(s.slope(side * 3.5), slope, rtol=1e-13)
        assert_allclose(s.spread(), 0)

    def test_noise_is_shrunk_to_zero(self):
        bins, pairs = 2000, 8
        s = learn_signature("", -1, 1, noise(pairs, bins, 1), noise(pairs, bins, 2))
        # 68 % of normal means are below one of their known error; with the error from 8 pairs, 65 %.
        self.assertAlmostEqual(np.mean(s.curvature == 0), 0.65, delta=0.05)
        self.assertGreater(np.mean(s.linear == 0), 0.4)
        self.assertLess(np.mean(s.at(1) ** 2), 0.7 / pairs)  # mean of the runs with the second amplitude: 1/pairs

    def test_clear_effects_are_kept(self):
        s = learn_signature("", 0.5, 1, 0.5 + 0.1 * noise(8, 500, 1), 1 + 0.1 * noise(8, 500, 2))
        # The mean of 8 pairs has an error of 0.035. The error of the slope is slightly larger, and larger again if a curvature is accepted.
        self.assertAlmostEqual(s.at(1).mean(), 1, delta=0.01)
        self.assertLess(np.sqrt(np.mean((s.at(1) - 1) ** 2)), 0.06)

    def test_spread_is_that_of_pairs_over_the_amplitude(self):
        s = learn_signature("", 1, 2, np.array([[1.0], [1], [1]]), np.array([[2.0], [3], [7]]))
        self.assertAlmostEqual(s.spread()[0], 7 / 4, 12)  # variance 7

    def test_continues_from_a_partially_refined_model(self):
        """Half of the error is already removed; a further part b of the rest gives 1/2 + b/2 in total."""
        s = learn_signature("plate_speed", 0.5, 0.75, pairs_of(0.5), pairs_of(0.75))
        for done in (0.5, 0.75, 0.875):
            for part in (0.0, 0.3, 0.5, 1.0):
                expected = s.at(done + part * (1 - done)) - s.at(done)
                assert_allclose(continued_from(s, done).at(part), expected, rtol=0, atol=1e-11, err_msg=f"{done} {part}")
        assert_allclose(continued_from(s, 0.75).slopes, 0.25 * s.slopes)


class MissingValues(unittest.TestCase):
    def test_failed_runs_are_excluded(self):
        """If the larger amplitude runs away, the smaller one is used."""
        first, second = pairs_of(0.5), pairs_of(1)
        second[2] = NAN
        three = learn_signature("adhesion", 0.5, 1, first, second)
        self.assertEqual(three.pairs(), 3)
        assert_allclose(three.linear, LINEAR, atol=1e-12)
        second[:3] = NAN
        straight = learn_signature("adhesion", 0.5, 1, first, second)
        self.assertEqual(straight.reach, 0.5)
        assert_allclose(straight.curvature, 0)
        assert_allclose(straight.at(0.5), parabola(0.5), atol=1e-12)
        other = learn_signature("adhesion", 0.5, 1, second, pairs_of(1))
        self.assertEqual(other.reach, 1)
        assert_allclose(other.at(1), parabola(1), atol=1e-12)
        first[:3] = NAN
        self.assertFalse(np.isfinite(learn_signature("adhesion", 0.5, 1, first, second).linear).any())

    def test_a_bin_without_a_value_at_one_amplitude_is_a_straight_line_through_the_other(self):
        """A force whose logarithm is observed may vanish with the larger amplitude, in some bins and pairs only."""
        first, second = pairs_of(0.5), pairs_of(1)
        second[2, 1] = first[0, 2] = NAN
        s = learn_signature("adhesion", 0.5, 1, first, second)
        self.assertEqual(s.pairs(), 4)
        assert_allclose(s.linear, LINEAR + np.array([0, 0.5, 1]) * CURVATURE, atol=1e-12)
        assert_allclose(s.curvature, [CURVATURE[0], 0, 0], atol=1e-11)
        assert_allclose(s.spread(), 0, atol=1e-20)
        second[1, 2] = NAN
        none = learn_signature("adhesion", 0.5, 1, first, second)
        self.assertTrue(np.isnan(none.linear[2]))
        self.assertAlmostEqual(none.linear[1], s.linear[1], 12)


if __name__ == "__main__":
    unittest.main()
