"""Figures of a convergence study, of a what-if table and of a challenge have the values of figures.json. other_figures_test.py PROGRAM"""
import json
import pathlib
import shutil
import sys
import tempfile
import unittest

import drawn
import matplotlib.pyplot as plt
import numpy as np
from drawn import figures
from matplotlib.colors import to_rgba

VALUES = {
    "mcdem_figures": 1,
    "convergence": {
        "x_label": "error / limit",
        "causes": [{"words": "plate speed", "colour": "#0072B2", "marker": "s"}, {"words": "time step", "colour": "#D55E00", "marker": "o"}],
        "rows": [{"observable": "top_force", "words": "top force", "errors": [{"over_limit": 2, "standard_error": 0.25}, None]},
                 {"observable": "mean_force", "words": "mean force", "errors": [{"over_limit": -30, "standard_error": 0.5},
                                                                               {"over_limit": 0.5, "standard_error": None}]}]},
    "what_if": {
        "x_label": "change", "y_label": "top force [N]", "target": 3.0, "top_force": 3.0, "displacement": [1, 2], "scene_force": [1, 2],
        "measured": None, "series": [
            {"words": "stiffer", "colour": "#0072B2", "marker": "s", "change": [0, 50], "target": [2, 3], "is_met": True, "found": [50, 3],
             "force": [1.5, 3]},
            {"words": "rougher", "colour": "#D55E00", "marker": "o", "change": [0, 900], "target": [2, None], "is_met": False,
             "found": [0, 2], "force": [1, None]}]},
    "confusion": {"truths": ["no gap", "adhesion"], "verdicts": ["no gap", "adhesion", "unknown effect"],
                  "cases": [[9, 1, 0], [2, 3, 5]], "right": [[0, 0], [1, 1]]},
    "power": {"x_label": "amplitude", "y_label": "detected",
              "measured": {"x": [0.5, 2], "part": [0.1, 1], "interval": [[0.02, 0.3], [0.8, 1]], "cases": [20, 31]},
              "predicted": {"x": [0.4, 1, 3], "part": [0.1, 0.8, 1]}, "words_predicted": "as predicted"},
    "confidence": {"x_label": "stated", "y_label": "right",
                   "measured": {"x": [0.9], "part": [0.75], "interval": [[0.5, 0.9]], "cases": [12]},
                   "predicted": {"x": [0, 1], "part": [0, 1]}, "words_predicted": "as stated"}}


def setUpModule():
    global folder
    folder = pathlib.Path(tempfile.mkdtemp())
    unittest.addModuleCleanup(shutil.rmtree, folder)
    unittest.addModuleCleanup(plt.close, "all")
    (folder / "figures.json").write_text(json.dumps(VALUES))


class WhatIf(unittest.TestCase):
    def test_trials_solutions_and_curves_are_drawn(self):
        left, right = figures.what_if(folder)
        self.assertEqual(left.get_ylabel(), "top force [N]")
        level, *lines = left.lines
        self.assertEqual(list(level.get_ydata()), [3, 3])
        np.testing.assert_array_equal([line.get_xydata()[-1] for line in lines], [[50, 3], [50, 3], [900, np.nan], [0, 2]])
        self.assertEqual([line.get_markerfacecolor() for line in lines[1::2]], ["#0072B2", "white"], "open where the target is not met")
        curves = [line.get_ydata() for line in right.lines]
        np.testing.assert_array_equal(curves[:3], [[1, 2], [1.5, 3], [1, np.nan]])
        self.assertEqual(right.lines[3].get_xydata().tolist(), [[2, 3]], "the target, without an experiment")
        self.assertEqual(drawn.words_of(right), ["scene", "stiffer", "rougher", "target"])


class Convergence(unittest.TestCase):
    def setUp(self):
        self.axes = figures.convergence(folder)

    def points(self, colour, marker):
        return [line.get_xydata()[0] for line in self.axes.lines
                if len(line.get_xdata()) == 1 and line.get_color() == colour and line.get_marker() == marker]

    def test_errors_with_two_standard_errors(self):
        speed, step = self.points("#0072B2", "s"), self.points("#D55E00", "o")
        np.testing.assert_allclose([x for x, _ in speed], [2, -3.95])  # outliers are drawn at the edge
        self.assertEqual([round(y) for _, y in speed + step], [0, 1, 1])
        self.assertEqual([x for x, _ in step], [0.5])
        bars = [line.get_xdata() for line in self.axes.lines if len(line.get_xdata()) == 2]
        np.testing.assert_allclose(bars[0], (1.5, 2.5))

    def test_words(self):
        self.assertEqual(drawn.words_of(self.axes), ["plate speed", "time step", "within the limit"])
        self.assertEqual([text.get_text() for text in self.axes.get_yticklabels()], ["top force", "mean force"])
        shaded = self.axes.patches[0].get_xy()
        self.assertEqual((shaded[:, 0].min(), shaded[:, 0].max()), (-1, 1))


class Challenge(unittest.TestCase):
    def test_confusion_counts_cases_and_frames_right_answers(self):
        axes = figures.confusion(folder)
        found = {text.get_position()[::-1]: text.get_text() for text in axes.texts}
        self.assertEqual(found, {(0, 0): "9", (0, 1): "1", (1, 0): "2", (1, 1): "3", (1, 2): "5"})
        np.testing.assert_allclose(axes.images[0].get_array(), [[0.9, 0.1, 0], [0.2, 0.3, 0.5]])
        frames = [np.round(np.array(box.get_xy()) + (box.get_width() / 2, box.get_height() / 2)).tolist() for box in axes.patches]
        self.assertEqual(frames, [[0, 0], [1, 1]])
        self.assertEqual([text.get_text() for text in axes.get_xticklabels()], VALUES["confusion"]["verdicts"])

    def expect_proportions(self, axes, values):
        measured = values["measured"]
        x, low, high = drawn.bars_of(axes, to_rgba("#0072B2"))
        np.testing.assert_allclose(x, measured["x"])
        np.testing.assert_allclose(np.array([low, high]).T, measured["interval"])
        np.testing.assert_allclose(drawn.lines_of(axes, "#0072B2", "None")[0], (measured["x"], measured["part"]))
        np.testing.assert_allclose(drawn.lines_of(axes, "#666666", "-")[0], (values["predicted"]["x"], values["predicted"]["part"]))
        self.assertEqual([text.get_text() for text in axes.texts], [str(cases) for cases in measured["cases"]])
        self.assertEqual(drawn.words_of(axes), ["measured, 95 % interval, cases", values["words_predicted"]])

    def test_power(self):
        axes = figures.power(folder)
        self.expect_proportions(axes, VALUES["power"])
        self.assertEqual(axes.get_xscale(), "log")

    def test_confidence(self):
        self.expect_proportions(figures.confidence(folder), VALUES["confidence"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
