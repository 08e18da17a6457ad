"""Sets the limits of decisions with cases whose truth is known and that are not scored."""
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

from ..diagnosis.decision import Findings, Limits, decide
from .case import ChallengeCase
from .merits import Answer, Merits, ScoredCase, Share, merits_of

# By limit, the values that are tried.
CHOICES: dict[str, tuple[float, ...]] = {
    "false_alarm": (0.01,),  # a level of significance has a fixed meaning and is not tuned
    "reduction": (0.5, 0.6, 0.7, 0.8),
    "over_placebo": (0.1, 0.2, 0.4),
    "misfit": (1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1),
    "remainder": (0.1, 0.2, 0.3, 0.4),
    "form_remainder": (0.05, 0.1, 0.15, 0.2),
    "pair_reduction": (0.6, 0.7, 0.8, 0.9),
    "pair_misfit": (0.01, 0.02, 0.05, 0.1, 0.2),
    "only_noise": (0.01, 0.05, 0.2, 2),
    "group": (1, 2, 3, 5),
    "group_share": (0.01, 0.02, 0.04, 0.06, 0.1),
    "second_gain": (4, 8, 12, 20),
    "second_share": (0.02, 0.04, 0.08, 0.15, 0.3),
    "second_certain": (25, 50, 100, 1e9),
    "right_below": (0.03, 0.1, 0.3),
    "right_above": (0.9, 0.94, 0.96, 0.98),
    "right_form": (0.2, 0.4, 0.6, 0.8),
}
MAX_ROUNDS = 5


@dataclass(frozen=True)
class LimitCase:
    """Findings of a case, to be decided with trial limits."""
    truth: ChallengeCase
    findings: Findings
    over_limit: float = 0  # as in ScoredCase


@dataclass(frozen=True)
class Bars:
    """Targets of a challenge."""
    false_alarms: float = 0.10  # at most
    named_unknown: float = 0.10
    named_outside_prior: float = 0.10
    group_size: float = 1.5
    led_by_truth: float = 0.80  # at least
    truth_in_group: float = 0.85


def objective(merits: Merits) -> float:
    """Sharpness plus half the fraction of found pairs minus the Brier score, minus five times the shortfall from each target."""
    def above(value: float, bar: float) -> float:
        return max(0.0, value - bar)

    def below(share: Share, bar: float) -> float:
        return max(0.0, bar - share.value()) if share.of > 0 else 0.0

    bars = Bars()
    missing = (above(merits.false_alarms.value(), bars.false_alarms) + above(merits.named_unknown.value(), bars.named_unknown)
               + above(merits.named_outside_prior.value(), bars.named_outside_prior) + above(merits.group_size, bars.group_size)
               + below(merits.led_by_truth, bars.led_by_truth) + below(merits.truth_in_group, bars.truth_in_group))
    return merits.sharpness + 0.5 * merits.pair_found.value() - merits.brier - 5 * missing


def answer_of(findings: Findings, limits: Limits) -> Answer:
    decision = decide(findings, limits)
    answer = Answer(decision.verdict, tuple(findings.names[candidate] for candidate in decision.group))
    return Answer(answer.verdict, answer.group, decision.confidence[decision.group[0]]) if answer.leads() else answer


def merits_with(cases: Sequence[LimitCase], limits: Limits) -> Merits:
    return merits_of(ScoredCase(case.truth, answer_of(case.findings, limits), case.over_limit) for case in cases)


def choose_limits(cases: Sequence[LimitCase], names_alone: bool = True) -> Limits:
    """`names_alone`: as in Limits. The limits with the largest objective: one limit after the other is varied over a few values until none changes. Among equally
    good limits, those nearest to the defaults."""
    @cache
    def reached(limits: Limits) -> float:
        return objective(merits_with(cases, limits))

    best = Limits(names_alone=names_alone)
    for _ in range(MAX_ROUNDS):
        before = best
        for name, values in CHOICES.items():
            for value in values:
                tried = replace(best, **{name: value})
                if reached(tried) > reached(best) + 1e-9:
                    best = tried
        if best == before:
            break
    return best


def named_limits(limits: Limits) -> dict[str, float]:
    """The limits by name, for tables."""
    return {name: float(getattr(limits, name)) for name in sorted(CHOICES)}
