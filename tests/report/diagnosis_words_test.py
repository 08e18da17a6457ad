"""Words of diagnoses, and the tables that they come from."""
import math
import unittest

from mcdem.diagnosis.diagnosis_types import Cause, MissingBins, NextStep, NuisanceFit, Refinement, WhereEntry
from mcdem.report import diagnosis_words as words


# Function, arguments, result.
CASES = [
    (words.words_of, ("cross_contact",), "cross-contact deformation"),
    (words.words_of, ("modulus",), "modulus of the grains"),
    (words.words_of, ("adhesion",), "adhesion"),
    (words.words_of, ("some_new_effect",), "some new effect"),
    (words.words_of, ("a\nb",), "a b"),
    (words.listed, ([],), ""),
    (words.listed, (["a"],), "a"),
    (words.listed, (["a", "b"],), "a and b"),
    (words.listed, (["a", "b", "c"],), "a, b and c"),
    (words.listed, (["a", "b", "c", "d"], 2), "a, b and 2 more"),
    (words.amount, (2.5e-4, "J/m2"), "0.25 mJ/m²"),
    (words.amount, (1.234e-4, "m"), "0.123 mm"),
    (words.amount, (4e-3, "N"), "4 mN"),
    (words.amount, (2300, "Pa"), "2.3 kPa"),
    (words.amount, (0.05, "relative"), "5 %"),
    (words.amount, (0.05, ""), "0.05"),
    (words.amount, (7, "furlong"), "7 furlong"),
    (words.amount, (math.inf, "m"), "–"),
    (words.amount_with_error, (4.213e-4, 0.53e-4, "J/m2"), "0.421 ± 0.053 mJ/m²"),
    (words.amount_with_error, (123.456, 17, ""), "123 ± 17"),
    (words.amount_with_error, (2300, 200, "Pa", True), "+2.30 ± 0.20 kPa"),
    (words.amount_with_error, (-2300, 200, "Pa", True), "-2.30 ± 0.20 kPa"),
    (words.amount_with_error, (0.1234, 0, ""), "0.123"),
    (words.amount_with_error, (0.1234, math.nan, "", True), "+0.123"),
    (words.amount_with_error, (1, 5e-324, "Pa"), "0.001000000000 ± 0.000000000000 kPa"),
    (words.amount_with_error, (1, 1e308, "m"), "1000 ± inf mm"),
    (words.percent, (0.814,), "81 %"),
    (words.percent, (0.125,), "13 %"),
    (words.percent, (0.001,), "< 1 %"),
    (words.percent, (0,), "0 %"),
    (words.percent, (-0.001,), "0 %"),
    (words.percent, (-0.06,), "-6 %"),
    (words.percent, (math.nan,), "–"),
    (words.p_words, (0.0040,), "p = 0.004"),
    (words.p_words, (0.4432,), "p = 0.44"),
    (words.p_words, (1e-7,), "p < 0.0001"),
    (words.p_words, (math.nan,), "p = –"),
    (words.where_words, (WhereEntry("top_force", "load", (18, 24), None, 6.13, 0.4, None, 0.1),),
     "top force while loading, at a displacement of 18 to 24 mm: 11 % higher than simulated (6.1 sigma, 0.4 after recalibration)"),
    (words.where_words, (WhereEntry("mean_force", "", (0, 0), "floor", -4, -4, "weak"),),
     "mean force, floor, weak: lower than simulated (-4.0 sigma, -4.0 after recalibration)"),
    (words.where_words, (WhereEntry("top_force", "", (0, 0), None, 4, 4, None, 1e6),),
     "top force: – higher than simulated (4.0 sigma, 4.0 after recalibration)"),
    (words.displacement_words, ((18, 18),), "18 mm"),
    (words.phase_words, ("",), "both phases"),
    (words.directed_amount, ("modulus", math.log(0.95), 0.01, "relative"), "5.00 ± 0.95 % lower than stated"),
    (words.directed_amount, ("diameter_error", 2e-4, 1e-5, "m"), "0.200 ± 0.010 mm larger than stated"),
    (words.directed_amount, ("force_bias", -0.1, 0.01, "relative"), "10.0 ± 1.0 % too low"),
    (words.directed_amount, ("adhesion", 4e-4, 5e-5, "J/m2"), "0.400 ± 0.050 mJ/m²"),
    (words.directed_amount, ("friction", 0, 0.01, ""), "0.000 ± 0.010"),
    (words.directed_amount, ("friction", 0.1, math.inf, ""), "–"),
    (words.directed_amount, ("modulus", 1e6, 0.01, "relative"), "–"),
    (words.suspect_words, (NuisanceFit("modulus", 0.3, 0.02, 0.05, "relative", True),),
     "modulus of the grains: 35.0 ± 2.7 % higher than stated (6.0 times its stated error)"),
    (words.sigma_words, (NuisanceFit("modulus", 0.6, 0.02, 0.05, "relative", True),), "at least 12 sigma"),
    (words.refinement_words, (Refinement("", "plate.speed", 0.1, 0.025, "m/s", True),), "plate.speed = 0.025 m/s instead of 0.1"),
    (words.next_words, (NextStep("press again", 0.83),), "press again (probability of success: 83 %)"),
    (words.missing_words, ((),), ""),
    (words.missing_words, ((MissingBins("adhesion", 4, 8, False),),),
     "adhesion has no value in 4 of 8 bins (50 %), whose gap counts as not explained by it"),
]


class Words(unittest.TestCase):
    def test_cases(self):
        for function, arguments, expected in CASES:
            with self.subTest(function.__name__, arguments=arguments):
                self.assertEqual(function(*arguments), expected)

    def test_a_cause_at_its_limit_may_be_larger(self):
        for at_limit, more in ((False, ""), (True, ", or more: it is at the limit of the range tried")):
            cause = Cause("friction", 0.08, "", 0.5, (), 0.01, at_limit, 0, 0, None)
            self.assertEqual(words.cause_words(cause), f"friction between grains (0.080 ± 0.010 higher than in the scene{more})")


if __name__ == "__main__":
    unittest.main()
