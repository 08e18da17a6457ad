"""Scans of one setting grouped by compression level: the same phase and the same plate displacement."""
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..results.names import Phase
from ..results.recording import Floats, Ints, Recording
from .estimate import Estimate, mean_over_replicas
from .replicas import Replicas, discard_of

# Displacements within this distance of a level's mean belong to it [m]. If the scans of a recording are closer (recorded without
# stopping), a third of their median spacing is used.
level_tolerance = 0.1e-3


@dataclass(frozen=True, eq=False)
class Level:
    """`scans` has, for each of the replicas, the rows of its scans: one for each cycle that reached the level."""

    phase: Phase
    displacement: float  # mean over its scans [m]
    replicas: Replicas
    scans: tuple[Ints, ...]


Levels = Sequence[Level]
Quantity = Callable[[Recording], Floats]  # a value for each scan; NaN if the scan does not have it


@dataclass(frozen=True)
class LevelMean:
    """`mean`: over replicas, of their means over cycles."""

    phase: Phase
    displacement: float  # [m]
    mean: Estimate


@dataclass(frozen=True)
class LevelMatch:
    """Position of a reference level among simulated ones: (1 - weight) of `below` + weight of `above`."""

    below: int = -1  # index of a level; -1 if the reference level is out of range
    above: int = -1
    weight: float = 0.0

    def found(self) -> bool:
        return self.below >= 0


def group_levels(replicas: Replicas) -> Levels:
    """Loading levels first; each phase in order of increasing displacement.

    Without the first cycles that each recording's `protocol.discard` leaves out. Raises InputError for runs of a programme.
    """
    _expect_strokes(replicas)
    tolerance = min(level_tolerance, _median_spacing(replicas) / 3)
    levels = []
    for phase in Phase:
        rows = [_rows_of_phase(recording, phase) for recording in replicas]
        displacement = np.concatenate([one.displacement[row] for one, row in zip(replicas, rows, strict=True)] or [np.zeros(0)])
        owner = np.repeat(np.arange(len(rows)), [len(row) for row in rows])
        row_of = np.concatenate(rows or [np.zeros(0, int)])
        order = np.argsort(displacement, kind="stable")
        for members, mean in _runs_within(displacement[order], tolerance):
            level = order[members]
            scans = tuple(row_of[level[owner[level] == r]] for r in range(len(rows)))
            levels.append(Level(phase, mean, replicas, scans))
    return levels


def _rows_of_phase(recording: Recording, phase: Phase) -> Ints:
    scans = recording.scans
    wanted = (scans.phase == phase) & (scans.cycle >= discard_of(recording)) & np.isfinite(recording.displacement)
    return np.flatnonzero(wanted)


def _runs_within(ascending: Floats, tolerance: float) -> list[tuple[slice, float]]:
    """Neighbours of which each is at most `tolerance` above the mean of those before it, and their mean."""
    runs, first, mean = list[tuple[slice, float]](), 0, 0.0
    for i, here in enumerate(ascending.tolist()):
        if i > first and here - mean > tolerance:
            runs.append((slice(first, i), mean))
            first = i
        mean = here if i == first else mean + (here - mean) / (i - first + 1)
    return [*runs, (slice(first, len(ascending)), mean)] if len(ascending) else []


def _median_spacing(replicas: Replicas) -> float:
    """Median distance between neighbouring scans of the same recording, phase and cycle [m]; infinite if there are none."""
    spacings = []
    for scans in (recording.scans for recording in replicas):
        spacing = np.abs(np.diff(scans.plate_z))
        spacings.append(spacing[(np.diff(scans.phase) == 0) & (np.diff(scans.cycle) == 0) & (spacing > 0)])
    everyone = np.sort(np.concatenate(spacings or [np.zeros(0)]))
    return float(everyone[len(everyone) // 2]) if len(everyone) else math.inf


def _expect_strokes(replicas: Replicas) -> None:
    """A programme reaches the same displacement at different loads and times."""
    for recording in replicas:
        if recording.has_programme:
            raise InputError(f"{recording.label}: must be a run of the strokes of [plate] and [protocol] to be compared level by level, "
                             "got one of a [[programme]]: its scans stand in plate.csv and run.h5, position and force against time")


def top_force(recording: Recording) -> Floats:
    """(S,) [N]"""
    return recording.scans.top_force


def by_replica(levels: Levels, quantity: Quantity) -> Floats:
    """(replica, level): mean over the cycles that have the quantity; NaN if there are none."""
    replicas = levels[0].replicas if levels else ()
    return np.array([_means_of_cycles(quantity(recording), [level.scans[r] for level in levels])
                     for r, recording in enumerate(replicas)]).reshape(len(replicas), len(levels))


def _means_of_cycles(value: Floats, scans: Sequence[Ints]) -> Floats:
    rows, level = np.concatenate(scans), np.repeat(np.arange(len(scans)), [len(one) for one in scans])
    known = np.isfinite(value[rows])
    sums = np.bincount(level[known], value[rows[known]], len(scans))
    with np.errstate(invalid="ignore"):
        return np.asarray(sums / np.bincount(level[known], minlength=len(scans)))


def level_means(levels: Levels, values: Floats | Quantity) -> list[LevelMean]:
    """Of values by replica (rows) and level (columns), or of a quantity."""
    if callable(values):
        values = by_replica(levels, values)
    return [LevelMean(level.phase, level.displacement, mean_over_replicas(values[:, k])) for k, level in enumerate(levels)]


def tolerance_of(levels: Levels) -> float:
    """Displacements within it are the same [m]: `level_tolerance`, or a tenth of the median distance of the levels if they are closer."""
    ways = np.concatenate([np.diff([0.0, *(level.displacement for level in levels if level.phase == phase)]) for phase in Phase])
    return min(level_tolerance, float(np.median(ways[ways > 0])) / 10) if (ways > 0).any() else level_tolerance


def match_levels(simulated: Levels, reference: Levels) -> list[LevelMatch]:
    """One match for each reference level.

    A simulated level within the tolerance, otherwise linear interpolation between the two neighbours of the same phase (always
    if simulated levels are close together). No extrapolation.
    """
    of_phase = {phase: [s for s, level in enumerate(simulated) if level.phase == phase] for phase in Phase}
    displacements = {phase: np.array([simulated[s].displacement for s in of_phase[phase]]) for phase in Phase}
    tolerance = tolerance_of(simulated)
    return [_match(of_phase[level.phase], displacements[level.phase], level.displacement, tolerance) for level in reference]


def _match(indices: Sequence[int], ascending: Floats, wanted: float, tolerance: float) -> LevelMatch:
    """`b` and `a`: the neighbours below and above, equal if a level is met."""
    b, a = int(np.searchsorted(ascending, wanted, "right")) - 1, int(np.searchsorted(ascending, wanted, "left"))
    to_below = abs(ascending[b] - wanted) if b >= 0 else math.inf
    to_above = abs(ascending[a] - wanted) if a < len(ascending) else math.inf
    is_dense = to_below + to_above < 4 * level_tolerance
    if min(to_below, to_above) <= tolerance and (not is_dense or a == b):
        nearest = indices[b if to_below <= to_above else a]
        return LevelMatch(nearest, nearest, 0.0)
    if math.isfinite(to_below + to_above):
        return LevelMatch(indices[b], indices[a], float(to_below / (to_below + to_above)))
    return LevelMatch()


def at_reference(values: Floats, matches: Sequence[LevelMatch]) -> Floats:
    """Columns of `values` (.., replica, simulated level) interpolated to the reference levels."""
    if not values.shape[-1]:
        return np.full((*values.shape[:-1], len(matches)), math.nan)
    below, above = (np.array([getattr(match, name) for match in matches], int) for name in ("below", "above"))
    weight = np.array([match.weight for match in matches])
    between = (1 - weight) * values[..., below] + weight * values[..., above]
    return np.where(below < 0, math.nan, np.where(below == above, values[..., below], between))


def mean_without(values: Floats, left_out: int) -> Floats:
    """(.., level) mean of the finite values (.., replica, level) over replicas without number `left_out` (-1: all)."""
    kept = np.delete(values, left_out, axis=-2) if left_out >= 0 else values
    known = np.isfinite(kept)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(known, kept, 0).sum(-2) / known.sum(-2))
