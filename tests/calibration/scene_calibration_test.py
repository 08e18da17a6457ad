"""Calibrations of scenes: simulations of one grain, and batches with known forces. scene_calibration_test.py"""
import contextlib
import dataclasses
import math
import os
import pathlib
import sys
import tempfile
import unittest
import warnings
from unittest import mock

import numpy as np

import mcdem
from mcdem import _engine
from mcdem.calibration.calibrate import calibrate
from mcdem.calibration.scene_calibration import Options, SceneCalibration, calibrate_scene, scene_of_model
from mcdem.calibration.search import Calibration, SearchOptions
from mcdem.errors import InputError, RunError
from mcdem.observe.estimate import Estimate
from mcdem.results import ContactModel, Failure, Run
from mcdem.results.engine_run import run_of

sys.path.append(str(pathlib.Path(__file__).parents[1] / "observe"))
import synthetic  # noqa: E402

SMALL = {"name": "small", "box": {"size_x": 0.06, "size_y": 0.06}, "plate": {"start": 0.088, "end": 0.078},
         "packing": {"count": 30, "packing_fraction": 0.5}}
MODELS = {"batch.vary": {"contact.model": ["independent", "elastic_sphere"]}}


def nothing(_):
    pass


class OneGrain(unittest.TestCase):
    """Between two plates: the top force is a smooth function of gamma."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "grain.csv").write_text("x_m,y_m,z_m,diameter_m\n0.03,0.03,0.01,0.02\n")

    def scene(self, **keys):
        return mcdem.Scene({"name": "one", "box.size_x": 0.06, "box.size_y": 0.06, "packing.file": str(self.folder / "grain.csv"),
                            "plate.start": 0.0201, "plate.end": 0.018, "protocol.scans_per_stroke": 2, "protocol.stop_at_scans": True,
                            "protocol.rate_tolerance": 0, "protocol.settle_time": 0.02, "protocol.relax_time": 0.02,
                            "grains.poisson_ratio": 0.45} | {key.replace("__", "."): value for key, value in keys.items()})

    def reference(self, **keys):
        return run_of(mcdem.simulate(self.scene(**keys))).recordings

    def test_the_gamma_of_the_reference_is_found(self):
        reference, told = self.reference(contact__model="mc_dem", contact__gamma=0.8765), []
        options = Options(search=SearchOptions(tolerance=1e-3))
        result = calibrate_scene(self.scene(contact__model="mc_dem", contact__gamma=0.5), reference, options, told.append, self.fail)
        self.assertAlmostEqual(result.found.value, 0.8765, delta=2e-3)  # twice the tolerance
        self.assertTrue(result.found.converged)
        self.assertAlmostEqual(result.displacement, 2.1e-3, delta=1e-6)  # the plate stops where it should
        self.assertEqual(result.target.value, reference[0].scans.top_force[1])
        self.assertEqual((result.replicas, result.youngs_modulus, result.unit), (1, 0, 1))
        self.assertEqual(told, sorted(told))
        self.assertAlmostEqual(told[-1], len(result.found.rounds) / 8)

    def test_the_modulus_of_a_model_without_gamma_is_found(self):
        # Forces are proportional to the modulus.
        reference = self.reference(contact__model="hyperelastic_sphere", grains__youngs_modulus=26e3)
        stated = {key: value for key, value in reference[0].parameters.items() if not key.startswith(("grains.", "walls."))}
        reference = [dataclasses.replace(reference[0], parameters=stated | {"grains.youngs_modulus": "26000", "grains.friction": "0.5"})]
        scene, notes = self.scene(contact__model="mc_dem", grains__youngs_modulus=20e3), []
        options = Options(ContactModel.hyperelastic_sphere, search=SearchOptions(tolerance=1e-3))
        result = calibrate_scene(scene, reference, options, nothing, notes.append)
        self.assertEqual((result.youngs_modulus, result.unit), (20e3, 20e3))
        self.assertAlmostEqual(result.found.value, 1.3, delta=3e-3)  # three times the tolerance
        self.assertTrue(result.found.converged)
        self.assertEqual(notes, ["the reference has grains.friction = 0.5 (scene: 0.03): the calibrated value makes up for the difference; "
                                 "change the scene with --set if the reference is right"], "but not the modulus, which is searched for")
        with self.assertRaisesRegex(RunError, "E over the scene's = 0.6"):
            calibrate_scene(scene, reference, dataclasses.replace(options, search=SearchOptions(0.5, 0.6)), nothing, nothing)
        notes.clear()
        with self.assertRaises(RunError):
            calibrate_scene(scene, reference, Options(search=SearchOptions(0.1, 0.2)), nothing, notes.append)
        self.assertIn("the reference has grains.friction = 0.5 (scene: 0.03), grains.youngs_modulus = 26000 (scene: 20000):", notes[0])

    def test_a_plate_that_stops_early_is_refused(self):
        scene, reference = self.scene(), self.reference()
        lower = [dataclasses.replace(reference[0], plate_start=reference[0].plate_start + 1e-3)]
        with self.assertRaisesRegex(InputError, "3.100 mm, got 2.100 mm"):
            calibrate_scene(scene, lower, Options(), nothing, nothing)

    def test_a_value_out_of_range_is_refused(self):
        with self.assertRaisesRegex(InputError, "contact.gamma must be a number between 0 and 10, got 1[0-9]"):
            calibrate_scene(self.scene(), self.reference(), Options(search=SearchOptions(9, 12)), nothing, nothing)

    def test_the_function_for_users(self):
        run = mcdem.simulate(self.scene(batch__vary={"contact.model": ["independent", "elastic_sphere"]}))
        told = []
        found = calibrate(self.scene(), run, setting="elastic_sphere", rounds=2, batch=4, progress=told.append)
        self.assertEqual(found["target_top_force_N"], run["elastic_sphere"].top_force.max())
        self.assertTrue(0.5 < found["gamma"] < 1.5 and told)
        self.assertEqual((found["reference"], found["scene"]), ("elastic_sphere", self.scene().text))
        found = calibrate(self.scene(), run, setting="elastic_sphere", rounds=1, batch=4, model="elastic_sphere")
        self.assertAlmostEqual(found["youngs_modulus_Pa"] / 23.3e3, 1, delta=1e-3)  # the reference has the scene's; the response is a line
        self.assertNotIn("gamma", found)
        with self.assertWarnsRegex(RuntimeWarning, "the reference has grains.friction = 0.03") as said, self.assertRaises(RuntimeError):
            calibrate(self.scene(grains__friction=0.1), run, setting="elastic_sphere", low=0.1, high=0.2, batch=3)
        self.assertEqual(os.path.basename(said.filename), os.path.basename(__file__), "the line of the user")
        for problem, arguments in {"model must be one of independent, .*, got \"rubber\"": {"setting": "elastic_sphere", "model": "rubber"},
                                   "choose one with setting, of independent, elastic_sphere": {}}.items():
            with self.assertRaisesRegex(ValueError, problem):
                calibrate(self.scene(), run, **arguments)
        with self.assertRaisesRegex(TypeError, "must be a Run, or the path of a result or an experiment"):
            calibrate(self.scene(), 3)

    def test_an_interruption_ends_the_simulations(self):
        def interrupt(_):
            raise KeyboardInterrupt

        run = mcdem.simulate(self.scene())
        with self.assertRaises(KeyboardInterrupt):
            calibrate(self.scene(), run, progress=interrupt)


class Scenes(unittest.TestCase):
    def test_one_replica_of_the_model_runs_for_each_packing(self):
        scene = scene_of_model(mcdem.Scene(SMALL, **MODELS | {"batch.replicas": 3, "contact.gamma": 2}), ContactModel.mc_dem)
        self.assertEqual([(one["contact.model"], one["packing.seed"]) for one in scene.parameters],
                         [("mc_dem", 1), ("mc_dem", 2), ("mc_dem", 3)])
        self.assertEqual([(one["output.positions"], one["output.contacts"]) for one in scene.parameters], [(False, False)] * 3)
        scene = mcdem.Scene(SMALL, **{"batch.vary": {"contact.gamma": [0.5, 1], "packing.seed": [7, 5]}})
        self.assertEqual([one["packing.seed"] for one in scene_of_model(scene, ContactModel.independent).parameters], [7, 5])

    def test_scenes_that_cannot_be_calibrated_are_refused(self):
        cell = {"name": "cell", "box": {"size_x": 0.08, "size_y": 0.08}, "container": {"shape": "cell"}, "packing": {"count": 100}}
        stage = {"programme": [{"stage": "move", "strain": 0.1}]}
        for problem, tables in {"grains.friction must be the same for all replicas: give one value with --set grains.friction=..":
                                SMALL | {"batch.vary": {"grains.friction": [0.01, 0.02]}},
                                "species: must be left out": SMALL | {"species": [{"name": "soft"}, {"name": "stiff", "friction": 0.1}]},
                                "programme: must be left out": SMALL | {"programme": [{"stage": "move", "position": 0.08}]},
                                "container.shape: must be one with a plate": cell | stage}.items():
            with self.subTest(problem), self.assertRaisesRegex(InputError, problem):
                calibrate_scene(mcdem.Scene(tables), [synthetic.recording()], Options(), nothing, nothing)

    def test_a_reference_without_scans_is_refused(self):
        reference = synthetic.recording()
        reference.parameters["protocol.discard"] = "1"
        with self.assertRaisesRegex(InputError, "the reference must have a scan, got none"):
            calibrate_scene(mcdem.Scene(SMALL), [reference], Options(), nothing, nothing)


class FakeBatch:
    """Replicas whose top force is 10 N times gamma; those of `failing` fail."""

    packings, failing = 3, ()

    def __init__(self, scene, device):
        self.scans = []
        FakeBatch.last = self

    def simulate(self, changes, scans, progress):
        progress(0.5)
        progress(1.0)
        self.scans.append(scans)
        return Run("fake", "", "", "", "", tuple(self.recording(change["contact.gamma"], seed) for change in changes
                                                 for seed in range(self.packings)))

    def recording(self, gamma, seed):
        made = synthetic.recording(top=10 * gamma * (1 + 0.01 * seed), seed=seed, stroke=10e-3, levels=4, cycles=2)
        if seed not in self.failing:
            return made
        made = dataclasses.replace(made, failure=Failure(0, 0, "why"))
        return synthetic.changed(made, wall_force=np.full_like(made.scans.wall_force, math.nan))


class Batches(unittest.TestCase):
    """Three packings, of which some fail, and two cycles of four scans."""

    @contextlib.contextmanager
    def failing(self, *seeds):
        with mock.patch.object(_engine, "Batch", FakeBatch), mock.patch.object(FakeBatch, "failing", seeds):
            yield

    def calibrated(self, told=nothing, **keys):
        varied = {"contact.model": ["independent", "mc_dem"], "contact.gamma": [0.5, 1], "packing.seed": [1, 2, 3]}  # may vary
        scene = mcdem.Scene(SMALL, **{"batch.vary": varied, "protocol": {"cycles": 2, "scans_per_stroke": 4} | keys})
        reference = [synthetic.recording(top=10.0, stroke=10e-3, levels=4, seed=seed) for seed in (1, 2)]
        return calibrate_scene(scene, reference, Options(search=SearchOptions(rounds=2)), told, nothing)

    def test_forces_are_means_over_packings(self):
        told = []
        with self.failing():
            result = self.calibrated(told.append)
        self.assertAlmostEqual(result.found.value, 1 / 1.01, delta=1e-9)  # the response is a line
        np.testing.assert_allclose(result.found.rounds[0].top_force, 10.1 * result.found.rounds[0].values)
        self.assertAlmostEqual(result.simulated.standard_error, 10 * result.found.rounds[-1].values[-1] * 0.01 / math.sqrt(3))
        self.assertEqual((result.replicas, result.simulated.count, result.target), (3, 3, Estimate(10, 0, 2)))
        self.assertEqual(FakeBatch.last.scans, [12, 12])  # the last of four strokes is left out:
        np.testing.assert_allclose(told, [1 / 3, 1 / 2, 5 / 6, 1])  # half of the four are two thirds of three

    def test_the_scan_at_the_start_counts(self):
        with self.failing():
            self.calibrated(scan_at_start=True)
        self.assertEqual(FakeBatch.last.scans[0], 13)

    def test_a_minority_that_fails_is_left_out(self):
        with self.failing(2):
            result = self.calibrated()
        np.testing.assert_allclose(result.found.rounds[0].top_force, 10.05 * result.found.rounds[0].values)
        self.assertEqual(result.simulated.count, 2)

    def test_at_least_half_failing_is_running_away(self):
        for packings, failing in ((3, (0, 2)), (2, (1,))):
            with self.failing(*failing), mock.patch.object(FakeBatch, "packings", packings), \
                    self.assertRaisesRegex(RunError, "runs away already at gamma = 0.5"):
                self.calibrated()


class Errors(unittest.TestCase):
    def test_of_the_reference_and_of_the_scene_are_contained(self):
        # The error of a force over the slope is that of gamma; independent errors add as squares.
        result = SceneCalibration(Calibration(1.0, 0.003, 2.0, True, math.nan, ()), Estimate(), Estimate())
        self.assertEqual(result.standard_error, 0.003)
        self.assertFalse(result.knows_scatter)
        result = dataclasses.replace(result, target=Estimate(5, 0.008, 4), simulated=Estimate(5, 0.024, 4))
        self.assertAlmostEqual(result.standard_error, 0.013, delta=1e-12)  # 3, 4 and 12 thousandths
        self.assertTrue(result.knows_scatter)


if __name__ == "__main__":
    warnings.simplefilter("default")
    unittest.main()
