"""A figure of runs as one value in the units of its axes. Pages (charts.py), pictures (mcdem.figures) and figures.json show it."""
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from math import isfinite
from typing import Any, NamedTuple

from ..json_text import finite, json_text
from ..observe.estimate import not_available
from ..results import Phase
from .figure_data import FigureData, Series

FORMAT = 1  # of figures.json


@dataclass(frozen=True)
class Curve:
    """Points of one phase: x, y, and the standard error of y over replicas, NaN where unknown."""
    phase: Phase
    points: tuple[tuple[float, float, float], ...]

    def values(self) -> dict[str, Any]:
        return {"phase": self.phase.name, **dict(zip(("x", "y", "standard_error"), finite(list(zip(*self.points))), strict=True))}


@dataclass(frozen=True)
class FigureSeries:
    """Curves of a setting or the reference: loading, unloading; only those with points. `remark` follows its name in the legend:
    "tau 4.00 mN"; `slope` is that of the line through the origin fitted to all points, in the units of the axes."""
    of: Series
    curves: tuple[Curve, ...]
    remark: str = ""
    slope: float = not_available

    def values(self) -> dict[str, Any]:
        setting = self.of.setting
        return {"setting": setting.label, "words": self.of.words, "remark": self.remark, "colour": self.of.style.colour,
                "marker": self.of.style.marker, "is_reference": self.of.is_reference, "replicas": len(setting.replicas),
                **({"slope": self.slope} if isfinite(self.slope) else {}), "curves": [curve.values() for curve in self.curves]}


class Kind(Enum):
    """What the curves of a figure look like. The reference is points, filled and open, in all."""
    phases = "loading solid, unloading dashed"
    level = "one line for each series, at one displacement, over a logarithmic axis"
    points = "filled for loading, open for unloading, with a line through the origin"
    path = "one line through all scans in order of time"


class Hover(NamedTuple):
    """What a page says of a point: x and y with their formats and units, and what follows y where the error is known."""
    x: str
    y: str
    error: str


@dataclass(frozen=True)
class Drawing:
    """`from_zero`: axes that begin at zero; `log_axes`: those with a button for a logarithmic scale on pages; `legend`: its place in
    the axes of a picture, otherwise it is below; `remarks`: whether pages show them; `hover`: by default numbers and units."""
    kind: Kind
    from_zero: str = "xy"
    log_axes: str = ""
    legend: str | None = None
    remarks: bool = False
    hover: Hover | None = None


@dataclass(frozen=True)
class RunFigure:
    """`title` and `caption` are shown on pages; `displacement` [mm] is the level of a force distribution."""
    title: str
    x_label: str
    y_label: str
    series: list[FigureSeries] = field(default_factory=list)
    caption: str = ""
    displacement: float | None = None
    name: str = ""
    drawing: Drawing = Drawing(Kind.path)

    def values(self) -> dict[str, Any]:
        level = {} if self.displacement is None else {"displacement_mm": self.displacement}
        return {"x_label": self.x_label, "y_label": self.y_label, **level, "series": [series.values() for series in self.series]}


@dataclass(frozen=True)
class Definition:
    """`meaning` is the documentation of the function in mcdem.figures; `missing` says what is not drawn without data, and why."""
    make: Callable[[FigureData], RunFigure]
    drawing: Drawing
    meaning: str
    missing: str = ""


DEFINITIONS: dict[str, Definition] = {}  # by name of the figure, in the order of pages


def run_figure(drawing: Drawing, missing: str = "") -> Callable[[Callable[[FigureData], RunFigure]], Callable[[FigureData], RunFigure]]:
    """Decorator: the function makes the figure of its name, from runs of strokes. Its page, picture and values follow."""
    def define(make: Callable[[FigureData], RunFigure]) -> Callable[[FigureData], RunFigure]:
        DEFINITIONS[make.__name__] = Definition(make, drawing, make.__doc__ or "", missing)
        return make
    return define


def figure_file(values: Mapping[str, Any]) -> bytes:
    """The content of figures.json: one key for each figure, null for unknown numbers. Bytes of labels that are no UTF-8 are replaced."""
    return json_text({"mcdem_figures": FORMAT, **values}, indent=1).encode()
