"""The plate's table: height and force by row; phases and cycles from reversals if there are no columns for them."""
from typing import Any

import numpy as np

from ..number_text import shortest
from ..problems import Problems, quoted
from .arrays import Floats, Ints
from .mapping import MappedTable, signed_column
from .names import RATIO_KEYS, TIMES, column_name
from .rows import FrameIndex, ImportTable, Rows

TURN = 0.01  # of the stroke: smaller reversals are noise
PRESSED = 0.1  # of the whole way, below the start
LOAD, UNLOAD = 0, 1
SOLID_KEYS = RATIO_KEYS[1:]  # without the strain
BOTH = 2  # in a row's phase: the plate's way tells which
PHASES = {**dict.fromkeys("load loading down compression compress belastung reload reloading wiederbelastung".split(), LOAD),
          **dict.fromkeys("unload unloading up decompression decompress entlastung".split(), UNLOAD),
          **dict.fromkeys("unloadreload unloadingreloading loadunload cycle hold".split(), BOTH)}


class PlateRows:
    def __init__(self, z: Any = (), force: Any = (), keys: Any = (), rows: Rows | None = None) -> None:
        self.z, self.force = np.asarray(z, float), np.asarray(force, float)  # [m], upward force on it [N]
        self.index, self.rows = FrameIndex(keys), rows  # `rows` for messages
        self.time = self.set_force = np.full(len(self.z), np.nan)  # [s], [N]; of a programme
        self.phase = np.zeros(len(self.z), int)
        self.cycle = np.zeros(len(self.z), int)

    def __len__(self) -> int:
        return len(self.z)


def _phases(z: Floats) -> Ints:
    """A phase starts after the lowest or highest position before a reversal."""
    turn, phase, now, extreme = TURN * (z.max() - z.min()), np.zeros(len(z), int), LOAD, 0
    for i in range(1, len(z)):
        back = (z[i] - z[extreme]) * (1 if now == LOAD else -1)
        phase[i] = now
        if back <= 0:
            extreme = i
        elif back > turn:
            now = 1 - now
            phase[extreme + 1:i + 1] = now
            extreme = i
    return phase


def check_heights(plate: PlateRows, start: float, first: int) -> None:
    """Heights of the rows from `first` on."""
    if plate.rows is None or not np.isfinite(plate.z[first:]).any():
        return
    rows, goes_down = plate.rows, plate.rows.map.place != "plate_z"
    for low in np.flatnonzero(plate.z <= 0)[:1]:
        rows.problem_once("plate", low, f"the plate must be over the floor, got a height of {plate.z[low]:g} m: see length_unit"
                          + (" and plate.start" if goes_down else ", plate_z and origin_z"))
    highest, down = first + int(np.nanargmax(plate.z[first:])), np.nanmin(plate.z[first:])
    high = plate.z[highest]
    # Positions slightly above the start are noise; a plate that sticks is pulled beyond it after it has pressed.
    if high - start > 1e-9 * high and start - down < PRESSED * (high - down):
        rows.problem(highest, f"the plate must go down from plate.start, {start:g} m, got {high:g} m: "
                     + ("displacements count downwards, write a - before the column's name where it counts upwards" if goes_down
                        else "see length_unit, and --set plate.start=.."))


def _read_phases(rows: Rows, plate: PlateRows, problems: Problems) -> None:
    if "phase" in rows:
        for i in range(len(rows)):
            text = rows.text(i, "phase")
            plate.phase[i] = PHASES.get(column_name(text).base, -1)
            if plate.phase[i] < 0:
                rows.problem(i, f"phase must be load or unload, got {quoted(text)}")
        if not problems.count:
            plate.phase = np.where(plate.phase == BOTH, _phases(plate.z), plate.phase)
    elif not problems.count:
        plate.phase = _phases(plate.z)
    if "cycle" in rows:
        cycle = np.nan_to_num(rows.whole_number("cycle"))
        plate.cycle = (cycle - cycle[0]).astype(int)  # many tables count from 1
        for i in 1 + np.flatnonzero(np.diff(plate.cycle) < 0)[:1]:
            rows.problem_once("cycle", i, "cycle must not fall: sort the rows by time")
    else:
        plate.cycle = np.cumsum(np.diff(plate.phase, prepend=LOAD) == LOAD - UNLOAD)


def needs_start(mapped: MappedTable) -> bool:
    """Whether heights follow from plate.start."""
    return mapped.place not in ("", "plate_z") and not (mapped.place in SOLID_KEYS and "solid_volume" in mapped)


def _heights(rows: Rows, start: float) -> Floats:
    """Of the plate [m]. `start`: the height at no displacement and no strain, and of the first row where the grains' volume is unknown."""
    mapped, key = rows.map, rows.map.place
    values = rows.number(key) - (mapped.number("contact") * signed_column(mapped.word(key))[0] if key in ("displacement", "strain") else 0)
    if key == "plate_z":
        return np.asarray(mapped.length_factor() * (values - mapped.number("origin_z") * signed_column(mapped.word(key))[0]))
    if key not in RATIO_KEYS:
        return np.asarray(start - mapped.length_factor() * values)
    ratio = values * (0.01 if mapped.word("ratio_unit") == "%" else 1)
    if key == "strain":
        return np.asarray(start * (1 - ratio))
    with np.errstate(divide="ignore", invalid="ignore"):
        solid = 1 / (1 + ratio) if key == "void_ratio" else 1 - ratio if key == "porosity" else ratio
    for i in np.flatnonzero((solid <= 0) | (solid > 1))[:1]:
        rows.problem_once("ratio", i, f"{key} must leave grains a part > 0 and <= 1 of the volume, got {solid[i]:.4g}: see ratio_unit")
        return np.full(len(values), np.nan)
    if "solid_volume" in mapped:
        return np.asarray(mapped.number("solid_volume") / (mapped.number("area") * solid))
    return np.asarray(start * solid[0] / solid)


def import_plate(table: ImportTable, start: float, problems: Problems, programme: bool = False) -> PlateRows:
    """Heights require `start` [m] (NaN if unknown) if the table contains displacements. Rows of a programme require
    times."""
    mapped, rows = table.map, Rows(table, problems)
    forces = ("mean_stress", "deviator_stress") if "mean_stress" in rows else ("top_force",)
    if rows.lacks(*forces, mapped.place or "plate_z", *["time"] * programme) or not len(rows):
        return PlateRows()
    rows.expect_quantity("pressure" if mapped.is_pressure else "force", ("top_force", "set_force"))
    rows.expect_quantity("length", [key for key in ("plate_z", "displacement") if key == mapped.place])
    keys = rows.key if rows.keyed else np.arange(len(rows), dtype=float)
    force_unit = mapped.force_factor() * (-1 if mapped.word("force_sign") == "-" else 1)
    force = sum(part * rows.number(key) for key, part in zip(forces, (1, 2 / 3))) - mapped.number("tare")
    plate = PlateRows(_heights(rows, start), force_unit * force, keys, rows)
    for i in 1 + np.flatnonzero(~(np.diff(keys) > 0))[:1]:
        rows.problem_once("order", i, f"frame must rise from row to row, got {shortest(keys[i])} after {shortest(keys[i - 1])}: "
                          "repair the table, give each test as a table of its own, or leave frame out of the mapping where frames_by is order")
    if programme:
        plate.time = rows.number("time") * TIMES.get(column_name(mapped.word("time")).unit, 1)
    if programme and "set_force" in rows:
        stated = rows.stated("set_force")
        plate.set_force = np.where(stated, force_unit * rows.number("set_force", stated), np.nan)
    if mapped.word("course") != "stages":
        _read_phases(rows, plate, problems)
    return plate
