"""Charts of a diagnosis for pages. Colours "var(--ink)" are those of the page's present theme."""
from typing import Any

import numpy as np
import plotly.graph_objects as go

from ..diagnosis.diagnosis_types import Diagnosis
from .charts import from_zero, plot_text, titled
from .diagnosis_values import Values, diagnosis_figure_values
from .diagnosis_words import percent
from .page import Chart

MOST_NUMBERED_COLUMNS = 16
INK, SOFT, AXIS = "var(--ink)", "var(--soft)", "var(--axis)"

# Blue: the experiment is lower; orange: it is higher.
GAP_COLOURS = [[0, "var(--cool-3)"], [0.2, "var(--cool-2)"], [0.375, "var(--cool-1)"], [0.5, "var(--none)"], [0.625, "var(--warm-1)"],
               [0.8, "var(--warm-2)"], [1, "var(--warm-3)"]]


def diagnosis_charts(diagnosis: Diagnosis) -> list[Chart]:
    """Those that there are. where: a heat map before and after recalibration, bins that stand out framed. which: candidates by score,
    with their amplitudes over what these data can detect. how_far: the top force. gap_left: the gap before and after; neither where
    the data held out show none. law: that of contacts between grains."""
    values = diagnosis_figure_values(diagnosis)
    charts = [_where(values["where"], diagnosis.where_threshold)] if "where" in values else []
    if "which" in values:
        charts.append(_which(values["which"], [percent(cause.explained) for cause in diagnosis.ranking]))
    if "how_far" in values and diagnosis.shrink:
        forces = values["how_far"]["forces"]
        charts += [_how_far(forces)] if forces else []
        charts.append(_gap_left(values["how_far"], diagnosis.shrink.held_out))
    charts += [_law(values["law"])] if "law" in values else []
    return charts


def _small_titled(text: str, **axis: Any) -> dict[str, Any]:
    return {"title": {"text": text, "font": {"size": 12}}, **axis}


def _note(text: str, **place: Any) -> dict[str, Any]:
    return {"text": text, "showarrow": False, "font": {"size": 12}, **place}


def _rows_axis(words: list[str], **axis: Any) -> dict[str, Any]:
    return {"tickvals": list(range(len(words))), "ticktext": words, "showgrid": False, "ticks": "", **axis}


def _bins_trace(values: Values, panel: Values, axis: str) -> go.Heatmap:
    """A panel's bins, `axis` "" or "2". The trace has a column more for every gap between phases."""
    columns = values["columns"]
    edges = sorted({round(column["x"] + side, 6) for column in columns for side in (-0.5, 0.5)})
    scores, words = (np.full((len(values["observables"]), len(edges) - 1), None) for _ in range(2))
    for bin in panel["cells"]:
        column, z = columns[bin["column"]], bin["z_score"]
        place = bin["row"], edges.index(round(column["x"] - 0.5, 6))
        when = "both phases" if column["phase"] == "whole cycle" else column["phase"]
        where = f"{values['observables'][bin['row']]}, {when} at {column['displacement_mm']:.2f} mm"
        scores[place], words[place] = z, f"{plot_text(where)}<br>{z:.2f} sigma"
    return go.Heatmap(
        name=panel["words"], x=edges, y0=0, dy=1, z=scores.tolist(), text=words.tolist(), hoverinfo="text", xaxis=f"x{axis}",
        zmin=-values["colour_range"], zmax=values["colour_range"], xgap=1, ygap=1, colorscale=GAP_COLOURS, showscale=not axis,
        colorbar={"thickness": 12, "lenmode": "pixels", "len": 360, "y": 1, "yanchor": "top", "outlinewidth": 0,
                  "title": {"text": values["colour_label"], "side": "right", "font": {"size": 12}}})


def _frame(x: float, row: int, axis: str) -> dict[str, Any]:
    return {"type": "rect", "xref": f"x{axis}", "yref": "y", "x0": x - 0.47, "x1": x + 0.47, "y0": row - 0.45, "y1": row + 0.45,
            "line": {"width": 1.3, "color": INK}}


def _numbers_trace(values: Values, framed: list[Values], axis: str) -> go.Scatter:
    """Numbers in the framed bins."""
    scores = [bin["z_score"] for bin in framed]
    return go.Scatter(
        mode="text", x=[values["columns"][bin["column"]]["x"] for bin in framed], y=[bin["row"] for bin in framed],
        text=[f"{z:.{1 if abs(z) < 10 else 0}f}" for z in scores], xaxis=f"x{axis}", hoverinfo="skip", showlegend=False,
        textfont={"size": 10, "color": ["var(--on-strong)" if abs(z) > 0.6 * values["colour_range"] else "#111111" for z in scores]})


def _columns_axis(values: Values, domain: list[float]) -> dict[str, Any]:
    columns = values["columns"]
    shown = columns[::len(columns) // 10 + 1]  # more labels would overlap
    return _small_titled(
        values["x_label"], domain=domain, range=[-0.02, values["width"] + 0.02], tickvals=[column["x"] for column in shown],
        ticktext=[f"{column['displacement_mm']:.3g}" for column in shown], showgrid=False, showline=False, tickfont={"size": 11},
        tickangle=0, fixedrange=True)


def _headings(values: Values, heading: str, axis: str) -> list[dict[str, Any]]:
    """The panel's heading, and its phases."""
    above = {"xref": f"x{axis}", "yref": "paper", "y": 1, "xanchor": "center", "yanchor": "bottom"}
    notes = [_note(heading, x=values["width"] / 2, yshift=22, **above) | {"font": {"size": 14}}]
    for phase in dict.fromkeys(column["phase"] for column in values["columns"]):
        places = [column["x"] for column in values["columns"] if column["phase"] == phase]
        words = phase if phase == "whole cycle" else f"{phase} →"
        notes.append(_note(plot_text(words), x=(places[0] + places[-1]) / 2, yshift=3, **above))
    return notes


def _where(values: Values, threshold: float) -> Chart:
    observables, traces, shapes, notes = [plot_text(words) for words in values["observables"]], [], [], []
    for axis, panel in zip(("", "2"), values["panels"]):
        framed = [bin for bin in panel["cells"] if bin["stands_out"]]
        traces.append(_bins_trace(values, panel, axis))
        shapes += [_frame(values["columns"][bin["column"]]["x"], bin["row"], axis) for bin in framed]
        if framed and len(values["columns"]) <= MOST_NUMBERED_COLUMNS:
            traces.append(_numbers_trace(values, framed, axis))
        notes += _headings(values, panel["words"], axis)
    layout = {"margin": {"l": 60, "r": 16, "t": 64, "b": 56}, "shapes": shapes, "annotations": notes,
              "xaxis": _columns_axis(values, [0, 0.485]), "xaxis2": _columns_axis(values, [0.515, 1]),
              "yaxis": _rows_axis(observables, range=[len(observables) - 0.5, -0.5], showline=False, fixedrange=True)}
    caption = ("Orange: the experiment lies above the simulation, blue: below. Time runs from left to right. Left: parameters as stated; "
               "right: after they were fitted within their uncertainty.")
    if threshold > 0:
        caption += f" Framed: beyond {threshold:.1f} sigma, exceeded anywhere by noise in 1 % of the replicates."
    return Chart("where", "Where simulation and experiment differ", caption, go.Figure(traces, layout), height=120 + 22 * len(observables),
                 min_width=300 + 60 * len(values["columns"]))


def _words_column(heading: str, words: list[str], x: float, side: str) -> list[dict[str, Any]]:
    """A column of text next to the axes, one text per row."""
    place = {"xref": "paper", "x": x, "xanchor": side}
    return [_note(heading, yref="paper", y=1, yshift=12, **place),
            *(_note(plot_text(text), yref="y", y=row, yshift=0, **place) for row, text in enumerate(words))]


def _which_traces(values: Values, explained: list[str]) -> list[Any]:
    def colours(rows: list[Values]) -> list[str]:
        return [values["colour_named" if row["is_named"] else "colour_other"] for row in rows]

    def hover(row: Values) -> str:
        gain = "nan" if row["gain"] is None else f"{row['gain']:.2f}"
        return (f"{plot_text(row['words'])}<br>{plot_text(row['amplitude'])}<br>gain {gain}, probability {row['probability']}, "
                f"{row['explained']} of chi-square")

    rows = [row | {"y": y, "explained": part} for y, (row, part) in enumerate(zip(values["rows"], explained))]
    scored = [row for row in rows if row["gain"] is not None]
    confirmed = [row for row in rows if row["gain_simulated"] is not None]
    limited = [row for row in rows if row.get("over_limit") is not None]
    return [
        go.Bar(name=values["gain_label"], orientation="h", x=[row["gain"] for row in scored], y=[row["y"] for row in scored],
               hovertext=[hover(row) for row in scored], hoverinfo="text", text=[f"{row['gain']:.1f}" for row in scored],
               textposition="auto", insidetextfont={"color": "#111111"}, insidetextanchor="start", cliponaxis=False,
               marker={"color": colours(scored)}, showlegend=False),
        go.Scatter(mode="markers", name="full simulations", x=[row["gain_simulated"] for row in confirmed],
                   y=[row["y"] for row in confirmed], showlegend=False,
                   marker={"symbol": "diamond-open", "size": 10, "color": INK, "line": {"width": 1.5}},
                   hovertemplate="full simulations: gain %{x:.2f}<extra></extra>"),
        go.Scatter(mode="markers", name="fitted amplitude over detection limit", x=[row["over_limit"] for row in limited],
                   y=[row["y"] for row in limited], xaxis="x2", marker={"color": colours(limited), "size": 8},
                   error_x={"type": "data", "array": [row["half_interval"] for row in limited], "color": SOFT, "width": 3,
                            "thickness": 1.2},
                   text=[hover(row) for row in limited], hoverinfo="text", showlegend=False)]


def _which(values: Values, explained: list[str]) -> Chart:
    rows = values["rows"]

    def line(x: float, dash: str) -> dict[str, Any]:
        return {"type": "line", "xref": "x2", "yref": "paper", "x0": x, "x1": x, "y0": 0, "y1": 1,
                "line": {"width": 1, "dash": dash, "color": AXIS}}

    def column(key: str, x: float, side: str) -> list[dict[str, Any]]:
        return _words_column(key, [row[key] for row in rows], x, side)

    layout = {
        "margin": {"l": 60, "r": 16, "t": 44, "b": 56}, "bargap": 0.3, "shapes": [line(0, "solid"), line(1, "dash")],
        "annotations": column("group", -0.005, "right") + column("amplitude", 0.61, "left") + column("probability", 1, "right"),
        "xaxis": _small_titled(values["gain_label"], domain=[0, 0.3], showline=False),
        "xaxis2": _small_titled("amplitude / limit", domain=[0.37, 0.58], showline=False),
        "yaxis": _rows_axis([plot_text(row["words"]) + " " * 8 for row in rows], range=[len(rows) - 0.4, -0.6],
                            showline=False)}
    return Chart(
        "which", "Candidate effects",
        "Left: gain in log likelihood by each effect, with the parameters refitted in both cases; diamonds: from full simulations at the "
        "fitted amplitude. Candidates that share a letter cannot be distinguished by these data. Middle: amplitude with its 90 % interval, "
        "divided by the detection limit (dashed line); no dot: not detectable. Right: amplitude with one standard error, and the "
        "probability that the effect is the cause. Orange: named by the verdict.",
        go.Figure(_which_traces(values, explained), layout), height=100 + 26 * len(rows), min_width=760)


def _how_far(forces: Values) -> Chart:
    def trace(y: list[float], name: str, mode: str, colour: str, dash: str = "solid") -> go.Scatter:
        return go.Scatter(mode=mode, name=plot_text(name), x=forces["x"], y=y, line={"color": colour, "width": 2, "dash": dash},
                          marker={"color": colour, "size": 7}, hovertemplate="%{x:.2f} mm<br>%{y:.4g} N")

    layout: dict[str, Any] = {"xaxis": titled(forces["x_label"]), "legend": {"x": 0.02, "y": 0.98},
                              "yaxis": from_zero(forces["y_label"])}
    if "fitted" in forces:
        first, last = forces["fitted"]
        layout["shapes"] = [{"type": "rect", "xref": "x", "yref": "paper", "layer": "below", "x0": first, "x1": last, "y0": 0, "y1": 1,
                             "fillcolor": "var(--card)", "line": {"width": 0}}]
    traces = [trace(forces["before"], forces["words_before"], "lines", forces["colour_before"], "dash"),
              trace(forces["after"], forces["words_after"], "lines", forces["colour_after"]),
              trace(forces["experiment"], "experiment", "markers", INK)]
    return Chart("how_far", "Force on the plate, before and after", "Shaded: where the effect was fitted.", go.Figure(traces, layout),
                 log_axes="y", height=400)


def _gap_left(values: Values, held_out: str) -> Chart:
    bars = [bar for bar in values["bars"] if bar["gap_left"] is not None]
    left = [bar["gap_left"] for bar in bars]
    ends = [bar.get("interval", [None, None]) for bar in bars]
    trace = go.Bar(
        orientation="h", x=left, y=list(range(len(bars))), marker={"color": [bar["colour"] for bar in bars]},
        error_x={"type": "data", "symmetric": False, "color": INK, "width": 4, "thickness": 1.5,
                 "array": [None if high is None else high - value for value, (_, high) in zip(left, ends)],
                 "arrayminus": [None if low is None else value - low for value, (low, _) in zip(left, ends)]},
        hovertemplate="%{x:.1f} %<extra></extra>")
    layout = {"bargap": 0.35, "xaxis": from_zero(values["gap_label"]),
              "yaxis": _rows_axis([f"{bar['words']}: {bar['gap_left']:.0f} %" for bar in bars], range=[len(bars) - 0.4, -0.6])}
    return Chart("gap_left", "Gap that is left", f"In held-out data ({held_out}), with its 90 % interval; placebo: the best of twenty "
                 "random effects.", go.Figure(trace, layout), height=110 + 36 * len(bars))


def _law(values: Values) -> Chart:
    traces = []
    for curve in values["curves"]:
        x, y, half = curve["x"], curve["y"], curve["half_band"]
        edge = [a + b for a, b in zip(y, half)] + [a - b for a, b in zip(y[::-1], half[::-1])]
        traces += [go.Scatter(x=x + x[::-1], y=edge, fill="toself", mode="none", fillcolor=curve["colour"], opacity=0.18, hoverinfo="skip",
                              showlegend=False),
                   go.Scatter(x=x, y=y, mode="lines+markers", name=plot_text(curve["words"]), marker={"size": 5, "color": curve["colour"]},
                              line={"color": curve["colour"], "width": 2}, hovertemplate="%{x:.3f}<br>%{y:.1f} %<extra></extra>")]
    layout = {"xaxis": titled(values["x_label"]), "yaxis": titled(values["y_label"]), "legend": {"x": 0.02, "y": 0.98}}
    return Chart(
        "law", "The law of contacts between grains",
        "Force at equal overlap, measured over simulated, from the measured forces and positions of contacts, without the name of an effect; "
        "overlaps are corrected for the surface displacement by the other contacts. Bands: 90 %. "
        "A wrong modulus shifts a curve, another exponent tilts it; a curve that changes between loading and unloading shows a memory or a "
        "change in time. The exponent assumes that the scene's contacts have Hertz's 3/2.",
        go.Figure(traces, layout), height=400)
