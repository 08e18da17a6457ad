"""Commands that read runs and experiments, without the compiled module. experiment_test.py"""
import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import written

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "host/python"))
from mcdem.commands.command_line import module_of, parser_of, run_command  # noqa: E402
from mcdem.commands.sources import load_runs, names_of  # noqa: E402
from mcdem.errors import InputError  # noqa: E402
from mcdem.observe.reference import chosen_setting, load_reference  # noqa: E402
from mcdem.results import read_run  # noqa: E402

PACKAGE = pathlib.Path(__file__).parents[2] / "host/python"
PLATE = "frame,cycle,phase,plate_z_m,top_force_N\n0,0,load,0.022,0\n1,0,load,0.002,4\n2,0,unload,0.021,0.01\n"


def write_lab(folder):
    """An experiment of the plate alone."""
    (lab := folder / "lab").mkdir()
    (lab / "experiment.toml").write_text('name = "by hand"\nbox.size = [0.05, 0.06]\n')
    (lab / "plate.csv").write_text(PLATE)
    return lab


class Experiments(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.lab = write_lab(self.folder)

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

    def test_compare_with_an_experiment(self):
        lab = write_lab(self.folder)
        self.assertTrue(self.printed("compare", str(self.folder / "run.h5"), "--against", str(lab)).startswith("against by hand\n\nmodel "))
        (lab / "plate.csv").write_text(PLATE.replace("unload", "up"))
        self.assertEqual(self.said("compare", "run.h5", "--against", "lab"),
                         (2, "", 'mcdem: lab/plate.csv:4: phase must be one of load, unload, got "up"\n'))

    def test_usage_errors(self):
        compare, converge = ["compare", "run.h5", "--against", "x"], ["converge", "s", "--out", "o"]
        calibrate = ["calibrate", "s", "--experiment", "x"]
        for words, message in ((["table"], "RUN is required"),
                               (compare[:2], "--against is required"),
                               (["table", "run.h5", "--mark"], "The following argument was not expected: --mark"),
                               ([*compare, "--touch-force", "-1"], "--touch-force: must be a number >= 0, got -1"),
                               ([*compare, "--threshold", "nan"], "--threshold: must be a number >= 0, got nan"),
                               ([*compare, "--discard", "1.5"], "--discard: must be a whole number >= 0, got 1.5"),
                               ([*compare, "--out", ""], "--out: must be a path, got nothing"),
                               ([*converge, "--replicas", "7"], "--replicas: must be a whole number from 8 to 10000, got 7"),
                               ([*converge, "--jitter", "2"], "--jitter: must be a number from 0 to 1, got 2"),
                               ([*converge, "--force-limit", "0"], "--force-limit: must be a number > 0, got 0"),
                               ([*converge, "--sd-limit", "x"], "--sd-limit: must be a number > 0, got x"),
                               ([*converge, "--out="], "--out: must be a path, got nothing"),
                               ([*calibrate, "--rounds", "many"], "--rounds: must be a whole number from 1 to 10000, got many"),
                               ([*calibrate, "--batch", "2"], "--batch: must be a whole number from 3 to 10000, got 2"),
                               ([*calibrate, "--low=-1"], "--low: must be a number >= 0, got -1"),
                               (["report", "x", "--out", "o", "--scans", "0"], "--scans: must be a whole number from 1 to 100000, got 0")):
            with contextlib.redirect_stderr(io.StringIO()) as said:
                try:
                    code = run_command(words)
                except SystemExit as end:
                    code = end.code
            self.assertEqual((code, said.getvalue()), (2, f"mcdem: {message}\nmcdem: `mcdem {words[0]} --help` tells more\n"))

    def test_documented_defaults(self):
        found = vars(parser_of("converge", module_of("converge")).parse_intermixed_args(["s", "--out", "o", "--set", "a=1"]))
        self.assertEqual(found, {"SCENE": "s", "out": "o", "overrides": ["a=1"], "replicas": 32, "jitter": 0, "force_limit": 0.005,
                                 "sd_limit": 0.5, "seed": 1, "device": ""})

    def test_errors_of_files(self):
        self.assertEqual(self.said("table", "run.h5", "--over", "x"), (2, "", 'mcdem: reference setting: must be one of "mc_dem"; got "x"\n'))

    def test_help(self):
        code, out, _ = self.said("compare", "--help")
        self.assertEqual(code, 0)
        for words in ("--against DIR", "--displacement M", "(default: 0.018)", "  mcdem compare out/small --against out/small --setting mc_dem"):
            self.assertIn(words, out)

    def test_options_may_stand_between_runs(self):
        one = str(self.folder / "run.h5")
        self.assertEqual(self.printed("table", one, "--markdown", one), self.printed("table", one, one, "--markdown"))


if __name__ == "__main__":
    unittest.main()
