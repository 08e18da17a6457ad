"""A planted difference is located at its bins; replicates without a difference have none. location_test.py"""
import unittest

import numpy as np
import synthetic_evidence
from synthetic_evidence import GRID

from mcdem.diagnosis.decision import Limits
from mcdem.diagnosis.location import locate
from mcdem.observe.observables import observables

PLANTED = 8 * 2 + 4 + 1  # the third observable, unloading, second displacement


class Case(synthetic_evidence.Case):
    def __init__(self, seed=1):
        super().__init__(effects=(), known=4, seed=seed)
        self.modulus = self.parameters[0].linear

    def locate(self, gap):
        return locate(self.space, self.data, self.null, gap, GRID, Limits(false_alarm=0.05))

    def gap_of(self, bins):
        gap = np.full(len(self.data.mean), np.nan)
        gap[:self.world.known] = 0
        for bin, value in bins.items():
            gap[bin] = value
        return gap


class Locations(unittest.TestCase):
    def test_planted_bins_and_their_range_are_found(self):
        world = Case()
        gap = world.gap_of({PLANTED: 8, PLANTED + 1: 10})
        entry, = world.locate(gap).entries
        known = observables()[2]
        self.assertEqual((entry.observable, entry.phase, entry.region, entry.force_class), (known.name, "unload", known.region, None))
        half = 0.5 * (GRID.displacement[1] - GRID.displacement[0])
        np.testing.assert_allclose(entry.displacement_mm, 1e3 * np.array([GRID.displacement[1] - half, GRID.displacement[2] + half]))
        sigma, shift = world.space.sigma[PLANTED + 1], world.space.fit_nuisances(gap)[0]
        self.assertAlmostEqual(entry.z_score, 10 / sigma, 9)
        self.assertAlmostEqual(entry.z_score_refitted, (10 - shift * world.modulus[PLANTED + 1]) / sigma, 9)
        self.assertEqual(entry.difference, 10)

    def test_ranges_do_not_exceed_the_stroke(self):
        world = Case()
        entry, = world.locate(world.gap_of({3: -9})).entries
        self.assertEqual(entry.displacement_mm[1], 1e3 * GRID.stroke)
        self.assertLess(entry.z_score, 0)

    def test_the_largest_is_first(self):
        world = Case()
        # The third one is not adjacent to the first: the bin between them has no difference.
        entries = world.locate(world.gap_of({0: 8, 8: -12, 2: 9})).entries
        self.assertEqual(len(entries), 3)
        self.assertEqual(entries[0].observable, observables()[1].name)
        sizes = [abs(entry.z_score_refitted) for entry in entries]
        self.assertEqual(sizes, sorted(sizes, reverse=True))

    def test_loading_and_unloading_are_separate(self):
        world = Case()
        entries = world.locate(world.gap_of({3: 9, 4: 10})).entries  # neighbours in the list of bins
        self.assertEqual([entry.phase for entry in entries], ["unload", "load"])

    def test_all_bins_are_listed(self):
        world = Case()
        found = world.locate(world.data.gap)
        self.assertEqual(len(found.bins), 32)
        bin = found.bins[PLANTED]
        self.assertEqual((bin.observable, bin.phase, bin.displacement_mm), (observables()[2].name, "unload", 1e3 * GRID.displacement[1]))
        self.assertAlmostEqual(bin.z_score, world.data.gap[PLANTED] / world.space.sigma[PLANTED], 12)

    def test_replicates_have_no_significant_bins(self):
        alarms, draws = 0, 200
        for seed in range(10, 10 + draws):
            world = Case(seed)
            alarms += len(world.locate(world.data.gap + world.world.normal() * world.modulus).entries) > 0
        self.assertLessEqual(alarms, 0.12 * draws)  # 5 % +- 1.5 %, and as much again for thresholds from 32 replicates
        self.assertGreaterEqual(alarms, 1)


if __name__ == "__main__":
    unittest.main()
