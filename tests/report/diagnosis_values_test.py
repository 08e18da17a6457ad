"""Values of the figures of a diagnosis, and its charts."""
import json
import math
import unittest

from diagnosis_samples import VERDICTS, bare, cause, cell, entry, of, sample

from mcdem.report.diagnosis_charts import diagnosis_charts
from mcdem.report.diagnosis_text import where_line
from mcdem.report.diagnosis_values import diagnosis_figure_values, group_letters
from mcdem.report.diagnosis_words import percent


def values_of(d):
    return json.loads(json.dumps(diagnosis_figure_values(of(d)), allow_nan=False))


def number_of_framed(panel):
    return sum(one["stands_out"] for one in panel["cells"])


def names_of(d):
    return [chart.name for chart in diagnosis_charts(of(d))]


class Where(unittest.TestCase):
    def test_every_cell_is_there_twice_and_marked_beyond_the_threshold(self):
        d = sample("effect")
        panels = values_of(d)["where"]["panels"]
        framed = [sum(abs(one[score]) >= d["where_threshold"] for one in d["cells"]) for score in ("z_score", "z_score_refitted")]
        self.assertGreater(framed[0], framed[1])
        self.assertEqual([len(panel["cells"]) for panel in panels], [250, 250])
        self.assertEqual([number_of_framed(panel) for panel in panels], framed)

    def test_columns_are_ordered_by_time(self):
        d = bare() | {"cells": [cell("top_force", phase, displacement, 1, 1) for phase, displacement in
                                (("unload", 20), ("load", 10), ("unload", 10), ("load", 20.004), ("load", 20))]}
        columns = values_of(d)["where"]["columns"]
        self.assertEqual([(column["phase"], column["displacement_mm"]) for column in columns],
                         [("loading", 10), ("loading", 20), ("unloading", 20), ("unloading", 10)])
        self.assertEqual([column["x"] for column in columns], [0.5, 1.5, 2.85, 3.85])

    def test_without_a_threshold_the_entries_before_recalibration_are_marked(self):
        d = bare() | {"cells": [cell(*place, 5, 5) for place in (("top_force", "load", 10), ("top_force", "load", 20),
                                                                 ("top_force", "unload", 10), ("mean_force", "load", 10))],
                      "where": [entry("top_force", "load", [5, 15], 5, 5)]}
        panels = values_of(d)["where"]["panels"]
        self.assertEqual([number_of_framed(panel) for panel in panels], [1, 0])
        self.assertTrue(panels[0]["cells"][0]["stands_out"])

    def test_the_colour_range_neither_hides_nor_exaggerates(self):
        for largest, expected in ((0.5, 6), (6.2, 7), (-40, 8)):
            d = bare() | {"cells": [cell("top_force", "load", 1, largest, 0)]}
            self.assertEqual(values_of(d)["where"]["colour_range"], expected)


class Which(unittest.TestCase):
    def test_scores_with_the_named_effects_marked(self):
        for verdict, count in zip(VERDICTS, (0, 1, 3, 0, 0, 0), strict=True):
            self.assertEqual(sum(row["is_named"] for row in values_of(sample(verdict))["which"]["rows"]), count, verdict)
        rows = values_of(sample("group"))["which"]["rows"]
        self.assertEqual(len(rows), 18)
        self.assertAlmostEqual(rows[1]["gain"], 17.8)

    def test_both_effects_of_a_pair_are_marked(self):
        d = sample("effect")
        d["causes"].append(d["ranking"][2])
        values = values_of(d)
        self.assertEqual([k for k, row in enumerate(values["which"]["rows"]) if row["is_named"]], [0, 2])
        self.assertEqual(values["how_far"]["forces"]["words_after"], "simulated with both effects")

    def test_amplitudes_are_over_their_limits_with_90_percent_intervals(self):
        limit = {"absorbed_by_calibration": 0, "unit": "", "group": []}
        d = bare() | {"ranking": [cause("a", 6, 1, "N", ["a"]), cause("b", 1, 1, "", ["b"])],
                      "detection_limits": [limit | {"effect": "b", "minimum_amplitude": None},
                                           limit | {"effect": "a", "minimum_amplitude": 2}]}
        a, b = values_of(d)["which"]["rows"]
        self.assertEqual(a["over_limit"], 3)
        self.assertAlmostEqual(a["half_interval"], 0.82243, delta=1e-4)  # 1.64485 sigma / 2
        self.assertNotIn("over_limit", b)  # cannot be detected

    def test_letters_are_shared_by_effects_that_cannot_be_distinguished(self):
        for groups, letters in ((["ac", "b", "ca", "de", "ed"], ["A", "", "A", "B", "B"]),
                                # b is close to a and c, which are distinguishable: no letter is common to all three
                                (["ab", "b", "cb"], ["A", "AB", "B"]), (["abc", "ba", "c"], ["A", "A", "A"]), ([], [])):
            ranking = [cause("abcde"[k], group=group) for k, group in enumerate(groups)]
            self.assertEqual(group_letters(of(bare() | {"ranking": ranking}).ranking), letters)


class HowFar(unittest.TestCase):
    def test_forces_and_the_remaining_gap(self):
        values = values_of(sample("effect"))["how_far"]
        forces = values["forces"]
        self.assertEqual(len(forces["x"]), 21)
        for key, expected in (("x", 30), ("experiment", 14.65), ("before", 13.1)):
            self.assertAlmostEqual(forces[key][20], expected)
        self.assertEqual(forces["fitted"], [0, 18])
        self.assertEqual([round(bar["gap_left"]) for bar in values["bars"]], [100, 19, 21, 88])  # before, predicted, simulated, placebo
        self.assertEqual([round(end, 9) for end in values["bars"][1]["interval"]], [7, 34])

    def test_the_legend_says_what_was_changed(self):
        for verdict, words in (("effect", "simulated with adhesion"), ("not_converged", "simulated, refined"),
                               ("calibration_suspect", "simulated, recalibrated"), ("group", "simulated with adhesion")):
            self.assertEqual(values_of(sample(verdict))["how_far"]["forces"]["words_after"], words)

    def test_unknown_values_are_left_out(self):
        d = sample("effect")
        d["shrink"]["top_force"] = [{"displacement_mm": 10, "experiment_N": None, "before_N": 1, "after_N": 1}]
        self.assertIsNone(values_of(d)["how_far"]["forces"])
        d["shrink"]["before"] = 0
        self.assertNotIn("how_far", values_of(d))
        for one in (cell("top_force", "load", 10, None, None), cell("top_force", "load", None, 1, 1)):
            self.assertNotIn("where", values_of(d | {"cells": [one]}))
        self.assertEqual(values_of(bare()), {})


class Charts(unittest.TestCase):
    def test_have_the_values_of_the_printed_figures(self):
        d = sample("effect")
        where, which, how_far, gap_left, law = diagnosis_charts(of(d))
        values = values_of(d)
        scores = [[one["z_score"] for one in panel["cells"]] for panel in values["where"]["panels"]]
        maps = [trace for trace in where.figure.data if trace.type == "heatmap"]
        for trace, expected in zip(maps, scores, strict=True):
            self.assertEqual(sorted(z for row in trace.z for z in row if z is not None), sorted(expected))
        self.assertEqual(len(where.figure.layout.shapes), sum(map(number_of_framed, values["where"]["panels"])))
        numbers = [text for trace in where.figure.data if trace.type == "scatter" for text in trace.text]
        self.assertEqual(len(numbers), len(where.figure.layout.shapes))
        self.assertEqual(list(which.figure.data[0].x), [one["score"] for one in d["ranking"]])
        self.assertEqual(list(which.figure.data[1].x), [44.1])
        self.assertIn(f"{percent(d['ranking'][0]['explained'])} of chi-square", which.figure.data[0].hovertext[0])
        self.assertEqual([list(trace.y) for trace in how_far.figure.data],
                         [values["how_far"]["forces"][key] for key in ("before", "after", "experiment")])
        self.assertEqual(list(gap_left.figure.data[0].x), [bar["gap_left"] for bar in values["how_far"]["bars"]])
        self.assertEqual([list(trace.y) for trace in law.figure.data[1::2]], [curve["y"] for curve in values["law"]["curves"]])
        self.assertIn("Framed: beyond 3.9 sigma", where.caption)
        self.assertIn(d["shrink"]["held_out"], gap_left.caption)

    def test_cells_are_at_the_place_of_their_column(self):
        d = bare() | {"cells": [cell("top_force", "load", 10, 1, 0), cell("top_force", "unload", 10, 2, 0),
                                cell("mean_force", "unload", 10, 3, 0)]}
        trace = diagnosis_charts(of(d))[0].figure.data[0]
        self.assertEqual(list(trace.x), [0, 1, 1.35, 2.35])
        self.assertEqual([list(row) for row in trace.z], [[1, None, 2], [None, None, 3]])
        self.assertEqual(trace.text[1][2], "mean force, unloading at 10.00 mm<br>3.00 sigma")

    def test_exist_only_with_data(self):
        self.assertEqual(names_of(bare()), [])
        d = sample("effect")
        d["shrink"]["top_force"].clear()
        self.assertEqual(names_of(d), ["where", "which", "gap_left", "law"])
        d["shrink"]["before"] = 0
        self.assertEqual(names_of(d), ["where", "which", "law"])
        d["contact_laws"].clear()
        self.assertEqual(names_of(d), ["where", "which"])

    def test_texts_are_not_interpreted(self):
        d = sample("effect")
        d["ranking"][0]["effect"] = d["cells"][0]["observable"] = "<b>&\x01"
        where, which = diagnosis_charts(of(d))[:2]
        self.assertEqual(where.figure.layout.yaxis.ticktext[0], "&lt;b&gt;&amp; ")
        self.assertTrue(which.figure.data[0].hovertext[0].startswith("&lt;b&gt;&amp; <br>"))


class Agreement(unittest.TestCase):
    def test_framed_cells_are_in_the_text(self):
        for before in (1, 3.8, 3.95, -9, None):
            for after in (0.5, -3.95, math.pi, None):
                d = bare("unknown_effect") | {"where_threshold": 3.9, "cells": [cell("top_force", "load", 10, before, after),
                                                                               cell("mean_force", "load", 10, 0.1, 0.1)]}
                framed = sum(map(number_of_framed, values_of(d)["where"]["panels"]))
                self.assertNotEqual("no single value" in where_line(of(d)), framed > 0, (before, after))


if __name__ == "__main__":
    unittest.main()
