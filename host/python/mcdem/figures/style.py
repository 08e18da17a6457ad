"""Style of figures: sizes and fonts for print, legends, files."""
import functools
import io
import math
import pathlib
from collections.abc import Callable, Sequence
from typing import Any, TypeVar, cast

import matplotlib
import matplotlib.lines
import matplotlib.pyplot as plt
import numpy as np

from ..files import write_whole
from .values import Source

MILLIMETRE = 1 / 25.4  # of an inch, matplotlib's unit of length
COLUMN = 86            # width of a column of a journal [mm]
PAGE = 178             # width of its page [mm]

INK, GREY, GRID = "#222222", "#666666", "#dddddd"

Entry = tuple[Any, str]  # of a legend: artist and text
Draw = TypeVar("Draw", bound=Callable[..., Any])

line = functools.partial(matplotlib.lines.Line2D, [], [])  # for legends

# Applied on top of the user's settings. Text is stored as text, so that it can be edited and searched.
STYLE: dict[str, Any] = {
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "font.size": 7, "axes.labelsize": 7, "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5, "legend.fontsize": 6.5, "text.color": INK, "axes.labelcolor": INK, "xtick.labelcolor": INK,
    "ytick.labelcolor": INK, "axes.edgecolor": "#444444", "xtick.color": "#444444", "ytick.color": "#444444",
    "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6, "xtick.minor.width": 0.4, "ytick.minor.width": 0.4,
    "xtick.major.size": 2.5, "ytick.major.size": 2.5, "xtick.minor.size": 1.5, "ytick.minor.size": 1.5,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True, "grid.color": GRID,
    "grid.linewidth": 0.4, "lines.linewidth": 1.1, "lines.markersize": 3, "patch.linewidth": 0.8, "legend.frameon": False,
    "legend.handlelength": 2.2, "legend.labelspacing": 0.3, "legend.borderaxespad": 0.3, "axes.titlesize": 7, "text.usetex": False,
    "svg.fonttype": "none", "svg.hashsalt": "mcdem", "pdf.fonttype": 42, "savefig.dpi": 300, "savefig.facecolor": "white",
    "figure.facecolor": "white", "figure.dpi": 200, "figure.constrained_layout.use": True,
}


def styled(draw: Draw) -> Draw:
    """Decorator: the function draws in STYLE, whatever else the program has set."""
    return cast(Draw, matplotlib.rc_context(STYLE)(draw))


@styled
def new_axes(width: float = COLUMN, height: float = 62, **grid: Any) -> Any:
    """Axes on a new page of this size [mm]; `grid` as for matplotlib's `subplots`."""
    figure, axes = plt.subplots(figsize=(width * MILLIMETRE, height * MILLIMETRE), **grid)
    figure.get_layout_engine().set(w_pad=MILLIMETRE, h_pad=MILLIMETRE)
    return axes


def plain(text: str) -> str:
    """Escapes text that matplotlib would interpret (formulas, labels with a leading underscore)."""
    text = text.replace("$", r"\$")
    return " " + text if text.startswith("_") else text


def key_columns(entries: Sequence[Entry]) -> int:
    return 2 if max(len(words) for _, words in entries) < 23 else 1  # 22 characters are about 30 mm wide


def is_below(entries: Sequence[Entry], place: str | None) -> bool:
    """Whether a legend is below the axes: without a place inside them, or because it would hide curves there."""
    return place is None or len(entries) > 9 or max(len(words) for _, words in entries) > 36


def keyed_axes(entries: Sequence[Entry], place: str | None) -> Any:
    """New axes with space for a legend below them if it is there."""
    height = 3.1 * math.ceil(len(entries) / key_columns(entries)) + 1
    return new_axes(height=62 + height * is_below(entries, place))


def key(axes: Any, entries: Sequence[Entry], place: str | None = None, **beside: Any) -> Any:
    """A legend of (artist, text): inside the axes at `place`, below them, or `beside` them."""
    where: dict[str, Any] = {"loc": place, **beside}
    if not beside and is_below(entries, place):
        where = {"loc": "upper left", "bbox_to_anchor": (-0.1, -0.17), "ncol": key_columns(entries), "columnspacing": 1.2}
    return axes.legend([artist for artist, _ in entries], [plain(words) for _, words in entries], **where)


@styled
def save(axes: Any, file: Source) -> None:
    """Saves the figure of the axes atomically as PDF, PNG or SVG, according to the extension."""
    file = pathlib.Path(file)
    kind = file.suffix[1:]
    creator = {"png": "Software"}.get(kind, "Creator")  # `mcdem` recognises its own figures by this
    dates: dict[str, dict[str, None]] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}  # so that the same figure has the same bytes
    page = io.BytesIO()
    np.ravel(axes)[0].figure.savefig(page, format=kind, metadata={creator: "mcdem figure"} | dates.get(kind, {}))
    write_whole(file, page.getvalue())
