"""Experiments made by hand, and the commands that read them with runs. experiment_test.py"""
import contextlib
import gzip
import io
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np
import written

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "host/python"))
from mcdem.commands.command_line import run_command  # noqa: E402
from mcdem.commands.sources import load_runs, names_of  # noqa: E402
from mcdem.errors import InputError  # noqa: E402
from mcdem.observe.reference import chosen_setting, load_reference  # noqa: E402
from mcdem.results import Wall, read_run  # noqa: E402
from mcdem.results.experiment import read_experiment  # noqa: E402

PACKAGE = pathlib.Path(__file__).parents[2] / "host/python"
SETTINGS = """
name = "by hand"
[box]
size = [0.05, 0.06]
[plate]
start = 0.1
[grains]
youngs_modulus = 23300.0
[measurement]
force_threshold = 0.5
"""
PLATE = "# a comment\nphase,frame,cycle,plate_z_m,top_force_N,note\nload,0,0,0.1,0,a\n\n\"load\", 1,0,0.09,4.5,b\nunload,2,1,0.095,2,c\n"
GRAINS = "frame,grain,x_m,y_m,z_m,diameter_m\n0,1,0.03,0.01,0.01,0.021\n0,0,0.01,0.01,0.01,0.02\n1,0,0.01,0.01,0.01,0.02\n1,1,0.04,0.05,0.01,0.02\n"
CONTACTS = ("frame,grain,partner,x_m,y_m,z_m,fx_N,fy_N,fz_N\n1,1,0,0.02,0.01,0.01,3,0,4\n1,0,floor,0.01,0.01,0,0,0,2\n"
            "1,1,plate,0.01,0.01,0.09,0,0,-0.25\n")
HEAD = "#!/bin/sh\n"


class Experiments(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.lab = self.folder / "lab"
        self.lab.mkdir()
        self.write(SETTINGS)
        self.program("exit 0")

    def write(self, settings, plate=PLATE, grains=GRAINS, contacts=CONTACTS):
        for name, text in (("experiment.toml", settings), ("plate.csv", plate), ("grains.csv", grains), ("contacts.csv", contacts)):
            (self.lab / name).write_text(text)

    def program(self, script):
        """Stands for the program that checks the folder."""
        file = self.folder / "mcdem"
        file.write_text(HEAD + script)
        file.chmod(0o755)
        patch = mock.patch.dict(os.environ, MCDEM_PROGRAM=str(file))
        patch.start()
        self.addCleanup(patch.stop)

    def test_values(self):
        one = read_experiment(str(self.lab))
        self.assertEqual((one.label, one.box.size_x, one.box.size_y, one.parameters), ("by hand", 0.05, 0.06,
                                                                                      {"grains.youngs_modulus": "23300"}))
        np.testing.assert_allclose(one.displacement, [0, 0.01, 0.005], atol=1e-15)
        self.assertEqual((one.scans.phase.tolist(), one.scans.cycle.tolist()), ([0, 0, 1], [0, 0, 1]))
        self.assertEqual(one.scans.top_force.tolist(), [0, 4.5, 2])
        self.assertEqual(one.diameter.tolist(), [0.02, 0.021])  # of frame 0
        contacts = one.scans.contacts[1]
        self.assertEqual((contacts.grain.tolist(), contacts.partner.tolist()), ([0, 0, 1], [1, -5, -6]))
        self.assertEqual(contacts.force[0].tolist(), [-3, 0, -4])  # listed from the other side
        np.testing.assert_equal(one.scans.coordination_number, [math.nan, (2 + 1) / 2, math.nan])  # without that below the threshold
        np.testing.assert_allclose([one.scans.mean_force[1], one.scans.branch_length[1]], [(5 + 2) / 2, 0.05])
        self.assertEqual(one.scans.wall_force[1, Wall.floor].tolist(), [0, 0, -2])
        self.assertEqual(one.scans.wall_force[1, Wall.plate, 2], 4.5)  # the gauge also measures weak contacts
        self.assertTrue(np.isnan(one.scans.wall_force[1, Wall.x_min]).all())

    def test_other_containers_and_compressed_tables(self):
        self.write('[container]\nshape = "cylinder"\nradius = 0.03\n', contacts=CONTACTS.replace("floor", "side"))
        (self.lab / "contacts.csv.gz").write_bytes(gzip.compress((self.lab / "contacts.csv").read_bytes()))
        (self.lab / "contacts.csv").unlink()
        one = read_experiment(str(self.lab))
        self.assertEqual((one.label, one.box.size_x, one.plate_start), ("lab", 0.06, 0.1))
        self.assertEqual(one.scans.contacts[1].partner.tolist(), [1, -1, -6])
        self.write('[container]\nshape = "periodic"\n' + SETTINGS.replace('name = "by hand"', ""))
        (self.lab / "contacts.csv.gz").unlink()
        position = read_experiment(str(self.lab)).scans.position
        np.testing.assert_allclose(position[1][1], [0.04, -0.01, 0.01])  # the image nearest to (0.03, 0.01)

    def test_stages_of_a_programme(self):
        self.write(SETTINGS + '[[programme]]\nforce = 1\n[[programme]]\nstage = "hold"\n')
        one = read_experiment(str(self.lab))
        self.assertEqual((one.has_programme, one.parameters["programme.2.stage"]), (True, "hold"))

    def test_problems_are_those_that_the_program_finds(self):
        self.program('echo "mcdem: plate.csv:3: first" >&2; echo "mcdem: plate.csv:4: second" >&2; exit 2')
        with self.assertRaises(InputError) as raised:
            read_experiment(str(self.lab))
        self.assertEqual(raised.exception.problems, ["plate.csv:3: first", "plate.csv:4: second"])

    def test_a_folder_that_changed_after_the_check_is_an_input_error(self):
        for damage in ({"settings": "name ="}, {"settings": "[box]\n"}, {"plate": "frame\n"}, {"plate": ""}, {"plate": PLATE + "x\n"},
                       {"plate": PLATE.replace("unload", "up")}, {"contacts": CONTACTS.replace("floor", "roof")},
                       {"contacts": CONTACTS.replace("1,0,floor", "9,0,floor")}, {"grains": GRAINS.replace("1,1,", "1,7,")}):
            self.write(**({"settings": SETTINGS} | damage))
            with self.assertRaises(InputError, msg=damage) as raised:
                read_experiment(str(self.lab))
            self.assertIn("lab", str(raised.exception))

    def test_references(self):
        written.write_run(self.folder / "run.h5", replicas=2)
        reference = load_reference([str(self.lab), str(self.folder / "run.h5")], discard=1)
        self.assertEqual(reference.label, "by hand, mc_dem")
        self.assertEqual([one.parameters.get("protocol.discard") for one in reference.replicas], ["1", None, None])
        with self.assertRaisesRegex(InputError, "--setting: must be one of here's: mc_dem; got nope"):
            chosen_setting(read_run(self.folder), "nope", "here", "--setting")

    def test_names_of_runs(self):
        self.assertEqual(names_of(["out/a/", "out/./b/run.h5", "c"]), ["a", "b", "c"])
        self.assertEqual(names_of(["x/a", "y/a/run.h5", "c"]), ["x/a", "y/a/run.h5", "c"])
        written.write_run(self.folder / "run.h5")
        written.write_run(self.lab / "run.h5")
        labels = [setting.label for setting in load_runs([str(self.folder), str(self.lab)]).settings]
        self.assertEqual(labels, [f"{self.folder.name}: mc_dem", "lab: mc_dem"])


class Commands(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        written.write_run(self.folder / "run.h5")

    def said(self, *words):
        """Exit code, standard output and standard error of `python3 -m mcdem`."""
        done = subprocess.run([sys.executable, "-B", "-m", "mcdem", *words], cwd=self.folder, capture_output=True, text=True,
                              env=os.environ | {"PYTHONPATH": str(PACKAGE)})
        return done.returncode, done.stdout, done.stderr

    def printed(self, *words):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            self.assertEqual(run_command([*words]), 0)
        return out.getvalue()

    def test_table_and_compare(self):
        file = str(self.folder / "run.h5")
        self.assertIn("\nMC-DEM                       3.50        1.000         1\n", self.printed("table", file))
        self.assertRegex(self.printed("table", file, "--csv"), r"\nmc_dem,20(\.0+4)?,3\.5,,mc_dem,1,,1,0\n\Z")
        self.assertTrue(self.printed("compare", file, "--against", file).startswith("against mc_dem\n\nmodel "))
        self.assertIn("| MC-DEM | load   |", self.printed("table", "--markdown", file))

    def test_usage_errors(self):
        for words, message in (([], "A subcommand is required"), (["nonsense"], "there is no command nonsense"),
                               (["--nonsense"], "there is no option --nonsense"), (["table"], "RUN is required"),
                               (["compare", "run.h5"], "--against is required"),
                               (["table", "run.h5", "--mark"], "The following argument was not expected: --mark"),
                               (["compare", "run.h5", "--against", "x", "--touch-force", "-1"], "--touch-force: must be a number >= 0, got -1"),
                               (["compare", "run.h5", "--against", "x", "--threshold", "nan"], "--threshold: must be a number >= 0, got nan"),
                               (["compare", "run.h5", "--against", "x", "--out", ""], "--out: must be a path, got nothing")):
            command = "mcdem " + words[0] if words[:1] in (["table"], ["compare"]) else "mcdem"
            with contextlib.redirect_stderr(io.StringIO()) as said:
                try:
                    code = run_command(words)
                except SystemExit as end:
                    code = end.code
            self.assertEqual((code, said.getvalue()), (2, f"mcdem: {message}\nmcdem: `{command} --help` tells more\n"))

    def test_errors_of_files(self):
        self.assertEqual(self.said("table", "nowhere"), (2, "", "mcdem: nowhere: must be a result folder or file, got nothing there\n"))
        self.assertEqual(self.said("table", "run.h5", "--over", "x"), (2, "", 'mcdem: reference setting: must be one of "mc_dem"; got "x"\n'))

    def test_help(self):
        code, out, _ = self.said("compare", "--help")
        self.assertEqual(code, 0)
        for words in ("--against DIR", "--displacement M", "(default: 0.018)", "  mcdem compare out/small --against out/small --setting mc_dem"):
            self.assertIn(words, out)

    def test_options_may_stand_between_runs(self):
        one = str(self.folder / "run.h5")
        self.assertEqual(self.printed("table", one, "--markdown", one), self.printed("table", one, one, "--markdown"))

    def test_output_that_cannot_be_written_is_a_failure(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([sys.executable, "-B", "-m", "mcdem", "table", "run.h5"], cwd=self.folder, stderr=subprocess.PIPE, text=True,
                                  stdout=full, env=os.environ | {"PYTHONPATH": str(PACKAGE)})
        self.assertEqual((done.returncode, done.stderr), (1, "mcdem: standard output cannot be written: No space left on device\n"))


if __name__ == "__main__":
    unittest.main()
