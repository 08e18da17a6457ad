"""The verdict as a function of a few numbers. decision_test.py"""
import math
import unittest
from dataclasses import replace

from mcdem.diagnosis.decision import Decision, Findings, Limits, Proposal, contenders, decide, explanation_of
from mcdem.diagnosis.diagnosis_types import Verdict

LIMITS = Limits()
CERTAIN, PAIR_MISFIT, LEAST = LIMITS.second_certain, LIMITS.pair_misfit, LIMITS.pair_reduction
GROUP_OF_3 = Limits(group=3)


def proposal(candidates, gain, misfit_p, reduction=0.96):
    """A gap reduction of nearly the whole gap."""
    return Proposal(list(candidates), [1.0] * len(candidates), [0.1] * len(candidates), gain, misfit_p, reduction=reduction)


def clear_case(proposals=None, first=None, **others):
    """Four effects, a nuisance beyond its prior, and a clear gap that the second effect explains. `first`: changes of the first
    proposal; `others`: of the findings."""
    known = [proposal([1], 50, 0.5), proposal([4], 20, 1e-6, 0.3)] if proposals is None else proposals
    if first:
        known[0] = replace(known[0], **first)
    made = Findings(1e-4, ["adhesion", "friction", "plasticity", "plate_tilt", "modulus"], 4, [10, 50, 2, 0, 20], known, placebo=0.1)
    return replace(made, **others)


def first(**changes):
    return clear_case(first=changes)


def numerics(second):
    """Three candidates as good as one another: an effect, numerics, a parameter."""
    proposals = [proposal([1], 50, 0.5), proposal([2], 48.5, 0.5), proposal([4], 49, 0.5)]
    proposals[1].confirmed_reduction = second
    return clear_case(proposals, gain=[49, 50, 48.5, 0, 49], numerics=[2])


def suspect(behind, reduction=0.9):
    """A parameter this much behind the leading effect."""
    gain = 50 - behind * LIMITS.group
    return clear_case([proposal([1], 50, 0.5), proposal([4], gain, 1e-6, reduction)], gain=[10, 50, 2, 0, gain])


def known(first, second, **changes):
    """Gains of an effect and of a parameter in real runs."""
    proposals = [proposal([1], 50, 0.5), proposal([4], 49, 0.5)]
    proposals[0].confirmed_gain, proposals[1].confirmed_gain = first, second
    for name, value in changes.items():
        setattr(proposals[1], name, value)
    return clear_case(proposals, gain=[10, 50, 2, 0, 49])


def noisy(reduction, noise, misfit_p=LIMITS.only_noise, placebo=0.1):
    return clear_case(first={"reduction": reduction, "misfit_p": misfit_p}, held_out_noise=noise, placebo=placebo)


def left(part, misfit_p):
    return first(reduction=1 - part, misfit_p=misfit_p)


def no_gain(confirmed):
    findings = clear_case()
    for one in findings.proposals:
        one.confirmed_gain = -1
    findings.proposals[0].confirmed_gain = confirmed
    return findings


def pair_with_numerics():
    return clear_case([proposal([1], 50, 1e-6, 0.7), proposal([4], 20, 1e-6, 0.3), proposal([1, 3], 80, 0.5)], numerics=[3])


def pair(single, two):
    """One effect is not sufficient, a pair is; with these changes of both."""
    known = [replace(proposal([1], 50, 1e-6, 0.7), **single), proposal([4], 20, 1e-6, 0.3),
             replace(proposal([1, 3], 58.5, PAIR_MISFIT), **two)]
    return clear_case(known, gain=[10, known[0].gain, 2, 0, 20])


def large(gain, more):
    """A large gain, and how much more a pair gains."""
    return pair({"gain": gain}, {"gain": gain + more})


MUCH_BETTER, ENOUGH = {"misfit_p": 0.5, "reduction": 0.96}, {"reduction": 0.96}
PLACE = {"left_out": 2, "rest_misfit_p": 0.3}
WITHOUT = {"reduction": 0.96, "gain": 80, "misfit_p": 1e-6}
ONE_PLACE = ENOUGH | {"left_out": 2, "rest_misfit_p": 0.1}
NEARLY = {"gain": 80, "misfit_p": 0.99 * PAIR_MISFIT, "reduction": 0.99}  # a pair that leaves more than noise
NO_PROPOSAL = {"proposals": []}
BEST_NUISANCE = [proposal([4], 60, 0.5), proposal([1], 58, 0.5)]
BOTH = {"gain": [10, 58, 2, 0, 60]}
V = Verdict

# Findings, verdict, proposal, group (None: any).
DECISIONS = {
    "one effect": (clear_case(), V.effect, 0, [1]),
    "p of no gap": (clear_case(p_value=LIMITS.false_alarm), V.no_gap, None, None),
    "p of a gap": (clear_case(p_value=0.99 * LIMITS.false_alarm), V.effect, 0, None),
    "no effect gains anything": (clear_case(**NO_PROPOSAL), V.unknown_effect, -1, []),
    "no effect and no gap": (clear_case(**NO_PROPOSAL, p_value=LIMITS.false_alarm), V.no_gap, -1, []),
    "without gain": (clear_case([proposal([1], 2, 0.5)], gain=[0, 2, -0.5, 1e-3, 0]), V.group, 0, [1, 3]),
    "a nuisance is best": (clear_case(list(BEST_NUISANCE), **BOTH), V.calibration_suspect, 0, [4, 1]),
    "the same, an effect": (clear_case(list(BEST_NUISANCE), **BOTH, effects=5), V.group, 0, [4, 1]),
    "a nuisance takes little away": (suspect(0.99, 0.3), V.effect, 0, [1]),
    "a nuisance is nearly as good": (suspect(0.99), V.calibration_suspect, 1, [4, 1]),
    "a nuisance is behind": (suspect(1.01), V.effect, 0, [1]),
    "numerics are first": (numerics(None), V.not_converged, 1, None),
    "runs of numerics take little away": (numerics(0.2), V.calibration_suspect, 2, None),
    "numerics far behind": (clear_case(numerics=[2]), V.effect, 0, [1]),
    "numerics in a pair": (pair_with_numerics(), V.not_converged, 2, [3, 1]),
    "numerics leave a gap": (clear_case(first={"reduction": 0.7, "misfit_p": 1e-9}, numerics=[1]), V.not_converged, 0, [1]),
    "runs without gain": (no_gain(-1), V.unknown_effect, None, None),
    "runs with a small gain": (no_gain(1), V.effect, 0, None),
    "takes too little": (first(reduction=LIMITS.reduction - 0.01), V.unknown_effect, 0, [1]),
    "takes enough": (first(reduction=LIMITS.reduction), V.effect, 0, None),
    "real runs take too little": (first(confirmed_reduction=0.5), V.unknown_effect, 0, None),
    "placebo nearly as good": (clear_case(placebo=0.96 - 0.99 * LIMITS.over_placebo), V.unknown_effect, 0, None),
    "placebo worse": (clear_case(placebo=0.96 - 1.01 * LIMITS.over_placebo), V.effect, 0, None),
    # The reduction of a small gap in held-out data is uncertain by its noise.
    "well measured": (noisy(0.45, 0), V.unknown_effect, 0, None),
    "badly measured": (noisy(0.45, 0.2), V.effect, 0, None),
    "less than the noise allows": (noisy(0.39, 0.2), V.unknown_effect, 0, None),
    "much noise": (noisy(0.39, 0.45), V.effect, 0, None),
    "whatever the noise": (noisy(0.99 * LIMITS.min_reduction, 0.45), V.unknown_effect, 0, None),
    "a placebo does nearly as much": (noisy(0.39, 0.45, placebo=0.3), V.unknown_effect, 0, None),
    "more than noise is left": (noisy(0.39, 0.45, 0.99 * LIMITS.only_noise, 0), V.unknown_effect, 0, None),
    # An effect that removes most of a gap, but leaves a clear part of it, is not the cause.
    "a significant part": (left(1.01 * LIMITS.remainder, 0.99 * LIMITS.misfit), V.unknown_effect, 0, None),
    "an insignificant part": (left(1.01 * LIMITS.remainder, 1.01 * LIMITS.misfit), V.effect, 0, None),
    "a smaller part": (left(0.99 * LIMITS.remainder, LIMITS.another_form), V.effect, 0, None),
    "another form": (left(0.99 * LIMITS.remainder, 0.99 * LIMITS.another_form), V.unknown_effect, 0, None),
    "a small part of another form": (left(0.99 * LIMITS.form_remainder, 0.99 * LIMITS.another_form), V.effect, 0, None),
    "real runs prefer the parameter": (known(30, 44), V.calibration_suspect, 1, [4]),
    "its runs take little away": (known(30, 44, confirmed_reduction=0.2), V.unknown_effect, 1, None),
    "only its signature does": (known(30, 44, reduction=0.2, confirmed_reduction=0.9), V.calibration_suspect, 1, None),
    "a pair": (pair({}, {}), V.effect, 2, [1, 3]),
    "one effect is enough": (pair({"misfit_p": 0.5}, {}), V.effect, 0, None),
    "8 more are needed of a pair": (pair({}, {"gain": 57.9}), V.unknown_effect, 0, None),
    "a pair takes enough away": (pair({}, {"reduction": LEAST}), V.effect, 2, [1, 3]),
    "a pair takes too little away": (pair({}, {"reduction": 0.99 * LEAST}), V.unknown_effect, 0, None),
    "neither takes enough away": (pair({"reduction": 0.5}, {"reduction": 0.5}), V.unknown_effect, 0, None),
    "a large gain needs a large second one": (large(1000, 990 * LIMITS.second_share), V.unknown_effect, 0, None),
    "and this is one": (large(1000, 1010 * LIMITS.second_share), V.effect, 2, [1, 3]),
    "never more than this": (large(1e5, 0.99 * CERTAIN), V.unknown_effect, 0, None),
    "is needed": (large(1e5, 1.01 * CERTAIN), V.effect, 2, [1, 3]),
    # One effect leaves only noise, but two describe the data much better.
    "much better": (pair(MUCH_BETTER, {"gain": 50 + 1.01 * CERTAIN, "misfit_p": 0.9}), V.effect, 2, [1, 3]),
    "better": (pair(MUCH_BETTER, {"gain": 50 + 0.99 * CERTAIN, "misfit_p": 0.9}), V.effect, 0, None),
    # A pair that leaves more than noise has another cause, or a third one.
    "a pair leaves more than noise": (pair({}, NEARLY), V.unknown_effect, 0, None),
    "and one effect takes too little": (pair({"reduction": 0.69}, NEARLY), V.unknown_effect, 0, None),
    "a pair leaves only noise": (pair({}, NEARLY | {"misfit_p": 1.01 * PAIR_MISFIT}), V.effect, 2, [1, 3]),
    # A place that is left out for a pair may be left out for one effect.
    "a place is left out for the pair": (pair(ENOUGH, WITHOUT | PLACE), V.effect, 2, [1, 3]),
    "and for one effect": (pair(ONE_PLACE, WITHOUT | PLACE), V.effect, 0, None),
    "two effects explain all places": (pair(ONE_PLACE, WITHOUT | {"misfit_p": 0.3}), V.effect, 2, [1, 3]),
}


def confidence(findings):
    return sum(decide(findings, LIMITS).confidence)


class Verdicts(unittest.TestCase):
    def test_table(self):
        for name, (findings, verdict, index, group) in DECISIONS.items():
            with self.subTest(name):
                d = decide(findings, LIMITS)
                self.assertIs(d.verdict, verdict)
                self.assertIn(index, (d.proposal, None))
                self.assertIn(group, (d.group, None))
                self.assertEqual(decide(findings, LIMITS), d)  # a function of the findings

    def test_of_a_curve_alone_only_groups_are_named(self):
        limits = replace(LIMITS, names_alone=False)
        one = decide(clear_case(), limits)
        self.assertEqual((one.verdict, one.group), (Verdict.unknown_effect, [1]))
        self.assertEqual(sum(one.confidence), limits.right_refused)
        self.assertEqual(explanation_of(clear_case(), one, limits).needed, 1 + limits.over_placebo)  # no reduction suffices
        several = clear_case(gain=[49.5, 50, 2, 0, 20])
        self.assertEqual(decide(several, limits), decide(several, LIMITS))
        self.assertEqual(decide(several, limits).verdict, Verdict.group)

    def test_group_contains_effects_within_the_margin_of_the_gain(self):
        d = decide(clear_case(gain=[47.5, 50, 48.5, 46.9, 20]), GROUP_OF_3)
        self.assertEqual((d.verdict, d.group), (Verdict.group, [1, 2, 0]))
        self.assertAlmostEqual(sum(d.confidence), LIMITS.right_above, 12)
        self.assertAlmostEqual(d.confidence[2] / d.confidence[1], math.exp(-1.5), 12)
        self.assertAlmostEqual(d.confidence[0] / d.confidence[1], math.exp(-2.5), 12)

    def test_margin_grows_with_the_gain_of_the_best(self):
        limits = Limits(group=3, group_share=0.04)  # 20 of 500
        d = decide(clear_case([proposal([1], 500, 0.5)], gain=[481, 500, 479, 0, 0]), limits)
        self.assertEqual(d.group, [1, 0])
        self.assertAlmostEqual(d.confidence[0] / d.confidence[1], math.exp(-19 * 3.0 / 20), 12)

    def test_effects_without_confirmation_keep_their_distance_by_signatures(self):
        # Half of the best effect's gain remained in runs; adhesion was not simulated.
        changes = {"first": {"confirmed_gain": 25}}
        d = decide(clear_case(gain=[49, 50, 2, 0, 20], **changes), LIMITS)
        self.assertEqual(d.group, [1, 0])
        self.assertAlmostEqual(d.confidence[0] / d.confidence[1], math.exp(-1.0), 12)
        self.assertEqual(decide(clear_case(gain=[30, 50, 2, 0, 20], **changes), LIMITS).group, [1])


    def test_contenders_are_what_the_decision_depends_on(self):
        for findings, expected in ((pair({}, {}), [0, 2]), (pair({}, {"gain": 57.9}), [0]), (clear_case([proposal([1, 3], 80, 0.5)]), [])):
            self.assertEqual(contenders(findings, LIMITS), expected)


class Confidence(unittest.TestCase):
    def test_both_effects_of_a_pair_are_probable(self):
        confidence = decide(pair({}, {}), LIMITS).confidence
        self.assertGreater(confidence[1], 0.8)
        self.assertEqual((confidence[3], confidence[0]), (confidence[1], 0))

    def test_is_the_measured_success_rate(self):
        certain, none = LIMITS.reduction + LIMITS.certain_above, LIMITS.reduction - LIMITS.doubt_below
        quarter = 0.25 * LIMITS.right_above + 0.75 * LIMITS.right_below
        another_form = LIMITS.another_form
        for changes, expected in [
            ({"reduction": 1}, LIMITS.right_above),
            ({"reduction": certain}, LIMITS.right_above),
            ({"reduction": none}, LIMITS.right_below),
            ({"reduction": 0.25 * certain + 0.75 * none}, quarter),
            ({"reduction": LIMITS.reduction - 0.01}, LIMITS.right_refused),  # not named
            ({"reduction": -1}, LIMITS.right_below),
            ({"reduction": -1, "confirmed_reduction": 0.96}, LIMITS.right_above),  # real runs count
            ({"misfit_p": 2 * another_form}, LIMITS.right_above),
            ({"misfit_p": another_form / 2}, LIMITS.right_form),
            ({"reduction": 1 - 1.01 * LIMITS.remainder, "misfit_p": 0.99 * LIMITS.misfit}, LIMITS.right_refused),
        ]:
            with self.subTest(changes):
                self.assertAlmostEqual(confidence(first(**changes)), expected, 12)
        self.assertAlmostEqual(confidence(clear_case(placebo=1 + LIMITS.doubt_below)), LIMITS.right_below, 12)
        self.assertGreater(confidence(first(reduction=LIMITS.reduction)), LIMITS.right_refused)
        self.assertLess(confidence(noisy(0.45, 0.2)), LIMITS.right_above - 0.1)
        self.assertGreater(decide(clear_case(), LIMITS).confidence[1], 0.99 * LIMITS.right_above)


def explained(findings):
    return explanation_of(findings, decide(findings, LIMITS), LIMITS)


class Explanations(unittest.TestCase):
    def test_needed_reduction(self):
        for findings, needed in [(noisy(0.45, 0.2), LIMITS.reduction - 0.2), (left(0.31, 1e-4), 1 - LIMITS.remainder),
                                 (left(0.31, 2e-3), LIMITS.reduction), (clear_case(placebo=0.7), 0.7 + LIMITS.over_placebo),
                                 (clear_case(first={"misfit_p": 1e-9}, numerics=[1]), LIMITS.reduction)]:
            self.assertAlmostEqual(explained(findings).needed, needed, 12)

    def test_a_small_remainder_is_stated_and_does_not_change_the_verdict(self):
        findings = first(confirmed_reduction=0.97, confirmed_misfit_p=1e-30)
        self.assertIs(decide(findings, LIMITS).verdict, Verdict.effect)
        e = explained(findings)
        self.assertEqual((e.reduction, e.leaves_more_than_noise, e.simulated, e.placebo, e.needed, e.remainder_p),
                         (0.97, True, True, 0.1, 1 - LIMITS.form_remainder, 1e-30))
        self.assertAlmostEqual(e.remainder, 0.03, 12)
        self.assertIsNone(explained(clear_case(p_value=1)))  # no gap, nothing to explain
        self.assertIsNone(explanation_of(findings, Decision(Verdict.unknown_effect), LIMITS))


if __name__ == "__main__":
    unittest.main()
