"""The table of effects: each changes its own parameter and nothing else. effects_test.py"""
import pathlib
import re
import unittest
from dataclasses import replace

from small_trials import scene

from mcdem.diagnosis.effects import EFFECTS, find_effect, is_numerical, nuisances
from mcdem.diagnosis.model import Model
from mcdem.experiment.experiment import Measurement
from mcdem.experiment.instrument import Instrument

# The keys, or errors of the instrument, that each effect changes.
MOVES = {
    "cross_contact": ["contact.model", "contact.gamma"], "bulge_contacts": ["effects.bulge_contacts"], "friction": ["grains.friction"],
    "wall_friction": ["walls.friction"], "friction_history": ["effects.friction_history"], "adhesion": ["effects.adhesion"],
    "adhesion_net_friction": ["effects.adhesion", "effects.net_force_friction"], "cohesion": ["effects.cohesion"],
    "viscoelasticity": ["effects.viscoelasticity"], "stiffening": ["effects.stiffening"], "finite_strain": ["effects.finite_strain"],
    "plasticity": ["effects.plasticity"], "buoyancy": ["grains.excess_density"], "diameter_error": ["effects.diameter_error"],
    "polydispersity": ["effects.polydispersity"], "modulus_scatter": ["effects.modulus_scatter"],
    "rolling_resistance": ["effects.rolling_resistance"], "plate_tilt": ["effects.plate_tilt_x"], "plate_tilt_y": ["effects.plate_tilt_y"],
    "plate_compliance": ["effects.plate_compliance"], "force_bias": ["force_bias"], "gauge_drift": ["gauge_drift"],
    "zero_drift": ["zero_drift"], "gauge_hysteresis": ["gauge_hysteresis"], "force_lag": ["force_lag"],
    "guide_friction": ["guide_friction"], "force_saturation": ["force_saturation"], "force_threshold": ["threshold_shift"],
    "position_bias": ["position_bias"], "height_bias": ["height_bias"], "lost_contacts": ["lost_contacts"],
    "law_exponent": ["effects.law_exponent"], "box_width": ["effects.width_error_x"], "box_depth": ["effects.width_error_y"],
    "plate_speed": ["plate.speed"], "inertia": ["grains.density"], "time_step": ["numerics.time_step"]}
FULL = {"effects.adhesion": 0.01, "effects.cohesion": 50.0, "effects.net_force_friction": 0.4, "effects.viscoelasticity": 0.2,
        "effects.stiffening": 0.5, "effects.finite_strain": 0.3, "effects.plasticity": 0.1, "effects.bulge_contacts": 0.6,
        "effects.friction_history": 0.3, "effects.rolling_resistance": 0.1, "effects.modulus_scatter": 0.2, "effects.diameter_error": 1e-4,
        "effects.polydispersity": 2e-4, "effects.law_exponent": 0.1,
        "effects.width_error_x": 1e-4, "effects.width_error_y": 1e-4, "effects.plate_tilt_x": 0.01, "effects.plate_tilt_y": -0.01, "effects.plate_compliance": 1e-4}
PLAIN = Model(scene(), {}, Instrument(Measurement(force_threshold=4e-3)), 0.0215)
# No effect is zero.
WORN = Instrument(PLAIN.instrument.stated, 0.05, 1e-3, 1e-3, 0, 0.02, 0.01, 0.02, 1e-4, 0.01, 0.5, 1e-3, 0.02)
WHOLE = replace(Model(scene(contact__model="mc_dem"), FULL, WORN, 0.0215))


def numbers_of(model):
    """Everything that an effect may change."""
    return {**model.scene._values, **{name: value for name, value in vars(model.instrument).items()}}


def moved(before, after):
    first, then = numbers_of(before), numbers_of(after)
    return sorted(name for name in first if first[name] != then[name])


def with_keys(**keys):
    return PLAIN.with_keys({key.replace("__", "."): value for key, value in keys.items()})


class Effects(unittest.TestCase):
    def test_are_those_of_the_documentation(self):
        readme = (pathlib.Path(__file__).parents[2] / "host/python/mcdem/diagnosis/README.md").read_text().partition("\n## The effects\n")[2]
        rows = [re.findall("`(.*?)`", row.split("|")[1]) for row in re.findall(r"^\| `.*$", readme, re.M)]
        self.assertEqual([effect.name for effect in EFFECTS], [name for row in rows for name in row])
        self.assertEqual(sorted(MOVES), sorted(effect.name for effect in EFFECTS))
        self.assertIsNone(find_effect("phlogiston"))
        self.assertFalse(is_numerical("modulus"))

    def test_amplitudes_lie_within_their_bounds(self):
        for effect in EFFECTS:
            with self.subTest(effect.name):
                self.assertTrue(effect.low <= 0 < effect.high and effect.scale(PLAIN) > 0 and effect.formula and effect.source)
                for amplitude in (effect.first, effect.second):
                    self.assertTrue(effect.low <= amplitude <= effect.high and amplitude != 0)
                self.assertNotEqual(effect.first, effect.second)

    def test_change_only_their_own_parameter(self):
        for effect in EFFECTS:
            for amplitude in (effect.first, effect.second):
                self.assertEqual(moved(PLAIN, effect.apply(PLAIN, amplitude * effect.scale(PLAIN))), sorted(MOVES[effect.name]), effect.name)

    def test_of_amplitude_zero_change_nothing(self):
        for effect in EFFECTS:
            for start in (PLAIN, WHOLE):
                if effect.hindrance(start):
                    continue
                changed = effect.apply(start, 0.0)
                if effect.name == "cross_contact":  # Eq. 1 with gamma = 0 means independent contacts
                    self.assertEqual(changed["contact.gamma"], 0)
                else:
                    self.assertEqual(moved(start, changed), [], effect.name)

    def test_add_to_the_models_amplitude(self):
        """The amplitudes of paired runs are positive in the end; only bulge_contacts and numerics decrease."""
        for effect in EFFECTS:
            if effect.hindrance(WHOLE):
                continue
            changed = effect.apply(WHOLE, effect.second * effect.scale(WHOLE))
            self.assertEqual(moved(WHOLE, changed), sorted(MOVES[effect.name]), effect.name)
            name = MOVES[effect.name][0]
            grows = numbers_of(changed)[name] > numbers_of(WHOLE)[name]
            self.assertEqual(grows, effect.name != "bulge_contacts" and not effect.numerical, effect.name)

    def test_fractions_stay_between_zero_and_one(self):
        for name in ("viscoelasticity", "friction_history", "bulge_contacts", "finite_strain", "plasticity"):
            effect = find_effect(name)
            self.assertTrue(0 <= effect.apply(WHOLE, effect.high)[f"effects.{name}"] <= 1, name)

    def test_friction_is_never_negative(self):
        for name, key in (("friction", "grains.friction"), ("wall_friction", "walls.friction")):
            self.assertEqual(find_effect(name).apply(PLAIN, -1)[key], 0)

    def test_of_numerics_lower_their_keys(self):
        for effect in filter(lambda effect: effect.numerical, EFFECTS):
            key = effect.settings(PLAIN)[0]
            self.assertAlmostEqual(effect.apply(PLAIN, 0.5)[key], 0.5 * PLAIN[key], 12)
            self.assertGreater(effect.apply(PLAIN, 1)[key], 0, "a run that ends")

    def test_the_plates_speed_is_lowered_through_the_rate_tolerance(self):
        """plate.speed, its maximum, is lowered too, and so are the speeds of stages."""
        effect = find_effect("plate_speed")
        model = with_keys(plate__speed=0.1, protocol__rate_tolerance=0.04)
        self.assertEqual(effect.settings(model), ["protocol.rate_tolerance", "plate.speed"])
        slower = effect.apply(model, 0.5)
        self.assertEqual((slower["protocol.rate_tolerance"], slower["plate.speed"]), (0.02, 0.05))
        parameters = {"programme.1.stage": "move", "programme.1.position": "0.05", "programme.1.speed": "0.2", "programme.2.stage": "move",
                      "programme.2.position": "0.06"}
        staged = Model(scene()._with_programme(parameters), {}, Instrument(), 0.02)
        self.assertEqual(effect.settings(staged), ["plate.speed", "programme.1.speed"])
        self.assertEqual(effect.apply(staged, 0.5).scene._values["programme.1.speed"], 0.1)

    def test_reasons_for_exclusion_are_given(self):
        hindered = {"bulge_contacts", "finite_strain"}
        unlimited = PLAIN.read_with(stated=Measurement())
        for model, wanted in (
                (PLAIN, hindered), (with_keys(contact__model="elastic_sphere"), {"cross_contact"}),
                (with_keys(grains__friction=0.0), hindered | {"friction_history", "adhesion_net_friction"}),
                (unlimited, hindered | {"force_threshold"}),
                (replace(PLAIN, experiment_speed=0.9 * PLAIN["plate.speed"]), hindered),
                (replace(PLAIN, experiment_speed=PLAIN["plate.speed"]), hindered | {"plate_speed"}),
                (with_keys(protocol__rate_tolerance=0.01), hindered | {"plate_speed", "inertia"}),
                (with_keys(protocol__rate_tolerance=0.02), hindered),
                (with_keys(effects__adhesion=0.01), hindered | {"adhesion_net_friction"}),
                (replace(PLAIN, base=PLAIN.base._with_box("periodic", 0.06, 0.06)), hindered | {"plate_tilt", "plate_tilt_y", "position_bias", "box_width", "box_depth"}),
                (replace(PLAIN, base=PLAIN.base._with_box("cylinder", 0.06, 0.06)), hindered | {"box_depth"})):
            self.assertEqual({effect.name for effect in EFFECTS if effect.hindrance(model)}, wanted)


class Nuisances(unittest.TestCase):
    def test_change_their_parameter(self):
        self.assertEqual([one.name for one in nuisances(PLAIN, {})], ["modulus", "strain_offset"])
        model = PLAIN.with_keys({"contact.model": "mc_dem"})
        stated = {"grains.youngs_modulus": 0.1 * model["grains.youngs_modulus"], "grains.friction": 0.01, "walls.friction": 0.02,
                  "grains.diameter": 5e-5}
        found = nuisances(model, stated)
        self.assertEqual([one.name for one in found], ["modulus", "strain_offset", "gamma", "friction", "wall_friction", "diameter_error"])
        self.assertAlmostEqual(found[0].sigma, 0.1, 12)
        self.assertEqual([one.sigma for one in found[3:]], [0.01, 0.02, 5e-5])
        for one, name in zip(found, ("grains.youngs_modulus", "strain_offset", "contact.gamma", "grains.friction", "walls.friction",
                                    "effects.diameter_error")):
            self.assertEqual((moved(model, one.apply(model, 0.0)), moved(model, one.apply(model, one.sigma))), ([], [name]))


if __name__ == "__main__":
    unittest.main()
