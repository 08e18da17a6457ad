"""Proposals to be confirmed by real runs: the leading single effects, and the best pair."""
import math
from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ..results.recording import Floats
from .decision import Proposal
from .effect_fit import Candidate, EffectFit, draw_error, fit_effect, fits_of_many
from .effects import is_numerical
from .evidence import GapData
from .gap_space import BinChoice, FreeParameter, GapSpace, without
from .gap_tests import GapStatistics, NullDistribution
from .rearrangements import PlaceLeftOut

# Maximum number of leading single effects that are tried. In addition, the best nuisance is always tried, however far behind, so that no effect
# is named because of a wrong parameter; signatures are least accurate for parameters that are far off. The best of the simulation's own numerics
# is tried if it is close, and so is the best effect whose signature lacks bins, which its runs with a smaller amplitude may have.
MAX_SINGLES = 3
FAR_BEHIND, FAR_BEHIND_SHARE = 8, 0.25  # effects this far behind the leading one, in log likelihood or of its gain, are not tried
PAIR_GAIN = 4
SIGNATURE_ERROR = 0.1  # relative error of a signature, bin by bin
# Relative error of an amplitude because signatures are quadratic in it and may come from other packings. With it the 90 % interval holds 92 % of
# 199 true amplitudes in six challenges, the 68 % interval 76 %.
AMPLITUDE_ERROR = 0.01
MIN_RUNS = 2
STILL_FREE = 0.25  # fraction of an amplitude


def signature_variance(data: GapData, proposal: Proposal, packings: int = 1) -> Floats:
    """(all bins,) variance of the error of a proposal's signatures for the mean of packings: packings differ in an effect, and a tenth of a
    signature is uncertain."""
    variance = _effect_scatter(data, proposal) / packings
    for one, amplitude in zip(data.chosen(proposal.candidates), proposal.amplitudes):
        variance += (SIGNATURE_ERROR * one.signature.at(amplitude)) ** 2
    return variance


def _effect_scatter(data: GapData, proposal: Proposal) -> Floats:
    """Additional scatter between packings caused by the effect, because packings differ in it and it has random draws. For one packing."""
    chaos = 2 * data.packings * (data.noise**2).sum(axis=0) / len(data.noise)
    extra = np.zeros_like(data.mean)
    for one, amplitude in zip(data.chosen(proposal.candidates), proposal.amplitudes):
        part = min(1.0, abs(amplitude) / one.signature.reach)
        extra += np.maximum(amplitude**2 * one.signature.spread() - part**2 * chaos, 0)
    return extra


def propose(space: GapSpace, data: GapData, null: NullDistribution, statistics: GapStatistics) -> list[Proposal]:
    """`statistics` of the observed gap."""
    order = sorted(range(len(statistics.fits)), key=lambda c: -statistics.fits[c].score)
    proposals = _singles(space, data, statistics, order)
    if not proposals:
        return []
    pair = _best_pair(space, data, order)
    if pair and pair.gain > statistics.directed + PAIR_GAIN:
        proposals.append(pair)
    for proposal in proposals:
        with_error = data.space(extra=signature_variance(data, proposal, data.packings))
        proposal.misfit_p = null.misfit_p(with_error, data.gap - data.explained(proposal.candidates, proposal.amplitudes))
        proposal.errors = [
            math.hypot(error, draw_error(space, data.candidates[c], amplitude), AMPLITUDE_ERROR * amplitude)
            for c, amplitude, error in zip(proposal.candidates, proposal.amplitudes, proposal.errors)]
    return proposals


def _singles(space: GapSpace, data: GapData, statistics: GapStatistics, order: Sequence[int]) -> list[Proposal]:
    """By gain. `order`: all candidates by gain."""
    proposals: list[Proposal] = []
    tried: set[str] = set()  # the kinds of which one is tried even if three others are
    for c in order:
        fit = statistics.fits[c]
        if not fit.score > 0:
            break
        near = _behind(c, space, data, statistics) <= max(FAR_BEHIND, FAR_BEHIND_SHARE * statistics.directed)
        nuisance = c >= data.effects
        lacking = bool(np.isin(data.candidates[c].lacking, data.bins).any())
        kinds = {"nuisance": nuisance, "numerics": not nuisance and is_numerical(data.name(c)), "lacking": lacking}
        of_it = {kind for kind, is_it in kinds.items() if is_it}
        wanted = of_it - tried if near else (of_it - tried) & {"nuisance"}
        if (near and len(proposals) < MAX_SINGLES) or wanted:
            tried |= of_it
            proposals.append(_proposal([c], fit))
    return proposals


def _proposal(candidates: Sequence[int], fit: EffectFit) -> Proposal:
    return Proposal(list(candidates), list(fit.amplitudes), list(fit.errors), fit.score)


def _behind(c: int, space: GapSpace, data: GapData, statistics: GapStatistics) -> float:
    """How far a candidate is behind the leading one, in log likelihood, on the bins that it has."""
    tried, score = data.candidates[c], statistics.fits[c].score
    if not len(tried.lacking):
        return statistics.directed - score
    return fit_effect(space.lacking(tried.lacking), data.candidates[statistics.best], data.gap).score - score


def _best_pair(space: GapSpace, data: GapData, order: Sequence[int]) -> Proposal | None:
    """The two candidates that fit the gap best together. Neither needs to lead alone, because the contributions of both to a bin may
    cancel."""
    pairs = list(combinations(order, 2))
    fits = fits_of_many(space, [data.chosen(pair) for pair in pairs], data.gap[None])
    if not fits.scores.max(initial=0) > 0:
        return None
    best = int(fits.scores.argmax())
    return _proposal(pairs[best], fits.of(best))


def whole_runs(runs: Floats, bins: BinChoice) -> Floats:
    """The runs that finished: packings may run away at amplitudes at which others do not. (finished runs, all bins)"""
    whole: Floats = runs[np.isfinite(runs[:, bins]).all(axis=1)]
    return whole


def confirm(proposal: Proposal, data: GapData, null: NullDistribution, places: Sequence[PlaceLeftOut], enough: float, observed: Floats,
            nuisances: Floats, runs: Floats) -> Floats | None:
    """Evaluates the real runs (runs, all bins) of a proposal: its gain in log likelihood over no effect, including the cost of its scatter
    and its free parameters (their determinants, and the prior of the `nuisances` of the runs), and its misfit; if this is below `enough`,
    but not without one of the `places`, that one is left out. The amplitude may still move with a prior of twice its error plus a quarter of
    its size, and the nuisances within their priors; these steps are returned (nuisances, then amplitudes). Returns None if fewer than two
    runs finished. In bins that a candidate lacks and the runs as well, nothing is gained and the gap stays."""
    lacking = data.lacking(proposal.candidates)
    runs = whole_runs(runs, without(data.bins, lacking))
    if len(runs) < MIN_RUNS:
        return None
    left, lost = _left_by(runs, data, lacking, observed, nuisances)
    free = data.free + [
        _still_free(data.candidates[c], amplitude, error)
        for c, amplitude, error in zip(proposal.candidates, proposal.amplitudes, proposal.errors)]
    scatter = _effect_scatter(data, proposal) / data.packings
    space = data.space(free=free, mean_of=len(runs), extra=scatter)
    plain = data.space(mean_of=len(runs))
    cost = sum(0.5 * (shift / parameter.sigma) ** 2 for shift, parameter in zip(nuisances, data.free))  # of the nuisances, from their priors
    proposal.confirmed_gain = float(
        space.lacking(lost).log_likelihood(left) - cost - plain.lacking(lost).log_likelihood(data.gap))
    proposal.confirmed_misfit_p = null.misfit_p(space, left)
    proposal.left_out = None
    if proposal.confirmed_misfit_p < enough:
        proposal.rest_misfit_p = 0
        for one in places:
            p = one.null.misfit_p(data.space(one.data.bins, free, mean_of=len(runs), extra=scatter), left)
            if p >= enough and p > proposal.rest_misfit_p:
                proposal.left_out, proposal.rest_misfit_p = one.place, p
    return space.lacking(lacking).fit_nuisances(left)


def _still_free(candidate: Candidate, amplitude: float, error: float) -> FreeParameter:
    """The amplitude of a confirmed candidate, with a prior as wide as its range if two candidates cannot be distinguished."""
    sigma = 2 * error + STILL_FREE * abs(amplitude) if math.isfinite(error) else candidate.high - candidate.low
    return FreeParameter(candidate.signature.slope(amplitude), sigma)


def _left_by(runs: Floats, data: GapData, lacking: BinChoice, observed: Floats, nuisances: Floats) -> tuple[Floats, BinChoice]:
    """What the runs of a proposal leave of the gap, and the bins without a value in some run, which only its `lacking` ones may be: there the
    gap is as without the effect."""
    left = observed - runs.mean(axis=0)
    lost = lacking[~np.isfinite(left[lacking])]
    left[lost] = data.gap[lost]
    for shift, parameter in zip(nuisances, data.free):
        left[lost] -= shift * parameter.direction[lost]
    return left, lost
