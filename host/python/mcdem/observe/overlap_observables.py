"""Observables of the difference between implied and measured overlaps, between grains and at walls."""
import numpy as np

from ..experiment.container import apart, lengths
from ..results.names import Wall
from ..results.recording import Bools, Floats, Ints
from .observables import observed
from .seen_scans import SeenScans
from .touching import near_grains

CLEAR_OVERLAP = 0.02  # over R*; smaller ones are not significant compared with errors of positions
ROWS_PER_TERM = 5  # a regression with fewer has no result


@observed("positions",
          ("gap_contacts", 0.005, "grains", "weak", "contacts per grain between spheres that do not overlap"),
          ("silent_overlaps", 0.005, "grains", "weak", "overlapping pairs without a listed contact, per grain"))
def contact_occurrence(seen: SeenScans) -> tuple[Floats, Floats]:
    grains, count = ~seen.is_wall, len(seen.diameter)
    gaps = seen.count(grains & (seen.residuals.measured < 0))
    scan, i, j = _overlapping(seen)
    listed = _key(seen.scan[grains], seen.grain[grains], seen.partner[grains], count)
    silent = np.bincount(scan[~np.isin(_key(scan, i, j, count), listed)], minlength=len(seen))
    return gaps / count, silent / count


def _key(scan: Ints, i: Ints, j: Ints, count: int) -> Ints:
    """One number for each pair of grains in a scan."""
    key: Ints = (scan * count + np.minimum(i, j)) * count + np.maximum(i, j)
    return key


def _overlapping(seen: SeenScans) -> tuple[Ints, Ints, Ints]:
    """Scan and grains of all pairs that overlap clearly."""
    scan, i, j = near_grains(seen.box, seen.position, float(seen.diameter.max()))
    a, b = seen.diameter[i], seen.diameter[j]
    reach = 0.5 * (a + b) - CLEAR_OVERLAP * 0.5 * a * b / (a + b)
    near = lengths(apart(seen.box, seen.position[scan, i], seen.position[scan, j])) < reach
    return scan[near], i[near], j[near]


def _regression(seen: SeenScans, terms: Floats, values: Floats, where: Bools) -> Floats:
    """(S, terms) coefficients of the least-squares fit of `values` (C,) by `terms` (C, terms) for each scan; NaN with too few contacts."""
    scan, terms, values = seen.scan[where], terms[where], values[where]
    of_scan = np.split(np.arange(len(scan)), np.cumsum(np.bincount(scan, minlength=len(seen)))[:-1])
    fits = np.full((len(seen), terms.shape[1]), np.nan)
    for number, rows in enumerate(of_scan):
        if len(rows) >= ROWS_PER_TERM * terms.shape[1]:
            x = terms[rows]
            products, right = x.T @ x, x.T @ values[rows]
            if np.isfinite(products).all() and np.isfinite(right).all():
                fits[number] = np.linalg.lstsq(products, right, rcond=None)[0]
    return fits


@observed("positions",
          ("overlap_offset", 0.0005, "grains", "", "implied minus measured overlap of grains, at zero force"),
          ("overlap_slope", 0.003, "grains", "", "change of implied minus measured overlap of grains with the implied overlap"),
          ("overlap_curvature", 0.02, "grains", "strong",
           "change of implied minus measured overlap of grains with the square of the implied overlap"),
          ("cross_contact", 0.005, "grains", "",
           "change of implied minus measured overlap of grains with the surface displacement by the other contacts"),
          ("overlap_scatter", 0.0003, "grains", "", "standard deviation over contacts of the residuals of this regression"),
          ("grain_scatter", 0.0005, "grains", "", "standard deviation over grains of their mean residual"),
          ("grain_scatter_slope", 0.0005, "grains", "", "standard deviation over grains of the slope of their residuals with the overlap"))
def grain_overlaps(seen: SeenScans) -> tuple[Floats, ...]:
    contacts, grains = seen.residuals, ~seen.is_wall
    terms = np.column_stack([np.ones(len(seen.scan)), contacts.implied, contacts.implied**2, contacts.cross_contact])
    fit = _regression(seen, terms, contacts.residual, grains)
    remainder = contacts.residual - np.einsum("ij,ij->i", terms, fit[seen.scan])
    mean_overlap = seen.mean(np.abs(contacts.implied), grains)  # contacts that pull have negative ones
    return *fit.T, np.sqrt(seen.mean(remainder**2, grains)), *_shared(seen, remainder, mean_overlap)


def _shared(seen: SeenScans, remainder: Floats, mean_overlap: Floats) -> tuple[Floats, Floats]:
    """Root of the mean product of the residuals of two contacts of one grain, and the same with residual times overlap; negative where the
    mean is."""
    grains, shape = ~seen.is_wall, (len(seen), len(seen.diameter))
    owner = np.concatenate([seen.of_grain(seen.grain)[grains], seen.of_grain(seen.partner)[grains]])

    def of_grains(values: Floats | None = None) -> Floats:
        weights = np.ones(len(owner)) if values is None else np.tile(values[grains], 2)
        return np.bincount(owner, weights, shape[0] * shape[1]).astype(float).reshape(shape)

    number = of_grains()
    pairs = (number * (number - 1)).sum(axis=1)
    scaled: Floats = remainder * (seen.residuals.implied / mean_overlap[seen.scan] - 1)
    products = [(of_grains(values) ** 2 - of_grains(values**2)).sum(axis=1) / np.where(pairs > 0, pairs, np.nan) for values in (remainder, scaled)]
    first, second = (np.copysign(np.sqrt(np.abs(product)), product) for product in products)
    return first, second


@observed("positions",
          ("side_overlap_offset", 0.0005, "sides", "", "implied minus measured overlap at the side walls, at zero force"),
          ("side_overlap_slope", 0.003, "sides", "", "change of implied minus measured overlap at the side walls with the implied overlap"),
          ("floor_overlap_offset", 0.0005, "floor", "", "implied minus measured overlap at the floor, mean"),
          ("plate_overlap_offset", 0.0005, "plate", "", "implied minus measured overlap at the plate, mean"),
          ("plate_overlap_tilt_x", 0.0005, "plate", "",
           "slope along x of implied minus measured overlap at the plate, in R over half the box"),
          ("plate_overlap_tilt_y", 0.0005, "plate", "",
           "slope along y of implied minus measured overlap at the plate, in R over half the box"))
def wall_overlaps(seen: SeenScans) -> tuple[Floats, ...]:
    contacts = seen.residuals
    values, one = contacts.residual - contacts.cross_contact, np.ones(len(seen.scan))
    sides = _regression(seen, np.column_stack([one, contacts.implied]), values, seen.at_sides)
    floor = _regression(seen, one[:, np.newaxis], values, seen.at(Wall.floor))
    across = [2 * seen.centre[:, axis] / size - 1 for axis, size in enumerate((seen.box.size_x, seen.box.size_y))]
    plate = _regression(seen, np.column_stack([one, *across]), values, seen.at(Wall.plate))
    return *sides.T, *floor.T, *plate.T
