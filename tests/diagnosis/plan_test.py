"""What a diagnosis takes from an experiment: cycles, candidates, the motion of the plate. plan_test.py"""
import functools
import pathlib
import tempfile
import unittest
from dataclasses import replace

import numpy as np
from small_trials import MEASUREMENT, TEXT, packing, scene

from mcdem import _engine as engine
from mcdem.diagnosis.effects import EFFECTS
from mcdem.diagnosis.plan import plan_of, plan_of_others
from mcdem.errors import InputError
from mcdem.experiment.experiment import Experiment, other_materials
from mcdem.experiment.from_run import experiment_from
from mcdem.observe.contact_residuals import GrainsAlone
from mcdem.observe.observation import observe
from mcdem.results.engine_run import run_of

CYCLES = {cycles: scene(protocol__scan_at_start=True, protocol__cycles=cycles, protocol__stop_at_scans=True) for cycles in (1, 2)}


@functools.cache
def experiment(cycles):
    """Simulated with the packing of the scene; the first cycle is the same for any number of cycles."""
    run = engine.simulate_starts(engine.Device(), [(CYCLES[cycles], packing(), 0, 0, 1)])
    return Experiment("measured", run_of(run).recordings[0], measurement=MEASUREMENT)


def plan(cycles, measured, notes=None, candidates=(), base=None):
    return plan_of(base or CYCLES[cycles], [measured], candidates, 8, 4, 1, False, (notes if notes is not None else []).append)


def observed_by(plan):
    comparison = plan.comparison
    return observe(plan.experiments[0].recording, comparison.grid, comparison.material, comparison.discard)


class Cycles(unittest.TestCase):
    def test_are_those_of_the_scene(self):
        one, two, notes = experiment(1), experiment(2), []
        self.assertEqual(len(two.recording.scans), 2 * len(one.recording.scans) - 1)
        same, first = plan(1, one, notes), plan(1, two, notes)
        self.assertEqual(notes, ["measured: only the first cycle is compared, of 2; protocol.cycles in the scene is the number of cycles to simulate"])
        self.assertEqual(first.model["protocol.cycles"], 1)
        np.testing.assert_array_equal(observed_by(first), observed_by(same))
        notes.clear()
        both, only = plan(2, two, notes), plan(2, one, notes)
        self.assertEqual((notes, both.model["protocol.cycles"], only.model["protocol.cycles"]), ([], 2, 1))
        self.assertFalse(np.array_equal(observed_by(both), observed_by(same), equal_nan=True), "the second cycle differs")
        np.testing.assert_array_equal(observed_by(only), observed_by(same))

    def test_include_one_that_is_not_discarded(self):
        discards = CYCLES[1]._variant({"protocol.discard": 1})
        self.assertEqual(len(plan(1, experiment(2), base=discards).experiments[0].recording.scans), len(experiment(2).recording.scans))


class Models(unittest.TestCase):
    def test_have_the_experiments_box_plate_and_scans(self):
        recording = experiment(1).recording
        moved = replace(recording, box=replace(recording.box, size_x=0.061), plate_start=0.0601)
        model = plan(1, replace(experiment(1), recording=moved)).model
        self.assertEqual([model.scene._values[key] for key in ("box.size_x", "box.size_y", "plate.start", "protocol.scans_per_stroke")],
                         [0.061, 0.06, 0.0601, 3])
        self.assertAlmostEqual(model["plate.end"], 0.05, 6)
        self.assertTrue(model["protocol.scan_at_start"])
        self.assertAlmostEqual(model.mean_diameter, packing().diameter.mean(), 12)

    def test_need_the_scenes_container_and_a_stroke(self):
        recording = experiment(1).recording
        up = replace(recording, plate_start=0.049)
        other = engine.Scene.parse('[container]\nshape = "periodic"\nsize_x = 0.06\nsize_y = 0.06\n[packing]\ncount = 18')
        for measured, base, problem in ((replace(experiment(1), recording=up), None, "must have loading frames below plate.start"),
                                        (experiment(1), other, "container.shape must be box, as in measured")):
            with self.assertRaisesRegex(InputError, problem):
                plan(1, measured, base=base)

    def test_follow_the_experiments_programme(self):
        """A scene with a programme needs an experiment with one."""
        programme = {"programme.1.stage": "move", "programme.1.position": "0.05", "programme.1.scans": "3"}
        staged = CYCLES[1]._with_programme(programme)
        with self.assertRaisesRegex(InputError, r"must state the \[\[programme\]\]"):
            plan(1, experiment(1), base=staged)
        recording = replace(experiment(1).recording, parameters={**experiment(1).recording.parameters, **programme})
        model = plan(1, replace(experiment(1), recording=recording)).model
        self.assertTrue(model.has_programme)
        self.assertEqual(model["programme.1.position"], 0.05)

    def test_of_others_have_other_packings_and_the_scenes_plate(self):
        made = plan_of_others(CYCLES[1], experiment(1), 2, (), 4, 1, 9)
        self.assertEqual([[len(start) for start in one.starts] for one in made.packings], [[18], [18]])
        self.assertNotEqual(made.packings[0].starts[0].digest, made.packings[1].starts[0].digest)
        self.assertAlmostEqual(made.comparison.grid.stroke, 0.01, 12)


def quiet(_):
    """Notes that a test does not look at."""


def of_grains(one):
    """Without contact forces."""
    return replace(experiment_from(one.recording, MEASUREMENT, measure="grains"), name=one.name)


def with_first_frame(one):
    """Positions of the packing at rest only."""
    scans, none = one.recording.scans, np.zeros((0, 3))
    position = (scans.position[0], *(none,) * (len(scans) - 1))
    return replace(one, recording=replace(one.recording, scans=replace(scans, position=position)))


def of_plate(one, **uncertainty):
    """Only its curve."""
    return replace(experiment_from(one.recording, MEASUREMENT, measure="plate"), name=one.name, uncertainty=uncertainty)


class WithoutForces(unittest.TestCase):
    """Grains are compared by themselves if no experiment has contact forces."""

    def test_grains_touch_from_the_error_of_their_overlap(self):
        self.assertIsNone(plan(1, experiment(1)).comparison.material.grains_alone)
        alone = of_grains(experiment(1))
        self.assertEqual(plan(1, alone).comparison.material.grains_alone,
                         GrainsAlone(np.sqrt(2 * MEASUREMENT.position_error**2 + MEASUREMENT.diameter_error**2 / 2)))
        listed = replace(alone, topology=np.array([[1, 0, 1]]))
        self.assertTrue(plan(1, listed).comparison.material.grains_alone.listed)
        for both, wanted in (([alone, listed], False), ([listed, listed], True)):
            self.assertEqual(plan_of(CYCLES[1], both, (), 8, 4, 1, False, quiet).comparison.material.grains_alone.listed, wanted)
        self.assertIsNone(plan(1, with_first_frame(alone)).comparison.material.grains_alone)

    def test_forces_have_an_assumed_error_in_simulations(self):
        """For the power of measuring them."""
        for measured, wanted in ((of_grains(experiment(1)), 0.05), (experiment(1), MEASUREMENT.force_error)):
            self.assertEqual(plan(1, measured).model.instrument.stated.force_error, wanted)


class WithoutGrains(unittest.TestCase):
    """Packings are drawn for an experiment that measured only the plate."""

    def test_every_replicate_has_a_packing_of_its_own(self):
        notes = []
        curve = of_plate(experiment(1))
        drawn = plan(1, curve, notes)
        self.assertTrue(drawn.drawn)
        self.assertIn("packings are drawn as the scene generates them", notes[0])
        trials = drawn.baseline()
        self.assertEqual(len({trial.packing.digest for trial in trials}), 8)
        self.assertEqual({trial.jitter for trial in trials}, {0})
        again = plan(1, curve).library()
        for row, trial in zip(drawn.paired_rows() * 2, again[8:16], strict=True):  # paired runs begin with the same grains
            self.assertEqual((trial.packing.digest, trial.seed), (trials[row].packing.digest, trials[row].seed))
        other = plan_of(CYCLES[1], [curve], (), 8, 4, 2, False, quiet)
        self.assertFalse({start.digest for start in other.packings[0].starts} & {trial.packing.digest for trial in trials})

    def test_repeated_tests_have_other_packings(self):
        curve = of_plate(experiment(1))
        twice = plan_of(CYCLES[1], [curve, curve], (), 8, 4, 1, False, quiet)
        self.assertEqual(len({trial.packing.digest for trial in twice.baseline()}), 16)

    def test_the_height_of_a_packing_is_uncertain(self):
        sigmas = [{one.name: one.sigma for one in plan(1, measured).nuisances}["strain_offset"]
                  for measured in (experiment(1), of_plate(experiment(1)), of_plate(experiment(1), **{"plate.start": 3e-4}))]
        np.testing.assert_allclose(sigmas, [0.01 * experiment(1).recording.diameter.mean(), 0.1 * 0.0215, 3e-4], rtol=0.05)  # 18 grains of 21.5 mm

    def test_libraries_are_of_as_many_packings(self):
        made = plan_of_others(CYCLES[1], of_plate(experiment(1)), 4, (), 2, 1, 1)
        self.assertEqual((len(made.packings), len(made.packings[0].starts), made.replicates, made.pairs), (1, 8, 8, 4))
        own = plan(1, of_plate(experiment(1)))
        self.assertEqual(made.model.instrument, plan_of(CYCLES[1], [of_plate(experiment(1))], (), 9, 4, 7, False, quiet).model.instrument)
        self.assertEqual([start.digest for start in made.packings[0].starts], [start.digest for start in own.packings[0].starts])

    def test_experiments_with_and_without_grains_are_refused(self):
        with self.assertRaisesRegex(InputError, "must have the positions of frame 0, or not, as measured"):
            plan_of(CYCLES[1], [experiment(1), of_plate(experiment(1))], (), 8, 4, 1, False, quiet)

    def test_scenes_with_a_file_of_grains_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "grains.csv"
            position = np.column_stack([0.02 * np.arange(1, 3), np.full((2, 2), 0.02)])
            file.write_text("x_m,y_m,z_m,diameter_m\n" + "".join(f"{x},{y},{z},0.015\n" for x, y, z in position))
            base = engine.Scene.parse(TEXT.replace("count = 18\npacking_fraction = 0.52", f'file = "{file}"'))
            with self.assertRaisesRegex(InputError, "packing.file must be left out for measured, whose grains were not measured"):
                plan_of(base, [of_plate(experiment(1))], (), 8, 4, 1, False, quiet)


class Packings(unittest.TestCase):
    def test_of_one_experiment_are_measured_alike(self):
        one = experiment(1)
        recording = one.recording
        short = replace(recording, scans=replace(recording.scans, plate_z=0.8 * (recording.scans.plate_z - 0.06) + 0.06))
        staged = replace(recording, parameters={"programme.1.stage": "move", "programme.1.position": "0.05", "programme.1.scans": "3"})
        for other, problem in ((replace(one, measurement=replace(MEASUREMENT, force_error=0.2)), r"the same \[measurement\]"),
                               (replace(one, recording=short), "must be within a tenth"),
                               (replace(one, recording=staged), r"the same \[\[programme\]\]")):
            with self.assertRaisesRegex(InputError, problem):
                plan_of(CYCLES[1], [one, replace(other, name="other")], (), 8, 4, 1, False, [].append)


class Candidates(unittest.TestCase):
    def test_are_all_that_the_model_allows(self):
        every = plan(1, experiment(1))
        self.assertEqual(len(every.candidates) + len(every.hindered), len(EFFECTS))
        self.assertIn("cross_contact", [effect.name for effect in every.candidates])
        self.assertEqual(every.hindered[0], "bulge_contacts: independent contacts have no surface displacements")
        some = plan(1, experiment(1), candidates=["adhesion", "bulge_contacts"])
        self.assertEqual(([effect.name for effect in some.candidates], len(some.hindered)), (["adhesion"], 1))

    def test_must_be_effects_of_which_one_is_possible(self):
        for names, problem in ((["adhesion", "phlogiston", "ether"], "(?s)phlogiston is not an effect; there are cross_contact.*ether is not"),
                               (["bulge_contacts"], "must name an effect that can be tested, got bulge_contacts: independent")):
            with self.assertRaisesRegex(InputError, problem):
                plan(1, experiment(1), candidates=names)


class Materials(unittest.TestCase):
    def test_are_stated_by_the_experiment_and_not_the_scenes(self):
        parameters = scene(grains__youngs_modulus=23300, grains__friction=0.1).parameters[0]
        for stated, wanted in (({}, []), ({"grains.youngs_modulus": 23300.0, "grains.friction": 0.1}, []),
                               ({"grains.youngs_modulus": 3e4, "grains.friction": 0.1}, ["grains.youngs_modulus = 30000 (scene: 23300)"])):
            self.assertEqual(other_materials(stated, parameters), wanted)
        self.assertEqual(other_materials({"grains.friction": 9.0}, {"species.1.name": "glass", "grains.friction": 0.1}), [])


if __name__ == "__main__":
    unittest.main()
