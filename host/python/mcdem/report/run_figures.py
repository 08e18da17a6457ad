"""The figures of the paper for runs: top force, force distribution at one level, Z after thresholding, scaling law; and those of
programmes (programme_figures.py)."""
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..observe.contact_forces import contact_forces
from ..observe.coordination import Coordination, reference_coordination
from ..observe.force_distribution import ForceDensity, bin_count, force_density
from ..observe.levels import Level, LevelMean, level_means, top_force
from ..observe.scaling import fit_scaling, scaling_points
from ..results import Phase
from .figure_data import FigureData, FigureOptions, Series
from .figure_values import Curve, FigureSeries, RunFigure
from .programme_figures import programme_figures

MM, MN, MN_M = 1e-3, 1e-3, 1e-3


@dataclass(frozen=True)
class RunFigures:
    """`missing` says what has no figure, and why: "the force distribution: no contacts were recorded"."""
    figures: tuple[RunFigure, ...]
    missing: tuple[str, ...]


def run_figures(data: FigureData, options: FigureOptions) -> RunFigures:
    if not data.simulated:
        return RunFigures((), ("any quantity: no scans are left after the discarded cycles",))
    figures: list[RunFigure] = programme_figures(data) if any(one.is_programme for one in data.simulated) else []
    if all(one.is_programme for one in data.simulated):
        return RunFigures(tuple(figures), ())
    missing = []
    for figure, why in ((_top_force(data), "the top force: it was not recorded"),
                        (_distribution(data, options), "the force distribution: no contacts were recorded"),
                        (_coordination(data, options), "Z: contacts per grain were not recorded"),
                        (_scaling(data), "the scaling law: averages over the packing were not recorded")):
        if figure.series:
            figures.append(figure)
        else:
            missing.append(why)
    return RunFigures(tuple(figures), tuple(missing))


def is_thresholded(data: FigureData, options: FigureOptions) -> bool:
    """Whether Z ignores weak forces."""
    return any(_threshold_of(series, options) is not None for series in data.simulated)


def _figure(data: FigureData, name: str, x_label: str, y_label: str, make: Callable[[Series], FigureSeries]) -> RunFigure:
    """Of the series that have levels and curves."""
    made = [make(series) for series in data.everyone if not series.is_programme]
    return RunFigure(name, x_label, y_label, [one for one in made if one.curves])


def _curves(means: Sequence[LevelMean]) -> list[Curve]:
    """Of the known levels. Unloading starts at the turning point, the last level of loading, which is then last."""
    means = [level for level in means if level.mean.available()]
    of = {phase: [(level.displacement / MM, level.mean.value, level.mean.standard_error) for level in means if level.phase == phase]
          for phase in Phase}
    load, unload = of[Phase.load], of[Phase.unload]
    if load and unload and load[-1][0] > unload[-1][0]:
        unload.append(load[-1])
    return [Curve(phase, tuple(points)) for phase, points in of.items() if points]


def _top_force(data: FigureData) -> RunFigure:
    def make(series: Series) -> FigureSeries:
        ratio = series.comparison and series.comparison.Rtop
        remark = f"Rtop {ratio.value:.2f}" if ratio and ratio.available() else ""
        return series.shown(remark, _curves(level_means(series.levels, top_force)))

    return _figure(data, "top_force", "plate displacement [mm]", "top force [N]", make)


def _nearest_level(series: Series, displacement: float, phase: Phase) -> Level | None:
    """The level with contacts nearest to the displacement in this phase, if there is one."""
    known = [level for level in series.levels if level.phase == phase
             and any(len(one.scans.contacts[row]) for one, rows in zip(level.replicas, level.scans, strict=True) for row in rows)]
    return known[int(np.argmin([abs(level.displacement - displacement) for level in known]))] if known else None


def _shown_phase(data: FigureData, displacement: float) -> Phase:
    """Unloading, unless the first series was loaded nearer to the displacement, as at the turning point."""
    load, unload = (_nearest_level(series, displacement, phase) for series in data.everyone[:1] for phase in Phase)
    alike = 1e-6  # [m]
    if load and unload and abs(load.displacement - displacement) < abs(unload.displacement - displacement) - alike:
        return Phase.load
    return Phase.unload


def _shown_levels(data: FigureData, displacement: float) -> list[tuple[Series, Level]]:
    """In one phase; in the other one if this one has no contacts, as unloading of runs that stopped early."""
    phase = _shown_phase(data, displacement)
    shown = ((series, _nearest_level(series, displacement, phase) or _nearest_level(series, displacement, Phase(1 - phase)))
             for series in data.everyone)
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


def _distribution(data: FigureData, options: FigureOptions) -> RunFigure:
    shown = _shown_levels(data, options.distribution_displacement)
    densities = _densities([level for _, level in shown])
    series = []
    for (one, level), density in zip(shown, densities, strict=bool(densities)):
        points = tuple((force / MN, mean.value * MN, mean.standard_error * MN)
                       for force, mean in zip(density.force, density.density, strict=True)
                       if mean.value > 0)  # the logarithm of an empty bin cannot be drawn
        if points:
            series.append(one.shown("", [Curve(level.phase, points)]))
    return RunFigure("force_distribution", "contact force f [mN]", "density p(f) [1/mN]", series,
                     displacement=shown[0][1].displacement / MM if densities else None)


def _threshold_of(series: Series, options: FigureOptions) -> float | None:
    """Force threshold of Z [N], if weaker forces are left out."""
    if series.comparison:
        return series.comparison.tau.value if series.comparison.tau.available() else None
    return options.threshold if options.threshold > 0 else None


def _coordination(data: FigureData, options: FigureOptions) -> RunFigure:
    """Z of a series at its threshold; as recorded without contacts, and for the reference."""
    def make(series: Series) -> FigureSeries:
        tau = None if series.is_reference else _threshold_of(series, options)
        z = reference_coordination(series.levels, series.setting.replicas)
        counted = Coordination(series.levels, series.setting.replicas)
        if not series.is_reference and counted.known():
            z = counted.at_threshold(tau or 0)
        return series.shown("" if tau is None else f"tau {tau / MN:.2f} mN", _curves(level_means(series.levels, z)))

    return _figure(data, "coordination", "plate displacement [mm]", "contacts per grain Z", make)


def _scaling(data: FigureData) -> RunFigure:
    def make(series: Series) -> FigureSeries:
        points = scaling_points(series.levels)
        if not any(point.product.value > 0 for point in points):
            return series.shown("", ())
        of = {phase: tuple((point.product.value / MN_M, point.top_force.value, point.top_force.standard_error)
                           for point in points if point.phase == phase) for phase in Phase}
        slope = fit_scaling(points).coefficient
        return series.shown(f"{slope:.0f} /m", [Curve(phase, shown) for phase, shown in of.items() if shown], slope * MN_M)

    return _figure(data, "scaling", "⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩ [mN m]", "top force F [N]", make)
