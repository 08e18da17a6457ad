"""The sealed truth file of a challenge: written first, opened last."""
import hashlib
import json
from dataclasses import asdict

from ..errors import InputError
from ..look import Path
from .case import CaseKind, Challenge
from .files import FORMAT, document_of, read_there


def truth_text(challenge: Challenge) -> str:
    """JSON; bit-identical for the same challenge."""
    return json.dumps({**asdict(challenge), "format": FORMAT}, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def parse_truth(content: bytes, file: Path) -> Challenge:
    """Raises InputError if it is not the truth of a challenge."""
    truth = document_of(Challenge, content, file, "the truth of a challenge", "made by another version")
    for case in truth.cases:
        if case.kind not in list(CaseKind):
            raise InputError(f"{file}: not the truth of a challenge (there is no {case.kind})")
    return truth


def seal_of(content: bytes) -> str:
    """SHA-256 of the content: the seal."""
    return hashlib.sha256(content).hexdigest()


def open_truth(file: Path, seal: str) -> Challenge:
    """Raises InputError if the file is missing, does not match the seal, or is not the truth of a challenge."""
    content = read_there(file, "is missing; --truth says where the truth is")
    if (found := seal_of(content)) != seal:
        raise InputError(f"{file}: is not the truth that was sealed: its SHA-256 is {found}, challenge.json says {seal}")
    return parse_truth(content, file)
