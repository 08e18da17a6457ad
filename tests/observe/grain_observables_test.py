"""Observables of grains without contact forces, against lattices and closed forms. grain_observables_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
from scans_by_hand import EDGE, SOFT, Lattice

from mcdem.observe.contact_residuals import GrainsAlone, reduced_modulus
from mcdem.observe.grain_observables import NEIGHBOURS
from mcdem.observe.observables import index_of, observables
from mcdem.observe.observation import scan_observables
from mcdem.observe.touching import near_grains
from mcdem.results import NO_CONTACTS, Box, Contacts, ContainerShape

ALONE = replace(SOFT, grains_alone=GrainsAlone(1e-5))
LISTED = replace(SOFT, grains_alone=GrainsAlone(1e-5, listed=True))
SHRUNK = 0.9  # height of a lattice that was compressed, over that at the start


def row(recording, number=0, material=ALONE):
    """Observables of one scan by name."""
    return dict(zip((one.name for one in observables()), scan_observables(recording, [number], material)[0], strict=True))


def moved(lattice, position, plate_z=None):
    """Scan 1 with the grains there, after scan 0 with those of the lattice."""
    recording = lattice.recording(2, position=(lattice.position, position), plate_z=np.array([lattice.plate_z, plate_z or lattice.plate_z]))
    return row(recording, 1)


def pressed(lattice):
    """Everything is moved with the plate."""
    return moved(lattice, lattice.position * (1, 1, SHRUNK), SHRUNK * lattice.plate_z)


class Overlaps(unittest.TestCase):
    """Grains 2 % larger than the spacing: 0.4 mm of overlap between them, half of it at walls."""

    def setUp(self):
        self.lattice = Lattice(5)
        self.between, self.wall = 0.02 * EDGE, 0.01 * EDGE
        self.found = row(self.lattice.recording())

    def test_are_those_of_the_lattice(self):
        diameter = self.lattice.diameter[0]
        for name, wanted in (("touching", 2 * 3 * 5 * 5 * 4 / 125), ("mean_overlap", self.between / diameter), ("overlap_spread", 0),
                             ("side_overlap", self.wall / diameter), ("floor_overlap", self.wall / diameter),
                             ("plate_overlap", self.wall / diameter)):
            self.assertAlmostEqual(self.found[name], wanted, 6, name)

    def test_have_the_forces_of_hertz(self):
        """Five grains in each of 25 columns along each axis have four contacts, and two with walls, of another force."""
        radius = self.lattice.diameter[0] / 2
        inside = 4 / 3 * reduced_modulus(SOFT, False) * math.sqrt(radius / 2) * self.between**1.5
        at_wall = 4 / 3 * reduced_modulus(SOFT, True) * math.sqrt(radius) * self.wall**1.5
        top = self.lattice.top_force
        total = 2 * 300 * inside + 150 * at_wall
        for name, wanted in (("hertz_plate", 25 * at_wall / top), ("hertz_floor", 25 * at_wall / top), ("hertz_sides", 25 * at_wall / top),
                             ("hertz_couple_x", 0), ("hertz_couple_y", 0), ("hertz_anisotropy", 0), ("hertz_gradient", 0),
                             ("hertz_sections", (25 * (4 * inside * EDGE + at_wall * EDGE) / (5 * EDGE)) / top)):
            self.assertAlmostEqual(self.found[name], wanted, delta=1e-6 * max(1, wanted), msg=name)
        corners, edges, faces = 8, 36, 54  # grains at three walls, two, one
        net = (math.sqrt(3) * corners + math.sqrt(2) * edges + faces) * abs(inside - at_wall)
        self.assertAlmostEqual(self.found["hertz_imbalance"], net / total, 9)

    def test_below_the_threshold_do_not_touch(self):
        alone = replace(SOFT, grains_alone=GrainsAlone(1.01 * self.wall))
        found = row(self.lattice.recording(), material=alone)
        self.assertEqual(found["touching"], self.found["touching"])
        self.assertTrue(math.isnan(found["plate_overlap"]))

    def test_a_tilted_plate_shows(self):
        self.lattice.position[:, 2] += 1e-4 * (self.lattice.position[:, 0] / 0.05 - 1)
        found = row(self.lattice.recording())
        self.assertGreater(found["hertz_couple_x"], 0.05)
        self.assertAlmostEqual(found["hertz_couple_y"], 0, 9)


class Lists(unittest.TestCase):
    def listed(self, keep):
        """The lattice, of whose contacts between grains some are listed, without forces."""
        lattice = Lattice(5)
        rows = np.flatnonzero((lattice.contacts.partner >= 0) & keep(lattice.contacts))
        unknown = np.full((len(rows), 3), np.nan)
        contacts = Contacts(lattice.contacts.grain[rows], lattice.contacts.partner[rows], unknown, unknown, unknown[:, 0])
        return row(lattice.recording(contacts=(contacts,)), material=LISTED)

    def test_tell_who_touches(self):
        every, some = self.listed(lambda one: one.grain >= 0), self.listed(lambda one: one.grain >= 25)
        self.assertAlmostEqual(every["touching"], 4.8, 12)
        self.assertAlmostEqual(some["touching"], 2 * (300 - 40 - 25) / 125, 12)  # of the 65 contacts of the lowest layer none is listed
        self.assertAlmostEqual(some["mean_overlap"], every["mean_overlap"], 9)

    def test_have_no_forces(self):
        known = {one.needs for one in observables() if math.isfinite(self.listed(lambda one: one.grain >= 0)[one.name])}
        self.assertEqual(known, {"plate", "grains"})

    def test_frames_without_a_list_are_not_compared(self):
        self.assertTrue(math.isnan(row(Lattice(5).recording(contacts=(NO_CONTACTS,)), material=LISTED)["touching"]))

    def test_simulations_have_that_of_their_contacts(self):
        """Also of grains that do not overlap, whose force is zero then."""
        lattice = Lattice(5, 0.99 * EDGE)
        found = row(lattice.recording(), material=LISTED)
        self.assertAlmostEqual(found["touching"], 4.8, 12)
        self.assertAlmostEqual(found["mean_overlap"], -0.01 / 0.99, 9)
        self.assertTrue(math.isnan(row(lattice.recording())["touching"]))


class Fractions(unittest.TestCase):
    def test_are_those_of_the_thirds(self):
        """Six layers have two in each third. Of four layers, planes cut the second and the third sphere."""
        def thirds(lattice):
            found = row(lattice.recording())
            return [found[f"fraction_{third}"] for third in ("low", "middle", "high")]

        sphere = math.pi / 6 * 1.02**3
        np.testing.assert_allclose(thirds(Lattice(6)), [sphere] * 3, rtol=1e-9)
        # The second sphere reaches from 0.99 to 2.01 spacings, and the plane is at 4/3: a cap is below it.
        cap = 1 / 3 + 0.01
        cut = math.pi * cap**2 * (3 * 0.51 - cap) / 3
        np.testing.assert_allclose(thirds(Lattice(4)), np.array([sphere + cut, 2 * (sphere - cut), sphere + cut]) / (4 / 3), rtol=1e-9)


class Motion(unittest.TestCase):
    def setUp(self):
        self.lattice = Lattice(5)
        self.random = np.random.default_rng(3)

    def test_with_the_plate_is_affine(self):
        found = pressed(self.lattice)
        self.assertAlmostEqual(found["affine_compression"], 1, 9)
        for name in ("affine_rest", "local_rest", "lost_neighbours"):
            self.assertAlmostEqual(found[name], 0, 6, name)

    def test_of_one_half_is_compression_by_less(self):
        """Only the upper half is pressed: the best affine map of z -> -max(0, z - h/2)/5 has the slope of its regression, 1/10 in the limit of
        many layers."""
        z = self.lattice.position[:, 2]
        down = 0.2 * np.maximum(0, z - 2.5 * EDGE)
        found = moved(self.lattice, self.lattice.position - down[:, np.newaxis] * [0, 0, 1], 0.9 * self.lattice.plate_z)
        slope = np.polyfit(z, down, 1)[0]
        self.assertAlmostEqual(found["affine_compression"], slope / 0.1, 9)
        rest = down - np.polyval(np.polyfit(z, down, 1), z)
        self.assertAlmostEqual(found["affine_rest"], math.sqrt(np.mean(rest**2)) / self.lattice.diameter[0], 9)

    def test_local_rest_is_that_of_the_best_map_of_each_surroundings(self):
        """As np.linalg.lstsq finds it grain by grain."""
        position = self.lattice.position + 1e-3 * self.random.standard_normal(self.lattice.position.shape)
        before, reach, squares, number = self.lattice.position, NEIGHBOURS * self.lattice.diameter[0], 0.0, 0
        for i, centre in enumerate(before):
            near = np.flatnonzero((np.linalg.norm(before - centre, axis=1) < reach) & (np.arange(len(before)) != i))
            was, now = before[near] - centre, position[near] - position[i]
            if len(near) >= 5:
                squares += ((now - was @ np.linalg.lstsq(was, now, rcond=None)[0])**2).sum()
                number += len(near)
        self.assertAlmostEqual(moved(self.lattice, position)["local_rest"], math.sqrt(squares / number) / self.lattice.diameter[0], 9)

    def test_of_one_grain_loses_its_neighbours(self):
        position = self.lattice.position.copy()
        position[62] += (0, 0, 0.6 * EDGE)  # of the middle: nearer to the one above, 0.4 spacings away
        self.assertAlmostEqual(moved(self.lattice, position)["lost_neighbours"], 1 / 300, 12)  # below 1.6, sideways 1.17 spacings

    def test_through_a_periodic_face_is_short(self):
        position = self.lattice.position.copy()
        self.lattice.box = Box(5 * EDGE, 5 * EDGE, ContainerShape.periodic)
        position[:, 0] = (position[:, 0] + 0.7 * EDGE) % (5 * EDGE)
        found = moved(self.lattice, position)
        for name in ("affine_rest", "local_rest", "lost_neighbours"):
            self.assertAlmostEqual(found[name], 0, 6, name)
        _, i, j = near_grains(self.lattice.box, self.lattice.position[np.newaxis], 1.01 * EDGE)
        self.assertEqual(len(i), 25 * (5 + 5 + 4))
        self.assertTrue((i < j).all())

    def test_needs_the_first_scan(self):
        recording = self.lattice.recording(2, position=(np.zeros((0, 3)), self.lattice.position))
        found = row(recording, 1)
        self.assertTrue(math.isnan(found["local_rest"]) and math.isfinite(found["touching"]))


class Compared(unittest.TestCase):
    def test_only_without_contact_forces(self):
        grains = [one.name for one in observables() if one.needs == "grains"]
        lattice = Lattice(5)
        both = lattice.recording(2, position=(lattice.position, lattice.position * (1, 1, SHRUNK)),
                                 plate_z=np.array([1, SHRUNK]) * lattice.plate_z)
        for material, known in ((SOFT, False), (ALONE, True)):
            found = row(both, 1, material)
            self.assertEqual({name: math.isfinite(found[name]) for name in grains}, dict.fromkeys(grains, known))
        self.assertEqual(len(grains), 22)

    def test_scans_do_not_mix(self):
        lattice = Lattice(5)
        noisy = lattice.position + 1e-4 * np.random.default_rng(1).standard_normal(lattice.position.shape)
        both = lattice.recording(3, position=(lattice.position, np.zeros((0, 3)), noisy), contacts=(NO_CONTACTS,) * 3)
        together = scan_observables(both, [0, 1, 2], ALONE)
        for k in range(3):
            np.testing.assert_allclose(together[k], scan_observables(both, [k], ALONE)[0], rtol=1e-9, atol=1e-12)
        self.assertTrue(math.isnan(together[1, index_of("touching")]))


if __name__ == "__main__":
    unittest.main()
