"""`mcdem experiment import`: a run, written in the format of a laboratory, is imported as from-run converts it.
import_test.py"""
import gzip
import os
import pathlib
import re
import sys
import unittest

import numpy as np
from small_run import AT_REST, STAGES, CommandCase, mcdem_command

from mcdem.experiment.read import read_experiment
from mcdem.results.names import Phase

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "importing"))
from lab import Contact, Scan, Style, Truth, lab_contacts, lab_grains, lab_plate  # noqa: E402

PERFECT = ["--position-error", "0", "--diameter-error", "0", "--force-error", "0", "--force-threshold", "0"]
IMPORT = ["experiment", "import"]
LAB = ["contacts.csv", "plate.csv", "grains.csv"]
BOX, MATERIALS = ["--set", "box.size=[0.06, 0.06]"], ["--set", "grains.youngs_modulus=23300", "--set", "grains.poisson_ratio=0.5"]
KNOWN = [*LAB, *BOX, *MATERIALS, "--out"]


def lab_truth(recording):
    scans = recording.scans
    contacts = [[Contact(*one) for one in zip(seen.grain.tolist(), seen.partner.tolist(), seen.point, seen.force, strict=True)]
                for seen in scans.contacts]
    phase = [Phase(one).name for one in scans.phase]
    columns = (scans.frame.tolist(), scans.plate_z.tolist(), phase, scans.position, contacts, scans.top_force.tolist())
    return Truth(recording.diameter, [Scan(*one) for one in zip(*columns, strict=True)])


class Import(CommandCase):
    def imported(self, *words):
        return self.done(*IMPORT, *words)

    def text(self, name):
        return (self.folder / name).read_text()

    def write(self, name, text):
        (self.folder / name).write_text(text)


class OfARun(Import):
    """A run that starts at rest; folder "seen" has its data from a perfect instrument."""

    def setUp(self):
        super().setUp()
        self.run_small(AT_REST, ("contact.model", "mc_dem"))
        self.done("experiment", "from-run", "a", *PERFECT, "--out", "seen")
        self.truth = read_experiment(self.folder / "seen").recording
        self.lab = lab_truth(self.truth)

    def write_lab(self, style=Style()):
        for name, write in (("plate.csv", lab_plate), ("grains.csv", lab_grains), ("contacts.csv", lab_contacts)):
            self.write(name, write(self.lab, style))

    def expect_truth(self, folder):
        """Numbers were printed with nine digits."""
        read, truth = read_experiment(self.folder / folder).recording.scans, self.truth.scans
        self.assertEqual(read.phase.tolist(), truth.phase.tolist())
        np.testing.assert_allclose(read.plate_z, truth.plate_z, rtol=0, atol=1e-10)
        np.testing.assert_allclose(read.top_force, truth.top_force, rtol=0, atol=1e-8)
        np.testing.assert_allclose(read.position, truth.position, rtol=0, atol=1e-9)
        for found, wanted in zip(read.contacts, truth.contacts, strict=True):
            self.assertEqual(found.partner.tolist(), wanted.partner.tolist())
            np.testing.assert_allclose(found.force, wanted.force, rtol=0, atol=1e-8)
            np.testing.assert_allclose(found.point, wanted.point, rtol=0, atol=1e-9)

    def test_tables_of_a_laboratory_become_the_experiment_of_their_run(self):
        self.write_lab()
        made = self.imported(*KNOWN, "lab")
        self.assertEqual(made.err, "")
        for part in ("grains.csv: grains (sure: its columns are named so)\n",
                     "  radius        Radius [mm]        sure    its name; neighbours touch", "lab: 9 frames, 30 grains in 9 of them, "):
            self.assertIn(part, made.out)
        self.expect_truth("lab")
        self.assertEqual(read_experiment(self.folder / "lab").name, "lab")
        self.assertIn("30 grains", self.done("experiment", "check", "lab").out)

    def test_a_mapping_reads_other_tables_of_the_laboratory(self):
        """Also compressed ones."""
        self.write_lab()
        self.imported(*KNOWN, "lab")
        (self.folder / "plate2.csv.gz").write_bytes(gzip.compress(self.text("plate.csv").encode()))
        self.imported("plate2.csv.gz", "grains.csv", "contacts.csv", "--mapping", "lab/mapping.toml", "--metadata", "lab/experiment.toml",
                      "--out", "again", "--gzip", "--name", "again")
        self.expect_truth("again")
        self.assertTrue((self.folder / "again/contacts.csv.gz").exists())
        self.assertIn('files = ["plate2.csv.gz"]', self.text("again/mapping.toml"))

    def test_uncertain_guesses_must_be_confirmed_in_the_mapping(self):
        self.write_lab(Style(named=False))
        refused = mcdem_command(*IMPORT, *LAB, "--out", "lab")
        self.assertEqual(refused.code, 2)
        self.assertIn("  length_unit   mm                 unclear no name says it", refused.out)
        self.assertRegex(refused.err,
                         r'mcdem: lab/mapping.toml:\d+: length_unit must be confirmed, got "\?mm": no name says it')
        for part in ("mcdem: --set: box.size must be the inner width and depth of the box",
                     "correct the entries of lab/mapping.toml that begin with a question mark, remove the marks, and import again with "
                     "--mapping"):
            self.assertIn(part, refused.err)  # all at once
        self.assertEqual(os.listdir("lab"), ["mapping.toml"])

        again = ["--mapping", "lab/mapping.toml", *BOX, "--out", "lab"]
        unchanged = mcdem_command(*IMPORT, *again)
        self.assertEqual(unchanged.code, 2)
        self.assertIn("put in what is right, without the question mark", unchanged.err)
        self.refused([*IMPORT, *KNOWN, "lab"], "lab/mapping.toml: is there already: import with --mapping lab/mapping.toml, or remove it")

        mapping = re.sub(r'(length_unit = )"\?[a-z]*"', r'\1"mm"', self.text("lab/mapping.toml"))
        mapping = re.sub(r'(force_unit = )"\?[a-zA-Z]*"', r'\1"mN"', mapping).replace('"?', '"')
        self.write("lab/mapping.toml", mapping)
        self.imported(*again)
        self.expect_truth("lab")
        self.assertEqual(self.text("lab/mapping.toml"), mapping)

    def test_the_name_is_that_of_the_folder_if_none_is_stated(self):
        self.write_lab()
        self.imported(*KNOWN, "lab/", "--set", 'name="Probe 7"')
        self.imported(*KNOWN, "second/")
        self.assertEqual([read_experiment(self.folder / name).name for name in ("lab", "second")], ["Probe 7", "second"])
        self.assertEqual(set(os.listdir()), {"a", "seen", "small.toml", *LAB, "lab", "second"})


class OfAProgramme(Import):
    def test_keeps_stages_and_times(self):
        self.run_small(AT_REST, ("contact.model", "independent"), ("plate.end", 0.06), scene=STAGES)
        self.done("experiment", "from-run", "a", "--out", "e")
        self.imported("e/contacts.csv", "e/plate.csv", "e/grains.csv", "--metadata", "e/experiment.toml", "--out", "i")
        seen, imported = (read_experiment(self.folder / name).recording for name in "ei")
        self.assertTrue(seen.has_programme)
        self.assertEqual(imported.parameters, seen.parameters)
        self.assertEqual(imported.scans.time.tolist(), seen.scans.time.tolist())


class OfAMachine(Import):
    """A record with a hold of 10 s, without a run."""

    KNOWN = ["--set", "box.size=[0.05, 0.05]", "--set", "plate.start=0.03", "--out"]

    def write_record(self, unit="mm"):
        time = np.arange(0, 17, 0.02)
        down = np.interp(time, [0, 1, 4, 14, 17], [0, 0, 6, 6, 0])
        force = np.maximum(down - 0.5, 0) ** 1.5 * (1 - 0.2 * np.clip(time - 4, 0, 10) / 10) - 0.02
        self.write("machine.csv", f"Time [s],Extension [{unit}],Load [N]\n" + "".join(f"{t:.3f},{d:.5f},{f:.5f}\n" for t, d, f in zip(time, down, force)))

    def test_is_a_programme_with_a_picture(self):
        self.write_record()
        made = self.imported("machine.csv", *self.KNOWN, "lab")
        self.assertIn("lab/record.png shows what was understood of the record", made.err)
        self.assertEqual(sorted(os.listdir("lab")), ["experiment.toml", "mapping.toml", "plate.csv", "record.png"])
        read = read_experiment(self.folder / "lab").recording
        self.assertEqual([read.value(f"programme.{stage}.scans") for stage in (1, 3)], [20, 20])
        self.assertAlmostEqual(read.value("programme.2.time"), 10, delta=0.05)
        self.assertAlmostEqual(read.value("programme.1.speed"), 2e-3, delta=2e-5)
        self.assertAlmostEqual(read.scans.top_force.max(), 5.5**1.5, delta=0.1)
        self.assertIn("a programme of 3 stages", self.done("experiment", "check", "lab").out)

    def test_is_pictured_before_it_is_confirmed_and_no_picture_of_others_is_replaced(self):
        self.write_record("furlong")
        self.assertEqual(mcdem_command(*IMPORT, "machine.csv", *self.KNOWN, "lab").code, 2)
        self.assertEqual(sorted(os.listdir("lab")), ["mapping.toml", "record.png"])
        self.write("lab/mapping.toml", self.text("lab/mapping.toml").replace('"?m"', '"mm"').replace('"?', '"'))
        self.imported("--mapping", "lab/mapping.toml", *self.KNOWN, "lab")
        (self.folder / "mine").mkdir()
        self.write("mine/record.png", "mine")
        self.refused([*IMPORT, "machine.csv", *self.KNOWN, "mine"], "record.png: is not a figure of mcdem")


class WithoutForces(Import):
    def test_contacts_are_counted_by_check_and_checked(self):
        self.write("plate.csv", "frame,plate_z_m,force_N\n0,0.012,0\n")
        self.write("grains.csv", "frame,grain,x_m,y_m,z_m,diameter_m\n" + "".join(f"0,{7 + n},{x},0.005,0.005,0.01\n" for n, x in enumerate((0.005, 0.015))))
        self.write("contacts.csv", "frame,grain1,grain2\n0,8,7\n")
        self.imported("plate.csv", "grains.csv", "contacts.csv", "--set", "box.size=[0.02, 0.01]", "--out", "lab")
        self.assertEqual(self.text("lab/topology.csv"), "frame,grain,partner\n0,0,1\n")
        self.assertIn("1 contacts without forces in 1 of 1 frames, 1 of each grain", self.done("experiment", "check", "lab").out)
        self.write("lab/topology.csv", "frame,grain,partner\n0,0,5\n0,1,1\n")
        self.refused(["experiment", "check", "lab"], "topology.csv:2: grain and partner must be grains of grains.csv, 0 to 1, or a wall, got 0 and 5",
                     "topology.csv:3: grain 1 cannot touch itself")


class WrongOptions(Import):
    def test_are_bad_input(self):
        self.write("odd.csv", "a,b\n1,2\n1,2,3\n")
        (self.folder / "old").mkdir()
        self.write("old/contacts.csv.gz", "others")
        for words, *parts in ((["--out", "e"], "TABLE: must be at least one file, or --mapping must name them"),
                              (["none", "odd.csv", "--out", "e"], "none: must be a table, got no such file",
                               "odd.csv:3: must have 2 columns as the first row, got 3"),
                              (["--mapping", "none", "--out", "e"], "none: must be a mapping of at most 1 MB, got no such file"),
                              (["odd.csv", "--metadata", "none", "--out", "e"], "none: must be a text of at most 1 MB, got no such file"),
                              (["odd.csv", "--out", "small.toml"], "--out: small.toml must be a folder, got a file"),
                              (["odd.csv", "--out", "old"], "--out: old already contains contacts.csv.gz")):
            with self.subTest(words):
                self.refused([*IMPORT, *words], *parts)
                self.assertFalse((self.folder / "e").exists())

    def test_are_reported_with_the_mapping(self):
        self.write("odd.csv", "a,b\n1,2\n")
        words = [word for setting in ("box.size=[60.0, 60.0]", "grains.friktion=1", "nothing") for word in ("--set", setting)]
        wrong = mcdem_command(*IMPORT, "odd.csv", *words, "--out", "e")
        self.assertEqual(wrong.code, 2)
        for part in ("--set: box.size must be > 0 and <= 20 [m], got 60: divide by 1000 if it is in millimetres",
                     "--set: grains.friktion is not a key of an experiment", "--set: must be KEY=VALUE", "role must be confirmed"):
            self.assertIn(part, wrong.err)
        self.assertTrue((self.folder / "e/mapping.toml").exists())


if __name__ == "__main__":
    unittest.main()
