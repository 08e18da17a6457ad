"""An experiment with only the force on its plate, on which an effect has the signature of the modulus. plate_only_test.py"""
import unittest

import numpy as np
from synthetic_evidence import GRID, SyntheticWorld

from mcdem.diagnosis.builder import DiagnosisBuilder
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.diagnosis.not_measured import not_measured
from mcdem.observe.grid import bins_of
from mcdem.observe.observables import index_of
from mcdem.errors import InputError


def plate_evidence(shift, seed):
    world = SyntheticWorld(1, seed)
    evidence = world.evidence(1, 32)
    modulus = world.pattern(1)
    world.add_effect(evidence, "diameter_error", modulus)
    world.add_nuisance(evidence, "modulus", modulus, 1)
    evidence.observed += shift * modulus
    return evidence


def diagnosed(shift, seed):
    return DiagnosisBuilder(plate_evidence(shift, seed), Limits()).diagnosis()


class PlateOnly(unittest.TestCase):
    def test_missing_files_are_named(self):
        observed = np.full(len(bins_of(GRID)), np.nan)
        for bin, files in ((0, ["contacts.csv: ", "grains.csv beyond frame 0"]), (8, ["grains.csv beyond frame 0"]), (8 * 13, [])):
            observed[bin] = 1  # top_force, floor_force, section_load
            told = list(not_measured(observed, GRID))
            self.assertEqual(len(told), len(files))
            for text, file in zip(told, files):
                self.assertIn(file, text)

    def test_measured_grains_need_contact_forces_only(self):
        observed = np.full(len(bins_of(GRID)), np.nan)
        observed[[0, 8 * index_of("touching")]] = 1
        self.assertEqual([text.partition(":")[0] for text in not_measured(observed, GRID)], ["contacts.csv", "contacts.csv in the frames of grains.csv"])

    def test_within_the_prior_of_the_modulus_there_is_no_gap(self):
        self.assertLessEqual(sum(diagnosed(1, seed).gap.detected for seed in range(1, 21)), 4)

    def test_far_beyond_the_prior_no_single_cause_is_named(self):
        groups = []
        for seed in range(1, 11):
            with self.subTest(seed):
                d = diagnosed(9, seed)
                self.assertTrue(d.gap.detected)
                self.assertNotEqual(d.verdict, Verdict.effect)  # with eight bins a placebo may be as good
                first, second = d.ranking
                self.assertAlmostEqual(first.confidence, second.confidence, 3)
                groups.append({cause.effect for cause in d.causes})
                self.assertEqual((len(d.not_measured), len(d.cells)), (2, 8))
        # One of them may take away too little of a small gap in held-out data.
        self.assertGreaterEqual(groups.count({"diameter_error", "modulus"}), 8)

    def test_limits_state_that_the_modulus_absorbs_the_effect(self):
        limit, = diagnosed(0, 1).detection_limits
        self.assertGreater(limit.absorbed_by_calibration, 0.5)
        self.assertIn("modulus", limit.group)

    def test_a_few_bins_are_required(self):
        evidence = plate_evidence(0, 1)
        evidence.observed[:5] = np.nan
        with self.assertRaisesRegex(InputError, "have 3 observations in common, and 4 are needed"):
            DiagnosisBuilder(evidence, Limits())
        evidence.observed[0] = 0
        DiagnosisBuilder(evidence, Limits())


if __name__ == "__main__":
    unittest.main()
