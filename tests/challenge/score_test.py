"""`mcdem challenge score` from files to files; what it refuses. score_test.py"""
import contextlib
import functools
import io
import json
import pathlib
import tempfile
import unittest

from known_evidence import evidence

from mcdem.challenge.ablations import ABLATIONS, ablated_findings
from mcdem.challenge.case import CaseKind, Challenge, ChallengeCase, Hidden
from mcdem.challenge.files import OpenCase, OpenChallenge, open_challenge_text
from mcdem.challenge.truth import seal_of, truth_text
from mcdem.commands.command_line import run_command
from mcdem.diagnosis.evidence_file import evidence_text, findings_text
from mcdem.diagnosis.library import library_text
from mcdem.errors import InputError

ADHESION = (Hidden("adhesion", 3.0),)
CASES = (ChallengeCase("case_0001", CaseKind.effect, ADHESION, (), (), 0, 1),
         ChallengeCase("case_0002", CaseKind.effect, ADHESION, (), (), 1, 2),
         ChallengeCase("case_0003", CaseKind.none, (), (), (), 1, 3))
DIAGNOSED = {"detection_limits": [{"effect": "adhesion", "minimum_amplitude": 1}, {"effect": "friction", "minimum_amplitude": None}],
             "shrink": {"fraction": 0.9, "interval": [0.8, 1], "confirmed": 0.7}}


@functools.cache
def contents():
    """A challenge of two diagnosed cases with one effect, and one without an effect that could not be diagnosed."""
    truth = truth_text(Challenge(1, "", (1, 2), CASES))
    opened = OpenChallenge("", seal_of(truth.encode()), tuple(OpenCase(case.folder) for case in CASES))
    found = evidence(adhesion=3)
    of_case = {"": json.dumps(DIAGNOSED), "evidence/": evidence_text(found),
               "findings/": findings_text(ablated_findings(found, ABLATIONS[0]))}
    return {"challenge/challenge.json": open_challenge_text(opened), "challenge/truth.json": truth,
            "answers/library.json": library_text(found.library), "answers/case_0003.json": json.dumps({"problem": "too few scans"}),
            **{f"answers/{kind}{case.folder}.json": text for case in CASES[:2] for kind, text in of_case.items()}}


def write(folder):
    for name, text in contents().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


class Score(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        write(self.folder)

    def score(self, *words):
        """Standard output and error."""
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as error:
            code = run_command(["challenge", "score", str(self.folder / "challenge"), str(self.folder / "answers"), "--no-figures", *words])
        self.assertEqual(code, 0, error.getvalue())
        return out.getvalue(), error.getvalue()

    def expect_refused(self, text, *words):
        with self.assertRaisesRegex(InputError, text):
            self.score(*words)

    def change(self, name, old, new):
        file = self.folder / name
        content = file.read_text()
        self.assertIn(old, content)
        file.write_text(content.replace(old, new))

    def test_writes_the_score(self):
        out, error = self.score()
        self.assertIn("RMSE ranking", out)
        self.assertTrue(out.endswith("answers/score.md\n"))
        self.assertIn("not diagnosed: case_0003: too few scans", error)
        score = json.loads((self.folder / "answers/score.json").read_text())
        self.assertEqual((score["cases"], score["not_diagnosed"]), (3, ["case_0003: too few scans"]))
        self.assertEqual(score["shrink"]["median_error"], 0.9 - 0.7)
        self.assertEqual(score["shrink"]["covered"]["hits"], 0)
        whole, *others = score["methods"]
        for half in ("first_half", "scored_half"):
            self.assertEqual({name: (whole[half][name]["hits"], whole[half][name]["of"]) for name in ("detected_clear", "led_by_truth")},
                             {"detected_clear": (1, 1), "led_by_truth": (1, 1)}, "3 limits")
        self.assertEqual((whole["first_half"]["false_alarms"]["of"], whole["scored_half"]["false_alarms"]["of"]), (0, 1))
        self.assertEqual([method["limits"] is None for method in others], [False] * 5 + [True] * 2)
        blind = next(method for method in others if method["name"] == "top force alone")
        self.assertEqual(blind["scored_half"]["detected"]["hits"], 0)
        page = (self.folder / "answers/score.md").read_text()
        self.assertIn("| adhesion |      1/1 |         1/1 |", page)
        self.assertTrue(page.endswith("\n## Not diagnosed\n\n- case_0003: too few scans\n"))

    def test_files_of_others_are_not_replaced(self):
        (self.folder / "answers/score.md").write_text("# My score\n")
        self.expect_refused("score.md: is not the score of a challenge; it is not replaced")

    def test_another_truth_is_refused(self):
        self.change("challenge/truth.json", '"none"', '"pair"')
        self.expect_refused("truth.json: is not the truth that was sealed: its SHA-256 is [0-9a-f]{64}, challenge.json says ")
        self.expect_refused("there: is missing; --truth says where the truth is", "--truth", str(self.folder / "there"))

    def seal(self, truth):
        (self.folder / "challenge/truth.json").write_text(truth)
        opened = json.loads((self.folder / "challenge/challenge.json").read_text())
        (self.folder / "challenge/challenge.json").write_text(json.dumps({**opened, "sealed_sha256": seal_of(truth.encode())}))

    def test_invalid_truths_are_refused(self):
        truth = (self.folder / "challenge/truth.json").read_text()
        for text, problem in ((truth.replace('"none"', '"some"'), "not the truth of a challenge .there is no some"),
                              (truth.replace('"seed"', '"deed"'), "not the truth of a challenge .*seed: is missing"),
                              (truth.replace('"format": 1', '"format": 2'), "made by another version"),
                              (truth.replace("case_0003", "case_0004"), "lists other cases than its truth"), ("[", "not the truth")):
            with self.subTest(problem):
                self.seal(text)
                self.expect_refused(problem)

    def test_invalid_challenges_are_refused(self):
        for old, new, problem in (("case_0003", "case_0002", "folder case_0002 is there twice"),
                                  ("case_0003", "../case_0003", 'folder must be a name such as case_0001, .* got "../case_0003"'),
                                  ('"format": 1', '"format": 9', "made by another version; generate it again"),
                                  ('"cases"', '"none"', "not a challenge .cases: is missing")):
            with self.subTest(problem):
                write(self.folder)
                self.change("challenge/challenge.json", old, new)
                self.expect_refused(problem)
        (self.folder / "challenge/challenge.json").unlink()
        self.expect_refused("challenge.json: there is no challenge; `mcdem challenge make` makes one")

    def test_incomplete_diagnoses_are_refused(self):
        for name, problem in (("case_0001.json", "is missing; `mcdem challenge run` must have ended"),
                              ("findings/case_0002.json", "case_0002.json: is missing"), ("library.json", "library.json"),
                              ("evidence/case_0002.json", "case_0002.json: is missing; `mcdem challenge run` writes it")):
            with self.subTest(name):
                write(self.folder)
                (self.folder / "answers" / name).unlink()
                self.expect_refused(problem)
        write(self.folder)
        self.change("answers/case_0001.json", '"shrink"', '"other"')
        self.expect_refused("case_0001.json: not a diagnosis of a challenge .shrink: is missing")


if __name__ == "__main__":
    unittest.main()
