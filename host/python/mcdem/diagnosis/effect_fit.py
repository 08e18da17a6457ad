"""Maximum-likelihood amplitudes of one or several effects for a gap, and their gain over no effect."""
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import reduce

import numpy as np

from ..results.recording import Floats
from .amplitude_search import Misfit
from .gap_space import BinChoice, GapSpace
from .signature import Signature

SHOWN = 1e-300  # Fisher information of an effect of which the data show anything


def no_bins() -> BinChoice:
    return np.zeros(0, np.int64)


@dataclass(frozen=True, eq=False)
class Candidate:
    """A candidate: its signature and the range of plausible amplitudes.

    `lacking`: bins without a value of the signature, which is zero there. The candidate is fitted on the others, so these bins gain
    nothing, and their gap counts as unexplained by it.
    """

    signature: Signature
    low: float
    high: float
    lacking: BinChoice = field(default_factory=no_bins)


Candidates = Sequence[Candidate]  # that are fitted together


def lacking_bins(candidates: Candidates) -> BinChoice:
    """Bins that one of the candidates lacks."""
    return reduce(np.union1d, (candidate.lacking for candidate in candidates if len(candidate.lacking)), no_bins())


def explained_by(candidates: Candidates, amplitudes: Floats | Sequence[float], all_bins: int) -> Floats:
    """(.., all bins) sum of the signatures at their amplitudes (.., candidates)."""
    each = np.moveaxis(np.asarray(amplitudes, float), -1, 0)
    explained: Floats = np.zeros((*each.shape[1:], all_bins))
    for one, amplitude in zip(candidates, each, strict=True):
        explained += one.signature.at(amplitude)
    return explained


@dataclass(frozen=True)
class EffectFit:
    """Joint fit of one or several effects.

    The errors (one sigma, from the slopes of the signatures) include the uncertainty of the other amplitudes. They are all infinite if the
    data do not show one of the effects or cannot distinguish them.
    """

    amplitudes: Sequence[float] = (0.0,)  # one per candidate
    errors: Sequence[float] = (0.0,)
    score: float = 0.0  # gain in log likelihood over no effect, with nuisances marginalised in both

    @property
    def amplitude(self) -> float:
        """Of the first candidate."""
        return self.amplitudes[0]

    @property
    def error(self) -> float:
        return self.errors[0]


@dataclass(frozen=True, eq=False)
class Fits:
    """Fits of many gaps by many combinations of n candidates."""

    amplitudes: Floats  # (combinations, gaps, n)
    scores: Floats  # (combinations, gaps)
    reach: Floats  # (combinations, n)
    terms: Floats  # (combinations, 2n, 2n) products of the whitened terms of the signatures

    def of(self, combination: int) -> EffectFit:
        """Of the first gap."""
        amplitudes, reach = self.amplitudes[combination, 0], self.reach[combination]
        slopes = np.zeros((len(reach), 2 * len(reach)))
        for k, bend in enumerate(2 * np.clip(amplitudes, -reach, reach)):
            slopes[k, 2 * k:2 * k + 2] = 1, bend
        errors = _errors(slopes @ self.terms[combination] @ slopes.T)
        return EffectFit(amplitudes.tolist(), errors, float(self.scores[combination, 0]))


def fits_of_many(space: GapSpace, combinations: Sequence[Candidates], gaps: Floats) -> Fits:
    """`combinations`: each of the same number n of candidates. `gaps`: (gaps, all bins) observed minus model."""
    count, n = len(combinations), len(combinations[0]) if combinations else 0
    fits = Fits(np.zeros((count, len(gaps), n)), np.zeros((count, len(gaps))), np.zeros((count, n)), np.zeros((count, 2 * n, 2 * n)))
    by_lacking: dict[bytes, list[int]] = {}
    lacking = [lacking_bins(candidates) for candidates in combinations]
    for k, bins in enumerate(lacking):
        by_lacking.setdefault(bins.tobytes(), []).append(k)
    for chosen in by_lacking.values():
        misfit = _misfit(space.lacking(lacking[chosen[0]]), [combinations[k] for k in chosen], gaps)
        best, value = misfit.best()
        fits.amplitudes[chosen] = best.reshape(len(chosen), len(gaps), n)
        fits.scores[chosen] = 0.5 * (misfit.square - value).reshape(len(chosen), len(gaps))
        fits.reach[chosen], fits.terms[chosen] = misfit.reach[::len(gaps)], misfit.terms[::len(gaps)]
    return fits


def _misfit(space: GapSpace, combinations: Sequence[Candidates], gaps: Floats) -> Misfit:
    """Lanes: combinations, then gaps."""
    count, n = len(combinations), len(combinations[0])
    of_all = [term for candidates in combinations for one in candidates for term in (one.signature.linear, one.signature.curvature)]
    terms = space.whiten(np.reshape(of_all, (count * 2 * n, gaps.shape[1]))).reshape(count, 2 * n, len(space.bins))
    gap = space.whiten(gaps)
    limits = np.array([[(one.signature.reach, one.low, one.high) for one in candidates] for candidates in combinations], float)
    reach, low, high = np.repeat(limits.reshape(count, n, 3), len(gaps), axis=0).transpose(2, 0, 1)
    return Misfit(np.tile((gap**2).sum(axis=1), count), (gap @ terms.swapaxes(1, 2)).reshape(count * len(gaps), 2 * n),
                  np.repeat(terms @ terms.swapaxes(1, 2), len(gaps), axis=0), reach, low, high)


def _errors(information: Floats) -> list[float]:
    """One sigma of each amplitude, from their Fisher information (n, n)."""
    n = len(information)
    if not (information.diagonal() > SHOWN).all() or n > 1 and np.linalg.matrix_rank(information, hermitian=True) < n:
        return [math.inf] * n
    errors: list[float] = np.sqrt(np.linalg.inv(information).diagonal()).tolist()
    return errors


def fit_effects(space: GapSpace, candidates: Candidates, gap: Floats) -> EffectFit:
    """`gap`: observed minus model, all bins."""
    return fits_of_many(space, [candidates], gap[None]).of(0)


def fit_effect(space: GapSpace, candidate: Candidate, gap: Floats) -> EffectFit:
    """`gap`: observed minus model, all bins."""
    return fit_effects(space, [candidate], gap)


def draw_error(space: GapSpace, candidate: Candidate, amplitude: float) -> float:
    """One sigma of an amplitude from differences of the effect between packings and from its random draws, without the scatter from chaos.

    From the slopes of the pairs, with the weights of the fit.
    """
    space = space.lacking(candidate.lacking)
    signature = candidate.signature
    slope = space.whiten(signature.slope(amplitude))
    information = float(slope @ slope)
    pairs = signature.pairs()
    if pairs < 2 or not information > 1e-300:
        return 0.0
    of_pair = space.whiten(signature.slopes) @ slope / information  # amplitude of each pair relative to the mean
    chaos = 2 / (information * signature.reach**2)
    return abs(amplitude) * math.sqrt(max(0.0, float(of_pair.var(ddof=1)) - chaos) * (1 + 1 / pairs))
