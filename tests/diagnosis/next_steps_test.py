"""Recommended next measurements, predicted from the signatures. next_steps_test.py"""
import copy
import math
import unittest

import numpy as np
from synthetic_evidence import SyntheticWorld

from mcdem.diagnosis.builder import DiagnosisBuilder
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.diagnosis.next_steps import ProtocolRuns


def two_alike(world, apart, amplitude):
    """Two effects whose signatures differ by `apart`; the first one is planted."""
    evidence = world.evidence(1, 32)
    shape = world.pattern(1)
    world.add_effect(evidence, "viscoelasticity", shape)
    world.add_effect(evidence, "plasticity", shape + apart * world.pattern(1))
    world.add_nuisance(evidence, "modulus", world.pattern(0.5), 1)
    evidence.observed = evidence.observed + amplitude * shape
    return evidence


def protocol_runs(world, apart):
    """Eight runs of each effect. In a bin that the diagnosis does not have, their scatter is 1 and they differ by `apart`."""
    leader, rival = (np.array([world.noise(0.3) for _ in range(8)]) for _ in range(2))
    relaxation = world.known + 3
    leader[:, relaxation] = math.sqrt(7 / 8) * np.tile([1, -1], 4)
    rival[:, relaxation] = leader[:, relaxation] + apart
    return ProtocolRuns(leader, rival)


def margin(gain):
    return max(Limits().group, Limits().group_share * gain)


class NextSteps(unittest.TestCase):
    def builder(self, evidence, verdict):
        builder = DiagnosisBuilder(evidence, Limits())
        self.assertEqual(builder.decision.verdict, verdict)
        return builder

    def texts(self, evidence, verdict):
        return [step.what for step in self.builder(evidence, verdict).diagnosis().next]

    def assert_one_has(self, texts, *parts):
        self.assertTrue(any(all(part in text for part in parts) for text in texts), texts)

    def test_they_distinguish_the_members_of_a_group(self):
        diagnosis = self.builder(two_alike(SyntheticWorld(6, 3), 0.05, 4), Verdict.group).diagnosis()
        for cause in diagnosis.ranking:
            self.assertEqual(len(cause.group), 1 if cause.effect == "modulus" else 2, cause.effect)
        self.assert_one_has([step.what for step in diagnosis.next], "3 more packings", "to distinguish viscoelasticity from plasticity")
        powers = [step.power or 0 for step in diagnosis.next]
        self.assertEqual(powers, sorted(powers, reverse=True))  # the most useful first
        # At twice the difference, more of such experiments would distinguish them.
        other = DiagnosisBuilder(two_alike(SyntheticWorld(6, 3), 0.1, 4), Limits())
        if other.decision.verdict == Verdict.group:
            self.assertGreater(other.diagnosis().next[0].power, powers[0])

    def test_predicted_power_is_the_fraction_of_experiments_that_decide(self):
        predicted, told = [], []
        for seed in range(900, 940):
            world = SyntheticWorld(6, seed)
            evidence = two_alike(world, 0.12, 4)
            builder = DiagnosisBuilder(evidence, Limits())
            if builder.decision.verdict != Verdict.group:
                continue
            for step in builder.diagnosis().next:
                if "3 more packings" in step.what:
                    predicted.append(step.power)
                    four = copy.deepcopy(evidence)  # the mean of four experiments has half the scatter
                    four.library.baseline *= 0.5
                    four.baseline = four.library.baseline
                    four.observed = four.baseline.mean(axis=0) + 4 * evidence.library.effects[0].linear + 0.5 * world.noise()
                    gain = DiagnosisBuilder(four, Limits()).findings.gain
                    told.append(gain[0] - gain[1] > margin(gain[0]))
        self.assertGreater(len(predicted), 10)
        self.assertAlmostEqual(np.mean(told), np.mean(predicted), delta=0.2)

    def test_power_of_a_protocol_follows_from_runs_of_both_effects(self):
        # A difference of n sigmas decides with the probability that a normal number exceeds margin / n - n / 2. The noise of the runs in
        # the other bins changes the mean of a few draws by some per cent.
        power, expected = {apart: [] for apart in (0, 2, 3, 5)}, {apart: [] for apart in (0, 2, 3, 5)}
        for seed in range(70, 90):
            world = SyntheticWorld(6, seed)
            builder = self.builder(two_alike(world, 0.05, 4), Verdict.group)
            needed = margin(builder.findings.proposals[builder.decided()].best_gain())
            for apart in power:
                power[apart].append(builder.power_of(protocol_runs(world, apart)))
                expected[apart].append(0.5 * math.erfc((needed / apart - 0.5 * apart) / math.sqrt(2)) if apart else 0)
        for apart in power:
            self.assertAlmostEqual(np.mean(power[apart]), np.mean(expected[apart]), delta=0.1, msg=apart)

    def test_another_speed_checks_an_effect_that_depends_on_it(self):
        world = SyntheticWorld(6, 3)
        evidence = world.evidence(1, 32)
        world.add_effect(evidence, "viscoelasticity", world.pattern(1))
        evidence.observed = evidence.observed + 4 * evidence.library.effects[0].linear
        self.assert_one_has(self.texts(evidence, Verdict.effect), "repeat the experiment at another plate speed")

    def test_half_the_error_of_positions_lowers_the_limits_as_it_lowers_the_scatter(self):
        world = SyntheticWorld(6, 5)
        evidence = world.evidence(1, 32)
        world.add_effect(evidence, "diameter_error", world.pattern(2))
        mean = evidence.baseline.mean(axis=0)
        evidence.finer_baseline = mean + 0.6 * (evidence.baseline - mean)
        # Without parameters the limit is proportional to the noise.
        self.assert_one_has(self.texts(evidence, Verdict.no_gap), "measure positions twice as accurately", "to 60 % of the present value")

    def test_without_a_gap_they_lower_the_detection_limits(self):
        world = SyntheticWorld(6, 5)
        evidence = world.evidence(1, 32)
        modulus = world.pattern(2)
        world.add_effect(evidence, "diameter_error", modulus + world.pattern(0.1))
        world.add_nuisance(evidence, "modulus", modulus, 1)
        texts = self.texts(evidence, Verdict.no_gap)
        self.assert_one_has(texts[:1], "grains.youngs_modulus 5 times more accurately", "% of the present value")
        self.assertFalse(any("hold the plate" in text for text in texts))


if __name__ == "__main__":
    unittest.main()
