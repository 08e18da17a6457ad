"""Keys that a convergence study changes, and its remedies. refinements_test.py"""
import unittest

from mcdem.convergence.refinements import refinements_of

PARAMETERS = {"container.shape": "box", "plate.speed": 0.1, "protocol.rate_tolerance": 0, "grains.density": 11.5,
              "numerics.time_step": 0.1, "numerics.skin": 0.2, "numerics.precision": "double", "protocol.stop_at_scans": False,
              "protocol.settle_unbalanced_force": 0.001, "protocol.settle_time": 0.5}
STAGES = {"programme.1.stage": "move", "programme.1.speed": 0.4, "programme.2.stage": "hold", "programme.2.speed": None,
          "programme.3.stage": "hold", "programme.3.speed": None, "programme.4.stage": "move", "programme.4.speed": 0.8}


def found(**changes):
    """Cause -> refinement; `__` in names of keys means a dot."""
    return {one.cause: one for one in refinements_of(PARAMETERS | {key.replace("__", "."): value for key, value in changes.items()})}


class Refinements(unittest.TestCase):
    def test_depend_on_the_scene(self):
        plain = ["plate speed", "inertia", "time step", "list margin"]
        for changes, causes in (({}, plain), ({"numerics__precision": "float"}, [*plain[:3], "precision", plain[3]]),
                                ({"protocol__stop_at_scans": True}, [*plain[:3], "settling", "stops at scans", plain[3]])):
            self.assertEqual(list(found(**changes)), causes)

    def test_change_one_setting(self):
        all_found = found(numerics__precision="float", protocol__stop_at_scans=True)
        for cause, remaining, changes in (("inertia", 0.5, {"grains.density": 11.5 / 4}), ("time step", 0.5, {"numerics.time_step": 0.05}),
                                          ("settling", 0, {"protocol.settle_unbalanced_force": 0.0001, "protocol.settle_time": 2.0}),
                                          ("stops at scans", 0, {"protocol.stop_at_scans": False, "protocol.pause": 0}),
                                          ("precision", 0, {"numerics.precision": "double"}), ("list margin", 0, {"numerics.skin": 0.25})):
            step, = all_found[cause].steps
            self.assertEqual((step.remaining, step.changes), (remaining, changes), cause)

    def test_a_margin_that_cannot_be_wider_is_narrowed(self):
        for changes, skin in (({"numerics__skin": 2}, 1.6), ({"container__shape": "periodic"}, 0.16)):
            step, = found(**changes)["list margin"].steps
            self.assertAlmostEqual(step.changes["numerics.skin"], skin)

    def test_slow_the_plate_in_all_that_it_does(self):
        steps = found(protocol__rate_tolerance=0.02, **STAGES)["plate speed"].steps
        self.assertEqual([step.remaining for step in steps], [0.5, 0.25, 0.125])
        for step in steps:
            self.assertEqual(step.changes, {key: value * step.remaining for key, value in {
                "plate.speed": 0.1, "protocol.rate_tolerance": 0.02, "programme.1.speed": 0.4, "programme.4.speed": 0.8}.items()})

    def test_have_remedies_with_the_scene_s_values(self):
        longer = ", runs 3 times as long"
        for cause, changes, remedy in (
                ("plate speed", {"protocol__rate_tolerance": 0.02}, f"protocol.rate_tolerance = 0.02 / 3{longer}"),
                ("plate speed", {}, f"plate.speed = 0.1 / 3{longer}, or set protocol.rate_tolerance, which slows the plate only when "
                                    "necessary"),
                ("plate speed", STAGES, f"plate.speed = 0.1 / 3 and the speeds of stages likewise{longer}, or set protocol.rate_tolerance, "
                                        "which slows the plate only when necessary"),
                ("inertia", {}, f"grains.density = 11.5 / 9{longer}"), ("time step", {}, f"numerics.time_step = 0.1 / 3{longer}"),
                ("precision", {"numerics__precision": "float"}, "numerics.precision = double, runs twice as long"),
                ("list margin", {}, "")):
            self.assertEqual(found(**changes)[cause].remedy.format(factor=3.0, square=9.0), remedy)


if __name__ == "__main__":
    unittest.main()
