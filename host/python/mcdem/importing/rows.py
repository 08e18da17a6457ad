"""Rows of a table's files as arrays, by keys of the mapping; frames by number, time or step."""
import os
import re

import numpy as np

from .mapping import columns_of, signed_column
from .names import TIMES, column_name
from .problems import is_whole, number_text, quoted


class ImportTable:
    """A table of the mapping with its files."""

    def __init__(self, mapped, parts):
        self.map, self.parts = mapped, parts

    def changed(self, **entries):
        return ImportTable(self.map.changed(**entries), self.parts)

    @property
    def role(self):
        return self.map.role


def of_role(tables, role):
    return [table for table in tables if table.role == role]


def whole_entry(mapped, key, problems):
    """An integer in the mapping, 0 if it is missing; anything else is a problem."""
    if is_whole(value := mapped.number(key)):
        return int(value)
    problems.add(mapped.files[0], f'{key} must be a whole number of at most 2e9, got "{mapped.word(key)}": see the mapping')
    return 0


def _number_in_name(file):
    """The last number in a file's name without its extensions: 3 for "scan2/grains_003.csv.gz"."""
    stem = os.path.splitext(os.path.basename(file).removesuffix(".gz"))[0]
    digits = re.findall(r"[0-9]+", stem)
    return float(digits[-1]) if digits else None


def _keys_of_files(parts):
    """The numbers in the files' names if all have one and they increase; otherwise their positions."""
    numbers = [_number_in_name(part.file) for part in parts]
    if len(parts) > 1 and None not in numbers and all(a < b for a, b in zip(numbers, numbers[1:])):
        return numbers, "file"
    return list(range(len(parts))), "place"


class Rows:
    """The rows in the order of the files. `keyed_by` determines the rows' frames: the files' positions in the list, the last
    numbers in their names, a dump's steps, or a column. `key` is the number, time (in s if the column has a unit) or step of the frame."""

    def __init__(self, table, problems, most=None):
        self.map, self.parts, self.problems = table.map, table.parts, problems
        self.columns = {}  # by key: signs and columns of each part
        before = problems.count
        self._find_columns()
        whole = problems.count == before
        counts = [(part.rows if most is None else min(part.rows, most)) if whole else 0 for part in self.parts]
        self.part = np.repeat(np.arange(len(counts)), counts)
        self.row = np.concatenate([np.arange(n) for n in counts]) if counts else np.zeros(0, int)
        keys, self.keyed_by = _keys_of_files(self.parts)
        self.key = np.concatenate([np.full(n, float(key)) for n, key in zip(counts, keys)]) if counts else np.zeros(0)
        if "frame" in self.columns:
            self.keyed_by = "column"
            unit = TIMES.get(column_name(self.map.word("frame")).unit, 1)
            stated = self.stated("frame")
            self.key = np.where(stated, unit * self.number("frame", stated), np.nan)
            known = np.isfinite(self.key)
            self._keep(known)
            if self.map.role != "plate" and len(self.frames()) - 1 > len(np.unique(self.key)):  # sorted by grain, not by frame
                self._keep(np.argsort(self.key, kind="stable"))
        elif any(part.frames for part in self.parts):
            self.keyed_by = "step"
            for number, part in enumerate(self.parts):
                mine = self.part == number
                steps, first = zip(*part.frames) if part.frames else ((keys[number],), (0,))
                self.key[mine] = np.array(steps, float)[np.searchsorted(first, self.row[mine], "right") - 1]

    def _keep(self, which):
        self.part, self.row, self.key = self.part[which], self.row[which], self.key[which]

    @property
    def keyed(self):
        """Whether frames have numbers, times or steps."""
        return self.keyed_by in ("step", "column")

    def __len__(self):
        return len(self.row)

    def lacks(self, key):
        """Whether the mapping names no column for the key, which is a problem."""
        if key not in self:
            self.problems.add(self.map.files[0], f"must have a column for {key}, got none: name it in the mapping")
        return key not in self

    def wanted(self):
        """Whether a row counts, by the column for `where`."""
        return np.nan_to_num(self.number("where")) != 0 if "where" in self else np.ones(len(self), bool)

    def __contains__(self, key):
        return key in self.columns

    def _find_columns(self):
        for key, words in columns_of(self.map):
            of_parts = self.columns[key] = []
            for part in self.parts:
                found = [(sign, part.find(name)) for sign, name in map(signed_column, words)]
                of_parts.append(found)
                for (_, column), word in zip(found, words):
                    if column is None:
                        self.problems.add(part.file, f"must have the column {quoted(signed_column(word)[1])} that the mapping names for "
                                          f"{key}, got {', '.join(part.columns)}")

    def each_part(self, key):
        """Each part with its rows, their positions among all rows, and its columns of that key."""
        for number, part in enumerate(self.parts):
            mine = np.flatnonzero(self.part == number)
            if len(mine):
                yield part, self.row[mine], mine, self.columns[key][number]

    def stated(self, key):
        """Whether the cells are not empty: a trigger has numbers in some rows only."""
        stated = np.ones(len(self), bool)
        for part, rows, mine, ((_, column), *_) in self.each_part(key):
            for i in np.flatnonzero(np.isnan(part.numbers(column)[rows])) if column is not None else ():
                stated[mine[i]] = part.text(rows[i], column).strip() != ""
        return stated

    def number(self, key, of=None):
        """The entry's value in each row, the sum of several columns. NaN is a problem in the rows `of`."""
        values = np.zeros(len(self))
        for part, rows, mine, columns in self.each_part(key):
            for sign, column in columns:
                numbers = part.numbers(column)[rows]
                wrong = np.isnan(numbers) if of is None else np.isnan(numbers) & of[mine]
                for row in rows[wrong] if wrong.any() else ():
                    self.problems.add(lambda part=part, row=row: part.where(row), f"{part.columns[column]} must be a finite number, got "
                                      f"{quoted(part.text(row, column))}: leave out what was not measured: a row of the plate, a contact, or the whole frame of grains")
                    if self.problems.full:
                        break
                values[mine] += sign * numbers
        return values

    def whole_number(self, key):
        values = self.number(key)
        for i in np.flatnonzero(np.isfinite(values) & ~((np.abs(values) <= 2e9) & (values == np.round(values))))[:20]:
            self.problem(i, f"{key} must be a whole number, got {number_text(values[i])}")
            values[i] = np.nan
        return values

    def text(self, i, key):
        part = self.parts[self.part[i]]
        return part.text(self.row[i], self.columns[key][self.part[i]][0][1])

    def where(self, i):
        return self.parts[self.part[i]].where(self.row[i])

    def problem(self, i, what):
        self.problems.add(lambda: self.where(i), what)

    def problem_once(self, topic, i, what):
        """Adds only one problem for each topic and file: a column in millimetres is one problem, not one for each line."""
        topic = self.parts[self.part[i]].file + topic
        if topic not in self.problems.told:
            self.problems.told.add(topic)
            self.problem(i, what)

    def frames(self):
        """First row of each frame, and the end of the last one: a frame is a sequence of rows with the same key."""
        changes = np.flatnonzero(np.diff(self.key)) + 1
        return np.concatenate([[0], changes, [len(self)]]) if len(self) else np.zeros(1, int)


class FrameIndex:
    """Finds frames. Times may differ by a thousandth of the shortest interval."""

    def __init__(self, keys=()):
        keys = np.asarray(keys, float)
        self.order = np.argsort(keys, kind="stable")
        self.sorted = keys[self.order]
        steps = np.diff(self.sorted)
        steps = steps[steps > 0]
        self.tolerance = 1e-3 * steps.min() if len(steps) else 1e-9 * abs(self.sorted[0]) if len(keys) else 0.0

    def nearest(self, keys):
        """Positions of the nearest ones; -1 if there would have been a nearer one before the first or after the last."""
        keys = np.asarray(keys, float)
        if len(self.sorted) < 2:
            return self.find(keys)
        right = np.clip(np.searchsorted(self.sorted, keys), 1, len(self.sorted) - 1)
        is_left = keys - self.sorted[right - 1] <= self.sorted[right] - keys
        first, last = self.sorted[[0, -1]] - np.diff(self.sorted)[[0, -1]] * [0.5, -0.5]
        inside = (keys >= first) & (keys <= last)
        return np.where(inside, self.order[np.where(is_left, right - 1, right)], -1)

    def find(self, keys):
        """Positions; -1 if there is none."""
        keys = np.asarray(keys, float)
        if not len(self.sorted):
            return np.full(keys.shape, -1)
        at = np.minimum(np.searchsorted(self.sorted, keys - self.tolerance), len(self.sorted) - 1)
        near = np.abs(self.sorted[at] - keys) <= self.tolerance * (1 + 1e-12)
        return np.where(near, self.order[at], -1)
