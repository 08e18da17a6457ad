"""Convergence of small scenes with few grains: a fast plate is named as the cause of errors. converge_test.py"""
import json
import pathlib
import re
import tempfile
import unittest

import numpy as np

from mcdem import _engine as engine
from mcdem.convergence.convergence_types import Limits
from mcdem.convergence.simulator import Simulator
from mcdem.convergence.converge import Study, converge
from mcdem.errors import InputError

SCENE = """name = "small"
[box]
size_x = 0.06
size_y = 0.06
[contact]
model = "independent"
[packing]
count = 18
packing_fraction = 0.52
[plate]
start = 0.06
end = 0.05
[protocol]
scans_per_stroke = 4
stop_at_scans = false
rate_tolerance = 0
settle_time = 0.02
relax_time = 0.2
"""
PROGRAMME = """
[[programme]]
position = 0.046
speed = 1
scans = 6
[[programme]]
stage = "hold"
time = 0.1
scans = 2
[[programme]]
position = 0.06
speed = 1
scans = 6
"""
ONE_GRAIN = {"packing.count": 1, "packing.packing_fraction": 0.382, "packing.diameter_mean": 0.0215, "packing.diameter_sd": 1e-4,
             "packing.diameter_min": 0.0213, "packing.diameter_max": 0.0217, "box.size_x": 0.025, "box.size_y": 0.025, "plate.start": 0.022,
             "plate.end": 0.0195, "plate.speed": 0.5}


def pressed(changes, programme=""):
    text = SCENE.replace("scans_per_stroke = 4\n", "") if programme else SCENE
    return engine.Scene.parse(text + programme, set=changes)


class SmallScenes(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory(prefix="mcdem-convergence-")
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.stages = []

    def told(self, stage, fraction):
        if stage not in self.stages:
            self.stages.append(stage)

    def study(self, scene):
        simulator = Simulator(scene, self.folder, replicas=8, jitter=0, seed=1, device="")
        return Study(scene, simulator, 0, Limits(), self.told).run()

    def beyond(self, made):
        return {cause.cause for cause in made.causes if any(bin.beyond for bin in cause.errors)}

    def test_a_fast_plate_is_named_as_the_cause(self):
        """At 2 m/s the inertial number is 0.3."""
        made = self.study(pressed({"plate.speed": 2}))
        self.assertLessEqual({"plate speed", "inertia"}, self.beyond(made))
        self.assertNotIn("precision", self.beyond(made))
        self.assertLessEqual({"plate speed", "inertia", "time step", "precision", "list margin"}, set(self.stages))
        self.assertIn("plate.speed = 2 / ", made.words[1])

    def test_the_speeds_of_a_programme_are_refined_and_its_holds_are_compared(self):
        made = self.study(pressed({"plate.end": 0.046}, PROGRAMME))
        self.assertEqual(self.stages[0], "the programme's displacements")
        self.assertIn("plate speed", self.beyond(made))
        self.assertIn("speeds of stages", made.words[1])
        worst = max((bin for bin in made.causes[0].errors if bin.observable == "relaxation"), key=lambda bin: abs(bin.over_limit))
        self.assertGreater(worst.error, 2 * worst.standard_error, "grains at rest relax less than those that a plate has thrown")
        self.assertGreater(worst.mean, worst.error)

    def test_a_programme_of_forces_is_compared_at_equal_forces(self):
        """The force on the plate, which most other studies need, is then not an observable."""
        force = "\n[[programme]]\nforce = 1.0\nscans = 6\n"
        made = self.study(pressed({"plate.end": 0.03, "plate.speed": 0.3}, force))
        observables = {bin.observable for bin in made.causes[0].errors}
        self.assertIn("displacement", observables)
        self.assertNotIn("top_force", observables)

    def test_runs_that_stop_are_refused_at_once(self):
        for changes, programme, problem, stages in (
                ({"plate.end": 0.015}, "[[programme]]\nposition = 0.015\n", "does not come to the end of the programme", 1),
                ({"plate.start": 0.2, "plate.end": 0.19}, "", "0 of 8 replicas reach the first compared displacement", 1)):
            self.setUp()
            with self.assertRaisesRegex(InputError, problem):
                self.study(pressed(changes, programme))
            self.assertEqual(len(self.stages), stages)

    def test_new_packings_are_drawn_if_copies_hardly_differ(self):
        """One grain between floor and plate: the force does not depend on its position, so copies have no scatter."""
        made = self.study(pressed(ONE_GRAIN))
        self.assertRegex(made.copies, "new random packings")
        self.assertIn("new random packings", self.stages)
        self.assertGreater(made.causes[0].errors[0].standard_deviation, 0.01, "diameters differ")

    def test_stored_simulations_are_not_repeated(self):
        """mcdem.converge returns the content of its file; a second call makes the same of the same simulations."""
        scene, documents, files = pressed({"plate.speed": 0.5}), [], []
        for _ in range(2):
            documents.append(converge(scene, self.folder, replicas=8, progress=self.told))
            self.assertEqual(json.loads((self.folder / "convergence.json").read_text()), documents[-1])
            files.append(sorted(self.folder.rglob("*")))
            del documents[-1]["seconds"]
        self.assertEqual(documents[0], documents[1])
        self.assertEqual(files[0], files[1])
        self.assertEqual((documents[0]["scene"], documents[0]["replicas"]), (scene.name, 8))


class Changes(unittest.TestCase):
    def test_of_the_numerics_are_those_of_a_scene_with_other_keys(self):
        """As a scene that has these keys from the beginning."""
        changes = {"plate.speed": 0.25, "grains.density": 20, "numerics.precision": "double"}
        observed = []
        for scene, changed in ((pressed({"plate.speed": 1}), changes), (pressed(changes), {})):
            with tempfile.TemporaryDirectory() as folder:
                simulator = Simulator(scene, folder, replicas=2, jitter=1e-4, seed=3, device="")
                simulator.find_grid()
                observed.append(simulator.observe(changed))
        np.testing.assert_array_equal(*observed)
        self.assertTrue(np.isfinite(observed[0]).any())

    def test_of_packings_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            simulator = Simulator(pressed({}), folder, replicas=2, jitter=1e-4, seed=3, device="")
            simulator.find_grid()
            for key, value in (("packing.count", 3), ("numerics.skin", 3)):
                with self.assertRaisesRegex(InputError, re.escape(key)):
                    simulator.observe({key: value})

    def test_of_the_packing_leave_the_first_copy(self):
        """Copies have their own jitter; new packings begin with that of the scene."""
        with tempfile.TemporaryDirectory() as folder:
            simulator = Simulator(pressed({"plate.speed": 2}), folder, replicas=2, jitter=1e-4, seed=3, device="")
            simulator.find_grid()
            copies = simulator.observe({})
            self.assertTrue(simulator.draws_packings)
            simulator.draw_packings()
            drawn = simulator.observe({})
        np.testing.assert_array_equal(drawn[0], copies[0])
        for one, other in ((copies[0], copies[1]), (drawn[1], copies[1])):
            self.assertFalse(np.array_equal(one, other, equal_nan=True))


if __name__ == "__main__":
    unittest.main()
