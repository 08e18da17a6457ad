"""Comparisons with a reference against closed forms: coordination, distributions of forces, the paper's table. compare_test.py"""
import itertools
import math
import unittest
from dataclasses import replace

import numpy as np
import synthetic
from synthetic import FLOOR, Law, changed, contacts_of, recording, rows, stopped, with_parameters

from mcdem.errors import InputError
from mcdem.observe.compare import compare
from mcdem.observe.coordination import Coordination, coordination_error, reference_coordination
from mcdem.observe.estimate import Jackknife, mean_over_replicas
from mcdem.observe.force_distribution import bhattacharyya, bin_count, common_edges, distribution_distance, force_density, histogram
from mcdem.observe.levels import group_levels, match_levels
from mcdem.observe.model_table import model_table
from mcdem.observe.replicas import group_by_setting, seeds_of
from mcdem.results import NO_CONTACTS


def without_weak(made, force):
    """Without contacts whose force is below this [N]."""
    kept = []
    for one in made.scans.contacts:
        strong = np.linalg.norm(one.force, axis=1) >= force
        kept.append(contacts_of(one.grain[strong], one.partner[strong], one.force[strong]))
    return changed(made, contacts=tuple(kept))


def with_scaled_forces(made, scan, factor, walls=True):
    contacts = list(made.scans.contacts)
    one = contacts[scan]
    contacts[scan] = contacts_of(one.grain, one.partner, np.where((one.is_wall | walls)[:, None], factor, 1) * one.force)
    return changed(made, contacts=tuple(contacts))


class CoordinationNumbers(unittest.TestCase):
    def three_grains(self, forces=(1, 3, 2)):
        """Two contacts between grains, one with the floor."""
        force = np.outer(forces, [0, 0.6, -0.8])
        made = synthetic.scans(1, contacts=(contacts_of([0, 1, 0], [1, 2, FLOOR], force),))
        return replace(recording(), diameter=np.ones(3), scans=made)

    def z(self, made, tau):
        return float(Coordination(group_levels([made]), [made]).at_threshold(tau)[0, 0])

    def test_contacts_count_for_both_grains(self):
        for forces, tau, contacts in (((1, 3, 2), 0, 5), ((1, 3, 2), 1.01, 3), ((1, 3, 2), 2.01, 2), ((1, 3, 2), 3.01, 0),
                                      ((2, 3, 2), 1.999, 5)):
            self.assertAlmostEqual(self.z(self.three_grains(forces), tau), contacts / 3, 14)
        exact = self.three_grains()
        exact.scans.contacts[0].force[:] = [[0, 0, 2], [0, 0, 3], [0, 0, 2]]
        self.assertAlmostEqual(self.z(exact, 2.0), 5 / 3, 14)  # forces equal to the threshold count

    def test_unrecorded_contacts_are_not_zero_contacts(self):
        for z, expected in ((6.4, math.nan), (0.0, 0.0)):
            made = changed(self.three_grains(), contacts=(NO_CONTACTS,), coordination_number=np.array([z]))
            np.testing.assert_equal(self.z(made, 0), expected)

    def error(self, simulated, reference):
        a, b = group_levels(simulated), group_levels(reference)
        return coordination_error(a, simulated, reference_coordination(b, reference), match_levels(a, b),
                                  Jackknife(seeds_of(simulated), seeds_of(reference)))

    def test_the_threshold_of_the_reference_is_found(self):
        made = recording(cycles=2, contacts=2000)
        error = self.error([made], [without_weak(made, 4e-3)])
        self.assertAlmostEqual(error.errZ.value, 0, 12)
        self.assertAlmostEqual(error.tau.value, 4e-3, delta=5e-6)  # the spacing of the forces near 4 mN
        self.assertEqual(error.levels_used, 20)
        itself = self.error([made], [made])
        self.assertEqual((itself.errZ.value, itself.tau.value), (0, 0))

    def test_error_is_that_of_the_best_threshold(self):
        # Two levels with equal forces cannot fit both Z + 1 and Z - 1 of a reference: the smallest error is 1.
        made = recording(levels=1, touch=-1e9, contacts=5000)
        made = changed(made, contacts=(made.scans.contacts[0],) * 2)
        measured = changed(made, contacts=(NO_CONTACTS,) * 2, coordination_number=np.array([51.0, 49.0]))
        error = self.error([made], [measured])
        self.assertAlmostEqual(error.errZ.value, 1, 3)
        self.assertAlmostEqual(self.z(made, error.tau.value), 50, delta=0.05)

    def test_without_contacts_the_recorded_numbers_are_used(self):
        made = recording()
        error = self.error([made], [changed(made, coordination_number=made.scans.coordination_number - 0.25)])
        self.assertAlmostEqual(error.errZ.value, 0.25, 12)
        self.assertFalse(error.tau.available())

    def test_a_threshold_without_forces_near_it_has_no_standard_error(self):
        # Forces of 1 and 9 N: every threshold between is as good, and no parabola has a vertex.
        def pair(seed):
            made = self.three_grains()
            force = np.outer([1, 9, 9 + seed], [0, 0, 1])
            return replace(made, parameters={"packing.seed": str(seed)}, scans=replace(
                made.scans, contacts=(contacts_of([0, 1, 0], [1, 2, FLOOR], force),)))
        measured = changed(pair(3), contacts=(NO_CONTACTS,), coordination_number=np.array([1.1]))
        error = self.error([pair(1), pair(2)], [measured])
        self.assertAlmostEqual(error.errZ.value, 0.1, 12)
        self.assertAlmostEqual(error.tau.value, 5, delta=0.1)
        self.assertTrue(math.isnan(error.tau.standard_error))

    def test_standard_error_is_the_scatter_of_repetitions(self):
        measured = without_weak(recording(seed=999, levels=2, contacts=2000), 4e-3)
        errors = [self.error([recording(seed=1 + 6 * k + r, levels=2, contacts=2000) for r in range(6)], [measured]) for k in range(12)]
        scatter = np.std([error.tau.value for error in errors], ddof=1)
        claimed = np.mean([error.tau.standard_error for error in errors])
        self.assertTrue(0.5 < claimed / scatter < 2, claimed / scatter)


class Distributions(unittest.TestCase):
    def overlap(self, p, q):
        edges = common_edges(p, q, bin_count(len(p), len(q)))
        return bhattacharyya(histogram(p, edges), histogram(q, edges))

    def assert_overlap(self, p, q, exact):
        """Within three standard errors of a sum of sqrt(p q), which follow from those of the counts."""
        self.assertAlmostEqual(self.overlap(p, q), exact, delta=3 * math.sqrt((1 - exact**2) / 4 * (1 / len(p) + 1 / len(q))))

    def test_closed_forms(self):
        random = np.random.default_rng(1)
        for ratio in (1.2, 1.5, 2.0, 4.0):
            p, q = random.exponential(1, 22500), random.exponential(ratio, 22500)
            self.assert_overlap(p, q, 2 * math.sqrt(ratio) / (1 + ratio))
        for shift, width in itertools.product((0.5, 1.0, 2.0), (1.0, 1.5)):
            p, q = random.normal(10, 1, 22500), random.normal(10 + shift, width, 22500)
            s = 1 + width * width
            self.assert_overlap(p, q, math.sqrt(2 * width / s) * math.exp(-shift * shift / (4 * s)))

    def test_symmetry_scale_and_limits(self):
        random = np.random.default_rng(5)
        p, q = random.exponential(1, 3000), random.exponential(0.5, 4000)
        self.assertAlmostEqual(self.overlap(p, q), self.overlap(q, p), 14)
        self.assertAlmostEqual(self.overlap(p, q), self.overlap(7 * p**3, 7 * q**3), 14)
        self.assertLess(self.overlap(random.uniform(0, 1, 2000), random.uniform(5, 6, 3000)), 1 / bin_count(2000, 3000) + 0.005)
        self.assertAlmostEqual(self.overlap(np.full(100, 2.0), np.full(50, 2.0)), 1, 12)  # equal forces
        self.assertTrue(math.isnan(self.overlap(p, np.zeros(0))))
        self.assertEqual([bin_count(*two) for two in ((1, 1), (1500, 1500), (10**9, 10**9))], [4, 37, 100])

    def test_noise_of_counts_is_corrected(self):
        # Without the correction the mean is too small by (K - 1) / 8 * 2 / n = 0.0059 for n = 1500 and K = 37 bins.
        random = np.random.default_rng(7)
        overlaps = [self.overlap(random.gamma(1.5, size=1500), random.gamma(1.5, size=1500)) for _ in range(100)]
        self.assertAlmostEqual(np.mean(overlaps), 1, delta=1e-3)

    def distance(self, simulated, reference):
        a, b = group_levels(simulated), group_levels(reference)
        return distribution_distance(a, b, match_levels(a, b), Jackknife(seeds_of(simulated), seeds_of(reference)))

    def test_distance(self):
        a, b = (recording(seed=seed, cycles=15, levels=2, contacts=1500) for seed in (1, 2))
        self.assertLess(self.distance([a], [b]).bhat.value, 0.001)
        self.assertEqual(self.distance([a], [b]).levels_used, 4)
        a, b = (recording(seed=seed, levels=1, contacts=20000) for seed in (1, 2))
        b = with_scaled_forces(b, 0, 16)  # B = 2 * 4 / 17 while loading, 1 while unloading: minus log of the mean
        self.assertAlmostEqual(self.distance([a], [b]).bhat.value, -math.log((8 / 17 + 1) / 2), delta=0.01)

    def test_walls_and_levels_without_contacts_are_left_out(self):
        a, b = (recording(seed=seed, levels=2, contacts=5000) for seed in (1, 2))
        b = with_scaled_forces(b, 0, 1000, walls=False)
        b = changed(b, contacts=(b.scans.contacts[0], NO_CONTACTS, *b.scans.contacts[2:]))
        distance = self.distance([a], [b])
        self.assertLess(distance.bhat.value, 0.003)
        self.assertEqual(distance.levels_used, 3)

    def test_standard_error_is_the_scatter_of_repetitions(self):
        measured = recording(seed=999, levels=1, contacts=3000)
        distances = [self.distance([recording(seed=1 + 5 * k + r, levels=1, contacts=800, mean_force=90e-3) for r in range(5)], [measured])
                     for k in range(16)]
        scatter = np.std([one.bhat.value for one in distances], ddof=1)
        claimed = mean_over_replicas([one.bhat.standard_error for one in distances]).value
        self.assertTrue(0.5 < claimed / scatter < 2, claimed / scatter)

    def test_density_integrates_to_one(self):
        density = force_density(group_levels([recording(levels=1, touch=-1e9, contacts=50000)])[0], 40, 0.4)
        self.assertAlmostEqual(sum(one.value for one in density.density) * 0.01, 1, 3)
        self.assertAlmostEqual(density.density[2].value, math.exp(-0.5) / 0.05, delta=0.3)
        self.assertAlmostEqual(density.force[2], 0.025, 14)


class Comparisons(unittest.TestCase):
    def compared(self, run, *reference):
        return compare(group_by_setting(run)[0], reference)

    def test_with_itself(self):
        run = synthetic.run([Law(cycles=2, scatter=0.05, contacts=500)], 4)
        one = self.compared(run, *run.recordings)
        self.assertAlmostEqual(one.Rtop.value, 1, 14)
        self.assertAlmostEqual(one.Rtop.standard_error, 0, 12)  # paired by seed
        self.assertEqual((one.errf.value, one.errZ.value, one.levels_errf, one.replicas, one.notes), (0, 0, 20, 4, []))
        self.assertLess(one.bhat.value, 1e-3)

    def test_known_results(self):
        one = self.compared(synthetic.run([Law(top=6.0, hysteresis=0.0, touch=0.0)], 2), recording(hysteresis=0.0, touch=0.0))
        self.assertAlmostEqual(one.Rtop.value, 0.4, 12)
        # 9 N (i/10)^(3/2) at i = 1 .. 10 and 9 .. 0: mean square 81 (2 * 2025 + 1000) / 1000 / 20
        self.assertAlmostEqual(one.errf.value, math.sqrt(81 * (2 * 2025 + 1000) / 1000 / 20), 12)

    def test_scatter_of_replicas_gives_the_error(self):
        one = self.compared(synthetic.run([Law(scatter=0.05)], 32), recording())
        self.assertAlmostEqual(one.Rtop.standard_error, 0.05 / math.sqrt(32), delta=0.004)
        self.assertGreater(one.errf.standard_error, 0)

    def test_missing_quantities_are_noted(self):
        run = synthetic.run([Law(levels=7)], 2)
        run = replace(run, recordings=(run.recordings[0], stopped(run.recordings[1], 3)))
        one = self.compared(run, recording())
        self.assertEqual(one.notes, [
            "1 of 2 replicas stopped early (first: step 4711, grain 42: overlap past the limit); their scans until then count, except in "
            "Rtop where they did not get there",
            "16 of 20 levels of the reference lie between levels of the simulation: interpolated",
            "2 of 20 levels of the reference are outside the simulated ones: left out",
            "errZ is without threshold: the simulation has no contacts recorded",
            "bhat: contacts are not recorded on both sides at any level"])
        self.assertTrue(one.Rtop.available() and not one.bhat.available())

    def test_the_end_of_a_shorter_simulation_is_noted(self):
        run = synthetic.run([Law()], 1)
        cut = replace(run, recordings=(rows(run.recordings[0], run.recordings[0].displacement < 21.1e-3),))
        self.assertIn("Rtop is taken at 21.00 mm, where the simulation ends; the reference goes to 30.00 mm",
                      self.compared(cut, recording()).notes)

    def test_the_scale_of_lengths_does_not_matter(self):
        found = []
        for scale, at in ((1, "21.00"), (1e-3, "0.021")):  # grains of 21 mm and of 21 um
            law = Law(stroke=0.03 * scale, touch=0.0)
            run = synthetic.run([law], 1)
            for levels, end in ((slice(None), 0.0211), (slice(6, 7), 0.03)):  # to 7 of 10 levels; one level
                made = rows(run.recordings[0], run.recordings[0].displacement < end * scale)
                one = self.compared(replace(run, recordings=(rows(made, np.arange(len(made.scans))[levels]),)), recording(law))
                self.assertTrue(any(f"Rtop is taken at {at} mm" in note for note in one.notes), one.notes)
                found.append((one.Rtop.value, one.errf.value, one.levels_errf, len(one.notes)))
        np.testing.assert_allclose(found[2:], found[:2], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(found[0][:3], (1, 0, 15), atol=1e-9)

    def test_discarded_cycles(self):
        run = synthetic.run([Law()], 1)
        run = replace(run, recordings=(with_parameters(run.recordings[0], protocol__discard="1"),))
        with self.assertRaisesRegex(InputError, "reference: must have scans after its discarded cycles"):
            self.compared(run, run.recordings[0])
        one = self.compared(run, with_parameters(recording(cycles=2), protocol__discard="1"))
        self.assertEqual(one.notes, ["no scans after the discarded cycles"])


class Models(unittest.TestCase):
    def table(self, laws, replicas, change=lambda one, number: one, reference=None):
        run = synthetic.run(laws, replicas)
        run = replace(run, recordings=tuple(change(one, number) for number, one in enumerate(run.recordings)))
        return model_table(group_by_setting(run), reference)

    def test_ratios_are_over_mc_dem_and_paired_by_seed(self):
        laws = [Law(model="independent", top=6.45, scatter=0.1), Law(scatter=0.1)]
        table = self.table(laws, 5)
        self.assertEqual(table.reference, "mc_dem")
        self.assertAlmostEqual(table.displacement, 30e-3, 12)
        self.assertAlmostEqual(table.rows[0].ratio.value, 0.43, 12)
        self.assertAlmostEqual(table.rows[0].ratio.standard_error, 0, 12)
        self.assertGreater(table.rows[0].top_force.standard_error, 0.05)
        other = self.table(laws, 5, lambda one, k: with_parameters(one, packing__seed=str(100 + k)) if k > 4 else one)
        self.assertGreater(other.rows[0].ratio.standard_error, 0.01)

    def test_replicas_that_stopped(self):
        table = self.table([Law(model="elastic_half_space", top=12.0), Law()], 3, lambda one, k: one if k else stopped(one, 5))
        self.assertEqual((table.rows[0].failed, table.rows[0].top_force.count), (1, 2))
        self.assertAlmostEqual(table.rows[0].ratio.value, 0.8, 12)

    def test_a_setting_that_stopped_shows_its_last_scan(self):
        table = self.table([Law(model="independent", top=6.0), Law()], 2, lambda one, k: one if k < 2 else stopped(one, 6))
        whole, cut = table.rows
        self.assertAlmostEqual(table.displacement, 30e-3, 12)  # of the independent contacts
        self.assertIsNone(whole.reached)
        self.assertFalse(whole.ratio.available())
        self.assertAlmostEqual(cut.reached, 18e-3, 12)
        self.assertAlmostEqual(cut.top_force.value, 15 * (13 / 25) ** 1.5, 12)
        self.assertAlmostEqual(cut.ratio.value, 1, 12)

    def test_reference(self):
        laws = [Law(model="sphere_to_sphere", top=10.0), Law(model="independent", top=5.0)]
        self.assertEqual(self.table(laws, 1).reference, "sphere_to_sphere")
        self.assertAlmostEqual(self.table(laws, 1, reference="independent").rows[0].ratio.value, 2, 12)
        with self.assertRaisesRegex(InputError, '"sphere_to_sphere", "independent"; got "hertz"'):
            self.table(laws, 1, reference="hertz")


if __name__ == "__main__":
    unittest.main()
