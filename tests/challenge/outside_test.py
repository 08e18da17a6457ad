"""Effects that no library has change the simulated experiment as they say. outside_test.py"""
import csv
import gzip
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from mcdem._engine import scene_of_options
from mcdem.challenge.case import ChallengeCase, Hidden
from mcdem.challenge.case_simulator import CaseSimulator
from mcdem.challenge.outside_effects import OUTSIDE_EFFECTS
from mcdem.experiment.experiment import Measurement
from mcdem.experiment.from_run import experiment_from
from mcdem.experiment.write import write_experiment

sys.path.append(str(pathlib.Path(__file__).parents[1]))
from small_scene import scene_text  # noqa: E402

SCENE = scene_text("small", 0.0555)
AMPLITUDES = {"barrel": 0.01, "plate_backlash": 1e-3, "soft_walls": 2.0, "mixed_forces": 0.3}


def table(folder, name):
    """Columns by name; texts where they are no numbers."""
    with gzip.open(folder / f"{name}.csv.gz", "rt", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {column: np.array([row[column] for row in rows]) for column in rows[0]}


def numbers(folder, name, column):
    return table(folder, name)[column].astype(float)


class OutsideEffects(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "small.toml").write_text(SCENE)
        scene, _ = scene_of_options(str(cls.folder / "small.toml"), [])
        simulator = CaseSimulator(scene, Measurement(), "")  # measured without errors
        simulator.make_packings([1])
        effects = {"nothing": (), **{name: (Hidden(name, amplitude),) for name, amplitude in AMPLITUDES.items()}}
        cases = [ChallengeCase(name, "", hidden, (), (), 0, 5) for name, hidden in effects.items()]
        failures = simulator.simulate(cases, False, lambda fraction: None)
        assert not any(failures), failures
        for k, name in enumerate(effects):
            write_experiment(cls.folder / name, experiment_from(simulator.measured(k), Measurement()), gzip=True)

    def values(self, effect, name, column):
        """Those of the experiment without an effect, and of the one with it."""
        return (numbers(self.folder / case, name, column) for case in ("nothing", effect))

    def test_are_all_tried_here(self):
        self.assertEqual(set(AMPLITUDES), {effect.name for effect in OUTSIDE_EFFECTS})

    def test_barrel_moves_grains_and_contacts_from_the_axis_with_the_cube_of_their_distance(self):
        half = 0.5 * scene_of_options(str(self.folder / "small.toml"), [])[0]._values["box.size_x"]
        for name in ("grains", "contacts"):
            x, y = ((before - half, after - half) for before, after in (self.values("barrel", name, axis) for axis in ("x_m", "y_m")))
            part = 1 + 0.01 * (x[0] ** 2 + y[0] ** 2) / half**2
            for before, after in (x, y):
                np.testing.assert_allclose(after, part * before, rtol=1e-5, atol=1e-8)
            np.testing.assert_array_equal(*self.values("barrel", name, "z_m"))

    def test_mixed_forces_keep_directions_and_approach_the_mean_of_their_grains(self):
        before, after = (np.column_stack([numbers(self.folder / case, "contacts", f"f{axis}_N") for axis in "xyz"])
                         for case in ("nothing", "mixed_forces"))
        np.testing.assert_allclose(np.cross(before, after), 0, atol=1e-12)
        small, large = (np.linalg.norm(one, axis=1) for one in (before, after))
        self.assertLess(large.std() / large.mean(), small.std() / small.mean())
        self.assertAlmostEqual(np.polyfit(small, large, 1)[0], 0.7 + 0.3 * 0.5, delta=0.15)  # a half of a mean of few is its own

    def test_plate_backlash_moves_the_plate_on_its_way_up(self):
        before, after = self.values("plate_backlash", "plate", "plate_z_m")
        is_up = table(self.folder / "nothing", "plate")["phase"] == "unload"
        self.assertEqual(set(is_up), {True, False})
        np.testing.assert_allclose(after - before, np.where(is_up, 1e-3, 0), atol=1e-9)
        np.testing.assert_array_equal(*self.values("plate_backlash", "grains", "z_m"))

    def test_soft_walls_lower_the_force(self):
        is_deepest = np.argmin(numbers(self.folder / "nothing", "plate", "plate_z_m"))
        before, after = (force[is_deepest] for force in self.values("soft_walls", "plate", "top_force_N"))
        self.assertLess(after / before, 0.98)

    def test_the_stated_box_stays(self):
        for effect in AMPLITUDES:
            settings = (self.folder / effect / "experiment.toml").read_text().replace(effect, "nothing")
            self.assertEqual(settings, (self.folder / "nothing/experiment.toml").read_text())


if __name__ == "__main__":
    unittest.main()
