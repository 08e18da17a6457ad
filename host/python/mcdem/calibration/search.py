"""Finds gamma, or another parameter that scales the top force, such that Rtop = 1: the root of a noisy, increasing function that may
diverge.

The top force increases with gamma. Every evaluation is a mean over replicas and has noise; above some gamma no static solution exists.
Simulations run in batches, so each round evaluates several values at once: first spread over the bracket, then increasingly close to
the root. The root comes from a parabola (or a line, while there are few points) fitted to all nearby points, its standard error from
the scatter about the fit.
"""
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..errors import InputError, RunError
from ..number_text import shortest
from ..results.recording import Floats
from .local_fit import Crossing, crossing_of_fit, rising_fit

POINTS_FOR_AN_ERROR = 6  # with fewer, the scatter about the fit is too uncertain to stop

TopForces = Callable[[Floats], Floats]  # mean top force at full stroke for each value [N]; NaN if the simulations ran away


@dataclass(frozen=True)
class SearchOptions:
    low: float = 0.5  # ends of the bracket
    high: float = 1.5
    tolerance: float = 0.005  # standard error of the value at which the search stops
    batch: int = 6  # number of values per round
    rounds: int = 8  # maximum
    what: str = "gamma"  # name of the parameter in messages


@dataclass(frozen=True, eq=False)
class Round:
    """The evaluated values and their top forces."""

    values: Floats
    top_force: Floats  # [N]; NaN if the simulations ran away
    root: float = math.nan  # estimate after this round; NaN while there is none
    standard_error: float = math.nan


@dataclass(frozen=True, eq=False)
class Calibration:
    """The value at which the top force is the target."""

    value: float
    standard_error: float  # from the scatter about the fit
    slope: float  # increase of the top force with the value, there [N]; NaN if it is not known
    converged: bool  # the tolerance was reached within the allowed rounds
    runs_away_at: float  # lowest value that ran away; NaN if none did
    rounds: tuple[Round, ...]


def find_value(top_forces: TopForces, target: float, options: SearchOptions = SearchOptions()) -> Calibration:
    """The value at which the top force is `target` [N].

    Raises InputError for an invalid bracket, target or option, RunError if the target is not reached within the bracket.
    """
    _check(target, options)
    search = _Search(target, options)
    while len(search.rounds) < options.rounds and not search.converged:
        forces = np.asarray(top_forces(search.values), float)
        if len(forces) != len(search.values):
            raise RunError(f"calibration: asked for {len(search.values)} top forces, got {len(forces)}")
        search.add(search.values, forces)
    if math.isnan(search.value):
        raise search.out_of_reach()
    return Calibration(search.value, search.root.standard_error, search.root.slope, search.converged, search.runs_away_at,
                       tuple(search.rounds))


def _check(target: float, options: SearchOptions) -> None:
    demands = ((math.isfinite(target) and target > 0, "target top force must be > 0 [N]", target),
               (math.isfinite(options.low) and options.low >= 0, "low end of the bracket must be >= 0", options.low),
               (math.isfinite(options.high) and options.high > options.low, "high end of the bracket must be above its low end", options.high),
               (options.tolerance > 0, "tolerance must be > 0", options.tolerance),
               (options.batch >= 3, "batch must be at least 3 values per round", options.batch),
               (options.rounds >= 1, "rounds must be at least 1", options.rounds))
    problems = [f"calibration: {what}, got {shortest(got)}" for good, what, got in demands if not good]
    if problems:
        raise InputError(problems)


def _evenly(low: float, high: float, count: int) -> Floats:
    return np.asarray(low + (high - low) * np.arange(count) / (count - 1))


class _Search:
    """The rounds so far, what follows from them, and the values to evaluate next."""

    def __init__(self, target: float, options: SearchOptions) -> None:
        self._target, self._options = target, options
        self._x: Floats = np.zeros(0)  # evaluated values without those that ran away, and above; in increasing order
        self._y: Floats = np.zeros(0)  # their top forces [N]
        self._window: tuple[float, float] | None = None  # centre and half width, once the target has been crossed
        self.values = _evenly(options.low, options.high, options.batch)
        self.value, self.root, self.runs_away_at = math.nan, Crossing(), math.nan
        self.converged = False
        self.rounds = list[Round]()

    def add(self, values: Floats, forces: Floats) -> None:
        """A round. Raises RunError if it shows that the target is out of reach."""
        self._collect(values, forces)
        below, above = self._neighbours()
        if math.isnan(below) or math.isnan(above):
            self.values = self._exploring()
            self.rounds.append(Round(values, forces))
            return
        middle = (below + above) / 2
        centre, half = self._window or (middle, 1.5 * abs(above - below))
        low, high = centre - half, centre + half
        self.root = crossing_of_fit(self._x, self._y, low, high, self._target)
        self.value = middle if math.isnan(self.root.x) else self.root.x
        self.rounds.append(Round(values, forces, self.value, self.root.standard_error))
        inside = int(((self._x >= low) & (self._x <= high)).sum())
        self.converged = self.root.standard_error <= self._options.tolerance and inside >= POINTS_FOR_AN_ERROR
        if self._window:  # half as wide as before, but wide enough that the slope is significant
            least = half if math.isnan(self.root.x) else np.fmin(5 * self.root.standard_error, half)
            centre, half = self.value, float(np.fmax(half / 2, least))
        self._window = centre, half
        self.values = _evenly(max(centre - half, self._options.low), self._highest_safe(min(centre + half, self._options.high)),
                              self._options.batch)

    def _collect(self, values: Floats, forces: Floats) -> None:
        finite = np.isfinite(forces)
        self.runs_away_at = float(np.fmin.reduce(values[~finite], initial=self.runs_away_at))
        x, y = np.append(self._x, values[finite]), np.append(self._y, forces[finite])
        kept = ~(x > self.runs_away_at)  # results above the lowest value that ran away are not reliable
        order = np.argsort(x[kept], kind="stable")
        self._x, self._y = x[kept][order], y[kept][order]

    def _neighbours(self) -> tuple[float, float]:
        """Between which the increasing fit crosses the target; one is NaN if all points are on the other side."""
        lower = int(np.searchsorted(rising_fit(self._y), self._target))  # number of points below the target
        x = [math.nan, *self._x.tolist(), math.nan]
        return x[lower], x[lower + 1]

    def _highest_safe(self, high: float) -> float:
        """End of the interval below the lowest runaway, at some distance from it."""
        if math.isnan(self.runs_away_at) or not len(self._x):
            return high
        return min(high, (float(self._x[-1]) + self.runs_away_at) / 2)

    def _exploring(self) -> Floats:
        """Values in the part of the bracket below the lowest runaway, while the target has not been crossed."""
        low, high = float(self._x[-1]) if len(self._x) else self._options.low, self.runs_away_at
        is_open = not math.isnan(self._neighbours()[0]) if len(self._x) else high > low
        if not (is_open and high - low > self._options.tolerance):
            raise self.out_of_reach()
        return _evenly(low, high, self._options.batch + 2)[1:-1]  # both ends are known

    def out_of_reach(self) -> RunError:
        """Why the target is not reached."""
        what, target = self._options.what, f"{self._target:.4g} N"
        if not len(self._x):
            return RunError(f"calibration: the packing runs away already at {what} = {self.runs_away_at:.4g}; give a bracket that starts "
                            "lower")
        if math.isnan(self._neighbours()[0]):
            return RunError(f"calibration: the top force is {self._y[0]:.4g} N already at {what} = {self._x[0]:.4g}, above the target of "
                            f"{target}; give a bracket that starts lower, or check the modulus")
        if math.isnan(self.runs_away_at):
            return RunError(f"calibration: the top force comes only to {self._y[-1]:.4g} N at {what} = {self._x[-1]:.4g}, the target is "
                            f"{target}; give a bracket that ends higher than {self._options.high:.4g}")
        return RunError(f"calibration: the packing runs away at {what} = {self.runs_away_at:.4g} before it comes to the target of {target} "
                        f"({self._y[-1]:.4g} N at {what} = {self._x[-1]:.4g}); no {what} gives Rtop = 1 here")
