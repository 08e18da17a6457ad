"""Score of a challenge: compares the answers with the sealed truth."""
import functools
import multiprocessing
import os
import statistics
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from multiprocessing.connection import wait
from typing import TypeVar

from ..diagnosis.decision import Findings, Limits
from ..diagnosis.evidence_file import read_evidence
from ..diagnosis.library import Library
from ..errors import InputError, RunError
from ..look import Path
from .ablations import ABLATIONS, SIMPLER_METHODS, ablated_findings
from .case import CaseKind, Challenge, ChallengeCase, in_first_half
from .files import OpenChallenge, evidence_file
from .limits import LimitCase, answer_of, choose_limits, merits_with
from .merits import Answer, Merits, ScoredCase, Share, merits_of, share_of
from .results import CaseResult, ChallengeResults, read_challenge_results

Case = TypeVar("Case", LimitCase, ScoredCase)


@dataclass(frozen=True)
class ArmScore:
    """A method, with limits set on the first half of the packings."""
    name: str
    meaning: str
    limits: Limits | None  # None for simpler methods
    first: Merits  # on the half that was used to set limits
    second: Merits  # on the other one


@dataclass(frozen=True)
class GapReductionScore:
    """Predicted and realised gap reduction, over all cases with confirming runs. It does not depend on limits."""
    cases: int = 0
    median_error: float = 0.0  # median |predicted - confirmed|
    covered: Share = field(default_factory=Share)  # the 90 % interval contains the realised value


@dataclass(frozen=True)
class ChallengeScore:
    cases: int
    not_diagnosed: list[str]  # folder and reason
    arms: list[ArmScore]  # the whole method first
    gap_reduction: GapReductionScore
    scored: list[ScoredCase]  # second half, by the whole method


def score_challenge(truth: Challenge, open: OpenChallenge, folder: Path, on_progress: Callable[[float], object]) -> ChallengeScore:
    """`truth` must belong to the challenge and have the same order. `on_progress`: completed fraction of the ablations."""
    if [case.folder for case in truth.cases] != [case.folder for case in open.cases]:
        raise InputError("challenge.json: lists other cases than its truth")
    results = read_challenge_results(folder, open)
    others = _try_other_arms(open, results, folder, on_progress)
    whole = [result.findings for result in results.cases]
    arms = [_score_with_limits(truth, results, "whole method", "with confirming runs", whole)]
    arms += [_score_with_limits(truth, results, ablation.name, ablation.meaning, [findings[a] for findings, _ in others])
             for a, ablation in enumerate(ABLATIONS)]
    for a, method in enumerate(SIMPLER_METHODS):
        cases = _scored(truth, results, [answers[a] for _, answers in others])
        arms.append(ArmScore(method.name, method.meaning, None, merits_of(_half_of(cases, True)), merits_of(_half_of(cases, False))))
    answers = [answer_of(findings, arms[0].limits or Limits()) for findings in whole]
    return ChallengeScore(
        len(truth.cases), [f"{case.folder}: {result.problem}" for case, result in zip(open.cases, results.cases) if result.problem],
        arms, _score_gap_reduction(results.cases), _half_of(_scored(truth, results, answers), False))


def over_limit(truth: ChallengeCase, result: CaseResult) -> float:
    """Amplitude of the only effect over its detection limit; 0: no effect, two, or no limit."""
    if truth.kind != CaseKind.effect or not (limit := result.detection_limits.get(truth.effects[0].name)):
        return 0.0
    return abs(truth.effects[0].amplitude) / limit


def _score_gap_reduction(results: Sequence[CaseResult]) -> GapReductionScore:
    known = [(one, one.confirmed) for result in results if (one := result.gap_reduction) and one.confirmed is not None]
    errors = [abs(one.fraction - confirmed) for one, confirmed in known]
    covered = share_of(one.interval[0] <= confirmed <= one.interval[1] for one, confirmed in known)
    return GapReductionScore(len(errors), statistics.median(errors) if errors else 0.0, covered)


def _half_of(cases: Sequence[Case], first: bool) -> list[Case]:
    return [case for case in cases if in_first_half(case.truth.packing) == first]


def _score_with_limits(truth: Challenge, results: ChallengeResults, name: str, meaning: str, findings: Sequence[Findings]) -> ArmScore:
    cases = [LimitCase(case, found, over_limit(case, result)) for case, found, result in zip(truth.cases, findings, results.cases)]
    first, second = _half_of(cases, True), _half_of(cases, False)
    limits = choose_limits(first, not results.library.is_drawn)
    return ArmScore(name, meaning, limits, merits_with(first, limits), merits_with(second, limits))


def _scored(truth: Challenge, results: ChallengeResults, answers: Sequence[Answer]) -> list[ScoredCase]:
    return [ScoredCase(case, answer, over_limit(case, result)) for case, answer, result in zip(truth.cases, answers, results.cases)]


# By case: the findings of every ablation and the answers of every simpler method.
Others = tuple[list[Findings], list[Answer]]


def _others_of(file: str, library: Library) -> Others:
    evidence = read_evidence(file, library)
    return [ablated_findings(evidence, ablation) for ablation in ABLATIONS], [method.answer(evidence) for method in SIMPLER_METHODS]


def _end_with_parent() -> None:
    """Ends this process with its parent, also if that is killed."""
    def end_after(process: int) -> None:
        wait([process])
        os._exit(1)

    if parent := multiprocessing.parent_process():
        threading.Thread(target=end_after, args=(parent.sentinel,), daemon=True).start()


def _try_other_arms(open: OpenChallenge, results: ChallengeResults, folder: Path, on_progress: Callable[[float], object]) -> list[Others]:
    """Evaluates all methods for all cases, on all cores; those that were not diagnosed find nothing."""
    nothing = [Findings() for _ in ABLATIONS], [Answer() for _ in SIMPLER_METHODS]
    files = {k: evidence_file(folder, case) for k, case in enumerate(open.cases) if not results.cases[k].problem}
    others = [nothing] * len(open.cases)
    try:
        with ProcessPoolExecutor(len(os.sched_getaffinity(0)), multiprocessing.get_context("fork"), _end_with_parent) as pool:
            work = functools.partial(_others_of, library=results.library)
            for done, (k, found) in enumerate(zip(files, pool.map(work, files.values())), 1):
                others[k] = found
                on_progress(done / len(files))
    except BrokenProcessPool as error:
        raise RunError("a process that tried other methods was killed: the machine may not have enough memory") from error
    return others
