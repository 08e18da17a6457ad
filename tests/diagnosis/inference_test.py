"""The loop of a diagnosis with simulations of a known world. inference_test.py"""
import unittest

import numpy as np
from synthetic_evidence import SyntheticWorld

from mcdem.diagnosis.builder import DiagnosisBuilder
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_json import diagnosis_json
from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.diagnosis.inference import MAX_ROUNDS, Inference

HIDDEN, CURVATURE = 5.0, 0.04
REPLICATES = 16


class World:
    """The effect bends, which its signature does not know: HIDDEN appears to be a fifth larger."""

    def __init__(self, amplitude=HIDDEN, seed=3):
        world = SyntheticWorld(6, seed)
        self.evidence = world.evidence(1, 32)
        self.pattern, other, self.modulus = world.pattern(1), world.pattern(1), world.pattern(0.5)
        world.add_effect(self.evidence, "adhesion", self.pattern)
        world.add_effect(self.evidence, "friction", other)
        world.add_nuisance(self.evidence, "modulus", self.modulus, 1)
        self.effects = [lambda a: (a + CURVATURE * a * abs(a)) * self.pattern, lambda a: a * other, lambda a: a * self.modulus]
        self.evidence.observed += self.effects[0](amplitude)
        self.noise = [world.noise() for _ in range(REPLICATES)]
        self.purposes = []  # of all runs

    def run(self, builder, proposal, fit):
        shift = fit.nuisances[0] * self.modulus
        for candidate, amplitude in zip(builder.findings.proposals[proposal].candidates, fit.amplitudes):
            shift = shift + self.effects[candidate](amplitude)
        return self.evidence.baseline.mean(axis=0) + shift + self.noise

    def simulate(self, builder, runs):
        self.purposes.append(runs.purpose)
        return [self.run(builder, k, fit) for k, fit in runs.fits]


def completed(world, confirmations=REPLICATES):
    inference = Inference(world.evidence, Limits(), confirmations)
    while runs := inference.next_runs():
        inference.add(world.simulate(inference.builder, runs))
    return inference.builder


class Loop(unittest.TestCase):
    def test_the_hidden_amplitude_is_found(self):
        world = World()
        by_signatures = DiagnosisBuilder(world.evidence, Limits()).diagnosis().causes[0]
        d = completed(world).diagnosis()
        cause, = d.causes
        self.assertEqual((d.verdict, cause.effect), (Verdict.effect, "adhesion"))
        self.assertLess(abs(cause.amplitude - HIDDEN), 0.5 * abs(by_signatures.amplitude - HIDDEN))
        self.assertTrue(d.explanation.simulated)
        self.assertGreater(d.explanation.reduction, 0.9)
        self.assertGreater(cause.confirmed_score, 0)

    def test_purposes_are_in_order(self):
        world = World()
        completed(world)
        rounds = world.purposes.count("confirmation")
        self.assertTrue(1 <= rounds <= MAX_ROUNDS, rounds)
        held_out = len(world.purposes) - rounds
        self.assertGreater(held_out, 0)
        self.assertEqual(world.purposes, ["confirmation"] * rounds + ["held-out confirmation"] * held_out)

    def test_steps_are_those_of_the_builder(self):
        world = World()
        builder = DiagnosisBuilder(world.evidence, Limits())
        tried = list(range(len(builder.findings.proposals)))
        for _ in range(MAX_ROUNDS):
            for k, runs in [(k, world.run(builder, k, builder.whole_fit(k))) for k in tried]:
                builder.confirm(k, runs)
            tried = [k for k in tried if builder.refit(k)]
        while (k := builder.wants_held_out()) is not None:
            builder.confirm_held_out(k, world.run(builder, k, builder.part_fit(k)))
        self.assertEqual(diagnosis_json(completed(World()).diagnosis()), diagnosis_json(builder.diagnosis()))

    def test_nothing_is_run_without_a_gap_or_confirmations(self):
        for world, confirmations in ((World(amplitude=0), REPLICATES), (World(), 0)):
            builder = completed(world, confirmations)
            self.assertEqual(world.purposes, [])
            self.assertEqual(builder.decision.verdict == Verdict.no_gap, confirmations > 0)

    def test_runs_are_the_same_until_results_are_added(self):
        inference = Inference(World().evidence, Limits(), REPLICATES)
        first, second = inference.next_runs(), inference.next_runs()
        self.assertEqual([k for k, _ in first.fits], list(range(len(inference.builder.findings.proposals))))
        self.assertEqual([(k, fit.amplitudes) for k, fit in first.fits], [(k, fit.amplitudes) for k, fit in second.fits])

    def test_runs_that_fail_are_repeated_with_half_the_amplitude(self):
        world = World()
        inference = Inference(world.evidence, Limits(), REPLICATES)
        amplitudes = []
        while (runs := inference.next_runs()) and runs.purpose == "confirmation":
            amplitudes.append(runs.fits[0][1].amplitudes[0])
            inference.add([np.full((REPLICATES, len(world.pattern)), np.nan) for _ in runs.fits])
        np.testing.assert_allclose(amplitudes, amplitudes[0] / 2.0 ** np.arange(MAX_ROUNDS))

    def test_every_fit_needs_results(self):
        inference = Inference(World().evidence, Limits(), REPLICATES)
        with self.assertRaises(ValueError):
            inference.add([])


if __name__ == "__main__":
    unittest.main()
