"""Impacts of spheres: closed forms, and the equations of motion of one pair, integrated independently of mcdem.

The cases are those of Chung & Ooi 2011, Granular Matter 13:643 (impacts.csv). Axes of a pair: x from the sphere to its partner
(a wall or another sphere), y tangential; spins are about z = x cross y. All arrays have one element per impact.
"""
import csv
import pathlib

import numpy as np

TABLE = pathlib.Path(__file__).with_name("impacts.csv")
WALL = {"youngs_modulus": 1e13, "poisson_ratio": 0.3}  # the stiffest wall that a scene can have


def read_cases(file=TABLE):
    """The impacts by (case, material, restitution), which one scene can have: columns as arrays, one element per impact."""
    groups = {}
    with open(file, newline="") as lines:
        for row in csv.DictReader(line for line in lines if not line.startswith("#")):
            groups.setdefault((int(row["case"]), row["material"], float(row["restitution"])), []).append(row)
    return {key: {name: np.array([float(row[name]) for row in rows]) for name in rows[0] if name not in ("case", "material")}
            for key, rows in groups.items()}


class Pair:
    """Constants of the spheres of a case and of their partners."""

    def __init__(self, case):
        young, nu = case["youngs_modulus_Pa"], case["poisson_ratio"]
        self.radius, self.restitution, self.friction = case["radius_m"], case["restitution"], case["friction"]
        self.mass = case["density_kg_m3"] * 4 / 3 * np.pi * self.radius**3
        self.inertia = 0.4 * self.mass * self.radius**2
        shear = young / (2 * (1 + nu))
        self.wall = case["partner_radius"] == 0
        wall_shear = WALL["youngs_modulus"] / (2 * (1 + WALL["poisson_ratio"]))
        compliance, shear_compliance = (1 - nu**2) / young, (2 - nu) / shear
        compliance = compliance + np.where(self.wall, (1 - WALL["poisson_ratio"]**2) / WALL["youngs_modulus"], compliance)
        shear_compliance = shear_compliance + np.where(self.wall, (2 - WALL["poisson_ratio"]) / wall_shear, shear_compliance)
        self.other_radius = self.radius * case["partner_radius"]
        self.other_mass = np.where(self.wall, np.inf, case["partner_density_kg_m3"] * 4 / 3 * np.pi * self.other_radius**3)
        self.reduced_radius = np.where(self.wall, self.radius, self.radius * case["partner_radius"] / (1 + case["partner_radius"]))
        self.reduced_mass = 1 / (1 / self.mass + 1 / self.other_mass)
        self.modulus, self.shear = 1 / compliance, 1 / shear_compliance
        logarithm = np.log(self.restitution)
        self.damping = 2 * np.sqrt(5 / 6) * -logarithm / np.sqrt(logarithm**2 + np.pi**2)

    def largest_overlap(self, speed):
        """Without damping: of the relative normal `speed` [m] (Timoshenko & Goodier, Theory of Elasticity, section 142)."""
        return (15 / 16 * self.reduced_mass * speed**2 / (self.modulus * np.sqrt(self.reduced_radius)))**0.4

    def force(self, overlap):
        return 4 / 3 * self.modulus * np.sqrt(self.reduced_radius) * np.maximum(overlap, 0)**1.5

    def duration(self, speed):
        """Of an impact without damping [s]: 2 times the integral of dx / sqrt(1 - x^2.5), times overlap over speed."""
        return 2.94327539 * self.largest_overlap(speed) / speed


def approach(case):
    """Relative normal speed before the impact [m/s]."""
    return case["normal_m_s"] - case["partner_normal_m_s"]


def sliding(pair, case):
    """Tangential velocity of the sphere's surface relative to that of its partner before the impact [m/s]."""
    return case["tangential_m_s"] + pair.radius * case["spin_1_s"] + pair.other_radius * case["partner_spin_1_s"]


def pressing_share(damping, steps=4000):
    """Impulse of the pressing force over the whole one, (1 + e) m* v_n: above 1, because a damped contact pulls at its end, where
    there is no friction. In units of m* = v_n = 1 and a Hertz force x^1.5, with the damping force c x^0.25 v, c = damping sqrt(3/2)."""
    x, v, pressing, step = 0 * damping, 1 + 0 * damping, 0 * damping, 3 / steps
    for _ in range(3 * steps):
        force = np.where(x > 0, np.abs(x)**1.5 + damping * np.sqrt(1.5) * np.abs(x)**0.25 * v, 0)
        pressing = pressing + step * np.maximum(force, 0)
        v = v - step * force
        x = x + step * v
    return pressing / (1 - v)


def sliding_rebound(pair, case):
    """Tangential velocity and spin of the sphere after an impact that slides throughout in one direction: rigid bodies with the
    impulse P = (1 + e) m* v_n, and mu times that of the pressing force."""
    impulse = np.sign(sliding(pair, case)) * pair.friction * (1 + pair.restitution) * pair.reduced_mass * approach(case)
    impulse = impulse * pressing_share(pair.damping[:1])
    return case["tangential_m_s"] - impulse / pair.mass, case["spin_1_s"] - pair.radius * impulse / pair.inertia


def hertz_force(pair, speed, time):
    """Force of an impact without damping at the times since it began [N]; `speed` and `pair` are of one impact."""
    top = pair.largest_overlap(speed)
    angle = np.linspace(0, np.pi / 2, 4001)
    x = np.sin(angle)**0.8  # overlap over the largest: dx / sqrt(1 - x^2.5) = 0.8 sin^-0.2 d angle is integrable
    middle = (angle[1:] + angle[:-1]) / 2
    until = np.concatenate([[0], np.cumsum(0.8 * np.sin(middle)**-0.2 * np.diff(angle))]) * top / speed
    whole = 2 * until[-1]
    return pair.force(top * np.interp(np.minimum(time, whole - time), until, x, left=0))


def integrate_impact(pair, case, steps=4000):
    """Velocities along x and y and spin about z after the impact, of the sphere and of its partner: leapfrog with steps of the
    undamped duration over `steps`.

    Law: Hertz; damping 2 sqrt(5/6) beta sqrt(S m*), S = 2 E* a; tangential spring k_t = 8 G* a that keeps its force while the
    contact grows and loses it in proportion to a while it shrinks; damping of the spring; limit mu F_n of both together.
    """
    step = pair.duration(approach(case)) / steps
    zero = 0 * step
    overlap, spring, radius_before = zero, zero, zero
    first = np.array([case["normal_m_s"], case["tangential_m_s"], case["spin_1_s"]])
    other = np.array([case["partner_normal_m_s"], zero, case["partner_spin_1_s"]])
    grain = ~pair.wall
    other_inertia = np.where(grain, 0.4 * np.where(grain, pair.other_mass, 1) * pair.other_radius**2, np.inf)
    for _ in range(3 * steps):  # damping prolongs the impact
        overlap = overlap + step * (first[0] - other[0])
        touching = overlap > 0
        radius = np.sqrt(pair.reduced_radius * np.maximum(overlap, 0))
        arm = np.where(grain, pair.radius - overlap / 2, pair.radius - overlap)
        other_arm = np.where(grain, pair.other_radius - overlap / 2, 0)
        stiffness = 2 * pair.modulus * radius
        pressing = 2 / 3 * stiffness * np.maximum(overlap, 0) + pair.damping * np.sqrt(stiffness * pair.reduced_mass) * (first[0] - other[0])
        slip = other[1] - other_arm * other[2] - first[1] - arm * first[2]  # of the partner's surface along the sphere's
        tangent = 8 * pair.shear * radius
        ratio = np.where(radius < radius_before, radius / np.where(radius_before > 0, radius_before, 1), 1)
        spring = ratio * spring + tangent * step * slip
        full = spring + pair.damping * np.sqrt(tangent * pair.reduced_mass) * slip
        limit = pair.friction * np.maximum(pressing, 0)
        cut = np.minimum(1, limit / np.maximum(np.abs(full), 1e-300))
        spring, across = np.where(touching, cut * spring, 0), np.where(touching, cut * full, 0)
        radius_before = radius
        pressing = np.where(touching, pressing, 0)
        first = first + step * np.array([-pressing / pair.mass, across / pair.mass, arm * across / pair.inertia])
        other = other + step * np.array([pressing / pair.other_mass, -across / pair.other_mass, other_arm * across / other_inertia])
    return first, other
