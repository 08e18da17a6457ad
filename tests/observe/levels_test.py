"""Estimates, settings, levels, top forces and the scaling law against closed forms. levels_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np
import synthetic
from synthetic import Law, changed, recording, rows, stopped, with_force, with_parameters

from mcdem.errors import InputError
from mcdem.observe.estimate import Estimate, Jackknife, Omission, Sample, mean_over_replicas, pair_by_seed, ratio_of_means
from mcdem.observe.law_range import beyond_law
from mcdem.observe.levels import at_reference, by_replica, group_levels, level_means, match_levels, top_force
from mcdem.observe.programmes import are_cells, has_hold, mean_scans, with_programme
from mcdem.observe.replicas import Setting, discard_of, group_by_setting, model_of, seeds_of
from mcdem.observe.scaling import ScalingPoint, fit_scaling, scaling_points
from mcdem.observe.stress_strain import deviatoric_strain, deviatoric_stress, mean_stress, strongest_scan, volume_strain
from mcdem.observe.top_force import top_force_error, top_force_ratio
from mcdem.results import ContactModel, Phase

NAN = math.nan


class Estimates(unittest.TestCase):
    def test_mean_and_standard_error(self):
        mean = mean_over_replicas([1, 2, NAN, 3, 4])
        self.assertEqual((mean.value, mean.count), (2.5, 4))
        self.assertAlmostEqual(mean.standard_error, math.sqrt(5 / 3 / 4), 14)
        self.assertTrue(math.isnan(mean_over_replicas([3]).standard_error))
        self.assertFalse(mean_over_replicas([NAN]).available())

    def test_pairs_need_the_same_seeds_each_once(self):
        self.assertEqual(pair_by_seed("123", "312"), [(0, 1), (1, 2), (2, 0)])
        for a, b in (("12", "13"), ("12", "123"), ("11", "12"), ("12", "11"), (["", ""], ["", ""]), ((), ())):
            self.assertIsNone(pair_by_seed(a, b), (a, b))

    def test_ratios(self):
        def ratio(seeds_a, a, seeds_b, b):
            return ratio_of_means(Sample(seeds_a, np.array(a, float)), Sample(seeds_b, np.array(b, float)))

        common = ratio("123", [0.5, 1, 1.5], "321", [3, 2, 1])
        self.assertEqual(common.value, 0.5)
        self.assertAlmostEqual(common.standard_error, 0, 15)
        failed = ratio("123", [1, 1, 100], "123", [2, 2, NAN])
        self.assertEqual((failed.value, failed.count), (0.5, 2))
        apart = ratio("12", [9, 11], "56", [19, 21])  # standard errors 1 and 1
        self.assertAlmostEqual(apart.standard_error, math.hypot(1 / 20, 0.5 / 20), 14)
        self.assertAlmostEqual(ratio("12", [9, 11], [""], [20]).standard_error, 1 / 20, 14)
        self.assertTrue(math.isinf(ratio("1", [9], "5", [0]).value))

    def test_jackknife_of_means_is_their_standard_error(self):
        a, b = [1.0, 4, 9, 16, 25], [10.0, 30]
        for other in ([7.0], b):
            jackknife = Jackknife("12345", [""] * len(other))
            values = [np.mean(np.delete(a, one.simulated) if one.simulated >= 0 else a)
                      - np.mean(np.delete(other, one.reference) if one.reference >= 0 else other) for one in jackknife.omissions]
            expected = [error for error in (mean_over_replicas(a).standard_error, mean_over_replicas(other).standard_error)
                        if not math.isnan(error)]
            self.assertAlmostEqual(jackknife.estimate(values).standard_error, math.hypot(*expected), 12)
            self.assertEqual(jackknife.estimate(values).count, 5)
        self.assertEqual(Jackknife("123", [""]).estimate([3, 1, 1, 1]), Estimate(3, 0, 3))  # the value is that without omissions

    def test_jackknife_omits_pairs_together(self):
        counts = [len(Jackknife(a, b).omissions) for a, b in (("123", "321"), ("123", "789"), ("1", [""]))]
        self.assertEqual(counts, [4, 7, 1])
        self.assertEqual(Jackknife("12", "21").omissions[1], Omission(0, 1))


class Settings(unittest.TestCase):
    def test_seeds_are_replicas_and_models_are_settings(self):
        run = synthetic.run([Law(model='"independent"'), Law(model="mc_dem")], 3)
        one = list(run.recordings)
        one[1], one[4] = one[4], one[1]
        settings = group_by_setting(replace(run, recordings=tuple(one)))
        self.assertEqual([setting.label for setting in settings], ["independent", "mc_dem"])
        self.assertEqual(seeds_of(settings[0].replicas), ["1", "3", "2"])
        self.assertEqual(model_of(settings[0].replicas), ContactModel.independent)

    def test_labels(self):
        run = synthetic.run([Law()], 4)
        gammas = [with_parameters(one, contact__gamma="1" if k < 2 else "1.125") for k, one in enumerate(run.recordings)]

        def labels(recordings):
            return [setting.label for setting in group_by_setting(replace(run, recordings=tuple(recordings)))]

        self.assertEqual(labels(gammas), ["gamma=1", "gamma=1.125"])
        named = [replace(one, label=f"{'packing 7' if k < 2 else 'gamma'} #{k % 2 + 1}") for k, one in enumerate(gammas)]
        self.assertEqual(labels(named), ["packing 7", "gamma"])
        named[3] = replace(named[3], label="packing 7 #4")  # no longer distinct
        self.assertEqual(labels(named), ["gamma=1", "gamma=1.125"])
        self.assertEqual(labels(run.recordings), ["mc_dem"])
        unknown = [replace(one, parameters={}) for one in run.recordings]
        self.assertEqual((labels(unknown), model_of(unknown)), (["synthetic"], None))

    def test_discard(self):
        for text, number in (("5", 5), ("-3", 0), ("", 0), ("5x", 5), ("x5", 0), ("99999999999", 0)):
            self.assertEqual(discard_of(with_parameters(recording(), protocol__discard=text)), number, text)


class Levels(unittest.TestCase):
    def test_one_for_each_phase_and_displacement(self):
        levels = group_levels([recording(cycles=3, levels=4)])
        self.assertEqual([level.phase for level in levels], [Phase.load] * 4 + [Phase.unload] * 4)
        np.testing.assert_allclose([level.displacement for level in levels], np.array([7.5, 15, 22.5, 30, 0, 7.5, 15, 22.5]) / 1e3,
                                   atol=1e-12)
        self.assertEqual({len(level.scans[0]) for level in levels}, {3})

    def test_first_cycles_are_discarded(self):
        made = recording(cycles=4, levels=2)
        for discard, cycles in (("3", [3]), ("1", [1, 2, 3])):
            level = group_levels([with_parameters(made, protocol__discard=discard)])[0]
            self.assertEqual(made.scans.cycle[level.scans[0]].tolist(), cycles)
        self.assertFalse(group_levels([with_parameters(made, protocol__discard="4")]))

    def test_without_levels_there_are_no_values(self):
        self.assertEqual(by_replica([], top_force).shape, (0, 0))
        self.assertEqual(scaling_points([]), [])

    def test_tolerance(self):
        made = recording(cycles=2, levels=3)
        steps = np.array([10, 20, 30, 0, 10, 20]) / 1e3
        for way, expected in ((0.04e-3, steps), (0.06e-3, np.add.outer(steps, [-0.06e-3, 0.06e-3]).ravel())):
            moved = changed(made, plate_z=made.scans.plate_z + np.where(made.scans.cycle == 0, way, -way))
            np.testing.assert_allclose([level.displacement for level in group_levels([moved])], expected, atol=1e-12)
        self.assertEqual(len(group_levels([recording(cycles=2, levels=1000)])), 2000)  # 0.03 mm apart, recorded in motion
        unknown = recording(levels=2)
        unknown.scans.plate_z[0] = NAN
        self.assertEqual(len(group_levels([unknown])), 3)

    def test_cycles_are_averaged_first(self):
        a, b = recording(cycles=2, levels=1), recording(cycles=2, levels=1)
        means = level_means(group_levels([with_force(a, [1, 0, 3, 0]), with_force(b, [4, 0, 8, 0])]), top_force)
        self.assertEqual((means[0].mean.value, means[0].mean.standard_error), (4, 2))  # of 2 and 6

    def test_a_stopped_replica_counts_up_to_its_last_level(self):
        made = recording(levels=2)
        means = level_means(group_levels([made, stopped(made, 1)]), top_force)
        self.assertEqual([mean.mean.count for mean in means], [2, 1, 1, 1])
        self.assertEqual(means[1].mean.value, 15)

    def test_matches(self):
        made = recording(levels=4)
        shifted = changed(made, plate_z=made.scans.plate_z - 0.09e-3)
        matches = match_levels(group_levels([shifted]), group_levels([made]))
        self.assertEqual([(match.below, match.above) for match in matches], [(k, k) for k in range(8)])

    def test_interpolation(self):
        def displacement(phase):
            return lambda one: np.where(one.scans.phase == phase, one.displacement, NAN)

        dense, seven = group_levels([recording(levels=1000)]), group_levels([recording(levels=7)])
        at = at_reference(by_replica(dense, displacement(0)), match_levels(dense, seven))
        np.testing.assert_allclose(at[0, :7], 30e-3 * np.arange(1, 8) / 7, atol=1e-9)
        coarse, fine = group_levels([recording(levels=2)]), group_levels([recording(levels=4)])
        matches = match_levels(coarse, fine)
        self.assertEqual([match.found() for match in matches], [False, True, True, True, True, True, True, False])  # never beyond
        np.testing.assert_allclose(at_reference(by_replica(coarse, displacement(0)), matches)[0, 2:4], [22.5e-3, 30e-3])
        self.assertAlmostEqual(at_reference(by_replica(coarse, displacement(1)), matches)[0, 5], 7.5e-3, 12)


class TopForce(unittest.TestCase):
    def ratio(self, a, b):
        return top_force_ratio(group_levels([a]), [a], group_levels([b]), [b])

    def error(self, a, b, touch=None):
        levels = group_levels([a]), group_levels([b])
        return top_force_error(*levels, match_levels(*levels), [Omission()], touch)

    def test_ratio_at_maximum_compression(self):
        ratio = self.ratio(recording(top=6.45, hysteresis=0.3), recording(top=15.0))
        self.assertAlmostEqual(ratio.Rtop.value, 0.43, 12)
        self.assertAlmostEqual(ratio.displacement, 30e-3, 12)
        two = recording(cycles=2, top=10.0)
        two = with_force(two, two.scans.top_force * np.where(two.scans.cycle == 0, 0.6, 0.8))
        self.assertAlmostEqual(self.ratio(two, recording(top=10.0)).Rtop.value, 0.7, 12)

    def test_a_turning_point_counts_as_either_phase(self):
        made = recording(top=10.0)
        unload = changed(made, phase=np.where(made.displacement > 29.9e-3, 1, made.scans.phase))
        self.assertAlmostEqual(self.ratio(recording(top=15.0), unload).Rtop.value, 1.5, 12)

    def test_a_shorter_simulation_is_compared_at_its_end(self):
        made = recording()
        cut = rows(made, made.displacement < 21.1e-3)
        self.assertAlmostEqual(self.ratio(cut, made).displacement, 21e-3, 12)
        self.assertAlmostEqual(self.ratio(cut, made).Rtop.value, 1, 12)
        self.assertFalse(self.ratio(stopped(cut, None), made).Rtop.available())

    def test_errors(self):
        made = recording()
        raised = with_force(made, made.scans.top_force + np.where(made.scans.phase == 0, 0.5, -1.5))
        self.assertAlmostEqual(self.error(raised, made).by_omission[0], math.sqrt((0.25 + 2.25) / 2), 12)
        seven, ten = (with_force(one, 300 * one.displacement) for one in (recording(levels=7), recording(levels=10)))
        straight = self.error(seven, ten)
        self.assertAlmostEqual(straight.by_omission[0], 0, 12)
        self.assertEqual(straight.levels_used, 9 + 9)  # loading from 30/7 = 4.3 mm on, unloading up to 30 * 6/7 = 25.7 mm
        a, b = recording(top=12.0), recording(top=10.0, touch=9.1e-3)
        self.assertEqual(self.error(a, b).levels_used, 20)
        self.assertEqual(self.error(a, b, 0.0).levels_used, 7 + 6)  # 12 .. 30 mm and 27 .. 12 mm


class Laws(unittest.TestCase):
    def points(self, forces):
        return [ScalingPoint(Phase.load, 0.0, Estimate(force), Estimate(x)) for x, force in forces.items()]

    def test_scaling(self):
        points = scaling_points(group_levels([recording(cycles=2)]))  # F = 150 <Z><phi><b><f> in both phases
        self.assertEqual(len(points), 20)
        for phase in Phase:
            fit = fit_scaling(points, phase)
            np.testing.assert_allclose([fit.coefficient, fit.r_squared, fit.curvature, fit.points], [150, 1, 0, 10], atol=1e-9)
        unknown = recording()
        unknown.scans.packing_fraction[3] = NAN
        self.assertEqual(len(scaling_points(group_levels([unknown]))), 19)
        self.assertEqual(fit_scaling([]).points, 0)

    def test_fit(self):
        for linear, square, curvature in ((3, 0.25, 0.25 * 4 / (3 + 0.25 * 4)), (0, 1, 1), (3, -0.25, -0.5)):
            points = self.points({x: linear * x + square * x * x for x in (1.0, 2.0, 3.0, 4.0)})
            self.assertAlmostEqual(fit_scaling(points).curvature, curvature, 12)
        fit = fit_scaling(self.points({1.0: 1.0, 2.0: 3.0}))
        np.testing.assert_allclose([fit.coefficient, fit.r_squared], [7 / 5, 1 - (0.16 + 0.04) / 2])

    def test_range_of_a_law(self):
        def pressed(model, *overlaps):
            return changed(rows(recording(model=model, levels=2), slice(2)), max_overlap=np.array(overlaps))

        within, late, early = (pressed("hyperelastic_sphere", *two) for two in ((0.1, 0.19), (0.1, 0.27), (0.21, 0.25)))
        self.assertIsNone(beyond_law([within]))
        self.assertAlmostEqual(beyond_law([within, late]).displacement, late.displacement[1], 12)
        self.assertAlmostEqual(beyond_law([late, early]).displacement, early.displacement[0], 12)
        self.assertEqual((beyond_law([late, early]).tested, beyond_law([late, early]).max_overlap), (0.2, 0.27))
        self.assertTrue(beyond_law([pressed("elastic_sphere", 0.05, 0.12)]))
        for other in (pressed("independent", 0.2, 0.3), pressed("elastic_sphere", NAN, NAN)):
            self.assertIsNone(beyond_law([other]))

    def test_stress_and_strain(self):
        self.assertAlmostEqual(mean_stress(np.diag([1.0, 1, 4])), 2, 14)
        self.assertAlmostEqual(deviatoric_stress(np.diag([1.0, 1, 4])), 3, 14)
        along = np.array([0, 0, 1 - math.exp(-0.3), 0, 0, 0])
        self.assertAlmostEqual(volume_strain(along), 1 - math.exp(-0.3), 14)
        self.assertAlmostEqual(deviatoric_strain(along), 0.2, 14)
        shear = np.zeros((3, 3))
        shear[0, 2] = shear[2, 0] = -5
        self.assertAlmostEqual(deviatoric_stress(shear), 5 * math.sqrt(3), 13)
        self.assertAlmostEqual(deviatoric_strain(np.array([0, 0, 0, 0, 1e-4, 0])), 1e-4 / math.sqrt(3), 11)
        self.assertAlmostEqual(volume_strain(np.array([0, 0, 0, 0.3, 0.1, -0.2])), 0, 14)
        twisted = 3 * np.eye(3)
        twisted[0, 1], twisted[1, 0] = 1, -1  # the antisymmetric part is ignored
        self.assertAlmostEqual(deviatoric_stress(twisted), 0, 14)

    def test_strongest_scan(self):
        cell = synthetic.cell("mc_dem")
        self.assertEqual((strongest_scan(recording(levels=3)), strongest_scan(cell)), (2, 1))
        cell.scans.stress[3] *= 2
        self.assertEqual(strongest_scan(cell), 3)
        cell.scans.stress[:] = NAN
        self.assertIsNone(strongest_scan(cell))


class Programmes(unittest.TestCase):
    def held(self, forces, later):
        made = synthetic.scans(len(forces), time=later + np.arange(len(forces)), plate_z=np.full(len(forces), 0.09))
        return with_force(replace(recording(), parameters={"programme.1.stage": "move"}, plate_start=0.1, scans=made), forces)

    def test_means_are_over_the_replicas_that_have_the_scan(self):
        scans = mean_scans([self.held([3, 2, 1.5], 0), self.held([5], 0.5)])
        self.assertEqual([scan.top_force.value for scan in scans], [4, 2, 1.5])
        self.assertEqual((scans[0].top_force.standard_error, scans[0].time.value), (1, 0.25))
        self.assertTrue(math.isnan(scans[2].top_force.standard_error))
        self.assertAlmostEqual(scans[1].displacement.value, 0.01, 14)

    def test_are_distinguished_from_strokes(self):
        held = self.held([1, 1], 0)
        both = [Setting("held", [held]), Setting("stroke", [recording()])]
        self.assertEqual([with_programme(both, which)[0].label for which in (True, False)], ["held", "stroke"])
        with self.assertRaisesRegex(InputError, r"got one of a \[\[programme\]\]"):
            group_levels([held])

    def test_cells(self):
        replicas = [synthetic.cell("mc_dem", 1), synthetic.cell("mc_dem", 2, 3)]
        self.assertTrue(are_cells(replicas) and has_hold(replicas) and not are_cells([recording()]))
        scans, gone = mean_scans(replicas), 1 - 0.98**3
        np.testing.assert_allclose([scans[2].p.value, scans[2].p.standard_error, scans[2].q.value, scans[1].volume_strain.value],
                                   [2e5 * gone, 1e5 * gone, 2e4 * gone * math.sqrt(3), gone])
        self.assertAlmostEqual(scans[1].q.value, 0, 9)
        self.assertEqual(scans[2].strain[4].value, 0.1)


if __name__ == "__main__":
    unittest.main()
