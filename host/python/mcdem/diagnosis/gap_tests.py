"""Tests for a gap: an omnibus test (any difference) and a directed test (a difference similar to a known effect), both ranked against
replicates that go through the same comparison."""
import math
from dataclasses import dataclass, field

import numpy as np
from scipy.stats import t as students_t

from .._engine import Random
from ..results.recording import Bools, Floats, Ints
from .effect_fit import EffectFit, Fits, fits_of_many
from .evidence import OWN_PACKING, GapData
from .gap_space import GapSpace
from .library import apart_from_mean
from ..observe.grid import bins_each

DRAWS_A_REPLICATE = 3
FEWEST_BINS = 3  # of an observable whose mean and trend are tested
STATISTICS = "omnibus", "directed", "remainder", "highest_refitted", "pattern_left"  # fields of GapStatistics

Statistics = dict[str, Floats]  # by name, of several gaps


@dataclass(frozen=True, eq=False)
class GapStatistics:
    """Statistics of one gap."""

    omnibus: float  # chi-square with nuisances marginalised
    directed: float  # largest gain in log likelihood of any candidate
    remainder: float  # chi-square after the best candidate
    highest_refitted: float  # largest |gap|/sigma of a bin after refitting the nuisances
    pattern_left: float  # highest_pattern of the gap that the best candidate leaves
    fits: list[EffectFit] = field(default_factory=list)  # by candidate
    best: int = 0


def gap_statistics(space: GapSpace, data: GapData, gap: Floats) -> GapStatistics:
    """`gap`: (all bins,)"""
    fits = fits_of_singles(space, data, gap[None])
    values, best = _statistics(space, data, gap[None], fits)
    return GapStatistics(**{name: float(one[0]) for name, one in values.items()}, fits=[fits.of(c) for c in range(len(data.candidates))],
                         best=int(best[0]))


def statistics_of(space: GapSpace, data: GapData, gaps: Floats) -> Statistics:
    """GapStatistics of many gaps (gaps, all bins)."""
    return _statistics(space, data, gaps, fits_of_singles(space, data, gaps))[0]


def fits_of_singles(space: GapSpace, data: GapData, gaps: Floats) -> Fits:
    """Of each candidate alone to gaps (gaps, all bins)."""
    return fits_of_many(space, [[candidate] for candidate in data.candidates], gaps)


def _statistics(space: GapSpace, data: GapData, gaps: Floats, fits: Fits) -> tuple[Statistics, Ints]:
    """Also the best candidates."""
    omnibus, refitted = (space.whiten(gaps) ** 2).sum(axis=1), _highest_bin(space, space.refitted(gaps))
    best, directed, left = np.zeros(len(gaps), np.int64), np.zeros(len(gaps)), gaps.copy()
    if data.candidates:
        best, directed = fits.scores.argmax(axis=0), fits.scores.max(axis=0)
        for c in np.unique(best):
            lanes = (best == c) & (directed > 0)
            left[lanes] -= data.candidates[c].signature.at(fits.amplitudes[c, lanes, 0])
    return dict(zip(STATISTICS, (omnibus, directed, omnibus - 2 * directed, refitted, highest_patterns(space, left)))), best


def highest_pattern(space: GapSpace, gap: Floats) -> float:
    """Significance of the strongest simple pattern in a gap (all bins,) after refitting the nuisances: a bin, the mean over the bins of
    an observable, or their trend in the order in which the plate passes them."""
    return float(highest_patterns(space, gap[None])[0])


def highest_patterns(space: GapSpace, gaps: Floats) -> Floats:
    """highest_pattern of many gaps (gaps, all bins)."""
    left = space.refitted(gaps)
    highest = _highest_bin(space, left)
    weights = _observable_patterns(space, gaps.shape[1])
    if not len(weights):
        return highest
    sigma = np.array([space.sigma_of(of_pattern) for of_pattern in weights])
    return np.maximum(highest, np.abs(left @ weights.T / sigma).max(axis=1))


def _highest_bin(space: GapSpace, left: Floats) -> Floats:
    highest: Floats = np.abs(left / space.sigma).max(axis=1)
    return highest


def _observable_patterns(space: GapSpace, all_bins: int) -> Floats:
    """Mean and trend of every observable with three or more bins, as weights of the selected bins, which are ordered by observable, phase
    (loading first) and displacement (bins_of). Bins have the weight 1/sigma^2. (patterns, bins)"""
    each = bins_each(all_bins)
    observable, place = np.divmod(space.bins, each)
    # Order in which the plate passes a bin: loading, then unloading.
    passage = np.where(2 * place < each, place, each - 1 - (place - each // 2))
    tested, bins = np.unique(observable, return_counts=True)
    mean = (observable == tested[bins >= FEWEST_BINS, None]) / space.sigma**2
    trend = mean * passage
    return np.concatenate([mean, trend - (trend.sum(axis=1) / mean.sum(axis=1))[:, None] * mean])


class NullDistribution:
    """Distribution of the statistics without a gap: each replicate is compared without its own contribution to the noise, with nuisances
    drawn from their priors."""

    def __init__(self, data: GapData, seed: int) -> None:
        random = Random(seed, "null_draws")
        both = math.sqrt(1 + (1 / data.mean_of if data.mean_of > 0 else 0))
        sigma = np.array([parameter.sigma for parameter in data.free])
        directions = np.array([parameter.direction for parameter in data.free])
        of_observed, of_draws, packings = [], [], []
        for fold in np.unique(data.fold):
            out = data.fold == fold
            gaps = both * np.repeat(_rows_left_out(data, out), DRAWS_A_REPLICATE, axis=0)
            if len(sigma):
                gaps += random.normals(len(gaps) * len(sigma)).reshape(len(gaps), -1) * sigma @ directions
            space = data.space(noise=_noise_without(data, out))
            values = statistics_of(space, data, np.concatenate([data.gap[None], gaps]))
            of_observed.append({name: one[0] for name, one in values.items()})
            of_draws.append({name: one[1:] for name, one in values.items()})
            packings.append(np.repeat(data.group[out], DRAWS_A_REPLICATE))
        whole = statistics_of(data.space(), data, data.gap[None])
        packing = np.concatenate(packings) if OWN_PACKING in data.group else np.zeros(sum(map(len, packings)), np.int64)
        self._draws: dict[int, Statistics] = {int(p): {} for p in np.unique(packing)}
        for name in STATISTICS:
            # Statistics are larger if fewer replicates determine the covariance: to the scale of the observed gap.
            mean = float(np.mean([values[name] for values in of_observed]))
            scale = float(whole[name][0]) / mean if mean > 0 and whole[name][0] > 0 else 1
            draws = scale * np.concatenate([values[name] for values in of_draws])
            for p, of_packing in self._draws.items():
                of_packing[name] = draws[packing == p]

    def draws(self) -> dict[int, Statistics]:
        """By packing, the experiment's own first. Without replicates of its own: all of them under 0."""
        return self._draws

    def p_value(self, statistic: str, value: float) -> float:
        """Probability of a statistic at least as large without a gap, from Student's t of its cube root with the mean and the variance of
        the replicates."""
        root = self._predicted(statistic)
        return root.complement_at(value, root.own_degrees)

    def misfit_p(self, space: GapSpace, left: Floats) -> float:
        """Probability that the remainder of an explanation (all bins,) is noise: Bonferroni correction for two tests, its chi-square over
        all bins (insensitive to gaps in few bins) and its highest pattern (insensitive to gaps spread over many bins). Student's t has
        the degrees of freedom of all replicates, with which the limits of the verdict were set."""
        values = {"remainder": float((space.whiten(left) ** 2).sum()), "pattern_left": highest_pattern(space, left)}
        roots = {name: self._predicted(name) for name in values}
        return min(1.0, 2 * min(root.complement_at(values[name], root.pooled_degrees) for name, root in roots.items()))

    def quantile(self, statistic: str, p: float) -> float:
        """The value that a fraction `p` of the null distribution exceeds."""
        return self._predicted(statistic).quantile(p)

    def mean(self, statistic: str) -> float:
        return float(next(iter(self._draws.values()))[statistic].mean())

    def _predicted(self, statistic: str) -> "_Predicted":
        roots = [np.cbrt(of_packing[statistic]) for of_packing in self._draws.values()]
        replicates = [len(of_packing) / DRAWS_A_REPLICATE for of_packing in roots]
        mean, degrees = float(roots[0].mean()), sum(replicates) - len(replicates)
        squares = sum(float(of_packing.var()) * n for of_packing, n in zip(roots, replicates))
        variance = max(squares / degrees, 1e-12 * mean * mean)
        return _Predicted(mean, math.sqrt(variance * (1 + 1 / replicates[0])), replicates[0] - 1, degrees)


@dataclass(frozen=True)
class _Predicted:
    """The cube root of a statistic is nearly normal (Wilson & Hilferty 1931). Its mean and variance are estimated from few replicates, so a
    further replicate follows Student's t. Packings differ in both. The mean is that of the first packing, the experiment's own if it is
    known. The variance is pooled over the packings; for the experiment's own it is known no better than from that packing's replicates."""

    mean: float
    sigma: float
    own_degrees: float  # of freedom
    pooled_degrees: float

    def complement_at(self, value: float, degrees: float) -> float:
        return float(students_t.sf((np.cbrt(value) - self.mean) / self.sigma, degrees)) if value > 0 else 1.0

    def quantile(self, p: float) -> float:
        return max(0.0, self.mean + self.sigma * float(students_t.isf(p, self.own_degrees))) ** 3


def _unscaling(data: GapData) -> Floats:
    """Factor of each row of the noise that was scaled to the variance of one replicate. (rows, 1)"""
    _, group = np.unique(data.group, return_inverse=True)
    n = np.bincount(group)[group][:, None]
    factor: Floats = np.sqrt(np.maximum(1, n - 1) / n)
    return factor


def _noise_without(data: GapData, out: Bools) -> Floats:
    """The replicates that are not left out. Those left out do not contribute to the mean either: otherwise a small set would lie in the
    subspace of the others' scatter, in contrast to an experiment."""
    groups, members = np.unique(data.group[~out], return_counts=True)
    kept = ~out & np.isin(data.group, groups[members > 1])  # a single row is its own mean
    return apart_from_mean((_unscaling(data) * data.noise)[kept], data.group[kept].tolist())


def _rows_left_out(data: GapData, out: Bools) -> Floats:
    """Each row that is left out as if it were observed: minus the mean of the remaining replicates, scaled to the variance of one."""
    alike = (data.group[out][:, None] == data.group) & ~out
    kept = alike.sum(axis=1)[:, None]
    n = np.maximum(kept, 1)
    apart = _unscaling(data)[out] / np.sqrt(1 + 1 / n) * (data.noise[out] - alike @ data.noise / n)
    return np.where(kept > 0, apart, data.noise[out])
