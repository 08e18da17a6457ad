"""Tables, labels and CSV of runs with known results. tables_test.py"""
import math
import re
import unittest
from dataclasses import replace

import numpy as np
import synthetic
from synthetic import Law, changed, rows, stopped, with_parameters

from mcdem.errors import InputError
from mcdem.observe.compare import Comparison
from mcdem.observe.estimate import Estimate
from mcdem.observe.model_table import model_table
from mcdem.observe.replicas import Setting, group_by_setting
from mcdem.report.csv_text import csv_of
from mcdem.report.estimate_text import rate_note, with_error
from mcdem.report.labels import one_line, shortened, stress_unit, styles_of, three_digits, words_for
from mcdem.report.run_tables import csv_of_models, table_of_comparisons, table_of_energies, table_of_models, table_of_scaling
from mcdem.report.scan_tables import csv_of_scans, tables_of_scans
from mcdem.report.text_table import Column, TextTable, to_text

NAN = math.nan
NAME, F = Column("name", "left"), Column("F")


class Texts(unittest.TestCase):
    def test_table(self):
        self.assertEqual(to_text(TextTable([NAME, F], [["φ", "1.5"], ["long name", "10 ± 2"]], ["a note"])),
                         "name            F\n─────────  ──────\nφ             1.5\nlong name  10 ± 2\n\n  a note\n")
        self.assertEqual(to_text(TextTable([NAME, F], [["a|b", "1"]], ["a note"]), markdown=True),
                         "| name |   F |\n| :--- | --: |\n| a\\|b |   1 |\n\n- a note\n")
        self.assertIn("a [31m b\n", to_text(TextTable([NAME], [["a\x1b[31m\nb"]])))

    def test_with_error(self):
        for estimate, decimals, unit, text in (
                (Estimate(0.43, 0.0123), 2, 1, "0.43 ± 0.01"), (Estimate(0.004), 2, 1e-3, "4.00"), (Estimate(), 2, 1, "–"),
                (Estimate(0.0523), 2, 1, "0.052"), (Estimate(3.021e-8, 4.2e-10), 2, 1, "3.02e-08 ± 4.2e-10"),
                (Estimate(0.001, 0.22), 2, 1, "0.00 ± 0.22"), (Estimate(0.0), 2, 1, "0.00"), (Estimate(math.inf, 1.0), 2, 1, "–")):
            self.assertEqual(with_error(estimate, decimals, unit), text)

    def test_labels(self):
        for label, words in (("mc_dem", "MC-DEM"), ("mc_dem, gamma = 1.2", "MC-DEM, gamma = 1.2"), ("elastic_sphere", "Elastic sphere"),
                             ("gamma = 1", "gamma = 1"), ("mc_demented", "mc_demented"), ("", ""), ("mc_dem\n, x", "mc_dem , x")):
            self.assertEqual(words_for(label), words)
        self.assertEqual(one_line("a\nb\x1b[2Jc\td\x7f⟨Z⟩"), "a b [2Jc d ⟨Z⟩")
        for value, text in ((0.01234, "0.0123"), (99.94, "99.9"), (999.9, "1000"), (-5881, "-5880"), (1000, "1000"), (2.5e7, "2.5e+07"),
                            (NAN, "nan")):
            self.assertEqual(three_digits(value), text)
        self.assertEqual([shortened(text, 4) for text in ("φφφφ", "φφφφφ", "abc")], ["φφφφ", "φφφ…", "abc"])
        self.assertEqual([stress_unit(p).name for p in (9e3, 1e4, 1e7)], ["Pa", "kPa", "MPa"])

    def test_styles(self):
        def colours(*labels):
            settings = [Setting(label, [synthetic.recording(model=label)]) for label in labels]
            return [style.colour for style in styles_of(settings)]

        self.assertEqual(colours("mc_dem", "independent"), ["#D55E00", "#0072B2"])
        self.assertEqual(colours("mc_dem", "mc_dem"), ["#0072B2", "#56B4E9"])
        self.assertEqual(len(set(colours(*["mc_dem"] * 7))), 7)
        many = colours(*["mc_dem"] * 40)
        self.assertEqual((len(set(many)), many[0], many[-1]), (40, "#440154", "#c8e020"))

    def test_csv_starts_no_formula(self):
        for cell, field in (("=1+1", "'=1+1"), (' "@x', '"\' ""@x"'), ("-0.5", "-0.5"), ("+1e-3", "+1e-3"), ("-x", "'-x"), ("a,b", '"a,b"'),
                            ("--1", "'--1"), ("+inf", "'+inf"), ("a\nb", "a b"), (-0.1, "-0.1"), (3, "3"), (NAN, "")):
            self.assertEqual(csv_of(["b"], [[cell, "x"]]), f"b\n{field},x\n")

    def test_rate_note(self):
        self.assertEqual(rate_note(False, 0.004), "error of forces by the plate's speed: at most 0.4 % in the mean over packings, 7.4 % in "
                                                  "95 % of single scans (estimate)")
        self.assertTrue(rate_note(True, 1.234).startswith("error of stresses by the strain rate: at most 123 % in the mean over packings (e"))
        self.assertTrue(rate_note(True, 0.021).endswith("`mcdem converge` measures it"))


class Runs(unittest.TestCase):
    def models(self, laws, replicas, change=lambda one, number: one):
        run = synthetic.run(laws, replicas)
        settings = group_by_setting(replace(run, recordings=tuple(change(one, number) for number, one in enumerate(run.recordings))))
        return to_text(table_of_models(model_table(settings))), csv_of_models(model_table(settings), settings)

    def test_models(self):
        laws = [Law(model="independent", top=6.45), Law()]
        text, _ = self.models(laws, 2)
        for words in ("top force at 30.00 mm [N]", "over MC-DEM", "0.430 ± 0.000"):
            self.assertIn(words, text)
        self.assertNotIn("stopped early", text)
        self.assertIn("stopped early", self.models(laws, 2, lambda one, k: one if k else stopped(one, 3))[0])

    def test_a_setting_that_stopped_is_marked(self):
        text, _ = self.models([Law(model="independent", top=6.45), Law()], 1, lambda one, k: stopped(one, 6) if k else one)
        self.assertRegex(text, r"MC-DEM +[0-9.]+ \* at 18\.00 mm +1\.000 +1 +1")
        self.assertIn("*: no replica reached full stroke", text)

    def test_scans_beyond_the_range_of_a_law_are_marked(self):
        text, _ = self.models([Law(model="elastic_sphere", levels=2)], 1,
                              lambda one, k: changed(one, max_overlap=np.array([0.05, 0.15, 0.05, 0])))
        self.assertIn("Elastic sphere: from 30.00 mm on, overlaps exceed the tested range of the contact model (0.10 of the sum of two "
                      "radii) and reach 0.15; numerics.stop_beyond_law = true stops the run there", text)

    def test_csv_has_a_column_for_each_key_that_differs(self):
        _, text = self.models([Law(top=12.0)], 2, lambda one, k: with_parameters(one, contact__gamma=("1", "1.125")[k], name='"same"'))
        self.assertEqual(text, "setting,contact.gamma,displacement_mm,top_force_N,standard_error_N,over,ratio,ratio_standard_error,"
                               "replicas,stopped_early\ngamma=1,1,30,12,,gamma=1,1,,1,0\ngamma=1.125,1.125,30,12,,gamma=1,1,,1,0\n")

    def test_comparisons(self):
        one = Comparison("mc_dem", Estimate(1, 0.004), Estimate(0.41, 0.02), Estimate(0.26, 0.01), Estimate(4e-3, 1e-4),
                         Estimate(0.0098, 0.0004), levels_errf=50, reference_levels=60)
        self.assertIn("MC-DEM       1.000 ± 0.004  0.41 ± 0.02  0.26 ± 0.01  0.98 ± 0.04  4.00 ± 0.10  50 of 60",
                      to_text(table_of_comparisons([one])))
        table = table_of_comparisons([Comparison("independent", notes=["shared", "its own"]), Comparison("mc_dem", notes=["shared"])])
        self.assertEqual(table.notes[:-1], ["shared", "Independent contacts: its own"])

    def test_scaling(self):
        table = table_of_scaling(group_by_setting(synthetic.run([Law()], 1)))
        self.assertEqual([re.sub("-0.000", "0.000", " ".join(row)) for row in table.rows],
                         ["MC-DEM load 150.0 1.0000 0.000 10", "MC-DEM unload 150.0 1.0000 0.000 10"])

    def test_energies(self):
        one = synthetic.recording(levels=2)
        values = {"elastic_energy": [1, 4, 2, 0], "wall_work": [1, 5, 3, 1], "friction_loss": [0, 0.5, 1, 1], "energy_error": [0, 1e-5, 0, 0]}
        one = changed(one, **{name: np.array(value) * 1e-3 for name, value in values.items()})
        other = changed(one, energy_error=np.full(4, NAN))
        table = table_of_energies([Setting("mc_dem", [one, other]), Setting("x", [other])])
        self.assertEqual(table.rows, [["MC-DEM", "5", "nan", "4", "0", "nan", "0.5", "nan", "1e-05"]])


class Scans(unittest.TestCase):
    def held_plate(self):
        return with_parameters(synthetic.recording(levels=2), **{"programme__1__stage": '"hold"'})

    def titles(self, table):
        return [column.title for column in table.columns]

    def test_cells(self):
        table, = tables_of_scans([Setting("mc_dem", [synthetic.cell("mc_dem"), synthetic.cell("mc_dem", 2, 3)])])
        self.assertEqual(self.titles(table), ["model", "scan", "phase", "time [s]", "strain [%]", "shear xz [%]", "φ", "p [kPa]", "q [kPa]",
                                              "Z"])
        self.assertEqual(table.rows[2], ["MC-DEM", "2", "load", "2.500", "2.00 ± 0.00", "10.00 ± 0.00", "0.6200 ± 0.0000",
                                         "11.76 ± 5.88", "2.04 ± 1.02", "6.00 ± 0.00"])
        self.assertIn("error of stresses by the strain rate: at most 0.4 % in the mean over packings (estimate)", table.notes)
        one = synthetic.cell("mc_dem")
        one.scans.strain[1, 2] = 0.05
        self.assertEqual(self.titles(tables_of_scans([Setting("mc_dem", [one])])[0])[4:8],
                         ["strain x [%]", "strain y [%]", "strain z [%]", "shear xz [%]"])

    def test_plates_and_cells_are_apart(self):
        both = [Setting("cell", [synthetic.cell("mc_dem")]), Setting("plate", [self.held_plate()])]
        plates, _ = tables_of_scans(both)
        self.assertEqual(self.titles(plates)[4:], ["displacement [mm]", "top force [N]", "Z"])
        self.assertEqual(len(plates.rows), 4)
        with self.assertRaisesRegex(InputError, "cells and plates have different columns"):
            csv_of_scans(both)

    def test_notes(self):
        broken = stopped(synthetic.cell("elastic_sphere", 2), 3)
        broken.scans.max_overlap[:] = [0.05, 0.12, 0.14]
        table, = tables_of_scans([Setting("elastic_sphere", [synthetic.cell("elastic_sphere"), broken])])
        self.assertEqual((self.titles(table)[-1], [row[-1] for row in table.rows]), ("replicas", ["2", "2", "2", "1"]))
        self.assertIn("Elastic sphere: 1 of 2 stopped early, the first after 3 scans: overlap past the limit", table.notes)
        self.assertIn("Elastic sphere: from scan 1 on, overlaps exceed the tested range of the contact model (0.10 of the sum of two radii)"
                      " and reach 0.14; numerics.stop_beyond_law = true stops the run there", table.notes)

    def test_csv(self):
        one, other = (rows(synthetic.cell(model), slice(1)) for model in ("mc_dem", "independent"))
        head, first, second = csv_of_scans([Setting("mc_dem", [one]), Setting("independent", [other])]).splitlines()
        self.assertTrue(head.startswith("setting,contact.model,frame,cycle,phase,time_s,strain_x,strain_x_standard_error,strain_y,"))
        self.assertTrue(head.endswith("q_Pa_standard_error,coordination_number,coordination_number_standard_error,replicas"))
        self.assertTrue(first.startswith("mc_dem,mc_dem,0,0,load,0.5,0.01,,0.01,,0.01,,0,,"))
        self.assertTrue(second.startswith("independent,independent,0,0,load,0.5,") and second.endswith(",6,,1"))


if __name__ == "__main__":
    unittest.main()
