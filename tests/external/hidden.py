"""What the realities of a sealed challenge hide: an effect of mcdem's library, or something that no library has, as another code
simulates it or as an instrument would read it.

An entry changes the arguments of cases.liggghts(), cases.lammps() or cases.yade(), the reality itself (realities.DEFAULTS), or the scans that
were measured. Amplitudes are those of host/diagnose/infer/effects.cpp.
"""
import dataclasses
import math
import random
import statistics
import typing

import cases
import realities

EXCESS_DENSITY = realities.DENSITY
MATERIALS = 8  # of grains whose modulus scatters


@dataclasses.dataclass
class Hidden:
    low: float                                       # of the amplitude, drawn log-uniform
    high: float
    meaning: str
    signed: bool = False                             # either sign
    codes: tuple = ("liggghts", "lammps", "yade")
    arguments: typing.Callable = None                # (code, amplitude, chance) -> arguments of the code's function in cases
    reality: typing.Callable = None                  # amplitude -> further keys of the reality
    reading: typing.Callable = None                  # (scans, amplitude, chance): changes them

    def draw(self, chance):
        amplitude = self.low * (self.high / self.low)**chance.random()
        return -amplitude if self.signed and chance.random() < 0.5 else amplitude


def rolling(code, amplitude, chance):
    if code == "lammps":
        return {"further": f"rolling sds 20.0 0.0 {amplitude}"}
    return {"further": "rolling_friction cdt", "rolling": amplitude}


def scattered_moduli(code, amplitude, chance):
    """The quantiles of a log-normal distribution with that standard deviation, one a material."""
    moduli = [statistics.NormalDist().inv_cdf((k + 0.5) / MATERIALS) for k in range(MATERIALS)]
    spread = math.sqrt(sum(m * m for m in moduli) / MATERIALS)
    return {"moduli": tuple(cases.E * math.exp(amplitude * m / spread) for m in moduli)}


def soft_walls(code, amplitude, chance):
    """`amplitude`: modulus of the walls over that of the grains. A wall as stiff as a is a contact stiffness of 1 / (1 + 1/a)."""
    if code == "lammps":
        return {"wall_stiffness": 1 / (1 + 1 / amplitude)}
    return {"wall_youngs_modulus": amplitude * cases.E}


# What instruments do. Scans as realities.simulate returns them.

def change_diameters(scans, error):
    """`error`: of the stated diameter, by grain."""
    for scan in scans:
        scan["grains"] = [(d - error(i), *centre) for i, (d, *centre) in enumerate(scan["grains"])]


def diameter_error(scans, amplitude, chance):
    change_diameters(scans, lambda i: amplitude)


def polydispersity(scans, amplitude, chance):
    errors = [chance.gauss(0, amplitude) for _ in scans[0]["grains"]]
    change_diameters(scans, errors.__getitem__)


def change_points(scans, change):
    """Of grains and contacts alike."""
    for scan in scans:
        scan["grains"] = [(d, *change(centre)) for d, *centre in scan["grains"]]
        scan["contacts"] = [(i, j, change(point), force) for i, j, point, force in scan["contacts"]]


MIDDLE = (realities.BOX / 2, realities.BOX / 2, 0)


def position_bias(scans, amplitude, chance):
    change_points(scans, lambda point: [m + (1 + amplitude) * (p - m) for p, m in zip(point, MIDDLE)])


def vertical_stretch(scans, amplitude, chance):
    change_points(scans, lambda point: [point[0], point[1], (1 + amplitude) * point[2]])


def barrel(scans, amplitude, chance):
    """Lateral distances from the axis are read too large by this part at a side's middle, by its square less inside."""
    def change(point):
        out = [p - m for p, m in zip(point[:2], MIDDLE)]
        part = amplitude * sum(o * o for o in out) / (realities.BOX / 2)**2
        return [m + (1 + part) * o for m, o in zip(MIDDLE, out)] + [point[2]]
    change_points(scans, change)


def change_forces(scans, factor):
    """Of contacts: factor(grain, partner, size of the force)."""
    for scan in scans:
        scan["contacts"] = [(i, j, point, [factor(i, j, math.hypot(*force)) * f for f in force])
                            for i, j, point, force in scan["contacts"]]


def force_bias(scans, amplitude, chance):
    change_forces(scans, lambda i, j, size: 1 + amplitude)


def force_saturation(scans, amplitude, chance):
    """Forces are read as f / (1 + f/f0), with f0 = 1/amplitude."""
    change_forces(scans, lambda i, j, size: 1 / (1 + amplitude * size))


def dim_walls(scans, amplitude, chance):
    change_forces(scans, lambda i, j, size: 1 - amplitude if isinstance(j, str) else 1)


def missing_contacts(scans, amplitude, chance):
    """Every contact of two grains is overlooked with this probability, whatever its force."""
    for scan in scans:
        scan["contacts"] = [c for c in scan["contacts"] if isinstance(c[1], str) or chance.random() >= amplitude]


def missing_grains(scans, amplitude, chance):
    """The part of the grains that is not found, with its contacts."""
    count = len(scans[0]["grains"])
    kept = sorted(chance.sample(range(count), count - round(amplitude * count)))
    number = {grain: n for n, grain in enumerate(kept)}
    for scan in scans:
        scan["grains"] = [scan["grains"][grain] for grain in kept]
        scan["contacts"] = [(number[i], j if isinstance(j, str) else number[j], point, force)
                            for i, j, point, force in scan["contacts"] if i in number and (isinstance(j, str) or j in number)]


def plate_compliance(scans, amplitude, chance):
    for scan in scans:
        scan["height"] -= amplitude * scan["top"]


def backlash(scans, amplitude, chance):
    for scan in scans:
        if scan["phase"] == "unload":
            scan["height"] += amplitude


def gauge_drift(scans, amplitude, chance):
    for n, scan in enumerate(scans):
        scan["top"] *= 1 + amplitude * n / (len(scans) - 1)


def late_force(scans, amplitude, chance):
    """The gauge's clock is late by this part of the time between scans."""
    tops = [scan["top"] for scan in scans]
    for scan, before, now in zip(scans[1:], tops, tops[1:]):
        scan["top"] = now + amplitude * (before - now)


def gauge_hysteresis(scans, amplitude, chance):
    """On the way back the gauge reads too much: nothing where it turns and at no force, this part of the highest force at half
    of it."""
    highest = max(scan["top"] for scan in scans)
    for scan in scans:
        if scan["phase"] == "unload":
            scan["top"] += 4 * amplitude * scan["top"] * (1 - scan["top"] / highest)


def zero_drift(scans, amplitude, chance):
    """The gauge's zero moves, by this part of the highest force in the end."""
    highest = max(scan["top"] for scan in scans)
    for n, scan in enumerate(scans):
        scan["top"] += amplitude * highest * n / (len(scans) - 1)


LIBRARY = {
    "cross_contact": Hidden(0.25, 1.5, "multi-contact model, gamma; the strongest may run away and are left out", codes=("liggghts",), arguments=lambda code, a, chance: {
        "further": "surface multicontact", "skin": 0.004, "gamma": a}),
    "friction": Hidden(0.02, 0.11, "more friction between grains", arguments=lambda code, a, chance: {
        "friction": cases.FRICTION + a}),
    "wall_friction": Hidden(0.02, 0.11, "more friction at walls", arguments=lambda code, a, chance: {
        "wall_friction": cases.FRICTION + a}),
    "adhesion": Hidden(0.15, 1.2, "DMT, work of adhesion [J/m2]", codes=("lammps",), arguments=lambda code, a, chance: {
        "work": a}),
    "rolling_resistance": Hidden(0.04, 0.22, "constant couple (LIGGGHTS) or spring and slider (LAMMPS)", codes=("liggghts", "lammps"),
                                 arguments=rolling),
    "buoyancy": Hidden(14, 43, "grains heavier than stated [kg/m3]", reality=lambda a: {
        "weight": 1 + a / EXCESS_DENSITY}),
    "modulus_scatter": Hidden(0.1, 0.6, "eight materials dealt at random, sd of ln E", codes=("liggghts", "yade"),
                              arguments=scattered_moduli),
    "plate_tilt": Hidden(0.008, 0.023, "slope along x", signed=True, reality=lambda a: {"tilt": a}),
    "diameter_error": Hidden(7e-5, 1.9e-4, "true less stated [m]", signed=True, reading=diameter_error),
    "polydispersity": Hidden(9e-5, 6.4e-4, "sd of true less stated [m]", reading=polydispersity),
    "plate_compliance": Hidden(2e-5, 1.5e-4, "[m/N]", reading=plate_compliance),
    "force_bias": Hidden(0.05, 0.15, "contact forces read too large", signed=True, reading=force_bias),
    "gauge_drift": Hidden(0.05, 0.15, "gain of the gauge, in the end", signed=True, reading=gauge_drift),
    "force_saturation": Hidden(0.3, 2, "1/f0 of f/(1 + f/f0) [1/N]", reading=force_saturation),
    "zero_drift": Hidden(0.01, 0.05, "of the gauge, over the highest force", signed=True, reading=zero_drift),
    "gauge_hysteresis": Hidden(0.025, 0.1, "of the gauge, over the highest force", reading=gauge_hysteresis),
    "position_bias": Hidden(0.0015, 0.0045, "lengths read too large", signed=True, reading=position_bias),
}

OUTSIDE = {
    "leaning_box": Hidden(0.03, 0.15, "tangent of the angle by which the cell stands crooked", reality=lambda a: {"lean": a}),
    "soft_walls": Hidden(0.5, 3, "modulus of the walls over that of the grains", arguments=soft_walls),
    "rough_floor": Hidden(0.15, 0.6, "friction at the floor", arguments=lambda code, a, chance: {"floor_friction": a}),
    "area_cohesion": Hidden(50, 400, "SJKR [J/m3]", codes=("liggghts",), arguments=lambda code, a, chance: {
        "further": "cohesion sjkr", "cohesion_energy": a}),
    "vertical_stretch": Hidden(0.005, 0.015, "heights of grains read too large", signed=True, reading=vertical_stretch),
    "barrel": Hidden(0.005, 0.02, "lateral distortion at the sides", signed=True, reading=barrel),
    "missing_grains": Hidden(0.03, 0.1, "part of the grains not found", reading=missing_grains),
    "missing_contacts": Hidden(0.08, 0.25, "part of the contacts overlooked", reading=missing_contacts),
    "dim_walls": Hidden(0.08, 0.3, "part of the forces at walls that is not seen", reading=dim_walls),
    "late_force": Hidden(0.2, 0.6, "lateness of the gauge over the time between scans", reading=late_force),
    "backlash": Hidden(4e-4, 1.5e-3, "plate read too high on the way up [m]", signed=True, reading=backlash),
}


def find(name):
    return LIBRARY.get(name) or OUTSIDE[name]


def simulated(folder, case):
    """The scans of a case (challenge's), as its instrument reads them but for noise."""
    chance = random.Random(case["seed"])
    arguments, further = {}, {"slower": case["slower"], "held": case["held"]}
    modulus = cases.E * math.exp(case["modulus"])
    for name, amplitude in case["effects"]:
        entry = find(name)
        arguments |= entry.arguments(case["code"], amplitude, chance) if entry.arguments else {}
        further |= entry.reality(amplitude) if entry.reality else {}
    if case["code"] == "lammps":
        reality = cases.lammps(modulus=modulus, **arguments)
    else:
        moduli = arguments.pop("moduli", (cases.E,))
        reality = getattr(cases, case["code"])(moduli=tuple(m * math.exp(case["modulus"]) for m in moduli), **arguments)
    scans = realities.simulate(folder, case["seed"], {**reality, **further})
    for name, amplitude in case["effects"]:
        if find(name).reading:
            find(name).reading(scans, amplitude, chance)
    for scan in scans:
        scan["height"] += case["strain_offset"]
    return scans
