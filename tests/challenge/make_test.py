"""Simulated experiments that run away are weakened before they are sealed; sealed ones survive an interruption. make_test.py"""
import dataclasses
import json
import math
import os
import pathlib
import sys
import tempfile
import unittest

from mcdem import _engine as engine
from mcdem.challenge.files import read_open_challenge
from mcdem.challenge.make import Options, make_challenge
from mcdem.challenge.case_simulator import CaseSimulator
from mcdem.challenge.plan import ChallengeSize, draw_challenge, facts_of
from mcdem.challenge.truth import open_truth, seal_of
from mcdem.errors import InputError

sys.path.append(str(pathlib.Path(__file__).parents[1]))
from small_scene import scene_text  # noqa: E402

# Very dense at the end: strongly interacting contacts have no static solution there.
DENSE = scene_text("dense", 0.0490)


class Make(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "dense.toml").write_text(DENSE)
        self.scene, _ = engine.scene_of_options(str(self.folder / "dense.toml"), [])
        self.options = self.options_for("challenge", "truth.json")

    def options_for(self, folder, truth, **more):
        return Options(**{"folder": str(self.folder / folder), "truth": str(self.folder / truth), "seed": 1,
                          "size": ChallengeSize(1, 2, 2, 0, 0, 2), "effects": ["cross_contact", "stiffening"], **more})

    def drawn(self):
        facts = facts_of(CaseSimulator(self.scene, self.options.measurement, ""))
        return draw_challenge(self.options.size, self.options.effects, facts, seal_of(self.scene.text.encode()), self.options.seed)

    def interrupted(self, options, when):
        def progress(fraction):
            if when():
                raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            make_challenge(self.scene, options, progress)

    def test_weakens_experiments_that_run_away_before_sealing(self):
        seal = make_challenge(self.scene, self.options)
        sealed, steps = open_truth(self.options.truth, seal), []
        for case, first in zip(sealed.cases, self.drawn().cases, strict=True):
            self.assertTrue((self.folder / "challenge" / case.folder / "experiment.toml").exists())
            parts = [own.amplitude / wanted.amplitude for own, wanted in zip(case.effects, first.effects, strict=True)]
            steps += [math.log(part) / math.log(0.8) for part in parts]
            self.assertEqual(dataclasses.replace(case, effects=first.effects), first)
        for step in steps:
            self.assertAlmostEqual(step, round(step), delta=1e-9)
        self.assertTrue(0 < sum(round(step) > 0 for step in steps) < len(steps), steps)
        self.assertEqual(read_open_challenge(self.options.folder).sealed_sha256, seal)
        self.assertEqual(make_challenge(self.scene, self.options), seal, "what is sealed stays")

    def test_continues_after_an_interruption(self):
        seal = make_challenge(self.scene, self.options)
        again = self.options_for("again", "again.json")
        truth, first_case = pathlib.Path(again.truth), pathlib.Path(again.folder, "case_0001")
        self.interrupted(again, lambda: True)
        self.assertFalse(truth.exists())
        self.interrupted(again, pathlib.Path(again.folder, "challenge.json").exists)
        self.assertTrue(truth.exists())
        self.assertFalse(first_case.exists())
        shown = []
        self.assertEqual(make_challenge(self.scene, again, shown.append), seal)
        self.assertEqual(shown, sorted(shown))
        self.assertTrue(0.9 < shown[-1] <= 1, shown)
        for file in sorted(path.relative_to(again.folder) for path in pathlib.Path(again.folder).rglob("*") if path.is_file()):
            self.assertEqual(*((self.folder / folder / file).read_bytes() for folder in ("challenge", "again")), file)
        (first_case / "experiment.toml").unlink()
        content = (first_case / "contacts.csv.gz").read_bytes()
        (first_case / "contacts.csv.gz").unlink()
        complete = pathlib.Path(again.folder, "case_0002", "plate.csv.gz")
        os.utime(complete, (0, 0))
        self.assertEqual(make_challenge(self.scene, again), seal)
        self.assertEqual(complete.stat().st_mtime, 0, "what is complete stays")
        self.assertEqual((first_case / "contacts.csv.gz").read_bytes(), content)

    def test_without_a_seed_it_is_random_and_secret(self):
        one, other = (self.options_for(name, name + ".json", size=ChallengeSize(1, 0, 0, 0, 0, 2), seed=None) for name in ("one", "other"))
        seal = make_challenge(self.scene, one)
        self.assertEqual(make_challenge(self.scene, one), seal)
        self.assertNotEqual(make_challenge(self.scene, other), seal)

    def test_public_are_only_folders_and_candidates(self):
        options = self.options_for("unknown", "unknown.json", size=ChallengeSize(0, 0, 0, 5, 0, 2))
        truth = open_truth(options.truth, make_challenge(self.scene, options))
        public = json.loads(pathlib.Path(options.folder, "challenge.json").read_text())
        self.assertEqual(set(public), {"cases", "format", "scene_sha256", "sealed_sha256"})
        for case, hidden in zip(public["cases"], truth.cases, strict=True):
            self.assertEqual(set(case), {"folder", "candidates"})
            self.assertEqual(case["candidates"] is None, not hidden.struck)
            self.assertFalse(set(case["candidates"] or []) & set(hidden.struck))
        self.assertEqual(sum(case["candidates"] is not None for case in public["cases"]), 2)

    def test_what_belongs_to_others_is_refused(self):
        small = ChallengeSize(1, 0, 0, 0, 0, 2)
        seal = make_challenge(self.scene, self.options_for("challenge", "truth.json", size=small))
        (self.folder / "mine/case_0001").mkdir(parents=True)
        another = "is of another challenge; choose another folder, or the same scene, seed and numbers"
        for options, problem in (
                (self.options_for("challenge", "truth.json", size=small, seed=2), f"truth.json: {another}"),
                (self.options_for("challenge", "new.json", size=small, seed=2), f"challenge.json: {another}"),
                (self.options_for("mine", "new.json", size=small), "case_0001: is there without a challenge.json beside it, and is not"),
                (self.options_for("new", "new/../new/challenge.json", size=small), "give another file for the truth"),
                (self.options_for("new", "dense.toml", size=small), "dense.toml: not the truth of a challenge")):
            with self.assertRaisesRegex(InputError, problem):
                make_challenge(self.scene, options)
        self.assertFalse((self.folder / "new.json").exists())
        self.assertEqual((self.folder / "dense.toml").read_text(), DENSE)
        self.assertEqual(make_challenge(self.scene, self.options_for("challenge", "truth.json", size=small)), seal)


if __name__ == "__main__":
    unittest.main()
