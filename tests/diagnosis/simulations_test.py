"""The simulations that a diagnosis asks for: libraries of tiny packings, other protocols, the motion of the plate. simulations_test.py"""
import unittest
from dataclasses import replace

import numpy as np
from small_trials import MEASUREMENT, TEXT, Small, mirrored, packing, scene

from mcdem import _engine as engine
from mcdem.diagnosis.effects import EFFECTS, find_effect, nuisances
from mcdem.diagnosis.model import Model
from mcdem.diagnosis.plan import Packing
from mcdem.diagnosis.plate_motion import neglected_motion
from mcdem.diagnosis.simulations import Simulations
from mcdem.experiment.experiment import Experiment
from mcdem.experiment.instrument import Instrument
from mcdem.observe.contact_residuals import GrainsAlone
from mcdem.observe.grid import bins_of
from mcdem.observe.observables import index_of, observables
from mcdem.results.names import Phase


class Libraries(unittest.TestCase):
    def setUp(self):
        self.small = Small(self)

    def simulations(self, *candidates, **plan):
        effects = [find_effect(name) for name in candidates]
        return Simulations(self.small.plan(**{"candidates": effects, **plan}), self.small.folder, "")

    def test_are_baseline_effects_and_nuisances(self):
        simulations = self.simulations("force_bias", "plate_tilt", nuisances=nuisances(self.small.model, {}))
        rows, plan = simulations.library(), simulations.plan
        self.assertEqual(plan.paired_rows(), [0, 1])
        probes = plan.probes()
        self.assertEqual([one.name for one in probes], ["force_bias", "plate_tilt", "modulus", "strain_offset"])
        self.assertEqual((probes[1].amplitudes, probes[2].amplitudes), ((-0.015, 0.015), (-0.05, 0.05)))
        self.assertEqual(rows.shape, (3 + 4 * 4, len(bins_of(self.small.comparison.grid))))
        np.testing.assert_array_equal(rows[3:7, 0], np.tile(rows[:2, 0], 2), "the plate's force is not a contact force")
        # ln F of the plate increases by one with ln E, except for rearrangements.
        self.assertGreater((rows[13:15, 1] - rows[11:13, 1]).mean(), 0.3 * 2 * 0.05)
        fresh = Small(self)
        np.testing.assert_array_equal(fresh.observe(*(fresh.trial(seed) for seed in (1, 2, 3))), rows[:3])
        tilted = [fresh.trial(seed, self.small.model.with_keys({"effects.plate_tilt_x": tilt})) for tilt in (-0.015, 0.015) for seed in (1, 2)]
        np.testing.assert_array_equal(fresh.observe(*tilted), rows[7:11])

    def test_are_made_of_every_packing(self):
        packings = [Packing(self.small.model, [one]) for one in (packing(), mirrored())]
        simulations = self.simulations("force_bias", packings=packings, replicates=2, pairs=1)
        rows = simulations.library()
        self.assertEqual((simulations.plan.paired_rows(), len(rows)), ([0, 2], 2 * 2 + 2 * 2))  # one of each packing
        self.assertFalse((rows[0] == rows[2]).all())
        np.testing.assert_array_equal(rows[4:6, 0], rows[[0, 2], 0])
        self.assertEqual([trial.seed for trial in simulations.plan.baseline()], [1, 2, 1001, 1002])

    def test_seeds_begin_again_after_the_largest(self):
        plan = self.small.plan(seed=2**64 - 2)
        self.assertEqual([trial.seed for trial in plan.baseline()], [2**64 - 2, 2**64 - 1, 0])
        self.assertEqual(plan.baseline(replicates=0), [])

    def test_the_finer_baseline_has_half_the_error_of_positions(self):
        plan = self.small.plan()
        for coarse, fine in zip(plan.baseline(), plan.baseline(finer=0.5), strict=True):
            self.assertEqual((fine.jitter, fine.model.instrument.stated.position_error), (coarse.jitter / 2, MEASUREMENT.position_error / 2))
            self.assertEqual((fine.seed, fine.diameter_jitter), (coarse.seed, coarse.diameter_jitter))

    def test_failures_have_a_cause_and_belong_to_an_effect(self):
        """The zero of strain is the instrument's: its trials look at the simulations of the baseline."""
        model = self.small.model.with_keys({"numerics.overlap_limit": 1e-4})
        simulations = self.simulations("friction", packings=[Packing(model, [packing()])], nuisances=nuisances(model, {}), replicates=2, pairs=1)
        simulations.library()
        self.assertEqual(set(simulations.causes_of_failure), {"", "friction", "modulus"})
        self.assertTrue(all("overlap" in cause for cause in simulations.causes_of_failure.values()))

    def test_changed_keys_are_those_of_the_scene(self):
        simulations = self.simulations()
        self.assertEqual(simulations.changed_keys([("friction", 0.05), ("force_bias", 0.1)]), ["grains.friction = 0.08"])
        self.assertEqual(simulations.changed_keys([("cross_contact", 1.1234567)]), ["contact.model = mc_dem", "contact.gamma = 1.12"])
        self.assertEqual(simulations.changed_keys([("force_bias", 0.1)]), [])

    def test_numerical_settings_are_lowered(self):
        simulations = self.simulations()
        step = self.small.model["numerics.time_step"]
        self.assertEqual(simulations.setting("time_step"), ("numerics.time_step", "", step, step))
        self.assertEqual(simulations.setting("plate_speed")[:2], ("plate.speed", "m/s"))
        simulations.refine("time_step", 0.5)
        self.assertEqual(simulations.setting("time_step")[2], 0.5 * step)

    def test_parts_together_are_the_library(self):
        simulations = self.simulations("force_bias", recordings=True)
        self.assertEqual((simulations.count_parts(), simulations.missing_parts(""), simulations.missing_parts(simulations.device)), (1, [0], [0]))
        simulations.compute_part(0)
        self.assertEqual((simulations.missing_parts(simulations.device), simulations.missing_parts("another")), ([], [0]))
        simulations.record([], 3, lambda fraction: self.fail("recorded again"))
        simulations.library(lambda fraction: self.fail("simulated again"))


class Origin(unittest.TestCase):
    """What a library depends on."""

    def setUp(self):
        self.small = Small(self)

    def origin(self, model=None, grains=None):
        return Simulations(self.small.plan(packings=[Packing(model or self.small.model, [grains or packing()])]), self.small.folder, "").origin

    def changed(self, model=None, grains=None):
        before, after = self.origin(), self.origin(model, grains)
        return {name for name in before if before[name] != after[name]}

    def test_has_every_key_but_those_of_the_packing(self):
        keys = {key for key in self.small.model.scene._values if not key.startswith("packing.")}
        self.assertEqual(keys - set(self.origin()), set())
        self.assertFalse(any(key.startswith("packing.") for key in self.origin()))
        self.assertEqual(self.changed(self.small.model.with_keys({"grains.friction": 0.9})), {"grains.friction"})
        self.assertEqual(self.changed(self.small.model.with_keys({"packing.seed": 7})), set())

    def test_of_packings_that_are_drawn_has_how_they_are(self):
        """A library of measured packings does not fit an experiment without grains, nor one of packings that are drawn otherwise."""
        def origin(**settings):
            packings = [Packing(Model(scene(**settings), {}, Instrument(MEASUREMENT), 0.0215), [packing()])]
            return Simulations(self.small.plan(packings=packings, drawn=True), self.small.folder, "").origin

        drawn = origin()
        self.assertEqual(drawn["drawn packing.packing_fraction"], "0.52")
        self.assertEqual({name.partition(".")[0] for name in set(drawn) - set(self.origin())}, {"drawn packing"})
        self.assertEqual(origin(packing__seed=7), drawn)
        other = origin(packing__packing_fraction=0.5)
        self.assertEqual({name for name in drawn if drawn[name] != other[name]}, {"drawn packing.packing_fraction"})

    def test_of_grains_alone_says_so(self):
        """A library of an experiment with contact forces has no values of grains alone."""
        def origin(listed):
            material = replace(self.small.comparison.material, grains_alone=GrainsAlone(1e-5, listed))
            return Simulations(self.small.plan(comparison=replace(self.small.comparison, material=material)), self.small.folder, "").origin

        self.assertEqual(set(origin(False)) - set(self.origin()), {"grains without contact forces"})
        self.assertNotEqual(origin(False), origin(True))

    def test_has_instrument_grains_precision_version_and_kernels(self):
        for name, value in vars(MEASUREMENT).items():
            stated = replace(MEASUREMENT, **{name: 2 * value})
            self.assertEqual(self.changed(self.small.model.read_with(stated=stated)), {f"measurement.{name}"})
        self.assertEqual(self.changed(replace(self.small.model, mean_diameter=0.05)), {"mean diameter"})
        self.assertEqual(self.changed(grains=engine.Packing(np.zeros((2, 3)), [0.02, 0.02])), {"grains"})
        double = Model(scene(numerics__precision="double"), {}, Instrument(MEASUREMENT), 0.0215)
        self.assertEqual(self.changed(double), {"numerics.precision"})
        origin = self.origin()
        self.assertEqual((len(origin["kernels"]), origin["program"]), (64, engine.__version__.split()[0]))


class OtherProtocols(unittest.TestCase):
    def setUp(self):
        self.small = Small(self)

    def simulations(self, **changes):
        """1 s down; a fast plate shakes the packing."""
        model = self.small.model.with_keys({"effects.relaxation_time": 0.2, "plate.speed": 0.01, **changes})
        simulations = Simulations(self.small.plan(packings=[Packing(model, [packing()])], candidates=list(EFFECTS)), self.small.folder, "")
        return simulations, simulations.other_protocols(True)

    def observed(self, simulations, protocol, fit=()):
        return simulations.fitted([list(fit)], 1, protocol)[0].reshape(len(observables()), 2, -1)

    def test_a_hold_at_full_stroke_shows_relaxation(self):
        """The top force relaxes by at most the relaxing fraction, and only for viscoelastic grains."""
        simulations, what = self.simulations()
        self.assertEqual(what[0], "hold the plate at full stroke for 0.6 s")
        soft = [("viscoelasticity", 0.4)]
        stroke, held, rigid = self.observed(simulations, None, soft), self.observed(simulations, 0, soft), self.observed(simulations, 0)
        relaxation = index_of("relaxation")
        others = np.arange(len(observables())) != relaxation
        np.testing.assert_array_equal(np.isfinite(stroke[others]), np.isfinite(held[others]))
        self.assertTrue(np.isnan(stroke[relaxation]).all())
        self.assertEqual(np.argwhere(np.isfinite(held[relaxation])).tolist(), [[Phase.load, 1]])  # the last displacement
        self.assertGreater(held[relaxation, 0, 1], rigid[relaxation, 0, 1] + 0.1)

    def test_one_more_cycle_has_the_bins_of_one(self):
        simulations, what = self.simulations()
        self.assertEqual(what[1], "press one more cycle")
        one, two = (self.observed(simulations, protocol, [("plasticity", 0.3)]) for protocol in (None, 1))
        self.assertFalse(np.array_equal(one, two, equal_nan=True))
        self.assertTrue((np.isfinite(two) | ~np.isfinite(one)).all())

    def test_a_slower_plate_shows_the_rate(self):
        """It leaves more time to relax: of the elastic force at full stroke less is left."""
        simulations, what = self.simulations()
        self.assertEqual(what[2], "press 4 times slower")
        self.assertEqual(len(simulations.other_protocols(False)), 2)
        simulations.other_protocols(True)

        def left(protocol):
            soft, elastic = (self.observed(simulations, protocol, fit)[0, 0, 1] for fit in ([("viscoelasticity", 0.4)], []))
            return soft / elastic

        self.assertLess(left(2), left(None) - 0.02)
        self.assertGreater(left(2), 0.6 - 0.02)  # all of 0.4 has relaxed

    def test_are_not_made_of_a_programme(self):
        programme = scene()._with_programme({"programme.1.stage": "move", "programme.1.position": "0.05"})
        simulations = Simulations(self.small.plan(packings=[Packing(Model(programme, {}, Instrument(), 0.02), [packing()])]), self.small.folder, "")
        self.assertEqual(simulations.other_protocols(True), [])


class PlateMotion(unittest.TestCase):
    def neglected(self, speed, pause, hold, max_slowdown=4, **settings):
        model = Model(scene(**settings), {}, Instrument(), 0.02)
        return {key: to for key, _, _, to in neglected_motion(model, Experiment("x", None, plate_speed=speed, plate_pause=pause, plate_hold=hold),
                                                              max_slowdown)}

    def test_is_that_of_the_experiment(self):
        motion = {"protocol.pause": 0.01, "protocol.hold": 0.02, "plate.speed": 0.05}
        rests = {"protocol__relax_time": 0.02}
        for wanted, given, settings in (
                (motion, (0.05, 0.01, 0.02), {}), ({"plate.speed": 0.05}, (0.05, 0, 0), {}),
                ({"protocol.pause": 0.01, "plate.speed": 0.2}, (0.2, 0.01, 0), {}),  # a faster one
                ({}, (None, 0.01, 0.01), {}), ({}, (0.024, 0.01, 0), {}),  # a slow plate
                ({"protocol.pause": 0.01, "plate.speed": 0.024}, (0.024, 0.01, 0, 5), {}),
                ({"protocol.pause": 0.02, "protocol.hold": 0.02}, (0.1, 60, 90), rests),  # grains have come to rest
                ({"protocol.pause": 60, "protocol.hold": 90}, (0.1, 60, 90), {"protocol__relax_time": 0}),
                ({}, (0.1, 0, 0), {}), ({"protocol.rate_tolerance": 0}, (0.1, 0, 0), {"protocol__rate_tolerance": 0.01}),
                ({}, (0.1, 0.15, 0.25), {"protocol__hold": 0.2, "protocol__stop_at_scans": True, "protocol__pause": 0.1})):
            with self.subTest(given=given, settings=settings):
                self.assertEqual(self.neglected(*given, **{"plate__speed": 0.1, **settings}), wanted)

    def test_of_a_programme_is_kept(self):
        model = Model(scene()._with_programme({"programme.1.stage": "move", "programme.1.position": "0.05"}), {}, Instrument(), 0.02)
        self.assertEqual(neglected_motion(model, Experiment("x", None, plate_speed=0.1, plate_pause=0.15), 4), [])

    def test_is_followed(self):
        """As by a scene with these settings."""
        for pause in (0.01, 0.0):
            small = Small(self)
            small.model = Model(scene(protocol__rate_tolerance=0.01), {}, Instrument(MEASUREMENT), 0.0215)
            experiment = Experiment("x", None, measurement=MEASUREMENT, plate_speed=0.05, plate_pause=pause, plate_hold=0.02)
            simulations = Simulations(small.plan(experiments=[experiment], replicates=1), small.folder, "")
            simulations.follow_motion(20)
            self.assertEqual(simulations.neglected_motion(20), [])
            settings = {"protocol.stop_at_scans": pause > 0, "protocol.pause": pause, "protocol.hold": 0.02, "plate.speed": 0.05,
                        "protocol.rate_tolerance": 0}
            set_by_user = Model(engine.Scene.parse(TEXT, set=settings), {}, Instrument(MEASUREMENT), 0.0215)
            self.assertEqual(simulations.plan.model.digest, set_by_user.digest)


if __name__ == "__main__":
    unittest.main()
