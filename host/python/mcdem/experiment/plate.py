"""plate.csv: one scan for each row. Those of a programme must be its scans, in order."""
import math
import pathlib
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..number_text import shortest
from ..problems import Problems, quoted
from ..results.names import Phase, Wall, all_names, parse
from ..results.recording import NO_CONTACTS, NO_VECTORS, Bools, Recording, Scans
from ..results.run_file import KINDS, ROW_SHAPES, SCAN_FIELDS
from .row_problems import RowProblems
from .table import NUMBER, NUMBER_OR_NOTHING, WHOLE, Kind, Table, read_table

PHASE = Kind(lambda word: parse(Phase, word), lambda word: f"must be one of {all_names(Phase)}, got {quoted(word)}")
COLUMNS = {"frame": WHOLE, "cycle": WHOLE, "phase": PHASE, "plate_z_m": NUMBER, "top_force_N": NUMBER}
OF_PROGRAMMES = {"set_force_N": NUMBER_OR_NOTHING, "time_s": NUMBER}
PLATE_COLUMNS = tuple(COLUMNS)
MAX_FRAMES = 1_000_000  # as of a scene
LARGEST_HEIGHT = 20  # plate height over the width of the box; a larger one is not in metres
# Rows with larger deviations belong to other scans; relative to the stroke, the force and the duration of the hold.
FAR_POSITION, FAR_FORCE, FAR_TIME = 0.25, 0.5, 0.1
OTHER_FORCE = 0.01  # relative to the prescribed force
IN_ORDER = "state the stages in their order, with their scans"


def read_plate(file: pathlib.Path, modulus: float, recording: Recording, problems: Problems, largest: int) -> Recording:
    """The recording with its scans. `modulus`: Young's modulus of the grains [Pa], infinite if unknown, limits the plausible forces.

    Raises InputError, RunError, OSError.
    """
    table = read_table(file, COLUMNS, OF_PROGRAMMES, largest, problems)
    if table is None:
        return recording
    if len(table) > MAX_FRAMES:
        problems.add(table.where(int(table.line[MAX_FRAMES])), f"must have at most {MAX_FRAMES} frames")
        return recording
    found = RowProblems(table)
    _check_rows(found)
    _check_values(found, modulus, recording)
    recording = _with_scans(recording, table)
    if "time_s" in table.values:
        found.add_wrong("time_s")
        time, before = recording.scans.time, np.append(-np.inf, recording.scans.time[:-1])
        found.add(table.valid("time_s") & ~(time > before),
                  lambda row: f"time_s must rise from row to row, got {shortest(time[row])} after {shortest(before[row])}: sort the rows "
                              "by time")
    if "set_force_N" in table.values:
        found.add_wrong("set_force_N")
    found.report(problems)
    if not problems.count and recording.has_programme:
        _check_programme(table, recording, problems)
    return recording


def _check_rows(found: RowProblems) -> None:
    table = found.table
    frame, cycle, row_numbers = table["frame"], table["cycle"], np.arange(len(table))
    before = np.append(0, _filled(cycle, table.valid("cycle"), 0)[:-1])
    found.add_wrong("frame", "cycle")
    found.add(table.valid("frame") & (frame != row_numbers),
              lambda row: f"frame must be {row}, got {frame[row]}: frames count from 0, one a row, in the order of the measurement")
    found.add(table.valid("cycle") & (cycle < before),
              lambda row: f"cycle must not fall, got {cycle[row]} after {before[row]}: sort the rows by time")
    found.add_wrong("phase", "plate_z_m", "top_force_N")


def _check_values(found: RowProblems, modulus: float, recording: Recording) -> None:
    z, force, box = found.table["plate_z_m"], found.table["top_force_N"], recording.box
    width, largest_force = max(box.size_x, box.size_y), modulus * box.size_x * box.size_y
    found.add(z <= 0, lambda row: f"plate_z_m must be > 0 [m], the height of the plate over the floor, got {shortest(z[row])}")
    found.add_once((width > 0) & (z > LARGEST_HEIGHT * width),
                   lambda row: f"plate_z_m must be in metres: {shortest(z[row])} is more than {LARGEST_HEIGHT} times the box's width of "
                               f"{shortest(width)} m; divide by 1000 if it is in millimetres")
    found.add_once((largest_force > 0) & (np.abs(force) > largest_force),
                   lambda row: f"top_force_N must be in newtons: {shortest(force[row])} is a pressure beyond Young's modulus, "
                               f"{shortest(modulus)} Pa; divide by 1000 if it is in millinewtons, or correct grains.youngs_modulus if it "
                               "is not in Pa")


def _filled(values: NDArray[Any], valid: Bools, first: float) -> NDArray[Any]:
    """With the last valid value before it in place of each that is not; `first` where there is none."""
    last = np.maximum.accumulate(np.where(valid, np.arange(len(values)), -1))
    return np.where(last < 0, first, values[last])


def _with_scans(recording: Recording, table: Table) -> Recording:
    count = len(table)
    values: dict[str, Any] = {name: np.full((count, *ROW_SHAPES.get(name, ())), np.nan) for name in SCAN_FIELDS if name not in KINDS}
    values["strain"][:] = 0
    values["plate_z"] = np.where(table.valid("plate_z_m"), table["plate_z_m"], 1)
    values["wall_force"][:, Wall.plate, 2] = table["top_force_N"]
    if "time_s" in table.values:
        values["time"] = _filled(table["time_s"], table.valid("time_s"), 0)
    nothing = (NO_VECTORS,) * count
    scans = Scans(frame=np.arange(count), cycle=table["cycle"], phase=table["phase"], settled=np.ones(count, bool), **values,
                  position=nothing, rotation=nothing, contacts=(NO_CONTACTS,) * count)
    return replace(recording, scans=scans)


def scan_places(recording: Recording) -> list[dict[str, Any]]:
    """Where and how the stages of the programme place each scan after that at rest (_engine.scan_places)."""
    from .. import _engine
    return _engine.scan_places(recording.parameters, recording.plate_start)


def set_forces(recording: Recording) -> list[float | None]:
    """By scan, the prescribed force [N]; None if the programme does not prescribe one."""
    forces: list[float | None] = [None] * len(recording.scans)
    before, leg = math.nan, -1  # force kept by a hold that does not set one
    for scan, place in enumerate(scan_places(recording)[:max(len(forces) - 1, 0)], 1):
        if place["leg"] != leg:
            before, leg = float(recording.scans.top_force[scan - 1]), place["leg"]
        is_set = not math.isnan(place["set"])
        if place["by"] == "force" and (is_set or place["held"]):
            forces[scan] = place["set"] if is_set else before
    return forces


def _check_programme(table: Table, recording: Recording, problems: Problems) -> None:
    """Rows that do not match the scans of the recording's programme are problems."""
    if "time_s" not in table.values:
        problems.add(table.where(1), "the header must name time_s where experiment.toml states a [[programme]]: when each row was measured "
                                     "[s]")
        return
    scans, places = recording.scans, scan_places(recording)
    if len(table) != len(places) + 1:
        problems.add(table.name, f"must have {len(places) + 1} rows, one of the packing at rest and one for each of the {len(places)} "
                                 f"scans of [[programme]] in experiment.toml, got {len(table)}: state the scans of its stages as they "
                                 "were measured (scans, scan_at)")
        return
    stroke = float(np.max(recording.displacement, initial=0))  # [m]
    stated_force = table.values.get("set_force_N", np.full(len(table), np.inf))  # infinite: not prescribed
    before: dict[str, Any] = {"leg": None}
    for row, place in enumerate(places, 1):
        stage, goal, force = f"stage {place['stage'] + 1} of [[programme]] in experiment.toml", place["set"], stated_force[row]

        def problem(what: str) -> None:
            problems.add(table.where(int(table.line[row])), what)

        if place["by"] == "force":
            _check_force(float(scans.top_force[row]), force, goal, stage, problem)
        else:
            if np.isfinite(force):
                problem(f"set_force_N must be empty, got {shortest(force)}: {stage} sets a position")
            if abs(scans.plate_z[row] - goal) > FAR_POSITION * stroke:
                problem(f"plate_z_m must be near {goal:.6g} m, which {stage} sets, got {shortest(scans.plate_z[row])}: {IN_ORDER}")
        if place["held"] and before["leg"] == place["leg"]:
            interval, time = place["time"] - before["time"], scans.time[row] - scans.time[row - 1]
            if abs(time - interval) > FAR_TIME * recording.value(f"programme.{place['stage'] + 1}.time"):
                problem(f"time_s must be {interval:.6g} s after the row before, as {stage} holds, got {time:.6g} s: state when the hold was "
                        "scanned (time, scans, scan_at)")
        before = place


def _check_force(top: float, force: float, goal: float, stage: str, problem: Callable[[str], None]) -> None:
    """`force`: that of the row, infinite if it states none; `goal`: that of the stage, NaN if it sets none [N]."""
    if not np.isfinite(force):
        force = goal
    if abs(force - goal) > OTHER_FORCE * goal:
        problem(f"set_force_N must be {goal:.6g} N, which {stage} sets, got {shortest(force)}: {IN_ORDER}")
    elif abs(top - force) > FAR_FORCE * force:
        problem(f"top_force_N must be near {force:.6g} N, which {stage} sets, got {shortest(top)}: {IN_ORDER}")
