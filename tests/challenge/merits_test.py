"""Figures of merit compared with hand counts, the choice of limits, and the values of a score's figures. merits_test.py"""
import unittest

from mcdem.challenge.case import CaseKind, ChallengeCase, Hidden
from mcdem.challenge.figure_values import ideal_power, score_figure_values
from mcdem.challenge.limits import LimitCase, choose_limits, merits_with
from mcdem.challenge.merits import Answer, Merits, ScoredCase, Share, merits_of, wilson_interval
from mcdem.challenge.score import ArmScore, ChallengeScore, GapReductionScore
from mcdem.diagnosis.decision import Findings, Limits, Proposal
from mcdem.diagnosis.diagnosis_types import Verdict

NOTHING = Answer()


def truth(kind, effects=(), struck=()):
    return ChallengeCase("case_0001", kind, tuple(Hidden(name, 1) for name in effects), (), tuple(struck), 0, 0)


def named(*group, confidence=1.0):
    return Answer(Verdict.group if len(group) > 1 else Verdict.effect, group, confidence)


def refused(*group, confidence=0.0):
    return Answer(Verdict.unknown_effect, group, confidence)


NONE, SHIFTED = truth(CaseKind.none), truth(CaseKind.outside_prior)
ADHESION, TILT = truth(CaseKind.effect, ["adhesion"]), truth(CaseKind.effect, ["plate_tilt"])
PAIR = truth(CaseKind.pair, ["adhesion", "plate_tilt"])
SOFT, STRUCK = truth(CaseKind.unknown, ["soft_walls"]), truth(CaseKind.unknown, ["friction"], ["friction"])
SUSPECT = Answer(Verdict.calibration_suspect)
RIGHT = named("adhesion", confidence=0.9)


class OfCases(unittest.TestCase):
    def expect(self, cases, by_name=None, **expected):
        merits = merits_of(ScoredCase(*case) for case in cases)
        for name, value in expected.items():
            if isinstance(value, tuple):
                self.assertEqual(getattr(merits, name), Share(*value), name)
            else:
                self.assertAlmostEqual(getattr(merits, name), value, 15, name)
        for (name, effect), value in (by_name or {}).items():
            self.assertEqual(getattr(merits, name)[effect], Share(*value), (name, effect))

    def test_without_an_effect(self):
        self.expect([(NONE, NOTHING), (NONE, refused()), (NONE, named("friction"))], false_alarms=(2, 3), right_leaders=(0, 1), brier=1)

    def test_a_probability_counts_also_if_the_effect_is_not_named(self):
        self.expect([(ADHESION, refused("adhesion", confidence=0.3), 2), (SOFT, refused("adhesion", confidence=0.1)),
                     (SOFT, Answer(Verdict.calibration_suspect, ("modulus",), 0.5)), (ADHESION, named("adhesion", confidence=0.9), 2)],
                    right_leaders=(2, 3), brier=(0.49 + 0.01 + 0.01) / 3, led_by_truth=(1, 2), truth_in_group=(1, 2), named_unknown=(0, 2))

    def test_with_one_effect(self):
        self.expect([(ADHESION, named("adhesion", confidence=0.9), 2),  # right
                     (ADHESION, named("friction", "adhesion", confidence=0.6), 1.6),  # in the group
                     (ADHESION, named("friction", confidence=0.8), 5),  # wrong
                     (TILT, refused(), 3),  # detected, not named
                     (TILT, NOTHING, 2),  # missed
                     (TILT, NOTHING, 0.5),  # too small
                     (TILT, named("plate_tilt", "adhesion", "friction"), 1)],  # small and named
                    {("detected_by_effect", "plate_tilt"): (2, 4), ("named_by_effect", "plate_tilt"): (1, 4)},
                    detected=(5, 7), detected_clear=(4, 5), led_by_truth=(1, 4), truth_in_group=(2, 4), named=(2, 7),
                    group_size=(1 + 2 + 1) / 3, sharpness=(1 + 0.5) / 5, brier=(0.01 + 0.36 + 0.64 + 0) / 4)

    def test_with_two_effects(self):
        self.expect([(PAIR, named("plate_tilt")), (PAIR, named("plate_tilt", "adhesion")), (PAIR, named("friction", "adhesion")),
                     (PAIR, named("plate_tilt", "adhesion", "friction")), (PAIR, NOTHING)],
                    pair_led=(3, 5), pair_found=(1, 5), detected=(0, 0))

    def test_with_an_unknown_effect(self):
        self.expect([(SOFT, named("adhesion")), (SOFT, refused()), (STRUCK, NOTHING), (SHIFTED, SUSPECT), (SHIFTED, named("adhesion"))],
                    {("named_by_unknown", "soft_walls"): (1, 2), ("named_by_unknown", "struck"): (0, 1)},
                    named_unknown=(1, 3), named_outside_prior=(1, 2), suspected=(1, 2), right_leaders=(0, 2))


def findings(p, gain, reduction):
    """A diagnosis of two candidates."""
    return Findings(p, ["adhesion", "friction"], 2, [gain, 0.0], [Proposal([0], [1.0], [0.1], gain, 0.5, reduction=reduction)])


class ChooseLimits(unittest.TestCase):
    def test_unknown_effects_get_no_name_without_losing_known_ones(self):
        """Known effects remove 0.9 of their gap; effects of the library remove 0.65 of the gap of an unknown one."""
        cases = [LimitCase(ADHESION, findings(1e-6, 50, 0.9), 3), LimitCase(SOFT, findings(1e-6, 50, 0.65))]
        self.assertEqual(merits_with(cases, Limits()).named_unknown.hits, 1)
        limits = choose_limits(cases)
        self.assertEqual(merits_with(cases, limits).named_unknown.hits, 0)
        self.assertEqual(merits_with(cases, limits).led_by_truth.hits, 1)
        self.assertEqual(limits.false_alarm, Limits().false_alarm, "what does not matter stays")

    def test_false_alarms_are_limited(self):
        cases = [LimitCase(NONE, findings(0.03, 5, 0.9))]
        self.assertEqual(merits_with(cases, choose_limits(cases)).false_alarms.hits, 0)


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
        values = figures_of((9, NONE, NOTHING), (1, NONE, RIGHT), (2, ADHESION, NOTHING), (3, ADHESION, RIGHT),
                            (5, ADHESION, refused()))["confusion"]
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
        measured = figures_of((15, ADHESION, RIGHT), (5, NONE, RIGHT), (4, ADHESION, refused))["confidence"]["measured"]
        self.assertEqual(measured["part"], [1, 0.75])
        for found, expected in zip(measured["x"], (0.1, 0.9)):
            self.assertAlmostEqual(found, expected, 15)
        self.assertAlmostEqual(measured["interval"][1][0], 0.531, delta=5e-4)

    def test_figures_exist_only_with_data(self):
        self.assertEqual(figures_of(), {})
        self.assertEqual(list(figures_of((1, NONE, NOTHING))), ["confusion"])


if __name__ == "__main__":
    unittest.main()
