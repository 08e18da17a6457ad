"""Diagnoses of simulated experiments with a scene of 64 grains: the planted effect is named, and no other. verdicts_test.py"""
import contextlib
import io
import json
import pathlib
import tempfile
import unittest

import mcdem
from mcdem.commands.command_line import run_command
from mcdem.errors import InputError
from mcdem.observe.observables import observables

SOURCES = pathlib.Path(__file__).resolve().parents[2]
SMALL = "--replicates 10 --pairs 2 --confirmations 4 --candidates "
FEW = SMALL + "friction,wall_friction,rolling_resistance,plate_speed"
BOX = "[box]\nsize_x = 0.083\nsize_y = 0.083\n"
CONTAINERS = ('[container]\nshape = "cylinder"\nradius = 0.047\n', '[container]\nshape = "periodic"\nsize_x = 0.08\nsize_y = 0.085\n')


class Case(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        self.take(SOURCES / "tests/ensemble/tiny_challenge.toml")

    def take(self, scene):
        (self.folder / "scene.toml").write_text(scene.read_text())

    def said(self, words):
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(run_command(words), 0)
        return out.getvalue()

    def experiment(self, changes=None, folder="e", seed=5):
        """With another packing, and the scene with these changes."""
        changes = {"protocol.scan_at_start": True, "packing.seed": seed, **(changes or {})}
        mcdem.run(mcdem.Scene.read(str(self.folder / "scene.toml"), set=changes), self.folder / f"run-{folder}")
        self.said(["experiment", "from-run", str(self.folder / f"run-{folder}"), "--out", str(self.folder / folder)])

    def words(self, options, experiments, out):
        return ["diagnose", str(self.folder / "scene.toml"), "--out", str(self.folder / out), "--no-figures", *options.split(),
                *(word for name in experiments for word in ("--experiment", str(self.folder / name)))]

    def diagnosis(self, options, *experiments, out="d"):
        self.said(self.words(options, experiments or ["e"], out))
        return json.loads((self.folder / out / "diagnosis.json").read_text())

    def expect(self, told, verdict, effect=None):
        self.assertEqual(told["verdict"], verdict, told["sentence"])
        if effect:
            self.assertEqual(told["causes"][0]["effect"], effect)


class Verdicts(Case):
    def test_a_slow_experiment_without_effect_gets_no_effect(self):
        """A real plate ten times slower than the scene's is not an effect: the scene's plate is too fast."""
        self.experiment({"plate.speed": 0.02})
        fast = self.diagnosis(FEW + " --refine 1")
        self.expect(fast, "not_converged")
        refinement, = fast["refinements"]
        self.assertEqual((refinement["key"], refinement["done"]), ("plate.speed", False))
        self.assertLessEqual(refinement["to"], 0.1)
        self.assertIn("set plate.speed = ", fast["next"][0]["what"])
        slow = self.diagnosis(FEW + " --refine 8")
        self.expect(slow, "no_gap")
        self.assertEqual([one["done"] for one in slow["refinements"]], [True])
        self.assertIn("with plate.speed = ", slow["sentence"])

    def test_with_a_rate_tolerance_a_slow_experiment_agrees_with_the_scene(self):
        self.experiment({"plate.speed": 0.01})
        told = self.diagnosis(FEW + " --set protocol.rate_tolerance=0.01")
        self.expect(told, "no_gap")
        self.assertEqual(told["refinements"], [])
        self.assertIn("plate_speed: protocol.rate_tolerance keeps", json.dumps(told["not_testable"]))

    def test_several_packings_get_one_verdict(self):
        for name, seed in (("a", 5), ("b", 6)):
            self.experiment({}, name, seed)
            self.experiment({"grains.friction": 0.15}, f"rough-{name}", seed)
        none = self.diagnosis(FEW, "a", "b")
        self.expect(none, "no_gap")
        self.assertEqual([pathlib.Path(one["experiment"]).name for one in none["packings"]], ["a", "b"])
        self.assertEqual(none["provenance"]["experiment"], ", ".join(str(self.folder / name) for name in "ab"))
        rough = self.diagnosis(FEW, "rough-a", "rough-b")
        self.expect(rough, "effect", "friction")
        self.assertAlmostEqual(rough["causes"][0]["amplitude"], 0.12, delta=4 * rough["causes"][0]["amplitude_error"])
        self.assertEqual([one["differs"] for one in rough["packings"]], [False, False])
        self.assertEqual([one["differs"] for one in self.diagnosis(FEW, "a", "rough-b")["packings"]], [True, True])
        with self.assertRaisesRegex(InputError, "--experiment: .*a is given twice"):
            self.diagnosis(FEW, "a", "a")

    def test_only_the_planted_effect_is_named_in_every_container(self):
        scene = (self.folder / "scene.toml").read_text()
        self.assertIn(BOX, scene)
        options = SMALL + "friction,viscoelasticity,force_bias"
        for number, container in enumerate(CONTAINERS):
            (self.folder / "scene.toml").write_text(scene.replace(BOX, container))
            self.experiment({}, f"e{number}")
            check = self.said(["experiment", "check", str(self.folder / f"e{number}")])
            self.assertIn("in addition: nothing", check)
            self.assertIn("suspicious data: nothing", check)
            self.expect(self.diagnosis(options, f"e{number}"), "no_gap")
            self.experiment({"grains.friction": 0.2}, f"f{number}")
            self.expect(self.diagnosis(options, f"f{number}"), "effect", "friction")

    def test_plate_and_positions_are_sufficient(self):
        self.experiment()
        (self.folder / "e/contacts.csv").unlink()
        self.assertIn("in addition: nothing", self.said(["experiment", "check", str(self.folder / "e")]))
        told = self.diagnosis(FEW)
        self.expect(told, "no_gap")
        self.assertIn("contacts.csv", json.dumps(told["not_measured"]))
        self.assertEqual([file.name for file in (self.folder / "d").iterdir() if file.suffix in (".png", ".pdf", ".svg")], [])
        without_forces = {one.name for one in observables() if one.needs in ("plate", "grains")}
        self.assertEqual({bin["observable"] for bin in told["cells"]}, without_forces)

    def test_a_candidate_whose_runs_fail_affects_only_itself(self):
        """Without any of the surface displacements free surfaces move too far, and the runs stop. The smallest accepted numbers of
        runs are sufficient, and give no false gap."""
        self.experiment({"contact.model": "mc_dem", "contact.gamma": 1.08})
        told = self.diagnosis("--replicates 8 --pairs 2 --confirmations 0 --candidates friction,bulge_contacts "
                              "--set contact.model=mc_dem --set contact.gamma=1.08")
        self.expect(told, "no_gap")
        self.assertGreater(len(told["cells"]), 100)

    def test_with_its_library_in_parts_it_is_the_same(self):
        self.experiment({"grains.friction": 0.3})
        options = "--replicates 8 --pairs 2 --confirmations 2 --candidates friction"
        alone = self.diagnosis(options)
        parts = self.words(options, ["e"], "parts")
        missing = self.said([*parts, "--missing"]).split()
        self.assertTrue(missing[0].startswith("1/"))
        for part in missing:
            self.said([*parts, "--part", part])
        self.assertEqual(self.said([*parts, "--missing"]), "")
        self.said([*parts, "--merge"])
        told = json.loads((self.folder / "parts/diagnosis.json").read_text())
        self.assertEqual({**told, "seconds": 0}, {**alone, "seconds": 0})
        self.assertEqual(*(len(list((self.folder / out / "simulations").iterdir())) for out in ("parts", "d")))


class Holds(Case):
    """Scenes of scenes/ with holds and prescribed forces, instead of the tiny one."""

    def verdict_on(self, name, change=None):
        self.experiment(change, name, 7)
        return self.diagnosis(SMALL + f"viscoelasticity,plasticity,friction --library {self.folder / 'l.json'}", name)

    def test_relaxation_is_distinguished_from_plasticity(self):
        self.take(SOURCES / "scenes/relaxation.toml")
        self.expect(self.verdict_on("plain"), "no_gap")
        for effect in ("viscoelasticity", "plasticity"):
            told = self.verdict_on(effect, {f"effects.{effect}": 0.2})
            self.expect(told, "effect", effect)
            self.assertEqual(len(told["causes"][0]["group"]), 1, told["causes"])

    def test_creep_under_prescribed_forces_is_named(self):
        self.take(SOURCES / "scenes/creep.toml")
        self.expect(self.verdict_on("plain"), "no_gap")
        self.expect(self.verdict_on("creeping", {"effects.viscoelasticity": 0.25}), "effect", "viscoelasticity")

    def test_programmes_of_scene_and_experiment_must_agree(self):
        self.experiment()
        self.take(SOURCES / "scenes/relaxation.toml")
        with self.assertRaisesRegex(InputError, r"experiment.toml must state the \[\[programme\]\] of the experiment, and plate.csv"):
            self.diagnosis("")


if __name__ == "__main__":
    unittest.main()
