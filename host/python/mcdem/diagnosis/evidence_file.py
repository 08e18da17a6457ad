"""Evidence and findings of a diagnosis as JSON files, so that limits and ablations can be tried without new simulations."""
import json
from dataclasses import dataclass
from typing import TypeVar

from ..checked_json import Invalid, expect, finite, json_of, object_of
from ..errors import InputError
from ..files import read_input
from ..json_text import compact_json
from ..look import Path, leads_somewhere
from ..results.recording import Floats
from .decision import Findings
from .evidence import CandidateRange, Evidence, NuisancePrior
from .library import Library

Document = TypeVar("Document")


@dataclass(frozen=True, eq=False)
class _EvidenceFile:
    """Everything of Evidence except the library, which all cases of a challenge share."""

    observed: Floats
    baseline: Floats
    candidates: list[CandidateRange]
    nuisances: list[NuisancePrior]
    seed: int


def _read(file: Path, kind: type[Document], what: str) -> Document:
    if not leads_somewhere(file):
        raise InputError(f"{file}: is missing; `mcdem challenge run` writes it")
    content = read_input(file)
    try:
        return object_of(kind, json.loads(content, parse_float=finite, parse_constant=finite), defaults=False)
    except (OverflowError, RecursionError, ValueError) as problem:  # numbers that are too large, too many lists, no JSON
        raise InputError(f"{file}: not {what} ({problem})") from problem


def evidence_text(evidence: Evidence) -> str:
    """JSON of everything except the library."""
    return compact_json(json_of(_EvidenceFile, evidence))


def read_evidence(file: Path, library: Library) -> Evidence:
    """Raises InputError if the file is not evidence, or does not match the bins of this library."""
    what = "evidence of this challenge"
    read = _read(file, _EvidenceFile, what)
    bins = library.baseline.shape[1]
    effects, nuisances = ({signature.name for signature in signatures} for signatures in (library.effects, library.nuisances))
    try:
        expect(read.observed.shape == read.baseline.shape[1:] == (bins,), "it has other observables than the library")
        expect(all(one.name in effects for one in read.candidates), "the library lacks an effect of it")
        expect(all(one.name in nuisances for one in read.nuisances), "the library lacks a nuisance of it")
    except Invalid as problem:
        raise InputError(f"{file}: not {what} ({problem})") from problem
    return Evidence(**vars(read), library=library, library_is_own=False)  # a challenge has one library for all


def findings_text(findings: Findings) -> str:
    """JSON."""
    return compact_json(json_of(Findings, findings))


def read_findings(file: Path) -> Findings:
    """Raises InputError if the file does not contain findings."""
    what = "findings of a diagnosis"
    findings = _read(file, Findings, what)
    proposed = [candidate for proposal in findings.proposals for candidate in proposal.candidates]
    if len(findings.names) != len(findings.gain):
        raise InputError(f"{file}: not {what} (one gain per candidate is required)")
    if not all(0 <= candidate < len(findings.names) for candidate in proposed):
        raise InputError(f"{file}: not {what} (it proposes a candidate that does not exist)")
    return findings
