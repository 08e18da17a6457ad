"""When two effects are named instead of one. pair_decision_test.py"""
import unittest

from decision_cases import clear_case, proposal

from mcdem.diagnosis.decision import Limits, contenders, decide
from mcdem.diagnosis.diagnosis_types import Verdict

LIMITS = Limits()
CERTAIN, MISFIT, LEAST = LIMITS.second_certain, LIMITS.pair_misfit, LIMITS.pair_reduction
SINGLE, PAIR = {"misfit_p": 1e-6, "reduction": 0.7}, {"gain": 58.5, "misfit_p": MISFIT}
PLACE = {"left_out": 2, "rest_misfit_p": 0.3}
WITHOUT = {"reduction": 0.96, "gain": 80, "misfit_p": 1e-6}


def case(single, pair):
    """One effect is not sufficient, a pair is; with these changes of both."""
    known = [proposal([1], 50, 0.5), proposal([4], 20, 1e-6, 0.3), proposal([1, 3], 80, 0.5)]
    for one, changes in ((known[0], SINGLE | single), (known[2], PAIR | pair)):
        for name, value in changes.items():
            setattr(one, name, value)
    return clear_case(known, gain=[10, known[0].gain, 2, 0, 20])


def large(gain, more):
    return {"gain": gain}, {"gain": gain + more}


# Changes of the single effect and of the pair; whether the pair is chosen.
CASES = {
    "one effect is not sufficient": ({}, {}, True),
    "one effect is enough": ({"misfit_p": 0.5}, {}, False),
    "8 more are needed": ({}, {"gain": 57.9}, False),
    "takes enough away": ({}, {"reduction": LEAST}, True),
    "takes too little away": ({}, {"reduction": 0.99 * LEAST}, False),
    "a large gain needs a large second one": (*large(1000, 990 * LIMITS.second_share), False),
    "and this is one": (*large(1000, 1010 * LIMITS.second_share), True),
    "never more than this": (*large(1e5, 0.99 * CERTAIN), False),
    "is needed": (*large(1e5, 1.01 * CERTAIN), True),
    # One effect leaves only noise, but two describe the data much better.
    "much better": ({"misfit_p": 0.5, "reduction": 0.96}, {"gain": 50 + 1.01 * CERTAIN, "misfit_p": 0.9}, True),
    "better": ({"misfit_p": 0.5, "reduction": 0.96}, {"gain": 50 + 0.99 * CERTAIN, "misfit_p": 0.9}, False),
    # A pair that leaves more than noise has another cause, or a third one.
    "more than noise": ({}, {"gain": 80, "misfit_p": 0.99 * MISFIT, "reduction": 0.99}, False),
    "only noise": ({}, {"gain": 80, "misfit_p": 1.01 * MISFIT, "reduction": 0.99}, True),
    # A place that is left out for a pair may be left out for one effect.
    "a place is left out for the pair": ({"reduction": 0.96}, WITHOUT | PLACE, True),
    "and for one effect": ({"reduction": 0.96, "left_out": 2, "rest_misfit_p": 0.1}, WITHOUT | PLACE, False),
    "two effects explain all places": ({"reduction": 0.96, "left_out": 2, "rest_misfit_p": 0.1}, WITHOUT | {"misfit_p": 0.3}, True),
}


class PairDecision(unittest.TestCase):
    def test_table(self):
        for name, (single, pair, chosen) in CASES.items():
            with self.subTest(name):
                d = decide(case(single, pair), LIMITS)
                self.assertEqual(d.proposal, 2 if chosen else 0)
                if chosen:
                    self.assertEqual((d.verdict, d.group), (Verdict.effect, [1, 3]))

    def test_both_effects_are_probable(self):
        d = decide(case({}, {}), LIMITS)
        self.assertGreater(d.confidence[1], 0.8)
        self.assertEqual((d.confidence[3], d.confidence[0]), (d.confidence[1], 0))

    def test_contenders_are_what_the_decision_depends_on(self):
        self.assertEqual(contenders(case({}, {}), LIMITS), [0, 2])
        self.assertEqual(contenders(case({}, {"gain": 57.9}), LIMITS), [0])
        self.assertEqual(contenders(clear_case(proposals=[proposal([1, 3], 80, 0.5)]), LIMITS), [])

    def test_unknown_if_neither_takes_enough_away(self):
        self.assertIs(decide(case({"reduction": 0.5}, {"reduction": 0.5}), LIMITS).verdict, Verdict.unknown_effect)
        self.assertIs(decide(case({"reduction": 0.69}, {"gain": 80, "misfit_p": 0.99 * MISFIT, "reduction": 0.99}), LIMITS).verdict,
                      Verdict.unknown_effect)


if __name__ == "__main__":
    unittest.main()
