"""Detection limits, compared with simulated experiments with that amplitude. detection_limits_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
from synthetic_evidence import SyntheticWorld

from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.detection_limits import detection_limits
from mcdem.diagnosis.evidence import gap_data
from mcdem.diagnosis.gap_tests import NullDistribution, statistics_of

REPLICATES = 32
LIMITS = Limits(false_alarm=0.05)
ADHESION, THE_SAME, FRICTION, NOTHING, LIKE_MODULUS, TOO_SMALL = range(6)


class DetectionLimits(unittest.TestCase):
    def setUp(self, seed=1):
        self.world = SyntheticWorld(4, seed)
        self.evidence = self.world.evidence(1, REPLICATES)
        modulus, first, second = (self.world.pattern(0.5) for _ in range(3))
        for name, linear, *bounds in (("adhesion", first), ("the_same", 0.5 * first), ("friction", second, 0, 10),
                                      ("nothing", np.zeros_like(first)), ("like_modulus", modulus), ("too_small", second, 0, 1e-3)):
            self.world.add_effect(self.evidence, name, linear, *bounds)
        self.world.add_nuisance(self.evidence, "modulus", modulus, 1000)  # a prior so wide that it has no effect
        self.data = gap_data(self.evidence)
        self.space = self.data.space()
        self.null = NullDistribution(self.data, 1)

    def limits(self):
        return detection_limits(self.space, self.data, self.null, self.evidence, LIMITS)

    def test_one_per_effect(self):
        self.assertEqual([limit.effect for limit in self.limits()], [candidate.name for candidate in self.evidence.candidates])

    def test_expected_gain_gives_a_power_of_four_fifths(self):
        limits = self.limits()
        wanted = 0.5 * (math.sqrt(2 * self.null.quantile("directed", 0.025)) + 0.8416) ** 2
        for k in (ADHESION, FRICTION):
            at_limit = self.data.candidates[k].signature.at(limits[k].minimum_amplitude)
            np.testing.assert_allclose(0.5 * (self.space.whiten(at_limit) ** 2).sum(), wanted, 2e-3)
        self.assertAlmostEqual(limits[THE_SAME].minimum_amplitude, 2 * limits[ADHESION].minimum_amplitude, delta=1e-6)

    def test_four_in_five_are_detected_at_the_limit(self):
        detected = []
        for seed in range(1, 5):
            self.setUp(seed)
            shift = self.limits()[FRICTION].minimum_amplitude * self.evidence.library.effects[FRICTION].linear
            gaps = np.array([math.sqrt(1 + 1 / REPLICATES) * self.world.noise() + shift for _ in range(100)])
            detected += [self.null.p_value("directed", value) < 0.025 for value in statistics_of(self.space, self.data, gaps)["directed"]]
        # 400 draws: 2 %; the covariances of 32 replicates and the best of several candidates add a few per cent.
        self.assertTrue(0.65 < np.mean(detected) < 0.95, np.mean(detected))

    def test_are_infinite_for_effects_that_cannot_be_detected(self):
        limits = self.limits()
        for k in (NOTHING, LIKE_MODULUS, TOO_SMALL):
            self.assertEqual(limits[k].minimum_amplitude, math.inf)
        self.assertEqual(limits[NOTHING].absorbed_by_calibration, 0)  # nothing to absorb

    def test_use_the_easier_sign(self):
        both = self.limits()[ADHESION].minimum_amplitude
        self.data.candidates[ADHESION] = replace(self.data.candidates[ADHESION], high=1e-3)
        self.assertAlmostEqual(self.limits()[ADHESION].minimum_amplitude, both, delta=1e-6)

    def test_list_effects_with_the_same_signature(self):
        limits = self.limits()
        self.assertIn("the_same", limits[ADHESION].group)
        self.assertIn("adhesion", limits[THE_SAME].group)
        self.assertFalse({"adhesion", "friction"} & set(limits[ADHESION].group))
        self.assertEqual(limits[FRICTION].group, ())

    def test_report_the_part_absorbed_by_calibration(self):
        self.assertAlmostEqual(self.limits()[LIKE_MODULUS].absorbed_by_calibration, 1, delta=1e-4)
        # Orthogonal to the modulus in the metric of the noise: nothing is absorbed.
        fixed = self.data.space(free=[])
        linear, modulus = self.evidence.library.effects[FRICTION].linear, self.evidence.library.nuisances[0].linear
        m = fixed.whiten(modulus)
        linear -= (fixed.whiten(linear) @ m) / (m @ m) * modulus
        self.assertAlmostEqual(self.limits()[FRICTION].absorbed_by_calibration, 0, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
