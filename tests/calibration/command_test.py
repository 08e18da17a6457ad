"""The command calibrate: what it prints, the file that it writes, what it refuses. command_test.py"""
import contextlib
import dataclasses
import io
import json
import math
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

import mcdem
from mcdem.calibration import scene_calibration
from mcdem.calibration.scene_calibration import SceneCalibration
from mcdem.calibration.search import Calibration, Round
from mcdem.commands.command_line import run_command
from mcdem.observe.estimate import Estimate
from mcdem.results import ContactModel

sys.path.append(str(pathlib.Path(__file__).parents[1]))
from small_scene import scene_text  # noqa: E402

SCENE = scene_text("small", 0.0590)
ROUNDS = (Round(np.array([0.5, 1.0, 1.5]), np.array([2.0, 3.25, math.nan])),
          Round(np.array([0.75, 1.0]), np.array([2.5, 0.00123]), 0.98, 0.004))
FOUND = Calibration(0.98, 0.004, 2.5, True, 1.5, ROUNDS)
GAMMA = SceneCalibration(FOUND, Estimate(3.2, math.nan, 1), Estimate(3.1, math.nan, 1), 15e-3, 1)
MODULUS = dataclasses.replace(GAMMA, found=dataclasses.replace(FOUND, converged=False), target=Estimate(3.2, 0.03, 2),
                              simulated=Estimate(3.1, 0.04, 3), replicas=3, model=ContactModel.elastic_sphere, youngs_modulus=20e3)
SCATTER = ("the error leaves out the scatter between packings, because {} a single packing; this is correct only if both are the same "
           "packing\n")


class Command(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "small.toml").write_text(SCENE)
        mcdem.run(mcdem.Scene.parse(SCENE, set={"contact.model": "elastic_sphere"}), cls.folder / "run")

    def command(self, *words, found=None):
        """Exit code, output and messages, with this result of all simulations."""
        result = {"return_value": found} if found else {"side_effect": AssertionError("this must end before the simulations")}
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as messages, \
                mock.patch.object(scene_calibration, "calibrate_scene", **result):
            try:
                code = run_command(["calibrate", str(self.folder / "small.toml"), "--experiment", str(self.folder / "run"), *words])
            except mcdem.errors.InputError as error:
                return 2, out.getvalue(), str(error)
        return code, out.getvalue(), messages.getvalue()

    def test_a_calibration_of_gamma_is_printed(self):
        code, out, messages = self.command(found=GAMMA)
        self.assertEqual((code, messages), (0, ""))
        self.assertEqual(out, "round   gamma  top force [N]\n"
                              "─────  ──────  ─────────────\n"
                              "    1  0.5000          2.000\n"
                              "    1  1.0000          3.250\n"
                              "    1  1.5000      runs away\n"
                              "    2  0.7500          2.500\n"
                              "    2  1.0000         0.0012\n"
                              "\n"
                              "target: 3.200 N at 15.00 mm; 1 replica for each value\n"
                              "gamma = 0.9800 ± 0.0040\n" + SCATTER.format("scene and reference each have"))

    def test_a_calibration_of_the_modulus_is_printed(self):
        out = self.command(found=MODULUS)[1].splitlines()
        self.assertEqual([out[0], out[2]], ["round  E [kPa]  top force [N]", "    1  10.0000          2.000"])
        # 20 kPa times the root of 4^2 + 12^2 + 16^2 thousandths
        self.assertEqual(out[-2:], ["target: 3.200 ± 0.030 N at 15.00 mm; 3 replicas for each value",
                                    "E = 19.6000 ± 0.4079 kPa (tolerance not reached: raise --rounds, or use more replicas)"])

    def test_which_side_has_a_single_packing_is_told(self):
        for missing, side in (("target", "the reference has"), ("simulated", "the scene has")):
            found = dataclasses.replace(MODULUS, **{missing: Estimate(3.2, math.nan, 1)})
            self.assertTrue(self.command(found=found)[1].endswith(SCATTER.format(side)))

    def test_the_file_is_written(self):
        file = self.folder / "out" / "calibration.json"
        for found in (GAMMA, MODULUS):  # the second replaces the first
            out = self.command("--out", str(file.parent), found=found)[1]
            self.assertTrue(out.endswith(f"\nwrote {file}\n"))
        text = file.read_text()
        document = json.loads(text)
        self.assertEqual(text, json.dumps(document, indent=2, sort_keys=True, ensure_ascii=False) + "\n")
        self.assertEqual(document, {
            "contact_model": "elastic_sphere", "converged": False, "displacement_m": 15e-3, "program": mcdem.__version__,
            "reference": "elastic_sphere", "replicas": 3, "runs_away_at_youngs_modulus_Pa": 30e3, "scene": SCENE,
            "target_standard_error_N": 0.03, "target_top_force_N": 3.2, "youngs_modulus_Pa": 19.6e3,
            "youngs_modulus_Pa_standard_error": 20e3 * MODULUS.standard_error, "youngs_modulus_Pa_standard_error_of_fit": 80.0,
            "rounds": [{"youngs_modulus_Pa": [10e3, 20e3, 30e3], "top_force_N": [2.0, 3.25, None], "estimate": None,
                        "standard_error": None},
                       {"youngs_modulus_Pa": [15e3, 20e3], "top_force_N": [2.5, 0.00123], "estimate": 19.6e3, "standard_error": 80.0}]})
        file.write_text("mine")
        code, _, messages = self.command("--out", str(file.parent))
        self.assertEqual((code, messages), (2, f"{file}: is not a calibration; it is not replaced: give another path (--out), or remove it "
                                               "first"))
        self.assertEqual(file.read_text(), "mine")

    def test_several_keys_are_fitted(self):
        folder = self.folder / "fit"
        words = ["--model", "elastic_sphere", "--fit", "grains.youngs_modulus,grains.friction", "--rounds", "1", "--out", str(folder)]
        code, out, messages = self.command(*words)
        self.assertEqual(code, 0, messages)
        self.assertRegex(messages, r"round 1: grains.youngs_modulus = 23.\d* (± \S+ )?kPa, grains.friction = 0.0\d*.*; misfit 0 \(rms: force 0 N")
        self.assertRegex(out, r"^key +value +scene +change\n")
        self.assertTrue(out.endswith(f"wrote {folder / 'calibration.json'}\n"))
        document = json.loads((folder / "calibration.json").read_text())
        self.assertEqual(list(document["keys"]), ["grains.friction", "grains.youngs_modulus"])
        self.assertEqual(document["differences"]["force"]["after"], 0)  # the scene made the reference
        self.assertEqual((document["Rtop"], len(document["rounds"])), ([1, 1], 1))
        self.assertTrue(list((folder / "trials").iterdir()))

    def test_wrong_options_are_refused(self):
        for words, problem in ((["--model", "hertz"], '--model must be one of independent, .*, got "hertz"'),
                               (["--compare", "force"], "--compare: is an option of --fit"),
                               (["--fit", "grains.youngs_moduls", "--model", "mc_dem"], r"did you mean grains.youngs_modulus\?"),
                               (["--setting", "nope"], "--setting: must be one of .*run's: elastic_sphere; got nope"),
                               (["--experiment", str(self.folder / "nowhere")], "nowhere: must be a result folder or file"),
                               (["--out", str(self.folder / "small.toml")], "small.toml: is a file; give a folder for the results")):
            code, out, messages = self.command(*words)
            self.assertEqual((code, out), (2, ""))
            self.assertRegex(messages, problem)


if __name__ == "__main__":
    unittest.main()
