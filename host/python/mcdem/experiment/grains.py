"""grains.csv: diameters from frame 0, and positions of the listed frames."""
import pathlib
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..number_text import shortest
from ..problems import Problems
from ..results.names import Wall
from ..results.recording import Box, Floats, Ints, Recording
from .container import apart, container_words, wall_distance, walls_of
from .row_problems import AT_END, RowProblems, known_frames
from .table import NUMBER, WHOLE, Table, read_table

NUMBERS = ("x_m", "y_m", "z_m", "diameter_m")
COLUMNS = {"frame": WHOLE, "grain": WHOLE} | dict.fromkeys(NUMBERS, NUMBER)
GRAIN_COLUMNS = tuple(COLUMNS)
MAX_CHANGE = 0.25  # relative change of a diameter between frames, larger than measurement errors
DRIFT = 20  # of a grain in a periodic container, in its edges


@dataclass(frozen=True, eq=False)
class Rows:
    """The R valid rows of the table, in F frames of N grains."""

    row: Ints  # (R,) of the table
    grain: Ints  # (R,)
    centre: Floats  # (R, 3) [m]
    diameter: Floats  # (R,) [m]
    frame: Ints  # (F,) numbers
    start: Ints  # (F,) first row, of these, of each frame
    of_frame: Ints  # (R,) index of the frame
    grains: int  # N: the rows of the first frame

    @staticmethod
    def of(table: Table, row: Ints) -> "Rows":
        frame, start = np.unique(table["frame"][row], return_index=True)
        of_frame = np.repeat(np.arange(len(frame)), np.diff(start, append=len(row)))
        centre = np.column_stack([table[axis][row] for axis in NUMBERS[:3]])
        return Rows(row, table["grain"][row], centre, table["diameter_m"][row], frame, start, of_frame, int((of_frame == 0).sum()))


def read_grains(file: pathlib.Path, recording: Recording, problems: Problems, largest: int) -> Recording:
    """The recording with diameters and positions. In a periodic container a grain is at the image nearest to its previous position.

    Raises InputError, RunError, OSError.
    """
    table = read_table(file, COLUMNS, {}, largest, problems)
    if table is None:
        return recording
    found = RowProblems(table)
    known = known_frames(found, len(recording.scans), table.valid("grain", *NUMBERS))
    found.add_wrong("grain", *NUMBERS)
    rows = Rows.of(table, np.flatnonzero(known & table.valid("grain", *NUMBERS)))
    diameter = np.zeros(rows.grains)
    if len(rows.row):
        if rows.frame[0] != 0:
            found.add_row(rows.row[0], f"the first frame must be 0, which says what grains there are, got {rows.frame[0]}")
        placed = _placed(found, rows)
        here = placed[rows.of_frame[placed] == 0]
        diameter[rows.grain[here]] = rows.diameter[here]
        _check_diameters(found, rows, diameter, recording.box)
        _check_positions(found, rows, recording)
    found.report(problems)
    if found.count or not len(diameter):
        return replace(recording, diameter=diameter)
    return replace(recording, diameter=diameter, scans=replace(recording.scans, position=_positions(rows, recording)))


def _placed(found: RowProblems, rows: Rows) -> Ints:
    """The rows that are the first ones of their grains in their frames. Others are problems, and grains without one."""
    line = found.table.line
    told_at = np.append(line[rows.row[rows.start[1:]]], AT_END)  # when a frame is complete: by frame
    is_placed, seen = rows.grain < rows.grains, rows.of_frame * rows.grains + rows.grain
    of_known = np.flatnonzero(is_placed)
    is_placed[:] = False
    is_placed[of_known[np.unique(seen[of_known], return_index=True)[1]]] = True
    twice = np.flatnonzero(~is_placed)

    def what(row: int) -> str:
        k = int(np.searchsorted(rows.row, row))
        if rows.grain[k] >= rows.grains:
            return f"grain must be 0 to {rows.grains - 1}, got {rows.grain[k]}: grains count from 0, the same in every frame"
        return f"grain {rows.grain[k]} is there twice in frame {rows.frame[rows.of_frame[k]]}"

    found.add_at(rows.row[twice], told_at[rows.of_frame[twice]], what)
    placed = np.flatnonzero(is_placed)
    incomplete = np.flatnonzero(np.bincount(rows.of_frame[placed], minlength=len(rows.frame)) < rows.grains)

    def missing(row: int) -> str:
        frame = int(rows.of_frame[np.searchsorted(rows.row, row)])
        absent = np.setdiff1d(np.arange(rows.grains), rows.grain[placed[rows.of_frame[placed] == frame]])
        return (f"frame {rows.frame[frame]} must list all {rows.grains} grains, but grain {absent[0]} is missing: add it, or leave the "
                "whole frame out")

    found.add_at(rows.row[rows.start[incomplete]], told_at[incomplete], missing)
    return placed


def _check_diameters(found: RowProblems, rows: Rows, diameter: Floats, box: Box) -> None:
    """`diameter` (N,) of frame 0."""
    width, now = max(box.size_x, box.size_y), found.table["diameter_m"]
    has_first = (rows.of_frame > 0) & (rows.grain < rows.grains)
    first = now.copy()
    first[rows.row[has_first]] = diameter[rows.grain[has_first]]
    here = np.zeros(len(now), bool)
    here[rows.row] = True
    large = (width > 0) & (now > width)
    found.add(here & (now <= 0), lambda row: f"diameter_m must be > 0 [m], got {shortest(now[row])}")
    found.add_once(here & large, lambda row: f"diameter_m must be in metres: {shortest(now[row])} is more than the box's width of "
                                             f"{shortest(width)} m; divide by 1000 if it is in millimetres")
    found.add_once(here & (now > 0) & ~large & (np.abs(now - first) > MAX_CHANGE * first),
                   lambda row: f"grain {found.table['grain'][row]} must be as large as in frame 0, {shortest(first[row])} m, got "
                               f"{shortest(now[row])}: number the grains alike in all frames")


def _check_positions(found: RowProblems, rows: Rows, recording: Recording) -> None:
    box, plate_z = recording.box, recording.scans.plate_z[rows.frame[rows.of_frame]]
    if not box.size_x > 0:
        return
    outside = rows.centre[:, 2] > plate_z
    for wall in walls_of(box):
        if wall != Wall.plate:
            outside |= wall_distance(box, wall, 0, rows.centre) < 0
    if box.is_periodic:
        outside |= (np.abs(rows.centre[:, :2]) > DRIFT * np.array([box.size_x, box.size_y])).any(1)
    for k in np.flatnonzero(outside)[:1].tolist():
        found.add_row(rows.row[k], f"centres must lie in the {container_words(box)} below the plate at {shortest(plate_z[k])} m, got "
                                   f"{', '.join(map(shortest, rows.centre[k]))} m: divide by 1000 if they are in millimetres, shift them "
                                   "if the origin is elsewhere, and check that frames are numbered consistently with plate.csv")


def _positions(rows: Rows, recording: Recording) -> tuple[Floats, ...]:
    """By scan (N, 3)."""
    centre = np.zeros((len(rows.frame), rows.grains, 3))
    centre[rows.of_frame, rows.grain] = rows.centre
    position = list(recording.scans.position)
    for number, here in zip(rows.frame.tolist(), _connected(recording.box, centre)):
        position[number] = here
    return tuple(position)


def _connected(box: Box, centre: Floats) -> Iterator[Floats]:
    """The frames of (F, N, 3). In a periodic container each grain is at the image nearest to its previous position."""
    last = centre[0]
    for here in centre:
        if box.is_periodic:
            here = last = last + apart(box, last, here)
        yield here
