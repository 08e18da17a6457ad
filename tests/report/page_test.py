"""A page is one file that shows any text, runs only its own script and loads nothing."""
import base64
import gzip
import hashlib
import pathlib
import re
import tempfile
import unittest

import plotly.graph_objects as go
from page_markup import Tags, content_of, markup_of

from mcdem.errors import InputError, RunError
from mcdem.report.charts import plot_text
from mcdem.report.page import Chart, Page
from mcdem.report.text_table import Column, TextTable

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=\"alert('2')\"> & ' \" {{ 7 * 7 }} {% raw %} \x01\x1b[2J"


def filled_page(text):
    """A page with this text in all positions where a page has text."""
    page = Page(text)
    page.lead(text, text, text)
    page.section(text)
    page.subheading(text)
    page.paragraph(text)
    page.table(text, TextTable([Column(text, "left")], [[text]], [text]))
    page.list([text])
    page.definitions([(text, text)])
    page.folded(text, text + "\nsecond line")
    page.chart(Chart("a_chart", text, text, go.Figure(go.Scatter(name=text, x=[1], y=[float("nan")])), "xy"))
    page.packing({"settings": [{"label": text}]}, text)
    return page


class PageTest(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)

    def test_texts_are_shown_and_not_executed_in_any_position(self):
        page = filled_page(HOSTILE).html("library")
        self.assertTrue(Tags(page).is_balanced)
        for harm in ("<script>alert", "<img src=x", "\x1b"):
            self.assertNotIn(harm, markup_of(page))
        self.assertEqual(len(re.findall("<script", page)), 3, "content, library, the page's own script")
        self.assertEqual(len(re.findall("</script", page)), 3)
        shown = HOSTILE.replace("\x01", " ").replace("\x1b", " ")
        self.assertEqual(sum(text.strip() == shown for text in Tags(page).texts), 18)
        content = content_of(page)
        self.assertEqual(content["charts"][0]["data"][0]["name"], HOSTILE, "complete, as text")
        self.assertEqual(content["charts"][0]["data"][0]["y"], [None])
        self.assertEqual(content["packings"][0]["view"]["settings"][0]["label"], HOSTILE)

    def test_the_check_of_tags_finds_an_unclosed_one(self):
        self.assertFalse(Tags(filled_page("text").html("") + "</p>").is_balanced)
        self.assertFalse(Tags("<p><b></p></b>").is_balanced)
        self.assertFalse(Tags("<p>").is_balanced)

    def test_texts_of_charts_are_escaped(self):
        self.assertEqual(plot_text("<a href='x'>&y\n</a>"), "&lt;a href='x'&gt;&amp;y &lt;/a&gt;")

    def test_bytes_that_are_no_utf8_are_replaced(self):
        page = filled_page(b"M\xfcller".decode("utf-8", "surrogateescape")).html("")
        self.assertEqual(content_of(page)["charts"][0]["data"][0]["name"], "M\ufffdller")
        self.assertIn("<h2>M\ufffdller</h2>", page)

    def test_the_policy_allows_only_its_script_and_no_address(self):
        page = filled_page("text").html("library")
        script = page[page.rindex("<script>") + 8:page.rindex("</script>")]
        policy, = re.findall('Content-Security-Policy" content="([^"]*)', page)
        self.assertEqual(re.findall("'sha256-([^']*)'", policy), [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()])
        self.assertIn("default-src 'none'", policy)
        self.assertNotIn("http", policy)
        self.assertNotIn("script-src 'unsafe-inline'", policy)

    def test_no_other_files_are_loaded(self):
        page = filled_page("text").html("library")
        for loads in (" src=", " href=", "<link", "@import", "url(", "<iframe"):
            self.assertNotIn(loads, markup_of(page))
        self.assertNotIn("@import", page)
        self.assertIsNone(re.search(r"url\(|https?://|fetch\(|XMLHttp", page))

    def test_charts_with_the_same_name_have_unique_ids(self):
        page = Page("three")
        for _ in range(3):
            page.chart(Chart("where", "", ""))
        self.assertEqual([chart["id"] for chart in content_of(page.html(""))["charts"]], ["where", "where_2", "where_3"])
        for place in ("where", "where_2", "where_3"):
            self.assertIn(f'id="{place}"', page.html(""))

    def test_only_charts_with_other_axes_have_a_button_for_them(self):
        page = Page("two")
        page.chart(Chart("plain", "", ""))
        page.chart(Chart("steep", "", "", log_axes="y"))
        self.assertEqual(re.findall('data-log="([^"]*)', page.html("")), ["steep"])
        self.assertEqual(re.findall('data-svg="([^"]*)', page.html("")), ["plain", "steep"])

    def test_charts_have_the_style_of_the_page(self):
        page = Page("one")
        page.chart(Chart("plain", "", "", go.Figure(layout={"xaxis": {"rangemode": "tozero"}, "yaxis2": {"showline": False}}), height=300))
        layout = content_of(page.html(""))["charts"][0]["layout"]
        self.assertEqual(layout["xaxis"]["gridcolor"], "var(--grid)")
        self.assertEqual(layout["xaxis"]["rangemode"], "tozero")
        self.assertEqual((layout["yaxis2"]["showline"], layout["height"]), (False, 300))
        self.assertNotIn("template", layout)

    def test_line_breaks_of_long_texts_are_kept(self):
        page = Page("scene")
        page.folded("The scene", "[box]\nsize_x = 1\t# <wide>\n")
        self.assertIn("<pre>[box]\nsize_x = 1 # &lt;wide&gt;\n", page.html(""))

    def test_parts_without_content_are_left_out(self):
        page = Page("empty")
        page.table("nothing", TextTable([Column("a")], [], ["a note"]))
        page.list([])
        for part in ("nothing", "a note", "<ul>"):
            self.assertNotIn(part, page.html(""))

    def test_the_plotting_library_is_in_the_page(self):
        file = self.folder / "page.html"
        filled_page("text").write(file)
        page = file.read_text("utf-8")
        library = gzip.decompress(base64.b64decode(re.search(r'(?s)id="library">(.*?)</script>', page)[1]))
        self.assertIn(b"plotly.js", library[:200])
        self.assertLess(file.stat().st_size, 4_000_000)

    def test_only_pages_of_mcdem_are_replaced(self):
        file, page = self.folder / "page.html", Page("text")
        page.html = lambda: filled_page("text").html("library")
        page.write(file)
        page.write(file)
        file.write_text("<!doctype html> of somebody")
        with self.assertRaisesRegex(InputError, "is not a page of mcdem; it is not replaced"):
            page.write(file)
        with self.assertRaisesRegex(RunError, "no/folder/page.html: cannot be written: No such file"):
            page.write(self.folder / "no/folder/page.html")


if __name__ == "__main__":
    unittest.main()
