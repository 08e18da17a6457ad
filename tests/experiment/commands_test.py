"""`mcdem experiment from-run` and `check`, given as a user gives them. commands_test.py"""
import filecmp
import os
import shutil
import subprocess
import unittest

import numpy as np
from forgeries import FORGERIES, forge, without_grains
from small_run import AT_REST, STAGES, CommandCase, mcdem_command

from mcdem import _engine
from mcdem.experiment.experiment import Measurement
from mcdem.experiment.instrument import Instrument, measured
from mcdem.experiment.from_run import experiment_from
from mcdem.experiment.read import read_experiment
from mcdem.experiment.write import write_experiment
from mcdem.results.engine_run import run_of
from mcdem.results.read import read_run

INDEPENDENT = "contact.model", "independent"
NOISY = {"force_bias": 0.03, "threshold_shift": -0.01, "position_bias": 0.002, "strain_offset": 1e-4}
FROM_RUN = ["experiment", "from-run"]
CHECK = ["experiment", "check"]


class Made(CommandCase):
    def from_run(self, out, *more):
        return self.done(*FROM_RUN, "a", "--out", out, *more)

    def expect_sums(self, experiment):
        subprocess.run(["sha256sum", "--check", "--strict", "--quiet", "SHA256SUMS"], cwd=experiment, check=True)

    def text(self, name):
        return (self.folder / name).read_text()

    def checked(self, experiment):
        return self.done(*CHECK, experiment).out


class FromRun(Made):
    def test_a_run_becomes_an_experiment_without_warnings(self):
        self.run_small(AT_REST)
        made = self.from_run("e", "--replica", "elastic_sphere", "--uncertainty", "grains.youngs_modulus=500", "--uncertainty",
                             "walls.friction=0.01")
        self.assertEqual(made.err, "")
        self.assertRegex(made.out, r"^e: 9 frames, 30 grains, \d+ of \d+ contacts seen\n$")
        e = read_experiment(self.folder / "e")
        self.assertEqual((e.name, e.materials["grains.youngs_modulus"]), ("small, elastic_sphere", 23300))
        self.assertEqual(e.uncertainty, {"grains.youngs_modulus": 500, "walls.friction": 0.01})
        self.assertEqual(e.measurement, Measurement(1e-4, 5e-5, 0.05, 4e-3))
        self.assertEqual(e.recording.displacement[0], 0)
        checked = self.checked("e")
        self.assertTrue(checked.startswith("small, elastic_sphere\n\navailable data\n"), checked)
        for part in ("\n  grains.csv      30 grains of ", "\n  experiment.toml [uncertainty] of grains.friction: ",
                     "\nsuspicious data: nothing\n", "required by `mcdem diagnose` in addition: nothing\n"):
            self.assertIn(part, checked)
        self.assertLessEqual(max(map(len, checked.splitlines())), 110)
        self.done("compare", "a", "--against", "e")

    def test_the_folder_returns_what_the_instrument_read(self):
        """Averages over contacts, and forces on walls as sums of those, are the same from the tables as from the instrument."""
        self.run_small(AT_REST)
        names = ("frame", "cycle", "phase", "settled", "time", "plate_z", "wall_force", "kinetic_energy", "elastic_energy",
                 "coordination_number", "mean_force", "packing_fraction", "branch_length")
        for stated, more in ((Measurement(1e-4, 5e-5, 0.05, 0.02), NOISY), (Measurement(), {})):
            truth = run_of(_engine.read_replica("a", 1)).recordings[0]
            seen = measured(truth, Instrument(stated, **more), 7)
            write_experiment("e", experiment_from(seen, stated))
            read = read_experiment(self.folder / "e").recording
            np.testing.assert_array_equal(read.diameter, seen.diameter)
            self.assertEqual(read.plate_start, seen.plate_start)
            for name in names:
                np.testing.assert_allclose(getattr(read.scans, name), getattr(seen.scans, name), rtol=1e-13, atol=1e-15, err_msg=name)
            np.testing.assert_array_equal(read.scans.position, seen.scans.position)
            for found, wanted in zip(read.scans.contacts, seen.scans.contacts, strict=True):
                for name in ("grain", "partner", "point", "force", "overlap"):
                    np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name), err_msg=name)

    def test_the_seed_determines_the_noise(self):
        self.run_small(AT_REST)
        for out, seed in (("e", "3"), ("same", "3"), ("other", "4")):
            self.from_run(out, "--replica", "0", "--seed", seed)
        self.from_run("packed", "--replica", "0", "--seed", "3", "--gzip", "--name", "a secret")
        for table in ("grains.csv", "contacts.csv"):
            self.assertEqual([filecmp.cmp(f"e/{table}", f"{other}/{table}", shallow=False) for other in ("same", "other")], [True, False])
            self.assertFalse((self.folder / "packed" / table).exists())
        self.assertTrue(filecmp.cmp("e/plate.csv", "other/plate.csv", shallow=False))
        plain, packed = (read_experiment(self.folder / name) for name in ("e", "packed"))
        self.assertEqual(packed.name, "a secret")
        np.testing.assert_array_equal(packed.recording.scans.position, plain.recording.scans.position)
        np.testing.assert_array_equal(packed.recording.scans.mean_force, plain.recording.scans.mean_force)


class Programmes(Made):
    def run_stages(self, *settings):
        self.run_small(*settings, INDEPENDENT, ("plate.end", 0.06), scene=STAGES)

    def test_are_kept_with_forces_and_times(self):
        self.run_stages(AT_REST)
        self.from_run("e")
        seen, truth = read_experiment(self.folder / "e").recording, read_run("a").recordings[0]
        self.assertEqual(seen.scans.time.tolist(), truth.scans.time.tolist())
        self.assertEqual(len(seen.scans), 9)
        plate = self.text("e/plate.csv")
        self.assertIn("top_force_N,set_force_N,time_s\n0,0,load,", plate)
        self.assertIn(",0.2,0.", plate)
        checked = self.checked("e")
        self.assertIn("suspicious data: nothing", checked)
        self.assertIn("a programme of 4 stages in", checked)
        self.expect_sums("e")

    def test_have_one_frame_for_each_scan(self):
        self.run_stages()
        self.refused([*FROM_RUN, "a", "--out", "e"], "the run must have the 8 scans of its programme and one before them, at rest, got 8: "
                     "run it to its end, with protocol.scan_at_start = true")


class BadInput(Made):
    def test_wrong_options_are_refused(self):
        self.run_small(AT_REST)
        for words, part in (([], "--replica: must be a number or label of a's replicas (0: independent, 1: elastic_sphere); got none"),
                            (["--replica", "0", "--position-error", "0.01"], "--position-error: must be at most an eighth"),
                            (["--force-threshold", "weak"], "--force-threshold"), (["--uncertainty", "friction=1"], "must be KEY=SIGMA")):
            with self.subTest(words):
                self.refused([*FROM_RUN, "a", "--out", "e", *words], part)
                self.assertFalse((self.folder / "e").exists())

    def test_what_is_no_run_or_no_experiment_is_named(self):
        self.run_small(AT_REST)
        for words, part in (([*FROM_RUN, "nowhere", "--out", "e"], "nowhere"), ([*FROM_RUN, "small.toml", "--out", "e"], "small.toml"),
                            (["experiment", "invent"], "invent"), ([*CHECK, "nowhere"], "nowhere: must be an experiment's folder"),
                            ([*CHECK, "a"], "a: is not an experiment")):
            with self.subTest(words):
                self.refused(words, part)


class Folders(Made):
    def test_measured_data_are_not_overwritten_and_other_files_are_kept(self):
        self.run_small(AT_REST)
        (self.folder / "e").mkdir()
        (self.folder / "e/notes").write_text("mine")
        self.from_run("e", "--replica", "0")
        self.assertEqual(self.text("e/notes"), "mine")
        self.expect_sums("e")
        words = [*FROM_RUN, "a", "--replica", "1", "--out"]
        self.refused([*words, "e"], "--out: e holds another experiment")
        self.refused([*words, "a"], "--out: a holds another experiment or run")
        self.expect_sums("e")
        unwritable = mcdem_command(*words, "/proc/nowhere")
        self.assertEqual(unwritable.code, 1)
        self.assertIn("/proc/nowhere: ", unwritable.err)


class Diagnosis(Made):
    def test_needs_what_the_check_says(self):
        """Both commands name missing data in the same words, before any simulation."""
        def expect(words):
            needs = self.checked("e").partition("required by `mcdem diagnose`")[2]
            self.assertIn(words, " ".join(needs.split()))
            self.refused(["diagnose", "small.toml", "--experiment", "e", "--out", "out"], words)
            self.assertFalse((self.folder / "out/simulations").exists())

        self.run_small(AT_REST)
        self.from_run("e", "--replica", "elastic_sphere")
        settings = self.text("e/experiment.toml")
        (self.folder / "e/experiment.toml").write_text(settings[:settings.index("[measurement]")])
        expect("a line such as `position_error = 1e-4 # [m]`")
        expect("a line such as `force_error = 0.05 # relative`")
        (self.folder / "e/contacts.csv").unlink()
        (self.folder / "e/grains.csv").unlink()
        self.assertIn("in addition: nothing", self.checked("e"))  # a curve alone is compared with packings that are drawn


class Forged(Made):
    def setUp(self):
        super().setUp()
        self.run_small(AT_REST, INDEPENDENT)

    def forged(self, change):
        shutil.copy("a/run.h5", "forged.h5")
        forge("forged.h5", change)
        return [*FROM_RUN, "forged.h5", "--out", "e"]

    def test_runs_are_readable_or_refused(self):
        refused = []
        for name, change in FORGERIES.items():
            with self.subTest(name):
                made = mcdem_command(*self.forged(change))
                self.assertIn(made.code, (0, 2), made.err)
                self.assertEqual((self.folder / "e").exists(), made.code == 0, made.err)
                if made.code == 0:
                    self.checked("e")
                    shutil.rmtree("e")
                else:
                    self.assertIn("forged.h5", made.err)
                    refused.append(name)
        self.assertGreater(len(refused), 8, refused)

    def test_runs_without_grains_are_refused(self):
        words = self.forged(without_grains)
        self.done("table", "forged.h5")
        self.refused(words, "forged.h5: holds no grains of this replica")
        self.assertFalse((self.folder / "e").exists())

    def test_problems_name_the_tables_that_would_have_been_written(self):
        self.refused(self.forged(FORGERIES["grain outside"]), "forged.h5: does not give a valid experiment, so nothing is written",
                     "mcdem: e/grains.csv:")
        self.assertEqual(set(os.listdir()), {"a", "forged.h5", "small.toml"})


if __name__ == "__main__":
    unittest.main()
