"""mcdem what-if: forces that are known from scaling, ends of ranges, files, what is refused. what_if_test.py"""
import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

import mcdem
from mcdem import _engine
from mcdem.calibration.fit import End
from mcdem.calibration.what_if import WhatIfOptions, what_if
from mcdem.commands.command_line import run_command
from mcdem.errors import InputError
from mcdem.report.what_if import what_if_figure_values, what_if_text
from mcdem.results.engine_run import run_of

sys.path.append(str(pathlib.Path(__file__).parents[1]))
from small_scene import scene_text  # noqa: E402

TEXT = scene_text("small", 0.054)
FAST = {"protocol.scans_per_stroke": 8, "protocol.rate_tolerance": 0.1}
STROKE = 8.5  # [mm]


def scene(**keys):
    return mcdem.Scene.parse(TEXT, set=FAST | {key.replace("__", "."): value for key, value in keys.items()})


def found(of_scene, reference=None, **options):
    return what_if(of_scene, reference, WhatIfOptions(**options), lambda _: None, lambda _: None)


class Moves(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_of_scene = run_of(mcdem.simulate(scene())).recordings
        cls.top = cls.run_of_scene[0].scans.top_force[7]  # at full stroke

    def test_the_modulus_scales_the_force(self):
        result = found(scene(), keys=["grains.youngs_modulus", "grains.friction=0..0.04"], target=("top_force", 1.3 * self.top),
                       shown=["force@6", "force_share@6", "coordination@8.5"])
        modulus, friction = result.moves
        self.assertTrue(modulus.is_met)
        # Walls are two thousand times as stiff; the weight of the grains and the accuracy of 0.5 % remain.
        self.assertAlmostEqual(modulus.key.relative(modulus.value), 0.3, delta=0.02)
        self.assertAlmostEqual(modulus.numbers[0] / self.top, 1.3, delta=0.0065)
        self.assertAlmostEqual(modulus.numbers[2], result.base[2], delta=0.05 * result.base[2])  # the shape remains
        self.assertEqual([one.name for one in result.shown], ["top_force", "force@6", "force_share@6", "coordination@8.5"])
        self.assertAlmostEqual(result.base[0], self.top, delta=1e-9)
        self.assertEqual((friction.is_met, friction.end), (False, End.out_of_range))
        nearest = np.argmin(np.abs(friction.trials[:, 1] - 1.3 * self.top))
        self.assertEqual((friction.value, friction.numbers[0]), tuple(friction.trials[nearest]))
        text = what_if_text(result)
        self.assertRegex(text, r"grains.youngs_modulus +\S+ kPa +\+(29|30|31)\S* % +yes ")
        self.assertRegex(text, r"grains.friction +\S+ +\S+ % +no: end of its range ")
        self.assertRegex(text, r"none: the scene +– +– +– +")

    def test_keys_that_move_together_keep_their_ratio(self):
        result = found(scene(grains__friction=0.1, walls__friction=0.2), keys=["grains.friction+walls.friction"], rounds=1,
                       target=("top_force", self.top))
        self.assertEqual(result.moves[0].key.values(0.3), {"grains.friction": 0.3, "walls.friction": 0.6})

    def test_a_zero_that_is_read_too_high_shifts_the_curve(self):
        measured = found(scene(), keys=["strain_offset=-1e-3..1e-3"], target=("force@6", float(self.force_at(6.3))), shown=["top_force"])
        move = measured.moves[0]
        self.assertTrue(move.is_met)
        self.assertAlmostEqual(move.value, 0.3e-3, delta=0.05e-3)  # forces are interpolated between scans that are 1 mm apart

    def force_at(self, displacement):
        recording = self.run_of_scene[0]
        load = recording.scans.phase == 0
        return np.interp(displacement, recording.displacement[load] * 1e3, recording.scans.top_force[load])

    def test_the_measured_top_force_is_the_target(self):
        measured = run_of(mcdem.simulate(scene(grains__youngs_modulus=28e3))).recordings
        result = found(scene(), measured, keys=["grains.youngs_modulus"])
        self.assertEqual(result.target, measured[0].scans.top_force[7])
        self.assertAlmostEqual(result.moves[0].value, 28e3, delta=0.01 * 28e3)
        self.assertIn("\nexperiment ", what_if_text(result))
        counted = run_of(mcdem.simulate(scene(protocol__force_threshold=0.02))).recordings  # of the same scene, without weak contacts
        same = found(scene(), counted, keys=["grains.youngs_modulus"], rounds=1)
        np.testing.assert_array_equal(same.base, same.measured_numbers)
        self.assertEqual(what_if_figure_values(result)["measured"][1][-1], result.target)

    def test_a_scene_that_stops_tells_how_far_it_came(self):
        result = found(scene(contact__model="mc_dem", contact__gamma=0.5, numerics__overlap_limit=0.25, plate__end=0.05), rounds=1,
                       keys=["effects.diameter_error"], target=("top_force", 2.0))
        self.assertTrue(np.isnan(result.base[0]))
        self.assertRegex(what_if_text(result), r"the scene's own simulations stop at \d+\.\d mm and \S+ N")

    def test_the_keys_by_default_are_those_that_the_scene_has(self):
        def moved(of_scene):
            return [move.key.name for move in found(of_scene, target=("top_force", self.top), rounds=1).moves]

        self.assertEqual(moved(scene()), ["grains.youngs_modulus", "grains.poisson_ratio", "grains.friction+walls.friction",
                                          "effects.diameter_error", "strain_offset"])

    def test_what_cannot_be_moved_is_refused(self):
        for problem, changes, options in (("top_forc: must be top_force, force@MM", {}, {"target": ("top_forc", 1)}),
                                          ("force@9: must be .* within the stroke of 8.50 mm", {}, {"target": ("force@9", 1)}),
                                          ("grains.young: must be strain_offset, or a key", {}, {"keys": ["grains.young"]}),
                                          ("must not be 0 in the scene", {"walls__friction": 0}, {"keys": ["grains.friction+walls.friction"]}),
                                          ("contact.model must be the same", {"batch__vary__contact__model": ["independent", "mc_dem"]}, {}),
                                          ("a target is required", {}, {"target": None})):
            with self.subTest(problem), self.assertRaisesRegex(InputError, problem):
                found(scene(**changes), **{"target": ("top_force", 1.0), "keys": ["grains.friction"]} | options)


class Command(unittest.TestCase):
    def command(self, *words):
        """Exit code, output and messages."""
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as messages:
            try:
                code = run_command(["what-if", *words])
            except InputError as error:
                return 2, out.getvalue(), str(error)
            except SystemExit as left:
                code = left.code
        return code, out.getvalue(), messages.getvalue()

    def test_files_are_written_and_an_interrupted_command_continues(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        file, out = pathlib.Path(folder.name, "small.toml"), pathlib.Path(folder.name, "out")
        file.write_text(TEXT)
        words = [str(file), *(f"--set={key}={value}" for key, value in FAST.items()), "--target", "top_force=1", "--keys",
                 "grains.youngs_modulus", "--out", str(out)]
        code, first, messages = self.command(*words)
        self.assertEqual(code, 0, messages)
        self.assertRegex(messages, r"top force, 1 wanted: grains.youngs_modulus = \S+ kPa: \S+( \(met\))?\n")
        document = json.loads((out / "what_if.json").read_text())
        self.assertEqual(document["what_if_target"], {"name": "top_force", "unit": "N", "value": 1})
        move, = document["moves"]
        self.assertEqual((move["key"], move["met"]), ("grains.youngs_modulus", True))
        self.assertTrue((out / "what_if.png").stat().st_size > 10_000 and first.endswith(f"  {out / 'what_if.png'}\n"))
        with unittest.mock.patch.object(_engine.Batch, "simulate", side_effect=AssertionError("all trials are kept")):
            self.assertEqual(self.command(*words)[:2], (0, first))
        (out / "what_if.json").write_text("mine")
        self.assertIn("what_if.json: is not a table of what-if; it is not replaced", self.command(*words)[2])

    def test_wrong_options_are_refused(self):
        for words, problem in ((["--target", "top_force"], "--target: must be NAME=VALUE, as in top_force=15.5, got top_force"),
                               (["--target", "top_force=1", "--accuracy", "0"], "--accuracy: must be a number > 0, got 0"),
                               ([], "--target: is required without --experiment")):
            code, out, messages = self.command("nowhere.toml", *words)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(problem, messages)


if __name__ == "__main__":
    unittest.main()
