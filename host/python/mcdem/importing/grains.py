"""Grains by frame, complete and ordered by id."""
from typing import Any

import numpy as np

from ..number_text import shortest
from ..problems import Problems
from .arrays import Bools, Floats, Ints
from .links import LOST, link
from .mapping import SIZE_KEYS, signed_column
from .plate import PlateRows
from .rows import FrameIndex, ImportTable, Rows, whole_entry


MOST_LOST = 0.2  # of the grains of a frame
MOST_LISTED = 50  # numbers in a note


class GrainFrames:
    def __init__(self) -> None:
        self.keys, self.position = list[float](), list[Floats]()  # of each frame: its key, centres [n][3] [m]
        self.ids, self.diameter = np.zeros(0, int), np.zeros(0)  # of the first frame; [m]
        self.where = list[tuple[Rows, int]]()  # of each frame, for messages
        self.origin = np.zeros(3)  # of the box, in the axes of the tables after reversal [m]
        self.sign = np.ones(3)  # -1 for reversed axes of a table
        self.labels = list[tuple[Ints, Ints]]()  # of each frame if grains are linked: labels, rising, and their grains, -1 for none
        self.notes = list[str]()
        self.index, self.plate = FrameIndex(), FrameIndex()
        self.row = list[int]()  # row of the plate for each frame; -1: none; empty: unknown
        self.plate_rows = 0

    def number_of(self, ids: Any, frame: int = 0) -> Ints:
        """Indices of grains from their numbers in the table, of this frame where they are linked; -1 if there is none."""
        ids = np.asarray(ids)
        if 0 < frame < len(self.labels):
            labels, grain = self.labels[frame]
            at = np.minimum(np.searchsorted(labels, ids), len(labels) - 1)
            return np.where(labels[at] == ids, grain[at], -1)
        at = np.minimum(np.searchsorted(self.ids, ids), max(len(self.ids) - 1, 0))
        return np.where(self.ids[at] == ids, at, -1) if len(self.ids) else np.full(ids.shape, -1)

    def has_name(self, ids: Any) -> Bools:
        """Whether a grain has this number in any frame."""
        return np.isin(ids, np.concatenate([self.ids, *(labels for labels, _ in self.labels)]))

    def top(self, frame: int) -> float:
        """Height of the highest grain [m]."""
        return max(0.0, float(np.max(self.position[frame][:, 2] + self.diameter / 2)))

    def plate_rows_of(self, by: str, keys: Any) -> Ints:
        """Rows of the plate for the frames of another table, in order; `by` as in frames_by. -1: none."""
        keys = np.asarray(keys, float)
        if by in ("order", "rows"):
            rows = np.arange(len(keys)) if by == "order" else keys
            return np.where((rows >= 0) & (rows < self.plate_rows) & (rows == np.round(rows)), rows, -1).astype(int)
        if by in ("plate", "nearest"):
            return self.plate.find(keys) if by == "plate" else self.plate.nearest(keys)
        return np.append(self.row or np.full(len(self.keys), -1), -1)[self.index.find(keys)]

    def frames_of(self, by: str, keys: Any) -> Ints:
        """The same for frames of the grains. If the rows of the plate are unknown, frames in order are those of the grains."""
        if by == "grains" or (by == "plate" and not self.row):
            return self.index.find(keys)
        if not self.row:
            return FrameIndex(range(len(self.keys))).find(range(len(keys)))
        return self.frames_at(self.plate_rows_of(by, keys))

    def frames_at(self, rows: Any) -> Ints:
        """The first frame at each of these rows of the plate; -1: none."""
        return np.where(np.asarray(rows) < 0, -1, FrameIndex(self.row).find(rows))

    def place(self, by: str, plate: PlateRows) -> None:
        """Finds the row of the plate for each frame."""
        self.plate, self.plate_rows = plate.index, len(plate)
        self.row = list(self.plate_rows_of(by, self.keys))


def _read_table(table: ImportTable, frames: GrainFrames, problems: Problems) -> None:
    mapped, rows = table.map, Rows(table, problems)
    size_key = next((key for key in SIZE_KEYS if key in rows), "same_diameter" if "same_diameter" in mapped else "diameter")
    first = whole_entry(mapped, "first_grain", problems)
    if rows.lacks("x", "y", "z", *[size_key] * (size_key in SIZE_KEYS)):
        return
    rows.expect_quantity("length", ("x", "y", "z", size_key))
    if not len(rows):
        problems.add(mapped.files[0], "must have rows, one for each grain of a frame: leave a table without any out")
        return
    unit, wanted = mapped.length_factor(), rows.wanted()
    centres = rows.numbers("xyz", wanted)
    frames.sign = np.array([signed_column(mapped.word(key))[0] for key in "xyz"], float)
    frames.origin = unit * frames.sign * [mapped.number(f"origin_{axis}") for axis in "xyz"]
    size = rows.number(size_key, wanted) if size_key in rows else np.full(len(rows), mapped.number(size_key))
    ids = rows.whole_number("grain") if "grain" in rows else np.zeros(len(rows))
    for i in np.flatnonzero((size <= 0) & wanted)[:1]:
        rows.problem_once("size", i, f"{size_key} must be > 0, got {shortest(size[i])}")
    whole = wanted & np.isfinite(centres).all(axis=1) & np.isfinite(size) & np.isfinite(ids)
    centres = unit * centres - frames.origin
    diameter = unit * (mapped.number("size_factor") or 1) * (2 * size if size_key == "radius" else np.cbrt(6 * size / np.pi) if size_key == "volume" else size)
    starts = rows.frames()
    for begin, end in zip(starts, starts[1:]):
        mine = begin + np.flatnonzero(whole[begin:end])
        if len(mine):
            of_frame = ids[mine].astype(int) if "grain" in rows else first + np.arange(len(mine))
            order = np.argsort(of_frame, kind="stable")
            _add_frame(frames, rows, mine[order], of_frame[order], centres[mine[order]], diameter[mine[order]])


def _add_frame(frames: GrainFrames, rows: Rows, mine: Ints, ids: Ints, centres: Floats, diameter: Floats) -> None:
    """The rows `mine` in the order of the ids."""
    key = rows.key[mine[0]]
    linked = rows.map.word("labels") == "linked"
    shown, twice = shortest(key), np.flatnonzero(np.diff(ids) == 0)
    if len(twice):
        rows.problem_once("twice", mine[twice[0] + 1], f"each grain must be there once in frame {shown}, got {ids[twice[0]]} again: "
                          "see frame in the mapping")
    if key in frames.keys:
        rows.problem_once("sorted", mine[0], f"the rows of frame {shown} must follow one another, got more behind others: sort the table by "
                          "frame")
    if not frames.keys:
        frames.ids, kept = np.unique(ids, return_index=True)
        frames.diameter, centres = diameter[kept], centres[kept]
    elif linked:
        centres = _link(frames, rows, mine[0], ids, centres)
    elif not len(twice) and not np.array_equal(ids, frames.ids):
        rows.problem_once("all", mine[0], f"frame {shown} must list the {len(frames.ids)} grains of the first frame, got {len(ids)}, of which "
                          f"{np.isin(ids, frames.ids, invert=True).sum()} are other ones: number grains alike in all frames, and leave a "
                          "frame out where one is missing")
    elif "grain" not in rows:  # a different order of the rows is seen by their diameters, which may all change by the same factor
        growth = diameter / frames.diameter
        differ = np.mean(np.abs(growth / np.mean(growth) - 1))
        if differ > 0.02:
            rows.problem_once("diameters", mine[0], "grains without numbers must stand in the same order in all frames, got diameters in frame "
                              f"{shown} that differ by {100 * differ:.0f} % from those of the first: number the grains")
    if linked and not frames.keys:
        frames.labels.append((frames.ids, np.arange(len(frames.ids))))
    frames.keys.append(key)
    frames.where.append((rows, mine[0]))
    frames.position.append(centres)


def _link(frames: GrainFrames, rows: Rows, first: int, labels: Ints, centres: Floats) -> Floats:
    """The centres of the grains of the first frame; notes lost grains and labels that are none of them."""
    found = link(frames.position[-1], centres)
    grain = np.full(len(labels), -1)
    seen = np.flatnonzero(found.row != LOST)
    grain[found.row[seen]] = seen
    frames.labels.append((labels, grain))
    lost, more, shown = frames.ids[found.row == LOST], labels[grain < 0], shortest(rows.key[first])
    if len(lost) > MOST_LOST * len(frames.ids):
        rows.problem_once("linked", first, f"grains must be near the places of the frame before, got {len(lost)} of {len(frames.ids)} in frame {shown} that "
                          "are nowhere within half the distance of neighbours: sort the frames by time, or leave this one out")
    frames.notes += [f"frame {shown}: {len(some)} {what}: " + ", ".join(map(str, some[:MOST_LISTED])) + (", .." if len(some) > MOST_LISTED else "")
                     for some, what in ((lost, "grains of the first frame are lost, and are put where their neighbours' displacement says"),
                                        (more, "labels are no grains of the first frame, such as doubled ones, and are left out")) if len(some)]
    return found.position


def import_grains(tables: list[ImportTable], problems: Problems) -> GrainFrames:
    frames = GrainFrames()
    for table in tables:
        _read_table(table, frames, problems)
    if tables and not frames.keys and not problems.count:
        problems.add(tables[0].map.files[0], "must have grains, got 0 in all rows of the column for where: see the mapping")
    frames.index = FrameIndex(frames.keys)
    return frames
