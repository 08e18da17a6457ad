"""Pairs that move along prescribed paths, against closed forms of the contact law: pair_motions.csv through mcdem.forces_along.

pair_motions_test.py [--table]: asserts the bars; with --table it prints the largest errors of each motion for README.md, over the
limit of friction mu F_n, and over that times the radius for torques.
"""
import csv
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import mcdem

TABLE = pathlib.Path(__file__).with_name("pair_motions.csv")
YOUNG, NU, FRICTION, DENSITY, SIZE = 1e6, 0.3, 0.5, 1000.0, 0.2
DIRECTION = np.array([1, 2, 2]) / 3  # of the line of centres; walls: the floor
STEP = 1e-5  # seconds a row


class Law:
    """The contact of a row of the table: Hertz, Mindlin's tangential stiffness, damping of constant restitution."""

    def __init__(self, row):
        self.radius, self.partner = float(row["radius_m"]), float(row["partner_radius_m"])
        self.wall = self.partner == 0
        shear = YOUNG / (2 * (1 + NU))
        self.modulus, self.shear = YOUNG / (2 * (1 - NU**2)), shear / (2 * (2 - NU))  # walls have the grains' material
        self.reduced_radius = self.radius if self.wall else 1 / (1 / self.radius + 1 / self.partner)
        mass = [DENSITY * 4 / 3 * np.pi * r**3 for r in (self.radius, self.partner)]
        self.reduced_mass = mass[0] if self.wall else 1 / (1 / mass[0] + 1 / mass[1])
        logarithm = np.log(float(row["restitution"]))
        self.damping = 2 * np.sqrt(5 / 6) * -logarithm / np.sqrt(logarithm**2 + np.pi**2)

    def contact_radius(self, overlap):
        return np.sqrt(self.reduced_radius * overlap)

    def normal(self, overlap, closing=0):
        stiffness = 2 * self.modulus * self.contact_radius(overlap)
        return 2 / 3 * stiffness * overlap + self.damping * np.sqrt(stiffness * self.reduced_mass) * closing

    def tangential_stiffness(self, overlap):
        return 8 * self.shear * self.contact_radius(overlap)

    def tangential_damping(self, overlap):
        return self.damping * np.sqrt(self.tangential_stiffness(overlap) * self.reduced_mass)

    def distance(self, overlap):
        return self.radius + self.partner - overlap

    def arms(self, overlap):
        """From the centres to the contact point, midway between the surfaces; at a wall on it [m]."""
        distance = self.distance(overlap)
        return (distance, 0 * distance) if self.wall else ((distance + self.radius - self.partner) / 2,
                                                           (distance - self.radius + self.partner) / 2)


def turned(vector, axis, angle):
    """Vectors turned about a unit axis by angles, [T][3] (Rodrigues)."""
    angle = np.asarray(angle)[:, None]
    along = axis * (vector @ axis)
    return along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(axis, vector)


class Motion:
    """A path by rows, and the forces on the first grain that are expected along it.

    The sliding of the partner's surface along the sphere's is `sliding` [m] a row, along `tangent`; spins cause it, so that the
    line of centres stays. `only`: of the first grain, otherwise of both. `spin`: further spins of both [1/s].
    """

    def __init__(self, row):
        self.law, self.kind, self.restitution = Law(row), row["motion"], float(row["restitution"])
        overlap, part, steps = float(row["overlap_m"]), float(row["shear"]), int(row["steps"])
        self.steps, self.turn = steps, np.radians(float(row["turn_deg"]))
        self.first_overlap = overlap
        self.limit = FRICTION * self.law.normal(overlap)
        self.stiffness = self.law.tangential_stiffness(overlap)
        self.shear = part * self.limit / self.stiffness  # [m]; `shear` of the table is over that at the limit of friction
        self.axis = np.array([0, 0, -1.0]) if self.law.wall else DIRECTION
        self.tangent = np.cross(self.axis, [1, 0, 0]) / np.linalg.norm(np.cross(self.axis, [1, 0, 0]))
        getattr(self, self.kind.replace(" ", "_").replace("-", "_"))()

    def ramp(self, *targets):
        """Values from 0 over the targets, `steps` rows to each."""
        return np.concatenate([[0]] + [np.linspace(a, b, self.steps + 1)[1:] for a, b in zip((0, *targets), targets)])

    def set(self, shear, tension, overlap=None, normal=None, tangent=None, spin=None, only=False):
        """`shear`: sum of the sliding by rows [m]; `tension`: expected tangential force [N]."""
        rows = len(shear)
        self.overlap = np.full(rows, self.first_overlap) if overlap is None else overlap
        self.normals = np.tile(self.axis, (rows, 1)) if normal is None else normal
        self.tangents = np.tile(self.tangent, (rows, 1)) if tangent is None else tangent
        rate = np.diff(shear, prepend=0) / STEP
        arm, other_arm = self.law.arms(self.overlap)
        # Sliding by equal spins w about n x t is -w (arm + other arm).
        spins = -(rate / (arm if only or self.law.wall else arm + other_arm))[:, None] * np.cross(self.normals, self.tangents)
        further = np.zeros((rows, 3)) if spin is None else spin
        self.spins = [spins + further, np.zeros((rows, 3)) if only else spins + further]
        closing = np.diff(self.overlap, prepend=self.overlap[0]) / STEP
        self.force = tension[:, None] * self.tangents - self.law.normal(self.overlap, closing)[:, None] * self.normals
        self.torque = [length[:, None] * np.cross(self.normals, tension[:, None] * self.tangents) for length in (arm, other_arm)]

    def tangential_elastic(self):
        shear = self.ramp(self.shear, -self.shear, 0)
        self.set(shear, self.stiffness * shear)

    def changing_load(self):
        """Sheared, loaded to four times the overlap, sheared back as far, unloaded."""
        back = self.steps
        shear = np.concatenate([self.ramp(self.shear), np.full(back, self.shear), np.linspace(self.shear, 0, back + 1)[1:], np.zeros(back)])
        growth = np.linspace(0, 3, back + 1)[1:]
        overlap = self.first_overlap * (1 + np.concatenate([np.zeros(back + 1), growth, np.full(back, 3.0), 3 - growth]))
        first, loaded = self.stiffness * self.shear, self.law.tangential_stiffness(4 * self.first_overlap)
        tension = np.concatenate([self.stiffness * self.ramp(self.shear), np.full(back, first),
                                  first + loaded * (shear[2 * back + 1:3 * back + 1] - self.shear), np.zeros(back)])
        # Half of the shear's stiffness gave the force, so sheared back it is opposite, and falls with the contact radius.
        tension[3 * back + 1:] = tension[3 * back] * np.sqrt(overlap[3 * back + 1:] / overlap[3 * back])
        self.set(shear, tension, overlap)

    def tangential_plastic(self):
        shear, most = self.ramp(self.shear, -self.shear, self.shear), self.limit
        first, second = self.steps + 1, 2 * self.steps + 1
        tension = np.concatenate([np.minimum(most, self.stiffness * shear[:first]),
                                  np.maximum(-most, most - self.stiffness * (self.shear - shear[first:second])),
                                  np.minimum(most, -most + self.stiffness * (shear[second:] + self.shear))])
        self.set(shear, tension)

    def rotation(self, axis):
        """Sheared along `tangent`, then turned as a rigid body about `axis`."""
        rows = self.steps
        shear = np.concatenate([self.ramp(self.shear), np.full(rows, self.shear)])
        angle = np.concatenate([np.zeros(rows + 1), np.linspace(0, self.turn, rows + 1)[1:]])
        spin = np.where(np.arange(2 * rows + 1)[:, None] > rows, self.turn / rows / STEP * axis, 0)
        self.set(shear, np.minimum(self.stiffness * shear, self.limit), normal=turned(self.axis, axis, angle),
                 tangent=turned(self.tangent, axis, angle), spin=spin)

    def out_of_plane_rotation(self):
        middle = self.tangent + np.cross(self.axis, self.tangent)  # the force is partly along the axis of the turn
        self.rotation(middle / np.linalg.norm(middle))

    def in_plane_rotation(self):
        self.rotation(self.axis)

    def viscous(self):
        """Sheared at constant rate, held, then pressed together."""
        rows = self.steps
        shear = np.concatenate([self.ramp(self.shear), np.full(2 * rows, self.shear)])
        overlap = self.first_overlap * (1 + np.concatenate([np.zeros(2 * rows + 1), np.linspace(0, 0.5, rows + 1)[1:]]))
        rate = np.diff(shear, prepend=0) / STEP
        self.set(shear, self.stiffness * shear + self.law.tangential_damping(overlap) * rate, overlap)

    def surface_arm(self):
        shear = self.ramp(self.shear)
        self.set(shear, self.stiffness * shear, only=True)

    def scene(self, folder, **more):
        file = pathlib.Path(folder) / "pair.csv"
        grains = [(0.05, self.law.radius)] + ([] if self.law.wall else [(0.12, self.law.partner)])
        file.write_text("x_m,y_m,z_m,diameter_m\n" + "".join(f"{x},0.1,0.1,{2 * radius}\n" for x, radius in grains))
        material = {"youngs_modulus": YOUNG, "poisson_ratio": NU, "friction": FRICTION, "restitution": self.restitution}
        return mcdem.Scene(more, container={"size_x": SIZE, "size_y": SIZE}, plate={"start": SIZE, "end": SIZE / 2},
                           grains=material | {"density": DENSITY}, walls=material,
                           contact={"model": "independent", "friction_law": "mindlin"}, packing={"file": str(file)})

    def path(self):
        """Arguments of forces_along after the scene."""
        rows = len(self.overlap)
        place = np.array([SIZE / 2, SIZE / 2, 0]) - self.axis[None, :] * self.law.distance(self.overlap)[:, None]
        if self.law.wall:
            return np.arange(rows) * STEP, place[:, None], None, self.spins[0][:, None]
        middle = np.full(3, SIZE / 2)
        half = 0.5 * self.law.distance(self.overlap)[:, None] * self.normals
        return np.arange(rows) * STEP, np.stack([middle - half, middle + half], 1), None, np.stack(self.spins, 1)


def motions():
    with open(TABLE, newline="") as lines:
        for row in csv.DictReader(line for line in lines if not line.startswith("#")):
            yield Motion(row)


def errors(motion, **more):
    """Largest errors of force and torque over the limit of friction, and that times the radius."""
    with tempfile.TemporaryDirectory() as folder:
        force, torque = mcdem.forces_along(motion.scene(folder, **more), *motion.path())
    found = [np.abs(force[:, 0] - motion.force).max() / motion.limit]
    found.append(np.abs(torque[:, 0] - motion.torque[0]).max() / (motion.limit * motion.law.radius))
    if not motion.law.wall:
        found[0] = max(found[0], np.abs(force[:, 1] + motion.force).max() / motion.limit)
        found[1] = max(found[1], np.abs(torque[:, 1] - motion.torque[1]).max() / (motion.limit * motion.law.partner))
    return found


# Of the limit of friction. The law is exact for each step, but for the turn of springs, whose length is kept to the fourth order of the
# angle of a step (0.5 degrees), and rounding of positions: an overlap of 4e-4 m is known to 1e-13 of itself.
BARS = {"out-of-plane rotation": 1e-6, "in-plane rotation": 1e-6}
BAR, SINGLE_PRECISION = 1e-9, 1e-3  # in float, 0.1 m is known to 7e-9 m: 2e-5 of the overlap


class PairMotions(unittest.TestCase):
    def test_forces_and_torques_follow_the_closed_forms(self):
        kinds = set()
        for motion in motions():
            kinds.add(motion.kind)
            with self.subTest(motion=motion.kind, wall=motion.law.wall, partner=motion.law.partner):
                self.assertLess(max(errors(motion, numerics={"precision": "double"})), BARS.get(motion.kind, BAR))
                self.assertLess(max(errors(motion)), SINGLE_PRECISION)
        self.assertEqual(len(kinds), 7)

    def test_the_same_path_gives_the_same_bits(self):
        motion = next(one for one in motions() if one.kind == "out-of-plane rotation")
        with tempfile.TemporaryDirectory() as folder:
            first, again = (mcdem.forces_along(motion.scene(folder), *motion.path()) for _ in range(2))
        for one, other in zip(first, again):
            self.assertTrue(one.any())
            self.assertEqual(one.tobytes(), other.tobytes())


if __name__ == "__main__":
    if "--table" in sys.argv:
        for one in motions():
            double, single = errors(one, numerics={"precision": "double"}), errors(one)
            print(f"{one.kind:22} {'wall' if one.law.wall else f'{one.law.partner / one.law.radius:g}':5}",
                  *(f"{value:.1e}" for value in double + single))
    else:
        unittest.main()
