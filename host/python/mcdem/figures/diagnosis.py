"""Figures of a diagnosis: location of the gap, consistent effects, gap reduction, the law of contacts."""
from typing import Any

import matplotlib.cm
import matplotlib.colors
import matplotlib.patches
import numpy as np

from .style import COLUMN, INK, PAGE, Entry, is_below, key, keyed_axes, line, new_axes, plain, styled
from .values import Source, read

# Blue: the experiment is lower than the simulation; orange: higher.
BELOW_ABOVE = matplotlib.colors.LinearSegmentedColormap.from_list("below_above", [
    (0, "#053B78"), (0.2, "#3F86BF"), (0.375, "#B9D5EA"), (0.5, "#F4F4F2"), (0.625, "#F9D3AE"), (0.8, "#E08530"), (1, "#8F3A04")])
Values = dict[str, Any]

MAX_NUMBERS = 12  # maximum number of columns with printed numbers
EXPERIMENT: Values = {"color": INK, "linestyle": "", "marker": "o", "markersize": 2.2}


@styled
def where(source: Source, axes: Any = None) -> Any:
    """Gap by observable and displacement, in sigmas of its noise. Left: stated parameters; right: parameters fitted
    within their uncertainty. Framed: significant among all bins. `axes`: two."""
    values = read(source, "where")
    if axes is None:
        axes = new_axes(PAGE, 28 + 3.6 * len(values["observables"]), ncols=2, sharey=True)
    scale = matplotlib.colors.Normalize(-values["colour_range"], values["colour_range"])
    for place, panel in zip(axes, values["panels"]):
        for bin in panel["cells"]:
            draw_bin(place, values, bin, scale)
        set_columns(place, values, panel["words"])
    axes[0].set_yticks(range(len(values["observables"])), [plain(words) for words in values["observables"]])
    axes[0].set_ylim(len(values["observables"]) - 0.5, -0.5)
    axes[0].figure.colorbar(matplotlib.cm.ScalarMappable(scale, BELOW_ABOVE), ax=list(axes), location="bottom", fraction=0.03,
                             aspect=60, pad=0.02, label=values["colour_label"])
    return axes


def draw_bin(axes: Any, values: Values, bin: Values, scale: Any) -> None:
    x, row, score = values["columns"][bin["column"]]["x"], bin["row"], bin["z_score"]
    axes.add_patch(matplotlib.patches.Rectangle((x - 0.49, row - 0.49), 0.98, 0.98, facecolor=BELOW_ABOVE(scale(score)), linewidth=0))
    if not bin["stands_out"]:
        return
    axes.add_patch(matplotlib.patches.Rectangle((x - 0.45, row - 0.45), 0.9, 0.9, fill=False, edgecolor="#111111", linewidth=0.7))
    if len(values["columns"]) <= MAX_NUMBERS:
        is_dark = abs(score) > 0.6 * values["colour_range"]
        axes.text(x, row, f"{score:.1f}", fontsize=5, ha="center", va="center_baseline", color="white" if is_dark else "#111111")


def set_columns(axes: Any, values: Values, heading: str) -> None:
    """Labels of the columns, in order of time: loading, then unloading."""
    columns = values["columns"]
    shown = columns[::len(columns) // 12 + 1]  # more labels would overlap
    axes.set_xticks([column["x"] for column in shown], [f"{column['displacement_mm']:.3g}" for column in shown])
    axes.set(xlim=(0, values["width"]), xlabel=values["x_label"])
    axes.tick_params(length=0)
    axes.grid(False)
    axes.spines[:].set_visible(False)
    for phase in dict.fromkeys(column["phase"] for column in columns):
        middle = np.mean([column["x"] for column in columns if column["phase"] == phase])
        axes.text(middle, -0.7, plain(phase) + ("" if phase == "whole cycle" else " →"), ha="center", va="bottom")
    axes.set_title(heading, pad=14, fontweight="bold")


GROUP, AMPLITUDE, PROBABILITY = -3, 4, 105  # columns next to the axes of `which` [points]


@styled
def which(source: Source, axes: Any = None) -> Any:
    """Candidate effects. Left: gain in likelihood of each (diamonds: from real runs); candidates that share a letter cannot be
    distinguished. Right: fitted amplitude with its 90 % interval over the detection limit of these data (dashed line), the
    amplitude with one standard error as text, and the probability that the effect is the cause. `axes`: two."""
    values = read(source, "which")
    rows = values["rows"]
    if axes is None:
        axes = new_axes(PAGE, 18 + 4.2 * len(rows), ncols=2, sharey=True, gridspec_kw={"width_ratios": (1, 0.75)})
    gain, over_limit = axes
    largest = max([row["gain"] or 0 for row in rows])
    for place, row in enumerate(rows):
        colour = values["colour_named" if row["is_named"] else "colour_other"]
        draw_gain(gain, place, row, colour, largest)
        if row.get("over_limit") is not None:
            over_limit.errorbar(row["over_limit"], place, xerr=row["half_interval"], color=colour, marker="o", capsize=1.5,
                                elinewidth=0.8, capthick=0.8)
        column(gain, GROUP, place, row["group"], "right")
        column(over_limit, AMPLITUDE, place, row["amplitude"], "left")
        column(over_limit, PROBABILITY, place, row["probability"], "right")
    over_limit.axvline(1, color=INK, linestyle=(0, (4, 2)), linewidth=0.7)
    for panel in axes:
        panel.axvline(0, color=INK, linewidth=0.5)
        set_rows(panel)
    gain.set_xlabel(values["gain_label"])
    over_limit.set_xlabel(values["over_limit_label"])
    gain.set_yticks(range(len(rows)), [plain(row["words"]) for row in rows])
    gain.tick_params(axis="y", pad=14)
    gain.set_ylim(len(rows) - 0.4, -0.6)
    gain.margins(x=0.1)
    heading = "group" if any(row["group"] for row in rows) else ""
    for panel, x, words, side in ((gain, GROUP, heading, "right"), (over_limit, AMPLITUDE, "amplitude", "left"),
                                  (over_limit, PROBABILITY, "probability", "right")):
        column(panel, x, -1.1, words, side)
    return axes


def set_rows(axes: Any) -> None:
    """Rows of a table have neither lines nor ticks."""
    axes.grid(False, axis="y")
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)


def draw_gain(axes: Any, place: int, row: Values, colour: str, largest: float) -> None:
    """Prints the number at the base of its bar, next to a bar that is too short, or next to a diamond."""
    gain, simulated = row["gain"], row["gain_simulated"]
    if gain is not None:
        axes.barh(place, gain, 0.68, color=colour)
        end = max(gain, 0) if gain < 0.12 * largest else None
        if end is not None and simulated is not None and end < simulated < end + 0.15 * largest:
            end = simulated
        axes.annotate(f"{gain:.1f}", (end or 0, place), (2 if end is None else 5, 0), textcoords="offset points", va="center",
                      fontsize=6)
    if simulated is not None:
        axes.plot(simulated, place, marker="D", markersize=3.5, markerfacecolor="none", color=INK, markeredgewidth=0.8)


def column(axes: Any, x: float, row: float, words: str, side: str) -> None:
    """A text of a table next to the axes, `x` points to the right of their right edge, or of their left edge if negative."""
    axes.annotate(plain(words), (float(x > 0), row), (x, 0), xycoords=axes.get_yaxis_transform(), textcoords="offset points", ha=side,
                  va="center", fontsize=6.5)


@styled
def how_far(source: Source, axes: Any = None) -> Any:
    """Top force before and after the effect is added, and the remaining gap in held-out data with its 90 % interval;
    placebo: the best of many random effects. `axes`: two, or one if the experiment has no top force."""
    values = read(source, "how_far")
    has_forces = bool(values["forces"])
    below = 15 if has_forces and is_below(force_entries(values["forces"]), "upper left") else 0
    if axes is None:
        axes = new_axes(COLUMN, (50 + below) * has_forces + 18 + 4.5 * len(values["bars"]), nrows=1 + has_forces, squeeze=False,
                        gridspec_kw={"height_ratios": (50 + below, 4.5 * len(values["bars"]) + 4)[-1 - has_forces:]})[:, 0]
    if has_forces:
        draw_forces(axes[0], values["forces"])
    draw_bars(axes[-1], values)
    return axes


def draw_forces(axes: Any, values: Values) -> None:
    if "fitted" in values:
        axes.axvspan(*values["fitted"], facecolor="#999999", alpha=0.18, linewidth=0)
    axes.plot(values["x"], values["before"], **before_look(values))
    axes.plot(values["x"], values["after"], color=values["colour_after"])
    axes.plot(values["x"], values["experiment"], **EXPERIMENT)
    axes.set(xlabel=values["x_label"], ylabel=values["y_label"])
    if min(*values["experiment"], *values["before"], *values["after"]) >= 0:
        axes.set_ylim(bottom=0)
    key(axes, force_entries(values), "upper left")


def before_look(values: Values) -> Values:
    return {"color": values["colour_before"], "linestyle": (0, (4, 2))}


def force_entries(values: Values) -> list[Entry]:
    entries = [(line(**EXPERIMENT), "experiment"), (line(**before_look(values)), values["words_before"]),
               (line(color=values["colour_after"]), values["words_after"])]
    if "fitted" in values:
        entries.append((matplotlib.patches.Patch(facecolor="#999999", alpha=0.18, linewidth=0), "fitted here"))
    return entries


def draw_bars(axes: Any, values: Values) -> None:
    for place, bar in enumerate(values["bars"]):
        left = bar["gap_left"]
        if left is None:
            continue
        axes.barh(place, left, 0.6, color=bar["colour"])
        low, high = bar.get("interval", (left, left))
        if low < high:
            axes.plot((low, high), (place, place), color=INK, linewidth=0.8, marker="|", markersize=4)
        axes.annotate(f"{left:.0f} %", (max(high, left, 0), place), (3, 0), textcoords="offset points", va="center", fontsize=6.5)
    axes.axvline(0, color=INK, linewidth=0.5)
    axes.set_yticks(range(len(values["bars"])), [plain(bar["words"]) for bar in values["bars"]])
    axes.set_ylim(len(values["bars"]) - 0.5, -0.5)
    axes.margins(x=0.17)
    set_rows(axes)
    axes.set_xlabel(values["gap_label"])


@styled
def law(source: Source, axes: Any = None) -> Any:
    """Force of contacts between grains at equal overlap, measured over simulated, with its 90 % band, at some displacements."""
    values = read(source, "law")
    entries = [(line(color=curve["colour"]), curve["words"]) for curve in values["curves"]]
    axes = axes or keyed_axes(entries, None)
    for curve in values["curves"]:
        x, y, half = (np.array(curve[name]) for name in ("x", "y", "half_band"))
        axes.fill_between(x, y - half, y + half, color=curve["colour"], alpha=0.18, linewidth=0)
        axes.plot(x, y, color=curve["colour"], marker="o", markersize=2)
    axes.axhline(0, color=INK, linewidth=0.6)
    axes.set(xlabel=values["x_label"], ylabel=values["y_label"])
    key(axes, entries)
    return axes
