"""A small challenge from its simulated experiments to its score: blind, sealed, without hints about the truth. whole_test.py"""
import contextlib
import csv
import gzip
import io
import json
import pathlib
import shutil
import tempfile
import unittest

from mcdem.challenge.outside_effects import OUTSIDE_EFFECTS
from mcdem.challenge.truth import seal_of
from mcdem.commands.command_line import run_command
from mcdem.diagnosis.effects import EFFECTS as EFFECTS_OF_LIBRARIES
from mcdem.errors import InputError

SCENE = pathlib.Path(__file__).resolve().parents[1] / "ensemble/tiny_challenge.toml"
MAKE = "--seed 3 --effects friction,force_bias --none 2 --per-effect 1 --pairs 0 --unknown 2 --outside 1 --packings 2"
RUN = "--candidates friction,force_bias --library-packings 8 --library-replicates 2 --replicates 3 --confirmations 2"
CASES = 7
EFFECTS = {effect.name for effect in (*EFFECTS_OF_LIBRARIES, *OUTSIDE_EFFECTS)}


def said_by(*words):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as messages:
        code = run_command([str(word) for word in words])
    assert code == 0, messages.getvalue()
    return out.getvalue()


def table(file):
    with gzip.open(file, "rt") as lines:
        return list(csv.DictReader(lines))


class Challenge(unittest.TestCase):
    """Experiments and diagnoses are made once; the truth is not there during the diagnoses."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.made = cls.make()
        (cls.folder / "sealed").mkdir()
        (cls.folder / "challenge/truth.json").rename(cls.folder / "sealed/truth.json")
        cls.run_it()
        cls.truth = json.loads((cls.folder / "sealed/truth.json").read_text())

    @classmethod
    def make(cls):
        return said_by("challenge", "make", SCENE, "--out", cls.folder / "challenge", *MAKE.split())

    @classmethod
    def run_it(cls, *more):
        said_by("challenge", "run", cls.folder / "challenge", "--scene", SCENE, "--library", cls.folder / "library.json",
                "--out", cls.folder / "answers", *RUN.split(), *more)

    def test_the_seal_is_that_of_the_truth(self):
        seal = seal_of((self.folder / "sealed/truth.json").read_bytes())
        self.assertIn(seal, self.made)
        self.assertEqual(json.loads((self.folder / "challenge/challenge.json").read_text())["sealed_sha256"], seal)

    def test_experiments_have_the_effects_of_the_truth(self):
        self.assertEqual(len(self.truth["cases"]), CASES)
        for case in self.truth["cases"]:
            plate, contacts = (table(self.folder / "challenge" / case["folder"] / f"{name}.csv.gz") for name in ("plate", "contacts"))
            for shift in case["nuisances"]:
                if shift["name"] == "strain_offset":
                    self.assertAlmostEqual(float(plate[0]["plate_z_m"]) - 0.0835, shift["amplitude"], delta=1e-8)
            bias = sum(effect["amplitude"] for effect in case["effects"] if effect["name"] == "force_bias")
            on_plate = -sum(float(row["fz_N"]) for row in contacts if row["partner"] == "plate")
            # About 250 contacts with 5 % noise each and unequal forces; the weakest are not detected: 2 %.
            self.assertAlmostEqual(on_plate / sum(float(row["top_force_N"]) for row in plate), 1 + bias, delta=0.02)

    def test_every_case_is_diagnosed_and_scored(self):
        for case in self.truth["cases"]:
            self.assertIn("verdict", json.loads((self.folder / f"answers/{case['folder']}.json").read_text()))
        said_by("challenge", "score", self.folder / "challenge", self.folder / "answers", "--truth", self.folder / "sealed/truth.json",
                "--no-figures")
        score = json.loads((self.folder / "answers/score.json").read_text())
        self.assertEqual((score["cases"], score["not_diagnosed"]), (CASES, []))
        whole = score["methods"][0]
        self.assertEqual(CASES, sum(whole[half][kind]["of"] for half in ("first_half", "scored_half")
                                    for kind in ("false_alarms", "detected", "named_unknown", "named_outside_prior")))
        self.assertIn("| whole method", (self.folder / "answers/score.md").read_text())

    def test_files_give_no_hints_about_the_truth(self):
        files = [file for file in (self.folder / "challenge").rglob("*") if file.is_file() and file.name != "challenge.json"]
        self.assertEqual(len(files), 4 * CASES)
        words = {"none", "pair", "unknown", "outside", "seed", "amplitude", "struck", *EFFECTS}
        self.assertGreater(len(words), 20)
        settings = set()
        for file in files:
            text = (gzip.open if file.suffix == ".gz" else open)(file, "rt").read()
            if file.name == "experiment.toml":  # it states grains.friction
                settings.add(text[text.index("["):])
            else:
                self.assertEqual([word for word in words if word in text], [], file)
        self.assertEqual(len(settings), 1)
        self.assertIn("youngs_modulus = 23300.0", *settings)

    def test_what_is_done_stays(self):
        shutil.copy(self.folder / "sealed/truth.json", self.folder / "challenge/truth.json")
        self.assertEqual(self.make(), self.made)
        (self.folder / "challenge/truth.json").unlink()
        kept = (self.folder / "answers/case_0001.json").read_bytes()
        self.run_it()
        self.assertEqual((self.folder / "answers/case_0001.json").read_bytes(), kept, "its time would differ")
        with self.assertRaisesRegex(InputError, "is not the scene that"):
            self.run_it("--set", "grains.friction=0.1")


if __name__ == "__main__":
    unittest.main()
