"""Charts of runs as plotly.py's figures, of the values that pictures for print are drawn of too (figure_values.py).

Colours may be those of the page's theme, "var(--ink)".
"""
import re
from typing import Any, NamedTuple

import numpy as np
import plotly.graph_objects as go

from ..results import Phase
from .figure_values import Curve, FigureSeries, RunFigure
from .labels import one_line

SOLID, DASHED, FULL, OPEN = "solid", "dash", "full", "open"  # looks of lines and of points
LOG_AXIS = {"type": "log", "dtick": "D2", "exponentformat": "power"}


class Hover(NamedTuple):
    """What a point says when pointed at: x and y with their formats and units, and what follows y where the error is known."""
    x: str
    y: str
    error: str


def plot_text(text: str) -> str:
    """Escapes a text for places in which plotly.js interprets tags and entities."""
    return one_line(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def titled(text: str) -> dict[str, Any]:
    return {"title": {"text": text}}


def from_zero(text: str) -> dict[str, Any]:
    return {**titled(text), "rangemode": "tozero"}


def chart_figure(figure: RunFigure) -> go.Figure:
    """Of the kinds that have no function of their own, figures of programmes."""
    made = go.Figure(layout={"xaxis": from_zero(figure.x_label), "yaxis": from_zero(figure.y_label)})
    return {"top_force": _top_force, "force_distribution": _distribution, "coordination": _coordination,
            "scaling": _scaling}.get(figure.name, _programme)(figure, made)


def _colour(series: FigureSeries) -> str:
    return "var(--ink)" if series.is_reference else series.style.colour


def _faint(colour: str) -> str:
    """ "#rrggbb" as a light fill; the colour of text is not changed."""
    red, green, blue = (int(colour[at:at + 2], 16) for at in (1, 3, 5)) if colour.startswith("#") else (0, 0, 0)
    return f"rgba({red},{green},{blue},0.18)" if colour.startswith("#") else "var(--grid)"


def _curve_traces(series: FigureSeries, curve: Curve, look: str, hover: Hover, in_key: bool = True, name: str = "") -> list[go.Scatter]:
    """A band of one standard error where it is known, and the line or the points over it. `in_key`: whether it has an entry there; all
    curves of a series come and go with that."""
    x, y, error = np.array(curve.points).T
    colour, words, is_line = _colour(series), plot_text(name or series.words), look in (SOLID, DASHED)
    has_errors = len(x) > 1 and bool(np.isfinite(error).all())
    trace = go.Scatter(
        mode="lines+markers" if is_line else "markers", name=words, x=x, y=y, legendgroup=words, showlegend=in_key,
        hovertemplate=f"{hover.x}<br>{hover.y}{hover.error if has_errors else ''}",
        marker={"color": colour, "size": 4 if is_line else 7, "symbol": "circle-open" if look == OPEN else "circle"},
        customdata=error if has_errors else None, line={"color": colour, "width": 2, "dash": look} if is_line else None,
        error_y={"type": "data", "array": error, "width": 2, "thickness": 1} if has_errors and not is_line else None)
    return [_band(words, colour, x, y, error), trace] if has_errors and is_line else [trace]


def _band(words: str, colour: str, x: Any, y: Any, error: Any) -> go.Scatter:
    """On logarithmic axes it must not reach zero, so the lower edge is limited to a third of the value."""
    low = np.where(y > 0, np.maximum(y - error, y / 3), y - error)
    return go.Scatter(mode="lines", name=f"{words} ± standard error", x=np.append(x, x[::-1]), y=np.append(y + error, low[::-1]),
                      fill="toself", fillcolor=_faint(colour), line={"width": 0}, hoverinfo="skip", legendgroup=words, showlegend=False)


def _add_phases(figure: RunFigure, made: go.Figure, hover: Hover, with_remarks: bool = False) -> go.Figure:
    """Loading solid, unloading dashed; the reference as points, filled and open."""
    for series in figure.series:
        name = ", ".join(filter(None, (series.words, series.remark if with_remarks else "")))
        for number, curve in enumerate(series.curves):
            loads = curve.phase == Phase.load
            look = (FULL if loads else OPEN) if series.is_reference else SOLID if loads else DASHED
            named = hover._replace(x=hover.x + (", loading" if loads else ", unloading"))
            made.add_traces(_curve_traces(series, curve, look, named, number == 0, name))
    return made


def _top_force(figure: RunFigure, made: go.Figure) -> go.Figure:
    return _add_phases(figure, made, Hover("%{x:.2f} mm", "%{y:.4g} N", " ± %{customdata:.2g} N"))


def _distribution(figure: RunFigure, made: go.Figure) -> go.Figure:
    hover = Hover("%{x:.4g} mN", "%{y:.3g} per mN", " ± %{customdata:.2g}")
    for series in figure.series:
        made.add_traces(_curve_traces(series, series.curves[0], FULL if series.is_reference else SOLID, hover))
    made.layout.yaxis = {**titled(figure.y_label), **LOG_AXIS}
    return made


def _coordination(figure: RunFigure, made: go.Figure) -> go.Figure:
    made.layout.yaxis = titled(figure.y_label)
    return _add_phases(figure, made, Hover("%{x:.2f} mm", "Z = %{y:.3f}", " ± %{customdata:.2g}"), with_remarks=True)


def _scaling(figure: RunFigure, made: go.Figure) -> go.Figure:
    """Points of loading (filled) and unloading (open), and the line through the origin."""
    hover = Hover("%{x:.4g} mN m", "%{y:.4g} N", " ± %{customdata:.2g} N")
    for series in figure.series:
        for number, curve in enumerate(series.curves):
            made.add_traces(_curve_traces(series, curve, FULL if curve.phase == Phase.load else OPEN, hover, number == 0))
        end = max(0, *(point[0] for curve in series.curves for point in curve.points))
        ends = np.array([end / 1000, end])  # not zero: that has no logarithm
        name = plot_text(series.words)
        made.add_traces([go.Scatter(mode="lines", x=ends, y=series.slope * ends, line={"color": _colour(series), "width": 1}, name=name,
                                    legendgroup=name, showlegend=False, hovertemplate=f"slope {series.slope * 1e3:.4g} /m")])
    return made


def _programme(figure: RunFigure, made: go.Figure) -> go.Figure:
    """One line through the scans of each setting."""
    x_unit, y_unit = (" ".join(re.findall(r"\[([^[]*)\]", label)[:1]) for label in (figure.x_label, figure.y_label))
    hover = Hover(*(f"{format} {unit}".rstrip() for format, unit in (
        ("%{x:.4g}", x_unit), ("%{y:.4g}", y_unit), (" ± %{customdata:.2g}", y_unit))))
    for series in figure.series:
        made.add_traces(_curve_traces(series, series.curves[0], SOLID, hover))
    if figure.name == "cell_coordination":
        made.layout.xaxis, made.layout.yaxis = titled(figure.x_label), titled(figure.y_label)
    return made
