"""Guesses which frames of the tables belong together."""
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..problems import Problems
from .links import LOST, link, same_labels
from .mapping import UNCLEAR, Guess, guess
from .names import COUNTED, TIMES, ColumnName, column_name, columns_by_key
from .rows import FrameIndex, ImportTable, Rows, of_role


LEAST_LINKED, FRAMES_COMPARED = 20, 3  # grains of a frame; pairs of frames
MOSTLY = 0.8


class _Frames(NamedTuple):
    """The frames of a table, and the meaning of their numbers."""

    keys: list[float]
    by: str  # as in Rows: place, file, step, column
    counts: str = ""  # "time", "step", "scan"; empty: unknown
    unit: str = ""  # of time, as stated by its name

    @property
    def told_by(self) -> str:
        told = {"place": "places in a list", "file": "numbers in file names"}.get(self.by)
        return told or f"{self.counts} numbers".strip() + (f" [{self.unit}]" if self.unit else "")

    @property
    def may_count_files(self) -> bool:
        """File names with 0, 1, 2, .. or 1, 2, 3, ..: may number the frames of this table and not those of others."""
        count = len(self.keys)
        return self.by == "file" and self.keys in (list(range(count)), list(range(1, count + 1)))

    def all_among(self, others: "_Frames") -> bool:
        return bool(self.keys) and bool(others.keys) and bool((FrameIndex(others.keys).find(self.keys) >= 0).all())


def _frames_of(table: ImportTable) -> _Frames:
    rows = Rows(table, Problems())
    if table.role == "plate" and not rows.keyed:
        return _Frames(list(range(len(rows))), "place")
    name = column_name(table.map.word("frame")) if rows.keyed_by == "column" else ColumnName()
    counts = "step" if rows.keyed_by == "step" else next((what for what, words in COUNTED.items() if name.base in words.split()), "")
    return _Frames([float(rows.key[start]) for start in rows.frames()[:-1]], rows.keyed_by, counts, name.unit + name.unknown)


def _choose_frame_column(table: ImportTable, plate: ImportTable) -> None:
    """Among several columns for the frame, the one that the plate's table also has."""
    for column in columns_by_key(table.role, table.parts[0].columns).get("frame", ()):
        if column_name(column).base == column_name(plate.map.word("frame")).base:
            table.map["frame"] = guess(column, "sure", "the plate's table has it too")


def _same_clock(a: _Frames, b: _Frames) -> bool:
    """Times must have comparable units: stated ones are converted. Together with seconds, a name may omit the unit."""
    if a.unit and b.unit or a.unit == b.unit:
        return a.unit == b.unit or (a.unit in TIMES and b.unit in TIMES)
    return 2 * len(a.keys) >= len(b.keys) and TIMES.get(a.unit or b.unit) == 1


def _by_numbers(word: str, frames: _Frames, others: _Frames) -> Guess:
    """Whether frames whose numbers all occur in `others` are the frames with these numbers."""
    alike = frames.counts == others.counts
    if others.by == "place":  # row numbers, if they also start at 0
        comparable = frames.keys[0] == 0 and frames.counts != "time"
    else:
        comparable = alike or not frames.counts and others.counts != "time"
    same = alike and frames.by == others.by or len(frames.keys) == len(others.keys)
    if not _same_clock(frames, others) or not (same or comparable and not frames.may_count_files):
        return guess(word, UNCLEAR, f"{frames.told_by} here, {others.told_by} there: are they the same?")
    return guess(word, "sure" if alike and frames.by == others.by != "place" else "likely", f"the table of the {word} has all of them")


def _in_order(frames: _Frames, plate: _Frames) -> Guess:
    here, rows = len(frames.keys), len(plate.keys)
    if here == rows:
        return guess("order", "likely", f"there are {here} of them, as many as rows of the plate")
    if frames.by == "file" and here and frames.keys[0] == 0 and frames.keys[-1] < rows and not frames.may_count_files:
        return guess("rows", "likely", f"the files' numbers count the plate's {rows} rows, and are none of its {plate.counts or 'frame'} numbers")
    return guess("order", UNCLEAR, f"there are {here} frames here and {rows} rows of the plate, and {frames.told_by} do not tell which "
                 "belong together: put numbers or times of the plate's rows into the files' names or into a column")


def _between_rows(frames: _Frames, plate: _Frames) -> Guess | None:
    """A proposal for times between the rows of a plate that was recorded more often; None if they are not."""
    rows = FrameIndex(plate.keys).nearest(frames.keys)
    if (not frames.keys or not frames.counts == plate.counts == "time" or not _same_clock(frames, plate) or len(plate.keys) < 3 * len(frames.keys)
            or (rows < 0).any() or len(set(rows)) < len(rows)):
        return None
    apart = np.abs(np.array(plate.keys)[rows] - frames.keys).max()
    return guess("nearest", UNCLEAR, f"times here lie between those of the plate's rows, at most {apart:.3g} s from the nearest: are they of the "
                 "same clock?")


def _match(frames: _Frames, plate: _Frames, grains: _Frames | None) -> Guess:
    if grains and frames.by == grains.by == "place" and frames.keys == grains.keys:
        return guess("grains", "likely", "there are as many as of the grains")
    if frames.by == "place":
        return _in_order(frames, plate)
    if grains and grains.by != "place" and (grains.by == "file") == (frames.by == "file") and frames.all_among(grains) and (
            len(frames.keys) > 1 or not frames.all_among(plate)):
        return _by_numbers("grains", frames, grains)
    if frames.all_among(plate):
        return _by_numbers("plate", frames, plate)
    return _between_rows(frames, plate) or _in_order(frames, plate)


def guess_links(table: ImportTable) -> None:
    """Whether grains keep their numbers: those of the first frames that have the same number are compared by their places."""
    if not all(key in table.map for key in ("grain", "x", "y", "z")):
        return
    rows = Rows(table, Problems())
    ids, centres, wanted = rows.number("grain"), rows.numbers("xyz"), rows.wanted()
    wanted = wanted & np.isfinite(ids) & np.isfinite(centres).all(axis=1)
    starts = rows.frames()
    frames = [begin + np.flatnonzero(wanted[begin:end]) for begin, end in zip(starts, starts[1:])]
    pairs = [(a, b) for a, b in pairwise(frames) if min(len(a), len(b)) >= LEAST_LINKED][:FRAMES_COMPARED]
    if any(len(np.unique(ids[a])) < len(a) for pair in pairs for a in pair):
        return
    alike = min((same_labels(ids[a], centres[a], ids[b], centres[b]) for a, b in pairs), default=1.0)
    other = sum(not np.array_equal(np.sort(ids[a]), np.sort(ids[b])) for a, b in pairs)
    if alike > MOSTLY and not other:
        return
    found = min((float(np.mean(link(centres[a], centres[b]).row != LOST)) for a, b in pairs), default=0.0)
    if alike > MOSTLY:
        table.map["labels"] = guess("linked", UNCLEAR, "numbers are alike in frames, but not all frames have the same: are grains lost and doubled? Then they "
                                    "are put where their neighbours' displacement says, or left out, and listed")
    elif found > MOSTLY:
        table.map["labels"] = guess("linked", "likely", f"only {100 * alike:.0f} % of the numbers are at their places in the next frame, and {100 * found:.0f} % of "
                                    "the grains have one there")


def guess_frames(tables: list[ImportTable]) -> None:
    plate = next(iter(of_role(tables, "plate")), None)
    if plate is None:
        return
    of_plate, grains = _frames_of(plate), None
    for role in ("grains", "contacts"):
        for table in of_role(tables, role):
            _choose_frame_column(table, plate)
            table.map["frames_by"] = _match(_frames_of(table), of_plate, grains)
        all_of = [_frames_of(table) for table in of_role(tables, "grains")]
        keys = [key for frames in all_of for key in frames.keys]
        grains = all_of[-1]._replace(keys=keys) if keys else None
