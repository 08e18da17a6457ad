"""Reduction of the gap by an effect. The effect's amplitude and the nuisances are fitted on loading up to 85 % of the stroke. The gap is
measured on the remaining data, once with only the nuisances refitted and once with the effect as well.

Differences are (all bins,), or (n, all bins) for n of them.
"""
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import sqrt

import numpy as np

from .._engine import Random
from ..results.names import Phase
from ..results.recording import Floats
from .diagnosis_types import GapReduction
from .effect_fit import Candidate, fit_effects, fits_of_many
from .evidence import GapData
from .gap_space import BinChoice, FreeParameter, GapSpace, resolutions, without
from ..observe.grid import Grid, bins_of
from .proposals import whole_runs
from .signature import Signature

FITTED_PART = 0.85  # of the stroke, loading only
BOOTSTRAP_DRAWS = 200
PLACEBO_SIGNATURES = 20
PLACEBO_RANGE = 50  # of their amplitudes, either way


@dataclass(frozen=True)
class HeldOutGap:
    """Gap on the held-out bins after the nuisances are fitted on the others, and its scatter without a gap."""

    size: float = 0
    noise: float = 0

    def shows(self) -> bool:
        return self.size > 2 * self.noise


@dataclass(frozen=True, eq=False)
class PartialFit:
    """Amplitudes fitted on the first part of the split, with the shifts of the nuisances (free,): the settings of a confirming run."""

    amplitudes: list[float] = field(default_factory=list)
    nuisances: Floats = field(default_factory=lambda: np.zeros(0))


def gap_sizes(data: GapData, bins: BinChoice, gaps: Floats, mean_of: int, extra: int = 0) -> Floats:
    """(n,) gaps without noise over bins, in squared sigmas: r'Dr - tr(D Sigma).

    `mean_of`: number of runs in the mean that was compared. `extra`: number of replicates whose scatter was added.
    """
    both = 1 + extra + (1 / mean_of if mean_of > 0 else 0)
    scatter = (data.noise[:, bins]**2).mean(axis=0)
    variance = scatter + resolutions(bins, gaps.shape[-1])**2
    sizes: Floats = ((gaps[..., bins]**2 - both * scatter) / variance).sum(axis=-1)
    return sizes


def _part_gone(before: Floats | float, after: Floats | float) -> Floats:
    return np.where(np.greater(before, 0), np.clip(1 - after / np.where(np.greater(before, 0), before, 1), -1, 1), 0)


class HeldOutTest:
    """Fits on the bins `fitted` and measures on the bins `held_out`. If one part is missing, all gaps and reductions are zero."""

    def __init__(self, data: GapData, fitted: BinChoice, held_out: BinChoice) -> None:
        self.data, self.fitted, self.held_out = data, fitted, held_out

    @classmethod
    def split(cls, data: GapData, grid: Grid) -> "HeldOutTest":
        first = np.array([bin.phase == Phase.load and bin.displacement < FITTED_PART * grid.stroke for bin in bins_of(grid)])
        return cls(data, *(data.bins[part] for part in (first[data.bins], ~first[data.bins])))

    @cached_property
    def _space(self) -> GapSpace:
        return self.data.space(self.fitted)

    def is_whole(self) -> bool:
        return len(self.fitted) > 0 and len(self.held_out) > 0

    def gap(self) -> HeldOutGap:
        if not self.is_whole():
            return HeldOutGap()
        data = self.data
        both = sqrt(1 + (1 / data.mean_of if data.mean_of > 0 else 0))
        size, *noise = self._sizes(self._refitted(np.vstack([data.gap, both * data.noise]))).tolist()
        return HeldOutGap(size, float(np.sqrt(np.mean(np.square(noise)))))

    def reduction(self, candidates: Sequence[int]) -> float:
        """Fraction of the held-out gap taken away by the given candidates (one or two), fitted on the other bins. Nothing of it is taken
        away in bins that a candidate lacks."""
        return float(self._sizes_with(self.data.gap[None], candidates)[2][0]) if self.is_whole() else 0

    def reduction_by_runs(self, observed: Floats, runs: Floats, lacking: BinChoice | None = None) -> float | None:
        """The same for runs with the amplitudes fitted there; row: replicate. None if they failed. The gap stays as it was in those
        `lacking` bins of the candidates in which some run has no value."""
        lacking = self.held_out[:0] if lacking is None else lacking
        runs = whole_runs(runs, without(self.held_out, lacking))
        before = self.gap().size
        if not len(runs) or not before > 0:
            return None
        left = observed - runs.mean(axis=0)
        unknown = lacking[~np.isfinite(left[lacking])]
        left[unknown] = self._refitted(self.data.gap)[unknown]
        return float(_part_gone(before, gap_sizes(self.data, self.held_out, left, len(runs))))

    def placebo(self, seed: int) -> float:
        """The same for the best of twenty random signatures."""
        if not self.is_whole():
            return 0
        data, placebos = self.data, _placebos(self.data, seed)
        fits = fits_of_many(self._space, [[one] for one in placebos], data.gap[None])
        left = data.gap - np.concatenate([one.signature.at(best[:, 0]) for one, best in zip(placebos, fits.amplitudes)])
        before, after = (self._sizes(self._refitted(gaps)) for gaps in (data.gap[None], left))
        return max(0.0, float(_part_gone(before, after).max()))

    def measured(self, candidates: Sequence[int], seed: int) -> GapReduction:
        """Of the given candidates (one or two). The interval is from a bootstrap: the scatter of the replicates is added once more, and its
        size subtracted."""
        data, before, after, fraction, interval = self.data, 0.0, 0.0, 0.0, (0.0, 0.0)
        if self.is_whole():
            before, after, fraction = (float(values[0]) for values in self._sizes_with(data.gap[None], candidates))
            random = Random(seed, "bootstrap")
            drawn = np.array([random.uniform() for _ in range(2 * BOOTSTRAP_DRAWS)]).reshape(-1, 2)
            rows = (drawn[:, 0] * len(data.noise)).astype(int)
            signs = np.where(drawn[:, 1] < 0.5, -1, 1)
            fractions = np.sort(self._sizes_with(data.gap + signs[:, None] * data.noise[rows], candidates, 1)[2])
            interval = float(fractions[BOOTSTRAP_DRAWS // 20]), float(fractions[-1 - BOOTSTRAP_DRAWS // 20])
        return GapReduction(held_out="unloading, and loading beyond 85 % of the stroke", before=before, after=after, fraction=fraction,
                            interval=interval, placebo=0, metrics={}, confirmed=None, fitted_displacement_mm=(0, 0), top_force=())

    def _sizes(self, gaps: Floats, extra: int = 0) -> Floats:
        return gap_sizes(self.data, self.held_out, gaps, self.data.mean_of, extra)

    def _refitted(self, gaps: Floats, space: GapSpace | None = None) -> Floats:
        """What is left after refitting the nuisances."""
        directions = np.array([one.direction for one in self.data.free]).reshape(len(self.data.free), gaps.shape[-1])
        left: Floats = gaps - (space or self._space).fit_nuisances(gaps) @ directions
        return left

    def _sizes_with(self, gaps: Floats, candidates: Sequence[int], extra: int = 0) -> tuple[Floats, Floats, Floats]:
        """Sizes of gaps without and with the candidates, and the fractions that these take away. (n,) each"""
        lacking = self.data.lacking(candidates)
        fits = fits_of_many(self._space, [self.data.chosen(candidates)], gaps)
        left = gaps - self.data.explained(candidates, fits.amplitudes[0])
        before, rest = self._refitted(gaps), self._refitted(left, self._space.lacking(lacking))
        rest[:, lacking] = before[:, lacking]
        size, after = self._sizes(before, extra), self._sizes(rest, extra)
        return size, after, _part_gone(size, after)


def _placebos(data: GapData, seed: int) -> list[Candidate]:
    """Random signatures of typical size: mixtures of the replicates' scatter."""
    drawn = Random(seed, "placebo").normals(PLACEBO_SIGNATURES * len(data.noise))
    nothing = np.zeros(len(data.mean))
    return [Candidate(Signature("", 1, linear, nothing), -PLACEBO_RANGE, PLACEBO_RANGE)
            for linear in drawn.reshape(PLACEBO_SIGNATURES, -1) @ data.noise]


def whole_placebo(space: GapSpace, data: GapData, excess: float, seed: int) -> float:
    """Reduction of the whole gap by the best of twenty random signatures, by likelihood: gain over `excess`, the gain if the whole gap were
    explained."""
    fits = fits_of_many(space, [[one] for one in _placebos(data, seed)], data.gap[None])
    return max(0.0, min(1.0, float(fits.scores.max()) / excess))


def stepped(data: GapData, candidates: Sequence[int], fit: PartialFit, step: Floats) -> PartialFit:
    """After a step of nuisances and amplitudes, as far as simulations can follow it."""
    count = len(fit.nuisances)
    amplitudes = [min(max(amplitude + change, one.low), one.high)
                  for amplitude, change, one in zip(fit.amplitudes, step[count:].tolist(), data.chosen(candidates))]
    return PartialFit(amplitudes, data.in_range(fit.nuisances + step[:count]))


def fit_part(data: GapData, bins: BinChoice, gap: Floats, candidates: Sequence[int]) -> PartialFit:
    """Amplitudes and nuisances fitted on these bins."""
    space = data.space(bins)
    amplitudes = list(fit_effects(space, data.chosen(candidates), gap).amplitudes)
    nuisances = space.lacking(data.lacking(candidates)).fit_nuisances(gap - data.explained(candidates, amplitudes))
    return PartialFit(amplitudes, data.in_range(nuisances))


def refit_part(data: GapData, bins: BinChoice, left: Floats, candidates: Sequence[int], at: PartialFit, mean_of: int) -> PartialFit:
    """The same from runs with `at` that left `left` (observed minus their mean, of `mean_of` runs): one Gauss-Newton step on these bins
    only. Nuisances start from zero again, so that they contain no information from other bins."""
    slopes = [FreeParameter(one.signature.slope(amplitude), one.high - one.low)
              for one, amplitude in zip(data.chosen(candidates), at.amplitudes)]
    space = GapSpace(data.noise, mean_of, without(bins, data.lacking(candidates)), [*data.free, *slopes])
    without_nuisances = left + sum(shift * one.direction for shift, one in zip(at.nuisances, data.free))
    return stepped(data, candidates, PartialFit(at.amplitudes, np.zeros(len(at.nuisances))), space.fit_nuisances(without_nuisances))
