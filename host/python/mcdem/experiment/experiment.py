"""A measured compression, in the form of a simulated recording (host/python/mcdem/experiment/README.md describes its folder)."""
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..number_text import shortest
from ..results.recording import Ints, Recording
from .sample import Sample

# The scene keys that `materials` may contain, and those of `uncertainty`.
MATERIALS = ("grains.youngs_modulus", "grains.poisson_ratio", "grains.excess_density", "grains.friction", "grains.restitution",
             "walls.youngs_modulus", "walls.friction")
UNCERTAIN = *MATERIALS, "plate.start", "grains.diameter"


def other_materials(stated: Mapping[str, float], parameters: Mapping[str, Any]) -> list[str]:
    """Simulations have the materials of the scene: "grains.youngs_modulus = 30000 (scene: 23300)" for each that is `stated` and that the scene
    with these parameters does not have. With several species, which have their own, none."""
    if "species.1.name" in parameters:
        return []
    return [f"{key} = {shortest(value)} (scene: {shortest(used)})" for key, value in sorted(stated.items())
            if isinstance(used := parameters.get(key), (int, float)) and abs(used - value) > 1e-6 * abs(value)]


@dataclass(frozen=True)
class Measurement:
    """Accuracy of the measurement; simulations are measured with the same instrument before they are compared."""

    position_error: float = 0.0  # sigma of every coordinate of a centre [m]
    diameter_error: float = 0.0  # sigma [m]
    force_error: float = 0.0  # relative sigma of a contact force
    force_threshold: float = 0.0  # weaker contacts are not detected [N]


@dataclass(frozen=True, eq=False)
class Experiment:
    """The measurements of one packing, in SI units; what was not measured is NaN or empty."""

    name: str
    recording: Recording  # Z, <f> and <b> are computed from the contacts above the force threshold
    materials: dict[str, float] = field(default_factory=dict)  # measured values of MATERIALS
    uncertainty: dict[str, float] = field(default_factory=dict)  # one sigma of some of UNCERTAIN
    measurement: Measurement = field(default_factory=Measurement)
    plate_speed: float | None = None  # [m/s]; None: slow
    plate_pause: float = 0.0  # the plate stands for this time at each scan [s]; 0: it does not stop
    plate_hold: float = 0.0  # .. at the lowest position [s]
    sample: Sample | None = None  # of any size, of which simulations are a part
    topology: Ints = field(default_factory=lambda: np.zeros((0, 3), int))  # (N, 3) contacts without forces: frame, grain, partner

    @property
    def has_grains_alone(self) -> bool:
        """Whether grains were measured under load, but no contact forces."""
        scans = self.recording.scans
        return any(map(len, scans.position[1:])) and not any(map(len, scans.contacts))
