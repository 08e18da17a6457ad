"""Trials: the same results alone and together, new and from the store; different trials have different names. trials_test.py"""
import math
import unittest
from dataclasses import asdict, replace

import numpy as np
from small_trials import MEASUREMENT, Small, packing, scene

from mcdem import _engine as engine
from mcdem.diagnosis.model import Model
from mcdem.diagnosis.trials import GRAINS_OF_A_PART, Observer, observation_name, parts_of, simulation_name
from mcdem.errors import InputError
from mcdem.experiment.instrument import Instrument
from mcdem.observe.contact_residuals import GrainsAlone
from mcdem.observe.observation import observe


class Trials(unittest.TestCase):
    def setUp(self):
        self.small = Small(self)
        self.calls = 0

    def count(self, fraction):
        """As progress: it is not called if nothing is simulated."""
        self.calls += 1
        assert 0 <= fraction <= 1

    def calls_of(self, *trials, small=None, **how):
        self.calls = 0
        rows = (small or self.small).observe(*trials, progress=self.count, **how)
        return self.calls, rows

    def test_are_the_same_alone_and_together(self):
        tilted = self.small.model.with_keys({"effects.plate_tilt_x": 0.01})
        trials = [self.small.trial(1), self.small.trial(2, tilted), self.small.trial(3, self.small.model.read_with(force_bias=0.2))]
        together = self.small.observe(*trials)
        self.assertTrue(np.isfinite(together[0, :2]).all())
        self.assertNotEqual(together[0, 1], together[1, 1])
        for trial, row in zip(trials, together):
            np.testing.assert_array_equal(Small(self).observe(trial)[0], row)

    def test_in_the_store_are_not_simulated(self):
        calls, fresh = self.calls_of(self.small.trial(1))
        self.assertGreater(calls, 0)
        calls, kept = self.calls_of(self.small.trial(1))
        self.assertEqual(calls, 0)
        np.testing.assert_array_equal(kept, fresh)
        calls, more = self.calls_of(self.small.trial(2), self.small.trial(1))
        self.assertGreater(calls, 0)
        np.testing.assert_array_equal(more[1], fresh[0])

    def test_with_another_instrument_share_the_simulation(self):
        calls, _ = self.calls_of(self.small.trial(1))
        fresh = Small(self)
        shifted = fresh.trial(1, fresh.model.read_with(strain_offset=1e-3))
        both, rows = self.calls_of(fresh.trial(1), shifted, small=fresh)
        self.assertFalse((rows[0] == rows[1]).all())
        self.assertEqual((both, fresh.files()), (calls, 2))

    def test_continue_after_an_interruption(self):
        def interrupt(fraction):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            self.small.observe(self.small.trial(1), progress=interrupt)
        self.assertEqual(self.small.files(), 0)
        fresh = Small(self)
        np.testing.assert_array_equal(self.small.observe(self.small.trial(1)), fresh.observe(fresh.trial(1)))

    def test_recordings_are_kept_where_they_are_wanted(self):
        trial = self.small.trial(1)
        before = self.small.observe(trial)
        with self.assertRaises(InputError):
            self.small.observer().recordings([trial])
        kept = replace(trial, recorded=True)
        row = self.small.observe(kept)[0]
        np.testing.assert_array_equal(row, before[0])
        recording, = self.small.observer().recordings([trial])
        self.assertEqual(len(recording.diameter), len(packing()))
        self.assertNotEqual(recording.diameter[0], packing().diameter[0])  # as measured
        seen = observe(recording, self.small.comparison.grid, self.small.comparison.material)
        np.testing.assert_allclose(seen, row, atol=1e-4)  # positions are stored as floats: 1e-8 m
        self.assertEqual(self.calls_of(kept)[0], 0)

    def test_end_when_no_bin_needs_more_scans(self):
        """The scan at 3.3 mm while unloading is the first that no bin needs."""
        narrow = replace(self.small.comparison, grid=replace(self.small.comparison.grid, width=0.003))
        ended, row = self.calls_of(self.small.trial(1), comparison=narrow)
        fresh = Small(self)
        whole, whole_row = self.calls_of(replace(fresh.trial(1), recorded=True), small=fresh, comparison=narrow)
        self.assertEqual(len(fresh.observer(narrow).recordings([fresh.trial(1)])[0].scans), 6)
        self.assertLess(ended, 0.95 * whole)
        np.testing.assert_array_equal(row, whole_row)

    def test_that_fail_are_unknown_and_have_a_cause(self):
        causes = []
        fails = self.small.trial(1, self.small.model.with_keys({"numerics.overlap_limit": 1e-4}))
        rows = self.small.observe(fails, self.small.trial(2), failed=lambda trial, cause: causes.append((trial, cause)))
        self.assertTrue(np.isnan(rows[0]).all() and np.isfinite(rows[1, 0]))
        (trial, cause), = causes
        self.assertEqual(trial, 0)
        self.assertIn("overlap", cause)

    def test_in_parts_are_the_same(self):
        trials = [self.small.trial(1), self.small.trial(2), self.small.trial(1)]
        enough = GRAINS_OF_A_PART // len(packing()) + 2  # one more than fits into a part
        parts = parts_of([self.small.trial(seed) for seed in range(enough)])
        self.assertEqual((len(parts), sum(map(len, parts))), (2, enough))
        few, = parts_of(trials)
        self.assertFalse(self.small.observer().has(few))
        self.small.observe(*few)
        self.assertTrue(self.small.observer().has(trials))
        self.assertFalse(self.small.observer().has([replace(trials[0], recorded=True)]))
        self.assertFalse(Observer("another", self.small.store, self.small.comparison).has(trials))
        self.assertEqual(self.small.files(), 2)
        fresh = Small(self)
        np.testing.assert_array_equal(self.small.observe(*trials), fresh.observe(*trials))


class Names(unittest.TestCase):
    """What is not the same has another name, so that no stored result is taken for another."""

    def setUp(self):
        self.small = Small(self)
        self.trial = self.small.trial(1)
        self.name = simulation_name(self.trial, "device")

    def test_are_reproducible(self):
        again = Model(scene(), {}, Instrument(MEASUREMENT), 0.0215)
        self.assertEqual(simulation_name(replace(self.trial, model=again), "device"), self.name)
        self.assertEqual(simulation_name(replace(self.trial, model=self.trial.model.read_with(force_bias=0.1)), "device"), self.name)

    def test_of_simulations_differ(self):
        diameter, device = packing().diameter, self.small.observer().device
        position = np.array(next(iter(engine.simulate_starts(device, [(scene(protocol__scan_at_start=True), packing(), 0, 0, 1)], scans=1)))
                            .positions(0))
        names = {simulation_name(trial, "device") for trial in (
            self.trial, replace(self.trial, seed=2), replace(self.trial, seed=2**64 - 2), replace(self.trial, seed=2**64 - 1),
            replace(self.trial, jitter=2e-5), replace(self.trial, diameter_jitter=2e-5), replace(self.trial, jitter=0, diameter_jitter=2e-5),
            *(replace(self.trial, packing=engine.Packing(at, size)) for at, size in (
                (position, diameter), (position + 1e-12 * (np.arange(18) == 3)[:, None], diameter), (position, diameter + 1e-12 * (np.arange(18) == 3)))))}
        self.assertEqual(len(names), 10)
        self.assertNotEqual(simulation_name(self.trial, "another"), self.name)

    def test_differ_for_every_key_of_a_replica(self):
        tried = 0
        for key, value in self.trial.model.scene._values.items():
            # Names say nothing of what the packing already is; radius and height are in the sizes of the box.
            if key.startswith("packing.") or value is None or key in ("container.shape", "container.radius", "container.size_x",
                                                                      "container.size_y", "box.size_x", "box.size_y"):  # test below
                continue
            words = {"contact.model": "mc_dem", "contact.friction_law": "mindlin", "numerics.precision": "double"}
            other = words[key] if isinstance(value, str) else ((not value) if isinstance(value, bool) else value + 1 if isinstance(value, int) else value + 1e-9)
            changed = replace(self.trial, model=self.trial.model.with_keys({key: other}))
            if key == "numerics.precision":
                changed = replace(self.trial, model=Model(scene(numerics__precision="double"), {}, Instrument(MEASUREMENT), 0.0215))
            self.assertNotEqual(simulation_name(changed, "device"), self.name, key)
            tried += 1
        self.assertGreater(tried, 40)
        wider = Model(scene()._with_box("box", 0.061, 0.06), {}, Instrument(MEASUREMENT), 0.0215)
        self.assertNotEqual(simulation_name(replace(self.trial, model=wider), "device"), self.name)

    def test_of_observations_differ(self):
        comparison, names = self.small.comparison, set()
        grid, material = comparison.grid, comparison.material
        comparisons = [comparison, replace(comparison, discard=1), replace(comparison, grid=replace(grid, width=grid.width + 1e-9)),
                       replace(comparison, grid=replace(grid, displacement=[grid.displacement[0], grid.displacement[1] + 1e-9])),
                       *(replace(comparison, material=replace(material, **{name: math.nextafter(value, math.inf)}))
                         for name, value in asdict(material).items() if name != "grains_alone"),
                       *(replace(comparison, material=replace(material, grains_alone=alone))
                         for alone in (GrainsAlone(1e-4), GrainsAlone(1e-4, listed=True), GrainsAlone(2e-4)))]
        instrument = self.trial.model.instrument
        instruments = [{name: math.nextafter(value, math.inf)} for name, value in vars(instrument).items() if name != "stated"]
        instruments += [{"stated": replace(MEASUREMENT, **{name: math.nextafter(value, math.inf)})} for name, value in vars(MEASUREMENT).items()]
        trials = [replace(self.trial, model=self.trial.model.read_with(**changes)) for changes in instruments]
        names = {observation_name(self.name, one, self.trial) for one in comparisons} | {observation_name("other", comparison, self.trial)}
        names |= {observation_name(self.name, comparison, trial) for trial in trials}
        self.assertEqual(len(names), len(comparisons) + 1 + len(trials))


    def test_of_equal_comparisons_are_equal(self):
        """A grid that was read from a file has real numbers where whole ones were set."""
        comparison = self.small.comparison
        read = replace(comparison, discard=comparison.discard, grid=replace(comparison.grid, force_width=0, displacement=list(
            np.array(comparison.grid.displacement))))
        self.assertEqual(observation_name(self.name, read, self.trial), observation_name(self.name, comparison, self.trial))


class Store(unittest.TestCase):
    def setUp(self):
        self.small = Small(self)
        self.store = self.small.store

    def test_finds_what_it_keeps(self):
        kept = np.array([1 / 3, math.nan, -math.inf, 1e-300])
        self.assertIsNone(self.store.find("name"))
        self.store.keep("name", kept)
        np.testing.assert_array_equal(self.store.find("name"), kept)
        self.assertIsNone(self.store.find("another"))
        self.store.keep("name", np.array([7.0, 8.0]))
        np.testing.assert_array_equal(self.store.find("name"), [7, 8])

    def test_ignores_damaged_files(self):
        self.store.keep("name", np.array([1.0, 2.0, 3.0]))
        file = self.small.folder / "name.obs"
        whole = file.read_bytes()
        damaged = [whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1:] for at in range(0, len(whole), 5)]
        for content in (*damaged, *(whole[:length] for length in (0, 10, len(whole) - 8, len(whole) - 3))):
            file.write_bytes(content)
            self.assertIsNone(self.store.find("name"))
        file.write_bytes(whole)
        self.assertIsNotNone(self.store.find("name"))

    def test_a_damaged_recording_is_missing(self):
        self.small.observe(replace(self.small.trial(1), recorded=True))
        name, = self.small.observer().names([self.small.trial(1)])
        self.assertTrue(self.store.has_recording(name))
        (self.small.folder / f"{name}.h5").write_bytes(b"no longer")
        self.assertFalse(self.store.has_recording(name))
        with self.assertRaises(InputError):
            self.store.recording(name)


if __name__ == "__main__":
    unittest.main()
