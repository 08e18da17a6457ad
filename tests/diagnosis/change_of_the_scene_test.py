"""What a diagnosis recommends to change in the scene. change_of_the_scene_test.py"""
import unittest

from mcdem.diagnosis.change_of_the_scene import change_of_the_scene, simulate_motion
from mcdem.diagnosis.diagnosis_types import Cause, Diagnosis, Gap, Refinement, Verdict

KEYS = {"friction": ["grains.friction = 0.0512"], "adhesion": ["effects.adhesion = 1.5e-06"],
        "cross_contact": ["contact.model = mc_dem", "contact.gamma = 1.16"]}


def changed_keys(amplitudes):
    """Errors of measurement change none."""
    return [key for name, _ in amplitudes for key in KEYS.get(name, [])]


def cause(effect, amplitude, *group):
    return Cause(effect, amplitude, "", 0.9, (effect, *group), 0.1, False, 0.9, 100, None)


def diagnosis(*causes, verdict=Verdict.effect, refinements=()):
    return Diagnosis(verdict=verdict, gap=Gap(True, 0, 0, 0), where=(), causes=causes, shrink=None, detection_limits=(), not_measured=(),
                     seconds=0, where_threshold=0, cells=(), ranking=(), nuisances=(), not_testable=(), provenance={},
                     refinements=refinements)


class Changes(unittest.TestCase):
    def text(self, *causes, **more):
        step = change_of_the_scene(diagnosis(*causes, **more), changed_keys)
        return step and step.what

    def test_keys_of_the_named_effect(self):
        after = " in the scene, and test with another packing whether the gap disappears"
        for causes, settings in (
                ([cause("friction", 0.0312345)], "grains.friction = 0.0512"),
                ([cause("cross_contact", 1.16)], "contact.model = mc_dem, contact.gamma = 1.16"),
                ([cause("friction", 0.01), cause("adhesion", 1.5e-6)], "grains.friction = 0.0512, effects.adhesion = 1.5e-06"),
                ([cause("friction", 0.01, "adhesion"), cause("adhesion", 2e-6, "friction")], "grains.friction = 0.0512")):  # of a group
            with self.subTest(settings):
                self.assertEqual(self.text(*causes), f"set {settings}{after}")

    def test_errors_of_measurement_have_no_key(self):
        self.assertEqual(self.text(cause("force_bias", 0.1)),
                         "check the measurement for bias of contact forces: the scene describes no errors of measurement")
        self.assertIn("bias of positions and the zero of the displacement ([plate] start in experiment.toml):",
                      self.text(cause("position_bias", 0.1), cause("strain_offset", 1e-4)))

    def test_nothing_without_a_named_effect(self):
        self.assertIsNone(self.text())
        self.assertIsNone(self.text(cause("friction", 0.01), verdict=Verdict.unknown_effect))

    def test_refinement(self):
        open_, done = (Refinement("time_step", "numerics.time_step", 4e-6, 1e-6, "s", is_done) for is_done in (False, True))
        self.assertEqual(self.text(cause("friction", 0.01), refinements=(done, open_)),
                         "set numerics.time_step = 1e-06 s in the scene (now 4e-06), or let the diagnosis refine it with --refine 4, and "
                         "diagnose again")
        self.assertIn("grains.friction", self.text(cause("friction", 0.01), refinements=(open_, done)))

    def test_motion_of_the_plate(self):
        pauses = [("protocol.pause", "s", 0, 0.05), ("plate.speed", "m/s", 0.1, 0.0123456)]
        self.assertEqual(simulate_motion(pauses).what, "simulate the motion of the experiment's plate: --set protocol.stop_at_scans=true "
                         "--set protocol.pause=0.05 --set plate.speed=0.0123")
        self.assertNotIn("stop_at_scans", simulate_motion(pauses[1:]).what)


if __name__ == "__main__":
    unittest.main()
