"""The result of a study in words and as JSON. words_test.py"""
import json
import math
import unittest
from dataclasses import replace

from mcdem.convergence.convergence_json import convergence_json
from mcdem.convergence.convergence_types import CauseErrors, BinError, Convergence, Limits
from mcdem.convergence.words import CONVERGED, NOT_CONVERGED, NOT_DECIDED, words_of_cause, words_of_result

LIMITS = Limits(0.005, 0.5)
SMALL = BinError("top_force", "load", 10.04, 1.5, 0.1, 0.001, 0.0005, True, 0.005, False)
FORCE = replace(SMALL, error=0.0131, standard_error=0.0021, beyond=True)
COUNT = BinError("coordination_number", "unload", 4.2, 5.0, 0.2, -0.3, 0.04, False, 0.1, True)  # the limit is half of 0.2
UNSURE = replace(SMALL, standard_error=0.003)
ZERO = replace(SMALL, error=0.0, standard_error=0.0)


def errors(*bins):
    return CauseErrors("plate speed", bins)


class OfACause(unittest.TestCase):
    def test_name_the_worst_error_and_its_remedy(self):
        remedy = "plate.speed = 0.1 / {factor:.2g}, or that / {square:.2g}"
        force = "top_force is 1.3 +- 0.2 % too high at 10.0 mm of loading"
        for bins, remedy_words, said in (
                ((SMALL, FORCE), "", force),
                ((FORCE,), remedy, f"{force}; within the limit with plate.speed = 0.1 / 2.6, or that / 6.9"),
                ((FORCE, COUNT), remedy, "coordination_number is at least 1.5 +- 0.2 sd too low at 4.2 mm of unloading, 2 values beyond "
                                         "their limits; within the limit with plate.speed = 0.1 / 3, or that / 9"),
                ((SMALL, SMALL), remedy, "no error beyond its limit"),
                ((SMALL, UNSURE), remedy, "no error beyond its limit, but 1 of 40 values have standard errors that are too large to tell; "
                                          "use more --replicas"),
                ((ZERO, replace(ZERO, standard_error=math.nan)), remedy, "no influence in these runs"),
                ((), remedy, "no influence in these runs")):
            self.assertEqual(words_of_cause(errors(*bins), remedy_words, LIMITS, 40), f"plate speed: {said}")


class OfTheResult(unittest.TestCase):
    def test_say_whether_it_is_converged(self):
        for causes, said in (((), CONVERGED), (((SMALL,), (ZERO,)), CONVERGED), (((SMALL,), (UNSURE,)), NOT_DECIDED),
                             (((UNSURE,), (SMALL, FORCE)), NOT_CONVERGED)):
            self.assertEqual(words_of_result([errors(*bins) for bins in causes]), said)


class Json(unittest.TestCase):
    def test_has_the_documented_keys_and_null_for_what_is_unknown(self):
        convergence = Convergence("küche\udcff", 8, "copies", (CONVERGED,), LIMITS, (errors(replace(COUNT, standard_error=math.nan)),), 1.5)
        text = convergence_json(convergence)
        self.assertTrue(text.startswith('{\n  "scene": "küche\ufffd",\n  "replicas": 8,\n'), text)
        document = json.loads(text)
        self.assertEqual(list(document), ["scene", "replicas", "copies", "words", "limits", "causes", "seconds"])
        self.assertEqual(document["limits"], {"force": 0.005, "deviations": 0.5})
        self.assertEqual(document["causes"], [{"cause": "plate speed", "errors": [{
            "observable": "coordination_number", "phase": "unload", "displacement_mm": 4.2, "mean": 5.0, "standard_deviation": 0.2,
            "error": -0.3, "standard_error": None, "follows_order": False, "limit": 0.1, "beyond": True}]}])


if __name__ == "__main__":
    unittest.main()
