"""Figures of the score of a challenge."""
from typing import Any

import matplotlib.colors
import matplotlib.patches
import matplotlib.ticker
import numpy as np

from ..report.diagnosis_words import words_of
from .style import GREY, key, new_axes, plain, styled
from .values import Source, read

PARTS = matplotlib.colors.LinearSegmentedColormap.from_list("parts", [(0, "#F1F4F7"), (0.25, "#C3DAEC"), (0.6, "#3F86BF"), (1, "#053B78")])
MEASURED, RIGHT = "#0072B2", "#D55E00"


@styled
def confusion(source: Source, axes: Any = None) -> Any:
    """Cases by truth (rows) and verdict (columns), shaded by the fraction of the row; framed: right answers."""
    values = read(source, "confusion")
    cases = np.array(values["cases"], float)
    axes = axes or new_axes(34 + 6 * cases.shape[1] + 14, 30 + 4.2 * cases.shape[0])
    parts = cases / np.maximum(cases.sum(1, keepdims=True), 1)
    axes.imshow(parts, cmap=PARTS, vmin=0, vmax=1, aspect="auto")
    for truth, verdict in np.argwhere(cases > 0):
        axes.text(verdict, truth, f"{cases[truth, verdict]:.0f}", ha="center", va="center_baseline", fontsize=6,
                  color="white" if parts[truth, verdict] > 0.55 else "#111111")
    for truth, verdict in values["right"]:
        axes.add_patch(matplotlib.patches.Rectangle((verdict - 0.46, truth - 0.44), 0.92, 0.88, fill=False, edgecolor=RIGHT))
    axes.set_yticks(range(cases.shape[0]), [plain(words_of(name)) for name in values["truths"]])
    axes.set_xticks(range(cases.shape[1]), [plain(words_of(name)) for name in values["verdicts"]], rotation=45, ha="left", rotation_mode="anchor")
    axes.xaxis.tick_top()
    axes.xaxis.set_label_position("top")
    axes.set(xlabel="verdict", ylabel="truth")
    axes.grid(False)
    axes.set_xticks(np.arange(cases.shape[1] + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(cases.shape[0] + 1) - 0.5, minor=True)
    axes.grid(True, which="minor", color="white", linewidth=1)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)
    return axes


@styled
def power(source: Source, axes: Any = None) -> Any:
    """Fraction of detected cases by amplitude over the predicted detection limit, with 95 % intervals."""
    axes = proportions(read(source, "power"), axes)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    return axes


@styled
def confidence(source: Source, axes: Any = None) -> Any:
    """Fraction of right verdicts by stated probability, with 95 % intervals."""
    axes = proportions(read(source, "confidence"), axes)
    axes.set_xlim(-0.02, 1.04)
    return axes


def proportions(values: dict[str, Any], axes: Any) -> Any:
    axes = axes or new_axes(height=70)
    measured, predicted = values["measured"], values["predicted"]
    part, interval = np.array(measured["part"]), np.array(measured["interval"]).T
    line, = axes.plot(predicted["x"], predicted["part"], color=GREY)
    points = axes.errorbar(measured["x"], part, [part - interval[0], interval[1] - part], color=MEASURED, marker="o", linestyle="",
                           elinewidth=0.8)
    for x, y, cases in zip(measured["x"], part, measured["cases"]):
        axes.annotate(str(cases), (x, y), (3, -6), textcoords="offset points", fontsize=5.5)
    axes.set(ylim=(-0.07, 1.04), xlabel=values["x_label"], ylabel=values["y_label"])
    key(axes, [(points, "measured, 95 % interval, cases"), (line, values["words_predicted"])])
    return axes
