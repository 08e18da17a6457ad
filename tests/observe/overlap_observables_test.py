"""Regressions of overlaps find the coefficients from which data were made. overlap_observables_test.py"""
import math
import unittest

import numpy as np
from scans_by_hand import Lattice, at, contacts, seen

from mcdem.observe.contact_residuals import ContactResiduals
from mcdem.observe.overlap_observables import contact_occurrence, grain_overlaps, wall_overlaps
from mcdem.results import Box, ContainerShape, Wall


def scan_of(rows, grains, position=None, box=Box(0.2, 0.1)):
    """Of rows (grain, partner, implied overlap, cross-contact sum, residual)."""
    grain, partner, implied, cross, residual = (np.array(column, float) for column in zip(*rows))
    scan = seen([(int(g), int(p), (0, 0, 0), (0, 0, 0)) for g, p in zip(grain, partner)], position, diameter=[0.02] * grains, box=box, plate_z=0.2)
    zeros = np.zeros(len(rows))
    scan.__dict__["residuals"] = ContactResiduals(np.zeros((len(rows), 3)), zeros, zeros, zeros, implied, implied - residual, cross)
    return scan


def random_contacts(grains, seed):
    """Six contacts per grain with random partners; overlaps from forces are uniform in 0.02 to 0.14. (grain, partner, implied, cross)"""
    random = np.random.default_rng(seed)
    here = np.arange(3 * grains) % grains
    there = (here + 1 + random.integers(grains - 1, size=3 * grains)) % grains
    return here, there, random.uniform(0.02, 0.14, 3 * grains), 0.05 * random.standard_normal(3 * grains)


def found(here, there, implied, cross, residual, grains):
    return np.ravel(grain_overlaps(scan_of(list(zip(here, there, implied, cross, residual)), grains)))


class Grains(unittest.TestCase):
    def test_coefficients(self):
        here, there, u, cross = random_contacts(50, 1)
        rows = list(zip(here, there, u, cross, 0.01 + 0.2 * u - 1.5 * u * u + 0.7 * cross))
        rows += [(k, at(Wall.floor), 0.1, 0.3, 5) for k in range(30)]  # ignored
        np.testing.assert_allclose(np.ravel(grain_overlaps(scan_of(rows, 50)))[:5], (0.01, 0.2, -1.5, 0.7, 0), atol=1e-7)

    def test_scatter_of_contacts_and_of_grains_is_separated(self):
        here, there, u, cross = random_contacts(2000, 2)
        random = np.random.default_rng(3)
        own = 0.004 * random.standard_normal(2000)
        fit = found(here, there, u, cross, own[here] + own[there] + 0.003 * random.standard_normal(len(u)), 2000)
        # 2000 values of `own` determine their standard deviation to 1.6 %; four of those errors.
        self.assertAlmostEqual(fit[4], math.sqrt(2 * 0.004**2 + 0.003**2), delta=0.065 * 0.0064)
        self.assertAlmostEqual(fit[5], 0.004, delta=0.065 * 0.004)
        self.assertLess(fit[6], 0.0012)

    def test_scatter_proportional_to_the_overlap(self):
        here, there, u, cross = random_contacts(2000, 2)
        own, mean = 0.02 * np.random.default_rng(3).standard_normal(2000), 0.08
        part = 0.12**2 / 12 / mean**2  # variance of u over its mean squared
        fit = found(here, there, u, cross, (own[here] + own[there]) * (u / mean - 1), 2000)
        self.assertAlmostEqual(fit[6], 0.02 * part, delta=0.1 * 0.02 * part)
        self.assertLess(fit[5], 0.2 * 0.02 * part + 0.0005)

    def test_is_finite_if_grains_attract(self):
        """Half of the contacts pull as much as the others push: the mean overlap is zero."""
        here, there, u, cross = random_contacts(200, 5)
        u[1::2] = -u[::2]
        self.assertLess(abs(found(here, there, u, cross, 0.001 * np.random.default_rng(6).standard_normal(len(u)), 200)[6]), 0.002)

    def test_unknown_overlaps_leave_the_regression_unknown(self):
        here, there, u, cross = random_contacts(50, 1)
        u[3] = math.nan
        self.assertTrue(np.isnan(found(here, there, u, cross, 0.1 * u, 50)[:4]).all())

    def test_five_contacts_a_term_are_needed(self):
        random = np.random.default_rng(7)
        for count, known in ((19, False), (20, True)):
            rows = [one[:count] for one in random_contacts(50, 1)]
            self.assertTrue((np.isfinite(found(*rows, 0.001 * random.standard_normal(count), 50)) == known).all())


class Occurrence(unittest.TestCase):
    def test_contacts_across_gaps_and_overlaps_without_force(self):
        d, start = 0.02, np.array([0.05, 0.05, 0.05])
        position = start + d * np.array([(0, 0, 0), (0.97, 0, 0), (1.99, 0, 0), (0, 0.97, 0), (1.99, 0.997, 0)])
        # 0-1 overlap and touch, 2-1 touch across a gap, 0-3 overlap without force, 2-4 hardly overlap.
        rows = [(0, 1, 0.1, 0, 0), (2, 1, 0.01, 0, 0.05), (3, at(Wall.floor), 0.01, 0, 0.05), (4, 1, 0.1, 0, 0)]
        for shape in ContainerShape.box, ContainerShape.periodic:
            moved = (position + (0.14, 0.1, 0)) if shape == ContainerShape.periodic else position  # across both ends
            occurrence = contact_occurrence(scan_of(rows, 5, moved, Box(0.2, 0.2, shape)))
            np.testing.assert_allclose(np.ravel(occurrence), (1 / 5, 1 / 5), rtol=1e-12)


class Walls(unittest.TestCase):
    def test_offsets_and_slopes(self):
        random, position, rows = np.random.default_rng(4), [], []
        for k in range(40):
            position.append((random.uniform(0, 0.2), random.uniform(0, 0.1), 0.05))
            u, moved = random.uniform(0.02, 0.1), 0.05 * random.standard_normal()
            x, y = position[-1][0] / 0.1 - 1, position[-1][1] / 0.05 - 1
            rows += [(k, at(Wall.plate), u, moved, moved + 0.01 + 0.02 * x - 0.03 * y), (k, at(Wall.floor), u, moved, moved - 0.04),
                     (k, at(Wall.x_min if k % 2 else Wall.y_max), u, moved, moved + 0.005 - 0.3 * u), (k, (k + 1) % 40, u, moved, 9)]
        fit = np.ravel(wall_overlaps(scan_of(rows, 40, position)))
        np.testing.assert_allclose(fit, (0.005, -0.3, -0.04, 0.01, 0.02, -0.03), atol=1e-10)
        # 14 plate contacts are too few for three terms, 14 side contacts suffice for two.
        fewer = np.ravel(wall_overlaps(scan_of(rows[:4 * 14], 40, position)))
        self.assertTrue(math.isnan(fewer[3]))
        self.assertAlmostEqual(fewer[0], 0.005, 10)

    def test_tilt_of_the_plate(self):
        radius, slope, overlap = 0.01, 0.02, 0.05  # the last over R
        lattice = Lattice(5, 2 * radius)
        push = 4 / 3 / ((1 - 0.25) / 20e3 + (1 - 0.09) / 60e3) * radius**2 * overlap**1.5
        top = np.arange(100, 125)
        lattice.position[top, 2] = lattice.plate_z + slope * (lattice.position[top, 0] - 0.05) - radius + overlap * radius
        lattice.contacts = contacts([(grain, at(Wall.plate), (0, 0, 0), (0, 0, -push)) for grain in top])
        # Where the plate is higher, the overlap is smaller than measured.
        np.testing.assert_allclose(np.ravel(wall_overlaps(lattice.seen()))[3:], (0, -slope * 0.05 / radius, 0), atol=1e-10)


if __name__ == "__main__":
    unittest.main()
