"""Text in tables that spreadsheets open, and the scene keys that vary as their columns."""
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from ..number_text import shortest
from ..observe.replicas import Setting, without_seed
from ..results.parameters import keys_that_vary, value_of, without_quotes
from .labels import one_line


def without_formula(text: str) -> str:
    """Text that begins with one of = + - @, also after blanks, has an apostrophe in front: a spreadsheet would run it. Numbers stay."""
    is_formula = text.lstrip(' \t\r\n"')[:1] in set("=+-@")
    return "'" + text if is_formula and not _is_number(text) else text


def _is_number(text: str) -> bool:
    return bool(re.fullmatch(r"\+?-?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text, re.ASCII))


def csv_field(text: str) -> str:
    """On one line, quoted if necessary."""
    line = without_formula(one_line(text))
    return '"' + line.replace('"', '""') + '"' if "," in line or '"' in line else line


def known(value: float) -> str:
    """All digits; empty if it is unknown."""
    return shortest(value) if math.isfinite(value) else ""


@dataclass(frozen=True)
class VaryingKeys:
    """Scene keys that differ between settings, without seeds, and their values for each setting."""

    keys: list[str]
    values: list[list[str]]


def varying_keys(settings: Sequence[Setting]) -> VaryingKeys:
    parameters = [without_seed(setting.replicas[0].parameters) for setting in settings]
    keys = keys_that_vary(parameters)
    return VaryingKeys(keys, [[without_quotes(value_of(mine, key)) for key in keys] for mine in parameters])
