"""The candidate effects: their names, units and plausible amplitudes (host/diagnose/effects.cpp, which also applies them)."""
from dataclasses import dataclass
from functools import cache

from .. import _engine as engine


@dataclass(frozen=True)
class Effect:
    """A way in which an experiment may differ from the scene; its amplitude is zero for the scene as it is."""

    name: str
    words: str  # in texts; empty: the name with blanks
    unit: str  # of the amplitude; empty for dimensionless ones
    formula: str  # meaning of the amplitude
    source: str  # reference for the formula
    low: float  # range of plausible amplitudes, over the scale of the model
    high: float
    first: float  # amplitudes of the paired runs, over the scale of the model
    second: float
    numerical: bool  # an effect of the simulation's own numerics
    depends_on_speed: bool  # of the plate


@cache
def effects() -> tuple[Effect, ...]:
    """All candidates, in the order of the documentation."""
    return tuple(Effect(**row) for row in engine.effects())


def find_effect(name: str) -> Effect | None:
    return next((effect for effect in effects() if effect.name == name), None)


def is_numerical(name: str) -> bool:
    """Whether it is an effect of the simulation's own numerics."""
    effect = find_effect(name)
    return effect is not None and effect.numerical


def depends_on_speed(name: str) -> bool:
    """Whether it depends on the speed of the plate."""
    effect = find_effect(name)
    return effect is not None and effect.depends_on_speed
