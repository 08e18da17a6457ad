"""Figures of merit of a challenge, from the verdicts and the named effects."""
import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field

from ..diagnosis.diagnosis_types import Verdict
from .case import CaseKind, ChallengeCase

CLEAR = 1.5  # amplitudes of at least this many detection limits are clear
NORMAL_QUANTILE_975 = 1.959964


@dataclass(frozen=True)
class Answer:
    """The scored part of a diagnosis: the verdict and the leading effects."""
    verdict: Verdict = Verdict.no_gap
    group: tuple[str, ...] = ()  # effects that cannot be distinguished, or both of a pair; the leading one first
    confidence: float = 0  # of the leading effect

    def detected(self) -> bool:
        return self.verdict != Verdict.no_gap

    def names(self) -> bool:
        """Whether the effects are named as the cause."""
        return self.verdict in (Verdict.effect, Verdict.group)

    def leads(self) -> bool:
        """Whether a probability is stated for a leading effect, named or not."""
        return bool(self.group) and (self.names() or self.verdict == Verdict.unknown_effect)


def wilson_interval(successes: int, trials: int) -> tuple[float, float]:
    """95 % interval of a proportion (Wilson 1927); from 0 to 1 without trials."""
    if trials <= 0:
        return 0.0, 1.0
    part, z2 = successes / trials, NORMAL_QUANTILE_975**2
    middle = (part + z2 / (2 * trials)) / (1 + z2 / trials)
    half = NORMAL_QUANTILE_975 / (1 + z2 / trials) * math.sqrt(part * (1 - part) / trials + z2 / (4 * trials**2))
    # exactly around the share, also where rounding would leave 0 or 1 of it outside
    return min(max(middle - half, 0.0), part), max(min(middle + half, 1.0), part)


@dataclass
class Share:
    """Number of cases with a property, among all that could have it."""
    hits: int = 0
    of: int = 0

    def add(self, hit: bool) -> None:
        self.hits, self.of = self.hits + hit, self.of + 1

    def value(self) -> float:
        return self.hits / self.of if self.of > 0 else 0.0

    def interval(self) -> tuple[float, float]:
        return wilson_interval(self.hits, self.of)

    def __str__(self) -> str:
        """"36 of 40: 90 % [77, 96]"."""
        low, high = self.interval()
        return f"{self.hits} of {self.of}: {100 * self.value():.0f} % [{100 * low:.0f}, {100 * high:.0f}]" if self.of else "-"


def share_of(hits: Iterable[bool]) -> Share:
    share = Share()
    for hit in hits:
        share.add(hit)
    return share


@dataclass(frozen=True)
class ScoredCase:
    """A case, its answer, and the detection limit of its diagnosis."""
    truth: ChallengeCase
    answer: Answer
    over_limit: float = 0  # amplitude of the only effect over its predicted detection limit; 0: no effect, two, or no limit

    def true_names(self) -> list[str]:
        return [effect.name for effect in self.truth.effects]

    def leader_is_true(self) -> bool:
        """Whether the leading effect, named or not, is one of the true ones."""
        return self.answer.leads() and self.answer.group[0] in self.true_names()

    def leads_rightly(self) -> bool:
        """Whether the effect named first is one of the true ones."""
        return self.answer.names() and self.leader_is_true()

    def both_named(self) -> bool:
        """Whether two effects are named and both are true ones."""
        group = self.answer.group
        return self.answer.names() and len(group) == 2 and set(group) <= set(self.true_names())


def _by_name() -> defaultdict[str, Share]:
    return defaultdict(Share)


@dataclass
class Merits:
    false_alarms: Share = field(default_factory=Share)  # without an effect: a gap is claimed
    detected: Share = field(default_factory=Share)  # one effect: a gap is detected
    detected_clear: Share = field(default_factory=Share)  # one effect of at least CLEAR times the limit: detected
    led_by_truth: Share = field(default_factory=Share)  # of the detected clear ones: the effect named first is the true one
    truth_in_group: Share = field(default_factory=Share)  # of the detected clear ones: the true effect is among the named ones
    named: Share = field(default_factory=Share)  # one effect, any amplitude: the effect named first is the true one
    group_size: float = 0.0  # of the detected clear ones: mean number of named effects, if any
    sharpness: float = 0.0  # one clear effect: mean of 1/(number of named effects) if the true one is among them, otherwise 0
    named_unknown: Share = field(default_factory=Share)  # an effect outside the library: effects of the library are named
    named_outside_prior: Share = field(default_factory=Share)  # a nuisance outside its prior: effects are named
    suspected: Share = field(default_factory=Share)  # a nuisance outside its prior: the calibration is suspected
    pair_led: Share = field(default_factory=Share)  # two effects: the one named first is one of them
    pair_found: Share = field(default_factory=Share)  # two effects: both are named, and no other
    brier: float = 0.0  # mean square of (confidence - right) for all cases with a leading effect
    right_leaders: Share = field(default_factory=Share)  # all cases with a leading effect, named or not: it is a true one
    detected_by_effect: dict[str, Share] = field(default_factory=_by_name)  # one effect
    named_by_effect: dict[str, Share] = field(default_factory=_by_name)  # one effect
    named_by_unknown: dict[str, Share] = field(default_factory=_by_name)  # outside the library, by effect


def brier(stated: float, right: bool) -> float:
    """Square error of a stated probability."""
    return (stated - right)**2


def mean_or_zero(values: Iterable[float]) -> float:
    listed = list(values)
    return sum(listed) / len(listed) if listed else 0.0


def unknown_name(truth: ChallengeCase) -> str:
    """For an unknown effect: the name of the outside effect, or "struck" if it was removed from the library."""
    return "struck" if truth.struck else truth.effects[0].name


def merits_of(cases: Iterable[ScoredCase]) -> Merits:
    of_kind = defaultdict[str, list[ScoredCase]](list)
    for case in cases:
        of_kind[case.truth.kind].append(case)
    single, pairs, unknown, outside = (of_kind[kind] for kind in list(CaseKind)[1:])
    led = [case for every in of_kind.values() for case in every if case.answer.leads()]
    merits = Merits(
        false_alarms=share_of(case.answer.detected() for case in of_kind[CaseKind.none]),
        named_unknown=share_of(case.answer.names() for case in unknown),
        named_outside_prior=share_of(case.answer.names() for case in outside),
        suspected=share_of(case.answer.verdict == Verdict.calibration_suspect for case in outside),
        pair_led=share_of(map(ScoredCase.leads_rightly, pairs)), pair_found=share_of(map(ScoredCase.both_named, pairs)),
        brier=mean_or_zero(brier(case.answer.confidence, case.leader_is_true()) for case in led),
        right_leaders=share_of(map(ScoredCase.leader_is_true, led)))
    for case in unknown:
        merits.named_by_unknown[unknown_name(case.truth)].add(case.answer.names())
    _add_single_effects(merits, single)
    return merits


def _add_single_effects(merits: Merits, cases: list[ScoredCase]) -> None:
    def names_it(case: ScoredCase) -> bool:
        return case.answer.names() and case.truth.effects[0].name in case.answer.group

    for case in cases:
        for share, hit in ((merits.detected, case.answer.detected()), (merits.named, case.leads_rightly()),
                           (merits.detected_by_effect[case.truth.effects[0].name], case.answer.detected()),
                           (merits.named_by_effect[case.truth.effects[0].name], case.leads_rightly())):
            share.add(hit)
    clear = [case for case in cases if case.over_limit >= CLEAR]
    found = [case for case in clear if case.answer.detected()]
    merits.detected_clear = Share(len(found), len(clear))
    merits.led_by_truth = share_of(map(ScoredCase.leads_rightly, found))
    merits.truth_in_group = share_of(map(names_it, found))
    merits.group_size = mean_or_zero(len(case.answer.group) for case in found if case.answer.names())
    merits.sharpness = mean_or_zero(1 / len(case.answer.group) if names_it(case) else 0.0 for case in clear)
