"""The observables of single scans against values computed by hand, and which of them a scan determines. scan_observables_test.py"""
import math
import pathlib
import unittest
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from scans_by_hand import EDGE, PUSH, SOFT, Lattice, at, contacts, seen

from mcdem.observe.contact_residuals import ContactResiduals
from mcdem.observe.force_observables import force_distribution, wall_loads
from mcdem.observe.observables import MIN_CONTACTS, index_of, observables
from mcdem.observe.observation import scan_observables
from mcdem.observe.position_observables import attraction, fabric, friction, non_affine, section_load, torque_imbalance, wall_friction
from mcdem.results import NO_CONTACTS, Wall

HERE = (0, 0, 0)


def with_residuals(scan, *, normal=None, normal_force=None, tangential=None):
    """The scan, whose contacts have these normals and forces whatever its positions say."""
    count = len(scan.scan)
    zeros = np.zeros(count)
    made = ContactResiduals(np.zeros((count, 3)) if normal is None else np.array(normal, float),
                            zeros if normal_force is None else np.array(normal_force, float),
                            zeros if tangential is None else np.array(tangential, float), zeros, zeros, zeros, zeros)
    scan.__dict__["residuals"] = made
    return scan


class Forces(unittest.TestCase):
    def test_loads_of_walls(self):
        rows = [(0, at(Wall.plate), (0.05, 0.075, 0.1), (0.5, 0, -3)), (0, at(Wall.plate), (0.15, 0.075, 0.1), (0, 0, -1)),
                (0, at(Wall.floor), HERE, (0.1, 0.2, 5)), (0, at(Wall.x_min), HERE, (0.8, 0.3, 0.3)),
                (0, at(Wall.y_max), HERE, (0.3, -0.4, 0.3)), (0, 1, (0.01, 0.01, 0), (9, 9, -9))]
        loads = np.ravel(wall_loads(seen(rows, top_force=4.4)))
        np.testing.assert_allclose(loads, (5 / 4.4, 1.2 / 4 / 4.4, 4 / 4.4, (3 * -0.5 + 1 * 0.5) / 4, 0.5), rtol=1e-12)

    def test_loads_need_a_force_on_the_plate_and_a_contact_there(self):
        floor, plate = (0, at(Wall.floor), HERE, (0, 0, 5)), (0, at(Wall.plate), HERE, (0, 0, -5))
        for rows, top in (([floor], 0), ([floor], 4.4), ([floor, plate], 0)):
            self.assertTrue(np.isnan(wall_loads(seen(rows, top_force=top))).all())

    def test_distribution(self):
        rows = [(0, at(Wall.floor) if k <= 40 else 1, HERE, k * np.array([2, 1, -2]) / 3) for k in range(1, 101)]
        found = np.ravel(force_distribution(seen(rows, diameter=[0.02] * 50, material=replace(SOFT, force_threshold=5))))
        wanted = ((40 + 2 * 60) / 50, 9 / 50, math.log(50.5), math.sqrt((100**2 - 1) / 12) / 50.5, 0.15, 0, 95 / 50.5)
        np.testing.assert_allclose(found, wanted, atol=1e-12)

    def test_distribution_with_strong_forces(self):
        found = force_distribution(seen([(0, 1, HERE, (1 if k % 10 else 11, 0, 0)) for k in range(100)]))
        np.testing.assert_allclose(np.ravel(found[3:]), (3 / 2, 0, 0.1, 5.5), atol=1e-12)  # variance 0.9 * 1 + 0.1 * 81


class SectionLoad(unittest.TestCase):
    @staticmethod
    def lattice_with_wall_friction(n):
        """At rest; its side walls exert 1 mN upwards on each grain that touches them."""
        carried, lattice = 0.001, Lattice(n)
        force, grain, partner = lattice.contacts.force, lattice.contacts.grain, lattice.contacts.partner
        sides = (partner < 0) & (partner > at(Wall.floor))
        walls = np.bincount(grain[sides], minlength=n**3)
        force[sides, 2] = carried
        for k in np.flatnonzero((force[:, 2] != 0) & ~sides & (partner != at(Wall.plate))):
            from_below = partner[k] == at(Wall.floor)
            above = n - grain[k] // (n * n) - (0 if from_below else 1)
            force[k, 2] = (1 if from_below else -1) * (PUSH - carried * walls[grain[k]] * above)
        return lattice

    def test_is_the_plates_force_whatever_the_walls_carry(self):
        lattice = self.lattice_with_wall_friction(4)
        self.assertLess(wall_loads(lattice.seen())[0][0], 0.8)  # the walls carry the rest
        self.assertAlmostEqual(section_load(lattice.seen())[0], 1, 12)
        lattice.position[:, 2] += 1e-3 * np.sin(np.arange(64))
        self.assertAlmostEqual(section_load(lattice.seen())[0], 1, 12)
        lattice.contacts.force[:] *= 1.1
        self.assertAlmostEqual(section_load(lattice.seen())[0], 1.1, 12)
        lattice.top_force *= 1.1
        self.assertAlmostEqual(section_load(lattice.seen())[0], 1, 12)
        lattice.top_force = 0
        self.assertTrue(np.isnan(section_load(lattice.seen())[0]))

    def test_averages_over_all_contacts(self):
        """Four of a column's six vertical contacts are a fifth of the height apart, those at both ends half of that. The error is
        sqrt(4 + 2/4)/5 of the plate's, which is 5 % / sqrt(25). 400 draws determine it within 3.5 %."""
        lattice, random, errors = Lattice(5), np.random.default_rng(7), []
        exact = lattice.contacts.force.copy()
        for _ in range(400):
            lattice.contacts.force[:] = exact * (1 + 0.05 * random.standard_normal((len(exact), 1)))
            errors.append((wall_loads(lattice.seen())[2][0] - 1, section_load(lattice.seen())[0] - 1))
        at_plate, everywhere = np.sqrt(np.mean(np.square(errors), axis=0))
        self.assertAlmostEqual(at_plate, 0.01, delta=0.0015)
        self.assertAlmostEqual(everywhere / at_plate, math.sqrt(4.5) / 5, delta=0.06)


class Directions(unittest.TestCase):
    def test_anisotropy_and_attraction(self):
        for normal, force, anisotropy, pulls in (
                (np.eye(3), (1, 1, 1), 0, 0), (([1, 0, 0], [0, 0, 1], [1, 0, 0], [1, 0, 0]), (1, 5, -1, -1), 5 / 4 - 1 / 3, 0.5)):
            scan = with_residuals(seen([(0, 1, HERE, HERE)] * len(force)), normal=normal, normal_force=force)
            self.assertAlmostEqual(fabric(scan)[0][0], anisotropy, 12)
            self.assertAlmostEqual(attraction(scan)[0], pulls, 12)

    def test_gradient_with_depth(self):
        lattice = Lattice(4, EDGE)  # the contact point is half a diameter from the centre
        scan = lattice.seen()
        force = np.where(scan.is_wall, 7, 3 - 20 * scan.point[:, 2])  # contacts with walls do not count
        scan = with_residuals(scan, normal=-scan.force / PUSH, normal_force=force)
        self.assertAlmostEqual(fabric(scan)[1][0], 20 * lattice.plate_z / force[~scan.is_wall].mean(), 9)

    def test_non_affine_displacements(self):
        lattice = Lattice(2)
        mapped = lattice.position @ np.array([[0.9, 0.1, 0], [0.02, 1.05, 0.03], [0, -0.04, 0.8]]).T + (1e-3, 2e-3, 3e-3)

        def found(position, before=lattice.position):
            return non_affine(seen(lattice.contacts, position, diameter=lattice.diameter, before=before))[0]

        self.assertAlmostEqual(found(mapped), 0, 9)
        # The signs of x y z at the corners of a cube are orthogonal to every affine function.
        sign = np.prod(np.where(lattice.position > EDGE, -1, 1), axis=1)
        moved = mapped + 5e-4 * sign[:, np.newaxis] * np.array([2, 1, -2]) / 3
        self.assertAlmostEqual(found(moved), 5e-4 / lattice.diameter[0], 9)
        self.assertTrue(np.isnan(found(moved, np.zeros((0, 3)))))


class Friction(unittest.TestCase):
    def test_of_strong_enough_contacts(self):
        kinds = [(1, 1, 0.03), (1, 1, 0.01), (1, 0.1, 0.09), (at(Wall.floor), 2, 0.1), (at(Wall.floor), 2, 0.02)]  # the third is too weak

        def scan(material):
            rows = [(0, partner, HERE, HERE) for partner, *_ in kinds] * 10
            _, force, tangential = zip(*kinds * 10)
            return with_residuals(seen(rows, material=material), normal_force=force, tangential=tangential)

        found = np.ravel(friction(scan(SOFT)) + wall_friction(scan(SOFT)))
        np.testing.assert_allclose(found, (0.02, 0.03, 0.5, 0.03, 0.05), rtol=1e-12)  # half within 20 % of 0.03
        self.assertTrue(np.isnan(friction(scan(replace(SOFT, friction=0)))[2][0]))

    def test_torques(self):
        x_min, x_max, left, right = at(Wall.x_min), at(Wall.x_max), (-1, 0, 0), (1, 0, 0)
        for what, rows, normal, wanted in (
                ("balanced", [(0, x_min, HERE, (1, 0.02, 0)), (0, x_max, HERE, (-1, 0.02, 0))], (left, right), 0),
                ("both turn", [(0, x_min, HERE, (1, 0.02, 0)), (0, x_max, HERE, (-1, -0.02, 0))], (left, right), 1),
                ("half", [(0, x_min, HERE, (1, 0.02, 0)), (0, x_max, HERE, (-1, 0.01, 0))], (left, right), 1 / 3),
                ("two grains have torques of one sign", [(0, 1, HERE, (-1, 0, 0.03))], (right,), 1),
                ("the middle one of three has opposite ones", [(0, 1, HERE, (-1, 0, 0.03)), (1, 2, HERE, (-1, 0, -0.03))], (right, right), 0.5)):
            with self.subTest(what):
                self.assertAlmostEqual(torque_imbalance(with_residuals(seen(rows, diameter=[0.02] * 3), normal=normal))[0], wanted, 12)


class Table(unittest.TestCase):
    def setUp(self):
        """A lattice with nonzero values of all observables: friction, and forces that differ."""
        self.lattice = Lattice(5)
        force = self.lattice.contacts.force
        size = 1 + 0.2 * (np.arange(len(force)) % 7)[:, np.newaxis]
        force[:] = size * (force + 1e-4)

    def row(self, **values):
        return scan_observables(self.lattice.recording(**values), [0], SOFT)[0]

    def expect_known(self, row, *needs):
        for observable, value in zip(observables(), row, strict=True):
            self.assertEqual(math.isfinite(value), observable.needs in needs, observable.name)

    def test_names_are_unique_and_complete(self):
        self.assertEqual(len({one.name for one in observables()}), len(observables()))
        for one in observables():
            self.assertTrue(one.resolution > 0 and one.meaning, one.name)
            self.assertEqual(observables()[index_of(one.name)], one)

    def test_what_a_scan_determines(self):
        self.expect_known(self.row(), "plate", "contacts", "positions")
        self.expect_known(self.row(contacts=(NO_CONTACTS,)), "plate")
        self.expect_known(self.row(position=(np.zeros((0, 3)),)), "plate", "contacts")
        few = self.lattice.contacts.rows(slice(-MIN_CONTACTS + 1, None))
        self.expect_known(self.row(contacts=(few,)), "plate")
        enough = self.row(contacts=(self.lattice.contacts.rows(slice(-MIN_CONTACTS, None)),))
        self.assertTrue(math.isfinite(enough[index_of("mean_force")]))

    def test_scans_do_not_mix(self):
        other = contacts(list(zip(self.lattice.contacts.grain, self.lattice.contacts.partner, self.lattice.contacts.point,
                                  2 * self.lattice.contacts.force))[:200])
        lattice, moved = self.lattice, self.lattice.position * (1, 1, 0.99)
        both = lattice.recording(3, contacts=(lattice.contacts, NO_CONTACTS, other), position=(lattice.position, lattice.position, moved))
        together = scan_observables(both, [0, 1, 2], SOFT)
        for k in range(3):
            np.testing.assert_allclose(together[k], scan_observables(both, [k], SOFT)[0], rtol=1e-9, atol=1e-12)

    def test_values_are_in_their_columns(self):
        lattice = self.lattice
        lattice.position[:, 2] += 1e-4 * lattice.position[:, 0] / 0.05
        at_plate = lattice.at(Wall.plate) & (lattice.contacts.grain % 5 == 0)
        lattice.contacts.force[at_plate] *= 2
        row = self.row()
        value = SimpleNamespace(**{one.name: number for one, number in zip(observables(), row, strict=True)})
        loads = wall_loads(lattice.seen())
        self.assertEqual((value.top_force, value.floor_force, value.plate_couple_x), (math.log(lattice.top_force), loads[0][0], loads[3][0]))
        self.assertLess(value.plate_couple_x, -0.05)  # the row of grains at x = 0 carries twice as much
        for found, wanted, delta in ((value.coordination_number, 6, 1e-12), (value.mean_force, math.log(0.01 * 1.6), 0.02),
                                     (value.force_anisotropy, 0, 0.02), (value.friction_ratio, 0.01 * math.sqrt(2), 1e-3),
                                     (value.wall_friction_ratio, 0.01 * math.sqrt(2), 1e-3)):
            self.assertAlmostEqual(found, wanted, delta=delta)
        self.assertEqual((value.attraction, value.gap_contacts, value.silent_overlaps), (0, 0, 0))
        # At the plate and the floor, half of the lattice was shifted up by 0.1 mm, which is 0.0098 R.
        self.assertGreater(value.floor_overlap_offset, value.plate_overlap_offset)
        self.assertLess(value.plate_overlap_tilt_x, value.plate_overlap_tilt_y)

    def test_without_a_force_on_the_plate(self):
        self.lattice.top_force = 0
        row = self.row()
        for name in ("top_force", "floor_force", "side_force", "plate_contacts", "plate_couple_x", "plate_couple_y"):
            self.assertTrue(math.isnan(row[index_of(name)]), name)
        for name in ("coordination_number", "mean_force", "cross_contact", "plate_overlap_offset"):
            self.assertTrue(math.isfinite(row[index_of(name)]), name)

    def test_all_are_in_the_documentation(self):
        readme = (pathlib.Path(__file__).parents[2] / "host/python/mcdem/diagnosis/README.md").read_text()
        self.assertIn("".join(f"| `{one.name}` | {one.needs} | {one.meaning} |\n" for one in observables()), readme)


if __name__ == "__main__":
    unittest.main()
