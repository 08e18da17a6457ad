"""Figures of programmes, scan by scan: force and displacement of a plate, stress and strain of a cell, against one another and against
time."""
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..observe.programmes import has_hold
from ..results import Phase
from .figure_data import FigureData, Series
from .figure_values import DEFINITIONS, Curve, Definition, Drawing, FigureSeries, Kind, RunFigure
from .labels import stress_unit

DISTORTION = 1e-6  # smaller deviatoric strains of a cell are ignored


class Axis(NamedTuple):
    """`quantity` of a MeanScan over `unit`, which None leaves to the largest stress."""
    label: str
    unit: float | None
    quantity: str


TIME = Axis("time [s]", 1, "time")
FORCE = Axis("top force [N]", 1, "top_force")
MOVED = Axis("plate displacement [mm]", 1e-3, "displacement")
MEAN_STRESS = Axis("mean stress p", None, "p")
DEVIATORIC_STRESS = Axis("deviatoric stress q", None, "q")
VOLUME = Axis("volume strain [%]", 1e-2, "volume_strain")
SHEAR = Axis("deviatoric strain [%]", 1e-2, "shear_strain")
FRACTION = Axis("packing fraction φ", 1, "packing_fraction")
CONTACTS = Axis("contacts per grain Z", 1, "coordination")
MEANINGS = {"p": "p: a third of the stress tensor's trace, compression positive.", "q": "q = √(3/2 s:s) of its deviator s.",
            "volume_strain": "Volume strain: decrease of the volume over the initial volume.",
            "shear_strain": "Deviatoric strain: √(2/3 e:e), e the deviator of the logarithmic strain."}

Select = Callable[[FigureData], list[Series]]


def _plates(data: FigureData) -> list[Series]:
    return data.programmes(cells=False)


def _cells(data: FigureData) -> list[Series]:
    return data.programmes(cells=True)


def _distorted(data: FigureData) -> list[Series]:
    """The cells, if there is one that is distorted."""
    return _cells(data) if _largest(_cells(data), "shear_strain") > DISTORTION else []


def _if_held(select: Select) -> Select:
    """Cells are shown against time only if there is a hold."""
    return lambda data: select(data) if any(has_hold(series.setting.replicas) for series in _cells(data)) else []


def scan_figure(name: str, title: str, x: Axis, y: Axis, of: Select, log_axes: str = "", from_zero: str = "xy") -> None:
    """Defines the figure `name` of the series that `of` selects: y against x, one line for each."""
    caption = " ".join(words for quantity, words in MEANINGS.items() if quantity in (x.quantity, y.quantity))

    def make(data: FigureData) -> RunFigure:
        shown = of(data)
        stress = stress_unit(max(_largest(shown, "p"), _largest(shown, "q")))
        (x_label, x_unit), (y_label, y_unit) = ((f"{label} [{stress.name}]", stress.size) if unit is None else (label, unit)
                                                for label, unit, _ in (x, y))
        figure = RunFigure(title, x_label, y_label, caption=caption)
        for series in shown:
            pairs = ((getattr(scan, x.quantity), getattr(scan, y.quantity)) for scan in series.scans)
            points = tuple((along.value / x_unit, up.value / y_unit, up.standard_error / y_unit) for along, up in pairs
                           if along.available() and up.available())
            if points:
                figure.series.append(FigureSeries(series, (Curve(Phase.load, points),)))
        return figure

    DEFINITIONS[name] = Definition(make, Drawing(Kind.path, from_zero, log_axes, "best"),
                                   f"{title}, scan by scan of a programme; bands: one standard error over replicas.")


def _largest(shown: Sequence[Series], quantity: str) -> float:
    return float(np.fmax.reduce([abs(getattr(scan, quantity).value) for series in shown for scan in series.scans], initial=0))


scan_figure("force_time", "Force on the plate against time", TIME, FORCE, _plates)
scan_figure("displacement_time", "Displacement of the plate against time", TIME, MOVED, _plates)
scan_figure("force_displacement", "Force on the plate against displacement", MOVED, FORCE, _plates)
scan_figure("pressure_strain", "Mean stress against volume strain", VOLUME, MEAN_STRESS, _cells, log_axes="y")
scan_figure("shear_stress_strain", "Deviatoric stress against deviatoric strain", SHEAR, DEVIATORIC_STRESS, _distorted)
scan_figure("cell_coordination", "Contacts per grain", FRACTION, CONTACTS, _cells, from_zero="")
scan_figure("stress_path", "Stress path", MEAN_STRESS, DEVIATORIC_STRESS, lambda data: _plates(data) + _distorted(data))
scan_figure("pressure_time", "Mean stress against time", TIME, MEAN_STRESS, _if_held(_cells))
scan_figure("volume_time", "Volume strain against time", TIME, VOLUME, _if_held(_cells))
scan_figure("shear_stress_time", "Deviatoric stress against time", TIME, DEVIATORIC_STRESS, _if_held(_distorted))
scan_figure("shear_strain_time", "Deviatoric strain against time", TIME, SHEAR, _if_held(_distorted))
