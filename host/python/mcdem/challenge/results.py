"""The results of `mcdem challenge run`, as far as they are scored."""
import os
from dataclasses import dataclass, field

from ..diagnosis.decision import Findings
from ..diagnosis.evidence_file import read_findings
from ..diagnosis.library import Library, read_library
from ..look import Path
from .files import OpenCase, OpenChallenge, answer_file, document_of, findings_file, read_there


@dataclass(frozen=True)
class DetectionLimit:
    effect: str
    minimum_amplitude: float = field(metadata={"null": float("inf")})


@dataclass(frozen=True)
class GapReduction:
    """Predicted gap reduction on held-out data, and that of real runs."""
    fraction: float
    interval: tuple[float, float]  # 90 %
    confirmed: float | None


@dataclass(frozen=True)
class _Diagnosed:
    detection_limits: tuple[DetectionLimit, ...]
    shrink: GapReduction | None


@dataclass(frozen=True)
class _Answer:
    problem: str | None = None


@dataclass(frozen=True)
class CaseResult:
    problem: str = ""  # reason why it was not diagnosed; empty if it was
    findings: Findings = field(default_factory=Findings)
    detection_limits: dict[str, float] = field(default_factory=dict)  # smallest detectable amplitude by effect
    gap_reduction: GapReduction | None = None  # if there were confirming runs


@dataclass(frozen=True)
class ChallengeResults:
    library: Library
    cases: list[CaseResult]  # in the order of the challenge


def _read_case(folder: Path, case: OpenCase) -> CaseResult:
    file = answer_file(folder, case)
    content, what = read_there(file, "is missing; `mcdem challenge run` must have ended"), "a diagnosis of a challenge"
    if (problem := document_of(_Answer, content, file, what).problem) is not None:
        return CaseResult(problem)
    diagnosis = document_of(_Diagnosed, content, file, what)
    limits = {limit.effect: limit.minimum_amplitude for limit in diagnosis.detection_limits}
    confirmed = diagnosis.shrink if diagnosis.shrink and diagnosis.shrink.confirmed is not None else None
    return CaseResult("", read_findings(findings_file(folder, case)), limits, confirmed)


def read_challenge_results(folder: Path, challenge: OpenChallenge) -> ChallengeResults:
    """Raises InputError if the folder lacks a case or contains something else."""
    return ChallengeResults(read_library(os.path.join(folder, "library.json")), [_read_case(folder, case) for case in challenge.cases])
