"""Similarity of two distributions of the contact forces between grains (the paper: "interparticle").

Bhattacharyya's B = integral sqrt(p q) df at each level, and bhat = -log of the mean of B over levels. B is invariant under
transformations of f, so bins need not have the same width. Their edges are quantiles of the two samples together, and every bin is
well filled. Few bins blur the difference between p and q; many bins mistake noise for difference: with n and m contacts and K bins
the plain sum of sqrt(p_i q_i) is too small by about (K - 1)/8 (1/n + 1/m). Therefore K grows as 2 min(n, m)^(2/5), and the bias,
known for each bin from the counts, is added back. This assumes independent contacts.
"""
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..results.recording import Floats
from .contact_forces import contact_forces
from .estimate import Estimate, Jackknife, Omission, mean_over_replicas, not_available
from .levels import Level, LevelMatch, Levels

SKETCH = 20000  # forces, sufficient to place edges


def bin_count(n: float, m: float) -> int:
    """Number of bins for samples of n and m contacts."""
    return int(min(max(2 * min(n, m) ** 0.4, 4), 100))


def common_edges(p: Floats, q: Floats, bins: int) -> Floats:
    """Inner edges of `bins` bins with equal parts of the two samples together, with equal weight of both samples.

    Coinciding edges (many equal forces) are merged.
    """
    sketches = [forces[::max(1, len(forces) // SKETCH)] for forces in (p, q)]
    force = np.concatenate(sketches)
    weight = np.concatenate([np.full(len(one), 0.5 / max(1, len(one))) for one in sketches])
    order = np.lexsort((weight, force))
    force, share = force[order], np.cumsum(weight[order]) * bins
    edges, at = list[float](), 0
    while (at := max(at, int(np.searchsorted(share, len(edges) + 1.0)))) < len(force):
        edges.append(float(force[at]))
        at = int(np.searchsorted(force, edges[-1], "right"))
    return np.array(edges[:-1])  # the last one is the largest force


@dataclass(frozen=True, eq=False)
class Histogram:
    """A histogram as probabilities, with the equivalent number of independent contacts."""

    probability: Floats
    contacts: float = 0.0


def histogram(forces: Floats, edges: Floats) -> Histogram:
    """(edges + 1,) bins; a force at an edge belongs to the bin above."""
    counts = np.bincount(np.searchsorted(edges, forces, "right"), minlength=len(edges) + 1)
    return Histogram(counts / max(1, len(forces)), float(len(forces)))


def mixture(a: Histogram, b: Histogram, weight: float) -> Histogram:
    """(1 - weight) a + weight b."""
    if weight == 0:
        return a
    if a.contacts == 0 or b.contacts == 0:
        return Histogram(a.probability, 0.0)
    variance = (1 - weight) ** 2 / a.contacts + weight**2 / b.contacts
    return Histogram((1 - weight) * a.probability + weight * b.probability, 1 / variance)


def pool(parts: Sequence[Histogram], left_out: int) -> Histogram:
    """Pools samples, except number `left_out`."""
    kept = [part for k, part in enumerate(parts) if k != left_out]
    contacts = sum(part.contacts for part in kept)
    counts = sum((part.probability * part.contacts for part in kept), np.zeros(len(parts[0].probability) if parts else 0))
    return Histogram(counts / contacts if contacts > 0 else counts, contacts)


def bhattacharyya(p: Histogram, q: Histogram) -> float:
    """B, corrected for finite counts. NaN if either is empty."""
    if p.contacts == 0 or q.contacts == 0:
        return not_available
    both = (p.probability > 0) & (q.probability > 0)
    a, b = p.probability[both], q.probability[both]
    # second-order bias of sqrt(a b) for binomial a and b
    return float((np.sqrt(a * b) * (1 + (1 - a) / (8 * p.contacts * a) + (1 - b) / (8 * q.contacts * b))).sum())


@dataclass(frozen=True)
class DistributionDistance:
    bhat: Estimate = Estimate()
    levels_used: int = 0


def distribution_distance(simulated: Levels, reference: Levels, matches: Sequence[LevelMatch],
                          jackknife: Jackknife) -> DistributionDistance:
    """Ignores levels at which either side has no recorded contacts.

    Between two simulated levels the distribution is interpolated like any other quantity.
    """
    overlaps = [_overlaps(simulated[match.below], simulated[match.above], match.weight, wanted, jackknife.omissions)
                for match, wanted in zip(matches, reference, strict=True) if match.found()]
    used = [b for b in overlaps if math.isfinite(b[0])]
    if not used:
        return DistributionDistance()
    with np.errstate(divide="ignore", invalid="ignore"):
        bhat = jackknife.estimate(-np.log(np.sum(used, axis=0) / len(used)))
    # noise can increase the corrected B above 1
    return DistributionDistance(Estimate(max(0.0, bhat.value), bhat.standard_error, bhat.count), len(used))


def _forces_by_replica(level: Level) -> list[Floats]:
    return [contact_forces(recording, scans).grain_grain for recording, scans in zip(level.replicas, level.scans, strict=True)]


def _overlaps(below: Level, above: Level, weight: float, reference: Level, omissions: Sequence[Omission]) -> list[float]:
    """B at one level for each omission."""
    p_below, q = _forces_by_replica(below), _forces_by_replica(reference)
    p_above = p_below if below is above else _forces_by_replica(above)
    p_all, q_all = np.concatenate(p_below if below is above else p_below + p_above), np.concatenate(q)
    edges = common_edges(p_all, q_all, bin_count(len(p_all), len(q_all)))
    counts_below, counts_above, counts_q = ([histogram(one, edges) for one in lists] for lists in (p_below, p_above, q))
    return [bhattacharyya(mixture(pool(counts_below, one.simulated), pool(counts_above, one.simulated), weight),
                          pool(counts_q, one.reference)) for one in omissions]


@dataclass(frozen=True)
class ForceDensity:
    """Density p(f) at one level in equal bins, for figures."""

    force: list[float]  # centre of each bin [N]
    density: list[Estimate]  # [1/N]; error over replicas


def force_density(level: Level, bins: int, largest: float) -> ForceDensity:
    """From 0 to `largest` [N]."""
    width = largest / bins
    replicas = [histogram(forces, np.arange(1, bins + 1) * width) for forces in _forces_by_replica(level)]
    densities = np.array([one.probability[:bins] / width if one.contacts > 0 else np.full(bins, not_available) for one in replicas])
    return ForceDensity([(k + 0.5) * width for k in range(bins)], [mean_over_replicas(densities[:, k]) for k in range(bins)])
