"""Modified documents are read or raise InputError and nothing else. document_test.py [FIRST COUNT]"""
import json
import pathlib
import random
import sys
import tempfile
import unittest

import numpy as np
from synthetic_evidence import SyntheticWorld

sys.path.append(str(pathlib.Path(__file__).parents[1] / "report"))
from diagnosis_samples import sample  # noqa: E402

from mcdem.challenge.case import CaseKind, Challenge, ChallengeCase, Hidden  # noqa: E402
from mcdem.challenge.files import OpenCase, OpenChallenge, open_challenge_text, read_open_challenge  # noqa: E402
from mcdem.challenge.truth import parse_truth, truth_text  # noqa: E402
from mcdem.diagnosis.decision import Findings, Proposal  # noqa: E402
from mcdem.diagnosis.diagnosis_json import diagnosis_json  # noqa: E402
from mcdem.diagnosis.evidence_file import evidence_text, findings_text, read_evidence, read_findings  # noqa: E402
from mcdem.diagnosis.library import library_text, read_library, scatter  # noqa: E402
from mcdem.errors import InputError  # noqa: E402
from mcdem.manifest import read_manifest  # noqa: E402
from mcdem.report.diagnosis import diagnosis_of  # noqa: E402

FIRST, COUNT = (int(sys.argv.pop(1)) for _ in range(2)) if len(sys.argv) == 3 else (0, 600)  # of each document

ODD_NUMBERS = (0, 1, -1, 2, 16, 255, 2**31 - 1, -2**31, 2**32, 2**63 - 1, 2**64, 10**400, 0.0, -0.0, 0.5, 1e-300, 1e17, 1e300, -1e300,
               float("nan"), float("inf"), -float("inf"))
ODD_TEXTS = ("", "../../etc", "/", "x" * 200, "\ud800", "\0", "caf\u00e9", "case_0001", "load", "force")
DEEP = 5000


def deep(value):
    for _ in range(DEEP):
        value = [value]
    return value


def odd_value(source, before):
    return source.choice((None, True, False, source.choice(ODD_NUMBERS), source.choice(ODD_NUMBERS), source.choice(ODD_TEXTS),
                          [before, before], {"folder": before}, [], {}))


def change(source, document):
    """Deletes, repeats or replaces something in the document, or all of it."""
    above, key, at = None, None, document
    while isinstance(at, dict | list) and at and (at is document or source.random() < 0.75):
        above, key = at, source.choice(list(at) if isinstance(at, dict) else range(len(at)))
        at = above[key]
        if source.random() < 0.125:
            del above[key]
            return document
        if isinstance(above, list) and source.random() < 0.06:
            above.append(at)
            return document
    if above is None:
        return odd_value(source, document)
    above[key] = odd_value(source, at)
    return document


def changed_text(source, text):
    document = json.loads(text)
    for _ in range(source.randint(1, 4)):
        document = change(source, document)
    return json.dumps(document, sort_keys=True, separators=(",", ":"))


def changed_bytes(source, content):
    """Cut off, with other bytes, or with many brackets, somewhere."""
    at = source.randrange(len(content))
    match source.randrange(4):
        case 0:
            return content[:at]
        case 1:
            return content[:at] + source.randbytes(source.randint(1, 4)) + content[at + 1:]
        case 2:
            return content[:at] + source.choice((b"[", b'{"a":', b"9", b"-", b'"', b" ")) * source.choice((1, DEEP)) + content[at:]
    return source.randbytes(source.randint(0, 100))


def modified(name, number, text):
    source = random.Random(f"{name} {number}")
    if source.random() < 0.7:
        return changed_text(source, text).encode()
    return changed_bytes(source, text.encode())


def evidence():
    world = SyntheticWorld(1, 1)
    made = world.evidence(2, 3)
    world.add_effect(made, "adhesion", world.pattern(0.1))
    world.add_nuisance(made, "modulus", world.pattern(1 / 3), 1)
    made.library.origin, made.library.provenance = {"grains.friction": "0.03"}, {"program": "0.1"}
    return made


EVIDENCE = evidence()
FINDINGS = Findings(0.1, ["adhesion", "modulus"], 1, [1.0, 0.5], [Proposal([0], [0.1], [0.02], 12.5, 0.3)], numerics=[0])
CASES = (ChallengeCase("case_0001", CaseKind.effect, (Hidden("adhesion", 3.0),), (Hidden("modulus", -0.1),), ("friction",), 0, 1),
         ChallengeCase("case_0002", CaseKind.none, (), (), (), 1, 2))
OPENED = OpenChallenge("a" * 64, "b" * 64, (OpenCase("case_0001", ("adhesion",)), OpenCase("case_0002")))


def without_digest(text):
    """So that changes are not refused by their digest alone."""
    document = json.loads(text)
    del document["sha256"]
    return json.dumps(document, sort_keys=True, separators=(",", ":"))


# Name -> whole text, what reads the file.
DOCUMENTS = {
    "library.json": (without_digest(library_text(EVIDENCE.library)), lambda file: library_text(read_scattered(file))),
    "evidence.json": (evidence_text(EVIDENCE), lambda file: evidence_text(read_evidence(file, EVIDENCE.library))),
    "findings.json": (findings_text(FINDINGS), lambda file: findings_text(read_findings(file))),
    "challenge.json": (open_challenge_text(OPENED), lambda file: open_challenge_text(read_open_challenge(file.parent))),
    "truth.json": (truth_text(Challenge(1, "", (1, 2), CASES)), lambda file: truth_text(parse_truth(file.read_bytes(), file))),
    "diagnosis.json": (json.dumps(sample("effect")), lambda file: diagnosis_json(diagnosis_of(file.read_bytes(), file))),
    "manifest.json": ('{"program": "0.1", "number of replicas": "4"}', read_manifest),
}


def read_scattered(file):
    library = read_library(file)
    with np.errstate(all="ignore"):
        scatter(library)
    return library


class Documents(unittest.TestCase):
    def test_whole_ones_are_read(self):
        for name, (text, _) in DOCUMENTS.items():
            self.assertEqual(self.problem_of(name, text.encode()), "")

    def test_modified_ones_are_read_or_refused(self):
        refused = 0
        for name, (text, _) in DOCUMENTS.items():
            with self.subTest(name):
                found = [(number, self.problem_of(name, modified(name, number, text))) for number in range(FIRST, FIRST + COUNT)]
                broken = [f"{name}, number {number}: {problem}" for number, problem in found if problem not in ("", "refused")]
                self.assertEqual(broken[:10], [], f"{len(broken)} of {COUNT}")
                refused += sum(problem == "refused" for _, problem in found)
        self.assertTrue(0.3 * COUNT * len(DOCUMENTS) < refused < 0.95 * COUNT * len(DOCUMENTS), refused)

    def problem_of(self, name, content):
        """Empty: it was read."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / name
            file.write_bytes(content)
            try:
                DOCUMENTS[name][1](file)
            except InputError:
                return "refused"
            except Exception as error:
                return f"{type(error).__name__}: {str(error)[:100]}"
        return ""


if __name__ == "__main__":
    unittest.main()
