"""Guesses which frames of the tables belong together."""
from dataclasses import dataclass, field

import numpy as np

from .mapping import UNCLEAR, guess
from .names import COUNTED, TIMES, column_name, is_among, key_of_name
from .problems import Problems
from .rows import FrameIndex, Rows, of_role


@dataclass
class _Frames:
    """The frames of a table, and the meaning of their numbers."""

    keys: list = field(default_factory=list)
    by: str = "place"
    counts: str = ""  # "time", "step", "scan"; empty: unknown
    unit: str = ""  # of time, as stated by its name


def _frames_of(table):
    rows = Rows(table, Problems())
    if table.role == "plate" and not rows.keyed:
        return _Frames(list(range(len(rows))))
    frames = _Frames([float(rows.key[start]) for start in rows.frames()[:-1]], rows.keyed_by)
    if frames.by == "column":
        name = column_name(table.map.word("frame"))
        frames.counts = next((what for what, words in COUNTED.items() if is_among(name.base, words)), "")
        frames.unit = name.unit + name.unknown
    if frames.by == "step":
        frames.counts = "step"
    return frames


def _all_among(keys, others):
    return bool(keys) and bool(others) and bool((FrameIndex(others).find(keys) >= 0).all())


def _choose_frame_column(table, plate):
    """Among several columns for the frame, the one that the plate's table also has."""
    if "frame" not in plate.map or "frame" not in table.map:
        return
    base = column_name(plate.map.word("frame")).base
    for column in table.parts[0].columns:
        if column_name(column).base == base and key_of_name(table.role, column_name(column)) == "frame":
            table.map["frame"] = guess(column, "sure", "the plate's table has it too")


def _only_counts(keys):
    """0, 1, 2, .. or 1, 2, 3, ..: may number the frames of this table and not those of others."""
    return bool(keys) and keys[0] in (0, 1) and all(b == a + 1 for a, b in zip(keys, keys[1:]))


def _told_by(frames):
    told = {"place": "places in a list", "file": "numbers in file names"}.get(frames.by)
    return told or f"{frames.counts} numbers".strip() + (f" [{frames.unit}]" if frames.unit else "")


def _same_clock(a, b):
    """Times must have comparable units: stated ones are converted. Together with seconds, a name may omit the unit."""
    if a.unit == b.unit:
        return True
    if not a.unit or not b.unit:
        return 2 * len(a.keys) >= len(b.keys) and TIMES.get(a.unit or b.unit) == 1
    return a.unit in TIMES and b.unit in TIMES


def _same_numbers(frames, others):
    """Certainty that frames whose numbers all occur in `others` are the frames with these numbers."""
    alike = frames.counts == others.counts
    if not _same_clock(frames, others):
        return UNCLEAR
    if alike and frames.by == others.by:
        return "likely" if frames.by == "place" else "sure"
    if len(frames.keys) == len(others.keys):
        return "likely"
    if others.by == "place":  # row numbers, if they also start at 0
        counts_rows = frames.keys[0] == 0 and frames.counts != "time"
        return "likely" if counts_rows and (frames.by != "file" or not _only_counts(frames.keys)) else UNCLEAR
    if frames.by == "file":
        return "likely" if others.counts != "time" and not _only_counts(frames.keys) else UNCLEAR
    return "likely" if alike or (not frames.counts and others.counts != "time") else UNCLEAR


def _by_numbers(word, frames, others, whose):
    certainty = _same_numbers(frames, others)
    if certainty != UNCLEAR:
        return guess(word, certainty, f"{whose} table has all of them")
    return guess(word, certainty, f"{_told_by(frames)} here, {_told_by(others)} there: are they the same?")


def _in_order(frames, plate):
    here, rows = len(frames.keys), len(plate.keys)
    if here == rows:
        return guess("order", "likely", f"there are {here} of them, as many as rows of the plate")
    if frames.by == "file" and here and frames.keys[0] == 0 and frames.keys[-1] < rows and not _only_counts(frames.keys):
        return guess("rows", "likely", f"the files' numbers count the plate's {rows} rows, and are none of its {plate.counts or 'frame'} numbers")
    return guess("order", UNCLEAR, f"there are {here} frames here and {rows} rows of the plate, and {_told_by(frames)} do not tell which "
                 "belong together: put numbers or times of the plate's rows into the files' names or into a column")


def _between_rows(frames, plate):
    """A proposal for times between the rows of a plate that was recorded more often; None if they are not."""
    if not frames.counts == plate.counts == "time" or not _same_clock(frames, plate) or len(plate.keys) < 3 * len(frames.keys):
        return None
    rows = FrameIndex(plate.keys).nearest(frames.keys)
    if (rows < 0).any() or len(set(rows)) < len(rows):
        return None
    apart = np.abs(np.array(plate.keys)[rows] - frames.keys).max()
    return guess("nearest", UNCLEAR, f"times here lie between those of the plate's rows, at most {apart:.3g} s from the nearest: are they of the "
                 "same clock?")


def _match(frames, plate, grains):
    if grains and frames.by == grains.by == "place" and frames.keys == grains.keys:
        return guess("grains", "likely", "there are as many as of the grains")
    if frames.by == "place":
        return _in_order(frames, plate)
    like_grains = grains and grains.by != "place" and (grains.by == "file") == (frames.by == "file") and _all_among(frames.keys, grains.keys)
    if like_grains and (len(frames.keys) > 1 or not _all_among(frames.keys, plate.keys)):
        return _by_numbers("grains", frames, grains, "the grains'")
    if _all_among(frames.keys, plate.keys):
        return _by_numbers("plate", frames, plate, "the plate's")
    return _between_rows(frames, plate) or _in_order(frames, plate)


def guess_frames(tables):
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
        grains = _Frames(keys, all_of[-1].by, all_of[-1].counts, all_of[-1].unit) if keys else None
