"""The table of observables: numbers that a scan of a measured and of a simulated packing has.

Global ones describe the packing. Conditional ones take the measured positions as given and compare each contact's force with the model; they
average over thousands of contacts and are not affected by chaotic rearrangements.
Those of grains alone are compared only where no contact forces were measured.
A new one is a function in force_observables.py, position_observables.py, overlap_observables.py or grain_observables.py.
"""
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, TypeVar

from ..results.recording import Floats

if TYPE_CHECKING:
    from .seen_scans import SeenScans

    Function = Callable[[SeenScans], Floats | tuple[Floats, ...]]  # (scans,) of each observable; NaN where a scan does not determine it
    OneFunction = TypeVar("OneFunction", bound=Function)

MIN_CONTACTS = 60  # scans with fewer contacts determine only the force on the plate


@dataclass(frozen=True)
class Observable:
    name: str
    needs: str  # plate, contacts, positions (and contacts), grains (without contact forces), programme
    resolution: float  # smaller differences are ignored: numerics, damping, drift of the instrument
    region: str  # part of the packing; empty: all
    force_class: str  # class of forces; empty: all
    meaning: str


@dataclass(frozen=True)
class Group:
    """Observables that one function computes."""

    observables: tuple[Observable, ...]
    function: "Function"


_groups: list[Group] = []

TOP_FORCE = Observable("top_force", "plate", 0.003, "plate", "", "log of the force on the plate")
OF_PROGRAMMES = (
    Observable("displacement", "programme", 0.002, "plate", "", "displacement of the plate over the stroke, where the force on it is set"),
    Observable("relaxation", "programme", 0.003, "plate", "",
               "log of the force on the plate at the beginning of a hold of its position, minus that at the end"),
    Observable("creep", "programme", 0.002, "plate", "", "downward displacement of the plate during a hold of its force, over the stroke"),
)


def observed(needs: str, *rows: tuple[str, float, str, str, str]) -> "Callable[[OneFunction], OneFunction]":
    """Adds a function to the table. `needs`: contacts, positions or grains. `rows`: name, resolution, region, class of forces and meaning of each
    array that it returns, in their order."""
    def add(function: "OneFunction") -> "OneFunction":
        group = tuple(Observable(name, needs, *facts) for name, facts in ((row[0], row[1:]) for row in rows))
        _groups.append(Group(group, function))
        return function
    return add


@cache
def groups() -> tuple[Group, ...]:
    """In the order of their observables in an observation: those of contacts, of positions, then of grains alone."""
    from . import force_observables, grain_observables, overlap_observables, position_observables
    files = [module.__name__ for module in (force_observables, position_observables, overlap_observables, grain_observables)]
    return tuple(sorted(_groups, key=lambda group: files.index(group.function.__module__)))


@cache
def observables() -> tuple[Observable, ...]:
    """In the order of an observation's entries."""
    return (TOP_FORCE, *(one for group in groups() for one in group.observables), *OF_PROGRAMMES)


@cache
def index_of(name: str) -> int:
    """Of an observable in the table."""
    return [one.name for one in observables()].index(name)
