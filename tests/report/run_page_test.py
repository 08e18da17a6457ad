"""Pages of runs: sentences, charts with titles and captions, tables, provenance."""
import dataclasses
import pathlib
import re
import sys
import unittest

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).parents[1] / "observe")]
from synthetic import Law, cell, recording, run, with_parameters  # noqa: E402

from mcdem.observe.replicas import Setting, group_by_setting  # noqa: E402
from mcdem.report.charts import run_chart  # noqa: E402
from mcdem.report.figure_data import Series  # noqa: E402
from mcdem.report.figure_values import DEFINITIONS, Curve, FigureSeries, RunFigure  # noqa: E402
from mcdem.report.labels import SeriesStyle  # noqa: E402
from mcdem.report.packing_view import PackingLimits  # noqa: E402
from mcdem.report.page import Page  # noqa: E402
from mcdem.report.report_sources import shown_packings  # noqa: E402
from mcdem.report.run_figures import run_figures  # noqa: E402
from mcdem.report.run_page import RunOrigin, RunsOnPage, add_runs  # noqa: E402
from mcdem.report.run_words import main_result, what_was_simulated  # noqa: E402
from mcdem.results import Failure, Phase, Run  # noqa: E402

HOSTILE = "<a href='x'>&y\n</a>"
ESCAPED = "&lt;a href='x'&gt;&amp;y &lt;/a&gt;"
CELL = Setting("mc_dem", (cell("mc_dem"),))


def scattered_models(replicas=1, contacts=300):
    return run([Law("independent", top=6, scatter=0.1, contacts=contacts), Law("mc_dem", scatter=0.1, contacts=contacts)], replicas)


def settings_of(laws, replicas=1):
    return group_by_setting(run(laws, replicas))


def with_failure(made, failure):
    """The first replica stopped."""
    return dataclasses.replace(made, recordings=(dataclasses.replace(made.recordings[0], failure=failure), *made.recordings[1:]))


def charts_of(made, reference=None):
    return {figure.name: run_chart(figure) for figure in run_figures(group_by_setting(made), reference).figures}


class WordsTest(unittest.TestCase):
    def test_what_was_simulated(self):
        one = dataclasses.replace(recording(Law(grains=1)), parameters={"protocol.cycles": "2"})
        for settings, words in (
                (settings_of([Law("independent"), Law("mc_dem")], 3), ["100 grains in a box, ", "by a plate; 2 settings, 3 packings each."]),
                ([CELL], ["20 grains in a cell", "deformed in 3 stages", "1 setting, 1 packing each"]),
                ([Setting("", (one, recording(Law()))), Setting("", (one,))],
                 ["1 to 100 grains", ", 2 cycles or compressed by a plate; 2 settings, 1 to 2 packings"])):
            for part in words:
                self.assertIn(part, what_was_simulated(settings))
        self.assertEqual(what_was_simulated([]), "")

    def test_main_result(self):
        two = run([Law("independent", top=6.45), Law("mc_dem")], 2)
        many = [Law(model, top=top) for model, top in (("independent", 5), ("mc_dem", 9), ("elastic_sphere", 7), ("sphere_to_sphere", 3),
                                                       ("point_force_on_sphere", 6))]
        held = with_parameters(recording(Law(levels=2)), programme__1__stage='"hold"')
        for settings, expected in (
                (group_by_setting(two), "Force on the plate at 30.00 mm: Independent contacts 6.45 ± 0.00 N, MC-DEM 15.00 ± 0.00 N."),
                (group_by_setting(with_failure(two, Failure(0, -1, ""))), " 1 of 4 replicas stopped early."),
                (settings_of(many), ": from 3.00 N (Sphere to sphere) to 9.00 N (MC-DEM)."),
                ([CELL], "Largest mean stress: MC-DEM 5880 Pa at φ = 0.620."),
                ([Setting("mc_dem", (held,))], "Largest force on the plate: MC-DEM 15 N at 30.00 mm.")):
            self.assertTrue(main_result(settings).endswith(expected), main_result(settings))


class ChartsTest(unittest.TestCase):
    def test_the_papers_four_figures(self):
        made = charts_of(scattered_models())
        self.assertEqual({name: chart.log_axes for name, chart in made.items()},
                         {"top_force": "xy", "force_distribution": "", "coordination": "", "scaling": "xy"})
        self.assertEqual(made["force_distribution"].title, "Contact forces at 18.0 mm, unloading")
        self.assertEqual([trace.showlegend for trace in made["top_force"].figure.data], [True, False] * 2, "one entry a series")
        self.assertEqual(made["force_distribution"].figure.layout.yaxis.type, "log", "always, without a button")

    def test_captions_describe_the_data(self):
        alone = charts_of(scattered_models())
        self.assertNotRegex(alone["top_force"].caption, "reference|standard error")
        self.assertEqual(alone["coordination"].title, "Contacts per grain")
        against = charts_of(scattered_models(4), Setting("experiment", (recording(Law(seed=50, contacts=300)),)))
        self.assertIn("Points: the reference", against["top_force"].caption)
        for name in ("top_force", "force_distribution", "coordination"):
            self.assertIn("one standard error over replicas", against[name].caption)
        self.assertEqual(against["coordination"].title, "Contacts per grain, weak forces left out")

    def test_of_programmes(self):
        charts = charts_of(Run("", "", "", "", "", CELL.replicas))
        shown = charts["pressure_strain"]
        self.assertEqual((len(charts), shown.title, shown.log_axes), (8, "Mean stress against volume strain", "y"))
        self.assertIn("a third of the stress tensor's trace", shown.caption)
        self.assertEqual(shown.figure.layout.yaxis.title.text, "mean stress p [Pa]")
        self.assertEqual([charts[name].figure.layout.xaxis.rangemode for name in ("pressure_strain", "cell_coordination")], ["tozero", None])


class TracesTest(unittest.TestCase):
    """Charts of artificial values: texts are escaped, and unknown values are omitted."""

    def traces(self, name, phase, points, is_reference=False):
        series = Series(HOSTILE, SeriesStyle("#123456", "o"), Setting("", (recording(Law()),)), [], is_reference=is_reference)
        shown = FigureSeries(series, (Curve(phase, points),), HOSTILE, 123456.789)
        return run_chart(RunFigure("", "time [s]", "a number", [shown], name=name, drawing=DEFINITIONS[name].drawing)).figure.data

    def test_a_band_is_one_standard_error_wide_and_stays_positive(self):
        band, line = self.traces("top_force", Phase.load, ((1, 3, 0.5), (2, 4, 3.9)))
        np.testing.assert_allclose(band.x, [1, 2, 2, 1])
        np.testing.assert_allclose(band.y, [3.5, 7.9, 4 / 3, 2.5])
        self.assertEqual((band.fillcolor, band.hoverinfo, band.showlegend, line.showlegend), ("rgba(18,52,86,0.18)", "skip", False, True))
        self.assertEqual(line.hovertemplate, "%{x:.2f} mm, loading<br>%{y:.4g} N ± %{customdata:.2g} N")
        self.assertEqual((band.legendgroup, line.legendgroup, line.name), (ESCAPED,) * 3)

    def test_no_band_where_an_error_is_unknown(self):
        for name, hover in (("top_force", "%{x:.2f} mm, unloading<br>%{y:.4g} N"), ("force_distribution", "%{x:.4g} mN<br>%{y:.3g} per mN"),
                            ("coordination", "%{x:.2f} mm, unloading<br>Z = %{y:.3f}"), ("pressure_time", "%{x:.4g} s<br>%{y:.4g}")):
            line, = self.traces(name, Phase.unload, ((1, 3, 0.1), (2, 4, np.nan)))
            self.assertEqual((line.hovertemplate, line.customdata, line.mode), (hover, None, "lines+markers"))
            self.assertEqual(line.name, f"{ESCAPED}, {ESCAPED}" if name == "coordination" else ESCAPED)

    def test_a_reference_is_points_with_bars(self):
        points, = self.traces("top_force", Phase.unload, ((1, 3, 0.5), (2, 4, 0.5)), is_reference=True)
        self.assertEqual((points.mode, points.marker.symbol, points.marker.color), ("markers", "circle-open", "var(--ink)"))
        self.assertEqual(list(points.error_y.array), [0.5, 0.5])

    def test_the_scaling_law_is_a_line_that_has_a_logarithm(self):
        line = self.traces("scaling", Phase.load, ((1, 2, np.nan), (2, 4, np.nan)))[-1]
        np.testing.assert_allclose(line.x, [0.002, 2])
        np.testing.assert_allclose(line.y, np.array([0.002, 2]) * 123456.789)
        self.assertEqual(line.hovertemplate, "slope 1.235e+08 /m")


class RunPageTest(unittest.TestCase):
    def page_of(self, made, reference=None):
        settings = group_by_setting(made)
        packings, left_out = shown_packings(settings, PackingLimits())
        page = Page("runs")
        add_runs(page, RunsOnPage([RunOrigin("out/run", made, [("run.h5", "0123")])], settings, reference, packings=packings,
                                  left_out=left_out))
        return page.html("")

    def test_sections_and_provenance(self):
        made = dataclasses.replace(scattered_models(2), scene="[box]\n# <scene>\n")
        page = self.page_of(made, Setting("experiment", (recording(Law(seed=50, contacts=300)),)))
        self.assertEqual(re.findall("<h2>(.*?)</h2>", page), ["Forces and contacts", "The packing in 3D", "Metrics", "Provenance"])
        for part in ("Compared with experiment.", "<h3>Against experiment</h3>", "<h3>Top force</h3>", "<h3>Scaling law</h3>",
                     "No positions recorded: run with output.positions = true", "<dt>packing seeds</dt><dd>1, 2</dd>",
                     "<dt>SHA-256 of run.h5</dt><dd>0123</dd>", "# &lt;scene&gt;\n", "<dt>replicas</dt><dd>4</dd>"):
            self.assertIn(part, page)
        self.assertNotIn("Energy budget", page)

    def test_what_is_long_missing_or_failed(self):
        page = self.page_of(with_failure(run([Law()], 14), Failure(7, 3, "<reason>")))
        for part in ("<dd>1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 and 2 more</dd>",
                     "<li>mc_dem #1 stopped at step 7, grain 3: &lt;reason&gt;</li>",
                     "<p>No chart of the force distribution: no contacts were recorded.</p>"):
            self.assertIn(part, page)

    def test_a_page_of_cells_says_nothing_of_plates(self):
        page = self.page_of(Run("cells", "", "", "", "", CELL.replicas))
        self.assertIn("<h2>Stresses and contacts</h2>", page)
        self.assertNotRegex(re.sub(r"(?s)<(script|style).*?</\1>", "", page).lower(), "plate|top force")


if __name__ == "__main__":
    unittest.main()
