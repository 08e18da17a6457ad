"""Whole diagnoses of simulated experiments with few grains. diagnose_test.py"""
import pathlib
import shutil
import tempfile
import unittest
from dataclasses import replace

import numpy as np

from mcdem import _engine as engine
from mcdem.challenge.case import ChallengeCase, Hidden
from mcdem.challenge.case_simulator import CaseSimulator
from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.diagnose import Listener, Options, diagnose, make_simulations
from mcdem.diagnosis.diagnosis_types import Verdict
from mcdem.diagnosis.library import read_library
from mcdem.experiment.experiment import Measurement
from mcdem.experiment.from_run import experiment_from
from mcdem.experiment.read import read_experiment
from mcdem.experiment.write import write_experiment
from mcdem.observe.observables import observables

SMALL = """name = "small"
[box]
size_x = 0.06
size_y = 0.06
[contact]
model = "independent"
friction_law = "saturated"
[grains]
friction = 0.001
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.088
end = 0.074
speed = 0.03
[protocol]
scans_per_stroke = 6
stop_at_scans = false
rate_tolerance = 0
settle_time = 0.02
relax_time = 0.02
"""
MEASUREMENT = Measurement(1e-5, 1e-5, 0.01, 1e-4)
FEW = Options(replicates=8, pairs=2, confirmations=4)


class Kept(Listener):
    def __init__(self):
        self.stages, self.notes, self.kept = [], [], {}

    def progress(self, stage, fraction):
        if stage not in self.stages:
            self.stages.append(stage)

    def note(self, text):
        self.notes.append(text)

    def evidence(self, evidence):
        self.kept["evidence"] = evidence

    def findings(self, findings):
        self.kept["findings"] = findings


class Diagnoses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(kept.cleanup)
        cls.folder = pathlib.Path(kept.name)
        (cls.folder / "small.toml").write_text(SMALL)
        cls.scene, _ = engine.scene_of_options(str(cls.folder / "small.toml"), [])
        simulator = CaseSimulator(cls.scene, MEASUREMENT, "")
        simulator.make_packings([2])
        hidden = {"plain": (), "adhesive": (Hidden("adhesion", 0.3),)}  # from 0.15 on two laws of adhesion take away all of the gap
        cases = [ChallengeCase(name, "", effects, (), (), 0, 5) for name, effects in hidden.items()]
        failures = simulator.simulate(cases, False, lambda fraction: None)
        assert failures == ["", ""], failures
        for k, name in enumerate(hidden):
            write_experiment(cls.folder / name, experiment_from(simulator.measured(k), MEASUREMENT), gzip=True)

    def diagnosed(self, experiment, options, store="simulations"):
        listener = Kept()
        experiments = [read_experiment(self.folder / experiment)]
        simulations = make_simulations(self.scene, experiments, self.folder / store, options, listener=listener)
        return diagnose(self.scene, simulations, options, listener), listener

    def curve(self, name, factor):
        """An experiment with only the force on its plate, times a factor."""
        whole = read_experiment(self.folder / "plain").recording
        stronger = replace(whole, scans=replace(whole.scans, wall_force=factor * whole.scans.wall_force))
        write_experiment(self.folder / name, experiment_from(stronger, MEASUREMENT, measure="plate"), gzip=False)

    def test_a_curve_alone_is_compared_with_packings_that_are_drawn(self):
        """The packing of the curve is none of those drawn. Thirty times the force cannot be another packing."""
        few = replace(FEW, candidates=["cross_contact", "stiffening", "friction"])
        self.curve("curve", 1)
        plain, listener = self.diagnosed("curve", few)
        self.assertTrue(any("packings are drawn" in note for note in listener.notes), listener.notes)
        self.assertEqual((plain.verdict, len(plain.not_measured)), (Verdict.no_gap, 2))
        self.assertNotIn("half the noise", listener.stages)
        self.curve("stiff", 30)
        stiff, _ = self.diagnosed("stiff", few)
        self.assertNotIn(stiff.verdict, (Verdict.no_gap, Verdict.effect))
        self.assertTrue(any("measure contact forces, with the positions" in step.what for step in stiff.next), stiff.next)

    def test_an_effect_is_named_from_grains_without_contact_forces(self):
        """Also if the experiment lists who touches."""
        whole = read_experiment(self.folder / "adhesive").recording
        write_experiment(self.folder / "grains", experiment_from(whole, MEASUREMENT, measure="grains"), gzip=False)
        rows = [f"{k},{i},{j}\n" for k, one in enumerate(whole.scans.contacts) for i, j in zip(one.grain, one.partner) if j >= 0]
        listed, few = self.folder / "listed", replace(FEW, candidates=["adhesion", "cross_contact"])
        shutil.copytree(self.folder / "grains", listed)
        (listed / "topology.csv").write_text("frame,grain,partner\n" + "".join(rows))
        for name in ("grains", "listed"):
            with self.subTest(name):
                diagnosis, listener = self.diagnosed(name, few)
                self.assertEqual((diagnosis.verdict, diagnosis.causes[0].effect), (Verdict.effect, "adhesion"))
                self.assertAlmostEqual(diagnosis.causes[0].amplitude, 0.3, delta=0.06)
                seen = listener.kept["evidence"].observed.reshape(len(observables()), -1)
                self.assertEqual({one.needs for one, known in zip(observables(), np.isfinite(seen).any(axis=1)) if known}, {"plate", "grains"})
                self.assertTrue(all(text.startswith("contacts.csv") for text in diagnosis.not_measured))

    def with_pauses(self, speed):
        """The plate is said to pause for 0.2 s at this speed [m/s]. The candidates are two laws of adhesion, which differ only in their
        friction. Both are in one group, but not the modulus, which gains half of that."""
        file = self.folder / "adhesive/experiment.toml"
        stated = file.read_text()
        self.addCleanup(file.write_text, stated)
        head, plate, rest = stated.partition("[plate]\n")
        file.write_text(f"{head}{plate}pause = 0.2\nspeed = {speed}\n{rest}")
        return self.diagnosed("adhesive", replace(FEW, candidates=["adhesion", "adhesion_net_friction"], limits=Limits(group_share=0.3)))

    def recommends_motion(self, diagnosis):
        return any(step.what.startswith("simulate the motion of the experiment's plate") for step in diagnosis.next)

    def test_other_protocols_get_a_power(self):
        """The plate is 30 times slower than that of the scene: pauses are recommended, not simulated."""
        diagnosis, _ = self.with_pauses(0.001)
        self.assertEqual((diagnosis.verdict, diagnosis.refinements), (Verdict.group, ()))
        powers = {step.what.partition(", to distinguish adhesion")[0]: step.power for step in diagnosis.next}
        for what in ("hold the plate at full stroke for 0.3 s", "press one more cycle"):
            self.assertTrue(0 <= powers[what] <= 1, powers)
        self.assertTrue(self.recommends_motion(diagnosis))

    def test_pauses_of_the_plate_are_simulated_if_there_is_a_gap(self):
        diagnosis, listener = self.with_pauses(0.06)
        pause, speed = diagnosis.refinements
        self.assertEqual((pause.key, pause.to, pause.done), ("protocol.pause", 0.02, True))  # relax_time: grains rest by then
        self.assertEqual((speed.key, speed.was, speed.to, speed.done), ("plate.speed", 0.03, 0.06, True))
        self.assertFalse(self.recommends_motion(diagnosis))
        self.assertIn("baseline with the experiment's plate", listener.stages)
        self.assertTrue(any("continuing with that motion" in note for note in listener.notes), listener.notes)

    def test_a_library_is_written_and_read_by_the_next(self):
        options = replace(FEW, candidates=["friction", "bulge_contacts"], confirmations=0, library=self.folder / "library.json")
        (first, a), (second, b) = (self.diagnosed("plain", options, store) for store in ("first", "second"))
        own, shared = a.kept["evidence"], b.kept["evidence"]
        self.assertEqual((own.library_is_own, shared.library_is_own), (True, False))
        np.testing.assert_array_equal(read_library(options.library).baseline, own.library.baseline)
        np.testing.assert_array_equal(own.baseline, shared.baseline)
        self.assertEqual((first.verdict, second.verdict), (Verdict.no_gap, Verdict.no_gap))
        self.assertIn("library", a.stages)
        self.assertNotIn("library", b.stages)
        self.assertEqual(a.notes, ["not tested: bulge_contacts: independent contacts have no surface displacements"])
        self.assertEqual([f"not tested: {one}" for one in first.not_testable], a.notes)
        self.assertEqual(a.kept["findings"].names, ["friction", "modulus", "strain_offset"])
        self.assertEqual({name: first.provenance[name] for name in ("scene", "experiment", "seed")},
                         {"scene": "small", "experiment": "plain", "seed": "1"})


if __name__ == "__main__":
    unittest.main()
