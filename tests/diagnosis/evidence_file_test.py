"""Stored evidence and findings. evidence_file_test.py"""
import json
import pathlib
import tempfile
import unittest
from dataclasses import replace

import numpy as np
from synthetic_evidence import Case

from mcdem.diagnosis.decision import Findings, Proposal
from mcdem.diagnosis.evidence_file import evidence_text, findings_text, read_evidence, read_findings
from mcdem.errors import InputError

FINDINGS = Findings(0.004, ["adhesion", "modulus"], 1, [12.5, 3.0], [
    Proposal([0], [0.1], [0.02], 12.5, 0.3, 11.0, None, 0.8, 0.7, 3, 0.25), Proposal([0, 1], [0.1, 0.2], [0.02, 0.03], 15, 0.6, reduction=0.9)],
    False, 0.3, 0.2, [0])
TEXT = ('{"effects":1,"gain":[12.5,3.0],"held_out":false,"held_out_noise":0.3,"names":["adhesion","modulus"],"numerics":[0],"p_value":0.004,'
        '"placebo":0.2,"proposals":[{"amplitudes":[0.1],"candidates":[0],"confirmed_gain":11.0,"confirmed_misfit_p":null,'
        '"confirmed_reduction":0.7,"errors":[0.02],"gain":12.5,"left_out":3,"misfit_p":0.3,"reduction":0.8,"rest_misfit_p":0.25},'
        '{"amplitudes":[0.1,0.2],"candidates":[0,1],"confirmed_gain":null,"confirmed_misfit_p":null,"confirmed_reduction":null,'
        '"errors":[0.02,0.03],"gain":15.0,"left_out":null,"misfit_p":0.6,"reduction":0.9,"rest_misfit_p":0.0}]}')


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "e.json"

    def written(self, text):
        self.file.write_text(text)
        return self.file


class KeptEvidence(Files):
    def test_is_read_back_unchanged(self):
        evidence = Case(4).evidence
        evidence.seed = 2**64 - 1
        back = read_evidence(self.written(evidence_text(evidence)), evidence.library)
        np.testing.assert_array_equal(back.observed, evidence.observed)  # with NaN
        np.testing.assert_array_equal(back.baseline, evidence.baseline)
        self.assertEqual((back.candidates, back.nuisances, back.seed), (evidence.candidates, evidence.nuisances, evidence.seed))
        self.assertIs(back.library_is_own, False)
        self.assertEqual(json.loads(evidence_text(evidence))["candidates"][0], {"name": "adhesion", "unit": "", "low": -10.0, "high": 10.0})

    def test_of_another_library_is_refused(self):
        evidence = Case(4).evidence
        library, file = evidence.library, self.written(evidence_text(evidence))
        for other, problem in ((replace(library, effects=library.effects[1:]), "the library lacks an effect of it"),
                               (replace(library, nuisances=[]), "the library lacks a nuisance of it"),
                               (replace(library, baseline=library.baseline[:, 1:]), "it has other observables than the library")):
            with self.assertRaisesRegex(InputError, problem):
                read_evidence(file, other)

    def test_what_is_none_is_refused(self):
        library = Case(4).evidence.library
        for text in ("", "[]", "{}", '{"seed":1,"observed":[1],"baseline":3,"candidates":[],"nuisances":[]}'):
            with self.assertRaisesRegex(InputError, "not evidence of this challenge"):
                read_evidence(self.written(text), library)


class KeptFindings(Files):
    def test_are_read_back_unchanged(self):
        self.assertEqual(findings_text(FINDINGS), TEXT)
        self.assertEqual(read_findings(self.written(TEXT)), FINDINGS)

    def test_what_are_none_is_refused(self):
        for text in ("3", TEXT.replace('"effects":1,', ""), TEXT.replace("[12.5,3.0]", "[12.5]"), TEXT.replace("[0,1]", "[0,2]"),
                     TEXT.replace('"held_out":false', '"held_out":0')):
            with self.assertRaisesRegex(InputError, "not findings of a diagnosis"):
                read_findings(self.written(text))
        self.file.unlink()
        with self.assertRaisesRegex(InputError, "is missing; `mcdem challenge run` writes it"):
            read_findings(self.file)


if __name__ == "__main__":
    unittest.main()
