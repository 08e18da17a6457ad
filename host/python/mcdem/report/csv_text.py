"""Tables that spreadsheets open, and the scene keys that vary as their columns."""
import csv
import io
import math
import re
from collections.abc import Iterable, Sequence

from ..number_text import shortest
from ..observe.replicas import Setting, without_seed
from ..results.parameters import keys_that_vary, value_of, without_quotes
from .labels import one_line

NUMBER = re.compile(r"\+?-?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def csv_of(titles: Sequence[str], rows: Iterable[Sequence[str | float]]) -> str:
    """The rows under their titles. Texts are on one line and run no formula, numbers have all digits; empty where they are unknown."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([_field(cell) for cell in row] for row in (titles, *rows))
    return text.getvalue()


def _field(cell: str | float) -> str:
    if isinstance(cell, str):
        return without_formula(one_line(cell))
    return shortest(cell) if math.isfinite(cell) else ""


def without_formula(text: str) -> str:
    """Text that begins with one of = + - @, also after blanks, has an apostrophe in front: a spreadsheet would run it. Numbers stay."""
    is_formula = text.lstrip(' \t\r\n"')[:1] in set("=+-@")
    return "'" + text if is_formula and not NUMBER.fullmatch(text) else text


def varying_keys(settings: Sequence[Setting]) -> tuple[list[str], list[list[str]]]:
    """Scene keys that differ between settings, without seeds, and their values for each setting."""
    parameters = [without_seed(setting.replicas[0].parameters) for setting in settings]
    keys = keys_that_vary(parameters)
    return keys, [[without_quotes(value_of(mine, key)) for key in keys] for mine in parameters]
