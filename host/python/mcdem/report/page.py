"""A page with charts: one self-contained HTML file without network access. Texts are escaped by Jinja2 (page.html.jinja)."""
import base64
import functools
import gzip
import hashlib
import json
import pathlib
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import jinja2
import plotly.graph_objects as go
import plotly.offline
from plotly.utils import PlotlyJSONEncoder

from ..outputs import PAGE, replace_own
from .labels import one_line
from .text_table import TextTable

HERE = pathlib.Path(__file__).parent
CLEAR, FONT = "rgba(0,0,0,0)", "system-ui, sans-serif"

# Of every chart. Colours "var(--ink)" are those of the page's present theme (page.css, page.js).
LAYOUT: dict[str, Any] = {
    "margin": {"l": 60, "r": 16, "t": 24, "b": 48}, "paper_bgcolor": CLEAR, "plot_bgcolor": CLEAR, "hovermode": "closest",
    "modebar": {"bgcolor": CLEAR, "color": "var(--line)", "activecolor": "var(--ink)"},
    "font": {"family": FONT, "size": 13, "color": "var(--ink)"},
    "hoverlabel": {"bgcolor": "var(--card)", "bordercolor": "var(--line)", "align": "left", "font": {"color": "var(--ink)"},
                   "namelength": -1}}
AXIS = {"gridcolor": "var(--grid)", "linecolor": "var(--axis)", "tickcolor": "var(--axis)", "showline": True, "zeroline": False,
        "automargin": True}


@dataclass(frozen=True)
class Chart:
    """A chart under its title. `name` is one word, `log_axes` the axes with a button for a logarithmic scale: "y", "xy" or none;
    `height` and `min_width` are in pixels, narrower screens scroll."""
    name: str
    title: str
    caption: str
    figure: go.Figure = field(default_factory=go.Figure)
    log_axes: str = ""
    height: int = 440
    min_width: int = 0


def dressed(layout: Mapping[str, Any]) -> dict[str, Any]:
    """A chart's layout in the style of pages."""
    axes = {key: {**AXIS, **axis} for key, axis in layout.items() if key.startswith(("xaxis", "yaxis"))}
    return {**LAYOUT, **{key: value for key, value in layout.items() if key != "template"}, **axes}


def json_for_page(content: Any) -> str:
    """JSON in which nothing can end the enclosing element; null for numbers that are not finite."""
    text = json.dumps(json.loads(json.dumps(content, cls=PlotlyJSONEncoder)), ensure_ascii=False, separators=(",", ":"))
    return re.sub("[<>&]", lambda found: f"\\u{ord(found[0]):04x}", text)


@functools.cache
def plotting_library() -> str:
    """plotly.js, compressed with gzip, in base64. The highest level of compression takes four times as long for 1 % less."""
    return base64.b64encode(gzip.compress(plotly.offline.get_plotlyjs().encode(), 6, mtime=0)).decode()


class Page:
    """Collects the parts of a page from top to bottom."""

    def __init__(self, title: str) -> None:
        self.title = one_line(title)
        self.parts: list[dict[str, Any]] = []
        self.charts: list[dict[str, Any]] = []
        self.packings: list[dict[str, Any]] = []
        self._names: Counter[str] = Counter()

    def _add(self, kind: str, **content: Any) -> None:
        self.parts.append({"kind": kind, **content})

    def lead(self, kicker: str, heading: str, sentence: str) -> None:
        """Head of the page, before the first section."""
        self._add("lead", kicker=one_line(kicker), heading=one_line(heading), sentence=one_line(sentence))

    def section(self, heading: str) -> None:
        self._add("h2", text=one_line(heading))

    def subheading(self, text: str) -> None:
        self._add("h3", text=one_line(text))

    def paragraph(self, text: str) -> None:
        self._add("p", text=one_line(text))

    def table(self, heading: str, table: TextTable) -> None:
        """A table under its heading; nothing if it has no rows."""
        if not table.rows:
            return
        if heading:
            self.subheading(heading)
        head, *rows = ([(one_line(cell), column.align == "left") for cell, column in zip(row, table.columns, strict=True)]
                       for row in ([column.title for column in table.columns], *table.rows))
        self._add("table", head=head, rows=rows, notes=[one_line(note) for note in table.notes])

    def list(self, texts: Sequence[str]) -> None:
        if texts:
            self._add("list", texts=[one_line(text) for text in texts])

    def definitions(self, lines: Iterable[tuple[str, str]]) -> None:
        self._add("definitions", lines=[(one_line(about), one_line(says)) for about, says in lines])

    def folded(self, heading: str, text: str) -> None:
        """A long text, collapsed under its heading."""
        self._add("folded", heading=one_line(heading), text="".join(one_line(line) + "\n" for line in text.split("\n")))

    def _new_id(self, name: str) -> str:
        """The name, with a number if it is repeated."""
        self._names[name] += 1
        return name if self._names[name] == 1 else f"{name}_{self._names[name]}"

    def chart(self, chart: Chart) -> None:
        drawn = chart.figure.to_plotly_json()
        place = self._new_id(chart.name)
        self.charts.append({"id": place, "log": chart.log_axes, "data": drawn["data"],
                            "layout": {**dressed(drawn["layout"]), "height": chart.height}})
        self._add("chart", id=place, title=one_line(chart.title), caption=one_line(chart.caption), log=chart.log_axes,
                  height=chart.height, min_width=chart.min_width)

    def packing(self, view: Mapping[str, Any], caption: str) -> None:
        """The 3D view of a packing (packing_view.py)."""
        place = self._new_id("packing")
        self.packings.append({"id": place, "view": view})
        self._add("packing", id=place, caption=one_line(caption))

    def html(self, library: str | None = None) -> str:
        """The complete file. `library`: as plotting_library() returns, which is the default."""
        script = "'use strict';\n" + "".join((HERE / name).read_text("utf-8") for name in ("page.js", "page_packing.js"))
        templates = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                       undefined=jinja2.StrictUndefined)
        text = templates.get_template("page.html.jinja").render(
            title=self.title, parts=self.parts, script=script,
            digest=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
            content=json_for_page({"charts": self.charts, "packings": self.packings}),
            library=plotting_library() if library is None else library)
        return text.encode("utf-8", "surrogateescape").decode("utf-8", "replace")

    def write(self, file: str | pathlib.Path) -> None:
        """Writes the page; replaces only a page of mcdem. Raises InputError and OSError."""
        replace_own(file, PAGE, self.html().encode("utf-8"))
