"""mcdem.compare for runs and experiments with known forces. comparing_test.py"""
import math
import os
import pathlib
import sys
import tempfile
import unittest
from dataclasses import replace
from unittest import mock

import h5py
import numpy as np

TESTS = pathlib.Path(__file__).parents[1]
sys.path[:0] = [str(TESTS.parent / "host/python"), str(TESTS / "results")]
import written  # noqa: E402

from mcdem.comparing import compare  # noqa: E402
from mcdem.errors import InputError  # noqa: E402
from mcdem.results import read_run  # noqa: E402

FORCES = np.array([1.25, 3.5, 2.0])  # of the plate in written.scans() [N]
METRICS = ["Rtop", "errf", "errZ", "bhat", "tau"]
PLATE = ("frame,cycle,phase,plate_z_m,top_force_N\n0,0,load,0.09,9\n1,0,load,0.08,9\n2,0,unload,0.085,9\n"
         "3,1,load,0.09,1.25\n4,1,load,0.08,3.5\n5,1,unload,0.085,2\n")


def rms(values):
    return math.sqrt(np.mean(np.square(values)))


class Comparing(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.file = self.folder / "run.h5"
        written.write_run(self.file)
        self.run_ = read_run(self.file, contacts=True)

    def half(self, model="mc_dem"):
        """The recording with half the force, of another setting if the model is another."""
        one = self.run_.recordings[0]
        return replace(one, label=model, parameters=one.parameters | {"contact.model": f'"{model}"'},
                       scans=replace(one.scans, wall_force=0.5 * one.scans.wall_force))

    def test_keys_and_values(self):
        one, = compare(self.run_, self.file)
        self.assertEqual(list(one), ["setting", "replicas", *(key for name in METRICS for key in (name, f"{name}_standard_error")), "notes"])
        self.assertEqual({key: value for key, value in one.items() if value is not None},
                         {"setting": "mc_dem", "replicas": 1, "Rtop": 1, "errf": 0, "errZ": 0, "bhat": 0, "tau": 0,
                          "notes": ["bhat rests on the 2 levels with contacts on both sides"]})
        self.assertEqual({type(one[name]) for name in METRICS}, {float})

    def test_every_setting_is_compared(self):
        run = replace(self.run_, recordings=(self.half("independent"), self.run_.recordings[0]))
        both = compare(run, str(self.folder))
        self.assertEqual([(one["setting"], one["Rtop"]) for one in both], [("independent", 0.5), ("mc_dem", 1)])
        self.assertAlmostEqual(both[0]["errf"], rms(FORCES / 2), 14)

    def test_levels_without_a_touch_are_left_out(self):
        one, = compare(replace(self.run_, recordings=(self.half(),)), self.folder, touch_force=1.5)
        self.assertAlmostEqual(one["errf"], rms(FORCES[1:] / 2), 14)

    def test_unknown_numbers_are_none(self):
        bare = read_run(self.file).recordings[0]
        bare = replace(bare, scans=replace(bare.scans, coordination_number=np.array([1.0, 1.0, 2.0])))
        one, = compare(replace(self.run_, recordings=(bare,)), self.file)
        self.assertEqual([one[name] for name in ("Rtop", "errf", "bhat", "tau")], [1, 0, None, None])
        self.assertAlmostEqual(one["errZ"], rms([1 - 3 / 4, 1 - 0, 2 - 5 / 4]), 14)  # 3, 0 and 5 ends of contacts at 4 grains
        self.assertIn("errZ is without threshold: the simulation has no contacts recorded", one["notes"])

    def test_errors_of_replicas(self):
        written.write_run(self.file, replicas=2)
        pair = read_run(self.file, contacts=True)
        one, = compare(replace(pair, recordings=(pair.recordings[0], replace(self.half(), parameters=pair.recordings[1].parameters))),
                       self.file)
        self.assertEqual((one["replicas"], one["Rtop"]), (2, 0.75))
        # forces F and F/2 over F and F, paired by seed: residuals +-F/4
        self.assertAlmostEqual(one["Rtop_standard_error"], 0.25, 14)

    def test_a_setting_of_the_reference_is_chosen(self):
        written.write_run(self.file, replicas=2)
        with h5py.File(self.file, "r+") as run:
            run["parameters/replica_00001"][0, 1] = b"hertz"
            run["particles/replica_00001"].attrs["label"] = np.bytes_("hertz")
            run["observables/replica_00001"][...] = doubled(run["observables/replica_00001"][()])
        for setting, Rtop in (("", 1), ("hertz", 0.5)):
            self.assertEqual(compare(self.run_, self.file, setting=setting)[0]["Rtop"], Rtop)
        with self.assertRaisesRegex(InputError, "setting: must be one of made by hand's: mc_dem, hertz; got soft"):
            compare(self.run_, self.file, setting="soft")

    def test_first_cycles_of_an_experiment_are_discarded(self):
        lab, program = self.folder / "lab", self.folder / "mcdem"
        lab.mkdir()
        (lab / "experiment.toml").write_text("[box]\nsize = [0.05, 0.06]\n[plate]\nstart = 0.1\n")
        (lab / "plate.csv").write_text(PLATE)
        program.write_text("#!/bin/sh\n")  # stands for the program that checks the folder
        program.chmod(0o755)
        with mock.patch.dict(os.environ, MCDEM_PROGRAM=str(program)):
            self.assertEqual(compare(self.run_, lab, discard=1)[0]["errf"], 0)
            self.assertAlmostEqual(compare(self.run_, lab)[0]["errf"], rms(FORCES - (9 + FORCES) / 2), 14)
            with self.assertRaisesRegex(InputError, "reference: must have scans after its discarded cycles"):
                compare(self.run_, lab, discard=2)


def doubled(rows):
    rows["wall_force"] *= 2
    return rows


if __name__ == "__main__":
    unittest.main()
