"""diagnosis.json has the documented keys, and is read back as it was written. diagnosis_json_test.py"""
import json
import math
import pathlib
import re
import sys
import unittest
from dataclasses import replace

sys.path.append(str(pathlib.Path(__file__).parents[1] / "report"))
from diagnosis_samples import bare, of, sample, with_texts  # noqa: E402

from mcdem.diagnosis.diagnosis_json import diagnosis_json  # noqa: E402
from mcdem.diagnosis.diagnosis_types import Verdict, WhereEntry, millimetres  # noqa: E402
from mcdem.report.diagnosis import diagnosis_of  # noqa: E402

NAN = math.nan
WHERE = "observable phase displacement_mm region z_score z_score_refitted force_class difference"
CAUSE = "effect amplitude unit confidence group amplitude_error at_limit explained score confirmed_score"
FIT = "name shift error prior unit at_bound"
# Place in the document, its keys in their order.
KEYS = {
    "": "verdict gap where causes explanation shrink detection_limits not_measured seconds where_threshold cells ranking nuisances "
        "check_first missing_bins not_testable refinements next packings contact_laws provenance",
    "gap": "detected p_value p_omnibus p_directed",
    "where 0": WHERE,
    "cells 0": "observable phase displacement_mm z_score z_score_refitted difference",
    "causes 0": CAUSE,
    "ranking 17": CAUSE,
    "explanation": "reduction simulated held_out placebo needed remainder remainder_p leaves_more_than_noise without",
    "shrink": "held_out before after fraction interval placebo metrics confirmed fitted_displacement_mm top_force",
    "shrink metrics": "Rtop errf errZ bhat",
    "shrink top_force 0": "displacement_mm experiment_N before_N after_N",
    "detection_limits 0": "effect minimum_amplitude absorbed_by_calibration unit group",
    "nuisances 0": FIT,
    "missing_bins 0": "of bins of_bins share for_all",
    "next 0": "what power",
    "packings 0": "experiment gap_p amplitude amplitude_error agreement_p differs",
    "contact_laws 0": "phase displacement_mm overlap change change_error exponent exponent_error",
}
# Changes of the first cause, parts of the text.
NUMBERS = [
    ({"amplitude": 1e-5}, '"amplitude": 1e-05,'),
    ({"amplitude": 0.0001}, '"amplitude": 0.0001,'),
    ({"amplitude": 3}, '"amplitude": 3.0,'),
    ({"amplitude": -0.0}, '"amplitude": -0.0,'),
    ({"amplitude": 0.1 + 0.2}, '"amplitude": 0.30000000000000004,'),
    ({"amplitude": NAN}, '"amplitude": null,'),
    ({"amplitude_error": math.inf}, '"amplitude_error": null,'),
    ({"confirmed_score": None}, '"confirmed_score": null'),
    ({"effect": '"\\\x01\n µ粒'}, '"effect": "\\"\\\\\\u0001\\n µ粒",'),
    ({"effect": "caf\udce9"}, '"effect": "caf\ufffd",'),
]


def at(document, place):
    for key in place.split():
        document = document[int(key) if isinstance(document, list) else key]
    return document


def written(diagnosis):
    return json.loads(diagnosis_json(diagnosis))


class DiagnosisJson(unittest.TestCase):
    def test_keys_are_the_documented_ones_in_their_order(self):
        document = written(of(sample("effect")))
        for place, keys in KEYS.items():
            with self.subTest(place):
                self.assertEqual(list(at(document, place)), keys.split())
        self.assertEqual(list(written(of(sample("not_converged")))["refinements"][0]), "effect key was to unit done".split())

    def test_values_are_kept(self):
        for verdict in Verdict:
            for document in (sample(verdict), bare(verdict)):
                document["provenance"] = dict(sorted(document["provenance"].items()))
                self.assertEqual(written(of(document)), json.loads(json.dumps(document)))

    def test_is_read_back_as_written(self):
        for verdict in Verdict:
            d = of(with_texts(sample(verdict), '"}]\n\\ <x> \x01'))
            d = replace(d, cells=(replace(d.cells[0], z_score=NAN), *d.cells[1:]))
            text = diagnosis_json(d)
            self.assertEqual(diagnosis_json(diagnosis_of(text.encode(), "here")), text)

    def test_numbers_and_texts(self):
        d = of(sample("effect"))
        for changes, part in NUMBERS:
            with self.subTest(part):
                self.assertIn(part, diagnosis_json(replace(d, causes=(replace(d.causes[0], **changes),))))

    def test_layout(self):
        lines = diagnosis_json(of(bare("no_gap"))).split("\n")
        self.assertEqual(lines[:3] + lines[-2:], ["{", '  "verdict": "no_gap",', '  "gap": {', "}", ""])
        self.assertIn('  "where": [],', lines)
        self.assertIn('  "shrink": null,', lines)
        document = written(replace(of(bare("no_gap")), provenance={"seed": "1", "device": "x"}))
        self.assertEqual(list(document["provenance"]), ["device", "seed"])

    def test_unknown_texts_are_null_and_empty_ones_are_not(self):
        entry = WhereEntry("x", "", (1, 2), None, 1, 1, None)
        row = written(replace(of(bare("effect")), where=(entry,)))["where"][0]
        self.assertEqual([row[key] for key in ("phase", "region", "force_class")], [None] * 3)
        self.assertEqual(written(of(sample("effect")))["explanation"]["without"], "")

    def test_millimetres_have_no_noise_in_the_last_digits(self):
        self.assertEqual([millimetres(x) for x in (0.018 + 0.003, 0.024 - 0.003, 1e-10, 0.0126)], [21.0, 21.0, 0.0, 12.6])

    def test_every_key_is_documented(self):
        known = (pathlib.Path(__file__).parents[2] / "host/python/mcdem/diagnosis/DIAGNOSIS_OUTPUT.md").read_text()
        for place, keys in KEYS.items():
            for key in keys.split():
                self.assertRegex(known, rf"\b{re.escape(key)}\b", place)


if __name__ == "__main__":
    unittest.main()
