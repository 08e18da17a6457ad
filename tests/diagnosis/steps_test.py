"""Steps of a diagnosis whose simulations partly fail: rows and parameters stay what they are. steps_test.py"""
import types
import unittest

import numpy as np
from synthetic_evidence import SyntheticWorld

from mcdem.diagnosis.diagnose import Listener, Options, _Diagnosing
from mcdem.diagnosis.inference import Inference

REPLICATES = 12


class KnownSimulations:
    """As Simulations: runs of one packing that are given."""

    causes_of_failure = {"": "diverged"}

    def __init__(self, observed, runs):
        self.rows, self.runs = observed, runs

    def facts(self):
        nuisances = [("modulus", "Pa", 1.0), ("strain_offset", "m", 1.0)]
        return {"packings": 1, "names": ["measured"], "hindered": [], "has_programme": True, "nuisances": nuisances}

    def observed(self):
        return self.rows[None]


class Steps(unittest.TestCase):
    def setUp(self):
        world = SyntheticWorld(6, 5)
        self.evidence = world.evidence(1, REPLICATES)
        world.add_effect(self.evidence, "friction", world.pattern(1))
        for name in ("modulus", "strain_offset"):
            world.add_nuisance(self.evidence, name, world.pattern(0.5), 1)
        self.runs = self.evidence.library.baseline.copy()
        self.steps = _Diagnosing(KnownSimulations(self.evidence.observed, self.runs), Options(), Listener())

    def take(self, runs):
        self.steps._take_baseline(self.evidence, runs)
        self.steps._note_failures(self.evidence)

    def test_a_replicate_that_failed_once_is_back_in_the_next_baseline(self):
        failed = self.runs.copy()
        failed[2] = np.nan
        for runs, left in ((failed, REPLICATES - 1), (self.runs, REPLICATES)):
            self.take(runs)
            rows = len(self.evidence.baseline), len(self.evidence.library.baseline), len(self.evidence.library.packing)
            self.assertEqual(rows, (left, left, left))
        self.assertEqual(len(self.steps.hindered), 1)

    def test_shifts_are_those_of_the_parameters_that_are_left(self):
        self.evidence.library.nuisances[0].linear[:] = np.nan  # all runs with another modulus failed
        self.take(self.runs)
        inference = Inference(self.evidence, Options().limits, 0)
        inference.builder.findings.proposals = [types.SimpleNamespace(candidates=[0])]
        fit = types.SimpleNamespace(amplitudes=[0.02], nuisances=np.array([1e-4]))
        self.assertEqual(self.steps._amplitudes(inference, 0, fit), [("friction", 0.02), ("strain_offset", 1e-4)])


if __name__ == "__main__":
    unittest.main()
