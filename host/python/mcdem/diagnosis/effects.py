"""The library of effects that a simulation may neglect, and of uncertain parameters. A new effect is one entry of EFFECTS."""
from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from .model import Model

Scale = Callable[[Model], float]
Apply = Callable[[Model, float], Model]  # the model with this amplitude
Hindrance = Callable[[Model], str]  # why a model cannot have the effect; empty if it can


@dataclass(frozen=True)
class Effect:
    """A way in which an experiment may differ from the scene; its amplitude is zero for the scene as it is."""

    name: str
    words: str  # in texts; empty: the name with blanks
    unit: str  # of the amplitude; empty for dimensionless ones
    formula: str  # meaning of the amplitude
    source: str  # reference for the formula
    low: float  # range of plausible amplitudes, over the scale
    high: float
    first: float  # amplitudes of the paired runs, over the scale
    second: float
    apply: Apply
    scale: Scale = lambda model: 1.0  # natural scale of the amplitude in a model [unit]: comparable for soft and stiff, small and large grains
    hindrance: Hindrance = lambda model: ""
    # Effects of the simulation's own numerics: keys that are lowered together; the first is recommended to the user.
    settings: Callable[[Model], list[str]] | None = None
    depends_on_speed: bool = False  # of the plate

    @property
    def numerical(self) -> bool:
        """Whether it is an effect of the simulation's own numerics."""
        return self.settings is not None


def _reduced_modulus(m: Model) -> float:
    return float(m["grains.youngs_modulus"] / (2 * (1 - m["grains.poisson_ratio"] ** 2)))


def _diameter(m: Model) -> float:
    return m.mean_diameter


def _adhesive_scale(m: Model) -> float:
    return _reduced_modulus(m) * m.mean_diameter / 4  # E* R*


def _compliance_scale(m: Model) -> float:
    return 1 / (float(m["grains.youngs_modulus"]) * max(float(m["box.size_x"]), float(m["box.size_y"])))


def _excess_density(m: Model) -> float:
    return max(abs(float(m["grains.excess_density"])), 0.02 * float(m["grains.density"]))


def _friction_scale(m: Model) -> float:
    return max(float(m["grains.friction"]), 0.02)


def _interacts(m: Model) -> bool:
    return bool(m["contact.model"] != "independent")


def _plus(key: str) -> Apply:
    """Adds the amplitude to a key."""
    return lambda m, a: m.with_keys({key: m[key] + a})


def _share(key: str) -> Apply:
    """Adds the fraction a of the remainder 1 - share."""
    return lambda m, a: m.with_keys({key: m[key] + a * (1 - m[key])})


def _not_negative(key: str) -> Apply:
    return lambda m, a: m.with_keys({key: max(0.0, m[key] + a)})


def _read(name: str) -> Apply:
    """Adds the amplitude to an error of the instrument."""
    return lambda m, a: m.read_with(**{name: getattr(m.instrument, name) + a})


def _cross_contact(m: Model, a: float) -> Model:
    return m.with_keys({"contact.model": "mc_dem", "contact.gamma": a})


def _net_adhesion(m: Model, a: float) -> Model:
    return m.with_keys({"effects.adhesion": m["effects.adhesion"] + a} | ({"effects.net_force_friction": 1.0} if a > 0 else {}))


MAX_SLOWDOWN = 8  # runs with an effect of numerics take at most this factor longer
SLOW_TOLERANCE = 0.01  # with a rate tolerance up to this value, the plate's speed is not tested by runs


def _lower(settings: Callable[[Model], list[str]]) -> Apply:
    """Reduces settings by the fraction a."""
    return lambda m, a: m.with_keys({key: m[key] * max(1 - a, 1 / MAX_SLOWDOWN) for key in settings(m)})


def _plate_speed(m: Model) -> list[str]:
    return (["protocol.rate_tolerance"] if m["protocol.rate_tolerance"] > 0 else []) + ["plate.speed", *m.stage_speeds]


def _density(m: Model) -> list[str]:
    return ["grains.density"]


def _time_step(m: Model) -> list[str]:
    return ["numerics.time_step"]


def _slow_enough(m: Model) -> str:
    """Speed and inertia affect results only through the inertial number, which such a plate limits."""
    return ("protocol.rate_tolerance keeps what the plate's speed and inertia add below 1 % of mean forces; `mcdem converge` measures it"
            if 0 < m["protocol.rate_tolerance"] <= SLOW_TOLERANCE else "")


def _no_slower_plate(m: Model) -> str:
    if reason := _slow_enough(m):
        return reason
    is_fast = m.experiment_speed is not None and m.experiment_speed >= m["plate.speed"]
    return "the experiment's plate is stated to move as fast as the scene's" if is_fast else ""


def _interacting_already(m: Model) -> str:
    return "the contacts of the scene interact already" if _interacts(m) else ""


def _independent_contacts(m: Model) -> str:
    return "" if _interacts(m) else "independent contacts have no surface displacements"


def _not_elastic_sphere(m: Model) -> str:
    return "" if m["contact.model"] == "elastic_sphere" else "only grains of elastic_sphere have a law of finite strain, hyperelastic_sphere"


def _no_friction(m: Model) -> str:
    return "" if m["grains.friction"] > 0 else "the scene has no friction"


def _no_other_limit(m: Model) -> str:
    if m["effects.adhesion"] > 0:
        return "the scene has adhesion; effects.net_force_friction sets its Coulomb limit"
    return _no_friction(m)


def _no_sides(m: Model) -> str:
    return ("a periodic container repeats: its plate is level, and its period gives the scale of lengths"
            if m["container.shape"] == "periodic" else "")


def _no_walls(m: Model) -> str:
    return "" if m["container.shape"] in ("box", "cylinder") else "a periodic container has no side walls"


def _no_depth(m: Model) -> str:
    return "a cylinder is as wide along y as along x" if m["container.shape"] == "cylinder" else _no_walls(m)


def _no_threshold(m: Model) -> str:
    return "" if m.instrument.stated.force_threshold > 0 else "the experiment states no force threshold"


EFFECTS = (
    Effect("cross_contact", "cross-contact deformation", "",
           "gamma of the paper's Eq. 1: the force at a contact displaces the surface at all other contacts",
           "Brodu, Dijksman & Behringer 2015", 0, 1.8, 0.5, 1.0, _cross_contact, hindrance=_interacting_already),
    Effect("bulge_contacts", "contacts made by surface displacement", "",
           "fraction of the surface displacement that creates no contact between spheres that do not overlap undeformed",
           "Brodu, Dijksman & Behringer 2015", 0, 1, 0.5, 1.0,
           lambda m, a: m.with_keys({"effects.bulge_contacts": m["effects.bulge_contacts"] * (1 - a)}), hindrance=_independent_contacts),
    Effect("friction", "friction between grains", "", "change of mu between grains", "Coulomb", -1, 8, -0.7, 2.5,
           _not_negative("grains.friction"), _friction_scale),
    Effect("wall_friction", "friction at the walls", "", "change of mu at walls", "Coulomb", -1, 8, -0.7, 2.5,
           _not_negative("walls.friction"), lambda m: max(float(m["walls.friction"]), 0.02)),
    Effect("friction_history", "friction with memory", "", "share of the other law of friction (saturated or Mindlin's)",
           "Mindlin & Deresiewicz 1953", 0, 1, 0.5, 1.0, _share("effects.friction_history"), hindrance=_no_friction),
    Effect("adhesion", "", "J/m2", "work of adhesion w: touching grains attract by 2 pi w R*", "Derjaguin, Muller & Toporov 1975",
           0, 0.03, 0.003, 0.01, _plus("effects.adhesion"), _adhesive_scale),
    Effect("adhesion_net_friction", "adhesion with friction of the net force", "J/m2", "adhesion where Coulomb's law holds for the net force",
           "Derjaguin, Muller & Toporov 1975", 0, 0.03, 0.003, 0.01, _net_adhesion, _adhesive_scale, _no_other_limit),
    Effect("cohesion", "cohesion per contact area", "J/m3", "k: attraction over the area 2 pi R* overlap of a contact",
           '"SJKR" of LIGGGHTS', 0, 0.1, 0.005, 0.02, _plus("effects.cohesion"), _reduced_modulus),
    Effect("viscoelasticity", "", "", "fraction of the Hertz force that relaxes while a contact is held", "standard linear solid",
           0, 0.8, 0.1, 0.3, _share("effects.viscoelasticity"), depends_on_speed=True),
    Effect("stiffening", "stiffening at large strain", "", "c in F = F_Hertz (1 + c overlap/R*)", "first correction to Hertz at large strain",
           -1.5, 4, -0.7, 1.2, _plus("effects.stiffening")),
    Effect("law_exponent", "exponent of the contact law", "", "m: contact forces grow with the power 3/2 + m of the overlap; at 0.1 R* they are Hertz's",
           "power law (Hertz 1882: m = 0)", -0.4, 0.8, -0.1, 0.2, _plus("effects.law_exponent")),
    Effect("finite_strain", "finite strain of the grains", "", "fraction of the finite-strain correction of an elastic sphere",
           "finite elements of a neo-Hookean sphere", 0, 1, 0.5, 1.0, _share("effects.finite_strain"), hindrance=_not_elastic_sphere),
    Effect("plasticity", "", "", "fraction of the largest overlap that remains after unloading", "Walton & Braun 1986",
           0, 0.5, 0.05, 0.15, _share("effects.plasticity")),
    Effect("buoyancy", "weight under buoyancy", "kg/m3", "change of the grains' density over the fluid's", "Archimedes", -8, 30, -2.5, 2.5,
           _plus("grains.excess_density"), _excess_density),
    Effect("diameter_error", "error of all diameters", "m", "true minus stated diameter, equal for all grains", "measurement",
           -0.03, 0.03, -0.006, 0.006, _plus("effects.diameter_error"), _diameter),
    Effect("polydispersity", "scatter of diameters", "m", "standard deviation of true minus stated diameter", "measurement",
           0, 0.05, 0.008, 0.02, _plus("effects.polydispersity"), _diameter),
    Effect("modulus_scatter", "scatter of moduli", "", "standard deviation of ln E from grain to grain", "log-normal scatter",
           0, 0.8, 0.15, 0.4, _plus("effects.modulus_scatter")),
    Effect("rolling_resistance", "", "", "mu_r: a spring resists rolling and yields at the torque mu_r R* F_n",
           "Iwashita & Oda 1998; Ai et al. 2011, model C", 0, 1.5, 0.5, 1.5, _plus("effects.rolling_resistance"), _friction_scale),
    Effect("box_width", "width of the container along x", "m", "true minus stated width along x", "geometry", -0.15, 0.3, -0.02, 0.04,
           _plus("effects.width_error_x"), _diameter, _no_walls),
    Effect("box_depth", "width of the container along y", "m", "true minus stated width along y", "geometry", -0.15, 0.3, -0.02, 0.04,
           _plus("effects.width_error_y"), _diameter, _no_depth),
    Effect("plate_tilt", "tilt of the plate along x", "", "slope of the plate along x", "geometry", -0.08, 0.08, -0.015, 0.015,
           _plus("effects.plate_tilt_x"), hindrance=_no_sides),
    Effect("plate_tilt_y", "tilt of the plate along y", "", "slope of the plate along y", "geometry", -0.08, 0.08, -0.015, 0.015,
           _plus("effects.plate_tilt_y"), hindrance=_no_sides),
    Effect("plate_compliance", "compliance of the plate", "m/N", "deflection of the plate per newton", "linear spring", 0, 1, 0.1, 0.3,
           _plus("effects.plate_compliance"), _compliance_scale),
    Effect("force_bias", "bias of contact forces", "relative", "relative error by which contact forces are measured too large", "measurement",
           -0.5, 0.8, -0.1, 0.1, _read("force_bias")),
    Effect("gauge_drift", "drift of the load cell's gain", "relative",
           "relative error of the load cell's gain at the end of the last cycle; it grows in proportion to the plate's path", "measurement",
           -0.5, 0.8, -0.1, 0.1, _read("gauge_drift")),
    Effect("zero_drift", "drift of the load cell's zero", "relative",
           "offset of the load cell at the end of the last cycle, over the maximum top force; it grows in proportion to the plate's path",
           "measurement", -0.5, 0.5, -0.03, 0.03, _read("zero_drift")),
    Effect("gauge_hysteresis", "hysteresis of the load cell", "relative",
           "excess of the top force during unloading, at half the maximum force, over the maximum force", "measurement",
           -0.3, 0.3, -0.03, 0.03, _read("gauge_hysteresis")),
    Effect("force_lag", "lag of the load cell", "m", "plate travel by which the reading of the top force lags", "measurement",
           0, 0.1, 0.01, 0.03, _read("force_lag"), _diameter),
    Effect("guide_friction", "friction of the plate's guide", "relative",
           "friction of the plate's guide, which the load cell also reads, over the maximum force", "measurement",
           0, 0.3, 0.01, 0.03, _read("guide_friction")),
    Effect("force_saturation", "saturation of contact forces", "1/N", "a in f/(1 + a f), what is read of a contact force f", "measurement",
           0, 50, 2, 6, _read("force_saturation"), lambda m: 1 / (float(m["grains.youngs_modulus"]) * m.mean_diameter**2)),
    Effect("force_threshold", "shifted force threshold", "N", "true minus stated threshold of contact forces", "measurement",
           -1, 8, -0.5, 1.5, _read("threshold_shift"), lambda m: m.instrument.stated.force_threshold, _no_threshold),
    Effect("position_bias", "bias of positions", "relative", "relative error by which lengths are measured too large", "measurement",
           -0.02, 0.02, -0.003, 0.003, _read("position_bias"), hindrance=_no_sides),
    Effect("height_bias", "bias of heights", "relative", "relative error by which heights of grains, not of the plate, are measured too large",
           "measurement", -0.02, 0.02, -0.003, 0.003, _read("height_bias")),
    Effect("lost_contacts", "contacts that are not seen", "", "fraction of the contacts between grains that the analysis misses, whatever their force", "measurement",
           0, 0.5, 0.03, 0.1, _read("lost_contacts")),
    Effect("plate_speed", "speed of the plate", "", "fraction by which the real plate is slower than the scene's", "numerics",
           0, 1, 0.5, 0.75, _lower(_plate_speed), hindrance=_no_slower_plate, settings=_plate_speed, depends_on_speed=True),
    Effect("inertia", "inertia of the grains", "", "fraction by which real inertia is smaller than the scene's, with the same weight",
           "numerics", 0, 1, 0.5, 0.75, _lower(_density), hindrance=_slow_enough, settings=_density, depends_on_speed=True),
    Effect("time_step", "", "", "fraction by which the time step is too long", "numerics", 0, 1, 0.3, 0.6, _lower(_time_step),
           settings=_time_step),
)


def find_effect(name: str) -> Effect | None:
    return next((effect for effect in EFFECTS if effect.name == name), None)


def is_numerical(name: str) -> bool:
    """Whether it is an effect of the simulation's own numerics."""
    effect = find_effect(name)
    return effect is not None and effect.numerical


def depends_on_speed(name: str) -> bool:
    """Whether it depends on the speed of the plate."""
    effect = find_effect(name)
    return effect is not None and effect.depends_on_speed


# Standard deviations of parameters whose uncertainty the experiment does not state.
MODULUS_SIGMA = 0.05
GAMMA_SIGMA = 0.05
STRAIN_ZERO_SIGMA = 0.01  # over the mean diameter
# .. of a packing whose grains were not measured: its height and packing fraction are known to one or two per cent. A packing that is looser by
# a part of its height carries nearly the same force where the plate is lower by that part.
HEIGHT_SIGMA = 0.1


@dataclass(frozen=True)
class Nuisance:
    """An uncertain parameter of the model, refitted in every comparison."""

    name: str
    unit: str
    sigma: float  # prior [unit]
    apply: Apply


def nuisances(model: Model, uncertainty: Mapping[str, float], has_grains: bool = True) -> list[Nuisance]:
    """The model's. Sigmas are taken from the experiment's [uncertainty] if given there. `has_grains`: their positions were measured."""
    modulus = uncertainty.get("grains.youngs_modulus", 0.0) / model["grains.youngs_modulus"]
    zero = uncertainty.get("plate.start", 0.0) or (STRAIN_ZERO_SIGMA if has_grains else HEIGHT_SIGMA) * model.mean_diameter
    found = [
        Nuisance("modulus", "relative", modulus if modulus > 0 else MODULUS_SIGMA,
                 lambda m, shift: m.with_keys({"grains.youngs_modulus": m["grains.youngs_modulus"] * math.exp(shift)})),
        Nuisance("strain_offset", "m", zero, _read("strain_offset"))]
    if model["contact.model"] == "mc_dem":
        found.append(Nuisance("gamma", "", GAMMA_SIGMA, _plus("contact.gamma")))
    for name, key in (("friction", "grains.friction"), ("wall_friction", "walls.friction"), ("diameter_error", "grains.diameter")):
        effect, sigma = find_effect(name), uncertainty.get(key, 0.0)
        if effect and sigma > 0:
            found.append(Nuisance(name, "", sigma, effect.apply))
    return found
