"""Errors of a scene's numerics from paired simulations with refined numerics, extrapolated to the limit."""
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..observe.grid import Bin
from ..observe.observables import observables
from ..results.recording import Floats
from .convergence_types import RELATIVE, CauseErrors, BinError, Limits

SURE = 4  # differences are significant beyond this number of standard errors, because about two thousand bins are tested


def mean_and_error(values: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean of each column of (replicas, bins) over its finite values, its standard error, and their number; NaN if there are too few."""
    known = np.isfinite(values)
    count = known.sum(axis=0).astype(float)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = np.where(known, values, 0).sum(axis=0) / count
        squares = np.where(known, values - mean, 0) ** 2
        return mean, np.sqrt(squares.sum(axis=0) / (count - 1) / count), count


@dataclass(frozen=True, eq=False)
class Baseline:
    """The scene itself: `observed` is (replicas, bins), NaN where unknown."""

    bins: Sequence[Bin]
    observed: Floats
    limits: Limits

    @cached_property
    def mean(self) -> Floats:
        return mean_and_error(self.observed)[0]

    @cached_property
    def deviation(self) -> Floats:
        """Standard deviation of each bin over replicas."""
        _, error, count = mean_and_error(self.observed)
        deviation: Floats = error * np.sqrt(count)
        return deviation

    @cached_property
    def scale(self) -> Floats:
        """The standard deviation, or more where an error must be allowed that the observable does not resolve: copies without
        rearrangements hardly differ."""
        resolution = np.array([observables()[bin.observable].resolution for bin in self.bins])
        return np.fmax(self.deviation, resolution / self.limits.deviations)

    @cached_property
    def limit(self) -> Floats:
        """Largest allowed error of each bin."""
        is_relative = np.array([observables()[bin.observable].name in RELATIVE for bin in self.bins])
        limit: Floats = np.where(is_relative, self.limits.force, self.limits.deviations * self.scale)
        return limit

    def hardly_differ(self) -> bool:
        """Whether the replicas scatter less than the observables resolve, in most bins."""
        return bool(2 * (self.deviation >= self.scale).sum() < np.isfinite(self.deviation).sum())


@dataclass(frozen=True, eq=False)
class Errors:
    """By bin; BinError has the same fields."""

    value: Floats
    standard_error: Floats
    follows_order: NDArray[np.bool_]


def errors_of(base: Floats, remaining: Sequence[float], refined: Sequence[Floats]) -> Errors:
    """Errors of the scene `base` (replicas, bins). `refined`: likewise with one numerical setting refined step by step, of the same
    replicas in the same order; `remaining`: fraction of the error that remains after each step: 1/2, 1/4, ..

    After step k the error e is reduced to e remaining_k, so the scene differs from step k by e (1 - remaining_k). Least squares for each
    replica separately, so that the standard error includes correlations between steps. A replica without a value in a bin is left out
    there.
    """
    gone = 1 - np.array(remaining, float)
    differences = base - np.array(refined)
    value, error, _ = mean_and_error(np.tensordot(gone, differences, 1) / (gone @ gone))
    if len(gone) < 2:
        return Errors(value, error, np.ones(len(value), bool))
    trend, trend_error, _ = mean_and_error(differences[0] / gone[0] - differences[-1] / gone[-1])
    last, last_error, _ = mean_and_error(differences[-1])
    drifts = np.abs(trend) > SURE * trend_error
    return Errors(np.where(drifts, last, value), np.where(drifts, last_error, error), ~drifts)


def cause_errors(cause: str, baseline: Baseline, errors: Errors) -> CauseErrors:
    size = np.abs(errors.value)
    beyond = (size > baseline.limit) & (size > SURE * errors.standard_error)
    return CauseErrors(cause, tuple(
        BinError(observables()[bin.observable].name, bin.phase.name, 1e3 * bin.displacement,
                  float(baseline.mean[k]), float(baseline.deviation[k]), float(errors.value[k]), float(errors.standard_error[k]),
                  bool(errors.follows_order[k]), float(baseline.limit[k]), bool(beyond[k]))
        for k, bin in enumerate(baseline.bins) if np.isfinite(errors.value[k])))
