"""Proposed explanations of a planted gap, and their change by confirmation runs. proposals_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
import synthetic_evidence

from mcdem.diagnosis.decision import Proposal
from mcdem.diagnosis.effect_fit import EffectFit
from mcdem.diagnosis.gap_tests import gap_statistics
from mcdem.diagnosis.proposals import confirm, propose

ADHESION, FRICTION, PLASTICITY, TILT = range(4)


class Case(synthetic_evidence.Case):
    def __init__(self, *amplitudes, seed=1):
        super().__init__(*amplitudes, effects=("adhesion", "friction", "plasticity", "plate_tilt"), known=4, seed=seed)
        self.linear = [signature.linear for signature in self.effects]

    def proposals(self, statistics=None):
        return propose(self.space, self.data, self.null, statistics or self.statistics)

    def singles(self, statistics):
        return [one.candidates[0] for one in self.proposals(statistics) if not one.is_pair()]

    def confirmed(self, proposal, runs, nuisance=0.0):
        """The proposal with these runs, and the next step."""
        confirmed = replace(proposal)
        step = confirm(confirmed, self.data, self.null, [], 0.001, self.evidence.observed, np.array([nuisance]), runs)
        return confirmed, step


def scored(*scores):
    return [EffectFit([1], [0.1], score) for score in scores]


class Proposals(unittest.TestCase):
    def test_one_effect_explains_the_gap(self):
        case = Case(0, 4)
        first, *others = case.proposals()
        self.assertEqual(first.candidates, [FRICTION])
        self.assertAlmostEqual(first.amplitudes[0], 4, delta=4 * first.errors[0])
        self.assertEqual(first.gain, case.statistics.directed)
        self.assertGreater(first.misfit_p, 0.01)
        self.assertFalse(any(proposal.is_pair() for proposal in others))

    def test_two_effects_explain_the_gap_together(self):
        case = Case(0, 4, 0, -3)
        first, *_, pair = case.proposals()
        self.assertEqual(set(pair.candidates), {FRICTION, TILT})
        for candidate, amplitude, error in zip(pair.candidates, pair.amplitudes, pair.errors):
            self.assertAlmostEqual(amplitude, 4 if candidate == FRICTION else -3, delta=4 * error)
        self.assertGreater(pair.misfit_p, 0.01)
        self.assertLess(first.misfit_p, 0.003)
        left = case.data.gap - case.data.explained(pair.candidates, pair.amplitudes)
        np.testing.assert_allclose(pair.gain, 0.5 * (case.statistics.omnibus - (case.space.whiten(left) ** 2).sum()), 1e-6)

    def test_two_effects_neither_of_which_is_best_alone(self):
        # They cancel most of each other, so a third effect with the signature of the remainder is the best single one.
        case = Case()
        large, small, decoy = (case.world.pattern(size) for size in (3, 0.5, 0.2))
        case.linear[FRICTION][:], case.linear[TILT][:], case.linear[ADHESION][:] = large, small - large, small + decoy
        case.data.gap = 8 * small
        statistics = gap_statistics(case.space, case.data, case.data.gap)
        self.assertEqual(statistics.best, ADHESION)
        pair = case.proposals(statistics)[-1]
        self.assertEqual(set(pair.candidates), {FRICTION, TILT})
        for amplitude, error in zip(pair.amplitudes, pair.errors):
            self.assertAlmostEqual(amplitude, 8, delta=4 * error)

    def test_a_nuisance_with_gain_is_always_confirmed(self):
        case = Case(4)
        fits = scored(50, 49, 48, 47)
        for behind, singles in ((10, [0, 1, 2, 4]), (49, [0, 1, 2, 4]), (51, [0, 1, 2]), (0.5, [0, 4, 1])):  # 51: without gain
            statistics = replace(case.statistics, fits=fits + scored(50 - behind), directed=50)
            self.assertEqual(case.singles(statistics), singles)

    def test_the_nearest_numerics_and_the_nearest_that_lacks_bins_are_tried(self):
        case = Case(4)
        gain = case.statistics.directed
        fits = scored(gain, gain - 1, gain - 2, gain - 3, 0)
        statistics = replace(case.statistics, fits=fits)
        self.assertEqual(case.singles(statistics), [0, 1, 2])
        tilt = case.data.candidates[TILT]
        case.data.candidates[TILT] = replace(tilt, signature=replace(tilt.signature, name="time_step"))
        self.assertEqual(case.singles(statistics), [0, 1, 2, TILT])
        case.data.candidates[TILT] = replace(tilt, lacking=np.array([3]))
        far = replace(statistics, fits=[*fits[:3], replace(fits[3], score=1e-3), fits[4]])
        for given, singles in ((statistics, [0, 1, 2, TILT]), (far, [0, 1, 2])):
            self.assertEqual(case.singles(given), singles)

    def test_explanation_by_signatures_is_found(self):
        case = Case()
        explained = case.data.explained([ADHESION, PLASTICITY], [1.5, -2.0])
        np.testing.assert_allclose(explained, 1.5 * case.linear[ADHESION] - 2 * case.linear[PLASTICITY], atol=1e-12)

    def test_effects_without_gain_are_not_proposed(self):
        case = Case()
        nothing = replace(case.statistics, fits=scored(0, 0, 0, 0, 0), directed=0)
        self.assertEqual(case.proposals(nothing), [])


class Confirmation(unittest.TestCase):
    def setUp(self):
        self.case = Case(0, 4, seed=2)
        self.first = self.case.proposals()[0]

    def test_runs_that_agree_with_the_data(self):
        confirmed, step = self.case.confirmed(self.first, self.case.runs(4 * self.case.linear[FRICTION]))
        self.assertEqual(len(step), 2)  # the modulus, then the amplitude
        self.assertGreater(confirmed.confirmed_misfit_p, 0.01)
        self.assertAlmostEqual(confirmed.confirmed_gain, confirmed.gain, delta=0.25 * confirmed.gain)

    def test_runs_that_do_not_agree_with_the_data(self):
        confirmed, _ = self.case.confirmed(self.first, self.case.runs(4 * self.case.linear[PLASTICITY]))
        self.assertLess(confirmed.confirmed_misfit_p, 1e-3)
        self.assertLess(confirmed.confirmed_gain, 0.6 * confirmed.gain)

    def test_nuisance_shifts_are_penalised_by_their_prior(self):
        # The runs explain the data equally well with a modulus three sigmas off.
        runs = self.case.runs(4 * self.case.linear[FRICTION])
        near, far = (self.case.confirmed(self.first, runs, shift)[0].confirmed_gain for shift in (0, 3))
        self.assertAlmostEqual(near - far, 4.5, 9)

    def test_scatter_that_the_data_do_not_show_is_penalised(self):
        # An effect with a large scatter reduces chi-square.
        case = Case()
        scattering = case.effects[FRICTION]
        scattering.slopes = math.sqrt(0.5) * np.array([[1.0], [-1.0]]) * np.ones(len(scattering.linear))
        self.assertAlmostEqual(scattering.spread()[0], 1, 12)
        confirmed, _ = case.confirmed(Proposal([FRICTION], [5.0], [0.1]), case.runs())
        self.assertGreater(confirmed.confirmed_misfit_p, 0.5)
        self.assertLess(confirmed.confirmed_gain, -10)

    def test_step_is_the_error_of_the_amplitude(self):
        _, step = self.case.confirmed(self.first, self.case.runs(3 * self.case.linear[FRICTION], 200))
        self.assertAlmostEqual(step[1], 1, delta=0.6)  # one sigma of the amplitude is 0.2, and the prior has some influence

    def test_failed_runs_are_excluded(self):
        failed = self.case.runs(4 * self.case.linear[FRICTION], 4)
        whole = failed[[0, 1, 3]]
        failed[2, self.case.data.bins[-1]] = np.nan
        (a, step), (b, other) = (self.case.confirmed(self.first, runs) for runs in (failed, whole))
        self.assertEqual((a.confirmed_gain, a.confirmed_misfit_p), (b.confirmed_gain, b.confirmed_misfit_p))
        np.testing.assert_array_equal(step, other)

    def test_requires_more_than_one_run(self):
        failed = self.case.runs(number=4)
        failed[1:] = np.nan
        confirmed, step = self.case.confirmed(self.first, failed)
        self.assertIsNone(step)
        self.assertIsNone(confirmed.confirmed_gain)


if __name__ == "__main__":
    unittest.main()
