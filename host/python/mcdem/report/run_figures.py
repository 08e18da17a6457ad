"""The figures of the paper for runs: top force, force distribution at one level, Z after thresholding, scaling law. Those of programmes
are in programme_figures.py.

A figure is one function: what it returns is drawn on pages and as a picture, and is in figures.json.
"""
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..observe.contact_forces import contact_forces
from ..observe.coordination import Coordination, reference_coordination
from ..observe.force_distribution import ForceDensity, bin_count, force_density
from ..observe.levels import Level, LevelMean, level_means
from ..observe.levels import top_force as recorded_top_force
from ..observe.replicas import Setting
from ..observe.scaling import fit_scaling, scaling_points
from ..results import Phase
from . import programme_figures  # noqa: F401  defines its figures, which come first
from .figure_data import FigureData, FigureOptions, Series, figure_data
from .figure_values import DEFINITIONS, Curve, Drawing, FigureSeries, Hover, Kind, RunFigure, run_figure

MM, MN, MN_M = 1e-3, 1e-3, 1e-3


@dataclass(frozen=True)
class RunFigures:
    """`missing` says what has no figure, and why: "the force distribution: no contacts were recorded"."""
    figures: list[RunFigure]
    missing: list[str]


def run_figures(settings: Sequence[Setting], reference: Setting | None = None, options: FigureOptions = FigureOptions()) -> RunFigures:
    """All figures that the runs have data for."""
    data = figure_data(settings, reference, options)
    if not data.simulated:
        return RunFigures([], ["any quantity: no scans are left after the discarded cycles"])
    made = [(replace(one.make(data), name=name, drawing=one.drawing), one.missing) for name, one in DEFINITIONS.items()]
    has_strokes = not all(series.is_programme for series in data.simulated)
    return RunFigures([figure for figure, _ in made if figure.series],
                      [missing for figure, missing in made if missing and has_strokes and not figure.series])


@run_figure(Drawing(Kind.phases, "xy", "xy", "upper left", hover=Hover("%{x:.2f} mm", "%{y:.4g} N", " ± %{customdata:.2g} N")),
            "the top force: it was not recorded")
def top_force(data: FigureData) -> RunFigure:
    """Force on the plate. Solid lines: loading, dashed: unloading; points: the reference, filled and open."""
    def make(series: Series) -> FigureSeries:
        ratio = series.comparison and series.comparison.Rtop
        remark = f"Rtop {ratio.value:.2f}" if ratio and ratio.available() else ""
        return FigureSeries(series, curves_of(level_means(series.levels, recorded_top_force)), remark)

    return RunFigure("Force on the plate", "plate displacement [mm]", "top force [N]", _each(data, make))


@run_figure(Drawing(Kind.level, "x", hover=Hover("%{x:.4g} mN", "%{y:.3g} per mN", " ± %{customdata:.2g}")),
            "the force distribution: no contacts were recorded")
def force_distribution(data: FigureData) -> RunFigure:
    """Density of contact forces at one level of compression, which the legend names; bands: one standard error over replicas."""
    shown = _shown_levels(data.strokes, data.options.distribution_displacement)
    made = []
    for (series, level), density in zip(shown, _densities([level for _, level in shown])):
        points = tuple((force / MN, mean.value * MN, mean.standard_error * MN)
                       for force, mean in zip(density.force, density.density, strict=True)
                       if mean.value > 0)  # the logarithm of an empty bin cannot be drawn
        if points:
            made.append(FigureSeries(series, (Curve(level.phase, points),)))
    displacement, words = (shown[0][1].displacement / MM, f"{made[0].curves[0].phase.name}ing") if made else (0, "")
    return RunFigure(f"Contact forces at {displacement:.1f} mm, {words}", "contact force f [mN]", "density p(f) [1/mN]", made,
                     "Probability density of the contact forces between grains, at one plate displacement.", displacement)


@run_figure(Drawing(Kind.phases, "x", remarks=True, hover=Hover("%{x:.2f} mm", "Z = %{y:.3f}", " ± %{customdata:.2g}")),
            "Z: contacts per grain were not recorded")
def coordination(data: FigureData) -> RunFigure:
    """Contacts per grain, without forces below tau if there is a reference; as recorded where there are no contacts, and for the
    reference. Lines and points as in `top_force`."""
    def make(series: Series) -> FigureSeries:
        tau = None if series.is_reference else _threshold_of(series, data.options)
        z = reference_coordination(series.levels, series.setting.replicas)
        counted = Coordination(series.levels, series.setting.replicas)
        if not series.is_reference and counted.known():
            z = counted.at_threshold(tau or 0)
        return FigureSeries(series, curves_of(level_means(series.levels, z)), "" if tau is None else f"tau {tau / MN:.2f} mN")

    is_thresholded = any(_threshold_of(series, data.options) is not None for series in data.simulated)
    return RunFigure("Contacts per grain" + (", weak forces left out" if is_thresholded else ""), "plate displacement [mm]",
                     "contacts per grain Z", _each(data, make))


@run_figure(Drawing(Kind.points, "xy", "xy", "upper left", hover=Hover("%{x:.4g} mN m", "%{y:.4g} N", " ± %{customdata:.2g} N")),
            "the scaling law: averages over the packing were not recorded")
def scaling(data: FigureData) -> RunFigure:
    """Top force against averages over the packing. Filled points: loading, open: unloading; lines through the origin are fitted to both."""
    def make(series: Series) -> FigureSeries:
        points = scaling_points(series.levels)
        if not any(point.product.value > 0 for point in points):
            return FigureSeries(series, ())
        of = {phase: tuple((point.product.value / MN_M, point.top_force.value, point.top_force.standard_error)
                           for point in points if point.phase == phase) for phase in Phase}
        slope = fit_scaling(points).coefficient
        return FigureSeries(series, tuple(Curve(phase, shown) for phase, shown in of.items() if shown), f"{slope:.0f} /m", slope * MN_M)

    return RunFigure("Scaling law F ∝ ⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩", "⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩ [mN m]", "top force F [N]", _each(data, make))


def _each(data: FigureData, make: Callable[[Series], FigureSeries]) -> list[FigureSeries]:
    """Of the series that have levels and curves."""
    return [one for one in map(make, data.strokes) if one.curves]


def curves_of(means: Sequence[LevelMean]) -> tuple[Curve, ...]:
    """Of the known levels. Unloading starts at the turning point, the last level of loading, which is then last."""
    load, unload = ([(level.displacement / MM, level.mean.value, level.mean.standard_error) for level in means
                     if level.phase == phase and level.mean.available()] for phase in Phase)
    if load and unload and load[-1][0] > unload[-1][0]:
        unload.append(load[-1])
    return tuple(Curve(phase, tuple(points)) for phase, points in zip(Phase, (load, unload)) if points)


def _nearest_level(series: Series, displacement: float, phase: Phase) -> Level | None:
    """The level with contacts nearest to the displacement in this phase, if there is one."""
    known = [level for level in series.levels if level.phase == phase
             and any(len(one.scans.contacts[row]) for one, rows in zip(level.replicas, level.scans, strict=True) for row in rows)]
    return min(known, key=lambda level: float(abs(level.displacement - displacement))) if known else None


def _shown_levels(strokes: Sequence[Series], displacement: float) -> list[tuple[Series, Level]]:
    """Of unloading, unless the first series was loaded nearer to the displacement, as at the turning point; of the other phase for series
    that have no contacts in this one, as unloading of runs that stopped early."""
    load, unload = (_nearest_level(series, displacement, phase) for series in strokes[:1] for phase in Phase) if strokes else (None, None)
    alike = 1e-4 * (load.displacement if load else 0)  # of rounding
    is_loading = load and unload and abs(load.displacement - displacement) < abs(unload.displacement - displacement) - alike
    phase = Phase.load if is_loading else Phase.unload
    shown = ((series, _nearest_level(series, displacement, phase) or _nearest_level(series, displacement, Phase(1 - phase)))
             for series in strokes)
    return [(series, level) for series, level in shown if level]


def _densities(levels: Sequence[Level]) -> list[ForceDensity]:
    """In common bins up to a force that few contacts exceed; their number follows from the smallest sample. Empty without data."""
    largest, count = 0.0, 100
    for level in levels:
        forces = np.sort(np.concatenate([contact_forces(replica, rows).grain_grain
                                         for replica, rows in zip(level.replicas, level.scans, strict=True)]))
        if len(forces):
            largest = max(largest, float(forces[(len(forces) - 1) * 999 // 1000]))
            count = min(count, int(np.clip(bin_count(len(forces), len(forces)), 8, 30)))
    return [force_density(level, count, largest) for level in levels] if largest > 0 else []


def _threshold_of(series: Series, options: FigureOptions) -> float | None:
    """Force threshold of Z [N], if weaker forces are left out."""
    if series.comparison:
        return series.comparison.tau.value if series.comparison.tau.available() else None
    return options.threshold if options.threshold > 0 else None
