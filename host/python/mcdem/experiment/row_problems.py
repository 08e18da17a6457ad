"""Problems in the rows of a table, which are told in the order of the rows."""
from collections.abc import Callable
from functools import partial

import numpy as np

from ..problems import MAX_TOLD, Problems
from ..results.recording import Bools, Ints
from .table import Table

Words = Callable[[int], str]  # for a row
AT_END = 2**62  # a line behind all others


class RowProblems:
    """Of one row, problems are told in the order in which they were added."""

    def __init__(self, table: Table) -> None:
        self.table = table
        self.count = table.others_count
        # The line that sorts it, the line where it is, and what it is. Of each kind there are only those that can be told.
        self._first = [(line, line, f"must have {table.width} columns as the header, got {got}") for line, got in table.others]

    def add(self, which: Bools, what: Words) -> None:
        """`which` (R,) rows."""
        rows = np.flatnonzero(which)
        self.add_at(rows, self.table.line[rows], what)

    def add_once(self, which: Bools, what: Words) -> None:
        """Only the first one: a column in millimetres is one problem, not one for each line."""
        rows = np.flatnonzero(which)[:1]
        self.add_at(rows, self.table.line[rows], what)

    def add_row(self, row: int, what: str) -> None:
        self.add_at(np.array([row]), self.table.line[[row]], lambda _: what)

    def add_at(self, rows: Ints, lines: Ints, what: Words) -> None:
        """Problems of rows that are told with those of other lines; these do not fall."""
        self._first += [(line, int(self.table.line[row]), what(row))
                        for row, line in zip(rows[:MAX_TOLD].tolist(), lines[:MAX_TOLD].tolist(), strict=True)]
        self.count += len(rows)

    def add_wrong(self, *columns: str) -> None:
        """Words that are not valid."""
        for column in columns:
            self.add(self.table.wrong(column), partial(self._wrong_word, column))

    def _wrong_word(self, column: str, row: int) -> str:
        return f"{column} {self.table.kinds[column].must(self.table.words[column][row])}"

    def report(self, problems: Problems) -> None:
        for _, line, what in sorted(self._first, key=lambda one: one[0]):
            problems.add(self.table.where(line), what)
        problems.count += self.count - len(self._first)


def known_frames(found: RowProblems, frames: int, others: Bools) -> Bools:
    """(R,) whether the frame is one of plate.csv, and not below that of a valid row before. `others`: the rest of the row is valid."""
    frame, last = found.table["frame"], frames - 1
    found.add_wrong("frame")
    known = (frame >= 0) & (frame <= last)
    found.add_once(frame > last, lambda row: f"frame must be one of plate.csv, 0 to {last}, got {frame[row]}")
    highest = np.maximum.accumulate(np.where(known & others, frame, -1))
    before = np.append(-1, highest)[:-1]
    found.add_once(known & (frame < before), lambda row: f"frames must be in order, got {frame[row]} after {before[row]}: sort the rows by "
                                                         "frame")
    return np.asarray(known & (frame >= before))
