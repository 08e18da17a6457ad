"""Bins in which a candidate, a parameter or a replicate has no value. missing_bins_test.py"""
import math
import unittest

import numpy as np
import synthetic_evidence
from synthetic_evidence import SyntheticWorld

from mcdem.diagnosis.diagnosis_types import MissingBins, Verdict
from mcdem.diagnosis.effect_fit import fit_effects
from mcdem.diagnosis.evidence import leave_out_failures
from mcdem.diagnosis.gap_reduction import HeldOutTest

TAKEN = slice(16, 40)  # three of six observables, with half of the 48 bins, can be taken from any


class Case(synthetic_evidence.Case):
    def __init__(self, friction=0, lacking=None, term="linear"):
        """`lacking`: the effect whose `term` lacks bins."""
        super().__init__(4, friction, replicates=16)
        if lacking is not None:
            getattr(self.effects[lacking], term)[TAKEN] = np.nan

    def held_out_reduction(self):
        return HeldOutTest.split(self.data, self.evidence.library.grid).reduction([0])


class OfACandidate(unittest.TestCase):
    def test_leave_the_evidence_for_all_others_as_it_is(self):
        without, lacking = Case(), Case(lacking=1)
        without.evidence.candidates.pop()
        np.testing.assert_array_equal(lacking.data.bins, without.data.bins)
        a, b = without.statistics, lacking.statistics
        self.assertEqual((a.omnibus, a.highest_refitted, a.fits[0]), (b.omnibus, b.highest_refitted, b.fits[0]))
        diagnosis = lacking.diagnosis()
        self.assertEqual((diagnosis.verdict, diagnosis.causes[0].effect), (Verdict.effect, "adhesion"))
        self.assertEqual(diagnosis.missing_bins, (MissingBins("friction", 24, 48, False),))
        self.assertEqual(without.diagnosis().missing_bins, ())

    def test_cost_the_candidate_that_lacks_them(self):
        # The amplitude is that of the other bins, without bias; what the missing ones would have gained is lost.
        whole, lacking = Case(), Case(lacking=0, term="curvature")
        a, b = whole.statistics.fits[0], lacking.statistics.fits[0]
        self.assertAlmostEqual(b.amplitude, 4, delta=4 * b.error)
        self.assertGreater(b.error, a.error)
        self.assertTrue(0.3 * a.score < b.score < 0.7 * a.score)
        all_known = whole.held_out_reduction()
        self.assertGreater(all_known, 0.9)
        self.assertAlmostEqual(lacking.held_out_reduction(), all_known / 2, delta=0.2)
        diagnosis = lacking.diagnosis()
        self.assertEqual(diagnosis.ranking[0].effect, "adhesion")
        self.assertEqual(diagnosis.verdict, Verdict.unknown_effect)  # the gap in the missing bins is left
        self.assertTrue(diagnosis.explanation.leaves_more_than_noise)

    def test_are_given_back_by_runs_that_have_them(self):
        # The signature is not known at amplitudes at which a force vanishes; runs at the fitted one have all bins.
        effect = Case().effects[0].linear
        case = Case(lacking=0)
        for have, verdict in ((True, Verdict.effect), (False, Verdict.unknown_effect)):
            builder, runs = case.builder(), case.runs(4 * effect)
            if not have:
                runs[:3, TAKEN] = np.nan
            builder.confirm(0, runs)
            while (k := builder.wants_held_out()) is not None:
                builder.confirm_held_out(k, runs)
            diagnosis = builder.diagnosis()
            first = diagnosis.ranking[0]
            self.assertEqual((first.effect, diagnosis.verdict), ("adhesion", verdict))
            self.assertIsNotNone(first.confirmed_score)
            self.assertAlmostEqual(first.amplitude, 4, delta=4 * first.amplitude_error)
            self.assertEqual(diagnosis.explanation.reduction > 0.9, have)
            self.assertEqual(diagnosis.explanation.leaves_more_than_noise, not have)

    def test_of_one_of_a_pair_are_not_gained_by_the_pair(self):
        whole, lacking = (Case(3, lacking=one) for one in (None, 1))
        gains = [fit_effects(case.space, case.data.candidates[:2], case.data.gap).score for case in (whole, lacking)]
        self.assertLess(gains[1], 0.8 * gains[0])
        diagnosis = lacking.diagnosis()
        self.assertTrue(all(math.isfinite(cause.score) for cause in diagnosis.ranking))
        self.assertTrue(all(math.isfinite(limit.minimum_amplitude) for limit in diagnosis.detection_limits))


class OfOthers(unittest.TestCase):
    def test_of_a_parameter_are_compared_for_no_candidate(self):
        # A parameter may shift a bin by any amount where its own change of it is not known.
        case = Case()
        case.parameters[0].linear[4:7] = np.nan
        self.assertEqual(len(case.data.bins), 45)
        self.assertEqual(case.diagnosis().missing_bins, (MissingBins("modulus", 3, 48, True),))

    def test_of_a_few_replicates_leave_out_these_replicates(self):
        case = Case()
        for rows in (case.evidence.library.baseline, case.evidence.baseline):
            rows[[2, 7], TAKEN] = np.nan
        kept = np.delete(case.evidence.library.baseline, [2, 7], axis=0)
        self.assertEqual(leave_out_failures(case.evidence), [
            "replicates: 2 of 16 runs of the scene as it stands lack values that the others have, and are left out of the noise"])
        np.testing.assert_array_equal(case.evidence.library.baseline, kept)
        self.assertEqual(len(case.data.bins), 48)
        self.assertEqual(case.diagnosis().verdict, Verdict.effect)

    def test_of_single_replicates_are_said(self):
        # 15 replicates in 48 bins are fewer values than 16 in 47.
        case = Case()
        case.evidence.library.baseline[5, 20] = np.nan
        self.assertEqual(leave_out_failures(case.evidence), [])
        self.assertEqual(case.diagnosis().missing_bins, (MissingBins("", 1, 48, True),))

    def test_leave_eight_replicates_at_least(self):
        evidence = SyntheticWorld(6, 3).evidence(1, 9)
        evidence.library.baseline[[1, 4], TAKEN] = np.nan
        self.assertEqual(leave_out_failures(evidence), [])
        self.assertEqual(len(evidence.library.baseline), 9)

    def test_packings_keep_two_replicates(self):
        for packings, replicates, left in ((2, 9, 16), (3, 6, 16), (6, 3, 18), (9, 2, 18)):
            evidence = SyntheticWorld(6, 3).evidence(packings, replicates)
            evidence.library.baseline[[0, 1], TAKEN] = np.nan
            leave_out_failures(evidence)
            self.assertEqual(len(evidence.library.baseline), left)


if __name__ == "__main__":
    unittest.main()
