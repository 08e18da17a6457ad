"""Several packings of one experiment: common effects and differences. packings_test.py"""
import math
import unittest

import numpy as np
from synthetic_evidence import SyntheticWorld

from mcdem.diagnosis.builder import DiagnosisBuilder
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.diagnosis.evidence import PackingEvidence, mean_over_packings, take_means

REPLICATES = 16


def two_packings(first, second, seed, size=0.4):
    """Two packings with the scatter of packings. "adhesion" acts on every bin of both, with the given amplitudes."""
    world = SyntheticWorld(6, seed)
    evidence = world.evidence(2, REPLICATES)
    world.add_effect(evidence, "adhesion", world.pattern(size))
    world.add_effect(evidence, "friction", world.pattern(0.4))
    world.add_nuisance(evidence, "strain_offset", world.pattern(0.5), 1)
    for p, (name, amplitude) in enumerate((("A", first), ("B", second))):
        runs = evidence.library.baseline[p * REPLICATES:(p + 1) * REPLICATES]
        observed = runs.mean(axis=0) + world.noise() + amplitude * evidence.library.effects[0].linear
        evidence.packings.append(PackingEvidence(name, observed, runs))
    take_means(evidence)
    return evidence


def diagnosis_of(evidence):
    return DiagnosisBuilder(evidence, Limits()).diagnosis()


class Packings(unittest.TestCase):
    def test_a_common_effect_has_one_amplitude(self):
        found = diagnosis_of(two_packings(3, 3, 5))
        self.assertEqual(found.verdict, Verdict.effect)
        cause = found.causes[0]
        self.assertEqual(cause.effect, "adhesion")
        self.assertAlmostEqual(cause.amplitude, 3, delta=3 * cause.amplitude_error)
        self.assertEqual([packing.experiment for packing in found.packings], ["A", "B"])
        for packing in found.packings:
            self.assertLess(packing.gap_p, 0.01)
            self.assertAlmostEqual(packing.amplitude, 3, delta=4 * packing.amplitude_error)
            self.assertAlmostEqual(packing.amplitude_error, math.sqrt(2) * cause.amplitude_error, delta=0.2 * packing.amplitude_error)
            self.assertGreater(packing.agreement_p, 0.01)
            self.assertFalse(packing.differs)

    def test_an_effect_in_one_of_them_is_not_common(self):
        found = diagnosis_of(two_packings(5, -5, 5))
        self.assertEqual(len(found.packings), 2)
        for packing in found.packings:
            self.assertLess(packing.gap_p, 0.01)
            self.assertTrue(packing.differs)

    def test_a_strong_effect_may_differ_slightly_between_packings(self):
        found = diagnosis_of(two_packings(8, 7.4, 5, 3))  # signatures have an error of a tenth
        self.assertEqual(found.verdict, Verdict.effect)
        self.assertFalse(any(packing.differs for packing in found.packings))

    def test_without_an_effect_all_p_are_uniform(self):
        drawn, level = 200, 0.1
        p = []
        for seed in range(1, drawn + 1):
            found = diagnosis_of(two_packings(0, 0, seed))
            p.append((found.gap.p_omnibus, found.packings[0].gap_p, found.packings[0].agreement_p))
        error = math.sqrt(level * (1 - level) * drawn)
        np.testing.assert_allclose((np.array(p) < level).sum(axis=0), level * drawn, atol=3.5 * error)

    def test_a_single_packing_has_no_test_of_agreement(self):
        world = SyntheticWorld(6, 1)
        evidence = world.evidence(1, REPLICATES)
        world.add_effect(evidence, "adhesion", world.pattern(1))
        self.assertEqual(len(diagnosis_of(evidence).packings), 0)

    def test_rows_are_averaged_by_replicate(self):
        np.testing.assert_array_equal(mean_over_packings(np.array([[1.], [2], [5], [10]]), 2), [[3], [6]])


if __name__ == "__main__":
    unittest.main()
