"""The verdict from a small set of numbers, without data and simulations, so that thresholds can be studied on stored cases."""
from dataclasses import dataclass, field

import numpy as np

from .diagnosis_types import Explanation, Verdict


@dataclass(frozen=True)
class Limits:
    """Thresholds of the decision. They were set on one half of the challenge and scored on the other (tests/challenge/README.md),
    except `reduction`: in 108 gaps from an independent solver, 63 of 63 leading effects that took away 0.6 or more were right, and
    41 of 45 that took away less were wrong."""

    false_alarm: float = 0.01  # there is a gap if p is smaller
    reduction: float = 0.6  # fraction of the gap that an effect must take away to be named,
    min_reduction: float = 0.3  # less by its noise, but this at least, if one effect leaves only noise,
    over_placebo: float = 0.1  # and by how much this must exceed the placebo's
    pair_reduction: float = 0.8  # the least fraction that a pair must take away
    misfit: float = 0.001  # the remainder of one effect exceeds noise if its p is smaller;
    remainder: float = 0.3  # largest fraction of the gap that a named effect may leave beyond noise,
    another_form: float = 1e-10  # and if p is smaller than this: another effect may be the cause, so it
    form_remainder: float = 0.1  # may leave only this fraction
    only_noise: float = 0.05  # the remainder of one effect is only noise if its p is at least this,
    pair_misfit: float = 0.02  # that of a pair, which is named only then, at least this
    group: float = 2.0  # largest difference in log likelihood within a group,
    group_share: float = 0.01  # or this fraction of the leading effect's gain
    second_gain: float = 8.0  # gain in log likelihood required of a second effect,
    second_share: float = 0.02  # and this fraction of the leading effect's gain,
    second_certain: float = 50  # but not more than this; it then counts even if one effect leaves only noise
    right_below: float = 0.1  # probability that a leading effect is right if the fraction that it takes
    doubt_below: float = 0.4  # away is less than required to name it by this much,
    right_above: float = 0.98  # and if it takes away
    certain_above: float = 0.2  # this much more than required; linear in between
    right_form: float = 0.4  # instead of `right_above` if p is smaller than `another_form`
    right_refused: float = 0.5  # largest probability of an effect that is not named
    # Whether one effect may be named alone. Of a curve alone only a group is: nothing else that was measured confirms which it is.
    names_alone: bool = True
    reduction_margin: float = 0.1  # error of the reduction by signatures, on either side of its interval

    def enough(self, pair: bool) -> float:
        """p-value of the remainder below which a proposal leaves more than noise."""
        return self.pair_misfit if pair else self.misfit

    def group_margin(self, gain: float) -> float:
        """Largest difference in log likelihood within the group of an effect with this gain."""
        return max(self.group, self.group_share * gain)

    def second_margin(self, gain: float) -> float:
        """Gain in log likelihood required of a second effect beside one with this gain."""
        return max(self.second_gain, min(self.second_share * gain, self.second_certain))


@dataclass
class Proposal:
    """One effect or a pair, and how well it explains the gap."""

    candidates: list[int]  # indices in Findings.names
    amplitudes: list[float] = field(default_factory=list)
    errors: list[float] = field(default_factory=list)
    gain: float = 0  # in log likelihood over no effect, from signatures
    misfit_p: float = 1  # p-value of the remainder, from signatures
    confirmed_gain: float | None = None  # the same from real runs
    confirmed_misfit_p: float | None = None
    reduction: float = 0  # fraction of the gap that it takes away (Findings.held_out), from signatures
    confirmed_reduction: float | None = None  # the same from real runs
    left_out: int | None = None  # place of the grid without which the runs leave no more than noise: grains may have rearranged
    # there; reductions are without it, too
    rest_misfit_p: float = 0  # p-value of the remainder without it

    def is_pair(self) -> bool:
        return len(self.candidates) == 2

    def best_gain(self) -> float:
        return self.gain if self.confirmed_gain is None else self.confirmed_gain

    def whole_misfit(self) -> float:
        return self.misfit_p if self.confirmed_misfit_p is None else self.confirmed_misfit_p

    def best_misfit(self) -> float:
        return self.whole_misfit() if self.left_out is None else self.rest_misfit_p

    def best_reduction(self) -> float:
        """At most zero without a gain in likelihood: a smaller remainder in some data then costs more in others."""
        known = self.reduction if self.confirmed_reduction is None else self.confirmed_reduction
        return known if self.best_gain() > 0 else min(known, 0.0)


@dataclass
class Findings:
    p_value: float = 1  # probability of the data without a gap
    names: list[str] = field(default_factory=list)  # candidates: effects, then nuisances beyond their priors
    effects: int = 0  # number of effects among them
    gain: list[float] = field(default_factory=list)  # by candidate, from signatures
    proposals: list[Proposal] = field(default_factory=list)  # single effects by gain, then the best pair
    held_out: bool = True  # reductions are of the gap in held-out data; False: these show no gap, so of the whole gap
    held_out_noise: float = 0  # noise of these reductions, as a fraction of the gap in held-out data
    placebo: float = 0  # reduction by the best of random signatures
    numerics: list[int] = field(default_factory=list)  # effects that are the simulation's own numerics

    def is_nuisance(self, candidate: int) -> bool:
        return candidate >= self.effects

    def is_numerical(self, candidate: int) -> bool:
        return candidate in self.numerics


@dataclass
class Decision:
    verdict: Verdict = Verdict.no_gap
    proposal: int = -1  # index in Findings.proposals, -1: none
    group: list[int] = field(default_factory=list)  # candidates that cannot be distinguished, the leading one first
    confidence: list[float] = field(default_factory=list)  # by candidate: probability that it is the cause, or one of a pair; the
    # rest to one is the probability of an unknown effect


def chosen_proposal(findings: Findings, decision: Decision) -> Proposal:
    """The proposal of a decision that has one."""
    return findings.proposals[decision.proposal]


def _known_gains(findings: Findings, leader: Proposal) -> list[float]:
    """Gain by candidate: from real runs if there are any, otherwise as far behind the leading one as by signatures."""
    gains = [gain + leader.best_gain() - leader.gain if gain > 0 else gain for gain in findings.gain]
    for proposal in findings.proposals:
        if not proposal.is_pair() and proposal.confirmed_gain is not None:
            gains[proposal.candidates[0]] = proposal.confirmed_gain
    return gains


def _best_single(findings: Findings) -> int:
    """Index of the best single effect; -1 if there is none."""
    singles = [k for k, proposal in enumerate(findings.proposals) if not proposal.is_pair()]
    return max(singles, key=lambda k: findings.proposals[k].best_gain(), default=-1)


def _gaining_pair(findings: Findings, single_gain: float, limits: Limits) -> int:
    """Index of a pair with a sufficient gain from its second effect; -1 if there is none."""
    return next((k for k, pair in enumerate(findings.proposals)
                 if pair.is_pair() and pair.best_gain() - single_gain > limits.second_margin(single_gain)), -1)


def _needed_reduction(proposal: Proposal, findings: Findings, limits: Limits) -> float:
    """Reduction required to name an effect: most of the gap, and clearly more than the placebo. A small gap in held-out data is
    measured badly: if one effect leaves only noise in all data, it may take away less by the noise of the reduction."""
    known = limits.pair_reduction if proposal.is_pair() else limits.reduction
    if not proposal.is_pair() and proposal.best_misfit() >= limits.only_noise:
        known = max(known - findings.held_out_noise, limits.min_reduction)
    return max(known, findings.placebo + limits.over_placebo)


def _reduces_enough(proposal: Proposal, findings: Findings, limits: Limits) -> bool:
    return proposal.best_reduction() >= _needed_reduction(proposal, findings, limits)


def _allowed_remainder(proposal: Proposal, limits: Limits) -> float:
    """Largest fraction of the gap that a named effect may leave: the less probable it is that the remainder is noise, the more
    probable is another cause."""
    p = proposal.best_misfit()
    return limits.form_remainder if p < limits.another_form else limits.remainder if p < limits.misfit else 1.0


def _remainder_exceeds_limit(proposal: Proposal, limits: Limits) -> bool:
    return 1 - proposal.best_reduction() > _allowed_remainder(proposal, limits)


def _is_better(pair: Proposal, single: Proposal, limits: Limits) -> bool:
    """Whether a pair is better than a single effect: one leaves more than noise, or is much less likely, and two leave only noise.
    Two free amplitudes take away most of many gaps with another cause, so a pair that leaves more is not named. If a place is left
    out for the pair, one may be left out for the single effect as well."""
    if pair.best_misfit() < limits.pair_misfit:
        return False
    if pair.left_out is not None:
        return single.best_misfit() < limits.misfit
    return single.whole_misfit() < limits.misfit or pair.best_gain() - single.best_gain() > limits.second_certain


def _trust(proposal: Proposal, findings: Findings, limits: Limits) -> float:
    """Probability that an explanation with this reduction is right, as in 343 gaps of five challenges
    (tests/external/results.md)."""
    low = _needed_reduction(proposal, findings, limits) - limits.doubt_below
    above = min(max((proposal.best_reduction() - low) / (limits.doubt_below + limits.certain_above), 0.0), 1.0)
    most = limits.right_form if proposal.best_misfit() < limits.another_form else limits.right_above
    right = limits.right_below + above * (most - limits.right_below)
    refused = not _reduces_enough(proposal, findings, limits) or _remainder_exceeds_limit(proposal, limits)
    return min(right, limits.right_refused) if refused else right


def _shares(gains: list[float], best: float, margin: float, limits: Limits) -> list[float]:
    """Share of each candidate in the likelihood; gains are scaled so that the group's margin corresponds to `limits.group`."""
    parts = np.exp(np.minimum(0.0, np.array(gains) - best) * limits.group / margin)
    return [float(part) for part in parts / parts.sum()]


def _group_of(leader: int, gains: list[float], best: float, margin: float) -> list[int]:
    """The leading candidate, and those within the margin, by gain."""
    others = [c for c, gain in enumerate(gains) if c != leader and gain > 0 and best - gain <= margin]
    return [leader, *sorted(others, key=lambda c: -gains[c])]


def _proposal_of(candidate: int, findings: Findings) -> int:
    """Index of the proposal with only this candidate; -1 if there is none."""
    return next((k for k, proposal in enumerate(findings.proposals) if proposal.candidates == [candidate]), -1)


def _without_refuted(group: list[int], findings: Findings, limits: Limits) -> list[int]:
    """Without members of the group that were tried and take away too little of the gap, even if their likelihood is close."""
    tried = {candidate: _proposal_of(candidate, findings) for candidate in group[1:]}
    return [group[0], *(candidate for candidate, k in tried.items()
                        if k < 0 or _reduces_enough(findings.proposals[k], findings, limits))]


def _suspected(decision: Decision, findings: Findings) -> Verdict | None:
    """Suspects take precedence over effects from which they cannot be distinguished: first the simulation's own numerics, then
    stated parameters. If there are any, they lead the group."""
    pair = chosen_proposal(findings, decision).is_pair()
    for verdict, is_suspect in ((Verdict.not_converged, findings.is_numerical), (Verdict.calibration_suspect, findings.is_nuisance)):
        if not any(map(is_suspect, decision.group)) or pair and verdict is Verdict.calibration_suspect:
            continue
        decision.group.sort(key=lambda candidate: not is_suspect(candidate))
        proposal = _proposal_of(decision.group[0], findings)
        if proposal >= 0 and not pair:
            decision.proposal = proposal
        return verdict
    return None


def _name_effect(decision: Decision, findings: Findings, limits: Limits) -> None:
    suspected = _suspected(decision, findings)
    chosen = chosen_proposal(findings, decision)
    if suspected:
        decision.verdict = suspected
    elif _remainder_exceeds_limit(chosen, limits):
        decision.verdict = Verdict.unknown_effect
    else:
        is_group = not chosen.is_pair() and len(decision.group) > 1
        decision.verdict = Verdict.group if is_group else Verdict.effect if limits.names_alone else Verdict.unknown_effect


def _chosen(findings: Findings, single: int, group: list[int], limits: Limits) -> Decision:
    """Selects verdict, proposal and group."""
    decision = Decision(proposal=single, group=group)
    if findings.p_value >= limits.false_alarm:
        return decision
    leader = findings.proposals[single]
    pair = _gaining_pair(findings, leader.best_gain(), limits)
    two = findings.proposals[pair]
    if pair >= 0 and _reduces_enough(two, findings, limits) and _is_better(two, leader, limits):
        decision.proposal, decision.group = pair, list(two.candidates)
    elif _reduces_enough(leader, findings, limits):
        decision.group = _without_refuted(group, findings, limits)
    else:
        decision.verdict = Verdict.unknown_effect
        return decision
    _name_effect(decision, findings, limits)
    return decision


def decide(findings: Findings, limits: Limits) -> Decision:
    single = _best_single(findings)
    if single < 0:  # no effect gains anything, or none could be tested
        verdict = Verdict.unknown_effect if findings.p_value < limits.false_alarm else Verdict.no_gap
        return Decision(verdict, confidence=[0.0] * len(findings.gain))
    leader = findings.proposals[single]
    gains = _known_gains(findings, leader)
    best = leader.best_gain()
    margin = limits.group_margin(best)
    decision = _chosen(findings, single, _group_of(leader.candidates[0], gains, best, margin), limits)
    decided = chosen_proposal(findings, decision)
    right = _trust(decided, findings, limits)
    if decision.verdict == Verdict.unknown_effect and not limits.names_alone:
        right = min(right, limits.right_refused)
    if decided.is_pair():  # gains of single effects are not compared
        decision.confidence = [right if c in decided.candidates else 0.0 for c in range(len(findings.gain))]
    else:
        decision.confidence = [right * share for share in _shares(gains, best, margin, limits)]
    return decision


def contenders(findings: Findings, limits: Limits) -> list[int]:
    """Proposals whose reductions the decision depends on: the best single one, and a pair with a sufficient additional gain."""
    single = _best_single(findings)
    if single < 0:
        return []
    pair = _gaining_pair(findings, findings.proposals[single].best_gain(), limits)
    return [single, pair] if pair >= 0 else [single]


def explanation_of(findings: Findings, decision: Decision, limits: Limits) -> Explanation | None:
    """What the chosen proposal explains and what it leaves; nothing without a proposal."""
    if decision.verdict == Verdict.no_gap or decision.proposal < 0:
        return None
    decided = chosen_proposal(findings, decision)
    needed = _needed_reduction(decided, findings, limits)
    if decision.verdict not in (Verdict.not_converged, Verdict.calibration_suspect):
        needed = max(needed, 1 - _allowed_remainder(decided, limits))
    if decision.verdict == Verdict.unknown_effect and not limits.names_alone:
        needed = max(needed, 1 + limits.over_placebo)  # no reduction suffices
    return Explanation(decided.best_reduction(), decided.confirmed_reduction is not None, findings.held_out, findings.placebo, needed,
                       decided.best_misfit(), leaves_more_than_noise=decided.best_misfit() < limits.misfit, without="")
