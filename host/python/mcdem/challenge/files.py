"""challenge.json: the public data of a challenge, and the seal of the rest; files of its diagnoses."""
import json
import os
import re
from dataclasses import asdict, dataclass
from typing import TypeVar

from ..errors import InputError
from ..files import read_input
from ..look import Path, leads_somewhere
from ..checked_json import finite, object_of

FORMAT = 1
# Names of cases are also names of files of results: only plain names that do not collide with other files.
NAME_OF_A_CASE = re.compile(r"case_[A-Za-z0-9_-]{0,95}")

Document = TypeVar("Document")


@dataclass(frozen=True)
class OpenCase:
    folder: str  # of its experiment, in the folder of the challenge
    candidates: tuple[str, ...] | None = None  # effects that may be named; None: all


@dataclass(frozen=True)
class OpenChallenge:
    scene_sha256: str  # of the scene's text
    sealed_sha256: str  # of the file with the rest: the seal
    cases: tuple[OpenCase, ...]


def answer_file(folder: Path, case: OpenCase) -> str:
    """diagnosis.json of a case in the folder of the diagnoses, or why it could not be diagnosed."""
    return os.path.join(folder, case.folder + ".json")


def evidence_file(folder: Path, case: OpenCase) -> str:
    """The evidence of its diagnosis."""
    return os.path.join(folder, "evidence", case.folder + ".json")


def findings_file(folder: Path, case: OpenCase) -> str:
    """The findings of its diagnosis."""
    return os.path.join(folder, "findings", case.folder + ".json")


def read_there(file: Path, if_missing: str) -> bytes:
    """The bytes of a file. Raises InputError, with `if_missing` if it is not there, and RunError."""
    if not leads_somewhere(file):
        raise InputError(f"{file}: {if_missing}")
    return read_input(file)


def document_of(kind: type[Document], content: bytes, file: Path, what: str, of_other_format: str = "") -> Document:
    """The dataclass in the content of a JSON file, which has this format if there is a text for others. Raises InputError."""
    try:
        document = json.loads(content, parse_float=finite, parse_constant=finite)
        if of_other_format and isinstance(document, dict) and document.get("format") != FORMAT:
            raise InputError(f"{file}: {of_other_format}")
        return object_of(kind, document)
    except InputError:
        raise
    except (OverflowError, RecursionError, ValueError) as problem:  # numbers that are too large, too many lists, no JSON
        raise InputError(f"{file}: not {what} ({problem})") from problem


def open_challenge_text(challenge: OpenChallenge) -> str:
    return json.dumps({**asdict(challenge), "format": FORMAT}, indent=1, sort_keys=True) + "\n"


def read_open_challenge(folder: Path) -> OpenChallenge:
    """Raises InputError if the folder does not contain a challenge."""
    file = os.path.join(folder, "challenge.json")
    content = read_there(file, "there is no challenge; `mcdem challenge make` makes one")
    challenge = document_of(OpenChallenge, content, file, "a challenge", "made by another version; generate it again")
    problems, seen = list[str](), set[str]()
    for name in (case.folder for case in challenge.cases):
        if not NAME_OF_A_CASE.fullmatch(name):
            problems.append(f'{file}: folder must be a name such as case_0001, without a path, got "{name}"')
        if name in seen:
            problems.append(f"{file}: folder {name} is there twice")
        seen.add(name)
    if problems:
        raise InputError(problems)
    return challenge
