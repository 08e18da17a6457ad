"""Bins in which a candidate, a parameter or a replicate has no value. missing_bins_test.py"""
import math
import unittest

import numpy as np
from synthetic_evidence import SyntheticWorld, TwoEffects

from mcdem.diagnosis.builder import DiagnosisBuilder
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_types import MissingBins, Verdict
from mcdem.diagnosis.effect_fit import fit_effects
from mcdem.diagnosis.evidence import gap_data, leave_out_failures
from mcdem.diagnosis.gap_reduction import held_out_reduction, split_cells
from mcdem.diagnosis.gap_space import GapSpace
from mcdem.diagnosis.gap_tests import gap_statistics

TAKEN = slice(16, 40)  # three of six observables, with half of the 48 bins, can be taken from any


class World(TwoEffects):
    def effect(self, k):
        return self.evidence.library.effects[k]

    def data(self):
        return gap_data(self.evidence)

    def space(self):
        data = self.data()
        return GapSpace(data.noise, len(self.evidence.baseline), data.cells, data.free)

    def statistics(self):
        return gap_statistics(self.space(), self.data(), self.data().gap)

    def diagnosis(self):
        return DiagnosisBuilder(self.evidence, Limits()).diagnosis()

    def runs_with(self, effect):
        """Runs of a few replicates with four times the effect."""
        centre = self.evidence.baseline.mean(axis=0) + 4 * effect
        return np.array([centre + self.synthetic.noise() for _ in range(16)])


class OfACandidate(unittest.TestCase):
    def test_leave_the_evidence_for_all_others_as_it_is(self):
        without, lacking = World(), World()
        without.evidence.candidates.pop()
        lacking.effect(1).linear[TAKEN] = np.nan
        np.testing.assert_array_equal(lacking.data().cells, without.data().cells)
        a, b = without.statistics(), lacking.statistics()
        for one, other in zip((a.omnibus, a.highest_refitted, a.fits[0].amplitude, a.fits[0].error, a.fits[0].score),
                              (b.omnibus, b.highest_refitted, b.fits[0].amplitude, b.fits[0].error, b.fits[0].score)):
            self.assertEqual(one, other)
        diagnosis = lacking.diagnosis()
        self.assertEqual((diagnosis.verdict, diagnosis.causes[0].effect), (Verdict.effect, "adhesion"))
        self.assertEqual(diagnosis.missing_bins, (MissingBins("friction", 24, 48, False),))
        self.assertEqual(without.diagnosis().missing_bins, ())

    def test_cost_the_candidate_that_lacks_them(self):
        # The amplitude is that of the other bins, without bias; what the missing ones would have gained is lost.
        whole, lacking = World(), World()
        lacking.effect(0).curvature[TAKEN] = np.nan
        a, b = whole.statistics().fits[0], lacking.statistics().fits[0]
        self.assertAlmostEqual(b.amplitude, 4, delta=4 * b.error)
        self.assertGreater(b.error, a.error)
        self.assertTrue(0.3 * a.score < b.score < 0.7 * a.score)
        split = split_cells(lacking.data().cells, lacking.evidence.library.grid)
        all_known = held_out_reduction(whole.data(), split, [0], 16)
        self.assertGreater(all_known, 0.9)
        self.assertAlmostEqual(held_out_reduction(lacking.data(), split, [0], 16), all_known / 2, delta=0.2)
        diagnosis = lacking.diagnosis()
        self.assertEqual(diagnosis.ranking[0].effect, "adhesion")
        self.assertEqual(diagnosis.verdict, Verdict.unknown_effect)  # the gap in the missing bins is left
        self.assertTrue(diagnosis.explanation.leaves_more_than_noise)

    def test_are_given_back_by_runs_that_have_them(self):
        # The signature is not known at amplitudes at which a force vanishes; runs at the fitted one have all bins.
        world = World()
        effect = world.effect(0).linear.copy()
        world.effect(0).linear[TAKEN] = np.nan
        for have, verdict in ((True, Verdict.effect), (False, Verdict.unknown_effect)):
            builder, runs = DiagnosisBuilder(world.evidence, Limits()), world.runs_with(effect)
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
        world = World()
        world.evidence.observed += 3 * world.effect(1).linear

        def pair_gain():
            return fit_effects(world.space(), world.data().candidates[:2], world.data().gap).score

        whole = pair_gain()
        world.effect(1).linear[TAKEN] = np.nan
        self.assertLess(pair_gain(), 0.8 * whole)
        diagnosis = world.diagnosis()
        self.assertTrue(all(math.isfinite(cause.score) for cause in diagnosis.ranking))
        self.assertTrue(all(math.isfinite(limit.minimum_amplitude) for limit in diagnosis.detection_limits))


class OfOthers(unittest.TestCase):
    def test_of_a_parameter_are_compared_for_no_candidate(self):
        # A parameter may shift a bin by any amount where its own change of it is not known.
        world = World()
        world.evidence.library.nuisances[0].linear[4:7] = np.nan
        self.assertEqual(len(world.data().cells), 45)
        self.assertEqual(world.diagnosis().missing_bins, (MissingBins("modulus", 3, 48, True),))

    def test_of_a_few_replicates_leave_out_these_replicates(self):
        world = World()
        for rows in (world.evidence.library.baseline, world.evidence.baseline):
            rows[[2, 7], TAKEN] = np.nan
        kept = np.delete(world.evidence.library.baseline, [2, 7], axis=0)
        self.assertEqual(len(world.data().cells), 24)
        self.assertEqual(leave_out_failures(world.evidence), [
            "replicates: 2 of 16 runs of the scene as it stands lack values that the others have, and are left out of the noise"])
        np.testing.assert_array_equal(world.evidence.library.baseline, kept)
        self.assertEqual(len(world.data().cells), 48)
        self.assertEqual(world.diagnosis().verdict, Verdict.effect)

    def test_of_single_replicates_are_said(self):
        # 15 replicates in 48 bins are fewer values than 16 in 47.
        world = World()
        world.evidence.library.baseline[5, 20] = np.nan
        self.assertEqual(leave_out_failures(world.evidence), [])
        self.assertEqual(world.diagnosis().missing_bins, (MissingBins("", 1, 48, True),))

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
