"""The scaling law F ~ <Z><phi><b><f> between the force on the plate and averages over the packing."""
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..results.names import Phase
from .estimate import Estimate, not_available
from .levels import Levels, by_replica, level_means, top_force


@dataclass(frozen=True)
class ScalingPoint:
    """One level: the product of averages over cycles."""

    phase: Phase
    displacement: float  # [m]
    top_force: Estimate  # F [N]
    product: Estimate  # <Z><phi><b><f> [N m]


@dataclass(frozen=True)
class ScalingFit:
    """F = coefficient * product, by least squares through the origin."""

    coefficient: float = not_available  # [1/m]
    r_squared: float = not_available  # 1 - residual / scatter about the mean force
    # With F = a x + b x^2 fitted through the origin: the contribution b x^2 / (a x + b x^2) of the square at the largest
    # product. 0: linear; positive: superlinear.
    curvature: float = not_available
    points: int = 0


def scaling_points(levels: Levels) -> list[ScalingPoint]:
    """Levels with all factors known."""
    product = (by_replica(levels, lambda one: one.scans.coordination_number) * by_replica(levels, lambda one: one.scans.packing_fraction)
               * by_replica(levels, lambda one: one.scans.branch_length) * by_replica(levels, lambda one: one.scans.mean_force))
    return [ScalingPoint(force.phase, force.displacement, force.mean, factors.mean)
            for force, factors in zip(level_means(levels, top_force), level_means(levels, product), strict=True)
            if force.mean.available() and factors.mean.available()]


def fit_scaling(points: Sequence[ScalingPoint], phase: Phase | None = None) -> ScalingFit:
    """Of the points of one phase, or of all."""
    chosen = [point for point in points if phase is None or point.phase == phase]
    x = np.array([point.product.value for point in chosen])
    force = np.array([point.top_force.value for point in chosen])
    if not len(x) or not x.max() > 0:
        return ScalingFit(points=len(x))
    coefficient = float((x * force).sum() / (x**2).sum())
    spread = float(((force - force.mean()) ** 2).sum())
    r_squared = 1 - float(((force - coefficient * x) ** 2).sum()) / spread if spread > 0 else not_available
    curvature = not_available
    if len(x) >= 3:
        scaled = x / x.max()
        part = np.linalg.lstsq(np.column_stack([scaled, scaled**2]), force, rcond=None)[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            curvature = float(part[1] / part.sum())
    return ScalingFit(coefficient, r_squared, curvature, len(x))
