"""Enumerations of scenes and results, with the names that files and scenes use (host/core/names.h)."""
from enum import Enum, IntEnum, StrEnum
from typing import TypeVar


class ContactModel(StrEnum):
    """How a force at one contact of a grain displaces its surface at the others."""

    independent = "independent"
    point_force_on_sphere = "point_force_on_sphere"
    sphere_to_sphere = "sphere_to_sphere"
    elastic_half_space = "elastic_half_space"
    mc_dem = "mc_dem"
    elastic_sphere = "elastic_sphere"
    hyperelastic_sphere = "hyperelastic_sphere"


class FrictionLaw(StrEnum):
    """Tangential force of a contact."""

    saturated = "saturated"
    mindlin = "mindlin"
    mindlin_displacement = "mindlin_displacement"


class ContainerShape(StrEnum):
    """Boundary at the sides; a `cell` is periodic along x, y and z."""

    box = "box"
    cylinder = "cylinder"
    periodic = "periodic"
    cell = "cell"


class Wall(IntEnum):
    """Row of a wall in `Scans.wall_force`; as a contact's partner it is -1 - wall. The side of a cylinder is x_min."""

    x_min = 0
    x_max = 1
    y_min = 2
    y_max = 3
    floor = 4
    plate = 5


class Phase(IntEnum):
    """Of a scan; `.name` is its name in files."""

    load = 0
    unload = 1


Name = TypeVar("Name", bound=Enum)


def parse(names: type[Name], word: str) -> Name | None:
    """The member with this name, if any."""
    return names.__members__.get(word)


def all_names(names: type[Enum]) -> str:
    """For messages: "a, b, c"."""
    return ", ".join(names.__members__)
