"""contacts.csv: contacts of the listed frames."""
import pathlib
import re
from dataclasses import replace
from functools import partial

import numpy as np

from ..number_text import shortest
from ..problems import Problems, quoted
from ..results.recording import Bools, Box, Contacts, Ints, Recording
from .container import walls_of
from .row_problems import AT_END, RowProblems, known_frames
from .table import NUMBER, WHOLE, Kind, must_be_whole, read_table, whole_number

POINT, FORCE = ("x_m", "y_m", "z_m"), ("fx_N", "fy_N", "fz_N")
CONTACT_COLUMNS = ("frame", "grain", "partner", *POINT, *FORCE)


def read_contacts(file: pathlib.Path, modulus: float, recording: Recording, problems: Problems, largest: int) -> Recording:
    """The recording with its contacts. `modulus`: Young's modulus of the grains [Pa], infinite if unknown, limits the plausible forces.

    Raises InputError, RunError, OSError.
    """
    kinds = {"frame": WHOLE, "grain": WHOLE, "partner": partner_kind(recording.box)} | dict.fromkeys(POINT + FORCE, NUMBER)
    table = read_table(file, kinds, {}, largest, problems)
    if table is None:
        return recording
    found = RowProblems(table)
    grain, partner = table["grain"], table["partner"]
    contacts = Contacts(grain, partner, np.column_stack([table[axis] for axis in POINT]), np.column_stack([table[axis] for axis in FORCE]),
                        np.full(len(table), np.nan))
    grains = len(recording.diameter)
    whole = table.valid("grain", "partner", *POINT, *FORCE) & (grain < grains) & (partner < grains)
    known = known_frames(found, len(recording.scans), whole & (grain != partner))
    for column, numbers in (("grain", grain), ("partner", partner)):
        found.add_wrong(column)
        found.add(numbers >= grains, partial(_unknown_grain, column, numbers, grains))
    found.add_wrong(*POINT, *FORCE)
    found.add(whole & (grain == partner), lambda row: f"grain {grain[row]} cannot touch itself")
    _check_units(found, contacts, whole & (grain != partner), modulus, recording)
    _check_twice(found, contacts, known & whole & (grain != partner))
    found.report(problems)
    return recording if found.count else _with_contacts(recording, contacts, table["frame"])


def partner_kind(box: Box) -> Kind:
    """A grain, or a wall as -1 - wall."""
    walls = {box.wall_name(wall): -1 - wall for wall in walls_of(box)}

    def must(word: str) -> str:
        is_number = re.fullmatch(r"\+?-?\d+", word, re.ASCII)
        return must_be_whole(word) if is_number else f"must be a grain's number or one of {', '.join(walls)}, got {quoted(word)}"

    return Kind(lambda word: walls.get(word, whole_number(word)), must)


def _unknown_grain(column: str, numbers: Ints, grains: int, row: int) -> str:
    return f"{column} must be a grain of grains.csv, 0 to {grains - 1}, got {numbers[row]}: there is no grain for this force"


def _check_units(found: RowProblems, contacts: Contacts, which: Bools, modulus: float, recording: Recording) -> None:
    box, diameter = recording.box, float(recording.diameter.max())
    largest_force, margin = modulus * diameter * diameter, max(box.size_x, box.size_y) + diameter
    point, force = contacts.point, np.linalg.norm(contacts.force, axis=1)
    far = np.array([box.size_x, box.size_y, recording.scans.plate_z[0]]) + margin
    if box.size_x > 0 and not box.is_periodic:
        outside = which & ((point < -margin) | (point > far)).any(1)
        found.add_once(outside, lambda row: f"x_m, y_m and z_m must lie in the box of {shortest(box.size_x)} by {shortest(box.size_y)} m, "
                                            f"got {shortest(point[row, 0])}, {shortest(point[row, 1])} and {shortest(point[row, 2])}: "
                                            "divide by 1000 if they are in millimetres")
    found.add_once(which & (force > largest_force),
                   lambda row: f"fx_N, fy_N and fz_N must be in newtons: {shortest(force[row])} is more than such grains can carry; divide "
                               "by 1000 if it is in millinewtons")


def _check_twice(found: RowProblems, contacts: Contacts, which: Bools) -> None:
    """Contacts of one pair in one frame are told when the frame is complete, by grain and partner."""
    line, frame = found.table.line, found.table["frame"]
    rows = np.flatnonzero(which)
    grain, partner = contacts.grain[rows], contacts.partner[rows]
    is_reversed = (partner >= 0) & (partner < grain)
    one, other = np.where(is_reversed, partner, grain), np.where(is_reversed, grain, partner)
    order = np.lexsort((other, one, frame[rows]))
    same = np.flatnonzero((np.diff(frame[rows][order]) == 0) & (np.diff(one[order]) == 0) & (np.diff(other[order]) == 0))
    if not len(same):
        return
    again, first = rows[order[same + 1]], rows[order[same]]
    line_of_first = dict(zip(again.tolist(), line[first].tolist()))
    next_row = np.searchsorted(frame[rows], frame[again], "right")
    told_at = np.append(line[rows], AT_END)[next_row]
    found.add_at(again, told_at, lambda row: f"this contact is there twice in frame {frame[row]}, first in line {line_of_first[row]}: list "
                                             "each pair once")


def _with_contacts(recording: Recording, contacts: Contacts, frame: Ints) -> Recording:
    """`frame` of each contact, which does not fall. A contact that is listed from the side of its second grain is reversed."""
    grain, partner = contacts.grain, contacts.partner
    swapped = (partner >= 0) & (partner < grain)
    force = np.where(swapped[:, None], -contacts.force, contacts.force)
    everyone = Contacts(np.where(swapped, partner, grain), np.where(swapped, grain, partner), contacts.point, force, contacts.overlap)
    by_scan = list(recording.scans.contacts)
    numbers, start = np.unique(frame, return_index=True)
    for number, first, end in zip(numbers.tolist(), start.tolist(), [*start[1:].tolist(), len(frame)]):
        by_scan[number] = everyone.rows(slice(first, end))
    return replace(recording, scans=replace(recording.scans, contacts=tuple(by_scan)))
