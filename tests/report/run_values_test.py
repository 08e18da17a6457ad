"""Values of the figures of runs, for pages and print: levels, densities, thresholds, slopes, programmes. Closed forms of synthetic.py."""
import dataclasses
import json
import math
import pathlib
import re
import sys
import unittest

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).parents[1] / "observe")]
from synthetic import Law, cell, changed, contacts_of, recording, rows, run, with_parameters  # noqa: E402

from mcdem.observe.replicas import Setting, group_by_setting  # noqa: E402
from mcdem.report.charts import run_chart  # noqa: E402
from mcdem.report.figure_data import FigureOptions  # noqa: E402
from mcdem.report.figure_values import DEFINITIONS, figure_file  # noqa: E402
from mcdem.report.run_figures import run_figures  # noqa: E402
from mcdem.results import Phase  # noqa: E402


def two_models(replicas=1, contacts=300):
    return run([Law("independent", top=6, contacts=contacts), Law("mc_dem", top=15, contacts=contacts)], replicas)


def values_of(settings, reference=None, **options):
    """As figures.json has them."""
    made = run_figures(settings, reference, FigureOptions(**options))
    return json.loads(figure_file({figure.name: figure.values() for figure in made.figures}))


def values_of_run(made, reference=None, **options):
    return values_of(group_by_setting(made), reference, **options)


def without_averages(made):
    """Neither contacts nor averages over the packing."""
    unknown = np.full(len(made.scans), math.nan)
    return changed(made, coordination_number=unknown, mean_force=unknown, packing_fraction=unknown, branch_length=unknown)


def each(made, change):
    return dataclasses.replace(made, recordings=tuple(map(change, made.recordings)))


class RunValuesTest(unittest.TestCase):
    def test_top_forces_are_the_level_means(self):
        series = values_of_run(two_models())["top_force"]["series"][1]
        self.assertEqual((series["setting"], series["words"], series["replicas"]), ("mc_dem", "MC-DEM", 1))
        load, unload = series["curves"]
        self.assertEqual((load["phase"], unload["phase"], len(load["x"])), ("load", "unload", 10))
        np.testing.assert_allclose((load["x"][9], load["y"][9]), (30, 15), atol=1e-9)
        share = (3e-3 * 6 - 5e-3) / 25e-3
        self.assertAlmostEqual(load["y"][5], 15 * share**1.5, places=9)
        self.assertIsNone(load["standard_error"][9])
        self.assertEqual(len(unload["x"]), 11, "with the turning point")
        self.assertEqual(unload["y"][10], load["y"][9])

    def test_errors_need_replicas(self):
        made = run([Law("mc_dem", scatter=0.1)], 4)
        curve = values_of_run(made)["top_force"]["series"][0]["curves"][0]
        tops = [one.scans.top_force[9] for one in made.recordings]
        self.assertAlmostEqual(curve["standard_error"][9], np.std(tops, ddof=1) / 2, places=9)

    def test_the_distribution_is_that_of_the_level_nearest_to_the_request(self):
        stopped = each(two_models(), lambda one: rows(one, one.scans.phase == Phase.load))  # before unloading
        for made, displacement, level, phase in ((two_models(), 18e-3, 18, "unload"), (two_models(), 0.0, 0, "unload"),
                                                 (two_models(), 50e-3, 30, "load"),  # 30 mm: the turning point
                                                 (stopped, 50e-3, 30, "load")):
            values = values_of_run(made, distribution_displacement=displacement)["force_distribution"]
            self.assertAlmostEqual(values["displacement_mm"], level, places=9)
            self.assertEqual(values["series"][0]["curves"][0]["phase"], phase)

    def test_densities_integrate_to_nearly_one(self):
        curve = values_of_run(run([Law(contacts=5000)], 1))["force_distribution"]["series"][0]["curves"][0]
        self.assertAlmostEqual(sum(curve["y"]) * 2 * curve["x"][0], 1, delta=0.01)  # all but a thousandth of the contacts

    def test_each_setting_has_its_own_tau(self):
        made = run([Law(contacts=2000)], 1)
        strong = changed(made.recordings[0], contacts=tuple(
            one.rows(one.force[:, 2] >= 4e-3) for one in made.recordings[0].scans.contacts))
        series = values_of_run(made, Setting("experiment", (strong,)))["coordination"]["series"]
        self.assertRegex(series[0]["remark"], r"^tau (3.99|4.00) mN$")
        self.assertEqual((series[1]["is_reference"], series[1]["remark"]), (True, ""))
        for ours, theirs in zip(series[0]["curves"], series[1]["curves"], strict=True):
            self.assertEqual(ours["y"], theirs["y"])

    def test_no_tau_without_contacts_of_the_reference(self):
        made = run([Law(contacts=2000)], 1)
        bare = changed(made.recordings[0], contacts=(contacts_of([], [], []),) * 20, coordination_number=np.full(20, math.nan))
        series = values_of_run(made, Setting("experiment", (bare,)))["coordination"]["series"]
        self.assertEqual([one["remark"] for one in series], [""])

    def test_a_threshold_leaves_weak_contacts_out(self):
        made = run([Law(contacts=2000)], 1)
        series = values_of_run(made, threshold=4e-3)["coordination"]["series"][0]
        self.assertEqual(series["remark"], "tau 4.00 mN")
        force = np.linalg.norm(made.recordings[0].scans.contacts[9].force, axis=1)
        both = 2 - made.recordings[0].scans.contacts[9].is_wall
        self.assertAlmostEqual(series["curves"][0]["y"][9], both[force >= 4e-3].sum() / 100, places=9)

    def test_the_scaling_law_has_its_slope(self):
        series = values_of_run(two_models())["scaling"]["series"][1]
        self.assertEqual(series["remark"], "150 /m")
        self.assertAlmostEqual(series["slope"], 0.15, places=9)  # N over mN m

    def test_the_ratio_to_the_reference_is_included(self):
        made = two_models()
        series = values_of_run(made, Setting("experiment", made.recordings[1:]))["top_force"]["series"]
        self.assertEqual([one["remark"] for one in series], ["Rtop 0.40", "Rtop 1.00", ""])
        self.assertEqual(series[2]["colour"], "#000000")

    def test_missing_data_are_explained(self):
        made = each(two_models(contacts=0), without_averages)
        figures = run_figures(group_by_setting(made))
        self.assertEqual([figure.name for figure in figures.figures], ["top_force"])
        self.assertEqual([missing.split(":")[0] for missing in figures.missing], ["the force distribution", "Z", "the scaling law"])
        self.assertIn("no contacts were recorded", figures.missing[0])

    def test_nothing_is_left_after_all_cycles_are_discarded(self):
        made = each(two_models(), lambda one: with_parameters(one, protocol__discard="1"))
        figures = run_figures(group_by_setting(made))
        self.assertEqual((figures.figures, figures.missing), ([], ["any quantity: no scans are left after the discarded cycles"]))

    def test_the_file_has_its_format_and_any_label(self):
        setting = dataclasses.replace(group_by_setting(two_models())[0], label="\udcff\" \\ `x`\n")
        values = values_of([setting])
        self.assertEqual(values["mcdem_figures"], 1)
        self.assertEqual(values["top_force"]["series"][0]["words"], "\ufffd\" \\ `x` ")

    def test_a_figure_is_one_function(self):
        """That of CONTRIBUTING.md: its values and its chart follow from it."""
        from mcdem.report import run_figures as room
        guide = (pathlib.Path(__file__).parents[2] / "CONTRIBUTING.md").read_text("utf-8")
        exec(re.search(r"(?s)```py\n(@run_figure.*?)```", guide)[1], dict(vars(room)))
        self.addCleanup(DEFINITIONS.pop, "packing_fractions")
        figure = run_figures(group_by_setting(two_models())).figures[-1]
        chart = run_chart(figure)
        self.assertEqual((figure.name, chart.name, len(chart.figure.data)), ("packing_fractions", "packing_fractions", 4))
        self.assertEqual(figure.values()["series"][0]["curves"][0]["y"], list(chart.figure.data[0].y))


class ProgrammeValuesTest(unittest.TestCase):
    def figures_of(self, *recordings):
        made = run_figures([Setting("mc_dem", recordings)])
        self.assertEqual(made.missing, [])
        return {figure.name: figure for figure in made.figures}

    def test_of_a_cell_show_stresses_and_strains(self):
        figures = self.figures_of(cell("mc_dem"), cell("mc_dem", 2, 3))
        self.assertEqual(list(figures), ["pressure_strain", "shear_stress_strain", "cell_coordination", "stress_path", "pressure_time",
                                         "volume_time", "shear_stress_time", "shear_strain_time"])
        for figure in figures.values():
            self.assertNotRegex(figure.title + figure.x_label + figure.y_label, "plate|orce")
        self.assertEqual(figures["pressure_strain"].y_label, "mean stress p [kPa]")
        self.assertEqual(figures["pressure_time"].x_label, "time [s]")
        points = figures["pressure_strain"].series[0].curves[0].points
        gone = 1 - 0.98**3
        np.testing.assert_allclose(points[1], (100 * gone, 200 * gone, 100 * gone), rtol=1e-12)
        p, q, _ = figures["stress_path"].series[0].curves[0].points[2]
        self.assertAlmostEqual(q / p, 0.1 * math.sqrt(3), places=12)

    def test_of_a_cell_without_shear_and_holds_are_two(self):
        made = rows(with_parameters(cell("mc_dem"), programme__3__stage='"move"'), slice(2))
        self.assertEqual(list(self.figures_of(made)), ["pressure_strain", "cell_coordination"])

    def test_of_a_plate_have_a_stress_path_if_stresses_are_known(self):
        held = with_parameters(recording(Law(levels=2)), programme__1__stage='"hold"')
        self.assertEqual(list(self.figures_of(held)), ["force_time", "displacement_time", "force_displacement"])
        figures = self.figures_of(changed(held, stress=np.repeat(np.diag([1.0, 1, 3])[None], 4, axis=0)))
        self.assertEqual(list(figures)[-1], "stress_path")
        self.assertEqual(figures["stress_path"].y_label, "deviatoric stress q [Pa]")


if __name__ == "__main__":
    unittest.main()
