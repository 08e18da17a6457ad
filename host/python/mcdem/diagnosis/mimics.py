"""Causes outside the library that act much like an effect of it, and the measurement that tells them apart. One more is one line of MIMICS."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Mimic:
    """A cause that is in no library and that an effect was, or may be, named for."""

    effects: tuple[str, ...]  # that it acts like
    what: str
    told_by: str  # what to measure to exclude it


MIMICS = (
    Mimic(("plasticity",), "grains that lose volume under load or with time (drainage, drying)",
          "measure the grains' diameters before and after the test"),
    Mimic(("viscoelasticity",), "grains that drain under load",
          "hold the plate at full stroke with grains of two sizes: drainage takes a time in proportion to the square of the size"),
    Mimic(("diameter_error", "position_bias", "height_bias"), "grains that swell or shrink during the test",
          "measure the grains' diameters before and after the test"),
    Mimic(("box_width", "box_depth"), "walls that bend under load", "measure the container's width in the images at rest and at full load"),
    Mimic(("stiffening", "law_exponent", "finite_strain"), "grains that are not uniform (a skin, a core)",
          "compress a single grain between two plates to the same overlap"),
    Mimic(("cross_contact", "bulge_contacts"), "grains whose modulus depends on the load",
          "compress a single grain between two plates, and then with its sides confined"),
    Mimic(("friction", "wall_friction", "friction_history", "rolling_resistance", "polydispersity"), "grains that are not round",
          "compare the widths of grains along three axes in the images"),
    Mimic(("modulus_scatter",), "a modulus that depends on the size or the place of a grain",
          "compress single grains of several sizes and from several places"),
    Mimic(("adhesion", "adhesion_net_friction", "cohesion"), "liquid bridges, which also pull across gaps",
          "record the force on the plate until it has left the grains"),
    Mimic(("buoyancy",), "a liquid whose level or density changes", "weigh a grain in the liquid before and after the test"),
    Mimic(("plate_tilt", "plate_tilt_y"), "a curved plate or a load that is not vertical",
          "measure the height of the plate at three points at full load"),
    Mimic(("plate_compliance",), "a floor or a frame that gives way", "press the plate on the floor of the empty container"),
    Mimic(("gauge_drift", "zero_drift"), "a modulus that changes during the test (drying, temperature)",
          "read a known weight with the load cell before and after the test"),
    Mimic(("gauge_hysteresis", "guide_friction", "force_lag"), "friction at the edge of the plate",
          "move the plate up and down in the empty container"),
    Mimic(("force_bias", "force_saturation", "force_threshold", "lost_contacts"), "an analysis that mixes the forces of a grain's contacts",
          "check in one frame that the forces on each grain balance"),
)


def mimics_of(effect: str) -> tuple[Mimic, ...]:
    """Those that act like this effect."""
    return tuple(mimic for mimic in MIMICS if effect in mimic.effects)
