"""Overlaps from forces and from positions against Hertz's formula and published values computed by hand. contact_residuals_test.py"""
import math
import unittest
from dataclasses import replace
from unittest import mock

import numpy as np
from scans_by_hand import SOFT, Lattice, at, seen

from mcdem.results import Box, ContainerShape, Wall

CENTRE = np.array([0.1, 0.1, 0.1])


def compliance(youngs_modulus, nu):
    return (1 - nu * nu) / youngs_modulus


SOFT_PAIR = 1 / (2 * compliance(20e3, 0.5))
SOFT_WALL = 1 / (compliance(20e3, 0.5) + compliance(60e3, 0.3))


def hertz(modulus, radius, overlap):
    return 4 / 3 * modulus * math.sqrt(radius * overlap) * overlap


class Overlaps(unittest.TestCase):
    def expect(self, found, normal, force, radius, implied, measured):
        np.testing.assert_allclose(found.normal[0], normal, atol=1e-12)
        for value, wanted in ((found.normal_force, force), (found.reduced_radius, radius), (found.implied, implied / radius),
                              (found.measured, measured / radius), (found.residual, (implied - measured) / radius)):
            np.testing.assert_allclose(value[0], wanted, rtol=1e-11)

    def test_of_two_unequal_grains(self):
        here, there, measured, implied = 0.010, 0.015, 4e-4, 5e-4
        direction, force = np.array([1, 2, -2]) / 3, hertz(SOFT_PAIR, 0.006, implied)
        scan = seen([(0, 1, (0, 0, 0), -force * direction)], [CENTRE, CENTRE + (here + there - measured) * direction], diameter=(2 * here, 2 * there))
        self.expect(scan.residuals, direction, force, 0.006, implied, measured)
        self.assertEqual(scan.residuals.cross_contact[0], 0)  # no other contacts

    def test_at_every_wall(self):
        radius, measured, implied, size = 0.01, 3e-4, 5e-4, np.array([0.2, 0.3, 0.15])
        force = hertz(SOFT_WALL, radius, implied)
        for wall in Wall:
            axis, far = wall // 2, wall % 2 == 1
            centre = 0.5 * size
            centre[axis] = size[axis] - radius + measured if far else radius - measured
            outward = (1 if far else -1) * np.eye(3)[axis]
            with self.subTest(wall.name):
                scan = seen([(0, at(wall), (0, 0, 0), -force * outward)], [centre], box=Box(0.2, 0.3), diameter=[2 * radius], plate_z=0.15)
                self.expect(scan.residuals, outward, force, radius, implied, measured)

    def test_at_the_side_of_a_cylinder(self):
        """In a cylinder of radius 2 R, 1/R* = sqrt(1/R (1/R - 1/(2 R)))."""
        radius, measured, outward = 0.05, 3e-4, np.array([0.6, -0.8, 0])
        scan = seen([(0, at(Wall.x_min), (0, 0, 0), -0.02 * outward)], [CENTRE + (0.1 - radius + measured) * outward],
                    box=Box(0.2, 0.2, ContainerShape.cylinder), diameter=[2 * radius])
        reduced = radius * math.sqrt(2)
        self.expect(scan.residuals, outward, 0.02, reduced, (3 * 0.02 / (4 * SOFT_WALL * math.sqrt(reduced))) ** (2 / 3), measured)

    def test_between_nearest_images_in_a_periodic_container(self):
        radius, measured = 0.01, 4e-4
        scan = seen([(0, 1, (0, 0, 0), (0.01, 0, 0))], [(0.005, 0.1, 0.1), (0.2 - 0.015 + measured, 0.1 + 0.3, 0.1)],
                    box=Box(0.2, 0.3, ContainerShape.periodic), diameter=[2 * radius] * 2)
        np.testing.assert_allclose(scan.residuals.normal[0], (-1, 0, 0), atol=1e-12)
        self.assertAlmostEqual(scan.residuals.measured[0] * scan.residuals.reduced_radius[0], measured, 12)

    def test_separate_friction_and_have_a_sign(self):
        scan = seen([(0, 1, (0, 0, 0), (0.003, 0.004, -0.02)), (0, 2, (0, 0, 0), (0, 0, -0.01))],
                    [(0.1, 0.1, 0.1), (0.1, 0.1, 0.1205), (0.1, 0.1, 0.0805)])
        found = scan.residuals
        np.testing.assert_allclose(found.normal_force, (0.02, -0.01), rtol=1e-12)
        self.assertAlmostEqual(found.tangential[0], 0.005, 15)
        self.assertAlmostEqual(found.measured[0], -0.0005 / 0.005, 12)  # a gap
        self.assertAlmostEqual(found.implied[1], -(3 * 0.01 / (4 * SOFT_PAIR * 0.005**2)) ** (2 / 3), 12)
        self.assertEqual(found.cross_contact[0], 0)  # attraction does not displace surfaces
        self.assertGreater(found.cross_contact[1], 0)


class CrossContact(unittest.TestCase):
    def displacement(self, degrees, nu):
        """At contact 0 of a grain with two partners at an angle, in F/(E R) of the other force."""
        radius, first, second, angle = 0.01, 0.02, 0.05, math.radians(degrees)
        directions = np.array([(1, 0, 0), (math.cos(angle), 0, math.sin(angle))])
        scan = seen([(0, 1, (0, 0, 0), -first * directions[0]), (0, 2, (0, 0, 0), -second * directions[1])],
                    [CENTRE, *(CENTRE + 2 * radius * directions)], material=replace(SOFT, poisson_ratio=nu))
        found = scan.residuals
        self.assertAlmostEqual(found.cross_contact[1] / first, found.cross_contact[0] / second, 12)
        return found.cross_contact[0] * found.reduced_radius[0] / (second / (SOFT.youngs_modulus * radius))

    def test_agrees_with_sphere_to_sphere(self):
        """Gonzalez & Cuitino 2012 at nu = 1/2: 3/(8 pi) (3 s^2 - 1)/s, to the tabulated digits."""
        for degrees, wanted in ((60, -0.0597), (90, 0.0844), (120, 0.1723), (180, 0.2387)):
            self.assertAlmostEqual(self.displacement(degrees, 0.5), wanted, delta=5e-5)
        self.assertAlmostEqual(self.displacement(180, 0.3), 1.3 / (4 * math.pi) * (-1.4 - 0.8 + 4.6), 12)

    def test_does_not_depend_on_how_many_are_computed_at_once(self):
        """A lattice in which grains have 3 to 6 contacts."""
        at_once = Lattice(4).seen().residuals.cross_contact
        with mock.patch("mcdem.observe.contact_residuals.MOST_PAIRS", 40):
            np.testing.assert_array_equal(Lattice(4).seen().residuals.cross_contact, at_once)
        self.assertTrue((at_once > 0).any())

    def test_is_bounded_for_very_close_contacts(self):
        self.assertAlmostEqual(self.displacement(0.1, 0.5), self.displacement(10, 0.5), 12)
        self.assertLess(self.displacement(18, 0.5), 0)

    def test_adds_both_grains(self):
        radius, force = 0.01, 0.04
        rows = [(grain, grain + 1, (0, 0, 0), (-force, 0, 0)) for grain in range(3)]
        found = seen(rows, [(0.05 + 2 * radius * grain, 0.1, 0.1) for grain in range(4)]).residuals
        one_side = 3 / (4 * math.pi) * force / (SOFT.youngs_modulus * radius) / (radius / 2)
        np.testing.assert_allclose(found.cross_contact, (one_side, 2 * one_side, one_side), rtol=1e-11)


if __name__ == "__main__":
    unittest.main()
