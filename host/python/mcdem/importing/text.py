"""Reads text tables, separated by commas, semicolons, tabs or blanks, with decimal points or commas.

What comes before the first row with a number in it may name the columns, and in a line below state their units; Yade's
`#format` line, and a line of words behind a # where nothing else does, name them too.
"""
import itertools
import math
import re
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from ..problems import Problems, quoted, to_number

if TYPE_CHECKING:
    from .tables import Table

SAMPLED_LINES = 100
MAX_COLUMNS = 10_000
BLANKS_IN_WORDS = 0.95  # merit of blanks, which are also inside of cells, as separators
MAX_CELL = 10_000  # characters
NOTHING = {"", "-", "--", "nan", "NaN", "NAN", "na", "NA", "N/A", "n/a", "null", "NULL", "inf"}
UNITS = {*"- m cm sec psi N/mm2 N/mm² mm/mm lbf kgf mm um µm μm N cN mN kN MN uN µN μN g gf kgf lbf s ms min h % 1 voxel Pa kPa MPa bar °C C K mm/min mm/s V mV".split(), ""}
THOUSANDS = {",": re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+(,.*)?", re.ASCII | re.DOTALL),  # 12.345,6 with a decimal comma
             ".": re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+(\..*)?", re.ASCII | re.DOTALL)}


class Form(NamedTuple):
    separator: str = ","  # " " means any blanks
    decimal: str = "."


FORMS = list(itertools.starmap(Form, itertools.product(";\t, ", ".,")))  # in order of preference among equally good ones


def cut(line: str, separator: str) -> list[str]:
    """Cells of a line; a quoted cell may contain the separator."""
    if separator == " ":
        return line.split()
    if '"' not in line:
        return [cell.strip(" \t\r") for cell in line.split(separator)]
    parted = re.sub(r'"[^"]*"?', lambda quote: quote[0].replace(separator, "\0"), line).split(separator)
    cells = [cell.replace("\0", separator).strip(" \t\r") for cell in parted]
    return [cell[1:-1] if len(cell) >= 2 and cell[0] == cell[-1] == '"' else cell for cell in cells]


def cell_number(cell: str, decimal: str) -> float | None:
    """A finite number, or None."""
    if decimal == "." or "," not in cell:
        return to_number(cell)
    return to_number(cell.replace(",", ".", 1)) if "." not in cell and len(cell) <= 64 else None


def numbers_of(cells: Sequence[str], decimal: str) -> list[float]:
    """NaN where a cell is not a finite number."""
    return [math.nan if (number := cell_number(cell, decimal)) is None else number for cell in cells]


def _numbers_in(cells: Sequence[str], decimal: str) -> int:
    return sum(cell_number(cell, decimal) is not None for cell in cells)


def sample(lines: list[str]) -> list[str]:
    """The first lines that are neither blank nor comments."""
    return list(itertools.islice((line for line in lines if line.strip()[:1] not in ("", "#")), SAMPLED_LINES))


def _usual_width(rows: list[list[str]]) -> int:
    """The most frequent number of cells; the largest one in a tie."""
    return max(((count, width) for width, count in Counter(map(len, rows)).items()), default=(0, 0))[1]


def _merit(lines: list[str], form: Form) -> float:
    """Fraction of lines with the usual number of cells, times the fraction of numbers among their cells."""
    rows = [cut(line, form.separator) for line in lines]
    width = _usual_width(rows)
    alike = [cells for cells in rows if len(cells) == width]
    numbers = sum(_numbers_in(cells, form.decimal) for cells in alike) / max(width, 1)
    return (1 if width > 1 else 0.1) * (BLANKS_IN_WORDS if form.separator == " " else 1) * len(alike) / len(lines) * (0.01 + numbers / len(alike))


def guess_form(lines: list[str]) -> Form:
    lines = sample(lines)
    return max(FORMS, key=lambda form: round(_merit(lines, form), 12)) if lines else Form()


def _kind(cell: str) -> str:
    if cell_number(cell, ".") is not None or cell_number(cell, ",") is not None:
        return "number"
    return "nothing" if cell in NOTHING else "word"


def _lines_above(lines: list[str], separator: str) -> int:
    """Number of header lines that are no rows although they may hold numbers. They end above the names of the columns, the last line
    with only words, if each of them has a word in a column of numbers: `Vorkraft;0,5;N` is not a row of `Zeit;Weg;Kraft`. Otherwise
    they are the lines with words before the first line with the usual number of cells: `Probe;17` is not a row."""
    rows = [[_kind(cell) for cell in cut(line, separator)] for line in sample(lines)]
    width = _usual_width(rows)
    names = max((n for n, row in enumerate(rows) if "word" in row and "number" not in row), default=0)
    if len(rows) > names + 1 and names and len(rows[names]) >= width:
        worded = {c for row in rows[names + 1:] for c, kind in enumerate(row) if kind == "word"}
        if all(len(row) < width or "number" not in row or any(kind == "word" and c not in worded for c, kind in enumerate(row[:width]))
               for row in rows[:names]):
            return names
    return next((n for n, row in enumerate(rows) if len(row) == width or "word" not in row), len(rows))


def _note_marks(seen: dict[str, tuple[str, int]], cells: Sequence[str], line: int) -> None:
    """Notes evidence for or against a decimal comma: the first cell of each kind with its line."""
    for cell in cells:
        if ("," in cell or "." in cell) and cell_number(cell, ",") is not None:
            kind = "point" if "." in cell else "either" if THOUSANDS["."].fullmatch(cell) else "comma"
            seen.setdefault(kind, (cell, line))


def _names_of(headings: list[list[str]], comment: list[str], format_: list[str], width: int) -> list[str]:
    """Names of the columns: the last line before the first row, or the last two if the second contains units."""
    headings = [names for names in headings if len(names) in (width, width + 1)]
    if not headings:
        return comment if len(comment) == width else format_
    names = headings[-1]
    units = [re.sub(r"^[\[(](.*)[\])]$", r"\1", word) for word in names]
    if len(headings) > 1 and all(unit != word or word in UNITS for unit, word in zip(units, names)):
        names = [name + ("" if unit in ("", "-", "1") else f" [{unit}]") for name, unit in zip(headings[-2], units + [""])]
    return names


def _ends_in_separators(lines: list[str], separator: str, width: int) -> bool:
    """Whether lines of that many cells have nothing in the last one: neither a column's name nor, in any row, a value."""
    rows = (cut(line.lstrip(" \t\r#") if line.lstrip(" \t\r")[:1] == "#" else line, separator) for line in lines)
    return not any(cells[-1] for cells in rows if len(cells) == width)


def parse_text(table: "Table", lines: list[str], form: Form | None, problems: Problems) -> None:
    form = form or guess_form(lines)
    table.begin("text", lines, form)
    above = _lines_above(lines, form.separator)
    headings, comment, format_, trailing, marks = list[list[str]](), list[str](), list[str](), None, dict[str, tuple[str, int]]()
    for number, line in enumerate(lines, 1):
        words = line.strip()
        if not words or problems.full or (words[0] == "#" and table.columns):
            continue
        if words[0] == "#":
            words = words[1:].strip()
            if words.startswith("format "):  # of Yade
                format_ = words[7:].strip().removesuffix("_attrs").split("_")
            else:
                comment = cut(words, form.separator if form.separator in words else " ")
            continue
        cells = cut(line, form.separator)
        if len(line) > MAX_CELL and (wide := [place for place, cell in enumerate(cells, 1) if len(cell) > MAX_CELL]):
            problems.add(f"{table.file}:{number}", f"column {wide[0]} must have at most {MAX_CELL} characters, got {quoted(cells[wide[0] - 1])} "
                         f"with {len(cells[wide[0] - 1])}: correct the line, or leave out the column")
            continue
        has_numbers = (not table.columns or not cells[-1]) and _numbers_in(cells, form.decimal) > 0
        if len(cells) > 1 and not cells[-1] and has_numbers:  # a separator at the end of the line
            trailing = _ends_in_separators(lines, form.separator, len(cells)) if trailing is None else trailing
            cells = cells[:-1] if trailing else cells
        if not table.columns and (above > 0 or not has_numbers):
            headings.append(cells)
            above -= 1
            continue
        if not table.columns:
            if len(cells) > MAX_COLUMNS:
                problems.add(f"{table.file}:{number}", f"must have at most {MAX_COLUMNS} columns, got {len(cells)}")
            table.name_columns(_names_of(headings, comment, format_, len(cells)), len(cells))
        if form.decimal == ",":
            _note_marks(marks, cells, number)
        if wrong := next(filter(THOUSANDS[form.decimal].fullmatch, cells), ""):
            problems.add(f"{table.file}:{number}", f"numbers must have no separators of thousands, got {quoted(wrong)} where the decimal is "
                         f'"{form.decimal}": write the table without them')
        elif len(cells) == len(table.columns):
            table.add_row(cells, number)
        else:
            problems.add(f"{table.file}:{number}", f"must have {len(table.columns)} columns as the first row, got {len(cells)}")
    table.decimal_clear = "either" not in marks or "comma" in marks
    if "either" in marks and "point" in marks:
        (cell, first), (point, point_line) = marks["either"], marks["point"]
        problems.add(f"{table.file}:{first}", "numbers must have one decimal mark and no separators of thousands, got "
                     f"{quoted(cell)} beside {quoted(point)} in line {point_line}: write the table with points only")
    if table.rows == 0 and not problems.count:
        problems.add(table.file, "must have at least one row with a number in it, got none")
