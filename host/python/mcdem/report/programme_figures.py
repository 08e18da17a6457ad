"""Figures of programmes that have data, scan by scan: force and displacement of a plate, stress and strain of a cell, against one
another and against time."""
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..observe.estimate import Estimate
from ..observe.programmes import MeanScan, are_cells, has_hold, mean_scans
from ..results import Phase
from .figure_data import FigureData, Series
from .figure_values import Curve, RunFigure
from .labels import stress_unit

DISTORTION = 1e-6  # smaller deviatoric strains of a cell are ignored


class Axis(NamedTuple):
    """`quantity` of a MeanScan over `unit`."""
    label: str
    unit: float
    quantity: str


class Track(NamedTuple):
    """Scans of one setting."""
    series: Series
    scans: list[MeanScan]


TIME = Axis("time [s]", 1, "time")
FORCE = Axis("top force [N]", 1, "top_force")
MOVED = Axis("plate displacement [mm]", 1e-3, "displacement")
VOLUME = Axis("volume strain [%]", 1e-2, "volume_strain")
SHEAR = Axis("deviatoric strain [%]", 1e-2, "shear_strain")
FRACTION = Axis("packing fraction φ", 1, "packing_fraction")
CONTACTS = Axis("contacts per grain Z", 1, "coordination")


def programme_figures(data: FigureData) -> list[RunFigure]:
    """Time is shown for plates, and for cells with a hold; figures of distortion only for cells that are distorted."""
    tracks = [Track(one, mean_scans(one.setting.replicas)) for one in data.simulated if one.is_programme]
    plates, cells = ([track for track in tracks if are_cells(track.series.setting.replicas) == is_cell] for is_cell in (False, True))
    distorted = _largest(cells, "shear_strain") > DISTORTION
    p, q = _stresses(cells)
    figures = [
        _figure(plates, "force_time", "Force on the plate against time", TIME, FORCE),
        _figure(plates, "displacement_time", "Displacement of the plate against time", TIME, MOVED),
        _figure(plates, "force_displacement", "Force on the plate against displacement", MOVED, FORCE),
        _figure(cells, "pressure_strain", "Mean stress against volume strain", VOLUME, p)]
    if distorted:
        figures.append(_figure(cells, "shear_stress_strain", "Deviatoric stress against deviatoric strain", SHEAR, q))
    figures.append(_figure(cells, "cell_coordination", "Contacts per grain", FRACTION, CONTACTS))
    paths = plates + cells if distorted else plates
    figures.append(_figure(paths, "stress_path", "Stress path", *_stresses(paths)))
    if any(has_hold(track.series.setting.replicas) for track in cells):
        figures.append(_figure(cells, "pressure_time", "Mean stress against time", TIME, p))
        figures.append(_figure(cells, "volume_time", "Volume strain against time", TIME, VOLUME))
        if distorted:
            figures.append(_figure(cells, "shear_stress_time", "Deviatoric stress against time", TIME, q))
            figures.append(_figure(cells, "shear_strain_time", "Deviatoric strain against time", TIME, SHEAR))
    return [figure for figure in figures if figure.series]


def _figure(tracks: Sequence[Track], name: str, title: str, x: Axis, y: Axis) -> RunFigure:
    figure = RunFigure(name, x.label, y.label, title=title)
    for track in tracks:
        pairs: list[tuple[Estimate, Estimate]] = [(getattr(scan, x.quantity), getattr(scan, y.quantity)) for scan in track.scans]
        points = tuple((along.value / x.unit, up.value / y.unit, up.standard_error / y.unit) for along, up in pairs
                       if along.available() and up.available())
        if points:
            figure.series.append(track.series.shown("", [Curve(Phase.load, points)]))
    return figure


def _largest(tracks: Sequence[Track], quantity: str) -> float:
    return float(np.fmax.reduce([abs(getattr(scan, quantity).value) for track in tracks for scan in track.scans], initial=0))


def _stresses(tracks: Sequence[Track]) -> tuple[Axis, Axis]:
    """Mean and deviatoric stress of the tracks in a common unit."""
    unit = stress_unit(max(_largest(tracks, "p"), _largest(tracks, "q")))
    return Axis(f"mean stress p [{unit.name}]", unit.size, "p"), Axis(f"deviatoric stress q [{unit.name}]", unit.size, "q")
