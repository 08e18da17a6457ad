"""Recommended next measurements, predicted from the signatures."""
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import erfc, nan, sqrt

import numpy as np

from ..observe.grid import bins_each
from ..observe.observables import observables
from ..results.recording import Floats
from .decision import Decision, Findings, Limits, chosen_proposal
from .diagnosis_types import Diagnosis, NextStep, Verdict
from .effect_fit import Candidate, fit_effect, lacking_bins
from .effects import depends_on_speed
from .evidence import Evidence, GapData, parameters_of
from .gap_space import BinChoice, FreeParameter, GapSpace, usable_bins
from .library import apart_from_mean
from .mimics import mimics_of
from .not_measured import not_measured

TIMES_BETTER = 5  # factor by which a parameter is measured better
MORE_PACKINGS = 3
WORTH_SAYING = 0.9  # ratio to the present error or limit; larger ones are not reported
MAX_STEPS = 4
KEYS = {"modulus": "grains.youngs_modulus", "strain_offset": "the zero of the plate's displacement", "gamma": "contact.gamma",
        "wall_friction": "walls.friction", "diameter_error": "the diameters of the grains"}


@dataclass(frozen=True)
class Measurement:
    """A possible measurement and the space that results from it."""

    what: str
    space: GapSpace


@dataclass(frozen=True)
class ProtocolRuns:
    """Runs of the leading effect and of its rival under another protocol of the plate. Row: replicate, with the same packing and noise in
    both; column: bin."""

    leader: Floats
    rival: Floats


def _key_of(nuisance: str) -> str:
    return KEYS.get(nuisance, "grains.friction")


def _scatter_of(runs: Floats) -> Floats:
    """Runs of one scene minus their mean, scaled to the variance of one run."""
    return apart_from_mean(runs, [0] * len(runs))


def _squared(values: Floats) -> float:
    return float(values @ values)


def _finer_noise(evidence: Evidence, noise: Floats) -> Floats:
    """Noise if positions were measured twice as accurately: that of the diagnosis, scaled bin by bin as the scatter of the replicates."""
    finer, coarse = (np.sqrt((_scatter_of(runs)**2).mean(axis=0)) for runs in (evidence.finer_baseline, evidence.baseline))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = finer / coarse
    scaled: Floats = noise * np.where(np.isfinite(ratio), ratio, 1)
    return scaled


def _measurements_of(evidence: Evidence, data: GapData) -> list[Measurement]:
    measurements = []

    def add(what: str, noise: Floats = data.noise, bins: BinChoice = data.bins, free: Sequence[FreeParameter] = data.free) -> None:
        measurements.append(Measurement(what, data.space(bins, free, noise=noise)))

    for k, nuisance in enumerate(evidence.nuisances):
        better = replace(data.free[k], sigma=data.free[k].sigma / TIMES_BETTER)
        add(f"determine {_key_of(nuisance.name)} {TIMES_BETTER} times more accurately", free=[*data.free[:k], better, *data.free[k + 1:]])
    add(f"measure {MORE_PACKINGS} more packings and diagnose them together (--experiment for each)",
        noise=data.noise / sqrt(1 + MORE_PACKINGS / data.packings))
    if len(evidence.finer_baseline) > 1:
        add("measure positions twice as accurately", noise=_finer_noise(evidence, data.noise))
    if not_measured(evidence.observed, evidence.library.grid):
        every = usable_bins(evidence.library.baseline, parameters_of(evidence), np.zeros(len(data.mean)))
        needs = np.array([one.needs for one in observables()])
        every = every[needs[every // bins_each(len(data.mean))] != "grains"]  # not compared where forces are measured
        if len(every) > len(data.bins):
            add("measure contact forces, with the positions of grains in the same frames", bins=every)
    return measurements


def _distance(whole: GapSpace, a: Candidate, amplitude: float, b: Candidate) -> float:
    """Squared distance, in sigmas, of a signature from the closest one of another candidate."""
    space = whole.lacking(lacking_bins([a, b]))
    gap = a.signature.at(amplitude)
    return max(0.0, _squared(space.whiten(gap)) - 2 * fit_effect(space, b, gap).score)


def _power_to_tell(squared_distance: float, margin: float) -> float:
    """Probability that the likelihoods of two explanations differ by more than the margin of a group; normal distribution."""
    if not squared_distance > 0:
        return 0
    return erfc(-(0.5 * squared_distance - margin) / sqrt(2 * squared_distance)) / 2


def _amplitude_of(findings: Findings, decision: Decision, candidate: int) -> float:
    """The amplitude of a candidate in the decision."""
    decided = chosen_proposal(findings, decision)
    return dict(zip(decided.candidates, decided.amplitudes)).get(candidate, 0)


def _telling_apart(measurements: Sequence[Measurement], data: GapData, findings: Findings, decision: Decision,
                   limits: Limits) -> list[NextStep]:
    """Measurements that distinguish the leading effect from the others in its group."""
    leader = chosen_proposal(findings, decision).candidates[0]
    rival = next(candidate for candidate in decision.group if candidate != leader)
    amplitude = _amplitude_of(findings, decision, leader)
    first = data.candidates[leader]
    steps = []
    for m in measurements:
        squared = _distance(m.space, first, amplitude, data.candidates[rival])
        gain = 0.5 * _squared(m.space.lacking(first.lacking).whiten(first.signature.at(amplitude)))
        steps.append(NextStep(f"{m.what}, to distinguish {data.name(leader)} from {data.name(rival)}",
                              _power_to_tell(squared, limits.group_margin(gain))))
    return steps


def _more_information(then: GapSpace, now: GapSpace, candidate: Candidate, amplitude: float) -> float:
    """Information on a candidate's amplitude after a measurement, over the present one."""
    slope = candidate.signature.slope(amplitude)
    after, known = (_squared(space.lacking(candidate.lacking).whiten(slope)) for space in (then, now))
    return after / known if known > 0 else 1


def _sharpening(measurements: Sequence[Measurement], evidence: Evidence, data: GapData, findings: Findings,
                decision: Decision) -> list[NextStep]:
    """Without rivals: resulting errors of the amplitude, or without a gap resulting detection limits."""
    now = data.space()
    named = decision.verdict == Verdict.effect
    what_falls = "the amplitude's error falls" if named else "the median detection limit falls"
    amplitudes = {c: _amplitude_of(findings, decision, c) if named else 0.0
                  for c in range(data.effects) if not named or c == decision.group[0]}
    found = []
    for m in measurements:
        parts = sorted(_more_information(m.space, now, data.candidates[c], a)**-0.5 for c, a in amplitudes.items())
        median = parts[len(parts) // 2] if parts else nan
        if median <= WORTH_SAYING:
            found.append((median, f"{m.what}: {what_falls} to {100 * median:.0f} % of the present value"))
    return [NextStep(what, None) for _, what in sorted(found)]


def _bins_of_protocol(runs: ProtocolRuns, baseline: Floats, known: BinChoice) -> BinChoice:
    """The bins of the diagnosis that the runs have too, and those that no run of the baseline has."""
    wanted = ~np.isfinite(baseline).any(axis=0)
    wanted[known] = True
    return np.flatnonzero(wanted & np.isfinite(runs.leader).all(axis=0) & np.isfinite(runs.rival).all(axis=0))


def _with_noise_of_new_bins(noise: Floats, runs: Floats, bins: BinChoice) -> Floats:
    """Replaces NaN in columns of `bins` by the scatter of the runs."""
    new = bins[~np.isfinite(noise[:, bins]).all(axis=0)]
    noise = noise.copy()
    noise[:, new] = np.resize(_scatter_of(runs)[:, new], (len(noise), len(new)))
    return noise


def _has_rivals(findings: Findings, decision: Decision) -> bool:
    """Whether several single effects explain the gap, which a measurement might distinguish."""
    return (decision.verdict != Verdict.no_gap and decision.proposal >= 0 and len(decision.group) > 1
            and not chosen_proposal(findings, decision).is_pair())


def check_of(diagnosis: Diagnosis) -> NextStep | None:
    """To check the parameters of Diagnosis.check_first; nothing if there are none."""
    if not diagnosis.check_first:
        return None
    keys = ", ".join(_key_of(fit.name) for fit in diagnosis.check_first)
    return NextStep(f"check {keys}: measure again what the experiment states, correct the scene or the data, and diagnose again before "
                    "anything else is changed", None)


def proposal_of_rival(findings: Findings, decision: Decision) -> int | None:
    """The proposal of the nearest rival of the leading effect, if it was confirmed by runs too."""
    if not _has_rivals(findings, decision):
        return None
    leader = chosen_proposal(findings, decision).candidates[0]
    return next((k for candidate in decision.group if candidate != leader
                 for k, proposal in enumerate(findings.proposals) if list(proposal.candidates) == [candidate]), None)


def power_of_protocol(runs: ProtocolRuns, evidence: Evidence, data: GapData, findings: Findings, decision: Decision,
                      limits: Limits) -> float:
    """Probability that one experiment under this protocol distinguishes the two. Noise and parameters are those of the diagnosis. A bin
    that only the protocol has, such as the relaxation in a hold, has the scatter of the runs and depends on no parameter."""
    bins = _bins_of_protocol(runs, evidence.baseline, data.bins)
    place = proposal_of_rival(findings, decision)
    if not len(bins) or place is None:
        return 0
    rival = findings.proposals[place]
    slope = data.candidates[rival.candidates[0]].signature.slope(rival.amplitudes[0])
    # The rival's amplitude is fitted to the new data as well.
    free = [*data.free, FreeParameter(slope, abs(rival.amplitudes[0]))]
    free = [replace(one, direction=np.where(np.isfinite(one.direction), one.direction, 0)) for one in free]
    space = data.space(bins, free, noise=_with_noise_of_new_bins(data.noise, runs.leader, bins))
    # The product of the means of both halves of the runs has no bias by their noise.
    first, second = (space.whiten(half.mean(axis=0)) for half in np.split(runs.leader - runs.rival, [len(runs.leader) // 2]))
    return _power_to_tell(float(first @ second), limits.group_margin(chosen_proposal(findings, decision).best_gain()))


def next_measurements(evidence: Evidence, data: GapData, findings: Findings, decision: Decision, limits: Limits) -> list[NextStep]:
    """Useful measurements, best first. If several effects explain the gap: with the probability that they distinguish the leading effect
    from its nearest rival; otherwise with the resulting errors of amplitudes or detection limits."""
    measurements = _measurements_of(evidence, data)
    has_rivals = _has_rivals(findings, decision)
    steps = (_telling_apart(measurements, data, findings, decision, limits) if has_rivals
             else _sharpening(measurements, evidence, data, findings, decision))
    steps = sorted(steps, key=lambda step: -(step.power or 0))[:MAX_STEPS]
    if decision.verdict != Verdict.no_gap and not has_rivals and any(depends_on_speed(data.name(c)) for c in decision.group):
        steps.append(NextStep("repeat the experiment at another plate speed: a difference that changes with speed is not caused by "
                              "geometry or elasticity", None))
    if decision.verdict in (Verdict.effect, Verdict.group):
        named = chosen_proposal(findings, decision).candidates
        steps += [NextStep(f"exclude {mimic.what}: {mimic.told_by}", None)
                  for mimic in dict.fromkeys(mimic for c in named for mimic in mimics_of(data.name(c)))]
    if decision.verdict == Verdict.unknown_effect:
        steps.insert(0, NextStep("see Where for the observables that differ, and check the data (`mcdem experiment check`), the stated "
                                 "parameters and units, and the numerics (`mcdem converge`)", None))
    return steps
