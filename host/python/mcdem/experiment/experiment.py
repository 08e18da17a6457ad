"""A measured compression, in the form of a simulated recording (host/experiment/README.md describes its folder)."""
from dataclasses import dataclass, field

from ..results.recording import Recording

# The scene keys that `materials` and `uncertainty` may contain.
MATERIALS = ("grains.youngs_modulus", "grains.poisson_ratio", "grains.excess_density", "grains.friction", "grains.restitution",
             "walls.youngs_modulus", "walls.friction")


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
    uncertainty: dict[str, float] = field(default_factory=dict)  # one sigma of some of MATERIALS
    measurement: Measurement = field(default_factory=Measurement)
    plate_speed: float | None = None  # [m/s]; None: slow
    plate_pause: float = 0.0  # the plate stands for this time at each scan [s]; 0: it does not stop
    plate_hold: float = 0.0  # .. at the lowest position [s]
