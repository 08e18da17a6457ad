"""An observation: one number for each observable, phase and displacement, which is called a cell (host/diagnose/observe/observation.h)."""
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from .. import _engine as engine
from ..results.names import Phase
from ..results.recording import Floats

MIN_CELLS = 4  # that an experiment and its simulations must have in common
PHASES = Phase.load, Phase.unload


@dataclass(frozen=True)
class Observable:
    """A number that a scan of a measured and of a simulated packing has."""

    name: str
    needs: str  # plate, contacts, positions (and contacts), programme
    resolution: float  # smaller differences are ignored: numerics, damping, drift of the instrument
    region: str  # part of the packing; empty: all
    force_class: str  # class of forces; empty: all
    meaning: str


@cache
def observables() -> tuple[Observable, ...]:
    """In the order of an observation's entries."""
    return tuple(Observable(**row) for row in engine.observables())


@dataclass(frozen=True)
class HoldScans:
    """A hold of a programme: the scans at its start and its end."""

    begin: int
    first: int  # the first one taken during the hold
    end: int
    keep: str  # position, force or stress
    phase: Phase
    displacement: float  # of the experiment [m]


@dataclass(frozen=True)
class Grid:
    """Displacements at which recordings are compared, and the width over which scans are smoothed."""

    displacement: list[float]  # [m]
    width: float  # scans within this distance contribute, with decreasing weight [m]
    stroke: float  # of the experiment [m]
    force: list[float] = field(default_factory=list)  # where the programme sets forces: those of the experiment while loading [N]
    force_width: float = 0  # [N]
    holds: list[HoldScans] = field(default_factory=list)  # of the programme, in order


def grid_from(values: Mapping[str, Any]) -> Grid:
    """The grid that the compiled module gives as a dict (host/python/grid_dict.h)."""
    holds = [HoldScans(**(hold | {"phase": Phase(hold["phase"])})) for hold in values["holds"]]
    of_all: dict[str, Any] = {**values, "holds": holds}
    return Grid(**of_all)


@dataclass(frozen=True)
class Cell:
    observable: int  # index in observables()
    phase: Phase
    displacement: float  # [m]


def cells_of(grid: Grid) -> list[Cell]:
    """The cells of a grid: by observable, then phase, then displacement."""
    return [Cell(*key) for key in product(range(len(observables())), PHASES, grid.displacement)]


def cells_each(count: int) -> int:
    """Number of cells of each observable, of `count` cells of a grid."""
    return count // len(observables())


NOT_MEASURED = {
    "contacts": "contacts.csv: the forces of contacts would tell the force distribution, the floor's and the walls' share, the plate's couple "
    "and biases of the force measurement",
    "positions": "grains.csv beyond frame 0, with contacts.csv: positions would tell the overlaps that the forces should imply, hence "
    "cross-contact effects, stiffening, adhesion, friction and errors of sizes",
}


def not_measured(observed: Floats, grid: Grid) -> list[str]:
    """One sentence for each file whose observables are missing in all scans; `observed`: one number per cell, NaN where unknown."""
    seen = {observables()[cell.observable].needs for cell, value in zip(cells_of(grid), observed) if np.isfinite(value)}
    return [text for needs, text in NOT_MEASURED.items() if needs not in seen]
