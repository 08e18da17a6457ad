"""Parts of the method are removed for evidence with a known result; simpler methods. ablations_test.py"""
import unittest

import numpy as np
from known_evidence import evidence

from mcdem.challenge.ablations import ABLATIONS, SIMPLER_METHODS, ablated_findings
from mcdem.challenge.limits import answer_of
from mcdem.diagnosis.decision import Limits

def findings_of(name, found):
    return ablated_findings(found, next(ablation for ablation in ABLATIONS if ablation.name == name))


def answer(name, found):
    """Of an ablation or a simpler method."""
    method = next((method for method in SIMPLER_METHODS if method.name == name), None)
    return method.answer(found) if method else answer_of(findings_of(name, found), Limits())


class Ablations(unittest.TestCase):
    def test_each_detects_what_it_can_see(self):
        for name, shifts, is_detected in (
                ("without confirming runs", {"adhesion": 2}, True), ("without confirming runs", {}, False),
                ("without conditional observables", {"adhesion": 2}, False), ("without conditional observables", {"friction": 8}, True),
                ("top force alone", {"adhesion": 2}, False), ("top force alone", {"friction": 8}, True),
                ("without confirming runs", {"modulus": 0.5}, False), ("without nuisances", {"modulus": 0.5}, True)):  # one sigma
            with self.subTest(name, **shifts):
                self.assertEqual(answer(name, evidence(**shifts)).detected(), is_detected)

    def test_without_confirming_runs_signatures_name_the_effect(self):
        found = answer("without confirming runs", evidence(adhesion=2))
        self.assertTrue(found.names())
        self.assertEqual(found.group[0], "adhesion")

    def test_without_pairing_the_scatter_of_packings_hides_the_effect(self):
        """Over packings sigma is 3: gains decrease by a factor of ten, and the mean is over eight packings. The covariance from 32 rows
        recovers part of it; the rest varies between draws."""
        found = evidence(adhesion=1.5)
        paired, unpaired = (findings_of(f"without {part}", found).gain[0] for part in ("confirming runs", "pairing"))
        self.assertLess(unpaired, 0.5 * paired)
        self.assertGreater(paired, 20)

    def test_too_little_evidence_finds_nothing(self):
        found = evidence(adhesion=5)
        found.observed[:] = np.nan
        self.assertFalse(answer("without confirming runs", found).detected())

    def test_evidence_stays_as_it_is(self):
        found = evidence(adhesion=2)
        before = found.observed.copy(), found.baseline.copy(), list(found.library.packing), list(found.nuisances)
        for ablation in ABLATIONS:
            ablation.changed(found)
        for old, now in zip(before, (found.observed, found.baseline, found.library.packing, found.nuisances)):
            np.testing.assert_array_equal(old, now)


class SimplerMethods(unittest.TestCase):
    def test_rmse_ranking_always_names(self):
        for shifts, group in (({"adhesion": 3}, ("adhesion",)), ({"friction": 9}, ("friction",))):
            self.assertEqual(answer("RMSE ranking", evidence(**shifts)).group, group)
        self.assertTrue(answer("RMSE ranking", evidence()).names())

    def test_bic_names_an_effect_only_if_it_is_worth_its_parameter(self):
        self.assertEqual(answer("BIC", evidence(adhesion=3)).group, ("adhesion",))
        self.assertFalse(answer("BIC", evidence()).detected())


if __name__ == "__main__":
    unittest.main()
