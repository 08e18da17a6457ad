"""Least squares by simulations: the values of keys with which simulated data are closest to measured ones.

Every trial is a mean over packings and has noise, and beyond some values simulations stop early. Simulations run in batches, so each round
tries several values at once. A polynomial is fitted to the trials in a window (the trust region) and minimised there; the next window is
around that minimum: smaller if the minimum is inside, larger if it is at the edge. One key alone begins with values spread over its range.
Standard errors are those of the minimum, from the scatter of the trials about the polynomial.
"""
import math
from dataclasses import dataclass
from enum import Enum, auto
from itertools import combinations

import numpy as np
from scipy.optimize import least_squares

from ..results.recording import Bools, Floats

POINTS_FOR_AN_ERROR = 6  # of one key alone; with fewer, the scatter about the polynomial is too uncertain to stop
REACH = 2.0  # trials within this many half widths of the window count for the polynomial of several keys
HOLD = 0.01  # penalty for leaving the window's centre by its half width, over that of one sigma: keys without influence stay where they are
STALLED = 0.02  # relative decrease of the misfit in two rounds below which several keys have converged


class End(Enum):
    """Why no more rounds follow."""
    converged = auto()
    out_of_range = auto()  # the minimum is at the limit of a key
    stops_early = auto()  # .. where simulations begin to stop early
    no_data = auto()  # all trials stopped early


@dataclass(frozen=True, eq=False)
class Target:
    """What is measured, N numbers."""
    value: Floats  # (N,)
    sigma: Floats  # (N,) differences of this size count equally

    def misfit(self, data: Floats) -> Floats:
        """(..,) root mean square of the differences of data (.., N) over sigma."""
        return np.asarray(np.sqrt((((data - self.value) / self.sigma) ** 2).mean(-1)))


@dataclass(frozen=True, eq=False)
class Ranges:
    """Of p keys, each (p,)."""
    low: Floats  # limits
    high: Floats
    first_low: Floats  # the first window
    first_high: Floats
    tolerance: Floats  # standard errors at which the fit ends


@dataclass(frozen=True, eq=False)
class Minimum:
    """Of the polynomial."""
    x: Floats  # (p,)
    slope: Floats  # (N, p) of the data with the keys, there
    gain: Floats  # (p, N) shift of the minimum with the data
    covariance: Floats  # (p, p) of x, from the scatter of the trials about the polynomial; NaN with too few trials
    at_edge: Bools  # (p,) of the window
    trials: int  # number that the polynomial rests on

    @property
    def standard_error(self) -> Floats:
        """(p,)"""
        return np.asarray(np.sqrt(np.diag(self.covariance)))


class Polynomial:
    """Least squares of first order, with squares and with products as far as there are trials for them."""

    def __init__(self, x: Floats, y: Floats, centre: Floats, half: Floats, for_squares: int = POINTS_FOR_AN_ERROR) -> None:
        """`x` (n, p), `y` (n, N); `for_squares`: number of trials of one key alone from which the square counts."""
        count, keys = x.shape
        self._centre, self._half = centre, half
        needed = {"squares": for_squares if keys == 1 else 2 * keys + 1, "products": 2 * keys + 3 + keys * (keys - 1) // 2}
        self._squares = count >= needed["squares"]
        self._pairs = list(combinations(range(keys), 2)) if count >= needed["products"] else []
        terms = self._terms(x)
        self._inverse: Floats = np.linalg.pinv(terms.T @ terms)
        self._coefficients: Floats = np.linalg.lstsq(terms, y, rcond=None)[0]
        rest, freedom = y - terms @ self._coefficients, count - terms.shape[1]
        self.scatter: Floats = rest.T @ rest / freedom if freedom > 0 else np.full((y.shape[1],) * 2, math.nan)  # (N, N)

    def _terms(self, x: Floats) -> Floats:
        u = (x - self._centre) / self._half
        squares = [u**2] if self._squares else []
        products = [u[:, [i]] * u[:, [j]] for i, j in self._pairs]
        return np.hstack([np.ones((len(u), 1)), u, *squares, *products])

    def _term_slopes(self, x: Floats) -> Floats:
        """(p, terms)"""
        u, keys = (x - self._centre) / self._half, len(x)
        columns = [np.zeros((keys, 1)), np.eye(keys)] + ([np.diag(2 * u)] if self._squares else [])
        for i, j in self._pairs:
            column = np.zeros((keys, 1))
            column[i], column[j] = u[j], u[i]
            columns.append(column)
        return np.asarray(np.hstack(columns) / self._half[:, None])

    def value(self, x: Floats) -> Floats:
        """(N,)"""
        return np.asarray((self._terms(x[None]) @ self._coefficients)[0])

    def slope(self, x: Floats) -> Floats:
        """(N, p)"""
        return np.asarray((self._term_slopes(x) @ self._coefficients).T)

    def leverage(self, x: Floats) -> float:
        """Variance of value(x) over the scatter."""
        terms = self._terms(x[None])[0]
        return float(terms @ self._inverse @ terms)

    def slope_leverage(self, x: Floats) -> Floats:
        """(p, p) covariance of the slopes over the scatter."""
        slopes = self._term_slopes(x)
        return np.asarray(slopes @ self._inverse @ slopes.T)


class Fit:
    """Asks for trials of `values`, and is told their data; until `end`, or as long as rounds are left."""

    def __init__(self, target: Target, ranges: Ranges, batch: int, for_squares: int = POINTS_FOR_AN_ERROR) -> None:
        """`batch`: number of values in a round of one key; several keys take one at the centre and two for each. `for_squares`: as of
        Polynomial."""
        self._target, self._ranges, self._batch, self._for_squares = target, ranges, batch, for_squares
        self._keys = len(ranges.low)
        self.x, self.y = np.zeros((0, self._keys)), np.zeros((0, len(target.value)))  # trials that did not stop early
        self.failed = np.zeros((0, self._keys))
        self._centre, self._half = (ranges.first_high + ranges.first_low) / 2, (ranges.first_high - ranges.first_low) / 2
        self._least_half = self._half.copy()
        self._has_window = self._keys > 1
        self._bests = list[float]()  # least misfit after each round
        self.minimum: Minimum | None = None
        self.end: End | None = None
        self.values = self._evenly(*self._window()) if self._keys == 1 else self._star(self._centre)

    @property
    def best(self) -> int:
        """Row of the trial with the least misfit."""
        return int(np.argmin(self._target.misfit(self.y)))

    def add(self, x: Floats, y: Floats) -> None:
        """A round: trials (n, p) and their data (n, N), NaN where a simulation stopped early."""
        finite = np.isfinite(y).all(1)
        self.x, self.y, self.failed = np.vstack([self.x, x[finite]]), np.vstack([self.y, y[finite]]), np.vstack([self.failed, x[~finite]])
        if self._keys == 1 and len(self.x):  # trials beyond one that stopped are not reliable
            low, high = self._stopped()
            kept = (self.x[:, 0] > low) & (self.x[:, 0] < high)
            self.x, self.y = self.x[kept], self.y[kept]
        if not len(self.x):
            self.end = End.no_data
            return
        (self._step_one_key if self._keys == 1 else self._step_several_keys)()

    def _window(self) -> tuple[float, float]:
        """Of one key, within its limits and at some distance from values with which simulations stop."""
        low, high = self._stopped()
        low = (low + self.x.min()) / 2 if math.isfinite(low) else -math.inf
        high = (high + self.x.max()) / 2 if math.isfinite(high) else math.inf
        centre, half = float(self._centre[0]), float(self._half[0])
        return max(centre - half, float(self._ranges.low[0]), low), min(centre + half, float(self._ranges.high[0]), high)

    def _stopped(self) -> tuple[float, float]:
        """The nearest values of one key below and above the first trial that did not stop, with which simulations stopped."""
        if not len(self.x):
            return -math.inf, math.inf
        first, failed = float(self.x[0, 0]), self.failed[:, 0]
        return max(failed[failed < first], default=-math.inf), min(failed[failed > first], default=math.inf)

    def _evenly(self, low: float, high: float) -> Floats:
        return np.asarray(low + (high - low) * np.arange(self._batch) / (self._batch - 1))[:, None]

    def _star(self, centre: Floats) -> Floats:
        """The centre, and on either side of it one value of each key, within its limits."""
        steps = np.vstack([np.zeros(self._keys), *(sign * np.diag(self._half) for sign in (1, -1))])
        points = np.clip(centre + steps, self._ranges.low, self._ranges.high)
        return np.asarray(points[np.sort(np.unique(points, axis=0, return_index=True)[1])])

    def _step_one_key(self) -> None:
        is_first = not self._has_window
        if is_first and not self._find_window():
            return
        found = self._minimise(np.abs(self.x - self._centre)[:, 0] <= self._half[0] * (1 + 1e-12))
        self.minimum = found
        error = float(found.standard_error[0])
        if error <= self._ranges.tolerance[0] and found.trials >= POINTS_FOR_AN_ERROR:
            self.end = End.converged
        if not is_first:  # half as wide as before, but wide enough that the slope is significant
            half = self._half if found.at_edge[0] else np.fmax(self._half / 2, np.fmin(5 * error, self._half))
            self._centre, self._half = found.x, half
        self.values = self._evenly(*self._window())

    def _find_window(self) -> bool:
        """Around the minimum; False while that is beyond the values that were tried, which `values` then extend."""
        order = np.argsort(self.x[:, 0], kind="stable")
        x, y = self.x[order, 0], self.y[order]
        best = int(np.argmin(self._target.misfit(y)))
        if y.shape[1] == 1:  # between values that are too small and too large, or nowhere
            above = y[:, 0] > self._target.value[0]
            crossed = np.flatnonzero(above[1:] != above[:-1])
            if len(crossed):
                nearest = int(crossed[np.argmin(np.abs(crossed + 0.5 - best))])
                self._centre, self._half = (x[nearest:nearest + 1] + x[nearest + 1]) / 2, 1.5 * (x[nearest + 1:nearest + 2] - x[nearest])
                self._has_window = True
                return True
        if 0 < best < len(x) - 1:
            self._centre, self._half = x[best:best + 1], np.array([1.5 * max(x[best] - x[best - 1], x[best + 1] - x[best])])
            self._has_window = True
            return True
        self._extend(float(x[0]), float(x[-1]), best)
        return False

    def _extend(self, lowest: float, highest: float, best: int) -> None:
        """Beyond the trials, on the side of the best of them, as far as the limits and simulations that stop allow."""
        stopped, limits = self._stopped(), (float(self._ranges.low[0]), float(self._ranges.high[0]))
        is_up = best > 0 or (lowest == highest and (math.isfinite(stopped[1]) or lowest <= limits[0]))
        edge, stop, limit = (highest, stopped[1], limits[1]) if is_up else (lowest, stopped[0], limits[0])
        if math.isfinite(stop):
            if abs(stop - edge) <= self._ranges.tolerance[0]:
                self.end = End.stops_early
            far, count = stop, self._batch + 2
        else:
            width = 2 * max(highest - lowest, float(self._half[0]))
            far, count = (min(edge + width, limit) if is_up else max(edge - width, limit)), self._batch + 1
            if edge == limit:
                self.end = End.out_of_range
        values = edge + (far - edge) * np.arange(count) / (count - 1)
        self.values = np.sort(values[1:self._batch + 1])[:, None]  # the edge is known

    def _step_several_keys(self) -> None:
        anchor = self.x[self.best]
        self._centre = anchor
        if len(self.failed):  # smaller than half the way to the nearest trial that stopped
            away = np.abs(self.failed - anchor) / self._half
            for row in away[(away.max(1) > 0) & (away.max(1) < 2)]:
                self._half = self._half * np.where(row == row.max(), np.minimum(1, row / 2), 1)
        near = (np.abs(self.x - anchor) / self._half).max(1)
        wanted = np.sort(near)[:2 * self._keys + 1][-1]
        found = self._minimise(near <= max(REACH, wanted))
        self.minimum = found
        self._bests.append(float(self._target.misfit(self.y).min()))
        is_limit = (found.x <= self._ranges.low) | (found.x >= self._ranges.high)
        is_open = found.at_edge & ~is_limit
        if (found.standard_error <= self._ranges.tolerance).all() and not is_open.any():
            self.end = End.converged
        if len(self._bests) > 2 and self._bests[-1] > (1 - STALLED) * self._bests[-3] and np.isfinite(found.covariance).all():
            self.end = End.converged
        least = np.minimum(self._half, np.fmax(self._least_half, 3 * np.nan_to_num(found.standard_error)))
        self._half = np.where(is_open, np.minimum(2 * self._half, self._ranges.high - self._ranges.low), np.maximum(self._half / 2, least))
        self.values = self._star(found.x)

    def slopes(self) -> tuple[Floats, Floats]:
        """(p, p) square of the data's slopes over sigma with the keys, on average over all trials, and what the scatter adds to it."""
        polynomial, middle = Polynomial(self.x, self.y, self.x.mean(0), self._half), self.x.mean(0)
        slope = polynomial.slope(middle) / self._target.sigma[:, None]
        scatter = np.nan_to_num(np.diag(polynomial.scatter) / self._target.sigma**2)
        return np.asarray(slope.T @ slope, float), np.asarray(polynomial.slope_leverage(middle) * float(scatter.sum()), float)

    def _minimise(self, chosen: Bools) -> Minimum:
        """Of the polynomial through the chosen trials, in the window."""
        polynomial = Polynomial(self.x[chosen], self.y[chosen], self._centre, self._half, self._for_squares)
        low, high = np.maximum(self._centre - self._half, self._ranges.low), np.minimum(self._centre + self._half, self._ranges.high)
        hold, sigma, scale = (math.sqrt(HOLD) if self._keys > 1 else 0.0), self._target.sigma, self._half

        def residuals(x: Floats) -> Floats:
            return np.append((polynomial.value(x) - self._target.value) / sigma, hold * (x - self._centre) / scale)

        def slopes(x: Floats) -> Floats:
            return np.vstack([polynomial.slope(x) / sigma[:, None], hold * np.diag(1 / scale)])

        start = np.clip(self._centre, low, high)
        found = least_squares(residuals, start, slopes, bounds=(low, np.maximum(high, low + 1e-12 * scale)), x_scale=scale,
                              xtol=1e-14, ftol=1e-14, gtol=1e-14)
        x, slope = np.asarray(found.x), polynomial.slope(found.x)
        gain = np.linalg.pinv(slope * scale / sigma[:, None]) * scale[:, None] / sigma
        covariance = polynomial.leverage(x) * gain @ polynomial.scatter @ gain.T
        at_edge = np.minimum(x - (self._centre - scale), self._centre + scale - x) < 1e-3 * scale
        return Minimum(x, slope, gain, covariance, at_edge, int(chosen.sum()))
