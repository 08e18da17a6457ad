"""A planted effect, from the evidence to the diagnosis. builder_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
from synthetic_evidence import Case

from mcdem.diagnosis.builder import DiagnosisBuilder
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.observe.grid import bins_each
from mcdem.observe.observables import observables


def planted(seed, observables_known=6, effects=("adhesion",), size=1.0):
    """A world, its evidence with effects of random patterns, and the pattern of the first one."""
    case = Case(effects=effects, size=size, parameters=(), known=observables_known, seed=seed)
    return case.world, case.evidence, case.effects[0].linear


def built(evidence):
    return DiagnosisBuilder(evidence, Limits())


def diagnosed(evidence):
    return built(evidence).diagnosis()


def places(evidence):
    """Observable and place of each bin."""
    bin = np.arange(len(evidence.observed))
    each = bins_each(len(bin))
    return bin // each, bin % each


def runs_at(world, evidence, shift):
    """Runs of a few replicates that differ by `shift` from the baseline."""
    return evidence.baseline.mean(axis=0) + shift + np.array([world.noise() for _ in range(64)])


class Planted(unittest.TestCase):
    def test_is_found_and_measured(self):
        world, evidence, pattern = planted(3, effects=("adhesion", "friction"))
        world.add_nuisance(evidence, "modulus", world.pattern(0.5), 1)
        evidence.candidates[0] = replace(evidence.candidates[0], unit="J/m2")
        evidence.observed += 4 * pattern
        d = diagnosed(evidence)
        self.assertEqual(d.verdict, Verdict.effect)
        cause, = d.causes
        self.assertEqual((cause.effect, cause.unit, cause.at_limit), ("adhesion", "J/m2", False))
        self.assertLess(abs(cause.amplitude - 4), 4 * cause.amplitude_error)
        self.assertGreater(cause.explained, 0.5)
        self.assertLess(d.gap.p_value, 1e-3)
        self.assertTrue(d.gap.detected and d.where)
        self.assertEqual((len(d.ranking), d.ranking[0], len(d.nuisances)), (3, cause, 1))
        self.assertGreater(d.shrink.fraction, 0.9)
        self.assertEqual(d.shrink.fitted_displacement_mm, (0, 25.5))
        self.assertRegex(" ".join(d.not_measured), "^grains.csv")

    def test_an_amplitude_may_be_at_the_limit_of_its_range(self):
        for low, high, amplitude in ((-10, 3, 4), (-3, 10, -4)):
            _, evidence, pattern = planted(3)
            evidence.candidates[0] = replace(evidence.candidates[0], low=low, high=high)
            evidence.observed += amplitude * pattern
            cause = diagnosed(evidence).ranking[0]
            self.assertAlmostEqual(cause.amplitude, math.copysign(3, amplitude), 4)
            self.assertTrue(cause.at_limit)

    def test_a_parameter_far_from_its_stated_value_is_a_symptom(self):
        world, evidence, _ = planted(4)
        modulus = world.pattern(2)
        world.add_nuisance(evidence, "modulus", modulus, 1)
        evidence.observed += 9 * modulus
        d = diagnosed(evidence)
        self.assertEqual((d.verdict, d.causes[0].effect), (Verdict.calibration_suspect, "modulus"))
        self.assertTrue(d.nuisances[0].at_bound)
        first, = d.check_first
        self.assertLess(abs(first.shift - 9), 4 * first.error)

    def test_the_symmetric_gap_has_the_opposite_amplitude(self):
        _, evidence, pattern = planted(5)
        mean = evidence.baseline.mean(axis=0)
        evidence.observed = mean + 4 * pattern
        plus = diagnosed(evidence)
        evidence.observed = mean - 4 * pattern
        minus = diagnosed(evidence)
        self.assertAlmostEqual(plus.causes[0].amplitude, -minus.causes[0].amplitude, 6)
        self.assertAlmostEqual(plus.gap.p_value, minus.gap.p_value, 12)

    def test_numerics_are_refined_until_the_rest_is_not_detectable(self):
        _, evidence, pattern = planted(6, effects=("plate_speed",), size=8)
        evidence.candidates[0] = replace(evidence.candidates[0], low=0, high=1)
        evidence.observed += 0.9 * pattern
        builder = built(evidence)
        self.assertEqual(builder.decision.verdict, Verdict.not_converged)
        factor = builder.refining_factor(0, 64)
        self.assertEqual(math.log2(factor) % 1, 0)
        self.assertGreater(factor, 2)
        self.assertEqual(builder.refining_factor(0, 1.5), 1.5)
        cause, = builder.diagnosis().causes
        amplitude = min(cause.amplitude + cause.amplitude_error, 1)
        space = builder.data.space(free=[])
        left = [space.whiten((amplitude - 1 + 1 / f) * pattern) for f in (factor / 2, factor)]
        self.assertEqual([0.5 * (one**2).sum() < 4 for one in left], [False, True])


def where(differs, size, observables_known=10):
    """The experiment differs by `size` wherever differs(observable, place)."""
    world, evidence, _ = planted(3, observables_known)
    evidence.observed[differs(*places(evidence)) & (np.arange(len(evidence.observed)) < world.known)] += size
    return diagnosed(evidence)


def with_remainder(chosen, left):
    """Decides between an effect with the pattern of all differences and none, if the runs with the effect leave `left` at the chosen
    bins."""
    world, evidence, pattern = planted(6, 8)
    observable, place = places(evidence)
    evidence.observed += 9 * pattern + np.where(chosen(observable, place), np.where(observable % 2, left, -left), 0)
    builder = built(evidence)
    builder.confirm(0, runs_at(world, evidence, 9 * pattern))
    while (k := builder.wants_held_out()) is not None:
        builder.confirm_held_out(k, runs_at(world, evidence, 9 * pattern))
    return builder.diagnosis()


class Rearrangements(unittest.TestCase):
    def test_a_difference_at_one_displacement_is_a_rearrangement(self):
        def smaller_p(d):
            return 2 * min(d.gap.p_omnibus, d.gap.p_directed)

        one = where(lambda _, place: place == 2, 5)
        self.assertLess(smaller_p(one), 1e-3)  # all bins together
        self.assertGreater(one.gap.p_value, 0.01)
        self.assertEqual((one.verdict, one.where, one.explanation), (Verdict.no_gap, (), None))
        two = where(lambda _, place: (place == 2) | (place == 5), 5)
        self.assertLess(two.gap.p_value, 0.01)
        self.assertGreater(two.gap.p_value, smaller_p(two))
        self.assertLess(where(lambda _, place: place >= 0, 2).gap.p_value, 0.01)

    def test_a_difference_in_a_hold_is_none(self):
        """The force relaxes in a hold only, and a hold belongs to one displacement."""
        names = [one.name for one in observables()]
        for name in ("relaxation", "creep", "top_force"):
            p = where(lambda observable, place: (observable == names.index(name)) & (place == 3), 60, len(names)).gap.p_value
            self.assertEqual(p < 0.01, name != "top_force", name)

    def test_one_beside_an_effect_is_left_out(self):
        """At one displacement of the unloading, which is held out. Differences of the same size at two displacements, or everywhere in
        one observable, are a remainder."""
        d = with_remainder(lambda _, place: place == 5, 12)
        self.assertEqual(d.verdict, Verdict.effect)
        self.assertGreater(d.explanation.reduction, 0.9)
        self.assertRegex(d.explanation.without, r"^18\.3 mm of unloading$")
        self.assertFalse(d.explanation.leaves_more_than_noise)
        two = with_remainder(lambda _, place: (place == 5) | (place == 6), 12)
        self.assertEqual((two.verdict, two.explanation.without), (Verdict.unknown_effect, ""))
        self.assertIn("mcdem experiment check", two.next[0].what)
        one = with_remainder(lambda observable, _: observable == 3, 12)
        self.assertEqual((one.explanation.without, one.explanation.leaves_more_than_noise), ("", True))


class Runs(unittest.TestCase):
    def test_a_parameter_is_run_again_if_its_runs_require_a_larger_amplitude(self):
        """Effect and parameter have the same signature. The effect's runs agree with the data; those of the parameter do not reach them
        and leave a slightly larger gap."""
        world, evidence, pattern = planted(3, size=2)
        world.add_nuisance(evidence, "modulus", pattern, 1)
        evidence.observed += 9 * pattern
        builder = built(evidence)
        proposals = builder.findings.proposals
        effect, parameter = ([one.candidates for one in proposals].index([candidate]) for candidate in (0, 1))
        builder.confirm(effect, runs_at(world, evidence, 9 * pattern))
        builder.confirm(parameter, runs_at(world, evidence, 7.5 * pattern + 0.6 * world.pattern(1)))
        self.assertEqual(builder.decision.proposal, effect)
        self.assertGreater(proposals[parameter].best_misfit(), 0.01)
        before = builder.whole_fit(parameter).amplitudes[0]
        self.assertTrue(builder.refit(parameter))
        self.assertLess(abs(builder.whole_fit(parameter).amplitudes[0] - before - 1.5), 0.5)
        self.assertFalse(builder.refit(effect))

    def test_runs_that_fail_are_repeated_with_half_the_amplitude(self):
        world, evidence, pattern = planted(4)
        evidence.observed += 9 * pattern
        builder = built(evidence)
        fitted = builder.whole_fit(0).amplitudes[0]
        failed = runs_at(world, evidence, fitted * pattern)
        failed[:, builder.data.bins[0]] = np.nan
        builder.confirm(0, failed)
        self.assertTrue(builder.refit(0))
        self.assertAlmostEqual(builder.whole_fit(0).amplitudes[0], fitted / 2, 12)
        builder.confirm(0, runs_at(world, evidence, fitted / 2 * pattern))
        self.assertGreater(builder.findings.proposals[0].amplitudes[0], 0.6 * fitted)  # half of the step that they require
        builder.confirm(0, failed)
        self.assertFalse(builder.refit(0))  # an earlier amplitude has results


if __name__ == "__main__":
    unittest.main()
