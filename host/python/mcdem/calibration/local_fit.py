"""A line or parabola through the points near a root, and its crossing with a target."""
import math
from dataclasses import dataclass

import numpy as np

from ..results.recording import Floats

POINTS_FOR_PARABOLA = 6


@dataclass(frozen=True)
class Crossing:
    """Where a fit rises through the target; all NaN if it does not in the window."""

    x: float = math.nan
    standard_error: float = math.nan  # from the scatter about the fit; NaN with too few points
    slope: float = math.nan  # dy/dx there


def crossing_of_fit(x: Floats, y: Floats, low: float, high: float, target: float) -> Crossing:
    """Least squares over the points with low <= x <= high: a parabola for six or more points, otherwise a line."""
    middle, half = (low + high) / 2, (high - low) / 2
    inside = (x >= low) & (x <= high)
    count = int(inside.sum())
    if count < 2:
        return Crossing()
    terms = 3 if count >= POINTS_FOR_PARABOLA else 2
    powers: Floats = np.vander((x[inside] - middle) / half, terms, increasing=True)
    gap: Floats = y[inside] - target
    coefficients = _least_squares(powers, gap)
    t = _rising_zero(coefficients)
    if math.isnan(t):
        return Crossing()
    residuals = gap - powers @ coefficients
    scatter = float(residuals @ residuals) / (count - terms) if count > terms else math.nan
    at = np.array([1, t, t * t])[:terms]
    variance = scatter * float(at @ _least_squares(powers.T @ powers, at))
    slope = float(coefficients[1:] @ np.array([1, 2 * t])[:terms - 1])
    return Crossing(middle + half * t, half * math.sqrt(variance) / slope, slope / half)


def _least_squares(columns: Floats, values: Floats) -> Floats:
    return np.asarray(np.linalg.lstsq(columns, values, rcond=None)[0])


def _rising_zero(coefficients: Floats) -> float:
    """The t from -1 to 1 at which c0 + c1 t + c2 t^2 rises through zero; NaN if there is none."""
    c0, c1, c2 = map(float, [*coefficients, 0.0][:3])
    discriminant = c1 * c1 - 4 * c2 * c0
    denominator = c1 + math.sqrt(discriminant) if discriminant > 0 else 0.0
    if denominator == 0:  # also a falling line
        return math.nan
    t = -2 * c0 / denominator  # where the slope is plus the root of the discriminant
    return t if abs(t) <= 1 else math.nan


def rising_fit(values: Floats) -> Floats:
    """The increasing sequence closest to the values (pool adjacent violators, Barlow et al. 1972)."""
    blocks = list[tuple[float, int]]()  # mean and size
    for value in values.tolist():
        blocks.append((value, 1))
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            (before, size), (last, more) = blocks[-2:]
            blocks[-2:] = [((before * size + last * more) / (size + more), size + more)]
    return np.repeat([mean for mean, _ in blocks], [size for _, size in blocks])
