"""The loop of a diagnosis with simulations of a known case. inference_test.py"""
import unittest

import numpy as np
import synthetic_evidence

from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.diagnosis.inference import MAX_ROUNDS, Inference

HIDDEN, CURVATURE = 5.0, 0.04
REPLICATES = 16


class Case(synthetic_evidence.Case):
    """The effect bends, which its signature does not know: HIDDEN appears to be a fifth larger."""

    def __init__(self, amplitude=HIDDEN):
        super().__init__()
        self.evidence.observed += self.shift(0, amplitude)
        self.noise = [self.world.noise() for _ in range(REPLICATES)]
        self.purposes = []  # of all runs

    def shift(self, candidate, amplitude):
        bent = CURVATURE * amplitude * abs(amplitude) if candidate == 0 else 0
        return (amplitude + bent) * (self.effects + self.parameters)[candidate].linear

    def run(self, builder, proposal, fit):
        shift = self.shift(2, fit.nuisances[0])
        for candidate, amplitude in zip(builder.findings.proposals[proposal].candidates, fit.amplitudes):
            shift = shift + self.shift(candidate, amplitude)
        return self.evidence.baseline.mean(axis=0) + shift + self.noise

    def simulate(self, builder, runs):
        self.purposes.append(runs.purpose)
        return [self.run(builder, k, fit) for k, fit in runs.fits]


def completed(case, confirmations=REPLICATES):
    inference = Inference(case.evidence, Limits(), confirmations)
    while runs := inference.next_runs():
        inference.add(case.simulate(inference.builder, runs))
    return inference.builder


class Loop(unittest.TestCase):
    def test_the_hidden_amplitude_is_found(self):
        case = Case()
        by_signatures = case.diagnosis().causes[0]
        d = completed(case).diagnosis()
        cause, = d.causes
        self.assertEqual((d.verdict, cause.effect), (Verdict.effect, "adhesion"))
        self.assertLess(abs(cause.amplitude - HIDDEN), 0.5 * abs(by_signatures.amplitude - HIDDEN))
        self.assertTrue(d.explanation.simulated)
        self.assertGreater(d.explanation.reduction, 0.9)
        self.assertGreater(cause.confirmed_score, 0)

    def test_purposes_are_in_order(self):
        case = Case()
        completed(case)
        rounds = case.purposes.count("confirmation")
        self.assertTrue(1 <= rounds <= MAX_ROUNDS, rounds)
        held_out = len(case.purposes) - rounds
        self.assertGreater(held_out, 0)
        self.assertEqual(case.purposes, ["confirmation"] * rounds + ["held-out confirmation"] * held_out)

    def test_nothing_is_run_without_a_gap_or_confirmations(self):
        for case, confirmations in ((Case(amplitude=0), REPLICATES), (Case(), 0)):
            builder = completed(case, confirmations)
            self.assertEqual(case.purposes, [])
            self.assertEqual(builder.decision.verdict == Verdict.no_gap, confirmations > 0)

    def test_runs_are_the_same_until_results_are_added(self):
        inference = Inference(Case().evidence, Limits(), REPLICATES)
        first, second = inference.next_runs(), inference.next_runs()
        self.assertEqual([k for k, _ in first.fits], list(range(len(inference.builder.findings.proposals))))
        self.assertEqual([(k, fit.amplitudes) for k, fit in first.fits], [(k, fit.amplitudes) for k, fit in second.fits])

    def test_runs_that_fail_are_repeated_with_half_the_amplitude(self):
        case = Case()
        inference = Inference(case.evidence, Limits(), REPLICATES)
        amplitudes = []
        while (runs := inference.next_runs()) and runs.purpose == "confirmation":
            amplitudes.append(runs.fits[0][1].amplitudes[0])
            inference.add([np.full((REPLICATES, len(case.evidence.observed)), np.nan) for _ in runs.fits])
        np.testing.assert_allclose(amplitudes, amplitudes[0] / 2.0 ** np.arange(MAX_ROUNDS))

    def test_every_fit_needs_results(self):
        inference = Inference(Case().evidence, Limits(), REPLICATES)
        with self.assertRaises(ValueError):
            inference.add([])


if __name__ == "__main__":
    unittest.main()
