"""Effects hidden in the simulated experiments of a sealed challenge: effects of mcdem's library, or others that no
library has, simulated by another code or applied to the measurements.

An entry changes the arguments of cases.liggghts(), cases.lammps() or cases.yade(), the keys of the experiment
(realities.DEFAULTS), or the measured scans. Amplitudes are defined as in host/python/mcdem/diagnosis/effects.py.
"""
import dataclasses
import math
import random
import statistics
import typing

import cases
import realities

EXCESS_DENSITY = realities.DENSITY
MATERIALS = 8  # grains with scattered moduli are distributed over this number


@dataclasses.dataclass
class Hidden:
    low: float                                       # of the amplitude, drawn log-uniformly
    high: float
    meaning: str
    signed: bool = False                             # both signs are possible
    codes: tuple = ("liggghts", "lammps", "yade")
    arguments: typing.Callable = None                # (code, amplitude, chance) -> arguments of the code's function in cases
    reality: typing.Callable = None                  # amplitude -> further keys of the experiment
    reading: typing.Callable = None                  # (scans, amplitude, chance): changes them

    def draw(self, chance):
        amplitude = self.low * (self.high / self.low)**chance.random()
        return -amplitude if self.signed and chance.random() < 0.5 else amplitude


def rolling(code, amplitude, chance):
    if code == "lammps":
        return {"further": f"rolling sds 20.0 0.0 {amplitude}"}
    return {"further": "rolling_friction epsd2", "rolling": amplitude}


def scattered_moduli(code, amplitude, chance):
    """Quantiles of a log-normal distribution with this standard deviation, one per material."""
    moduli = [statistics.NormalDist().inv_cdf((k + 0.5) / MATERIALS) for k in range(MATERIALS)]
    spread = math.sqrt(sum(m * m for m in moduli) / MATERIALS)
    return {"moduli": tuple(cases.E * math.exp(amplitude * m / spread) for m in moduli)}


def soft_walls(code, amplitude, chance):
    """`amplitude` a: modulus of the walls over that of the grains; contact stiffness is reduced to 1 / (1 + 1/a)."""
    if code == "lammps":
        return {"wall_stiffness": 1 / (1 + 1 / amplitude)}
    return {"wall_youngs_modulus": amplitude * cases.E}


# Errors of instruments. Scans are as returned by realities.simulate.

def change_diameters(scans, error):
    """`error(i)`: error of grain i's diameter [m]."""
    for scan in scans:
        scan["grains"] = [(d - error(i), *centre) for i, (d, *centre) in enumerate(scan["grains"])]


def diameter_error(scans, amplitude, chance):
    change_diameters(scans, lambda i: amplitude)


def polydispersity(scans, amplitude, chance):
    errors = [chance.gauss(0, amplitude) for _ in scans[0]["grains"]]
    change_diameters(scans, errors.__getitem__)


def change_points(scans, change):
    """Applies to grains and contacts."""
    for scan in scans:
        scan["grains"] = [(d, *change(centre)) for d, *centre in scan["grains"]]
        scan["contacts"] = [(i, j, change(point), force) for i, j, point, force in scan["contacts"]]


MIDDLE = (realities.BOX / 2, realities.BOX / 2, 0)


def position_bias(scans, amplitude, chance):
    """Lengths are read too large by this fraction."""
    change_points(scans, lambda point: [m + (1 + amplitude) * (p - m) for p, m in zip(point, MIDDLE)])


def height_bias(scans, amplitude, chance):
    change_points(scans, lambda point: [point[0], point[1], (1 + amplitude) * point[2]])


def barrel(scans, amplitude, chance):
    """Lateral distances from the axis are too large: by this fraction at a side's middle, decreasing inside with the
    square of the distance."""
    def change(point):
        out = [p - m for p, m in zip(point[:2], MIDDLE)]
        part = amplitude * sum(o * o for o in out) / (realities.BOX / 2)**2
        return [m + (1 + part) * o for m, o in zip(MIDDLE, out)] + [point[2]]
    change_points(scans, change)


def change_forces(scans, factor):
    """Multiplies contact forces by factor(grain, partner, force)."""
    for scan in scans:
        scan["contacts"] = [(i, j, point, [factor(i, j, math.hypot(*force)) * f for f in force])
                            for i, j, point, force in scan["contacts"]]


def force_bias(scans, amplitude, chance):
    change_forces(scans, lambda i, j, size: 1 + amplitude)


def force_saturation(scans, amplitude, chance):
    """Measured forces are f / (1 + f/f0), with f0 = 1/amplitude."""
    change_forces(scans, lambda i, j, size: 1 / (1 + amplitude * size))


def dim_walls(scans, amplitude, chance):
    change_forces(scans, lambda i, j, size: 1 - amplitude if isinstance(j, str) else 1)


def lost_contacts(scans, amplitude, chance):
    """Each contact of two grains is missed with this probability, whatever its force."""
    for scan in scans:
        scan["contacts"] = [c for c in scan["contacts"] if isinstance(c[1], str) or chance.random() >= amplitude]


def missing_grains(scans, amplitude, chance):
    """This fraction of the grains is missing, with their contacts."""
    count = len(scans[0]["grains"])
    kept = sorted(chance.sample(range(count), count - round(amplitude * count)))
    number = {grain: n for n, grain in enumerate(kept)}
    for scan in scans:
        scan["grains"] = [scan["grains"][grain] for grain in kept]
        scan["contacts"] = [(number[i], j if isinstance(j, str) else number[j], point, force)
                            for i, j, point, force in scan["contacts"] if i in number and (isinstance(j, str) or j in number)]


def swapped_labels(scans, amplitude, chance):
    """Tracking confuses this fraction of the grains, in pairs of nearest neighbours, from the second scan on. A
    label keeps the diameter of its first grain."""
    centres = [centre for _, *centre in scans[0]["grains"]]
    free, label = set(range(len(centres))), list(range(len(centres)))
    for i in chance.sample(range(len(centres)), round(amplitude * len(centres) / 2)):
        if i in free and len(free) > 1:
            free.remove(i)
            j = min(free, key=lambda k: math.dist(centres[i], centres[k]))
            free.remove(j)
            label[i], label[j] = j, i
    for scan in scans[1:]:
        scan["grains"] = [(d, *scan["grains"][label[i]][1:]) for i, (d, *_) in enumerate(scan["grains"])]
        scan["contacts"] = [(label[i], j if isinstance(j, str) else label[j], point, force)
                            for i, j, point, force in scan["contacts"]]


def mixed_forces(scans, amplitude, chance):
    """Forces are not resolved within a grain: each is read as its own, less this fraction, plus this fraction of the mean
    over the contacts of its grain."""
    for scan in scans:
        sizes = {}
        for i, j, _, force in scan["contacts"]:
            for grain in (i, j):
                sizes.setdefault(grain, []).append(math.hypot(*force))
        mean = {grain: statistics.fmean(of) for grain, of in sizes.items()}
        read = lambda i, j, size: 1 - amplitude + amplitude * statistics.fmean(
            mean[grain] for grain in (i, j) if not isinstance(grain, str)) / size if size > 0 else 1
        change_forces([scan], read)


def rotated_image(scans, amplitude, chance):
    """The image is rotated about a horizontal axis, by an angle with this tangent."""
    norm = math.hypot(1, amplitude)
    middle = statistics.fmean(grain[3] for grain in scans[0]["grains"])

    def change(point):
        x, z = point[0] - MIDDLE[0], point[2] - middle
        return [MIDDLE[0] + (x + amplitude * z) / norm, point[1], middle + (z - amplitude * x) / norm]
    change_points(scans, change)


def slow_scan(scans, amplitude, chance):
    """The image is taken from above to below and ends with the plate's reading: centres at the top are read where they were
    before, by this fraction of their way since the last scan, those at the floor where they are."""
    top = max(grain[3] for grain in scans[0]["grains"])
    before = scans[0]["grains"]
    for scan in scans[1:]:
        now = scan["grains"]
        scan["grains"] = [(d, *(p + amplitude * z / top * (q - p) for p, q in zip((x, y, z), old[1:])))
                          for (d, x, y, z), old in zip(now, before)]
        before = now


def plate_compliance(scans, amplitude, chance):
    for scan in scans:
        scan["height"] -= amplitude * scan["top"]


def backlash(scans, amplitude, chance):
    for scan in scans:
        if scan["phase"] == "unload":
            scan["height"] += amplitude


def share_of_first_cycle(scans):
    """By scan: number of scans before it, over that in the first cycle."""
    first = sum(scan.get("cycle", 0) == 0 for scan in scans) - 1
    return [n / first for n in range(len(scans))]


def gauge_drift(scans, amplitude, chance):
    for scan, share in zip(scans, share_of_first_cycle(scans)):
        scan["top"] *= 1 + amplitude * share


def force_lag(scans, amplitude, chance):
    """The top force is read as it was this way of the plate before, at most the way between two scans."""
    before = scans[0]["height"], scans[0]["top"]
    for scan in scans[1:]:
        now = scan["height"], scan["top"]
        scan["top"] += amplitude / abs(now[0] - before[0]) * (before[1] - now[1])
        before = now


def guide_friction(scans, amplitude, chance):
    """The plate's guide rubs: the gauge also reads this fraction of the largest force, against the motion."""
    highest = max(scan["top"] for scan in scans)
    for scan in scans[1:]:
        scan["top"] += amplitude * highest * (1 if scan["phase"] == "load" else -1)


def gauge_hysteresis(scans, amplitude, chance):
    """While unloading, the gauge reads too much: zero at the turning point and without force, this fraction of the
    largest force at half of it."""
    highest = max(scan["top"] for scan in scans)
    for scan in scans:
        if scan["phase"] == "unload":
            scan["top"] += 4 * amplitude * scan["top"] * (1 - scan["top"] / highest)


def zero_drift(scans, amplitude, chance):
    """The gauge's zero drifts; after the first cycle by this fraction of the largest force."""
    highest = max(scan["top"] for scan in scans)
    for scan, share in zip(scans, share_of_first_cycle(scans)):
        scan["top"] += amplitude * highest * share


def scale_drift(scans, amplitude, chance):
    """The scale of images drifts: after the first cycle lengths are read too large by this fraction."""
    for scan, share in zip(scans, share_of_first_cycle(scans)):
        position_bias([scan], amplitude * share, chance)


LIBRARY = {
    "cross_contact": Hidden(0.25, 1.5, "multi-contact model, gamma; the strongest may run away and are left out", codes=("liggghts",), arguments=lambda code, a, chance: {
        "further": "surface multicontact", "skin": 0.004, "gamma": a}),
    "friction": Hidden(0.02, 0.11, "more friction between grains", arguments=lambda code, a, chance: {
        "friction": cases.FRICTION + a}),
    "wall_friction": Hidden(0.02, 0.11, "more friction at walls", arguments=lambda code, a, chance: {
        "wall_friction": cases.FRICTION + a}),
    "adhesion_net_friction": Hidden(0.15, 1.2, "DMT, work of adhesion [J/m2]", codes=("lammps",), arguments=lambda code, a, chance: {
        "work": a}),
    "cohesion": Hidden(50, 400, "SJKR [J/m3]", codes=("liggghts",), arguments=lambda code, a, chance: {
        "further": "cohesion sjkr", "cohesion_energy": a}),
    "rolling_resistance": Hidden(0.004, 0.06, "spring and slider", codes=("liggghts", "lammps"),
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
    "gauge_drift": Hidden(0.05, 0.15, "gain of the gauge, after the first cycle", signed=True, reading=gauge_drift),
    "force_saturation": Hidden(0.3, 2, "1/f0 of f/(1 + f/f0) [1/N]", reading=force_saturation),
    "zero_drift": Hidden(0.01, 0.05, "of the gauge, over the highest force", signed=True, reading=zero_drift),
    "gauge_hysteresis": Hidden(0.025, 0.1, "of the gauge, over the highest force", reading=gauge_hysteresis),
    "force_lag": Hidden(3e-4, 1.2e-3, "way of the plate by which the gauge is late [m]", reading=force_lag),
    "guide_friction": Hidden(0.01, 0.04, "friction of the plate's guide, over the highest force", reading=guide_friction),
    "position_bias": Hidden(0.0015, 0.0045, "lengths read too large", signed=True, reading=position_bias),
    "height_bias": Hidden(0.003, 0.015, "heights of grains read too large", signed=True, reading=height_bias),
    "lost_contacts": Hidden(0.05, 0.25, "part of the contacts overlooked", reading=lost_contacts),
}

OUTSIDE = {
    "leaning_box": Hidden(0.03, 0.15, "tangent of the angle by which the cell stands crooked", reality=lambda a: {"lean": a}),
    "soft_walls": Hidden(0.5, 3, "modulus of the walls over that of the grains", arguments=soft_walls),
    "rough_floor": Hidden(0.15, 0.6, "friction at the floor", arguments=lambda code, a, chance: {"floor_friction": a}),
    "scale_drift": Hidden(0.004, 0.012, "lengths read too large, after the first cycle", signed=True, reading=scale_drift),
    "barrel": Hidden(0.005, 0.02, "lateral distortion at the sides", signed=True, reading=barrel),
    "missing_grains": Hidden(0.03, 0.1, "part of the grains not found", reading=missing_grains),
    "dim_walls": Hidden(0.08, 0.3, "part of the forces at walls that is not seen", reading=dim_walls),
    "swapped_labels": Hidden(0.03, 0.15, "part of the grains whose label a neighbour has, from the second scan on", reading=swapped_labels),
    "mixed_forces": Hidden(0.1, 0.4, "part of the mean force of a grain in each of its forces", reading=mixed_forces),
    "rotated_image": Hidden(0.01, 0.04, "tangent of the image's rotation", signed=True, reading=rotated_image),
    "slow_scan": Hidden(0.05, 0.3, "part of their way since the last scan by which the topmost positions are late", reading=slow_scan),
    "backlash": Hidden(4e-4, 1.5e-3, "plate read too high on the way up [m]", signed=True, reading=backlash),
}


def find(name):
    return LIBRARY.get(name) or OUTSIDE[name]


def simulated(folder, case):
    """The scans of a case of the challenge (challenge.Reality), as measured by its instrument, without noise."""
    chance = random.Random(case.seed)
    arguments, further = {}, {"slower": case.slower, "protocol": case.protocol}
    shift = {nuisance.name: nuisance.amplitude for nuisance in case.nuisances}
    for effect in case.effects:
        entry = find(effect.name)
        arguments |= entry.arguments(case.code, effect.amplitude, chance) if entry.arguments else {}
        further |= entry.reality(effect.amplitude) if entry.reality else {}
    if case.code == "lammps":
        reality = cases.lammps(modulus=cases.E * math.exp(shift["modulus"]), **arguments)
    else:
        moduli = arguments.pop("moduli", (cases.E,))
        reality = getattr(cases, case.code)(moduli=tuple(m * math.exp(shift["modulus"]) for m in moduli), **arguments)
    scans = realities.simulate(folder, case.seed, {**reality, **further})
    for effect in case.effects:
        if find(effect.name).reading:
            find(effect.name).reading(scans, effect.amplitude, chance)
    for scan in scans:
        scan["height"] += shift["strain_offset"]
    return scans
