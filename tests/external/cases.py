"""Simulated experiments by other codes: the effects of each that the diagnosed scene lacks."""
import math

import realities

E, NU, RESTITUTION, FRICTION = 23.3e3, 0.5, 0.95, 0.03  # those of scenes/challenge.toml and the defaults
STIFF_WALL = 50e6                                       # [Pa]
ABSTAIN = ["unknown_effect"]
DEEPER = ["plate.end=0.09"]                             # without the effect a force may be reached at a lower plate
MORE_NEIGHBOURS = ["numerics.slots=32"]                 # a large grain between small ones has more than 16


def liggghts(further="", tangential="history", tangential_damping="off", moduli=(E,), wall_youngs_modulus=STIFF_WALL,
             friction=FRICTION, wall_friction=FRICTION, floor_friction=None, cohesion_energy=0, rolling=0, gamma=0, skin=0.001):
    """Variables of liggghts.in. LIGGGHTS adds the damping of sticking contacts to friction without a limit, so that
    f_t/f_n reaches 0.1 at mu = 0.03. Without that damping Coulomb's limit holds, as in the scene."""
    count = len(moduli)
    types = count + 2  # of grains, walls, floor

    def table(between_grains, at_walls, at_floor):
        def value(a, b):
            return at_floor if max(a, b) == types - 1 else at_walls if max(a, b) == count else between_grains
        return " ".join(str(value(a, b)) for a in range(types) for b in range(types))

    return {"program": "liggghts", "input": "liggghts.in", "models": f"tangential {tangential} {further}",
            "tangential_damping": tangential_damping, "skin": skin, "gamma": gamma, "types": types, "materials": count,
            "wall_type": count + 1, "floor_type": count + 2,
            "moduli": " ".join(map(str, [*moduli, wall_youngs_modulus, wall_youngs_modulus])),
            "poisson_ratios": " ".join([str(NU)] * types), "restitutions": table(*[RESTITUTION] * 3),
            "frictions": table(friction, wall_friction, wall_friction if floor_friction is None else floor_friction),
            "cohesions": table(*[cohesion_energy] * 3), "rollings": table(*[rolling] * 3)}


def lammps(work=0, modulus=E, friction=FRICTION, wall_friction=FRICTION, floor_friction=None,
           wall_stiffness=1, further=""):
    """Variables of lammps.in. In the version of 29 Sep 2021 the modulus of a wall is E* itself for nu = 0.5 (for grains
    E* = E / (2 (1 - nu^2))): E / (1 - nu^2) gives a rigid wall, whose shear stiffness 8 G* = 8 G / (2 - nu) is given
    explicitly. `work`: of adhesion. LAMMPS takes half of it, because its attraction is 4 pi (w/2) R*."""
    shear = 8 * modulus / (2 * (1 + NU) * (2 - NU))
    wall_modulus = wall_stiffness * modulus / (1 - NU**2)
    sticking = f" {work / 2}" if work else ""
    normal = "dmt" if work else "hertz/material"

    def wall(limit):
        return (f"{normal} {wall_modulus} {RESTITUTION} {NU}{sticking} "
                f"tangential mindlin {shear} 1.0 {limit} {further} damping tsuji")

    return {"program": "lmp", "input": "lammps.in", "skin": 0.001,
            "law": f"{normal} {modulus} {RESTITUTION} {NU}{sticking} tangential mindlin NULL 1.0 {friction} {further} "
                   "damping tsuji",
            "wall_law": wall(wall_friction), "floor_law": wall(wall_friction if floor_friction is None else floor_friction)}


def yade(moduli=(E,), friction=FRICTION, wall_friction=FRICTION, floor_friction=None, wall_youngs_modulus=STIFF_WALL):
    """Variables of yade_stroke.py. `damping`: 2 damping sqrt(m* S) times the velocity is the scene's normal force."""
    count, wall = len(moduli), (wall_youngs_modulus, NU)
    at_floor = wall_friction if floor_friction is None else floor_friction
    return {"program": "yade", "input": "yade_stroke.py", "skin": 0.0005, "materials": count,
            "damping": -math.sqrt(5 / 6) * math.log(RESTITUTION) / math.hypot(math.log(RESTITUTION), math.pi),
            "kinds": [*((modulus, NU) for modulus in moduli), wall, wall],
            "frictions": [[*[friction] * count, wall_friction, at_floor]] * count}


CASES = {
    "liggghts_plain": {"effect": "none", "expected": ["no_gap"], "reality": liggghts()},
    "lammps_plain": {"effect": "none", "expected": ["no_gap"], "reality": lammps()},
    "liggghts_multicontact": {
        "effect": "cross_contact: multi-contact model, gamma = 1", "expected": ["cross_contact"],
        "reality": liggghts("surface multicontact", skin=0.004, gamma=1.0)},
    "lammps_adhesion": {
        "effect": "adhesion_net_friction: DMT, w = 0.1 J/m2", "expected": ["adhesion_net_friction"], "reality": lammps(work=0.1)},
    "liggghts_friction": {
        "effect": "friction: 0.10 for 0.03 between grains", "expected": ["friction"], "reality": liggghts(friction=0.10)},
    "liggghts_wall_friction": {
        "effect": "wall_friction: 0.06 for 0.03", "expected": ["wall_friction"], "reality": liggghts(wall_friction=0.06)},
    "liggghts_rolling": {
        "effect": "rolling_resistance: constant couple (cdt), mu_r = 0.1", "expected": ["rolling_resistance"],
        "reality": liggghts("rolling_friction cdt", rolling=0.1) | {"finer": 10}},
    "liggghts_rolling_spring": {
        "effect": "rolling_resistance: spring and slider (epsd2), mu_r = 0.02", "expected": ["rolling_resistance"],
        "reality": liggghts("rolling_friction epsd2", rolling=0.02)},
    "lammps_rolling": {
        "effect": "rolling_resistance: spring, dashpot, slider, mu_r = 0.1", "expected": ["rolling_resistance"],
        "reality": lammps(further="rolling sds 20.0 0.0 0.1")},
    "liggghts_no_history": {
        "effect": "friction without history: viscous up to mu F_n", "expected": ["friction_history", "friction", "wall_friction"] + ABSTAIN,
        "reality": liggghts(tangential="no_history", tangential_damping="on")},
    "liggghts_unlimited_damping": {
        "effect": "not in the library: damping beyond Coulomb's limit, LIGGGHTS's own", "expected": ABSTAIN,
        "reality": liggghts(tangential_damping="on")},
    "liggghts_sjkr": {
        "effect": "cohesion: SJKR, 100 J/m3", "expected": ["cohesion"],
        "reality": liggghts("cohesion sjkr", cohesion_energy=100)},
    "liggghts_soft_walls": {
        "effect": "not in the library: walls as soft as the grains", "expected": ABSTAIN,
        "reality": liggghts(wall_youngs_modulus=E)},
    "lammps_stiff_walls": {
        "effect": "not in the library: walls 1.5 times as stiff as rigid ones", "expected": ABSTAIN,
        "reality": lammps(wall_stiffness=1.5)},
    "lammps_cylinder": {"effect": "none, in a cylinder", "expected": ["no_gap"], "reality": lammps() | {"container": "cylinder"}},
    "lammps_cylinder_friction": {
        "effect": "friction: 0.10 for 0.03 between grains, in a cylinder", "expected": ["friction"],
        "reality": lammps(friction=0.10) | {"container": "cylinder"}},
    "lammps_two_sizes": {
        "effect": "none, two sizes", "expected": ["no_gap"], "reality": lammps() | {"sizes": realities.two_sizes}, "set": MORE_NEIGHBOURS},
    "lammps_two_sizes_friction": {
        "effect": "friction: 0.10 for 0.03 between grains, two sizes", "expected": ["friction"],
        "reality": lammps(friction=0.10) | {"sizes": realities.two_sizes}, "set": MORE_NEIGHBOURS},
    "lammps_periodic": {"effect": "none, periodic sides", "expected": ["no_gap"], "reality": lammps() | {"container": "periodic"}},
    "lammps_periodic_friction": {
        "effect": "friction: 0.10 for 0.03 between grains, periodic sides", "expected": ["friction"],
        "reality": lammps(friction=0.10) | {"container": "periodic"}},
    "lammps_forces": {
        "effect": "none, forces prescribed", "expected": ["no_gap"], "reality": lammps() | {"highest_force": 4, "slower": 5}, "set": DEEPER},
    "lammps_forces_friction": {
        "effect": "friction: 0.10 for 0.03 between grains, forces prescribed", "expected": ["friction"],
        "reality": lammps(friction=0.10) | {"highest_force": 4, "slower": 5}, "set": DEEPER},
    "liggghts_two_sizes": {
        "effect": "none, two sizes", "expected": ["no_gap"], "reality": liggghts() | {"sizes": realities.two_sizes}, "set": MORE_NEIGHBOURS},
    "liggghts_two_sizes_friction": {
        "effect": "friction: 0.10 for 0.03 between grains, two sizes", "expected": ["friction"],
        "reality": liggghts(friction=0.10) | {"sizes": realities.two_sizes}, "set": MORE_NEIGHBOURS},
    "lammps_cylinder_wall_friction": {
        "effect": "wall_friction: 0.06 for 0.03, in a cylinder", "expected": ["wall_friction"],
        "reality": lammps(wall_friction=0.06) | {"container": "cylinder"}},
}
for seed, case in enumerate(CASES.values(), 1):  # of packing and noise
    case["seed"] = seed
