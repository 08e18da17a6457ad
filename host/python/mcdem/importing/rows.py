"""Rows of a table's files as arrays, by keys of the mapping; frames by number, time or step."""
import os
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from ..number_text import shortest
from ..problems import Problems, is_whole, quoted
from .arrays import Bools, Floats, Ints
from .mapping import Guess, MappedTable, columns_of, signed_column
from .names import TIMES, column_name, other_quantity
from .tables import Table


class ImportTable:
    """A table of the mapping with its files."""

    def __init__(self, mapped: MappedTable, parts: list[Table]) -> None:
        self.map, self.parts = mapped, parts

    def changed(self, **entries: Guess) -> "ImportTable":
        return ImportTable(self.map.changed(**entries), self.parts)

    @property
    def role(self) -> str:
        return self.map.role


def of_role(tables: list[ImportTable], role: str) -> list[ImportTable]:
    return [table for table in tables if table.role == role]


def whole_entry(mapped: MappedTable, key: str, problems: Problems) -> int:
    """An integer in the mapping, 0 if it is missing; anything else is a problem."""
    if is_whole(value := mapped.number(key)):
        return int(value)
    problems.add(mapped.files[0], f'{key} must be a whole number of at most 2e9, got "{mapped.word(key)}": see the mapping')
    return 0


def _keys_of_files(parts: list[Table]) -> tuple[Sequence[float], str]:
    """The last numbers in the files' names without extensions, 3 for "scan2/grains_003.csv.gz", if all have one and they increase;
    otherwise the files' positions."""
    stems = [os.path.splitext(os.path.basename(part.file).removesuffix(".gz"))[0] for part in parts]
    numbers = [float(re.findall("[0-9]+", stem)[-1]) for stem in stems if re.search("[0-9]", stem)]
    if len(parts) > 1 and len(numbers) == len(parts) and (np.diff(numbers) > 0).all():
        return numbers, "file"
    return range(len(parts)), "place"


class Rows:
    """The rows in the order of the files. `keyed_by` determines the rows' frames: the files' positions in the list, the last
    numbers in their names, a dump's steps, or a column. `key` is the number, time (in s if the column has a unit) or step of the frame."""

    def __init__(self, table: ImportTable, problems: Problems, most: int | None = None) -> None:
        self.map, self.parts, self.problems = table.map, table.parts, problems
        # By key: for each of its columns the sign, and the position in each part.
        self.columns = {key: [(sign, [self._find(part, name, key) for part in self.parts]) for sign, name in map(signed_column, words)]
                        for key, words in columns_of(self.map)}
        found = all(-1 not in places for columns in self.columns.values() for _, places in columns)
        self.counts = [part.rows if most is None else min(part.rows, most) for part in self.parts] if found else [0] * len(self.parts)
        keys, self.keyed_by = _keys_of_files(self.parts)
        frames = [part.frames or [(key, 0)] for part, key in zip(self.parts, keys)]
        self.part = np.repeat(np.arange(len(self.parts)), self.counts)
        self.row = np.concatenate([np.zeros(0, int), *map(np.arange, self.counts)])
        self.at = np.arange(len(self.row))  # before rows were left out or sorted
        self.key = np.concatenate([np.zeros(0), *(np.array([step for step, _ in of], float)[
            np.searchsorted([first for _, first in of], np.arange(n), "right") - 1] for of, n in zip(frames, self.counts))])
        if "frame" in self.columns:
            self.keyed_by = "column"
            unit = TIMES.get(column_name(self.map.word("frame")).unit, 1)
            stated = self.stated("frame")
            self.key = np.where(stated, unit * self.number("frame", stated), np.nan)
            self._keep(np.isfinite(self.key))
            if self.map.role != "plate" and len(self.frames()) - 1 > len(np.unique(self.key)):  # sorted by grain, not by frame
                self._keep(np.argsort(self.key, kind="stable"))
        elif any(part.frames for part in self.parts):
            self.keyed_by = "step"

    def _find(self, part: Table, name: str, key: str) -> int:
        """The column's position; -1, with a problem, if there is none."""
        column = part.find(name)
        if column is None:
            self.problems.add(part.file, f"must have the column {quoted(name)} that the mapping names for {key}, got {', '.join(part.columns)}")
            return -1
        return column

    def _keep(self, which: Any) -> None:
        self.part, self.row, self.at, self.key = self.part[which], self.row[which], self.at[which], self.key[which]

    @property
    def keyed(self) -> bool:
        """Whether frames have numbers, times or steps."""
        return self.keyed_by in ("step", "column")

    def __len__(self) -> int:
        return len(self.row)

    def lacks(self, *keys: str) -> bool:
        """Whether the mapping names no column for one of the keys, which is a problem."""
        missing = [key for key in keys if key not in self]
        for key in missing:
            self.problems.add(self.map.files[0], f"must have a column for {key}, got none: name it in the mapping")
        return bool(missing)

    def expect_quantity(self, quantity: str, keys: Sequence[str]) -> None:
        """Columns whose names say another quantity than "force" or "length" are a problem, whatever unit the mapping states."""
        for part, sign_and_name in ((self.parts[0], named) for key in keys if key in self for named in map(signed_column, self.map[key].words)):
            if what := other_quantity(sign_and_name[1], quantity):
                self.problems.add(part.file, f"{quoted(sign_and_name[1])} must be a {quantity}, got another quantity: {what}")

    def wanted(self) -> Bools:
        """Whether a row counts, by the column for `where`."""
        return np.asarray(np.nan_to_num(self.number("where")) != 0 if "where" in self else np.ones(len(self), bool))

    def __contains__(self, key: str) -> bool:
        return key in self.columns

    def cells(self, key: str, column: int = 0) -> Floats:
        """Numbers in one of the key's columns, NaN where a cell is none."""
        places = self.columns[key][column][1]
        parts = [part.numbers(place)[:n] for part, place, n in zip(self.parts, places, self.counts) if n]
        return np.asarray(np.concatenate([np.zeros(0), *parts])[self.at])

    def stated(self, key: str) -> Bools:
        """Whether the cells are not empty: a trigger has numbers in some rows only."""
        stated = np.isfinite(self.cells(key))
        for i in np.flatnonzero(~stated):
            stated[i] = self.text(i, key).strip() != ""
        return stated

    def number(self, key: str, of: Bools | bool = True) -> Floats:
        """The entry's value in each row, the sum of several columns. NaN is a problem in the rows `of`."""
        values = np.zeros(len(self))
        for column, (sign, places) in enumerate(self.columns[key]):
            numbers = self.cells(key, column)
            for i in np.flatnonzero(np.isnan(numbers) & of):
                if self.problems.full:
                    break
                name = self.parts[self.part[i]].columns[places[self.part[i]]]
                self.problem(i, f"{name} must be a finite number, got {quoted(self.text(i, key, column))}: leave out what was not measured: a "
                             "row of the plate, a contact, or the whole frame of grains")
            values += sign * numbers
        return values

    def numbers(self, keys: Sequence[str], of: Bools | bool = True) -> Floats:
        """One column for each of the keys."""
        return np.column_stack([self.number(key, of) for key in keys])

    def whole_number(self, key: str) -> Floats:
        values = self.number(key)
        for i in np.flatnonzero(np.isfinite(values) & ~((np.abs(values) <= 2e9) & (values == np.round(values))))[:20]:
            self.problem(i, f"{key} must be a whole number, got {shortest(values[i])}")
            values[i] = np.nan
        return values

    def text(self, i: int, key: str, column: int = 0) -> str:
        part = int(self.part[i])
        return self.parts[part].text(self.row[i], self.columns[key][column][1][part])

    def problem(self, i: int, what: str) -> None:
        self.problems.add(self.parts[self.part[i]].where(self.row[i]), what)

    def problem_once(self, topic: str, i: int, what: str) -> None:
        """Adds only one problem for each topic and file: a column in millimetres is one problem, not one for each line."""
        part = self.parts[self.part[i]]
        self.problems.add_once(part.file + topic, part.where(self.row[i]), what)

    def frames(self) -> Ints:
        """First row of each frame, and the end of the last one: a frame is a sequence of rows with the same key."""
        return np.asarray(np.unique([0, *(np.flatnonzero(np.diff(self.key)) + 1), len(self)]))


class FrameIndex:
    """Finds frames by their keys, the first one of equal keys. Times may differ by a thousandth of the shortest interval."""

    def __init__(self, keys: Any = ()) -> None:
        self.keys, self.first = np.unique(np.asarray(keys, float), return_index=True)
        self.tolerance = 1e-3 * np.diff(self.keys).min() if len(self.keys) > 1 else 1e-9 * np.abs(self.keys).sum()

    def _find(self, keys: Any, tolerance: float | None) -> Ints:
        return np.asarray(np.append(self.first, -1)[pd.Index(self.keys).get_indexer(np.asarray(keys, float), "nearest", tolerance=tolerance)])

    def nearest(self, keys: Any) -> Ints:
        """Positions of the nearest ones; -1 if there would have been a nearer one before the first or after the last."""
        if len(self.keys) < 2:
            return self.find(keys)
        first, last = self.keys[[0, -1]] - np.diff(self.keys)[[0, -1]] * [0.5, -0.5]
        return np.where((keys >= first) & (keys <= last), self._find(keys, None), -1)

    def find(self, keys: Any) -> Ints:
        """Positions; -1 if there is none."""
        return self._find(keys, self.tolerance * (1 + 1e-12))
