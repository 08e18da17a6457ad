"""Figures of a challenge (figures/challenge.py): confusion of truth and verdict, detection power, and calibration of stated
probabilities."""
import bisect
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from ..diagnosis.decision import Limits
from ..diagnosis.diagnosis_types import Verdict
from .case import CaseKind, ChallengeCase
from .merits import Answer, ScoredCase, Share, share_of
from .score import ChallengeScore

POWER_AT_LIMIT = 0.8  # fraction of the cases at the detection limit that are detected
TWO_EFFECTS = "two effects"
LAST = TWO_EFFECTS, Verdict.unknown_effect, Verdict.not_converged, Verdict.calibration_suspect


def _row_of(truth: ChallengeCase) -> str:
    """The right verdict."""
    return {CaseKind.none: Verdict.no_gap, CaseKind.pair: TWO_EFFECTS, CaseKind.unknown: Verdict.unknown_effect,
            CaseKind.outside_prior: Verdict.calibration_suspect}.get(CaseKind(truth.kind)) or truth.effects[0].name


def _column_of(answer: Answer) -> str:
    if not answer.names():
        return answer.verdict
    return TWO_EFFECTS if answer.verdict == Verdict.effect and len(answer.group) == 2 else answer.group[0]


def _in_order(names: Iterable[str]) -> list[str]:
    """Order of rows and columns: no gap, single effects, two effects, unknown, not converged, calibration."""
    return sorted(set(map(str, names)), key=lambda name: (name != Verdict.no_gap, LAST.index(name) + 1 if name in LAST else 0, name))


def _confusion_values(cases: Sequence[ScoredCase]) -> dict[str, Any]:
    """Number of cases by truth and verdict."""
    places = [(_row_of(case.truth), _column_of(case.answer)) for case in cases]
    truths, verdicts = (_in_order(names) for names in zip(*places))
    counts = [[places.count((truth, verdict)) for verdict in verdicts] for truth in truths]
    return {"truths": truths, "verdicts": verdicts, "cases": counts,
            "right": [[t, verdicts.index(truth)] for t, truth in enumerate(truths) if truth in verdicts]}


def _measured(cases: Sequence[ScoredCase], edges: Sequence[float], x_of: Callable[[ScoredCase], float],
              is_hit: Callable[[ScoredCase], bool]) -> dict[str, Any]:
    """Fraction of the cases that are hits, with its interval, in bins of `x_of` with these upper edges, without empty ones."""
    bins: list[list[ScoredCase]] = [[] for _ in range(len(edges) + 1)]
    for case in cases:
        bins[bisect.bisect(edges, x_of(case))].append(case)
    filled = list(filter(None, bins))
    shares: list[Share] = [share_of(map(is_hit, cases)) for cases in filled]
    return {"x": [math.fsum(map(x_of, cases)) / len(cases) for cases in filled], "part": [share.value() for share in shares],
            "interval": [list(share.interval()) for share in shares], "cases": [share.of for share in shares]}


def ideal_power(false_alarm: float, over_limit: Any) -> Any:
    """Ideal power curve: detection probability at amplitudes over the detection limit for a normal variate with unit noise.
    `false_alarm`: that without an effect."""
    threshold = ndtri(1 - false_alarm / 2)  # two-sided
    mean = np.asarray(over_limit) * (threshold + ndtri(POWER_AT_LIMIT))
    return ndtr(mean - threshold) + ndtr(-mean - threshold)


def _power_values(cases: Sequence[ScoredCase], false_alarm: float) -> dict[str, Any]:
    """Power against the amplitude over the predicted detection limit."""
    points = _measured(cases, (0.35, 0.7, 1, 1.5, 3, 6, 12), lambda case: case.over_limit, lambda case: case.answer.detected())
    smallest, largest = min(0.5, points["x"][0]) / 1.2, max(2.0, points["x"][-1]) * 1.2
    x = smallest * (largest / smallest) ** (np.arange(101) / 100)
    return {"x_label": "amplitude / predicted detection limit", "y_label": "fraction detected", "measured": points,
            "predicted": {"x": x.tolist(), "part": ideal_power(false_alarm, x).tolist()},
            "words_predicted": f"as predicted: {false_alarm:.2g} without an effect, {POWER_AT_LIMIT:.2g} at the limit"}


def _confidence_values(cases: Sequence[ScoredCase]) -> dict[str, Any]:
    """Success rate of leading effects, named or not, against the probability that the diagnosis states."""
    points = _measured(cases, (0.2, 0.4, 0.6, 0.8, 0.95), lambda case: case.answer.confidence, ScoredCase.leader_is_true)
    return {"x_label": "probability stated", "y_label": "fraction right", "measured": points, "predicted": {"x": [0, 1], "part": [0, 1]},
            "words_predicted": "as stated"}


def score_figure_values(score: ChallengeScore) -> dict[str, Any]:
    """Values of the available figures: confusion, power and confidence."""
    values = dict[str, Any]()
    if score.scored:
        values["confusion"] = _confusion_values(score.scored)
    if with_limit := [case for case in score.scored if case.over_limit > 0]:
        values["power"] = _power_values(with_limit, (score.arms[0].limits or Limits()).false_alarm)
    if led := [case for case in score.scored if case.answer.leads()]:
        values["confidence"] = _confidence_values(led)
    return values
