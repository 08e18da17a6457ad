"""Estimates with standard errors over replicas: from the scatter of a mean, or by the jackknife for other metrics."""
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..results.recording import Floats

not_available = math.nan


@dataclass(frozen=True)
class Estimate:
    """A value with its standard error over replicas, which is NaN if there are fewer than two."""

    value: float = not_available
    standard_error: float = not_available
    count: int = 0  # number of replicas

    def available(self) -> bool:
        return math.isfinite(self.value)


def mean_over_replicas(values: ArrayLike) -> Estimate:
    """Mean of the finite values, with its standard error."""
    all_values = np.asarray(values, float)
    finite = all_values[np.isfinite(all_values)]
    count = len(finite)
    if count == 0:
        return Estimate()
    mean = sum(finite.tolist()) / count
    if count == 1:
        return Estimate(mean, not_available, 1)
    squares = sum(((finite - mean) ** 2).tolist())
    return Estimate(mean, math.sqrt(squares / (count - 1) / count), count)


@dataclass(frozen=True, eq=False)
class Sample:
    """One value per replica with its packing seed (empty if there is none)."""

    seed: Sequence[str]
    value: Floats  # NaN if the replica has no value


@dataclass(frozen=True)
class Omission:
    """Index of the replica that is left out on either side, or -1."""

    simulated: int = -1
    reference: int = -1


Pairs = list[tuple[int, int]]


def pair_by_seed(a: Sequence[str], b: Sequence[str]) -> Pairs | None:
    """Index pairs (in a, in b) of replicas with the same seed.

    None if the two sets of seeds differ, or a seed is missing or repeated: then the two samples are independent.
    """
    where_in_b = {seed: i for i, seed in enumerate(b)}
    if not a or len(a) != len(b) or "" in where_in_b or len(where_in_b) < len(b) or set(a) != set(b):
        return None
    return [(i, where_in_b[seed]) for i, seed in enumerate(a)]


def ratio_of_means(above: Sample, below: Sample) -> Estimate:
    """mean(above) / mean(below).

    If seeds pair up, only pairs with both values are used, and the error includes their correlation (Cochran 1977, chapter 6);
    otherwise errors add in quadrature (a single replica has none).
    """
    pairs = pair_by_seed(above.seed, below.seed)
    if pairs and len(pairs) > 1:
        return _ratio_of_pairs(above, below, pairs)
    a, b = mean_over_replicas(above.value), mean_over_replicas(below.value)
    if not (a.available() and b.available()):
        return Estimate()
    ratio = _over(a.value, b.value)
    if a.count < 2 and b.count < 2:
        return Estimate(ratio, not_available, a.count)
    error_a = 0.0 if a.count < 2 else _over(a.standard_error, b.value)
    error_b = 0.0 if b.count < 2 else _over(ratio * b.standard_error, b.value)
    return Estimate(ratio, math.hypot(error_a, error_b), a.count)


def _ratio_of_pairs(above: Sample, below: Sample, pairs: Pairs) -> Estimate:
    a, b = (above.value[[i for i, _ in pairs]], below.value[[j for _, j in pairs]])
    both = np.isfinite(a) & np.isfinite(b)
    a, b, count = a[both], b[both], int(both.sum())
    if count == 0:
        return Estimate()
    ratio = _over(a.sum(), b.sum())
    if count == 1:
        return Estimate(ratio, not_available, 1)
    squares = float(((a - ratio * b) ** 2).sum())
    return Estimate(ratio, _over(math.sqrt(squares / (count - 1) / count), abs(float(b.sum()) / count)), count)


def _over(a: float, b: float) -> float:
    """a / b as IEEE 754 has it: infinite or NaN where b is 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.float64(a) / np.float64(b))


class Jackknife:
    """Leaves out one replica at a time on either side; pairs with the same seed are left out together.

    `omissions`: the first one leaves nothing out.
    """

    def __init__(self, simulated_seeds: Sequence[str], reference_seeds: Sequence[str]) -> None:
        self.omissions, self._group_sizes = [Omission()], list[int]()
        pairs = pair_by_seed(simulated_seeds, reference_seeds)
        if pairs and len(pairs) > 1:
            self._add([Omission(i, j) for i, j in pairs])
        else:
            self._add([Omission(i, -1) for i in range(len(simulated_seeds))])
            self._add([Omission(-1, i) for i in range(len(reference_seeds))])

    def _add(self, group: list[Omission]) -> None:
        if len(group) > 1:
            self.omissions += group
            self._group_sizes.append(len(group))

    def estimate(self, value_by_omission: ArrayLike) -> Estimate:
        """Estimate from the metric's value under each omission (Efron 1982)."""
        values = np.asarray(value_by_omission, float)
        variance, first = 0.0, 1
        for size in self._group_sizes:
            group = values[first:first + size]
            variance += float(((group - group.mean()) ** 2).sum()) * (size - 1) / size
            first += size
        error = math.sqrt(variance) if self._group_sizes else not_available
        return Estimate(float(values[0]), error, max([1, *self._group_sizes]))
