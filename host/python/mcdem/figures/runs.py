"""Draws the figures of runs that mcdem.report.run_figures defines: lines for simulations, points for the reference."""
from collections.abc import Callable
from typing import Any

import matplotlib.patches
import numpy as np

from ..report.figure_values import DEFINITIONS, Drawing, Kind
from ..report.run_figures import run_figures  # noqa: F401  defines them
from .style import GREY, Entry, key, keyed_axes, line, styled
from .values import Source, read

Values = dict[str, Any]

SIMULATED: dict[str, Values] = {"load": {"linestyle": "-"}, "unload": {"linestyle": (0, (4, 2))}}
REFERENCE: dict[str, Values] = {"load": {}, "unload": {"markerfacecolor": "white"}}
PHASES = {"load": "loading", "unload": "unloading"}


def figure_function(name: str) -> Callable[..., Any]:
    """The function that draws the figure of this name of a folder or figures.json, into `axes` or new ones."""
    @styled
    def draw(source: Source, axes: Any = None) -> Any:
        return draw_curves(read(source, name), DEFINITIONS[name].drawing, axes)

    draw.__name__, draw.__qualname__, draw.__doc__ = name, name, DEFINITIONS[name].meaning
    return draw


def draw_curves(values: Values, drawing: Drawing, axes: Any = None) -> Any:
    """Lines with bands or points with error bars, and a legend. Returns the axes, by default new ones."""
    kind, everything = drawing.kind, values["series"]
    if kind is Kind.phases and drawing.legend:  # order as at the ends of the curves
        everything = sorted(everything, key=lambda series: (series["is_reference"], -max(max(curve["y"]) for curve in series["curves"])))
    shown = entries(everything, kind)
    axes = axes or keyed_axes(shown, drawing.legend)
    for series in everything:
        for curve in series["curves"]:
            phase = curve["phase"] if kind in (Kind.phases, Kind.points) else "load"
            if series["is_reference"] or kind is Kind.points:
                draw_points(axes, series, curve, REFERENCE[phase], **({"markersize": 2.2} if kind is Kind.points else {}))
            else:
                draw_line(axes, series, curve, SIMULATED[phase], **({"marker": "o", "markersize": 1.6} if kind is Kind.path else {}))
        if "slope" in series:
            end = max(max(curve["x"]) for curve in series["curves"])
            axes.plot([0, end], [0, series["slope"] * end], color=series["colour"], linewidth=0.7)
    axes.set(xlabel=values["x_label"], ylabel=values["y_label"])
    set_limits(axes, everything, drawing)
    legend = key(axes, shown, drawing.legend)
    if kind is Kind.level:
        axes.set_yscale("log")
        heading = f"at {values['displacement_mm']:.1f} mm, {PHASES[everything[0]['curves'][0]['phase']]}"
        legend.set_title(heading, prop={"size": axes.xaxis.label.get_size()})
    return axes


def set_limits(axes: Any, everything: list[Values], drawing: Drawing) -> None:
    """Zero is the end of axes that begin there, but for negative values of a programme, and for its forces and stresses."""
    is_path = drawing.kind is Kind.path
    if "x" in drawing.from_zero and not (is_path and any(x < 0 for series in everything for curve in series["curves"] for x in curve["x"])):
        axes.set_xlim(left=0)
    if "y" in drawing.from_zero and not is_path:
        axes.set_ylim(bottom=0)


def draw_line(axes: Any, series: Values, curve: Values, phase: Values, **look: Any) -> None:
    x, y, error = numbers(curve)
    axes.plot(x, y, color=series["colour"], **phase, **look)
    if np.isfinite(error).any():
        low = np.where(y > 0, np.maximum(y - error, y / 3), y - error)  # keeps the band positive on logarithmic axes
        axes.fill_between(x, low, y + error, color=series["colour"], alpha=0.18, linewidth=0)


def draw_points(axes: Any, series: Values, curve: Values, phase: Values, **look: Any) -> None:
    x, y, error = numbers(curve)
    bars = error if np.isfinite(error).any() else None
    axes.errorbar(x, y, bars, color=series["colour"], marker=series["marker"], linestyle="", markeredgewidth=0.6,
                  elinewidth=0.6, **phase, **look)


def numbers(curve: Values) -> list[Any]:
    """x, y and standard error (NaN if unknown)."""
    return [np.array(curve[quantity], float) for quantity in ("x", "y", "standard_error")]


def entries(everything: list[Values], kind: Kind) -> list[Entry]:
    """Legend entries of the series, followed by those of lines, points and bands."""
    shown: list[Entry] = []
    for series in everything:
        is_points = series["is_reference"] or kind is Kind.points
        look = {"marker": series["marker"], "linestyle": ""} if is_points else {"linewidth": 1.8}
        shown.append((line(color=series["colour"], **look), ", ".join(filter(None, (series["words"], series["remark"])))))
    if kind is Kind.points:
        return shown + [(line(color=GREY, marker="o", linestyle="", **REFERENCE[phase]), words) for phase, words in PHASES.items()]
    points = {"load": " (points: full)", "unload": " (points: open)"} if any(series["is_reference"] for series in everything) else {}
    if kind is Kind.phases:
        shown += [(line(color=GREY, **SIMULATED[phase]), words + points.get(phase, "")) for phase, words in PHASES.items()]
    if any(series["replicas"] > 1 for series in everything):
        shown.append((matplotlib.patches.Patch(color=GREY, alpha=0.3, linewidth=0), "± standard error"))
    return shown
