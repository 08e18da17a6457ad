"""Reads tables of other programs and laboratories as named columns; their meaning and units are determined later."""
import array
import errno
import gzip
import zlib
from collections.abc import Iterable, Sequence

import numpy as np

from ..errors import InputError
from ..look import is_file, is_there
from ..number_text import shortest
from ..problems import Problems
from . import formats
from .arrays import Floats
from .boxes import Box
from .text import MAX_COLUMNS, Form, cut, numbers_of, parse_text

LARGEST = 1 << 30  # maximum size of a table in bytes, uncompressed


class Table:
    def __init__(self, file: str) -> None:
        self.file, self.format, self.form = file, "text", Form()
        self.lines = list[str]()  # of the file, for cells that are not numbers and for messages
        self.decimal_clear = True  # otherwise every comma may also be a thousands separator: 1,306
        self.named, self.columns = False, list[str]()  # whether the file has names of columns; otherwise they are "column 1", ..
        self.repeated = set[str]()  # names that several columns have
        self.frames = list[tuple[float, int]]()  # of a dump: (timestep, first row)
        self.own = MAX_COLUMNS  # columns of the file; those behind them are of another one
        self.boxes = list[Box | None]()  # of each frame, or of the file; None: not said
        self._places = dict[str, int]()  # of columns by their names
        self.line_of = list[int]()  # of each row, from 1; empty if rows are not lines
        self._values: array.array[float] | Floats = array.array("d")  # row by row; NaN: not a finite number

    @property
    def rows(self) -> int:
        return len(self._values) // max(len(self.columns), 1)

    def begin(self, format_: str, lines: list[str], form: Form) -> None:
        self.format, self.lines, self.form = format_, lines, form

    def name_columns(self, names: Sequence[str], count: int) -> None:
        """Replaces names by the column's number if they are missing, repeated, or begin with a question mark or a minus, which a
        mapping uses for unconfirmed values and reversed columns."""
        self.columns, self.repeated = [], set()
        for i, name in enumerate([*names, *[""] * count][:count]):
            name = name.strip(" \t\r")
            if name in self._places:
                self.repeated.add(name)
            if not name or name[0] in "?-" or name in self._places:
                name = f"column {i + 1}"
            self._places[name] = i
            self.columns.append(name)
        self.named = bool(names)

    def add_row(self, cells: Sequence[str], line: int) -> None:
        assert isinstance(self._values, array.array)
        self._values.extend(numbers_of(cells, self.form.decimal))
        self.line_of.append(line)

    def set_numbers(self, format_: str, columns: list[str], values: Floats, line_of: Iterable[int] = ()) -> None:
        self.begin(format_, self.lines, Form(" ", "."))
        self.name_columns(columns, len(columns))
        self._values, self.line_of = np.where(np.isfinite(values), values, np.nan).ravel(), list(line_of)

    def add_columns(self, names: Sequence[str], values: Floats) -> None:
        """Behind the others, which `values` [rows][columns] repeat: their cells are numbers only."""
        self.own, self._places = len(self.columns), dict[str, int]()
        self.name_columns([*self.columns, *names], len(self.columns) + len(names))
        self._values = values.ravel()

    def numbers(self, column: int) -> Floats:
        """NaN if the cell is not a finite number."""
        return np.asarray(self._values)[column::len(self.columns)]

    def text(self, row: int, column: int) -> str:
        if not self.lines or column >= self.own:
            return shortest(self.numbers(column)[row])
        return cut(self.lines[self.line_of[row] - 1], self.form.separator)[column]

    def find(self, name: str) -> int | None:
        """Position of a column by its name or as "column 3"; None if there is none."""
        return self._places.get(name, {f"column {i + 1}": i for i in range(len(self.columns))}.get(name))

    def where(self, row: int) -> str:
        return f"{self.file}:{self.line_of[row]}" if self.line_of else self.file


def _bytes_of(file: str) -> bytes:
    """The file's bytes, decompressed if necessary."""
    try:
        there = is_file(file)
    except OSError as error:
        if error.errno != errno.ENAMETOOLONG:
            raise
        raise InputError(f"{file[:200]}: must be a table, got: {error.strerror}") from None
    if not there:
        got = "something that is not a file" if is_there(file) else "no such file"
        raise InputError(f"{file}: must be a table, got {got}")
    try:
        with open(file, "rb") as stream:
            packed = stream.read(2) == b"\x1f\x8b"
            stream.seek(0)
            content = (gzip.GzipFile(fileobj=stream) if packed else stream).read(LARGEST + 1)
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        raise InputError(f"{file}: must be whole, got one that cannot be unpacked ({error}): pack it again with gzip") from None
    except OSError as error:
        raise OSError(error.errno, error.strerror, file) from error
    if len(content) > LARGEST:
        raise InputError(f"{file}: must have at most 1 GiB, got more: leave out frames, or split it into several files")
    return content


def parse_table(content: bytes, file: str, form: Form | None = None) -> Table:
    """`form` overrides the guess of the text format."""
    table, problems = Table(file), Problems()
    content = content.removeprefix(b"\xef\xbb\xbf")
    try:
        text = content.decode()
    except UnicodeDecodeError:
        text = content.decode("latin-1")  # written by European spreadsheets instead of UTF-8
    lines = [line.removesuffix("\r") for line in text.removesuffix("\n").split("\n")]
    if formats.is_mesh(content):
        formats.parse_mesh(table, content)
    elif "\0" in text:
        problems.add(file, "must be text, got zero bytes: save it as text in UTF-8")
    elif text[:1000].lstrip(" \t\r").startswith(formats.ITEM):
        formats.parse_dump(table, lines)
    elif text.startswith("# vtk DataFile"):
        formats.parse_vtk(table, lines)
    elif formats.looks_like_data(lines):
        formats.parse_data(table, lines)
    elif len(lines) > 2 and lines[0].strip().isdigit() and "Properties=" in lines[1]:
        formats.parse_xyz(table, text)
    else:
        parse_text(table, lines, form, problems)
    problems.report()
    return table


def read_table(file: str, form: Form | None = None) -> Table:
    return parse_table(_bytes_of(file), file, form)


def read_tables(files: Sequence[str], form: Form | None = None) -> list[Table]:
    """All tables, or the problems of all of them together."""
    tables, problems = [], []
    for file in files:
        try:
            tables.append(read_table(file, form))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return tables
