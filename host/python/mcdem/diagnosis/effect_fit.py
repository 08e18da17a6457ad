"""Maximum-likelihood amplitudes of one or several effects for a gap, and their gain over no effect."""
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import reduce

import numpy as np

from ..results.recording import Floats
from .amplitude_search import COARSE_STEPS, GOLDEN, TOLERANCE
from .gap_space import CellChoice, GapSpace
from .signature import Signature

# Amplitudes are optimised in turn until none changes by more than this fraction of its range. Signatures with a correlation of 0.99 need a
# hundred rounds.
UNMOVED = 1e-5
MAX_ROUNDS = 200


def no_cells() -> CellChoice:
    return np.zeros(0, np.int64)


@dataclass(frozen=True, eq=False)
class Candidate:
    """A candidate: its signature and the range of plausible amplitudes.

    `lacking`: cells without a value of the signature, which is zero there. The candidate is fitted on the others, so these cells gain
    nothing, and their gap counts as unexplained by it.
    """

    signature: Signature
    low: float
    high: float
    lacking: CellChoice = field(default_factory=no_cells)


def lacking_cells(candidates: Sequence[Candidate]) -> CellChoice:
    """Cells that one of the candidates lacks."""
    return reduce(np.union1d, (candidate.lacking for candidate in candidates if len(candidate.lacking)), no_cells())


@dataclass(frozen=True)
class EffectFit:
    amplitude: float = 0.0
    error: float = 0.0  # one sigma, from the slope of the signature at the amplitude; infinite: the data do not show the effect
    score: float = 0.0  # gain in log likelihood over amplitude zero, with nuisances marginalised in both
    at_bound: bool = False


@dataclass(frozen=True)
class JointFit:
    """Joint fit of several effects.

    The errors include the uncertainty of the other amplitudes. They are all infinite if the data do not show one of the effects or cannot
    distinguish them.
    """

    amplitudes: list[float]  # one per candidate
    errors: list[float]
    score: float  # like EffectFit.score


def minimum(misfit: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Place and value of a minimum between the bounds (Brent 1973, as boost::math::tools::brent_find_minima)."""
    x = w = v = high
    fx = fw = fv = misfit(x)
    step = before = 0.0  # the last one, and the one before it
    while True:
        middle = (low + high) / 2
        least = TOLERANCE * abs(x) + TOLERANCE / 4
        if abs(x - middle) <= 2 * least - (high - low) / 2:
            return x, fx
        parabolic = False
        if abs(before) > least:
            r, q = (x - w) * (fx - fv), (x - v) * (fx - fw)
            p, q = (x - v) * q - (x - w) * r, 2 * (q - r)
            p, q = -p if q > 0 else p, abs(q)
            parabolic = abs(p) < abs(q * before / 2) and q * (low - x) < p < q * (high - x)
        if parabolic:
            before, step = step, p / q
            if x + step - low < 2 * least or high - x - step < 2 * least:
                step = math.copysign(least, middle - x)
        else:
            before = (low if x >= middle else high) - x
            step = GOLDEN * before
        u = x + (step if abs(step) >= least else least if step > 0 else -least)
        fu = misfit(u)
        if fu <= fx:
            low, high = (x, high) if u >= x else (low, x)
            v, w, x, fv, fw, fx = w, x, u, fw, fx, fu
            continue
        low, high = (u, high) if u < x else (low, u)
        if fu <= fw or w == x:
            v, w, fv, fw = w, u, fw, fu
        elif fu <= fv or v in (x, w):
            v, fv = u, fu


def _terms(signature: Signature, a: float) -> tuple[float, float]:
    """Minus the factors of `linear` and `curvature` in Signature.at."""
    inside = signature.within_reach(a)
    return -a, -inside * (2 * a - inside)


class _Misfit:
    """-2 log likelihood as a function of the amplitudes, from products of the whitened gap and the terms of the signatures."""

    def __init__(self, space: GapSpace, candidates: Sequence[Candidate], gap: Floats) -> None:
        self._candidates = candidates
        terms = [gap] + [term for one in candidates for term in (one.signature.linear, one.signature.curvature)]
        basis = np.array([term[space.cells] for term in terms]) @ space.whitener.T
        self._products = basis @ basis.T
        # For each candidate: the amplitudes of a coarse search, their terms, and the part of the misfit due to these alone.
        self._coarse = [self._grid(k) for k in range(len(candidates))]

    def _grid(self, k: int) -> tuple[Floats, Floats, Floats]:
        one = self._candidates[k]
        grid = one.low + np.arange(COARSE_STEPS + 1) * ((one.high - one.low) / COARSE_STEPS)
        inside = np.minimum(np.maximum(grid, -one.signature.reach), one.signature.reach)
        terms = np.array([-grid, -inside * (2 * grid - inside)])
        return grid, terms, (terms * (self._products[1 + 2 * k : 3 + 2 * k, 1 + 2 * k : 3 + 2 * k] @ terms)).sum(axis=0)

    def _factors(self, amplitudes: Sequence[float]) -> list[float]:
        """Of the terms of the difference between gap and signatures."""
        return [1.0] + [factor for one, a in zip(self._candidates, amplitudes) for factor in _terms(one.signature, a)]

    def at(self, amplitudes: Sequence[float]) -> float:
        c = np.array(self._factors(amplitudes))
        return float(c.dot(self._products.dot(c)))

    def information(self, amplitudes: Sequence[float]) -> Floats:
        """Fisher information of the amplitudes: products of the whitened slopes of their signatures."""
        slopes = np.zeros((len(self._products), len(amplitudes)))
        for k, (one, a) in enumerate(zip(self._candidates, amplitudes)):
            slopes[1 + 2 * k : 3 + 2 * k, k] = 1, 2 * one.signature.within_reach(a)
        information: Floats = slopes.T @ self._products @ slopes
        return information

    def best_amplitude(self, amplitudes: Sequence[float], k: int) -> float:
        """The best amplitude `k` with the others fixed."""
        one, first = self._candidates[k], 1 + 2 * k
        c = self._factors(amplitudes)
        c[first : first + 2] = 0, 0
        forces = self._products @ c
        constant, f, g = float(forces @ c), float(2 * forces[first]), float(2 * forces[first + 1])
        (ff, fg), (_, gg) = self._products[first : first + 2, first : first + 2].tolist()
        reach = one.signature.reach

        def misfit(a: float) -> float:
            inside = a if -reach <= a <= reach else math.copysign(reach, a)
            y = -inside * (2 * a - inside)
            return float(constant - a * f + y * g + a * a * ff - 2 * a * y * fg + y * y * gg)

        grid, terms, alone = self._coarse[k]
        coarse = constant + f * terms[0] + g * terms[1] + alone
        lowest, at_zero = int(coarse.argmin()), misfit(0)
        best = float(grid[lowest]) if coarse[lowest] < at_zero else 0.0
        step = (one.high - one.low) / COARSE_STEPS
        amplitude, value = minimum(misfit, max(one.low, best - step), min(one.high, best + step))
        return amplitude if value < at_zero else 0.0

    def best_amplitudes(self) -> list[float]:
        amplitudes = [0.0] * len(self._candidates)
        for _ in range(MAX_ROUNDS):
            moved = False
            for k, one in enumerate(self._candidates):
                before = amplitudes[k]
                amplitudes[k] = self.best_amplitude(amplitudes, k)
                moved |= abs(amplitudes[k] - before) > UNMOVED * (one.high - one.low)
            if not moved or len(amplitudes) == 1:
                break
        return amplitudes


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


def _invertible(matrix: Floats) -> bool:
    """Whether all pivots of a symmetric matrix without negative eigenvalues exceed the error of rounding (as Eigen::FullPivLU)."""
    least = np.finfo(float).eps * len(matrix) * matrix.diagonal().max()
    while len(matrix):
        i = int(matrix.diagonal().argmax())
        if not matrix[i, i] > least:
            return False
        matrix = np.delete(np.delete(matrix - np.outer(matrix[:, i] / matrix[i, i], matrix[i]), i, 0), i, 1)
    return True


def _errors(information: Floats) -> list[float]:
    count = len(information)
    if not information.diagonal().min(initial=math.inf) > 1e-300 or (count > 1 and not _invertible(information)):
        return [math.inf] * count
    errors: list[float] = np.sqrt(np.linalg.inv(information).diagonal() if count != 1 else 1 / information[0]).tolist()
    return errors


def fit_effects(space: GapSpace, candidates: Sequence[Candidate], gap: Floats) -> JointFit:
    """`gap`: observed minus model, all cells."""
    misfit = _Misfit(space.lacking(lacking_cells(candidates)), candidates, gap)
    amplitudes = misfit.best_amplitudes()
    score = 0.5 * (misfit.at([0.0] * len(candidates)) - misfit.at(amplitudes))
    return JointFit(amplitudes, _errors(misfit.information(amplitudes)), score)


def fit_effect(space: GapSpace, candidate: Candidate, gap: Floats) -> EffectFit:
    """`gap`: observed minus model, all cells."""
    alone = fit_effects(space, [candidate], gap)
    amplitude, margin = alone.amplitudes[0], 1e-3 * (candidate.high - candidate.low)
    beyond = candidate.low != 0 if amplitude < candidate.low + margin else amplitude > candidate.high - margin
    return EffectFit(amplitude, alone.errors[0], alone.score, amplitude != 0 and beyond)
