"""The four figures of the paper, with or without a reference, and figures of programmes of plates and cells."""
import matplotlib.patches
import numpy as np

from .style import GREY, key, keyed_axes, line, styled
from .values import read

SIMULATED = {"load": {"linestyle": "-"}, "unload": {"linestyle": (0, (4, 2))}}
REFERENCE = {"load": {}, "unload": {"markerfacecolor": "white"}}
PHASES = {"load": "loading", "unload": "unloading"}


@styled
def top_force(source, axes=None):
    """Force on the plate. Solid lines: loading, dashed: unloading; points: the reference, filled and open."""
    values = read(source, "top_force")
    values["series"].sort(key=lambda series: (  # order of the legend as at the ends of the curves
        series["is_reference"], -max(max(curve["y"]) for curve in series["curves"])))
    axes = draw_curves(values, axes, "upper left")
    axes.set_ylim(bottom=0)
    return axes


@styled
def force_distribution(source, axes=None):
    """Density of contact forces at one level of compression, which the legend names; bands: one standard error over replicas."""
    values = read(source, "force_distribution")
    curves = [curve for series in values["series"] for curve in series["curves"]]
    phase = PHASES[curves[0]["phase"]]
    for curve in curves:
        curve["phase"] = "load"  # all of one phase: solid lines, filled points
    axes = draw_curves(values, axes, phases=())
    axes.set_yscale("log")
    axes.get_legend().set_title(f"at {values['displacement_mm']:.1f} mm, {phase}", prop={"size": axes.xaxis.label.get_size()})
    return axes


@styled
def coordination(source, axes=None):
    """Contacts per grain, without forces below tau if there is a reference. Lines and points as in `top_force`."""
    return draw_curves(read(source, "coordination"), axes)


@styled
def scaling(source, axes=None):
    """Top force against averages over the packing. Filled points: loading, open: unloading; lines through the origin are fitted to both."""
    values = read(source, "scaling")
    shown = [(line(color=series["colour"], marker=series["marker"], linestyle=""), words(series)) for series in values["series"]]
    shown += [(line(color=GREY, marker="o", linestyle="", **REFERENCE[phase]), name) for phase, name in PHASES.items()]
    axes = axes or keyed_axes(shown, "upper left")
    for series in values["series"]:
        for curve in series["curves"]:
            draw_points(axes, series, curve, markersize=2.2)
        if "slope" in series:
            end = max(max(curve["x"]) for curve in series["curves"])
            axes.plot([0, end], [0, series["slope"] * end], color=series["colour"], linewidth=0.7)
    axes.set(xlim=(0, None), ylim=(0, None), xlabel=values["x_label"], ylabel=values["y_label"])
    key(axes, shown, "upper left")
    return axes


def programme_figure(name, meaning, from_zero=True):
    """One line per setting, in order of the scans, which are marked because paths may return to earlier points."""
    @styled
    def draw(source, axes=None):
        values = read(source, name)
        is_right = all(x >= 0 for series in values["series"] for curve in series["curves"] for x in curve["x"])
        return draw_curves(values, axes, "best", phases=(), from_zero=from_zero and is_right, marker="o", markersize=1.6)

    draw.__name__, draw.__doc__ = name, meaning
    return draw


force_time = programme_figure(
    "force_time", "Force on the plate against time, scan by scan of a programme; bands: one standard error over replicas.")
displacement_time = programme_figure("displacement_time", "Displacement of the plate against time, scan by scan of a programme.")
force_displacement = programme_figure("force_displacement", "Force on the plate against its displacement, scan by scan of a programme.")
pressure_strain = programme_figure("pressure_strain", "Mean stress of a cell against its volume strain.")
shear_stress_strain = programme_figure("shear_stress_strain", "Deviatoric stress q of a cell against its deviatoric strain.")
stress_path = programme_figure("stress_path", "Deviatoric stress q against mean stress p, for cells that are distorted and for plates.")
cell_coordination = programme_figure("cell_coordination", "Contacts per grain in a cell against its packing fraction.", from_zero=False)
pressure_time = programme_figure("pressure_time", "Mean stress of a cell against time.")
volume_time = programme_figure("volume_time", "Volume strain of a cell against time.")
shear_stress_time = programme_figure("shear_stress_time", "Deviatoric stress of a cell against time.")
shear_strain_time = programme_figure("shear_strain_time", "Deviatoric strain of a cell against time.")


def draw_curves(values, axes, place=None, phases=("load", "unload"), from_zero=True, **lines):
    """Lines with bands for simulations, points with error bars for the reference, and a legend (`place` as for `key`).

    `lines`: style of the lines. Returns the axes, by default new ones.
    """
    shown = entries(values, phases)
    axes = axes or keyed_axes(shown, place)
    for series in values["series"]:
        for curve in series["curves"]:
            if series["is_reference"]:
                draw_points(axes, series, curve)
            else:
                draw_line(axes, series, curve, **lines)
    axes.set(xlabel=values["x_label"], ylabel=values["y_label"])
    if from_zero:
        axes.set_xlim(left=0)
    key(axes, shown, place)
    return axes


def draw_line(axes, series, curve, **look):
    x, y, error = numbers(curve)
    axes.plot(x, y, color=series["colour"], **SIMULATED[curve["phase"]], **look)
    if np.isfinite(error).any():
        low = np.where(y > 0, np.maximum(y - error, y / 3), y - error)  # keeps the band positive on logarithmic axes
        axes.fill_between(x, low, y + error, color=series["colour"], alpha=0.18, linewidth=0)


def draw_points(axes, series, curve, **look):
    x, y, error = numbers(curve)
    bars = error if np.isfinite(error).any() else None
    axes.errorbar(x, y, bars, color=series["colour"], marker=series["marker"], linestyle="", markeredgewidth=0.6,
                  elinewidth=0.6, **{**REFERENCE[curve["phase"]], **look})


def numbers(curve):
    """x, y and standard error (NaN if unknown)."""
    return [np.array(curve[quantity], float) for quantity in ("x", "y", "standard_error")]


def words(series):
    return ", ".join(filter(None, (series["words"], series["remark"])))


def entries(values, phases):
    """Legend entries of the series, followed by those of lines, points and bands."""
    series = values["series"]
    shown = [(line(color=one["colour"], **({"marker": "o", "linestyle": ""} if one["is_reference"] else {"linewidth": 1.8})), words(one))
             for one in series]
    has_reference = any(one["is_reference"] for one in series)
    for phase in phases:
        points = {"load": " (points: full)", "unload": " (points: open)"}[phase] if has_reference else ""
        shown.append((line(color=GREY, **SIMULATED[phase]), PHASES[phase] + points))
    if any(one["replicas"] > 1 for one in series):
        shown.append((matplotlib.patches.Patch(color=GREY, alpha=0.3, linewidth=0), "± standard error"))
    return shown
