"""Figures of a diagnosis have the values of diagnosis.json. diagnosis_figures_test.py PROGRAM"""
import json
import pathlib
import shutil
import tempfile
import unittest

import drawn
import matplotlib.pyplot as plt
import numpy as np
from drawn import figures
from matplotlib.patches import Rectangle

from report.diagnosis_samples import bare, cause, cell, contact_law

THRESHOLD = 4
LIMIT = 1e-3
ORDER = [("load", 2.5), ("load", 5), ("load", 10), ("unload", 5), ("unload", 2.5)]  # from left to right
OBSERVABLES = {"top_force": "top force", "mean_force": "mean force", "non_affine": "non-affine displacement"}
FORCES = [{"displacement_mm": d, "experiment_N": d * d, "before_N": d, "after_N": d + 1} for d in range(6)]
NAMED, OTHER = "#D55E00", "#6F9BBF"
PROGRAM = ""


def candidate(effect, score, group, amplitude, confirmed):
    return cause(effect, amplitude, 2e-4, "N", group, confidence=0.81, explained=0.5, score=score, confirmed_score=confirmed)


def diagnosis():
    """As written by `mcdem diagnose`: two indistinguishable effects, one of them simulated."""
    score = np.random.default_rng(1).normal(0, 3.5, (len(OBSERVABLES), len(ORDER)))
    cells = [cell(name, phase, at, score[row][column], score[row][column] / 2)
             for row, name in enumerate(OBSERVABLES) for column, (phase, at) in reversed(list(enumerate(ORDER)))]
    pair = ["adhesion", "friction"]
    ranking = [candidate("adhesion", 9.5, pair, 5e-3, 8), candidate("friction", 8.2, pair, 2e-3, None),
               candidate("plate_tilt", -0.4, [], 1e-3, None)]
    return bare("group") | {
        "causes": ranking[:2], "ranking": ranking, "cells": cells, "where_threshold": THRESHOLD,
        "shrink": {"held_out": "unloading", "before": 9, "after": 1, "fraction": 0.7, "interval": [0.6, 0.9], "placebo": 0.05,
                   "metrics": {}, "confirmed": 0.65, "fitted_displacement_mm": [0, 3], "top_force": FORCES},
        "detection_limits": [{"effect": name, "minimum_amplitude": LIMIT, "absorbed_by_calibration": 0, "unit": "N", "group": []}
                             for name in pair],
        "contact_laws": [contact_law("load", 5, 1.7), contact_law("load", 10, 1.6), contact_law("unload", 10, 1.5),
                         contact_law("unload", 5, 1.4), contact_law("unload", 2.5, 1.3)]}


def setUpModule():
    global folder, mcdem, written
    folder = pathlib.Path(tempfile.mkdtemp())
    unittest.addModuleCleanup(shutil.rmtree, folder)
    mcdem = drawn.Program(PROGRAM, folder)
    written = diagnosis()
    (folder / "diagnosis.json").write_text(json.dumps(written))
    mcdem("figures", "diagnosis.json", "--out", "figures")


def boxes(axes, filled):
    return [box for box in axes.patches if isinstance(box, Rectangle) and box.get_fill() == filled]


class Where(unittest.TestCase):
    def setUp(self):
        self.axes = figures.where(folder / "figures")
        self.addCleanup(plt.close, "all")

    def test_every_cell_has_its_place_and_its_colour(self):
        from mcdem.figures.diagnosis import BELOW_ABOVE
        for axes, score in zip(self.axes, ("z_score", "z_score_refitted")):
            found = {}
            for box in boxes(axes, True):
                found[round(box.get_y() + box.get_height() / 2), box.get_x()] = box.get_facecolor()
            self.assertEqual(len(found), len(written["cells"]))
            left = sorted({x for _, x in found})
            most = max(abs(cell["z_score"]) for cell in written["cells"])
            reach = min(max(np.ceil(most), 6), 8)
            for cell in written["cells"]:
                column = ORDER.index((cell["phase"], cell["displacement_mm"]))
                colour = found[list(OBSERVABLES).index(cell["observable"]), left[column]]
                self.assertEqual(colour, BELOW_ABOVE((cell[score] / reach + 1) / 2))

    def test_what_stands_out_is_framed_and_has_its_number(self):
        for axes, score in zip(self.axes, ("z_score", "z_score_refitted")):
            beyond = sorted(f"{cell[score]:.1f}" for cell in written["cells"] if abs(cell[score]) >= THRESHOLD)
            self.assertEqual(len(boxes(axes, False)), len(beyond))
            self.assertEqual(sorted(text.get_text() for text in axes.texts if text.get_text()[-1].isdigit()), beyond)
        self.assertTrue(boxes(self.axes[0], False))

    def test_words(self):
        texts = drawn.texts_of_svg(folder / "figures/where.svg")
        for words in (*OBSERVABLES.values(), "as stated", "after recalibration", "loading →", "unloading →",
                      "plate displacement [mm]", "measured minus simulated [sigma of the noise]"):
            self.assertIn(words, texts)
        self.assertEqual([text.get_text() for text in self.axes[0].get_xticklabels()], ["2.5", "5", "10", "5", "2.5"])


class Which(unittest.TestCase):
    def setUp(self):
        self.gain, self.over_limit = figures.which(folder / "figures")
        self.addCleanup(plt.close, "all")

    def test_bars_are_gains_and_the_named_ones_stand_out(self):
        bars = boxes(self.gain, True)
        self.assertEqual([bar.get_width() for bar in bars], [row["score"] for row in written["ranking"]])
        self.assertEqual([round(bar.get_y() + bar.get_height() / 2) for bar in bars], [0, 1, 2])
        for bar, colour in zip(bars, (NAMED, NAMED, OTHER)):
            self.assertEqual(bar.get_facecolor(), drawn.matplotlib.colors.to_rgba(colour))

    def test_diamonds_are_simulated_in_full(self):
        diamonds = [line.get_xydata().tolist() for line in self.gain.lines if line.get_marker() == "D"]
        self.assertEqual(diamonds, [[[8, 0]]])

    def test_amplitudes_are_over_their_limits(self):
        dots = [line.get_xydata()[0] for line in self.over_limit.lines if line.get_marker() == "o"]
        np.testing.assert_allclose(dots, [[5, 0], [2, 1]])
        ends = [bars.get_segments()[0][:, 0] for bars in self.over_limit.collections]
        np.testing.assert_allclose(ends, [[5 - 0.2 * 1.6449, 5 + 0.2 * 1.6449], [2 - 0.2 * 1.6449, 2 + 0.2 * 1.6449]])

    def test_words(self):
        texts = drawn.texts_of_svg(folder / "figures/which.svg")
        for words in ("adhesion", "friction between grains", "tilt of the plate along x", "5.00 ± 0.20 mN", "81 %",
                      "gain in log likelihood", "fitted amplitude / detection limit"):
            self.assertIn(words, texts)
        self.assertEqual(texts.count("A"), 2)


class HowFar(unittest.TestCase):
    def setUp(self):
        self.axes = figures.how_far(folder / "figures")
        self.addCleanup(plt.close, "all")

    def test_forces(self):
        forces = self.axes[0]
        for key, colour, style in (("before_N", "#2B87C8", "--"), ("after_N", NAMED, "-"), ("experiment_N", "#222222", "None")):
            line, = drawn.lines_of(forces, colour, style)
            np.testing.assert_allclose(line, ([row["displacement_mm"] for row in FORCES], [row[key] for row in FORCES]))
        self.assertEqual(drawn.words_of(forces), ["experiment", "simulated before", "simulated with adhesion", "fitted here"])

    def test_bars_are_what_is_left_of_the_gap(self):
        bars = boxes(self.axes[1], True)
        np.testing.assert_allclose([bar.get_width() for bar in bars], [100, 30, 35, 95])
        interval, = [line.get_xdata() for line in self.axes[1].lines if line.get_marker() == "|"]
        np.testing.assert_allclose(interval, (10, 40))
        self.assertEqual([text.get_text() for text in self.axes[1].texts], ["100 %", "30 %", "35 %", "95 %"])

    def test_without_forces_there_are_bars_alone(self):
        poor = diagnosis()
        poor["shrink"]["top_force"] = []
        (folder / "poor.json").write_text(json.dumps(poor))
        mcdem("figures", "poor.json", "--out", "poor")
        self.assertEqual(len(figures.how_far(folder / "poor")), 1)


class Law(unittest.TestCase):
    def test_is_drawn_at_the_largest_displacement_and_at_the_end_of_unloading(self):
        axes = figures.law(folder / "figures")
        curves = [curve for curve in axes.lines if len(curve.get_xdata()) == 3]
        for curve, exponent in zip(curves, (1.6, 1.5, 1.3), strict=True):
            overlap = np.array([0.05, 0.1, 0.15])
            np.testing.assert_allclose(curve.get_xdata(), overlap)
            np.testing.assert_allclose(curve.get_ydata(), 100 * ((overlap / 0.1)**(exponent - 1.5) - 1), atol=1e-9)
        texts = [text.get_text() for text in axes.get_legend().get_texts()]
        self.assertEqual(texts[0], "loading, 10 mm: exponent 1.600 ± 0.020")
        self.assertEqual(texts[2], "unloading, 2.5 mm: exponent 1.300 ± 0.020")
        band = axes.collections[0].get_paths()[0].vertices[:, 1]
        self.assertAlmostEqual(band.max() - 100 * (1.5**0.1 - 1), 1.6449 * 3, places=6)


class Command(unittest.TestCase):
    def test_what_is_not_known_is_not_drawn(self):
        unknown = diagnosis() | {"cells": [cell("top_force", None, 1, None, None)], "shrink": None, "contact_laws": [],
                                 "ranking": [candidate("adhesion", None, [], None, None)]}
        (folder / "bare.json").write_text(json.dumps(unknown))
        self.assertEqual(mcdem("figures", "bare.json", "--out", "bare"), "bare/which.png\n")

    def test_a_diagnosis_stands_alone(self):
        done = mcdem.run("figures", "diagnosis.json", "run", "--out", "both")
        self.assertEqual(done.returncode, 2)
        self.assertIn("cannot be combined with other runs", done.stderr)

    def test_print_size(self):
        for name, width in (("where", 178), ("which", 178), ("how_far", 86), ("law", 86)):
            self.assertAlmostEqual(plt.imread(folder / f"figures/{name}.png").shape[1] / 300 / drawn.MILLIMETRE, width, delta=0.2)


if __name__ == "__main__":
    drawn.main()
