"""A simulation and the instrument that measures it: what effects and uncertain parameters change."""
from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ..experiment.instrument import Instrument
from ..observe.contact_residuals import Material
from ..results.parameters import has_programme

if TYPE_CHECKING:
    from .._engine import Scene


@dataclass(frozen=True, eq=False)
class Model:
    base: Scene  # its first replica
    changes: Mapping[str, Any]  # other values of its keys
    instrument: Instrument
    mean_diameter: float  # of the experiment's grains [m]
    experiment_speed: float | None = None  # of the experiment's plate [m/s]; None: slow

    @cached_property
    def scene(self) -> Scene:
        """The base with the changes."""
        return self.base._variant(dict(self.changes)) if self.changes else self.base

    @cached_property
    def texts(self) -> dict[str, str]:
        """All keys of the scene that determine a simulation of given grains, with their values as text."""
        return {key: text for key, text in self.scene._texts.items() if not key.startswith("packing.")}

    @cached_property
    def digest(self) -> str:
        """Of `texts`."""
        return hashlib.sha256(repr(self.texts).encode()).hexdigest()

    def __getitem__(self, key: str) -> Any:
        """The value of a key of the scene; None where it does not apply."""
        return self.changes[key] if key in self.changes else self._values[key]

    @cached_property
    def _values(self) -> Mapping[str, Any]:
        return self.base._values

    def with_keys(self, changes: Mapping[str, Any]) -> Model:
        """With other values of keys of the scene."""
        return replace(self, changes={**self.changes, **changes})

    def read_with(self, **changes: Any) -> Model:
        """With another instrument."""
        return replace(self, instrument=replace(self.instrument, **changes))

    @property
    def has_programme(self) -> bool:
        return has_programme(self._values)

    @property
    def stage_speeds(self) -> list[str]:
        """Keys of the stages that set the plate's speed."""
        return [key for key, value in self._values.items() if key.startswith("programme.") and key.endswith(".speed") and value is not None]

    def material(self) -> Material:
        """What the residuals of contacts assume."""
        return Material(self["grains.youngs_modulus"], self["grains.poisson_ratio"], self["walls.youngs_modulus"], self["walls.poisson_ratio"],
                        self["grains.friction"], self.instrument.stated.force_threshold)
