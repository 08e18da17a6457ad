"""mcdem.diagnose gives the same as `mcdem diagnose`, key by key; functions that call the program.

diagnosis_test.py PROGRAM
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import mcdem
from small import SMALL

PROGRAM = sys.argv.pop(1)
FEW = {"candidates": ["adhesion", "friction"], "replicates": 8, "pairs": 2, "confirmations": 2, "page": False}


class Diagnoses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kept = tempfile.TemporaryDirectory(prefix="mcdem-diagnosis-")
        cls.addClassCleanup(kept.cleanup)
        cls.folder = pathlib.Path(kept.name)
        os.environ["MCDEM_PROGRAM"] = PROGRAM
        cls.scene = mcdem.Scene(SMALL, contact={"model": "elastic_sphere"})
        reality = mcdem.Scene({**SMALL, "protocol": {**SMALL["protocol"], "scan_at_start": True}},
                              contact={"model": "elastic_sphere"}, effects={"adhesion": 0.5})
        mcdem.run(reality, cls.folder / "run")
        cls.program("experiment", "from-run", "run", "--out", "measured")

    @classmethod
    def program(cls, *words):
        subprocess.run([PROGRAM, *words], cwd=cls.folder, check=True, capture_output=True)

    def test_equals_the_file_and_the_program(self):
        """Notes of the program are warnings: here that the experiment states another modulus than the scene."""
        told = []
        stiffer = mcdem.Scene(SMALL, contact={"model": "elastic_sphere"}, grains={"youngs_modulus": 3e4})
        with self.assertWarnsRegex(RuntimeWarning, r"experiment.toml states grains.youngs_modulus = .* \(scene: 30000\)"):
            said = mcdem.diagnose(stiffer, self.folder / "measured", self.folder / "out", **{**FEW, "page": True}, refine=1,
                                  progress=lambda stage, fraction: told.append((stage, fraction)))
        self.assertIn("diagnosis", (self.folder / "out/diagnosis.html").read_text().lower())
        self.assertEqual(said, json.loads((self.folder / "out/diagnosis.json").read_text()))
        self.assertIn(said["verdict"], ("no_gap", "effect", "group", "unknown_effect", "not_converged",
                                        "calibration_suspect"))
        self.assertEqual({one["effect"] for one in said["ranking"]},
                         {"adhesion", "friction", "modulus", "strain_offset"})  # both candidates, and the nuisances
        self.assertIn("library", {stage for stage, _ in told})
        (self.folder / "scene.toml").write_text(stiffer.text)
        self.program("diagnose", "scene.toml", "--experiment", "measured", "--out", "out", "--candidates",
                     "adhesion,friction", "--replicates", "8", "--pairs", "2", "--confirmations", "2", "--refine", "1", "--no-figures")
        other = json.loads((self.folder / "out/diagnosis.json").read_text())
        for varying in ("seconds", "provenance"):
            del said[varying], other[varying]
        self.assertEqual(said, other)

    def test_exports_a_run(self):
        view = self.folder / "view"
        count = mcdem.export(self.folder / "run", view, vtk=True, xyz=True, replicas=[0], scans=[0, 1])
        self.assertEqual(count, sum(1 for file in view.rglob("*.*") if file.suffix in (".hdf", ".xyz", ".dump")))
        with self.assertRaisesRegex(ValueError, "vtk, xyz or both"):
            mcdem.export(self.folder / "run", view)

    def test_reports_runs_and_diagnoses(self):
        page = mcdem.report(self.folder / "run", self.folder / "page.html", against=[self.folder / "measured"])
        self.assertIn("errf", page.read_text())  # a column of the table of a comparison
        with self.assertRaisesRegex(ValueError, "nowhere"):
            mcdem.report([self.folder / "nowhere"], self.folder / "none.html")
        self.assertFalse((self.folder / "none.html").exists())

    def test_an_interruption_by_the_callback_is_passed_on(self):
        def refuse(stage, fraction):
            raise InterruptedError(stage)

        with self.assertRaises(InterruptedError):
            mcdem.diagnose(self.scene, self.folder / "measured", self.folder / "refused", **FEW, progress=refuse)
        self.assertFalse((self.folder / "refused/diagnosis.json").exists())

    def test_bad_input(self):
        with self.assertRaisesRegex(ValueError, "replicates: must be 8 or more, got 1\npairs: must be 2 or more"):
            mcdem.diagnose(self.scene, self.folder / "measured", self.folder / "bad", replicates=1, pairs=1)
        with self.assertRaisesRegex(ValueError, "refine: must be between 1 and 64, got 0.5"):
            mcdem.diagnose(self.scene, self.folder / "measured", self.folder / "bad", refine=0.5, **FEW)
        with self.assertRaisesRegex(ValueError, "nowhere"):
            mcdem.diagnose(self.scene, self.folder / "nowhere", self.folder / "bad")
        with self.assertRaisesRegex(ValueError, "gremlins"):
            mcdem.diagnose(self.scene, self.folder / "measured", self.folder / "bad", candidates=["gremlins"])


if __name__ == "__main__":
    unittest.main()
