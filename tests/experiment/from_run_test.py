"""What an experiment takes from a run, and which runs give none. from_run_test.py"""
import contextlib
import io
import unittest
from dataclasses import replace

import numpy as np
from recordings import recording_of

from mcdem.commands.command_line import module_of, parser_of
from mcdem.diagnosis.effects import find_effect
from mcdem.errors import InputError
from mcdem.experiment.experiment import Measurement
from mcdem.experiment.instrument import Instrument
from mcdem.experiment.from_run import Options, chosen_replica, experiment_from, expect_measurable, read_uncertainty
from mcdem.results.names import ContainerShape, Wall
from mcdem.results.recording import Box, Contacts

ON_FLOOR = Contacts(np.array([0]), np.array([-1 - Wall.floor]), np.zeros((1, 3)), np.array([[0, 0, 1.0]]), np.zeros(1))


def seen_by_an_instrument(first=(), shape=ContainerShape.box, **more):
    """One grain; `first`: its place in frame 0."""
    return recording_of("run, replica", Box(0.1, 0.1, shape), 0.1, [0.02], plate_z=[0.1, 0.09], top_force=[0, 1],
                        position=[first, [[1, 1, 1]]], contacts={1: ON_FLOOR}, **more)


def options(**changes):
    none = {"run": "a", "out": "e", "replica": "", "name": "", "uncertainty": (), "seed": 1, "gzip": False}
    return Options(**none | {"instrument": Instrument()} | changes)


def whole_experiment(seen):
    return experiment_from(seen, Measurement())


class FromRun(unittest.TestCase):
    def problems_of(self, call, *arguments):
        with self.assertRaises(InputError) as refused:
            call(*arguments)
        return refused.exception.problems

    def test_states_the_parameters_of_the_run(self):
        parameters = {"grains.youngs_modulus": "23300", "walls.friction": "0.05", "effects.adhesion": "0.1", "grains.friction": "none"}
        bare = experiment_from(seen_by_an_instrument(parameters=parameters), Measurement(0, 0, 0, 0.1))
        self.assertEqual((bare.name, bare.measurement.force_threshold), ("run, replica", 0.1))
        self.assertEqual(bare.materials, {"grains.youngs_modulus": 23300, "walls.friction": 0.05})
        self.assertEqual(bare.uncertainty, {})

    def test_without_positions_in_frame_0_only_the_plate_remains(self):
        bare, whole = (experiment_from(seen_by_an_instrument(first), Measurement()).recording for first in ((), [[1, 1, 1]]))
        self.assertEqual((len(bare.diameter), *map(len, bare.scans.position), *map(len, bare.scans.contacts)), (0,) * 5)
        self.assertEqual((len(whole.diameter), *map(len, whole.scans.position), *map(len, whole.scans.contacts)), (1, 1, 1, 0, 1))

    def test_the_plate_alone_states_no_errors_of_grains(self):
        whole = seen_by_an_instrument([[1, 1, 1]])
        curve = experiment_from(whole, Measurement(1e-4, 2e-5, 0.05, 0.1), measure="plate")
        self.assertEqual((curve.measurement, len(curve.recording.diameter), list(curve.recording.scans.top_force)),
                         (Measurement(), 0, list(whole.scans.top_force)))

    def test_grains_without_forces_state_no_errors_of_forces(self):
        whole = seen_by_an_instrument([[1, 1, 1]])
        grains = experiment_from(whole, Measurement(1e-4, 2e-5, 0.05, 0.1), measure="grains")
        self.assertEqual((grains.measurement, [len(one) for one in grains.recording.scans.contacts]), (Measurement(1e-4, 2e-5), [0, 0]))
        self.assertEqual(list(map(len, grains.recording.scans.position)), list(map(len, whole.scans.position)))
        self.assertTrue(grains.has_grains_alone and not whole_experiment(whole).has_grains_alone)

    def test_refuses_cells(self):
        self.assertEqual(self.problems_of(experiment_from, seen_by_an_instrument(shape=ContainerShape.cell), Measurement()),
                         ["run, replica: container.shape must be one with a plate, got cell: an experiment is a compression by a plate"])

    def test_a_replica_is_chosen_by_label_or_number(self):
        labels = ["mc_dem", "1", ""]
        for where, word, number in ((labels, "mc_dem", 0), (labels, "1", 1), (labels, "2", 2), (labels, "+0", 0), (["mc_dem"], "", 0)):
            self.assertEqual(chosen_replica(where, options(replica=word)), number, word)
        for word, got in (("3", "3"), ("-1", "-1"), ("none", "none"), ("0.0", "0.0"), ("9" * 30, "9" * 30)):
            self.assertEqual(self.problems_of(chosen_replica, labels, options(replica=word)),
                             [f"--replica: must be a number or label of a's replicas (0: mc_dem, 1: 1, 2); got {got}"])
        self.assertIn("got none", *self.problems_of(chosen_replica, labels[:2], options()))

    def test_uncertainties_are_numbers_of_materials(self):
        self.assertEqual(read_uncertainty(["grains.youngs_modulus=500", "walls.friction=+1e-2", "walls.friction=0.02"]),
                         {"grains.youngs_modulus": 500, "walls.friction": 0.02})
        wrong = ["youngs_modulus=5", "grains.friction", *(f"grains.friction={sigma}" for sigma in ("", "-1", "nan", "1=2"))]
        self.assertEqual(self.problems_of(read_uncertainty, ["grains.friction=1", *wrong]),
                         [f"--uncertainty: must be KEY=SIGMA with a key such as grains.youngs_modulus, got {word}" for word in wrong])

    def test_what_the_experiment_will_lack_is_said(self):
        for truth, said in ((seen_by_an_instrument([[1, 1, 1]]), ""),
                            (seen_by_an_instrument(), "mcdem: the run holds no positions of frame 0: grains.csv and contacts.csv are left "
                             "out. Run with output.positions = true\n"),
                            (replace(seen_by_an_instrument([[1, 1, 1]]), plate_start=0.1025), "mcdem: frame 0 is 2.5 mm below the "
                             "plate's start, not the packing at rest that a simulation should start from. Run with protocol.scan_at_start "
                             "= true\n")):
            with contextlib.redirect_stderr(io.StringIO()) as messages:
                expect_measurable(truth, options())
            self.assertEqual(messages.getvalue(), said)

    def test_large_errors_and_species_are_refused(self):
        instrument = Instrument(Measurement(0.003, 0.01))
        self.assertEqual(self.problems_of(expect_measurable, seen_by_an_instrument(), options(instrument=instrument)),
                         [f"--{option}-error: must be at most an eighth of the smallest diameter, 0.0025 m, got {got}"
                          for option, got in (("position", "0.003"), ("diameter", "0.01"))])
        two = seen_by_an_instrument(species=np.array([0]), species_names=("soft", "hard"))
        self.assertEqual(self.problems_of(expect_measurable, two, options()),
                         ["the run must be one of grains of one material, got one of [[species]]: experiments state one material only"])


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.module = module_of("experiment from-run")
        self.parser = parser_of("experiment from-run", self.module)

    def parsed(self, *words):
        return self.parser.parse_intermixed_args(["a", "--out", "e", *words])

    def test_unstated_errors_may_be_negative(self):
        for text in ("-1e-3", "-.5", "-0.25", "+5E-1"):
            self.assertEqual(self.parsed("--force-bias", text, "--gzip").force_bias, float(text))

    def test_numbers_are_in_their_ranges(self):
        for option, text in (("--force-bias", "0.51"), ("--force-bias", "-0.51"), ("--force-bias", "nan"), ("--position-bias", "x"),
                             ("--guide-friction", "-0.1"), ("--force-lag", "-1"), ("--seed", "-1"), ("--force-error", "1.1")):
            with self.subTest(option), contextlib.redirect_stderr(io.StringIO()) as messages, self.assertRaises(SystemExit) as end:
                self.parsed(option, text)
            self.assertEqual(end.exception.code, 2)
            self.assertRegex(messages.getvalue(), f"^mcdem: {option}: must be a .*number .*, got {text}\n")

    def test_errors_have_the_formulas_of_the_effects(self):
        for name, (_, _, text) in self.module.UNSTATED.items():
            if effect := find_effect(name):
                self.assertEqual(text, effect.formula, name)


if __name__ == "__main__":
    unittest.main()
