"""Finds gamma, or another parameter that scales the top force, such that Rtop = 1: the fit of one key to one number."""
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..errors import InputError, RunError
from ..number_text import shortest
from ..results.recording import Floats
from .fit import End, Fit, Ranges, Target

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
    low, high = np.array([options.low]), np.array([options.high])
    fit = Fit(Target(np.array([target]), np.array([target])), Ranges(low, high, low, high, np.array([options.tolerance])), options.batch)
    rounds = list[Round]()
    while len(rounds) < options.rounds and fit.end is None:
        values = fit.values[:, 0]
        forces = np.asarray(top_forces(values), float)
        if len(forces) != len(values):
            raise RunError(f"calibration: asked for {len(values)} top forces, got {len(forces)}")
        fit.add(values[:, None], forces[:, None])
        found = fit.minimum
        rounds.append(Round(values, forces, float(found.x[0]), float(found.standard_error[0])) if found else Round(values, forces))
    if fit.minimum is None:
        raise _out_of_reach(fit, target, options)
    return Calibration(rounds[-1].root, rounds[-1].standard_error, float(fit.minimum.slope[0, 0]), fit.end is End.converged,
                       float(min(fit.failed[:, 0], default=math.nan)), tuple(rounds))


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


def _out_of_reach(fit: Fit, target_force: float, options: SearchOptions) -> RunError:
    """Why the target is not reached."""
    what, target = options.what, f"{target_force:.4g} N"
    stopped = min(fit.failed[:, 0], default=math.nan)
    if not len(fit.x):
        return RunError(f"calibration: the packing runs away already at {what} = {stopped:.4g}; give a bracket that starts lower")
    last = int(np.argmax(fit.x[:, 0]))
    first, x, force = int(np.argmin(fit.x[:, 0])), float(fit.x[last, 0]), float(fit.y[last, 0])
    if fit.y[first, 0] > target_force:
        return RunError(f"calibration: the top force is {fit.y[first, 0]:.4g} N already at {what} = {fit.x[first, 0]:.4g}, above the target of "
                        f"{target}; give a bracket that starts lower, or check the modulus")
    if math.isnan(stopped):
        return RunError(f"calibration: the top force comes only to {force:.4g} N at {what} = {x:.4g}, the target is "
                        f"{target}; give a bracket that ends higher than {options.high:.4g}")
    return RunError(f"calibration: the packing runs away at {what} = {stopped:.4g} before it comes to the target of {target} "
                    f"({force:.4g} N at {what} = {x:.4g}); no {what} gives Rtop = 1 here")
