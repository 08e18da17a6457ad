"""One CSV table of an experiment, plain or compressed with gzip, as one array for each column."""
import gzip
import io
import os
import pathlib
import re
import zlib
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..files import read_input
from ..look import is_file, is_there
from ..problems import MAX_TOLD, Problems, quoted, to_number
from ..results.recording import Bools, Ints

LARGEST_TABLE = 1 << 30  # maximum uncompressed size [bytes]: about 12 million contacts
TOO_LARGE = "is larger than an experiment's table may be: leave out frames, or split it into several experiments"
LONGEST_LINE = 1 << 24  # characters
BLOCK = 1 << 22  # bytes that are converted at once
LARGEST_WHOLE = 2_000_000_000
WRONG = -(2**62)  # a whole number where the word is not valid; in columns of numbers it is NaN
BLANKS = " \t\r\n"
FIRST_LINE = re.compile(rb"^[ \t\r]*[^ \t\r\n#]", re.MULTILINE)  # that is neither empty nor a comment


@dataclass(frozen=True)
class Kind:
    """How the words of a column are read."""

    parse: Callable[[str], float | None]  # of a word without blanks; None: not valid
    must: Callable[[str], str]  # "must be .., got .." for a word that is not valid
    is_whole: bool = True

    def values(self, words: Sequence[str], is_ascii: bool) -> NDArray[Any]:
        """`is_ascii`: then Python reads words without underscores as `parse` does."""
        if self.is_whole:
            known = {word: self.parse(word.strip(BLANKS)) for word in set(words)}
            values = {word: WRONG if value is None else int(value) for word, value in known.items()}
            return np.fromiter(map(values.__getitem__, words), np.int64, len(words))
        try:
            numbers = np.fromiter(map(float, words), float, len(words)) if is_ascii and "_" not in "".join(words) else None
        except ValueError:
            numbers = None
        if numbers is None:
            numbers = np.array([self.parse(word.strip(BLANKS)) for word in words], float)  # None becomes NaN
        else:
            numbers[np.isinf(numbers)] = np.nan
        return numbers

    def wrong(self, values: NDArray[Any]) -> Bools:
        """Where the words are not valid."""
        return np.asarray(values == WRONG if self.is_whole else np.isnan(values))


def whole_number(word: str) -> int | None:
    """A whole number from 0 on, or None."""
    found = re.fullmatch(r"\+?(-?)0*(\d{1,10})", word, re.ASCII)
    value = int(found[1] + found[2]) if found else -1
    return value if 0 <= value <= LARGEST_WHOLE else None


def must_be_whole(word: str) -> str:
    return f"must be a whole number from 0 on, got {quoted(word)}"


NUMBER = Kind(to_number, lambda word: f"must be a finite number, got {quoted(word)}: correct it, or leave the row out", is_whole=False)
NUMBER_OR_NOTHING = Kind(lambda word: to_number(word) if word else np.inf, NUMBER.must, is_whole=False)  # infinite: an empty cell
WHOLE = Kind(whole_number, must_be_whole)
Kinds = Mapping[str, Kind]  # by column


@dataclass(frozen=True, eq=False)
class Table:
    """The R rows that have as many columns as the header."""

    name: str  # of the file, for messages
    kinds: Kinds  # of the columns that are there
    values: Mapping[str, NDArray[Any]]  # by column (R,)
    line: Ints  # (R,) of the file, from 1
    words: Mapping[str, Mapping[int, str]]  # by column, the first words that are not valid, by row
    width: int  # columns of the header
    others: Sequence[tuple[int, int]]  # line and number of columns of the first other rows
    others_count: int

    def __len__(self) -> int:
        return len(self.line)

    def __getitem__(self, column: str) -> NDArray[Any]:
        return self.values[column]

    def wrong(self, column: str) -> Bools:
        """(R,) where the word is not valid."""
        return self.kinds[column].wrong(self.values[column])

    def valid(self, *columns: str) -> Bools:
        """(R,) where the words of all these columns are valid."""
        return np.asarray(~np.any([self.wrong(column) for column in columns], axis=0))

    def where(self, line: int) -> str:
        """ "plate.csv:12" """
        return f"{self.name}:{line}"


def find_table(folder: pathlib.Path, name: str, largest: int, problems: Problems) -> pathlib.Path | None:
    """`<folder>/<name>` or `<name>.gz`; None if neither exists, or with a problem. Raises OSError."""
    plain, packed = folder / name, folder / f"{name}.gz"
    has_plain, has_packed = is_there(plain), is_there(packed)  # a broken link means that a table is missing
    if not has_plain and not has_packed:
        return None
    file = plain if has_plain else packed
    if has_plain and has_packed:
        problems.add(str(plain), "is there twice, plain and as .gz: remove the one that is out of date")
    elif not is_file(file):
        problems.add(str(file), "must be a file that can be read")
    elif (size := os.stat(file).st_size) > largest:
        problems.add(str(file), f"{TOO_LARGE} ({size} bytes, at most {largest})")
    else:
        return file
    return None


def read_table(file: pathlib.Path, needed: Kinds, optional: Kinds, largest: int, problems: Problems) -> Table | None:
    """The needed columns and those of the optional ones that the header names, in any order; others are ignored.

    Empty lines and lines that start with # are skipped. `largest`: maximum uncompressed size [bytes]. None if there are no rows or no
    such table, which are problems; those of rows are told by RowProblems. Raises InputError, RunError, OSError.
    """
    text = _text_of(file, largest, problems)
    if text is None:
        return None
    begin = FIRST_LINE.search(text)
    start = begin.start() if begin else len(text)
    end = _line_end(text, start)
    header, line = text[start:end].decode(errors="replace").strip(BLANKS), text.count(b"\n", 0, start) + 1
    if not header:
        problems.add(str(file), f"is empty: it must begin with the header {','.join(needed)}")
        return None
    if not _expect_columns(f"{file}:{line}", header, needed, optional, problems):
        return None
    rows = _Rows(_split(header), {**needed, **optional})
    rows.read(text, end + 1, line + 1)
    if not rows.count:
        problems.add(str(file), "must have at least one row, got none: add rows, or leave the file out")
        return None
    return rows.table(str(file))


def _text_of(file: pathlib.Path, largest: int, problems: Problems) -> bytes | None:
    """Without a byte order mark; None with a problem."""
    try:
        text = read_input(file)
        if text.startswith(b"\x1f\x8b"):
            text = _unpacked(text, largest)
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        problems.add(str(file), f"cannot be unpacked ({error}): pack it again with gzip")
        return None
    failure = _failure_of(text, largest)
    if failure:
        problems.add(str(file), failure)
    return None if failure else text.removeprefix(b"\xef\xbb\xbf")


def _unpacked(packed: bytes, largest: int) -> bytes:
    """Up to about one block more than `largest`, block by block: read(largest) would allocate all of it at once."""
    file, blocks, size = gzip.GzipFile(fileobj=io.BytesIO(packed)), list[bytes](), 0
    while size <= largest and (block := file.read(1 << 16)):
        blocks.append(block)
        size += len(block)
    return b"".join(blocks)


def _failure_of(text: bytes, largest: int) -> str:
    """Why the text is not read as a table; empty if it is."""
    if len(text) > largest:
        return TOO_LARGE
    if b"\0" in text:
        return "holds zero bytes and is no table: save it as text in UTF-8"
    start = 0  # of a line
    while len(text) - start >= LONGEST_LINE:
        end = text.rfind(b"\n", start, start + LONGEST_LINE)
        if end < 0:
            line = text.count(b"\n", 0, start) + 1
            return f"line {line} has more than 16 million characters: is this a table?"
        start = end + 1
    return ""


def _line_end(text: bytes, start: int) -> int:
    end = text.find(b"\n", start)
    return end if end >= 0 else len(text)


def _split(line: str) -> list[str]:
    words = [word.strip(BLANKS) for word in line.split(",")]
    if '"' in line:  # as R and spreadsheets write text
        words = [word[1:-1].strip(BLANKS) if len(word) > 1 and word[0] == word[-1] == '"' else word for word in words]
    return words


def _expect_columns(where: str, header: str, needed: Kinds, optional: Kinds, problems: Problems) -> bool:
    """Whether the header names them once; other numbers are problems."""
    names, before = _split(header), problems.count
    if len(names) == 1 and re.search("[;\t]", header):
        problems.add(where, "columns must be separated by commas: export the table with commas, and decimal points")
        return False
    columns = (*needed, *optional)
    for column in columns:
        times = names.count(column)
        if times != 1 and (column in needed or times != 0):
            problems.add(where, f"the header must name {column} once, got it {times} times: the columns are {','.join(columns)}")
    return problems.count == before


class _Rows:
    """The rows of a table, block by block."""

    def __init__(self, header: Sequence[str], kinds: Kinds) -> None:
        self.width, self.count = len(header), 0  # count: rows of any width
        self.kinds = {column: kind for column, kind in kinds.items() if column in header}
        self.place = {column: header.index(column) for column in self.kinds}
        self.values: dict[str, list[NDArray[Any]]] = {column: [np.zeros(0, np.int64 if kind.is_whole else float)]
                                                      for column, kind in self.kinds.items()}
        self.words = defaultdict[str, dict[int, str]](dict)
        self.line: list[Ints] = [np.zeros(0, np.int64)]
        self.others: list[tuple[int, int]] = []
        self.read_count = 0  # rows of the right width

    def read(self, text: bytes, start: int, line: int) -> None:
        """From a byte on, which is the first one of a line."""
        last = len(text) - text.endswith(b"\n")
        while start < last:
            end = text.rfind(b"\n", start, start + BLOCK) if last - start > BLOCK else last
            block = text[start:end if end >= 0 else _line_end(text, start)]
            start, line = start + len(block) + 1, line + self._read_block(block, line)

    def _read_block(self, block: bytes, line: int) -> int:
        """Returns the number of its lines."""
        text, is_ascii = block.decode(errors="replace"), block.isascii()
        if words := self._regular_words(text):
            count = len(words) // self.width
            lines = np.arange(line, line + count)
            columns = {column: words[place::self.width] for column, place in self.place.items()}
        else:
            count = text.count("\n") + 1
            rows = list(self._rows_of(text, line))
            lines = np.array([number for number, _ in rows], np.int64)
            columns = {column: [row[place] for _, row in rows] for column, place in self.place.items()}
        for column, of_column in columns.items():
            self._add(column, of_column, is_ascii)
        self.line.append(lines)
        self.read_count += len(lines)
        self.count += len(lines)
        return count

    def _regular_words(self, text: str) -> list[str]:
        """All words, with blanks, of lines that are rows of the right width without quotes; of others none."""
        if '"' in text or "#" in text:
            return []
        words = text.replace("\n", ",\n").split(",")
        rows, more = divmod(len(words), self.width)
        ends = "".join(words[::self.width]).count("\n")
        return words if more == 0 and rows - 1 == ends == text.count("\n") else []

    def _rows_of(self, text: str, line: int) -> Iterator[tuple[int, list[str]]]:
        """The rows of the right width, with their lines."""
        for number, row in enumerate(text.split("\n"), line):
            if not row or not (row := row.strip(BLANKS)) or row[0] == "#":
                continue
            words = _split(row)
            if len(words) == self.width:
                yield number, words
                continue
            self.count += 1
            if len(self.others) < MAX_TOLD:
                self.others.append((number, len(words)))

    def _add(self, column: str, words: Sequence[str], is_ascii: bool) -> None:
        values = self.kinds[column].values(words, is_ascii)
        self.values[column].append(values)
        for row in np.flatnonzero(self.kinds[column].wrong(values))[:MAX_TOLD - len(self.words[column])].tolist():
            self.words[column][self.read_count + row] = words[row].strip(BLANKS)

    def table(self, name: str) -> Table:
        values = {column: np.concatenate(blocks) for column, blocks in self.values.items()}
        return Table(name, self.kinds, values, np.concatenate(self.line), self.words, self.width, self.others,
                     self.count - self.read_count)
