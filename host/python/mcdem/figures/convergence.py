"""Figure of a convergence study."""
from typing import Any

import matplotlib.patches
import numpy as np

from .style import PAGE, key, new_axes, plain, styled
from .values import Source, read

EDGE = 4  # larger values are drawn at the edge


@styled
def convergence(source: Source, axes: Any = None) -> Any:
    """Largest error of every observable from each cause, over its limit, with two standard errors. Shaded: within the limits."""
    values = read(source, "convergence")
    rows, causes = values["rows"], values["causes"]
    axes = axes or new_axes(PAGE, 16 + 4.2 * len(rows))
    axes.axvspan(-1, 1, facecolor="#e8e8e8", linewidth=0)
    for number, cause in enumerate(causes):
        for place, row in enumerate(rows):
            error = row["errors"][number]
            if error:
                draw_error(axes, place - 0.4 + 0.8 * (number + 0.5) / len(causes), error, cause)
    axes.set(xlim=(-EDGE, EDGE), ylim=(len(rows) - 0.5, -0.5), xlabel=values["x_label"])
    axes.set_yticks(range(len(rows)), [plain(row["words"]) for row in rows])
    axes.tick_params(axis="y", length=0)
    artists = [(axes.plot([], [], color=cause["colour"], marker=cause["marker"], linestyle="")[0], cause["words"]) for cause in causes]
    artists.append((matplotlib.patches.Patch(color="#e8e8e8", linewidth=0), "within the limit"))
    key(axes, artists, "upper left", bbox_to_anchor=(1.01, 1))
    return axes


def draw_error(axes: Any, y: float, error: dict[str, Any], cause: dict[str, Any]) -> None:
    x, bar = error["over_limit"], 2 * (error["standard_error"] or 0)
    low, shown, high = np.clip((x - bar, x, x + bar), -EDGE + 0.05, EDGE - 0.05)
    axes.plot((low, high), (y, y), color=cause["colour"], linewidth=0.7)
    axes.plot(shown, y, color=cause["colour"], marker=cause["marker"], markersize=2)
