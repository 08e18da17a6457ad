"""Rtop and errf: simulated force on the plate compared with a reference."""
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..results.names import Phase
from ..results.recording import Floats
from .estimate import Estimate, Omission, Sample, not_available, ratio_of_means
from .levels import Level, LevelMatch, Levels, at_reference, by_replica, match_levels, mean_without, tolerance_of, top_force
from .replicas import Replicas, seeds_of


@dataclass(frozen=True)
class TopForceRatio:
    """Ratio of mean top forces at maximum compression; taken at the end of the simulation if that is before the reference's."""

    Rtop: Estimate = Estimate()
    displacement: float = not_available  # [m]
    reference_end: float = not_available  # maximum compression of the reference [m]


@dataclass(frozen=True, eq=False)
class LevelError:
    """RMS over levels, for each omission of the jackknife."""

    by_omission: Floats
    levels_used: int = 0


def full_stroke(levels: Levels, replicas: Replicas) -> float:
    """Largest displacement reached by replicas that did not fail [m]; NaN if all failed."""
    reached = [level.displacement for level in levels
               if any(not replica.failure and len(scans) for replica, scans in zip(replicas, level.scans, strict=True))]
    return max(reached, default=not_available)


def top_force_at(levels: Levels, replicas: Replicas, displacement: float) -> Sample:
    """Top force of each replica at a displacement [N].

    On the loading branch, or on the unloading branch if loading does not reach it (a turning point belongs to both).
    """
    value = np.full(len(replicas), not_available)
    forces = by_replica(levels, top_force)
    for phase in Phase:
        at = at_reference(forces, match_levels(levels, [Level(phase, displacement, (), ())]))
        if len(at):
            value = np.where(np.isfinite(value), value, at[:, 0])
    return Sample(seeds_of(replicas), value)


def top_force_ratio(simulated: Levels, simulated_replicas: Replicas, reference: Levels, reference_replicas: Replicas) -> TopForceRatio:
    reference_end, simulated_end = full_stroke(reference, reference_replicas), full_stroke(simulated, simulated_replicas)
    if np.isnan(simulated_end) or np.isnan(reference_end):
        return TopForceRatio(reference_end=reference_end)
    displacement = simulated_end if simulated_end < reference_end - tolerance_of(simulated) else reference_end
    ratio = ratio_of_means(top_force_at(simulated, simulated_replicas, displacement),
                           top_force_at(reference, reference_replicas, displacement))
    return TopForceRatio(ratio, displacement, reference_end)


def rms_over_levels(simulated: Floats, reference: Floats, omissions: Sequence[Omission]) -> LevelError:
    """RMS over the levels at which both are finite. Values (.., replica, level); the errors are (.., omission)."""
    differences = [mean_without(simulated, one.simulated) - mean_without(reference, one.reference) for one in omissions]
    used = [np.isfinite(difference) for difference in differences]
    with np.errstate(invalid="ignore"):
        errors = [np.sqrt((np.where(known, difference, 0) ** 2).sum(-1) / known.sum(-1))
                  for difference, known in zip(differences, used, strict=True)]
    return LevelError(np.stack(errors, -1), int(used[0].sum(-1).flat[0]))


def top_force_error(simulated: Levels, reference: Levels, matches: Sequence[LevelMatch], omissions: Sequence[Omission],
                    touch_force: float | None = None) -> LevelError:
    """errf [N]: RMS difference of the cycle-averaged top force over the levels of both phases.

    Levels at which the reference's mean force does not exceed `touch_force` are ignored; default: all levels are used.
    """
    at, measured = at_reference(by_replica(simulated, top_force), matches), by_replica(reference, top_force)
    if touch_force is not None:
        measured = np.where(mean_without(measured, -1) > touch_force, measured, np.nan)
    return rms_over_levels(at, measured, omissions)
