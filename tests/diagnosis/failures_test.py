"""A failed simulation affects only the candidate or nuisance for which it was run. failures_test.py"""
import math
import unittest

import numpy as np
from synthetic_evidence import Case

from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.diagnosis.evidence import leave_out_failures
from mcdem.errors import InputError


class Failures(unittest.TestCase):
    def setUp(self):
        self.case = Case(4, replicates=16)
        self.evidence, self.diagnosis = self.case.evidence, self.case.diagnosis

    def notes(self, *expected, causes=None):
        """What is left out must be as these say."""
        notes = leave_out_failures(self.evidence, causes)
        self.assertEqual(len(notes), len(expected), notes)
        for note, part in zip(notes, expected):
            self.assertIn(part, note)

    def fail_replicates(self, *rows):
        for row in rows:
            self.evidence.library.baseline[row] = self.evidence.baseline[row] = np.nan

    def test_nothing_is_excluded_from_complete_evidence(self):
        self.notes()
        self.assertEqual((len(self.evidence.candidates), len(self.evidence.library.baseline)), (2, 16))

    def test_a_candidate_that_runs_away_is_excluded_alone(self):
        self.evidence.library.effects[1].linear[:] = np.nan
        self.notes("friction: its runs failed (the packing runs away with it), so it cannot be tested")
        diagnosis = self.diagnosis()
        self.assertEqual((diagnosis.verdict, diagnosis.causes[0].effect), (Verdict.effect, "adhesion"))

    def test_a_nuisance_that_runs_away_is_excluded_alone(self):
        self.evidence.library.nuisances[0].curvature[:] = np.nan
        self.notes("modulus: its runs failed")
        self.assertEqual(self.evidence.nuisances, [])
        self.diagnosis()

    def test_a_candidate_without_most_bins_is_excluded(self):
        for lacking, notes in ((24, []), (25, ["friction: with it only 23 of 48 bins have a value, so it cannot be tested"])):
            self.setUp()
            self.evidence.library.effects[1].linear[:lacking] = np.nan
            self.notes(*notes)

    def test_replicates_without_numbers_are_excluded(self):
        self.fail_replicates(2, 7)
        kept = np.delete(self.evidence.baseline, [2, 7], axis=0)
        self.notes("2 of 16 runs of the scene as it stands failed")
        np.testing.assert_array_equal(self.evidence.library.baseline, kept)
        np.testing.assert_array_equal(self.evidence.baseline, kept)
        self.assertEqual(len(self.evidence.library.packing), 14)
        self.assertEqual(self.diagnosis().verdict, Verdict.effect)
        self.evidence.library.baseline[:7] = np.nan
        with self.assertRaisesRegex(InputError, "runs of the scene"):
            leave_out_failures(self.evidence)

    def test_reasons_are_stated_where_they_are_known(self):
        causes = {"": "too many neighbours", "friction": "the force is not reached"}
        self.evidence.library.effects[1].linear[:] = np.nan
        self.fail_replicates(3)
        self.notes("replicates: 1 of 16 runs of the scene as it stands failed and are left out: too many neighbours",
                   "friction: its runs failed (the force is not reached), so it cannot be tested", causes=causes)
        self.evidence.library.baseline[:8] = np.nan
        with self.assertRaisesRegex(InputError, "failed: too many neighbours; try `mcdem run`"):
            leave_out_failures(self.evidence, causes)

    def test_an_effect_that_no_observable_shows_has_no_amplitude(self):
        self.case.world.add_effect(self.evidence, "force_bias", np.zeros_like(self.evidence.observed))
        of_it = [(cause.amplitude, cause.amplitude_error) for cause in self.diagnosis().ranking if cause.effect == "force_bias"]
        self.assertEqual(of_it, [(0, math.inf)])


if __name__ == "__main__":
    unittest.main()
