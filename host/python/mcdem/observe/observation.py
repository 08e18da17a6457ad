"""A recording as one vector: every observable at several displacements of loading and of unloading."""
from collections.abc import Sequence

import numpy as np

from ..results.names import Phase
from ..results.recording import Floats, Ints, Recording
from .contact_residuals import Material
from .grid import PHASES, Grid, grid_of, offsets
from .observables import MIN_CONTACTS, groups, index_of, observables
from .seen_scans import SeenScans
from .touching import with_hertz_contacts

MIN_BINS = 4  # that an experiment and its simulations must have in common
LEAST_WEIGHT = 0.3  # of the scans around a displacement, each of which has at most 1
LEAST_SPREAD = 1e-3  # of their places, relative; below it there is no slope
NEAR = 0.1  # a mean without a slope counts if its place is that near


def observe(recording: Recording, grid: Grid, material: Material, discard: int = 0) -> Floats:
    """(bins,) in the order of bins_of(grid); NaN if the recording does not determine it.

    Cycles after `discard` are averaged. A hold is assigned to the nearest displacement. Within the width of a bin a straight line is fitted
    through the scans (local linear regression, triangular weights), so the recordings that are compared need not have scans at the same
    displacements.
    """
    scans = recording.scans
    strokes = (scans.cycle >= discard) & ~grid.is_held(len(scans))
    offset = offsets(recording, grid)
    near = strokes[:, np.newaxis] & (np.abs(offset) < 1)
    chosen = np.flatnonzero(near.any(axis=1))
    values = scan_observables(recording, chosen, material)
    if grid.force:  # of displacement and force, only the one that is not prescribed
        values[:, index_of("top_force")] = np.nan
        values[:, index_of("displacement")] = recording.displacement[chosen] / grid.stroke
    of_phase = scans.phase[chosen, np.newaxis, np.newaxis] == np.array(PHASES)[:, np.newaxis]
    weight = np.where(of_phase & near[chosen, np.newaxis], 1 - np.abs(offset[chosen, np.newaxis]), 0)
    weight = weight.reshape(len(chosen), len(PHASES) * len(grid.displacement))
    held_weight, held_values = _holds(recording, grid, discard)
    weight, values = np.concatenate([weight, held_weight]), np.concatenate([values, held_values])
    place = np.concatenate([np.tile(offset[chosen], len(PHASES)), np.zeros(held_weight.shape)])
    return _local_lines(weight, place, values).T.ravel()


def scan_observables(recording: Recording, numbers: "Sequence[int] | Ints", material: Material) -> Floats:
    """(scans, observables) of the scans with these numbers; NaN for observables that a scan does not determine."""
    scans = recording.scans
    values = np.full((len(numbers), len(observables())), np.nan)
    top = scans.top_force[numbers]
    values[:, 0] = np.log(np.where(top > 0, top, np.nan))
    contacts = [scans.contacts[number] for number in numbers]
    with_contacts = [k for k, one in enumerate(contacts) if len(one) >= MIN_CONTACTS and not np.isnan(one.force[0, 0])]
    with_positions = [k for k in with_contacts if len(scans.position[numbers[k]])]
    seen = {"contacts": SeenScans(recording, [numbers[k] for k in with_contacts], material)}
    seen["positions"] = (seen["contacts"] if with_contacts == with_positions
                         else SeenScans(recording, [numbers[k] for k in with_positions], material))
    seen["grains"], with_grains = _grains_alone(recording, numbers, material)
    rows, column = {"contacts": with_contacts, "positions": with_positions, "grains": with_grains}, 1
    with np.errstate(divide="ignore", invalid="ignore"):
        for group in groups():
            needs, width = group.observables[0].needs, len(group.observables)
            if rows[needs]:
                found = group.function(seen[needs])
                values[rows[needs], column:column + width] = np.column_stack(found if isinstance(found, tuple) else (found,))
            column += width
    return values


def _grains_alone(recording: Recording, numbers: "Sequence[int] | Ints", material: Material) -> tuple[SeenScans, list[int]]:
    """The scans of which grains are compared without their forces, with the contacts of touching.py, and their places in `numbers`."""
    scans, how = recording.scans, material.grains_alone
    rows = [k for k, number in enumerate(numbers) if how and len(scans.position[number]) and (not how.listed or len(scans.contacts[number]))]
    touching = with_hertz_contacts(recording, [int(numbers[k]) for k in rows], material)
    rows = [k for k in rows if len(touching.scans.contacts[numbers[k]]) >= MIN_CONTACTS]
    return SeenScans(touching, [int(numbers[k]) for k in rows], material), rows


def _holds(recording: Recording, grid: Grid, discard: int) -> tuple[Floats, Floats]:
    """(holds, phases x displacements) weights, and (holds, observables) values."""
    scans, places = recording.scans, len(grid.displacement)
    weights, values = [], []
    for hold in grid.holds:
        if hold.end >= len(scans) or hold.begin == hold.end or scans.cycle[hold.end] < discard:
            continue
        value, force = np.full(len(observables()), np.nan), scans.top_force
        if hold.keep == "force":
            value[index_of("creep")] = (scans.plate_z[hold.begin] - scans.plate_z[hold.end]) / grid.stroke
        elif force[hold.begin] > 0 and force[hold.end] > 0:
            value[index_of("relaxation")] = np.log(force[hold.begin] / force[hold.end])
        nearest = int(np.argmin(np.abs(np.array(grid.displacement) - hold.displacement)))
        weights.append(np.eye(len(PHASES) * places)[nearest + (0 if hold.phase == Phase.load else places)])
        values.append(value)
    return (np.array(weights).reshape(len(weights), len(PHASES) * places), np.array(values).reshape(len(values), len(observables())))


def _local_lines(weight: Floats, place: Floats, values: Floats) -> Floats:
    """(lines, observables): the weighted straight lines through `values` (scans, observables) at place 0; `weight` and `place` of each scan on
    each line (scans, lines)."""
    known = np.isfinite(values)
    finite, known = np.where(known, values, 0), known.astype(float)
    n, x, xx = weight.T @ known, (weight * place).T @ known, (weight * place * place).T @ known
    y, xy = weight.T @ finite, (weight * place).T @ finite
    determinant = n * xx - x * x
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = np.where(np.abs(x / n) < NEAR, y / n, np.nan)
        line = np.where(determinant > LEAST_SPREAD * n * n, (xx * y - x * xy) / determinant, mean)
    return np.where(n > LEAST_WEIGHT, line, np.nan)


def compared_forces(recording: Recording) -> tuple[list[float], int]:
    """Displacements where forces on the plate are compared, while loading and unloading [m], and the number of these places with a force
    above 0."""
    grid = grid_of(recording)
    return grid.displacement, int(np.isfinite(observe(recording, grid, Material())).sum())
