"""The page of a diagnosis, and what is printed and written beside diagnosis.json."""
import contextlib
import io
import json
import os
import pathlib
import re
import tempfile
import unittest
import unittest.mock

from diagnosis_samples import VERDICTS, bare, of, sample, with_texts
from page_markup import Tags, content_of, markup_of, tables_of

from mcdem.errors import InputError, RunError
from mcdem.report.diagnosis import read_diagnosis
from mcdem.report.diagnosis_page import add_diagnosis, write_diagnosis_page
from mcdem.report.diagnosis_text import diagnosis_text
from mcdem.report.page import Page
from mcdem.report.present_diagnosis import present
from mcdem.report.verdict import verdict_words

NUMBERS = (
    "p = 0.004", "p = 0.013", "p = 0.002", "0.264 ± 0.024 mJ/m²", "0.332 ± 0.052", "37 %", "71 %", "18.2",  # causes
    "0.08 mJ/m²", "4 kg/m³", ">not detectable<", "85 %",  # limits
    "413", "140", "0.874", "0.991", "0.812", "0.143", "0.421", "0.187", "0.0312", "0.0089",  # gap before and after
    "66 %", "51 to 78 %", "12 %", "64 %", "+0.18 ± 0.12 kPa", "± 0.5 kPa", "-0.021 ± 0.014",  # parameters
    "1834 s", "hydrogel.toml", "5f70bf18a086007016e948b04aed3b82103a36bea41755b6cddfaf10ace3c6ef")


def page_of(d, name=""):
    page = Page("diagnosis")
    add_diagnosis(page, of(d), name)
    return page.html("library")


class PageOfDiagnosis(unittest.TestCase):
    def test_charts(self):
        content = content_of(page_of(sample("group")))
        self.assertEqual([chart["id"] for chart in content["charts"]], ["where", "which", "how_far", "gap_left"])

    def test_all_numbers(self):
        d = sample("group")
        page = page_of(d, "out/diagnosis")
        strongest = max(d["where"], key=lambda one: abs(one["z_score"]))
        first, last = strongest["displacement_mm"]
        for number in (*NUMBERS, f"{strongest['z_score']:.1f}", f"{first} to {last} mm"):
            self.assertIn(number, markup_of(page))
        for words in ("<li>forces on the side walls: would tell", "<li>diameters of single grains", "unloading, and loading",
                      ": out/diagnosis</p>"):
            self.assertIn(words, page)

    def test_gains_and_metrics_are_in_their_columns(self):
        d = sample("effect")
        tables = tables_of(page_of(d))
        head, row = tables["Effects consistent with the gap"]
        self.assertEqual(row[head.index("gain in log likelihood"):][:2], [f"{d['causes'][0]['score']:.1f}", "44.1"])
        self.assertEqual(head[head.index("gain in log likelihood") + 1], "gain in full simulations")
        shrink = d["shrink"]
        names = {"Rtop": "1", "errf [N]": "0", "errZ": "0", "bhat": "0"}  # perfect
        self.assertEqual(tables["Before and after"], [
            ["", "before", "after", "perfect"], ["gap, noise subtracted", *(f"{shrink[key]:.3g}" for key in ("before", "after")), "0"],
            *([name, *(f"{value:.3g}" for value in shrink["metrics"][name.split()[0]]), best] for name, best in names.items())])

    def test_hostile_texts_are_shown_and_not_executed(self):
        hostile = "<script>alert(1)</script>\"'&`touch pwned1`'; system('touch pwned2') %s%n \\ \x01"
        page = page_of(with_texts(sample("effect"), hostile), hostile)
        self.assertNotIn("<script>alert", page)
        self.assertRegex(page, "&lt;script&gt;alert\\(1\\)&lt;/script&gt;&#34;&#39;&amp;`touch pwned1`")
        self.assertTrue(Tags(page).is_balanced)

    def test_every_verdict_has_a_page_also_without_charts(self):
        headings = set()
        for verdict in VERDICTS:
            page = page_of(sample(verdict))
            self.assertTrue(Tags(page).is_balanced)
            headings.add(re.search("<h1>([^<]*)", page)[1])
            empty = page_of(bare(verdict))
            self.assertTrue(Tags(empty).is_balanced)
            self.assertEqual(content_of(empty)["charts"], [])
            self.assertEqual("What comes nearest" in page, verdict == "unknown_effect")
        self.assertEqual(len(headings), len(VERDICTS))

    def test_long_lists_are_cut(self):
        d = sample("effect")
        d["where"] = (d["where"] * 25)[:25]
        self.assertIn("and 5 more, in diagnosis.json", page_of(d))


class Presented(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def write(self, d):
        (self.folder / "diagnosis.json").write_text(json.dumps(d, indent=2) + "\n")

    def presented(self, **wanted):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            present(self.folder, **wanted)
        return out.getvalue()

    def names(self):
        return {file.name for file in self.folder.iterdir()}

    def test_text_page_and_figures(self):
        self.write(sample("effect"))
        printed = self.presented()
        figures = ("where", "which", "how_far", "law")
        files = ["diagnosis.json", "diagnosis.html", *(f"{name}.png" for name in figures)]
        text = diagnosis_text(read_diagnosis(self.folder / "diagnosis.json"))
        self.assertEqual(printed, text + "\nwrote\n" + "".join(f"  {self.folder / name}\n" for name in files))
        self.assertEqual(self.names(), {*files, "figures.json", *(f"{name}.{kind}" for name in figures for kind in ("pdf", "svg"))})

    def test_a_page_that_cannot_be_made_costs_nothing_else(self):
        self.write(sample("effect"))
        missing = ModuleNotFoundError("No module named 'plotly'", name="plotly")
        told = io.StringIO()
        with unittest.mock.patch("mcdem.report.diagnosis_page.write_diagnosis_page", side_effect=missing), contextlib.redirect_stderr(told):
            printed = self.presented()
        self.assertIn("which.png", printed)
        self.assertNotIn("diagnosis.html", printed)
        self.assertRegex(told.getvalue(), "^mcdem: no page: the Python package plotly is not there .*install python3-plotly")

    def test_only_what_is_wanted(self):
        self.write(sample("no_gap"))
        self.assertTrue(self.presented(page=False, figures=False).endswith(f"\nwrote\n  {self.folder}/diagnosis.json\n"))
        self.assertEqual(self.names(), {"diagnosis.json"})

    def test_the_sentence_is_added_where_it_is_documented(self):
        d = sample("group")
        self.write(d)
        self.presented(page=False, figures=False)
        written = json.loads((self.folder / "diagnosis.json").read_text())
        self.assertEqual(written["sentence"], verdict_words(of(d)).sentence)
        keys = list(written)
        self.assertEqual(keys[keys.index("seconds") + 1], "sentence")
        del written["sentence"]
        self.assertEqual(written, d)

    def test_files_of_others_are_not_replaced(self):
        self.write(sample("no_gap"))
        (self.folder / "diagnosis.html").write_text("mine")
        with self.assertRaisesRegex(InputError, "diagnosis.html: is not a page of mcdem"):
            self.presented(figures=False)
        self.assertEqual((self.folder / "diagnosis.html").read_text(), "mine")

    def test_invalid_files_are_refused(self):
        (self.folder / "diagnosis.json").write_text("{}")
        with self.assertRaisesRegex(InputError, "diagnosis.json: must be a diagnosis.json"):
            self.presented()
        os.unlink(self.folder / "diagnosis.json")
        with self.assertRaises(OSError):
            self.presented()

    def test_a_page_needs_a_folder(self):
        with self.assertRaises(RunError):
            write_diagnosis_page(of(sample("no_gap")), "/nonexistent/folder/page.html")


if __name__ == "__main__":
    unittest.main()
