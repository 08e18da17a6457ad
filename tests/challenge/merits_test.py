"""Figures of merit compared with hand counts, and the choice of limits. merits_test.py"""
import unittest

from mcdem.challenge.case import CaseKind, ChallengeCase, Hidden
from mcdem.challenge.limits import LimitCase, choose_limits, merits_with
from mcdem.challenge.merits import Answer, ScoredCase, Share, merits_of
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


if __name__ == "__main__":
    unittest.main()
