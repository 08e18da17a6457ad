"""Guesses units and sign of the plate's table: its position from the grains below it, its force from their forces on it."""
import numpy as np

from ..number_text import shortest
from ..problems import Problems
from .arrays import Floats
from .contacts import import_contacts, wall_partner
from .grains import GrainFrames
from .guess_contacts import ROUGH, decide_force_unit, hertz_force
from .guess_names import has_force, note_units
from .guess_lengths import decide_unit, fitting_units, length_factors, state_voxel_size
from .mapping import UNCLEAR, Known, MappedTable, guess, signed_column
from .names import PERCENT, RATIO_KEYS, LENGTHS, column_name, columns_by_key
from .plate import SOLID_KEYS, PlateRows, import_plate
from .record import guess_course
from .rows import ImportTable, of_role


class _Plate:
    """The plate's rows, their raw numbers taken as m and N, and those of frames of the grains."""

    def __init__(self, table: ImportTable, start: float, grains: GrainFrames) -> None:
        plain = {key: guess(word, "stated", "") for key, word in (("length_unit", "m"), ("force_unit", "N"), ("force_sign", "+"))}
        start = start if np.isfinite(start) else float(table.map.place in RATIO_KEYS)
        self.rows = rows = import_plate(table.changed(**plain), start, Problems(), "time" in table.map)
        self.grains = grains
        row = rows.index.find(grains.keys) if not grains.row else np.array(grains.row, int)
        # Frames refer to the first table of the plate; a second one may be shorter.
        self.frames = np.flatnonzero((row >= 0) & (row < len(rows)))
        self.row = row[self.frames]
        self.z, self.force = rows.z[self.row], np.abs(rows.force[self.row])

    def force_ratio(self, expected: Floats) -> float:
        """Median over the loaded frames of the ratio of the table's force to the expected one of each of `frames`."""
        loaded = (self.force > 0.2 * np.fmax.reduce(np.abs(self.rows.force))) & (expected > 0)
        return float(np.median(self.force[loaded] / expected[loaded])) if loaded.any() else np.nan


def _pulls_and_pushes(force: Floats) -> bool:
    """Whether forces of both signs are more than an error of the zero: a plate that sticks is pulled on its way back."""
    low, high = force.min(initial=0), force.max(initial=0)
    return bool(min(-low, high) > 0.1 * max(-low, high))


def _first_way(z: Floats, force: Floats) -> int:
    """The direction of the first move that loads a plate which begins without a force: -1 down, 1 up; 0 if it begins under force."""
    size = np.abs(force)
    moved = np.flatnonzero(np.abs(z - z[0]) > 0.2 * np.ptp(z))
    if not len(moved) or size[0] > 0.2 * size.max() or size[:moved[0] + 1].max() < 1e-3 * size.max():
        return 0
    return int(np.sign(z[moved[0]] - z[0]))


def _guess_downwards(mapped: MappedTable, rows: PlateRows) -> None:
    """Guesses the direction: the force increases while the plate moves down. Its size alone does not tell it of a plate that sticks:
    where sizes, signs and the first move disagree, the direction must be confirmed."""
    place, known = mapped.place, np.isfinite(rows.z + rows.force)
    if len(rows) < 3 or place in SOLID_KEYS or mapped[place].certainty == UNCLEAR or not known.any():
        return
    known[:-1] &= ~(np.diff(rows.time) == 0)  # machines repeat a time before they start
    z, force = rows.z[known], rows.force[known]
    above, below = (np.abs(force[at]).mean() for at in (z >= z.max() - 0.2 * np.ptp(z), z <= z.min() + 0.2 * np.ptp(z)))
    first, by_size = _first_way(z, force), 1 if above > 2 * below else -1 if below > 2 * above else 0
    word = mapped.word(place)
    ends = f"its force is {above:.4g} at the upper end and {below:.4g} at the lower one if the column is taken as it is"
    sticks = _pulls_and_pushes(force)
    if by_size <= 0 and first <= 0 and not (sticks and 0 in (by_size, first)):
        return
    if by_size > 0 and first >= 0 and not (sticks and first == 0):
        mapped[place] = guess("-" + word, "sure", f"{ends}, and the plate presses on its way down")
    else:
        reverse = first > 0 or (first == 0 and z[0] > (z.min() + z.max()) / 2)
        way = "first moves " + ("up" if first > 0 else "down") if first else "begins under force"
        mapped[place] = guess("-" + word if reverse else word, UNCLEAR, f"{ends}, where the plate {way}, and a plate that sticks is pulled on "
                              "its way back: does the column count upwards? Then write a - before its name, otherwise none")


def _guess_origin(mapped: MappedTable, plate: _Plate, factors: dict[str, float], unit_of_grains: str) -> None:
    """The origin of a plate below 0 is not the floor; that of a downward column that does not touch the grains at its
    lowest position may be elsewhere as well."""
    if mapped.place != "plate_z" or not np.isfinite(plate.rows.z).any():
        return
    lowest = int(np.nanargmin(plate.rows.z))
    height, frames = plate.rows.z[lowest], plate.frames[plate.row == lowest]
    top = plate.grains.top(frames[-1]) if len(frames) else 0.0
    sign, column = signed_column(mapped.word("plate_z"))
    rests = top > 0 and fitting_units(factors, height, top, 0.85, 1.15)
    if height > 0 and (sign > 0 or rests):
        return
    mapped["origin_z"] = guess(f"{sign * (height - top / (mapped.length_factor(unit_of_grains) or 1)):.6g}" if top > 0 else "0", UNCLEAR,
                               f"counted from 0 the plate would be at {height:.4g} at the lowest: where is the floor, as {column} counts?")


def _units_above_floor(rows: PlateRows, start: float) -> list[str]:
    """Units in which displacements leave the plate above the floor, the largest first."""
    down = start - np.nanmin(rows.z) if np.isfinite(rows.z).any() else np.nan
    return [unit for unit, factor in sorted(LENGTHS.items(), key=lambda unit: -unit[1]) if 0 < down * factor < start]


def _prefer_displacement(table: ImportTable, tables: list[ImportTable], known: Known) -> None:
    """To a height as the machine counts it, where plate.start tells the height and no grains do."""
    if table.map.place == "plate_z" and known.plate_start > 0 and not of_role(tables, "grains"):
        if len(names := columns_by_key("plate", table.parts[0].columns).get("displacement", [])) == 1:
            table.map.entries.pop("plate_z")
            table.map["displacement"] = guess(names[0], "sure", "its name, and plate.start tells the height")
            table.map.entries.pop("length_unit", None)
            note_units(table.map)


def _guess_ratio(mapped: MappedTable, rows: PlateRows) -> None:
    """The unit of a strain, or of what tells the volume of the grains: a part of the volume is not above 1."""
    key = mapped.place
    assert rows.rows is not None
    name, largest = column_name(signed_column(mapped.word(key))[1]).unknown.lower(), np.nanmax(np.abs(rows.rows.number(key)), initial=0)
    most = {"strain": 1.0, "void_ratio": np.inf}.get(key, 1.5)  # estimates of a part may be above 1
    unit = "%" if name in PERCENT or (not name and largest > most) else "1"
    if name in PERCENT | {"-", "1", "mm/mm", "m/m"}:
        mapped["ratio_unit"] = guess(unit, "sure", "the column's name says so")
    else:
        sure = unit == "%" or key != "strain" and 0.1 < largest <= 1 or key == "void_ratio"
        mapped["ratio_unit"] = guess(unit, "sure" if sure else UNCLEAR, f"no name says it, and its values reach {largest:.4g}")


def _guess_area(mapped: MappedTable, known: Known) -> None:
    """What a pressure, or the volume of the grains, refers to."""
    if known.solid_volume > 0 and mapped.place in SOLID_KEYS:
        mapped["solid_volume"] = guess(shortest(known.solid_volume), "sure", "--mass over --solid-density")
    if mapped.is_pressure or "solid_volume" in mapped:
        told, area = ("--area says so", known.area) if known.area > 0 else ("the cross-section of the container", known.section)
        mapped["area"] = guess(shortest(area), "sure", told) if area > 0 else guess("1", UNCLEAR, "--area, or the container's size, would tell")


def _guess_height(mapped: MappedTable, plate: _Plate, start: float, factors: dict[str, float]) -> None:
    """The unit in which the plate touches the grains at its lowest position."""
    grains, fits, seen = plate.grains, [], ""
    goes_down = mapped.place == "displacement"
    if mapped.place in RATIO_KEYS:
        _guess_ratio(mapped, plate.rows)
        return
    if np.isfinite(plate.z).any() and not (goes_down and np.isnan(start)):
        lowest = np.nanargmin(plate.z)
        z, top, first_top = plate.z[lowest], grains.top(plate.frames[lowest]), grains.top(0)
        if goes_down:
            down = start - z
            fits = [unit for unit, factor in factors.items()
                    if 0.85 * top < start - down * factor < 1.15 * top and down * factor > 0.3 * (first_top - top) - 1e-12]
            seen = f"displacements reach {down:.4g}, the grains sink from {first_top:.4g} to {top:.4g} m"
        else:
            fits = fitting_units(factors, z, top, 0.6, 1.6)
            seen = f"at the lowest the plate is at {z:.4g}, the grains reach up to {top:.4g} m"
    if "length_unit" not in mapped or (seen and mapped.word("length_unit") in factors):
        likely, unknown = "m", "there are no grains to compare with"
        if goes_down and np.isnan(start):
            unknown = "plate.start is not known: --set plate.start=.. would tell"
        elif goes_down and (units := _units_above_floor(plate.rows, start)):
            likely, unknown = "mm" if "mm" in units else units[0], f"{unknown}; above the floor the plate stays in {', '.join(units)}"
        elif not seen and start > 0 and not goes_down and np.isfinite(plate.rows.z).any():
            highest = float(np.nanmax(plate.rows.z))
            fits, seen = fitting_units(LENGTHS, highest, start, 0.4, 2.5), f"at the highest the plate is at {highest:.4g}, and plate.start is {start:g} m"
        decide_unit(mapped, "length_unit", fits, seen, (fits[0] if fits else likely, seen or f"no name says it, and {unknown}"))


def _contact_forces(tables: list[ImportTable], grains: GrainFrames) -> Floats:
    """Force of the grains on the plate in each of their frames, from their contacts with it; NaN if none is listed."""
    sums, counts = np.zeros(len(grains.keys)), np.zeros(len(grains.keys))
    for table in of_role(tables, "contacts"):
        if "force_unit" in table.map and table.map["force_unit"].certainty != UNCLEAR:
            frames = import_contacts(table, grains, Problems())
            at = grains.frames_of(table.map.word("frames_by", "plate"), frames.keys)[frames.frame]
            mine = (frames.partner == wall_partner("plate")) & (at >= 0)
            np.add.at(sums, at[mine], -frames.force[mine, 2])
            np.add.at(counts, at[mine], 1)
    return np.where(counts > 0, sums, np.nan)


def _sign_at_the_lowest(rows: PlateRows) -> str:
    """The sign of the force where the plate is lowest, and the grains push; empty if there is none."""
    known = np.isfinite(rows.z + rows.force)
    z, force = rows.z[known], rows.force[known]
    low = force[z <= z.min() + 0.05 * np.ptp(z)].mean() if known.any() else 0
    return "-" if low < 0 else "+" if low > 0 else ""


def _guess_force(table: ImportTable, others: list[ImportTable], plate: _Plate, known: Known) -> None:
    mapped, force = table.map, plate.rows.force[np.isfinite(plate.rows.force)]
    low, high = force.min(initial=np.inf), force.max(initial=-np.inf)
    larger, deep = "-" if abs(low) > abs(high) else "+", _sign_at_the_lowest(plate.rows)
    clear = (low * high >= 0 or min(abs(low), abs(high)) < 0.3 * max(abs(low), abs(high))) and deep in ("", larger)
    mapped["force_sign"] = guess(deep or larger, "sure" if clear else UNCLEAR, f"forces reach from {low:.4g} to {high:.4g}, and the grains push"
                                 + (f"; at the lowest the sign is {deep}, and the plate may stick on its way back" if not clear and deep else ""))
    ratio, truth = plate.force_ratio(_contact_forces(others, plate.grains)[plate.frames]), "of the contacts with the plate"
    by_hertz = np.isnan(ratio)
    if mapped.is_pressure:
        return
    if by_hertz and len(plate.frames) and mapped.place not in RATIO_KEYS:
        start, radius = known.plate_start if mapped.place == "displacement" else 0, plate.grains.diameter / 2
        tops = np.array(plate.grains.position)[plate.frames, :, 2] + radius
        overlaps = tops - (start - mapped.length_factor() * (start - plate.z))[:, None]
        ratio, truth = plate.force_ratio(hertz_force(known, radius, np.inf, overlaps).sum(axis=1)), "of Hertz from the overlaps with the plate"
    named = mapped.get("force_unit")
    lengths = [other.map.get(key) for other in others for key in ("length_unit", "voxel_size", "origin_z", "same_diameter")]
    if named and by_hertz and (np.isnan(ratio) or any(entry and entry.certainty == UNCLEAR for entry in lengths)):
        return
    # Hertz's law is rough for strong compression and errors of position: a name is more reliable.
    decide_force_unit(mapped, ratio, 1.65 if not by_hertz else 30 if named else ROUGH, f"the largest forces would be {ratio:.3g} times those {truth}",
                      "no name says it, and nothing is known to compare with")


def guess_plate_units(table: ImportTable, tables: list[ImportTable], grains: GrainFrames, known: Known) -> None:
    mapped = table.map
    if not has_force(mapped.entries.keys()) or not mapped.place:
        return
    _guess_area(mapped, known)
    _prefer_displacement(table, tables, known)
    plate = _Plate(table, known.plate_start, grains)
    if not len(plate.rows):
        return
    factors = length_factors(known.voxel_size)
    unit_of_grains = next((other.map.word("length_unit", "m") for other in of_role(tables, "grains")), "m")
    _guess_downwards(mapped, plate.rows)
    state_voxel_size(mapped, known)
    _guess_origin(mapped, _Plate(table, known.plate_start, grains), factors, unit_of_grains)
    plate = _Plate(table, known.plate_start, grains)
    _guess_height(mapped, plate, known.plate_start, factors)
    state_voxel_size(mapped, known)
    _guess_force(table, tables, plate, known)
    guess_course(table, known, not of_role(tables, "grains") and len(of_role(tables, "plate")) == 1)
