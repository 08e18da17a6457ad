"""Search of the most likely amplitudes of effects, for many gaps or combinations of effects (lanes) at once."""
from dataclasses import dataclass

import numpy as np

from ..results.recording import Bools, Floats

COARSE_STEPS = 24
TOLERANCE = 2.0**-19  # of the amplitude
GOLDEN = float(np.float32(0.381966))
MAX_STEPS = 1000
# Amplitudes are optimised in turn until none changes by more than this fraction of its range. Signatures with a correlation of 0.99 need a
# hundred rounds.
UNMOVED = 1e-5
MAX_ROUNDS = 200


@dataclass(frozen=True, eq=False)
class Misfit:
    """-2 log likelihood of gaps minus the signatures of n effects, as a function of their amplitudes (lanes, n).

    From products of the whitened gap and of the whitened terms of the signatures: the linear one and the curvature of each effect.
    """

    square: Floats  # (lanes,) of the gap
    gap_terms: Floats  # (lanes, 2n) products of gap and terms
    terms: Floats  # (lanes, 2n, 2n) products of terms
    reach: Floats  # (lanes, n) largest simulated amplitude
    low: Floats  # (lanes, n) ends of the range of plausible amplitudes
    high: Floats

    def best(self) -> tuple[Floats, Floats]:
        """The best amplitudes in their ranges (lanes, n), optimised in turn, 0 where they gain nothing; and their misfit (lanes,)."""
        amplitudes, values = np.zeros_like(self.reach), self.square.copy()
        lanes, moving, count = np.arange(len(amplitudes)), self, amplitudes.shape[1]
        for _ in range(MAX_ROUNDS if count > 1 else 1):
            now = amplitudes[lanes]
            for k in range(count):
                now[:, k], values[lanes] = moving._along(k, now).best()
            moved = (np.abs(now - amplitudes[lanes]) > UNMOVED * (moving.high - moving.low)).any(axis=1)
            amplitudes[lanes] = now
            if count == 1 or not moved.any():
                break
            lanes, moving = lanes[moved], moving._some(moved)
        return amplitudes, values

    def _factors(self, amplitudes: Floats) -> Floats:
        """(lanes, 2n) of the terms in the sum of the signatures (Signature.at)."""
        inside = np.clip(amplitudes, -self.reach, self.reach)
        factors: Floats = np.stack([amplitudes, inside * (2 * amplitudes - inside)], axis=-1)
        return factors.reshape(self.gap_terms.shape)

    def _along(self, k: int, amplitudes: Floats) -> "_Line":
        """As a function of amplitude `k` alone."""
        place, square, left = 2 * k, self.square, self.gap_terms
        if amplitudes.shape[1] > 1:
            factors = self._factors(amplitudes)
            factors[:, place:place + 2] = 0
            of_others = (self.terms @ factors[:, :, None])[:, :, 0]
            square = square + (factors * (of_others - 2 * left)).sum(axis=1)
            left = left - of_others
        own = self.terms[:, place:place + 2, place:place + 2]
        columns = (square, left[:, place], left[:, place + 1], own[:, 0, 0], own[:, 0, 1], own[:, 1, 1], self.reach[:, k], self.low[:, k],
                   self.high[:, k])
        return _Line(*(np.ascontiguousarray(column, float) for column in columns))

    def _some(self, lanes: Bools) -> "Misfit":
        return Misfit(**{name: values[lanes] for name, values in vars(self).items()})


@dataclass(frozen=True, eq=False)
class _Line:
    """The misfit along one amplitude, from products of the gap g that the others leave and of the terms l and c. Every field is (lanes,)."""

    gg: Floats
    gl: Floats
    gc: Floats
    ll: Floats
    lc: Floats
    cc: Floats
    reach: Floats
    low: Floats
    high: Floats

    def at(self, amplitude: Floats) -> Floats:
        """(.., lanes) at amplitudes (.., lanes)."""
        inside: Floats = np.clip(amplitude, -self.reach, self.reach)
        square: Floats = inside * (2 * amplitude - inside)
        straight: Floats = amplitude * (amplitude * self.ll + 2 * (square * self.lc - self.gl))
        bent: Floats = square * (square * self.cc - 2 * self.gc)
        return self.gg + straight + bent

    def some(self, lanes: Bools) -> "_Line":
        return _Line(**{name: values[lanes] for name, values in vars(self).items()})

    def best(self) -> tuple[Floats, Floats]:
        """The best amplitude in the range and its misfit, 0 if it gains nothing: the best of a few, refined between its neighbours."""
        step = (self.high - self.low) / COARSE_STEPS
        tried = self.low + np.arange(COARSE_STEPS + 1)[:, None] * step
        values = self.at(tried)
        first = values.argmin(axis=0)
        lanes, nothing = np.arange(len(first)), self.at(np.zeros_like(self.gg))
        best = np.where(values[first, lanes] < nothing, tried[first, lanes], 0)
        amplitude, value = self._refined(np.maximum(self.low, best - step), np.minimum(self.high, best + step))
        return np.where(value < nothing, amplitude, 0), np.minimum(value, nothing)

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

    def step(self, misfit: _Line) -> None:
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

    def _take(self, u: Floats, misfit: _Line) -> None:
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
