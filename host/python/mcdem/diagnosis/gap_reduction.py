"""Reduction of the gap by an effect. The effect's amplitude and the nuisances are fitted on loading up to 85 % of the stroke. The gap is
measured on the remaining data, once with only the nuisances refitted and once with the effect as well.

Differences are (all cells,), or (n, all cells) for n of them.
"""
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import sqrt

import numpy as np

from .._engine import Random
from ..results.names import Phase
from ..results.recording import Floats
from .amplitude_search import Misfit
from .decision import Proposal
from .diagnosis_types import GapReduction
from .effect_fit import MAX_ROUNDS, UNMOVED, Candidate, lacking_cells
from .evidence import GapData
from .gap_space import CellChoice, FreeParameter, GapSpace, resolutions, without
from ..observe.grid import Grid, cells_of
from .proposals import whole_runs

FITTED_PART = 0.85  # of the stroke, loading only
BOOTSTRAP_DRAWS = 200
PLACEBO_SIGNATURES = 20
PLACEBO_RANGE = 50  # of their amplitudes, either way


@dataclass(frozen=True, eq=False)
class Split:
    """Cells for the fit, and held-out cells."""

    fitted: CellChoice
    held_out: CellChoice

    def is_whole(self) -> bool:
        return len(self.fitted) > 0 and len(self.held_out) > 0


@dataclass(frozen=True)
class HeldOutGap:
    """Gap on the held-out cells after the nuisances are fitted on the others, and its scatter without a gap."""

    size: float = 0
    noise: float = 0

    def shows(self) -> bool:
        return self.size > 2 * self.noise


@dataclass(frozen=True, eq=False)
class PartialFit:
    """Amplitudes fitted on the first part of the split, with the shifts of the nuisances (free,): the settings of a confirming run."""

    amplitudes: list[float] = field(default_factory=list)
    nuisances: Floats = field(default_factory=lambda: np.zeros(0))


def split_cells(cells: CellChoice, grid: Grid) -> Split:
    fitted = np.array([cell.phase == Phase.load and cell.displacement < FITTED_PART * grid.stroke for cell in cells_of(grid)])[cells]
    return Split(cells[fitted], cells[~fitted])


def _sizes(data: GapData, cells: CellChoice, gaps: Floats, mean_of: int, extra: int = 0) -> Floats:
    """gap_size of several gaps. (n,)"""
    both = 1 + extra + (1 / mean_of if mean_of > 0 else 0)
    scatter = (data.noise[:, cells]**2).mean(axis=0)
    variance = scatter + resolutions(cells, gaps.shape[-1])**2
    sizes: Floats = ((gaps[..., cells]**2 - both * scatter) / variance).sum(axis=-1)
    return sizes


def gap_size(data: GapData, cells: CellChoice, gap: Floats, mean_of: int, extra: int = 0) -> float:
    """Gap without noise over cells, in squared sigmas: r'Dr - tr(D Sigma). `extra`: number of replicates whose scatter was added to it."""
    return float(_sizes(data, cells, gap, mean_of, extra))


class _Signatures:
    """Those of some candidates, as functions of their amplitudes (n, candidates)."""

    def __init__(self, candidates: Sequence[Candidate], all_cells: int) -> None:
        self._terms = np.array([term for one in candidates for term in (one.signature.linear, one.signature.curvature)])
        self._terms = self._terms.reshape(-1, all_cells)
        self._reach = np.array([one.signature.reach for one in candidates])
        self._low = np.array([one.low for one in candidates])
        self._high = np.array([one.high for one in candidates])

    def _factors(self, amplitudes: Floats) -> Floats:
        """Of the linear and the quadratic term of each in their sum (Signature.at). (n, 2 candidates)"""
        inside = np.clip(amplitudes, -self._reach, self._reach)
        factors: Floats = np.stack([amplitudes, inside * (2 * amplitudes - inside)], axis=-1)
        return factors.reshape(len(amplitudes), -1)

    def total(self, amplitudes: Floats) -> Floats:
        """(n, all cells)"""
        total: Floats = self._factors(amplitudes) @ self._terms
        return total

    def fitted(self, space: GapSpace, gaps: Floats) -> Floats:
        """The amplitudes of fit_effects for several gaps, optimised in turn. (n, candidates)"""
        white, terms = space.whiten(gaps), space.whiten(self._terms)
        forces, products, squares = white @ terms.T, terms @ terms.T, (white**2).sum(axis=1)
        amplitudes = np.zeros((len(gaps), len(self._reach)))
        moving = np.arange(len(gaps))
        for _ in range(MAX_ROUNDS if amplitudes.shape[1] > 1 else 1):
            before = amplitudes[moving]
            for k in range(amplitudes.shape[1]):
                factors = self._factors(amplitudes[moving])
                factors[:, 2 * k:2 * k + 2] = 0
                of_others = factors @ products
                left = squares[moving] + (factors * (of_others - 2 * forces[moving])).sum(axis=1)
                amplitudes[moving, k] = self._misfit(k, left, forces[moving] - of_others, products).best()
            moving = moving[(np.abs(amplitudes[moving] - before) > UNMOVED * (self._high - self._low)).any(axis=1)]
            if not len(moving):
                break
        return amplitudes

    def _misfit(self, k: int, square: Floats, forces: Floats, products: Floats) -> Misfit:
        """Of candidate k, from products of gap and terms and of the terms."""
        (ll, lc), (_, cc) = products[2 * k:2 * k + 2, 2 * k:2 * k + 2]
        same = np.ones(len(square))
        return Misfit(square, forces[:, 2 * k], forces[:, 2 * k + 1], ll * same, lc * same, cc * same, self._reach[k] * same,
                      self._low[k] * same, self._high[k] * same)


class _Arms:
    """Both comparisons, sharing the whitening of the fitted cells."""

    def __init__(self, data: GapData, split: Split, mean_of: int) -> None:
        self._data, self._split, self._mean_of = data, split, mean_of
        self.space = GapSpace(data.noise, mean_of, split.fitted, data.free)
        self._directions = np.array([one.direction for one in data.free]).reshape(len(data.free), len(data.mean))

    def refitted(self, gaps: Floats, space: GapSpace | None = None) -> Floats:
        """What is left after refitting the nuisances."""
        left: Floats = gaps - (space or self.space).fit_nuisances(gaps) @ self._directions
        return left

    def fit(self, gap: Floats, candidates: Sequence[Candidate]) -> PartialFit:
        space = self.space.lacking(lacking_cells(candidates))
        signatures = _Signatures(candidates, len(gap))
        amplitudes = signatures.fitted(space, gap[None])
        return PartialFit(amplitudes[0].tolist(), space.fit_nuisances(gap - signatures.total(amplitudes)[0]))

    def parts_gone(self, gaps: Floats, candidates: Sequence[Candidate], extra: int = 0) -> tuple[Floats, Floats, Floats]:
        """Sizes of gaps on the held-out cells without and with the candidates, and the fractions that these take away. (n,) each"""
        lacking = lacking_cells(candidates)
        space = self.space.lacking(lacking)
        signatures = _Signatures(candidates, gaps.shape[1])
        return self.parts_without(gaps, gaps - signatures.total(signatures.fitted(space, gaps)), lacking, extra)

    def parts_without(self, gaps: Floats, left: Floats, lacking: CellChoice, extra: int = 0) -> tuple[Floats, Floats, Floats]:
        """The same for what candidates with these amplitudes leave."""
        before, after = self.refitted(gaps), self.refitted(left, self.space.lacking(lacking))
        after[:, lacking] = before[:, lacking]
        size, rest = (_sizes(self._data, self._split.held_out, gap, self._mean_of, extra) for gap in (before, after))
        return size, rest, _part_gone(size, rest)


def _part_gone(before: Floats, after: Floats) -> Floats:
    return np.where(before > 0, np.clip(1 - after / np.where(before > 0, before, 1), -1, 1), 0)


def _chosen(data: GapData, candidates: Sequence[int]) -> list[Candidate]:
    return [data.candidates[c] for c in candidates]


def _random_signatures(data: GapData, seed: int) -> Floats:
    """Of typical size: random mixtures of the replicates' scatter. (n, all cells)"""
    drawn = Random(seed, "placebo").normals(PLACEBO_SIGNATURES * len(data.noise))
    return drawn.reshape(PLACEBO_SIGNATURES, -1) @ data.noise


def _misfit_of_random(space: GapSpace, signatures: Floats, gap: Floats) -> Misfit:
    white, terms = space.whiten(gap), space.whiten(signatures)
    none, same = np.zeros(len(terms)), np.ones(len(terms))
    return Misfit(white @ white * same, terms @ white, none, (terms**2).sum(axis=1), none, none, same, -PLACEBO_RANGE * same,
                  PLACEBO_RANGE * same)


def stepped(data: GapData, candidates: Sequence[int], fit: PartialFit, step: Floats) -> PartialFit:
    """After a step of nuisances and amplitudes, as far as simulations can follow it."""
    count = len(fit.nuisances)
    amplitudes = [min(max(amplitude + change, one.low), one.high)
                  for amplitude, change, one in zip(fit.amplitudes, step[count:].tolist(), _chosen(data, candidates))]
    return PartialFit(amplitudes, data.in_range(fit.nuisances + step[:count]))


def fit_part(data: GapData, cells: CellChoice, gap: Floats, candidates: Sequence[int], mean_of: int) -> PartialFit:
    fit = _Arms(data, Split(cells, cells[:0]), mean_of).fit(gap, _chosen(data, candidates))
    return PartialFit(fit.amplitudes, data.in_range(fit.nuisances))


def refit_part(data: GapData, cells: CellChoice, left: Floats, candidates: Sequence[int], at: PartialFit, mean_of: int) -> PartialFit:
    """The same from runs with `at` that left `left` (observed minus their mean, of `mean_of` runs): one Gauss-Newton step on these cells
    only. Nuisances start from zero again, so that they contain no information from other cells."""
    slopes = [FreeParameter(one.signature.slope(amplitude), one.high - one.low)
              for one, amplitude in zip(_chosen(data, candidates), at.amplitudes)]
    space = GapSpace(data.noise, mean_of, without(cells, data.lacking(candidates)), [*data.free, *slopes])
    without_nuisances = left + sum(shift * one.direction for shift, one in zip(at.nuisances, data.free))
    return stepped(data, candidates, PartialFit(at.amplitudes, np.zeros(len(at.nuisances))), space.fit_nuisances(without_nuisances))


def held_out_gap(data: GapData, split: Split, mean_of: int) -> HeldOutGap:
    if not split.is_whole():
        return HeldOutGap()
    both = sqrt(1 + (1 / mean_of if mean_of > 0 else 0))
    gaps = np.vstack([data.gap, both * data.noise])
    size, *noise = _sizes(data, split.held_out, _Arms(data, split, mean_of).refitted(gaps), mean_of).tolist()
    return HeldOutGap(size, float(np.sqrt(np.mean(np.square(noise)))))


def held_out_reduction(data: GapData, split: Split, candidates: Sequence[int], mean_of: int) -> float:
    """Fraction of the held-out gap taken away by the given candidates (one or two), fitted on the other cells. Nothing of it is taken
    away in cells that a candidate lacks."""
    if not split.is_whole():
        return 0
    _, _, fraction = _Arms(data, split, mean_of).parts_gone(data.gap[None], _chosen(data, candidates))
    return float(fraction[0])


def reduction_by_runs(data: GapData, split: Split, observed: Floats, runs: Floats, mean_of: int,
                      lacking: CellChoice | None = None) -> float | None:
    """The same for runs with the amplitudes fitted there; row: replicate. None if they failed. The gap stays as it was in those `lacking`
    cells of the candidates in which some run has no value."""
    lacking = split.held_out[:0] if lacking is None else lacking
    runs = whole_runs(runs, without(split.held_out, lacking))
    before = held_out_gap(data, split, mean_of).size
    if not len(runs) or not before > 0:
        return None
    left = observed - runs.mean(axis=0)
    unknown = lacking[~np.isfinite(left[lacking])]
    left[unknown] = _Arms(data, split, mean_of).refitted(data.gap)[unknown]
    after = gap_size(data, split.held_out, left, len(runs))
    return min(max(1 - after / before, -1.0), 1.0)


def held_out_placebo(data: GapData, split: Split, mean_of: int, seed: int) -> float:
    """The same for the best of twenty random signatures."""
    if not split.is_whole():
        return 0
    arms, signatures = _Arms(data, split, mean_of), _random_signatures(data, seed)
    left = data.gap - _misfit_of_random(arms.space, signatures, data.gap).best()[:, None] * signatures
    return max(0.0, float(arms.parts_without(data.gap[None], left, split.held_out[:0])[2].max()))


def whole_placebo(space: GapSpace, data: GapData, excess: float, seed: int) -> float:
    """The same for the whole gap by likelihood: gain over `excess`, the gain if the whole gap were explained."""
    misfit = _misfit_of_random(space, _random_signatures(data, seed), data.gap)
    score = 0.5 * (misfit.gg - misfit.at(misfit.best())).max()
    return max(0.0, min(1.0, float(score) / excess))


def measure_reduction(data: GapData, split: Split, proposal: Proposal, mean_of: int, seed: int) -> GapReduction:
    """Fits the given candidates (one or two) on `split.fitted` and measures on `split.held_out`. The interval is from a bootstrap: the
    scatter of the replicates is added once more, and its size subtracted."""
    before = after = fraction = 0.0
    interval = 0.0, 0.0
    if split.is_whole():
        candidates, arms = _chosen(data, proposal.candidates), _Arms(data, split, mean_of)
        before, after, fraction = (float(values[0]) for values in arms.parts_gone(data.gap[None], candidates))
        random = Random(seed, "bootstrap")
        drawn = np.array([random.uniform() for _ in range(2 * BOOTSTRAP_DRAWS)]).reshape(-1, 2)
        rows = (drawn[:, 0] * len(data.noise)).astype(int)
        signs = np.where(drawn[:, 1] < 0.5, -1, 1)
        fractions = np.sort(arms.parts_gone(data.gap + signs[:, None] * data.noise[rows], candidates, 1)[2])
        interval = float(fractions[BOOTSTRAP_DRAWS // 20]), float(fractions[-1 - BOOTSTRAP_DRAWS // 20])
    return GapReduction(held_out="unloading, and loading beyond 85 % of the stroke", before=before, after=after, fraction=fraction,
                        interval=interval, placebo=0, metrics={}, confirmed=None, fitted_displacement_mm=(0, 0), top_force=())
