"""Recordings as vectors: local linear regression through the scans near a bin, grids, holds. observation_test.py"""
import math
import unittest
from dataclasses import replace

import numpy as np

from mcdem._engine import programme_parameters
from scans_by_hand import SOFT, Lattice
from synthetic import scans

from mcdem.observe.grid import Grid, HoldScans, bins_of, grid_of
from mcdem.observe.observables import index_of, observables
from mcdem.observe.observation import observe, scan_observables
from mcdem.results import NO_CONTACTS, Box, Contacts, Phase, Recording, Wall

START, STROKE = 0.15, 0.03  # [m]
GRID = Grid([0.01, 0.02], 0.004, STROKE)
UP = Phase.unload


def recording_of(rows, parameters=()):
    """Of rows (displacement, log of the top force, phase, cycle), the last two may be missing."""
    rows = [(*row, *(Phase.load, 0)[len(row) - 2:]) for row in rows]
    displacement, force, phase, cycle = (np.array(column) for column in zip(*rows)) if rows else np.zeros((4, 0))
    wall_force = np.zeros((len(rows), 6, 3))
    wall_force[:, Wall.plate, 2] = np.exp(force)
    made = scans(len(rows), plate_z=START - displacement, wall_force=wall_force, phase=phase.astype(int), cycle=cycle.astype(int))
    return Recording("plate", dict(parameters), Box(0.1, 0.1), START, np.zeros(0), made)


def top_forces(recording, discard=0):
    """Top force while loading at both displacements, then while unloading."""
    values = observe(recording, GRID, SOFT, discard)
    assert len(values) == len(bins_of(GRID)) and np.isnan(values[4:]).all()
    return values[:4]


class LocalLines(unittest.TestCase):
    def test_are_exact_for_linear_data(self):
        for shift in (0, 0.3e-3, 0.7e-3, 1.1e-3):
            places = np.arange(shift, STROKE, 1.3e-3)
            rows = [row for d in places for row in ((d, -3 + 150 * d), (d, -5 + 120 * d, UP))]
            np.testing.assert_allclose(top_forces(recording_of(rows)), (-1.5, 0, -3.8, -2.6), atol=1e-9)

    def test_have_triangular_weights(self):
        """Scans at -3/4, 0 and 1/2 of the width have the weights 1/4, 1, 1/2. The line through (0.8, 1, 1.5) was computed by hand."""
        n, x, xx, y, xy = 1.75, -0.1875 + 0.25, 0.140625 + 0.125, 0.2 + 1 + 0.75, -0.15 + 0.375
        found = top_forces(recording_of([(0.007, 0.8), (0.010, 1.0), (0.012, 1.5)]))[0]
        self.assertAlmostEqual(found, (xx * y - x * xy) / (n * xx - x * x), 9)

    def test_scans_beyond_the_width_do_not_count(self):
        inside = [(0.009, 1), (0.011, 2)]
        outside = [*inside, (0.0141, 9), (0.0059, 9)]
        self.assertEqual(top_forces(recording_of(outside))[0], top_forces(recording_of(inside))[0])
        self.assertNotEqual(top_forces(recording_of([*outside, (0.0139, 9)]))[0], top_forces(recording_of(inside))[0])

    def test_a_single_scan_counts_if_it_is_near(self):
        self.assertAlmostEqual(top_forces(recording_of([(0.0103, 1.7)]))[0], 1.7, 12)
        for rows in ([(0.011, 1.7)], []):
            self.assertTrue(math.isnan(top_forces(recording_of(rows))[0]))

    def test_scans_without_a_force_do_not_count(self):
        self.assertAlmostEqual(top_forces(recording_of([(0.009, 1), (0.010, -math.inf), (0.011, 1)]))[0], 1, 12)

    def test_cycles_are_averaged_without_the_discarded_ones(self):
        rows = [(d, 100 * d + (cycle or 9), phase, cycle) for cycle in range(3) for d in np.arange(0.0005, STROKE, 0.001) for phase in Phase]
        recording = recording_of(rows)
        np.testing.assert_allclose(top_forces(recording, 1)[[1, 3]], 2 + 1.5, atol=1e-9)
        self.assertAlmostEqual(top_forces(recording)[1], 2 + 4, 9)


class Bins(unittest.TestCase):
    def test_are_ordered_by_observable_then_phase_then_displacement(self):
        bins = bins_of(GRID)
        self.assertEqual(len(bins), 4 * len(observables()))
        for k, bin in enumerate(bins):
            self.assertEqual((bin.observable, bin.phase, bin.displacement), (k // 4, Phase.load if k % 4 < 2 else UP, GRID.displacement[k % 2]))

    def test_have_the_observables_of_their_scans(self):
        lattice = Lattice(5)
        one = lattice.contacts
        twice = Contacts(one.grain, one.partner, one.point, 2 * one.force, one.overlap)
        recording = lattice.recording(2, phase=np.array([Phase.load, UP]), contacts=(one, twice), plate_z=np.full(2, lattice.plate_z))
        recording = Recording("lattice", {}, recording.box, lattice.plate_z + 0.01, recording.diameter, recording.scans)
        found = observe(recording, GRID, SOFT).reshape(-1, 4)
        wanted = scan_observables(recording, [0, 1], SOFT).T
        np.testing.assert_allclose(found[:, [0, 2]], wanted, rtol=1e-9, atol=1e-9)
        self.assertTrue(np.isnan(found[:, [1, 3]]).all())


class Grids(unittest.TestCase):
    def test_follow_the_stroke_and_the_scans(self):
        def strokes(count, cycles):
            return recording_of([row for cycle in range(cycles) for k in range(1, count + 1)
                                 for row in ((STROKE * k / count, 0, Phase.load, cycle), (STROKE * (1 - k / count), 0, UP, cycle))])

        for cycles in (1, 3):
            fine = grid_of(strokes(50, cycles))
            self.assertAlmostEqual(fine.stroke, STROKE, 12)
            np.testing.assert_allclose(fine.displacement, np.multiply((0.42, 0.61, 0.80, 0.98), STROKE), rtol=1e-12)
            self.assertAlmostEqual(fine.width, 0.12 * STROKE, 12)
            self.assertAlmostEqual(grid_of(strokes(8, cycles)).width, 1.6 / 8 * STROKE, 12)  # three scans wide


    def test_without_contact_forces_are_at_the_frames_with_grains(self):
        rows = [(STROKE * k / 20, 0) for k in range(21)] + [(STROKE * (1 - k / 20), 0, UP) for k in range(1, 21)]
        recording, there = recording_of(rows), np.zeros((1, 3))

        def seen(*frames, contacts=NO_CONTACTS):
            position = tuple(there if k in (0, *frames) else np.zeros((0, 3)) for k in range(len(rows)))
            found = replace(recording, scans=replace(recording.scans, position=position, contacts=(contacts,) * len(rows)))
            return np.array(grid_of(found).displacement) / STROKE

        parts = (0.42, 0.61, 0.80, 0.98)
        for frames, wanted in (((), parts), ((20,), (0.42, 0.61, 0.80, 1)), ((10, 20), (0.5, 0.61, 0.80, 1)), ((5, 10, 15, 20), (0.25, 0.5, 0.75, 1)),
                               ((1, 2, 20, 30), (0.42, 0.61, 0.80, 1)), ((4, 7, 9, 12, 17, 20), (0.45, 0.6, 0.85, 1)), (range(41), parts)):
            np.testing.assert_allclose(seen(*frames), wanted, rtol=1e-9, err_msg=str(frames))
        np.testing.assert_allclose(seen(5, 10, contacts=Lattice(2).contacts), parts, rtol=1e-9)


def programme(*stages):
    parameters, problems = programme_parameters(stages, "by hand", "box", (0.1, 0.1), START)
    assert not problems, problems
    return parameters


def held(keep, scans_at="3"):
    """Down in three scans, a hold at 20 mm, up again."""
    down = {"scan_at": scans_at} if "[" in scans_at else {"scans": scans_at}
    stages = ({"position": f"{START - 0.02}", **down}, {"stage": '"hold"', "keep": f'"{keep}"', "time": "2", "scans": "2"},
              {"position": f"{START}", "scans": "3"})
    rows = [(0, -9), (0.01, 0), (0.015, 0.5), (0.02, 1), (0.0205, 0.9), (0.021, 0.7), (0.019, 0, UP), (0.01, -1, UP), (0, -2, UP)]
    return rows, programme(*stages)


def values_of(recording, grid, name):
    """Bins of one observable: loading at all displacements, then unloading."""
    return observe(recording, grid, SOFT).reshape(len(observables()), -1)[index_of(name)]


class Programmes(unittest.TestCase):
    def test_a_hold_of_the_position_shows_relaxation_in_its_bin(self):
        recording = recording_of(*held("position"))
        grid = grid_of(recording)
        self.assertEqual(grid.holds, [HoldScans(3, 4, 5, "position", Phase.load, grid.holds[0].displacement)])
        self.assertAlmostEqual(grid.holds[0].displacement, 0.02, 12)
        relaxation = values_of(recording, grid, "relaxation")
        self.assertEqual(np.flatnonzero(np.isfinite(relaxation)).tolist(), [3])  # 98 % of the stroke, loading
        self.assertAlmostEqual(relaxation[3], 1 - 0.7, 12)
        for name in ("creep", "displacement"):
            self.assertFalse(np.isfinite(values_of(recording, grid, name)).any())

    def test_a_hold_of_the_force_shows_creep(self):
        recording = recording_of(*held("force"))
        self.assertAlmostEqual(values_of(recording, grid_of(recording), "creep")[3], 0.001 / 0.021, 12)

    def test_scans_of_a_hold_are_not_part_of_the_stroke(self):
        recording = recording_of(*held("position"))
        grid = grid_of(recording)
        before = values_of(recording, grid, "top_force")
        recording.scans.wall_force[4:6] *= 7
        np.testing.assert_array_equal(values_of(recording, grid, "top_force"), before)

    def test_a_hold_without_a_scan_before_it_begins_with_its_first(self):
        rows, parameters = held("position", f"[{START - 0.01}]")
        grid = grid_of(recording_of([rows[k] for k in (0, 1, 4, 5, 6, 7, 8)], parameters))
        self.assertEqual([(hold.begin, hold.end) for hold in grid.holds], [(2, 3)])

    def test_displacements_are_compared_if_forces_are_prescribed(self):
        """At the forces that loading has at the displacements of the grid."""
        places = np.arange(0, STROKE + 1e-9, STROKE / 30)
        with np.errstate(divide="ignore"):
            rows = [row for d in places for row in ((d, np.log(100 * d)), (d, np.log(80 * d), UP))]
        recording = recording_of(rows, programme({"force": "3", "scans": str(len(rows) - 1)}))
        grid = grid_of(recording)
        np.testing.assert_allclose(grid.force, np.multiply(grid.displacement, 100), rtol=1e-9)
        unseen = programme({"force": "3", "scans": "0"}, {"position": "0.13", "scans": str(len(rows) - 1)})
        self.assertEqual(grid_of(recording_of(rows, unseen)).force, grid.force, "also if the stage with the force has no scans")
        way = values_of(recording, grid, "displacement")
        self.assertAlmostEqual(way[1], grid.displacement[1] / grid.stroke, 9)
        self.assertAlmostEqual(way[5], 1.25 * grid.displacement[1] / grid.stroke, 9)
        self.assertFalse(np.isfinite(values_of(recording, grid, "top_force")).any())


if __name__ == "__main__":
    unittest.main()
