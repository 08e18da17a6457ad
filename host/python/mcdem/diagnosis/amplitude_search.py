"""Search of the most likely amplitude of an effect, for many gaps or combinations of effects (lanes) at once."""
from dataclasses import dataclass

import numpy as np

from ..results.recording import Bools, Floats

COARSE_STEPS = 24
TOLERANCE = 2.0**-19  # of the amplitude
GOLDEN = float(np.float32(0.381966))
MAX_STEPS = 1000


@dataclass(frozen=True, eq=False)
class Misfit:
    """-2 log likelihood of the gap minus a signature, as a function of its amplitude, from products of the whitened gap g and of the
    whitened terms l and c of the signature (signature.py). Every field is (lanes,)."""

    gg: Floats
    gl: Floats
    gc: Floats
    ll: Floats
    lc: Floats
    cc: Floats
    reach: Floats  # largest simulated amplitude
    low: Floats  # ends of the range of plausible amplitudes
    high: Floats

    def at(self, amplitude: Floats) -> Floats:
        """(.., lanes) at amplitudes (.., lanes)."""
        inside: Floats = np.clip(amplitude, -self.reach, self.reach)
        square: Floats = inside * (2 * amplitude - inside)
        straight: Floats = amplitude * (amplitude * self.ll + 2 * (square * self.lc - self.gl))
        bent: Floats = square * (square * self.cc - 2 * self.gc)
        return self.gg + straight + bent

    def information(self, amplitude: Floats) -> Floats:
        """Fisher information of the amplitude: square of the whitened slope of the signature. (lanes,)"""
        bend = 2 * np.clip(amplitude, -self.reach, self.reach)
        return self.ll + bend * (2 * self.lc + bend * self.cc)

    def some(self, lanes: Bools) -> "Misfit":
        return Misfit(**{name: values[lanes] for name, values in vars(self).items()})

    def best(self) -> Floats:
        """The best amplitude in the range, 0 if it gains nothing: the best of a few, refined between its neighbours. (lanes,)"""
        step = (self.high - self.low) / COARSE_STEPS
        tried = self.low + np.arange(COARSE_STEPS + 1)[:, None] * step
        values = self.at(tried)
        first = values.argmin(axis=0)
        lanes, nothing = np.arange(len(first)), self.at(np.zeros_like(self.gg))
        best = np.where(values[first, lanes] < nothing, tried[first, lanes], 0)
        amplitude, value = self._refined(np.maximum(self.low, best - step), np.minimum(self.high, best + step))
        return np.where(value < nothing, amplitude, 0)

    def _refined(self, low: Floats, high: Floats) -> tuple[Floats, Floats]:
        """The minimum between `low` and `high`, and its value (Brent 1973, chapter 5)."""
        amplitude, value = high.copy(), self.at(high)
        searched, misfit, search = np.arange(len(low)), self, _Brent.started(low, high, value)
        for _ in range(MAX_STEPS):
            if not len(searched):
                break
            done = search.converged()
            if done.any():
                amplitude[searched[done]], value[searched[done]] = search.x[done], search.fx[done]
                searched, misfit, search = searched[~done], misfit.some(~done), search.some(~done)
            search.step(misfit)
        return amplitude, value


@dataclass(eq=False)
class _Brent:
    """State of Brent's minimisation, as in Boost's brent_find_minima. Every field is (lanes,)."""

    low: Floats  # bracket
    high: Floats
    x: Floats  # the best point, the second best and the one before
    w: Floats
    v: Floats
    fx: Floats
    fw: Floats
    fv: Floats
    delta: Floats  # the last move and the one before
    before: Floats

    @classmethod
    def started(cls, low: Floats, high: Floats, value: Floats) -> "_Brent":
        still = np.zeros_like(low)
        return cls(low, high, high, high, high, value, value, value, still, still)

    def some(self, lanes: Bools) -> "_Brent":
        return _Brent(**{name: values[lanes] for name, values in vars(self).items()})

    def smallest_move(self) -> Floats:
        return TOLERANCE * np.abs(self.x) + TOLERANCE / 4

    def converged(self) -> Bools:
        close: Bools = np.abs(self.x - (self.low + self.high) / 2) <= 2 * self.smallest_move() - (self.high - self.low) / 2
        return close

    def step(self, misfit: Misfit) -> None:
        """Moves to the minimum of the parabola through the three points, or by the golden section where it is not acceptable."""
        x, low, high, smallest = self.x, self.low, self.high, self.smallest_move()
        r, q = (x - self.w) * (self.fx - self.fv), (x - self.v) * (self.fx - self.fw)
        p, q = (x - self.v) * q - (x - self.w) * r, 2 * (q - r)
        p, q = np.where(q > 0, -p, p), np.abs(q)
        parabola = (np.abs(self.before) > smallest) & ~(
            (np.abs(p) >= np.abs(q * self.before / 2)) | (p <= q * (low - x)) | (p >= q * (high - x)))
        move = np.divide(p, q, out=np.zeros_like(p), where=parabola)
        middle = (low + high) / 2
        at_end = (x + move - low < 2 * smallest) | (high - (x + move) < 2 * smallest)
        move = np.where(at_end, np.where(middle < x, -smallest, smallest), move)
        larger = np.where(x >= middle, low - x, high - x)
        self.before = np.where(parabola, self.delta, larger)
        self.delta = np.where(parabola, move, GOLDEN * larger)
        moved = np.where(np.abs(self.delta) >= smallest, self.delta, np.where(self.delta > 0, smallest, -smallest))
        self._take(x + moved, misfit)

    def _take(self, u: Floats, misfit: Misfit) -> None:
        """Updates bracket and points after a move to `u`."""
        fu, x = misfit.at(u), self.x
        better, above = fu <= self.fx, u >= x
        self.low = np.where(better & above, x, np.where(~better & (u < x), u, self.low))
        self.high = np.where(better & ~above, x, np.where(~better & ~(u < x), u, self.high))
        second = ~better & ((fu <= self.fw) | (self.w == x))
        third = ~better & ~second & ((fu <= self.fv) | (self.v == x) | (self.v == self.w))
        shifted = better | second
        self.v = np.where(shifted, self.w, np.where(third, u, self.v))
        self.fv = np.where(shifted, self.fw, np.where(third, fu, self.fv))
        self.w = np.where(better, x, np.where(second, u, self.w))
        self.fw = np.where(better, self.fx, np.where(second, fu, self.fw))
        self.x, self.fx = np.where(better, u, x), np.where(better, fu, self.fx)
