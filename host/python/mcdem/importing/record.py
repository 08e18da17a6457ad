"""A testing machine's record as a programme: guessed for the mapping, imported, and shown in a picture."""
import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from ..number_text import shortest
from ..problems import Problems
from .arrays import Floats
from .course import CLEAR_FIT, SMALL_TARE, Contact, Course, Scans, contact_of, course_of, row_at, thinned
from .mapping import UNCLEAR, Known, MappedTable, guess, signed_column
from .names import RATIO_KEYS
from .plate import SOLID_KEYS, PlateRows, import_plate
from .rows import ImportTable, whole_entry

ABOVE_ALL = 1e6  # height from which displacements count, where it does not matter
MIN_ROWS = 50  # of a record; with fewer every row is a scan
SMALL_GAP = 0.01  # of the stroke
SCANS, MOST_SCANS = 20, 1000  # of each stage


@dataclass
class Programme:
    course: Course
    scans: Scans
    plate: pd.DataFrame
    start: float  # height of the plate at the contact [m]

    @property
    def text(self) -> str:
        """[[programme]] of experiment.toml."""
        return "".join("\n[[programme]]\n" + "".join(f"{key} = {_toml(value)}\n" for key, value in stage.items()) for stage in self.scans.stages)


def _toml(value: Any) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else shortest(value)


def _course_of(plate: PlateRows, problems: Problems) -> Course | None:
    known = np.isfinite(plate.time + plate.z + plate.force)
    rows, where = plate.rows, np.flatnonzero(known)
    falls = 1 + np.flatnonzero(np.diff(plate.time[where]) < 0)
    if rows is not None and len(falls):
        at, before = plate.time[where[falls[0]]], plate.time[where[falls[0] - 1]]
        rows.problem_once("time", where[falls[0]], f"time must not fall, got {shortest(at)} after {shortest(before)} s: give one test a table, with "
                          "the time since its start")
    return None if problems.count or len(falls) or known.sum() < 3 else course_of(plate.time[known], plate.z[known], plate.force[known])


def _as_it_counts(mapped: MappedTable, z: float, start: float) -> float:
    """The value of the place's column at the height z, both in the table's unit."""
    sign = signed_column(mapped.word(mapped.place))[0]
    return sign * z if mapped.place == "plate_z" else sign * (start - z)


def _plain(table: ImportTable) -> ImportTable:
    """A record whose numbers are taken as SI units."""
    words = {"length_unit": "m", "force_unit": "N", "ratio_unit": "1", "origin_z": "0", "course": "stages"}
    return table.changed(**{key: guess(word, "stated", "") for key, word in words.items()})


def guess_course(table: ImportTable, known: Known, alone: bool) -> None:
    """Of a plate's table with times and many rows that stands `alone`: no frames of grains belong to its rows."""
    mapped = table.map
    if not alone or known.programme or "time" not in mapped or mapped.place in ("", *SOLID_KEYS):
        return
    start, problems = float(mapped.place in RATIO_KEYS), Problems()
    plate = import_plate(_plain(table), start, Problems(), True)
    course = _course_of(plate, problems) if len(plate) >= MIN_ROWS else None
    contact = contact_of(course) if course else None
    if course is None or contact is None:
        return
    if mapped.word("frame") == mapped.word("time"):
        mapped.entries.pop("frame", None)
    mapped["course"] = guess("stages", "likely", f"{len(plate)} rows of one record: {'; '.join(_told(course, mapped))}")
    mapped["scans"] = guess(str(SCANS), "likely", "of each move and hold")
    _note_contact(mapped, course, contact, start)


def _told(course: Course, mapped: MappedTable) -> Iterator[str]:
    unit = mapped.word("length_unit", "of its units") if mapped.place not in RATIO_KEYS else "of strain"
    for leg in course.legs:
        change, duration = course.change(leg), course.duration(leg)
        if leg.kind == "move":
            yield f"{'up' if change > 0 else 'down'} by {abs(change):.3g} {unit} at {course.steady_speed(leg):.3g}/s"
        else:
            yield f"{'held' if leg.kind == 'hold' else 'force held'} for {duration:.3g} s"


def _note_contact(mapped: MappedTable, course: Course, contact: Contact, start: float) -> None:
    z = float(np.interp(contact.row, np.arange(len(course.z)), course.z))
    rise = float(course.force.max() - contact.tare)
    clear = contact.error < CLEAR_FIT
    mapped["contact"] = guess(f"{_as_it_counts(mapped, z, start):.6g}", "likely" if clear else UNCLEAR, "there the force of the first load begins"
                              + ("" if clear else f"; uncertain, for the force differs from a smooth rise by {100 * contact.error:.0f} %"))
    sign, small = -1 if mapped.word("force_sign") == "-" else 1, abs(contact.tare) < SMALL_TARE * rise
    mapped["tare"] = guess(f"{sign * contact.tare:.6g}", "likely" if small else UNCLEAR, f"the force before, {100 * abs(contact.tare) / rise:.2g} % of "
                           "the largest" + ("" if small else ": is it the machine's zero, or a load at the start? Then write 0"))


def import_course(table: ImportTable, known: Known, problems: Problems) -> Programme | None:
    """None if there are problems."""
    mapped, start = table.map, known.plate_start
    count = whole_entry(mapped, "scans", problems) if "scans" in mapped else SCANS
    if not 1 <= count <= MOST_SCANS:
        problems.add(mapped.files[0], f"scans must be between 1 and {MOST_SCANS}, got {count}: see the mapping")
    plate = import_plate(table, start, problems, True)
    course = _course_of(plate, problems) if len(plate) else None
    if course is None or problems.count:
        return None
    leg = course.first_load()
    if leg is None:
        problems.add(mapped.files[0], 'must have a move of the plate downwards that loads it, got none: write course = "rows" in the mapping')
        return None
    sign = signed_column(mapped.word(mapped.place))[0]
    level = mapped.length_factor() * sign * (mapped.number("contact") - mapped.number("origin_z")) if mapped.place == "plate_z" else start
    row = row_at(course, leg, np.fmin(level, start))
    scans, rows = thinned(course, row, count), np.arange(len(course.z))
    if level > start + SMALL_GAP * course.stroke or course.z.min() <= 0 or not scans.stages:
        problems.add(mapped.files[0], f"the plate must touch at plate.start or below it and stay above the floor, got a contact at {level:.4g} m, plate.start "
                     f"at {start:.4g} m and the lowest position at {course.z.min():.4g} m: see {mapped.place}, length_unit and contact in the mapping")
        return None
    time, z, force = (np.interp(scans.row, rows, values) for values in (course.time, course.z, course.force))
    start = z[0] if np.isnan(start) else start
    for stage in scans.stages:
        if "position" in stage:
            stage["position"] = min(stage["position"], start)
    table_of = pd.DataFrame({"frame": np.arange(len(z)), "cycle": scans.cycle, "phase": np.where(np.array(scans.unloads) == 1, "unload", "load"),
                             "plate_z_m": np.minimum(z, start), "top_force_N": force, "time_s": time})
    return Programme(course, scans, table_of, start)


def picture_of(table: ImportTable) -> bytes | None:
    """PNG of the record with its moves, holds, contact and scans, in the table's units; None if it cannot be read."""
    start = {"plate_z": np.nan, "strain": 1.0}.get(table.map.place, ABOVE_ALL)
    programme = import_course(_plain(table), Known(plate_start=start), Problems())
    if programme is None:
        return None
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    mapped, course, scans = table.map, programme.course, programme.scans
    is_strain = mapped.place in RATIO_KEYS
    down, force = programme.start - course.z, course.force
    seen = [np.interp(scans.row, np.arange(len(course.z)), values) for values in (course.time, down, force)]
    names = "time [s]", "strain" if is_strain else f"displacement [{mapped.word('length_unit')}]", f"force [{mapped.word('force_unit')}]"
    figure = Figure(figsize=(11, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, (x, y) in zip(figure.subplots(1, 3), ((0, 1), (0, 2), (1, 2))):
        values: tuple[Floats, Floats, Floats] = (course.time, down, force)
        for leg in course.legs:
            rows = slice(leg.first, leg.last + 1)
            colour = {"hold": "tab:orange", "creep": "tab:green"}.get(leg.kind, "tab:blue" if course.change(leg) < 0 else "tab:purple")
            axes.plot(values[x][rows], values[y][rows], color=colour, linewidth=1)
        axes.plot(seen[x], seen[y], ".", color="black", markersize=3)
        axes.plot(seen[x][:1], seen[y][:1], "o", color="tab:red", markersize=6)
        axes.axhline(0, color="lightgrey", linewidth=0.6, zorder=0)
        axes.set_xlabel(names[x])
        axes.set_ylabel(names[y])
    figure.suptitle("blue: down; purple: up; orange: position held; green: force held; red: contact; black: scans", fontsize=9)
    page = io.BytesIO()
    figure.savefig(page, format="png", dpi=110, metadata={"Software": "mcdem figure"})
    return page.getvalue()
