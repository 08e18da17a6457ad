"""Evidence without simulations: normal noise of known covariance on a few observables, and given signatures. synthetic_evidence.py"""
import math
from functools import cached_property

import numpy as np

from mcdem._engine import Random
from mcdem.diagnosis.builder import DiagnosisBuilder
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.evidence import CandidateRange, Evidence, NuisancePrior, gap_data
from mcdem.diagnosis.gap_tests import NullDistribution, gap_statistics
from mcdem.diagnosis.library import Library
from mcdem.observe.grid import Grid, bins_of
from mcdem.diagnosis.signature import Signature

GRID = Grid([0.0126, 0.0183, 0.0240, 0.0294], 0.0036, 0.03)  # eight bins of each observable


class SyntheticWorld:
    """Bins of the first `observables_known` observables have values; the noise of adjacent bins is correlated."""

    def __init__(self, observables_known, seed):
        self.bins = len(bins_of(GRID))
        self.known = 8 * observables_known
        self.random = Random(seed, "challenge")

    def normal(self):
        return float(self.random.normals(1)[0])

    def noise(self, size=1.0):
        """Variance 1, correlation 1/2 between adjacent bins; NaN for unknown bins. (all bins,)"""
        drawn = self.random.normals(self.known).tolist()
        values = drawn[:1]
        for number in drawn[1:]:
            values.append(0.5 * values[-1] + math.sqrt(0.75) * number)
        return size * np.append(values, np.full(self.bins - self.known, np.nan))

    def pattern(self, size):
        """`size` at each bin, with random signs."""
        values = np.zeros(self.bins)
        values[: self.known] = [-size if self.random.uniform() < 0.5 else size for _ in range(self.known)]
        return values

    def signature(self, name, linear):
        return Signature(name, 10, np.array(linear), np.zeros(self.bins), np.tile(linear, (8, 1)))

    def evidence(self, packings, replicates, packing_scatter=3.0):
        """Replicates of packings that differ by `packing_scatter`. The last packing is that of the experiment; its replicates are the
        baseline, and the observation is one more of them. No candidates."""
        baseline = np.empty((packings * replicates, self.bins))
        for p in range(packings):
            centre = self.noise(packing_scatter)
            for r in range(replicates):
                baseline[p * replicates + r] = centre + self.noise()
            observed = centre + self.noise()
        packing = [p for p in range(packings) for _ in range(replicates)]
        return evidence_of(observed, baseline[-replicates:].copy(), baseline, packing)

    def add_effect(self, evidence, name, linear, low=-10.0, high=10.0):
        evidence.library.effects.append(self.signature(name, linear))
        evidence.candidates.append(CandidateRange(name, "", low, high))

    def add_nuisance(self, evidence, name, linear, sigma):
        evidence.library.nuisances.append(self.signature(name, linear))
        evidence.nuisances.append(NuisancePrior(name, "", sigma))


def evidence_of(observed, baseline, library_baseline, packing):
    library = Library(grid=GRID, baseline=library_baseline, packing=packing, effects=[], nuisances=[], provenance={}, origin={})
    return Evidence(observed=observed, baseline=baseline, library=library)


class Case:
    """Effects and parameters with random patterns, a gap from these amplitudes of the effects, and what follows from it."""

    def __init__(self, *amplitudes, effects=("adhesion", "friction"), size=1.0, parameters=("modulus",), known=6, replicates=32, seed=3):
        self.world = SyntheticWorld(known, seed)
        self.evidence = self.world.evidence(1, replicates)
        for name in effects:
            self.world.add_effect(self.evidence, name, self.world.pattern(size))
        for name in parameters:
            self.world.add_nuisance(self.evidence, name, self.world.pattern(0.5), 1)
        for amplitude, signature in zip(amplitudes, self.effects):
            self.evidence.observed += amplitude * signature.linear

    @property
    def effects(self):
        return self.evidence.library.effects

    @property
    def parameters(self):
        return self.evidence.library.nuisances

    @cached_property
    def data(self):
        return gap_data(self.evidence)

    @cached_property
    def space(self):
        return self.data.space()

    @cached_property
    def null(self):
        return NullDistribution(self.data, 1)

    @cached_property
    def statistics(self):
        return gap_statistics(self.space, self.data, self.data.gap)

    def builder(self):
        return DiagnosisBuilder(self.evidence, Limits())

    def diagnosis(self):
        return self.builder().diagnosis()

    def runs(self, shift=0.0, number=16):
        """Runs of the scene that differ by `shift` from the baseline."""
        centre = self.evidence.baseline.mean(axis=0) + shift
        return np.array([centre + self.world.noise() for _ in range(number)])
