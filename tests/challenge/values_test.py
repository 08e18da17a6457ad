"""Intervals of proportions, the ideal power, and the values of the figures of a score. values_test.py"""
import unittest

from mcdem.challenge.case import CaseKind, ChallengeCase, Hidden
from mcdem.challenge.figure_values import ideal_power, score_figure_values
from mcdem.challenge.merits import Answer, Merits, ScoredCase, wilson_interval
from mcdem.challenge.score import ArmScore, ChallengeScore, GapReductionScore
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_types import Verdict

NO_EFFECT = ChallengeCase("", CaseKind.none, (), (), (), 0, 0)
ADHESION = ChallengeCase("", CaseKind.effect, (Hidden("adhesion", 1e-3),), (), (), 0, 0)
NOTHING, RIGHT, UNKNOWN = Answer(), Answer(Verdict.effect, ("adhesion",), 0.9), Answer(Verdict.unknown_effect)


def figures_of(*cases):
    """The figures for these numbers of cases of each kind."""
    scored = [ScoredCase(*case) for count, *case in cases for _ in range(count)]
    arms = [ArmScore("whole", "", Limits(false_alarm=0.05), Merits(), Merits())]
    return score_figure_values(ChallengeScore(len(scored), [], arms, GapReductionScore(), scored))


class Statistics(unittest.TestCase):
    def test_wilson_interval_as_newcombe_1998(self):
        """Statistics in Medicine 17 (1998) 857, Table I, method 3, to four decimals."""
        for successes, trials, low, high in ((81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0, 0.1611),
                                             (1, 29, 0.0061, 0.1718)):
            for found, expected in zip(wilson_interval(successes, trials), (low, high)):
                self.assertAlmostEqual(found, expected, delta=5.1e-5)
        self.assertEqual(wilson_interval(0, 0), (0, 1))
        self.assertEqual(wilson_interval(20, 20)[1], 1)
        for trials in range(1, 101):
            for successes in range(trials + 1):
                low, high = wilson_interval(successes, trials)
                self.assertTrue(0 <= low <= successes / trials <= high <= 1, (successes, trials))

    def test_ideal_power_has_the_stated_values(self):
        # At 1 the other sign adds 1e-6; half of the cases are detected at 1.96 sigma, and the limit is 1.960 + 0.8416 sigma.
        for over_limit, power, error in ((0, 0.05, 1e-12), (1, 0.8, 1e-5), (1.95996 / (1.95996 + 0.84162), 0.5, 1e-4)):
            self.assertAlmostEqual(ideal_power(0.05, over_limit), power, delta=error)
        self.assertGreater(ideal_power(0.05, 2), 0.999)


class Figures(unittest.TestCase):
    def test_cases_are_counted_and_correct_answers_marked(self):
        values = figures_of((9, NO_EFFECT, NOTHING), (1, NO_EFFECT, RIGHT), (2, ADHESION, NOTHING), (3, ADHESION, RIGHT),
                            (5, ADHESION, UNKNOWN))["confusion"]
        self.assertEqual(values, {"truths": ["no_gap", "adhesion"], "verdicts": ["no_gap", "adhesion", "unknown_effect"],
                                  "cases": [[9, 1, 0], [2, 3, 5]], "right": [[0, 0], [1, 1]]})

    def test_power_is_a_fraction_with_an_interval_and_omits_empty_bins(self):
        values = figures_of((20, ADHESION, NOTHING, 0.5), (20, ADHESION, RIGHT, 2))["power"]
        measured, predicted = values["measured"], values["predicted"]
        self.assertEqual((measured["x"], measured["part"], measured["cases"]), ([0.5, 2], [0, 1], [20, 20]))
        self.assertAlmostEqual(measured["interval"][0][1], 0.161, delta=5e-4)
        self.assertAlmostEqual(predicted["part"][50], ideal_power(0.05, predicted["x"][50]), 15)
        self.assertEqual(len(predicted["x"]), 101)

    def test_confidence_is_the_success_rate_over_the_stated_one(self):
        refused = Answer(Verdict.unknown_effect, ("adhesion",), 0.1)
        measured = figures_of((15, ADHESION, RIGHT), (5, NO_EFFECT, RIGHT), (4, ADHESION, refused))["confidence"]["measured"]
        self.assertEqual(measured["part"], [1, 0.75])
        for found, expected in zip(measured["x"], (0.1, 0.9)):
            self.assertAlmostEqual(found, expected, 15)
        self.assertAlmostEqual(measured["interval"][1][0], 0.531, delta=5e-4)

    def test_figures_exist_only_with_data(self):
        self.assertEqual(figures_of(), {})
        self.assertEqual(list(figures_of((1, NO_EFFECT, NOTHING))), ["confusion"])


if __name__ == "__main__":
    unittest.main()
