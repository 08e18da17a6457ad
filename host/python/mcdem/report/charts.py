"""Charts of runs as plotly.py's figures, of the values that pictures for print are drawn of too (figure_values.py).

Colours may be those of the page's theme, "var(--ink)".
"""
from collections.abc import Iterator
from typing import Any

import numpy as np
import plotly.graph_objects as go

from ..results import Phase
from .figure_values import Curve, FigureSeries, Hover, Kind, RunFigure
from .labels import one_line
from .page import Chart

LOG_AXIS = {"type": "log", "dtick": "D2", "exponentformat": "power"}
CAPTIONS = {Kind.phases: "Solid lines: loading, dashed: unloading.", Kind.path: "Scans in order of time.",
            Kind.points: "Filled points: loading, open: unloading; lines through the origin are fitted to both."}


def plot_text(text: str) -> str:
    """Escapes a text for places in which plotly.js interprets tags and entities."""
    return one_line(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def titled(text: str) -> dict[str, Any]:
    return {"title": {"text": text}}


def from_zero(text: str) -> dict[str, Any]:
    return {**titled(text), "rangemode": "tozero"}


def run_chart(figure: RunFigure) -> Chart:
    """The figure with its title and caption."""
    drawing = figure.drawing
    axes = {f"{axis}axis": from_zero(label) if axis in drawing.from_zero else titled(label)
            for axis, label in (("x", figure.x_label), ("y", figure.y_label))}
    if drawing.kind is Kind.level:
        axes["yaxis"] |= LOG_AXIS
    traces = [trace for series in figure.series for trace in _traces(figure, series)]
    return Chart(figure.name, figure.title, _caption(figure), go.Figure(traces, axes), drawing.log_axes)


def _caption(figure: RunFigure) -> str:
    """Meaning of lines, points and bands, and the figure's own words."""
    kind, words = figure.drawing.kind, [CAPTIONS.get(figure.drawing.kind, ""), figure.caption]
    if kind is Kind.phases and any(series.of.is_reference for series in figure.series):
        words.append("Points: the reference, filled: loading, open: unloading.")
    if kind is not Kind.points and any(len(series.of.setting.replicas) > 1 for series in figure.series):
        words.append(f"{'Bands and bars' if kind is Kind.phases else 'Bands'}: one standard error over replicas.")
    return " ".join(filter(None, words))


def _hover(figure: RunFigure) -> Hover:
    """By default four digits and the units of the axes' labels."""
    x, y = (label.partition("[")[2].rstrip("]") for label in (figure.x_label, figure.y_label))
    return figure.drawing.hover or Hover(*(f"{format} {unit}".rstrip() for format, unit in (
        ("%{x:.4g}", x), ("%{y:.4g}", y), (" ± %{customdata:.2g}", y))))


def _traces(figure: RunFigure, series: FigureSeries) -> Iterator[go.Scatter]:
    """All curves of a series come and go with the first one's entry in the legend."""
    kind, hover = figure.drawing.kind, _hover(figure)
    words = plot_text(", ".join(filter(None, (series.of.words, series.remark if figure.drawing.remarks else ""))))
    colour = "var(--ink)" if series.of.is_reference else series.of.style.colour
    for number, curve in enumerate(series.curves):
        loads = curve.phase == Phase.load or kind in (Kind.level, Kind.path)
        x_words = f"{hover.x}, {curve.phase.name}ing" if kind is Kind.phases else hover.x
        yield from _curve_traces(curve, words, colour, series.of.is_reference or kind is Kind.points, loads,
                                 hover._replace(x=x_words), number == 0)
    if kind is Kind.points:
        end = max(0, *(point[0] for curve in series.curves for point in curve.points))
        ends = np.array([end / 1000, end])  # not zero: that has no logarithm
        yield go.Scatter(mode="lines", x=ends, y=series.slope * ends, line={"color": colour, "width": 1}, name=words, legendgroup=words,
                         showlegend=False, hovertemplate=f"slope {series.slope * 1e3:.4g} /m")


def _curve_traces(curve: Curve, words: str, colour: str, is_points: bool, loads: bool, hover: Hover, in_key: bool) -> Iterator[go.Scatter]:
    """A band of one standard error where it is known, and the line or the points over it."""
    x, y, error = np.array(curve.points).T
    has_errors = len(x) > 1 and bool(np.isfinite(error).all())
    if has_errors and not is_points:
        low = np.where(y > 0, np.maximum(y - error, y / 3), y - error)  # positive, for logarithmic axes
        yield go.Scatter(mode="lines", name=f"{words} ± standard error", x=np.append(x, x[::-1]), y=np.append(y + error, low[::-1]),
                         fill="toself", fillcolor=_faint(colour), line={"width": 0}, hoverinfo="skip", legendgroup=words, showlegend=False)
    yield go.Scatter(
        mode="markers" if is_points else "lines+markers", name=words, x=x, y=y, legendgroup=words, showlegend=in_key,
        hovertemplate=f"{hover.x}<br>{hover.y}{hover.error if has_errors else ''}",
        marker={"color": colour, "size": 7 if is_points else 4, "symbol": "circle" if loads or not is_points else "circle-open"},
        customdata=error if has_errors else None,
        line=None if is_points else {"color": colour, "width": 2, "dash": "solid" if loads else "dash"},
        error_y={"type": "data", "array": error, "width": 2, "thickness": 1} if has_errors and is_points else None)


def _faint(colour: str) -> str:
    """ "#rrggbb" as a light fill; the colour of text is not changed."""
    red, green, blue = (int(colour[at:at + 2], 16) for at in (1, 3, 5)) if colour.startswith("#") else (0, 0, 0)
    return f"rgba({red},{green},{blue},0.18)" if colour.startswith("#") else "var(--grid)"
