"""Values of figures in the units of their axes, shared by pages, pictures and the file figures.json, which mcdem.figures draws."""
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..observe.estimate import not_available
from ..observe.replicas import Setting
from ..results import Phase
from .labels import SeriesStyle

FORMAT = 1  # of the file


@dataclass(frozen=True)
class Curve:
    """Points of one phase: x, y, and the standard error of y over replicas, NaN where unknown."""
    phase: Phase
    points: tuple[tuple[float, float, float], ...]

    def values(self) -> dict[str, Any]:
        x, y, error = ([_or_null(value) for value in column] for column in zip(*self.points, strict=True))
        return {"phase": self.phase.name, "x": x, "y": y, "standard_error": error}


@dataclass(frozen=True)
class FigureSeries:
    """One setting, or the reference. `words` is its name in the legend, to which `remark` is appended: "tau 4.00 mN"; `slope` is that
    of the line through the origin fitted to all points, in the units of the axes."""
    setting: Setting
    words: str
    style: SeriesStyle
    is_reference: bool
    remark: str
    curves: tuple[Curve, ...]  # loading, unloading; only curves with points
    slope: float = not_available

    def values(self) -> dict[str, Any]:
        return {"setting": self.setting.label, "words": self.words, "remark": self.remark, "colour": self.style.colour,
                "marker": self.style.marker, "is_reference": self.is_reference, "replicas": len(self.setting.replicas),
                **({"slope": self.slope} if math.isfinite(self.slope) else {}), "curves": [curve.values() for curve in self.curves]}


@dataclass(frozen=True)
class RunFigure:
    """`name` is that of its files and key: top_force; `displacement` [mm] the level of a force distribution; `title` is shown on a page
    for programmes."""
    name: str
    x_label: str
    y_label: str
    series: list[FigureSeries] = field(default_factory=list)
    displacement: float | None = None
    title: str = ""

    def values(self) -> dict[str, Any]:
        level = {} if self.displacement is None else {"displacement_mm": self.displacement}
        return {"x_label": self.x_label, "y_label": self.y_label, **level, "series": [series.values() for series in self.series]}


def _or_null(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def figure_values(figures: Iterable[RunFigure]) -> dict[str, Any]:
    """One key for each figure; null for unknown numbers."""
    return {figure.name: figure.values() for figure in figures}


def figure_file(values: Mapping[str, Any]) -> bytes:
    """The content of figures.json. Bytes of labels that are no UTF-8 are replaced."""
    text = json.dumps({"mcdem_figures": FORMAT, **values}, indent=1, ensure_ascii=False) + "\n"
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "replace").encode()
