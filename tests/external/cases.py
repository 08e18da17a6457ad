"""Realities that other codes make: what each has that the diagnosed scene leaves out."""

E, NU, RESTITUTION, FRICTION = 23.3e3, 0.5, 0.95, 0.03  # the scene's: scenes/challenge.toml and the defaults
STIFF_WALL = 50e6                                       # [Pa]
ABSTAIN = ["unknown_effect"]


def liggghts(further="", tangential="history", tangential_damping="off", **changes):
    """Variables of liggghts.in. LIGGGHTS adds the damping of sticking contacts to friction without a limit, so that f_t/f_n
    reaches 0.1 where mu is 0.03; without that damping Coulomb's limit holds, as it does in the scene."""
    return {"program": "liggghts", "input": "liggghts.in", "models": f"tangential {tangential} {further}",
            "tangential_damping": tangential_damping, "skin": 0.001, "youngs_modulus": E, "wall_youngs_modulus": STIFF_WALL,
            "friction": FRICTION, "wall_friction": FRICTION, "cohesion_energy": 0, "rolling": 0, "gamma": 0, **changes}


def lammps(normal=f"hertz/material {E} {RESTITUTION} {NU}", wall="hertz/material", wall_stiffness=1, further=""):
    """Variables of lammps.in. The modulus given to a wall of the version of 29 Sep 2021 is E* itself where nu = 0.5 (for
    grains E* = E / (2 (1 - nu^2))): E / (1 - nu^2) makes a rigid one, its shear stiffness 8 G* = 8 G / (2 - nu) is written
    out."""
    shear = 8 * E / (2 * (1 + NU) * (2 - NU))
    wall_modulus = wall_stiffness * E / (1 - NU**2)
    return {"program": "lmp", "input": "lammps.in", "skin": 0.001,
            "law": f"{normal} tangential mindlin NULL 1.0 {FRICTION} {further} damping tsuji",
            "wall_law": f"{wall.split()[0]} {wall_modulus} {RESTITUTION} {NU} {' '.join(wall.split()[1:])} "
                        f"tangential mindlin {shear} 1.0 {FRICTION} damping tsuji"}


def dmt(work):
    """LAMMPS takes half of the work of adhesion: it attracts by 4 pi (w/2) R*."""
    return lammps(normal=f"dmt {E} {RESTITUTION} {NU} {work / 2}", wall=f"dmt {work / 2}")


CASES = {
    "liggghts_plain": {"effect": "none", "expected": ["no_gap"], "reality": liggghts()},
    "lammps_plain": {"effect": "none", "expected": ["no_gap"], "reality": lammps()},
    "liggghts_multicontact": {
        "effect": "cross_contact: multi-contact model, gamma = 1", "expected": ["cross_contact"],
        "reality": liggghts("surface multicontact", skin=0.004, gamma=1.0)},
    "lammps_adhesion": {"effect": "adhesion: DMT, w = 0.1 J/m2", "expected": ["adhesion"], "reality": dmt(0.1)},
    "liggghts_friction": {
        "effect": "friction: 0.10 for 0.03 between grains", "expected": ["friction"], "reality": liggghts(friction=0.10)},
    "liggghts_wall_friction": {
        "effect": "wall_friction: 0.06 for 0.03", "expected": ["wall_friction"], "reality": liggghts(wall_friction=0.06)},
    "liggghts_rolling": {
        "effect": "rolling_resistance: constant couple, mu_r = 0.1", "expected": ["rolling_resistance"],
        "reality": liggghts("rolling_friction cdt", rolling=0.1)},
    "lammps_rolling": {
        "effect": "rolling_resistance: spring, dashpot, slider, mu_r = 0.1", "expected": ["rolling_resistance"],
        "reality": lammps(further="rolling sds 20.0 0.0 0.1")},
    "liggghts_no_history": {
        "effect": "friction without history: viscous up to mu F_n", "expected": ["friction_history", "friction"] + ABSTAIN,
        "reality": liggghts(tangential="no_history", tangential_damping="on")},
    "liggghts_unlimited_damping": {
        "effect": "not in the library: damping beyond Coulomb's limit, LIGGGHTS's own", "expected": ABSTAIN,
        "reality": liggghts(tangential_damping="on")},
    "liggghts_sjkr": {
        "effect": "not in the library: cohesion by contact area (SJKR), 100 J/m3", "expected": ABSTAIN,
        "reality": liggghts("cohesion sjkr", cohesion_energy=100)},
    "liggghts_soft_walls": {
        "effect": "not in the library: walls as soft as the grains", "expected": ABSTAIN,
        "reality": liggghts(wall_youngs_modulus=E)},
    "lammps_stiff_walls": {
        "effect": "not in the library: walls 1.5 times as stiff as rigid ones", "expected": ABSTAIN,
        "reality": lammps(wall_stiffness=1.5)},
}
for seed, case in enumerate(CASES.values(), 1):  # of packing and noise
    case["seed"] = seed
