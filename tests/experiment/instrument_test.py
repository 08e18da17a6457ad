"""What an instrument reads of a packing: size and independence of its noise, and each of its errors. instrument_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
from recordings import recording_of
from small_run import AT_REST, SMALL, made_run

from mcdem.experiment.experiment import Measurement
from mcdem.experiment.instrument import Instrument, measured
from mcdem.results import NO_CONTACTS, Box, Contacts, Phase, Wall, read_run

GRAINS, SCANS = 400, 5
FLOOR = -1 - Wall.floor


def truth():
    """A packing that is not in equilibrium but has everything that a simulation records; no contacts in its first scan."""
    random = np.random.default_rng(5)
    pairs = [(i, i + after) for i in range(GRAINS) for after in range(1, 4) if i + after < GRAINS] + [(i, -1 - i % 6) for i in range(GRAINS)]
    grain, partner = np.array(sorted(pairs, key=lambda pair: pair[0])).T
    position = random.uniform((0.01, 0.01, 0.01), (0.19, 0.09, 0.14), (SCANS, GRAINS, 3))
    contacts = {scan: Contacts(grain, partner, position[scan][grain], 0.1 * random.standard_normal((len(grain), 3)), np.full(len(grain), 1e-3))
                for scan in range(1, SCANS)}
    frame = np.arange(SCANS)
    return recording_of("true", Box(0.2, 0.1), 0.19, random.uniform(0.018, 0.022, GRAINS), plate_z=0.19 - 0.01 * frame, top_force=3.0 * frame,
                        cycle=frame // 4, phase=frame % 2, position=position, contacts=contacts, parameters={})


TRUTH = truth()


def of_plate(heights, forces=None, phase=0, cycle=0, start=0.1):
    return recording_of("plate", Box(0.2, 0.1), start, [], plate_z=heights, top_force=forces if forces is not None else 1.0 + np.arange(len(heights)),
                        phase=phase, cycle=cycle, parameters={})


class Perfect(unittest.TestCase):
    def test_reads_what_is_there(self):
        seen = measured(TRUTH, Instrument(), 1)
        self.assertEqual(seen.label, "true")
        np.testing.assert_array_equal(seen.diameter, TRUTH.diameter)
        np.testing.assert_array_equal(seen.scans.plate_z, TRUTH.scans.plate_z)
        np.testing.assert_array_equal(seen.scans.top_force, TRUTH.scans.top_force)
        for scan in range(SCANS):
            was, one = TRUTH.scans.contacts[scan], seen.scans.contacts[scan]
            np.testing.assert_allclose(seen.scans.position[scan], TRUTH.scans.position[scan], atol=1e-15)
            np.testing.assert_array_equal(one.force, was.force)
            if scan:
                np.testing.assert_allclose(seen.scans.wall_force[scan, Wall.floor], -was.force[was.partner == FLOOR].sum(axis=0), rtol=1e-12)
        self.assertTrue(np.isnan(seen.scans.packing_fraction).all() and np.isnan(seen.scans.contacts[1].overlap).all())

    def test_averages_are_those_of_the_engine(self):
        """Also where contacts cross the sides of a periodic container."""
        for shape in ("box", "periodic"):
            true = read_run(made_run(SMALL, (AT_REST, ("container.shape", shape))), contacts=True, positions=True).recordings[1]
            seen = measured(true, Instrument(), 1).scans
            for name in ("branch_length", "mean_force", "coordination_number"):
                of_engine = getattr(true.scans, name)[-3:]
                self.assertGreater(of_engine.min(), 0)
                np.testing.assert_allclose(getattr(seen, name)[-3:], of_engine, rtol=1e-5, err_msg=f"{shape}: {name}")  # positions as float

    def test_works_without_positions_and_contacts(self):
        noisy = Instrument(Measurement(1e-4, 5e-5, 0.05, 0.02), 0.03, -0.01, 0.002, 1e-4)
        bare = replace(TRUTH, scans=replace(TRUTH.scans, contacts=(NO_CONTACTS,) * SCANS))
        self.assertEqual(len(measured(bare, noisy, 1).scans.position[2]), GRAINS)
        plate = measured(of_plate([0.1, 0.09]), noisy, 1)
        self.assertEqual([len(one) for one in plate.scans.position], [0, 0])
        self.assertTrue(np.isnan(plate.scans.mean_force).all())
        self.assertEqual(len(measured(of_plate([]), noisy, 1).scans), 0)


class Noise(unittest.TestCase):
    def expect(self, values, sd):
        """Mean 0 and this standard deviation, within 4.5 sigma for this many numbers."""
        self.assertLess(abs(np.mean(values)), 4.5 * sd / math.sqrt(values.size))
        self.assertLess(abs(np.std(values) - sd), 4.5 * sd / math.sqrt(2 * values.size))

    def test_contacts_that_are_not_seen_are_the_stated_fraction(self):
        """Of all forces alike, between grains alone, and others in every scan."""
        seen = measured(TRUTH, Instrument(lost_contacts=0.2), 3)
        grains = TRUTH.scans.contacts[1].partner >= 0  # the same in every scan
        there = [np.isin(was.grain * 1000 + was.partner, one.grain * 1000 + one.partner)
                 for was, one in zip(TRUTH.scans.contacts[1:], seen.scans.contacts[1:])]
        self.assertTrue(all(one[~grains].all() for one in there))
        there = [one[grains] for one in there]
        self.expect(np.concatenate(there) - 0.8, 0.4)  # binomial
        force = np.concatenate([np.linalg.norm(one.force[grains], axis=1) for one in TRUTH.scans.contacts[1:]])
        self.assertLess(abs(np.corrcoef(force, np.concatenate(there))[0, 1]), 4.5 / math.sqrt(len(force)))
        self.assertLess(abs(np.corrcoef(there[0], there[1])[0, 1]), 4.5 / math.sqrt(len(there[0])))

    def test_heights_of_grains_are_read_too_large(self):
        seen = measured(TRUTH, Instrument(height_bias=0.01), 3)
        np.testing.assert_allclose(seen.scans.position[1], TRUTH.scans.position[1] * [1, 1, 1.01], rtol=1e-12)
        np.testing.assert_allclose(seen.scans.contacts[1].point, TRUTH.scans.contacts[1].point * [1, 1, 1.01], rtol=1e-12)
        np.testing.assert_array_equal(seen.scans.plate_z, TRUTH.scans.plate_z)

    def test_has_the_stated_size_and_is_uncorrelated(self):
        seen = measured(TRUTH, Instrument(Measurement(2e-4, 1e-4, 0.05, 0)), 3)
        shift = np.array(seen.scans.position) - TRUTH.scans.position
        was, now = ([scans.contacts[k] for k in range(1, SCANS)] for scans in (TRUTH.scans, seen.scans))
        gain = np.array([np.einsum("ij,ij->i", a.force, b.force) / np.einsum("ij,ij->i", a.force, a.force) - 1 for a, b in zip(was, now)])
        for k, (a, b) in enumerate(zip(was, now), 1):
            np.testing.assert_allclose(np.cross(a.force, b.force), 0, atol=1e-15)  # the same direction
            grains = a.partner >= 0
            mean = 0.5 * (shift[k][a.grain[grains]] + shift[k][a.partner[grains]])
            np.testing.assert_allclose((b.point - a.point)[grains], mean, atol=1e-15)
        same_grain = was[0].grain[1:] == was[0].grain[:-1]
        self.expect(seen.diameter - TRUTH.diameter, 1e-4)
        self.expect(shift, 2e-4)
        self.expect(shift[1:, :, 0] * shift[:-1, :, 0], 4e-8)  # product of two values: the product of their sigmas
        self.expect(shift[..., 0] * shift[..., 1], 4e-8)
        self.expect(gain, 0.05)
        self.expect((gain[:, 1:] * gain[:, :-1])[:, same_grain], 0.05**2)
        self.expect(gain[1:] * gain[:-1], 0.05**2)

    def test_depends_only_on_the_quantity_and_the_seed(self):
        instrument, scans = Instrument(Measurement(1e-4, 1e-4, 0.05, 0)), TRUTH.scans
        fewer = scans.chosen(np.arange(SCANS) < 3)
        fewer = replace(fewer, contacts=(NO_CONTACTS, NO_CONTACTS, scans.contacts[2].rows(slice(1, None))))
        a, b, other = measured(TRUTH, instrument, 9), measured(replace(TRUTH, scans=fewer), instrument, 9), measured(TRUTH, instrument, 10)
        np.testing.assert_array_equal(a.diameter, b.diameter)
        np.testing.assert_array_equal(a.scans.position[2], b.scans.position[2])
        np.testing.assert_array_equal(a.scans.contacts[2].force[1:], b.scans.contacts[2].force)
        for one, two in ((a.diameter, other.diameter), (a.scans.position[1], other.scans.position[1]),
                         (a.scans.contacts[1].force, other.scans.contacts[1].force)):
            self.assertFalse((one == two).any())

    def test_does_not_reverse_forces(self):
        seen = measured(TRUTH, Instrument(Measurement(force_error=3)), 1)
        self.assertTrue((np.einsum("ij,ij->i", seen.scans.contacts[1].force, TRUTH.scans.contacts[1].force) >= 0).all())

    def test_is_the_same_on_every_machine(self):
        """Values of the keyed numbers that were recorded with host/core/random.h."""
        from mcdem.experiment.keyed_normal import keyed_normals
        np.testing.assert_allclose(keyed_normals(7, 5, [0, 1, 2], [3, 2**40, 2**63]), RECORDED, rtol=1e-12)


RECORDED = (-1.3085715052614786, -0.37098561254078249, 0.13305513834008281)


class Errors(unittest.TestCase):
    def test_biases_scale_lengths_forces_and_plate_positions(self):
        seen = measured(TRUTH, Instrument(force_bias=0.1, position_bias=0.02, strain_offset=3e-4), 1)
        middle = np.array([0.1, 0.05, 0])
        np.testing.assert_allclose(seen.scans.plate_z, TRUTH.scans.plate_z + 3e-4, rtol=1e-14)
        np.testing.assert_array_equal(seen.scans.top_force, TRUTH.scans.top_force)
        for k in range(1, SCANS):
            was, one = TRUTH.scans.contacts[k], seen.scans.contacts[k]
            np.testing.assert_allclose(seen.scans.position[k], middle + 1.02 * (TRUTH.scans.position[k] - middle), rtol=1e-13)
            np.testing.assert_allclose(one.point, middle + 1.02 * (was.point - middle), rtol=1e-13)
            np.testing.assert_allclose(one.force, 1.1 * was.force, rtol=1e-13)
        self.assertEqual(seen.plate_start, TRUTH.plate_start)
        np.testing.assert_array_equal(seen.diameter, TRUTH.diameter)

    def test_of_the_load_cell(self):
        down_up, path = [0.1, 0.09, 0.07, 0.08], np.array([0, 0.01, 0.03, 0.04]) / 0.06
        rests = [0.1, 0.09, 0.07, 0.07, 0.08, 0.1]  # at the fourth scan
        there_and_back, phases = [0.1, 0.09, 0.08, 0.09, 0.1], [0, 0, 0, 1, 1]
        lagging = [0, 0.5, 2, 1.8, 1, 0]
        for instrument, heights, force, phase, read in (
                (Instrument(gauge_drift=0.2), down_up, [1, 2, 3, 4], 0, (1 + 0.2 * path) * [1, 2, 3, 4]),
                (Instrument(gauge_drift=0.2), [0.1], [1], 0, [1]),
                (Instrument(zero_drift=-0.03), down_up, [0, 0.5, 2, 0.25], 0, [0, 0.5, 2, 0.25] - 0.03 * 2 * path),
                (Instrument(gauge_hysteresis=0.1), [0.1] * 6, [0, 1, 4, 2, 1, 0], [0, 0, 0, 1, 1, 1], [0, 1, 4, 2.4, 1.3, 0]),
                (Instrument(guide_friction=0.05), there_and_back, [0, 1, 4, 1, 0], phases, [0, 1.2, 4.2, 0.8, -0.2]),
                (Instrument(force_lag=0), rests, lagging, 0, lagging),
                (Instrument(force_lag=0.005), rests, lagging, 0, [0, 0.25, 1.625, 1.8, 1.4, 0.25]),
                (Instrument(force_lag=0.015), rests, lagging, 0, [0, 0, 0.875, 1.8, 1.625, 0.75])):
            with self.subTest(instrument):
                seen = measured(of_plate(heights, force, phase), instrument, 1)
                np.testing.assert_allclose(seen.scans.top_force, read, atol=1e-12)
                np.testing.assert_array_equal(seen.scans.plate_z, heights)

    def test_drift_does_not_depend_on_the_end_of_the_recording(self):
        heights, cycle, instrument = [0.1, 0.09, 0.08, 0.09] * 2, np.repeat([0, 1], 4), Instrument(gauge_drift=0.2)
        whole = measured(of_plate(heights, [1.0] * 8, cycle=cycle), instrument, 1).scans.top_force
        self.assertAlmostEqual(whole[2], 1 + 0.2 / 4, 14)
        np.testing.assert_array_equal(measured(of_plate(heights[:7], [1.0] * 7, cycle=cycle[:7]), instrument, 1).scans.top_force, whole[:7])

    def test_strong_contact_forces_saturate(self):
        seen, force = measured(TRUTH, Instrument(force_saturation=0.7, force_bias=0.1), 1), TRUTH.scans.contacts[1].force
        np.testing.assert_allclose(seen.scans.contacts[1].force, 1.1 * force / (1 + 0.7 * np.linalg.norm(force, axis=1, keepdims=True)), rtol=1e-13)
        np.testing.assert_array_equal(seen.scans.top_force, TRUTH.scans.top_force)

    def test_the_real_threshold_has_its_error_and_averages_use_the_stated_one(self):
        size = 1.25 * np.linalg.norm(TRUTH.scans.contacts[1].force, axis=1)
        for shift in (-0.05, 0.0, 0.05):
            scans = measured(TRUTH, Instrument(Measurement(force_threshold=0.1), 0.25, shift), 1).scans
            self.assertEqual(len(scans.contacts[1]), np.count_nonzero(size >= 0.1 + shift))
            counted = size >= max(0.1, 0.1 + shift)
            self.assertLess(np.count_nonzero(counted), len(size))
            self.assertAlmostEqual(scans.mean_force[1], size[counted].mean(), 12)
            walls = TRUTH.scans.contacts[1].partner < 0
            self.assertAlmostEqual(scans.coordination_number[1], (2 * np.count_nonzero(counted & ~walls) + np.count_nonzero(counted & walls)) / GRAINS, 12)

    def test_only_programmes_have_times(self):
        timed = replace(TRUTH, scans=replace(TRUTH.scans, time=np.arange(5.0)))
        self.assertTrue(np.isnan(measured(timed, Instrument(), 1).scans.time).all())
        seen = measured(replace(timed, parameters={"programme.1.stage": "move"}), Instrument(), 1)
        np.testing.assert_array_equal(seen.scans.time, np.arange(5.0))
        self.assertEqual(Phase(int(seen.scans.phase[1])), Phase.unload)


if __name__ == "__main__":
    unittest.main()
