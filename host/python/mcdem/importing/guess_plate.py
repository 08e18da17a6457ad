"""Guesses units and sign of the plate's table: its position from the grains below it, its force from their forces on it."""
import numpy as np

from .contacts import import_contacts, wall_partner
from .guess_contacts import FORCE_FACTORS, LIKE_NEWTONS, hertz_force
from .guess_lengths import fitting_units, length_factors, state_voxel_size
from .mapping import UNCLEAR, guess, signed_column
from .plate import import_plate
from .problems import Problems
from .rows import of_role


def _plain_rows(table, start):
    """The plate's table with its raw numbers taken as m and N."""
    plain = {key: guess(word, "stated", "") for key, word in (("length_unit", "m"), ("force_unit", "N"), ("force_sign", "+"))}
    return import_plate(table.changed(**plain), start, Problems())


class _Plate:
    """The plate's rows together with the frames of the grains."""

    def __init__(self, rows, grains):
        self.rows, self.grains = rows, grains
        of_frames = rows.index.find(grains.keys) if grains.row is None else np.array(grains.row, int)
        # Frames refer to the first table of the plate; a second one may be shorter.
        self.row = np.where(of_frames < len(rows), of_frames, -1)

    def lowest_frame(self):
        """The frame with the lowest plate, which touches the grains there, and its height."""
        heights = np.where(self.row >= 0, self.rows.z[self.row], np.inf) if len(self.row) else np.zeros(0)
        return (int(np.argmin(heights)), float(heights.min())) if len(heights) else (0, np.inf)

    def force_ratio(self, truth):
        """Median over the loaded frames of the ratio of the table's force to that of `truth`."""
        force, ratios = np.abs(self.rows.force), []
        for frame in np.flatnonzero(self.row >= 0):
            row, expected = self.row[frame], truth(frame, self.rows.z[self.row[frame]])
            if force[row] > 0.2 * np.nanmax(force) and expected > 0:
                ratios.append(force[row] / expected)
        return float(np.median(ratios)) if ratios else np.nan


def _guess_downwards(mapped, rows):
    """Guesses the direction: the force increases while the plate moves down."""
    place = "displacement" if "displacement" in mapped else "plate_z"
    if len(rows) < 3 or mapped[place].certainty == UNCLEAR or not np.isfinite(rows.z).any():
        return
    low, high, force = np.nanmin(rows.z), np.nanmax(rows.z), np.abs(rows.force)
    above = np.nanmean(force[rows.z >= high - 0.2 * (high - low)])
    below = np.nanmean(force[rows.z <= low + 0.2 * (high - low)])
    if above > 2 * below:
        mapped[place] = guess("-" + mapped.word(place), "sure", f"its force is {above:.4g} at the upper end and {below:.4g} at the lower one "
                              "if the column is taken as it is, and the plate presses on its way down")


def _guess_origin(mapped, plate, factors, grains_factor):
    """The origin of a plate below 0 is not the floor; that of a downward column that does not touch the grains at its
    lowest position may be elsewhere as well."""
    if "plate_z" not in mapped or not np.isfinite(plate.rows.z).any():
        return
    lowest = int(np.nanargmin(plate.rows.z))
    height, frames = plate.rows.z[lowest], np.flatnonzero(plate.row == lowest)
    top = plate.grains.top(frames[-1]) if len(frames) else 0.0
    sign, column = signed_column(mapped.word("plate_z"))
    rests = top > 0 and fitting_units(factors, height, top, 0.85, 1.15)
    if height > 0 and (sign > 0 or rests):
        return
    unit = mapped.length_factor() if "length_unit" in mapped else grains_factor
    mapped["origin_z"] = guess(f"{sign * (height - top / (unit or 1)):.6g}" if top > 0 else "0", UNCLEAR,
                               f"counted from 0 the plate would be at {height:.4g} at the lowest: where is the floor, as {column} counts?")


def _height_fits(plate, start, goes_down, factors):
    """Units in which the plate touches the grains at its lowest position, with the reason."""
    grains = plate.grains
    lowest, lowest_z = plate.lowest_frame()
    if not grains.keys or not np.isfinite(lowest_z) or (goes_down and not np.isfinite(start)):
        return [], ""
    top, first_top = grains.top(lowest), grains.top(0)
    if not goes_down:
        return (fitting_units(factors, lowest_z, top, 0.6, 1.6),
                f"at the lowest the plate is at {lowest_z:.4g}, the grains reach up to {top:.4g} m")
    down = start - lowest_z
    fits = [unit for unit, factor in factors.items()
            if 0.85 * top < start - down * factor < 1.15 * top and down * factor > 0.3 * (first_top - top) - 1e-12]
    return fits, f"displacements reach {down:.4g}, the grains sink from {first_top:.4g} to {top:.4g} m"


def _guess_height(mapped, plate, start, factors):
    goes_down = "displacement" in mapped
    fits, seen = _height_fits(plate, start, goes_down, factors)
    named = mapped.get("length_unit")
    if named and (named.certainty == UNCLEAR or named.word not in factors or (not seen if not fits else named.word in fits)):
        return
    if named:
        mapped["length_unit"] = guess(named.word, UNCLEAR, "the columns' names say so, but " + seen)
    elif len(fits) == 1:
        mapped["length_unit"] = guess(fits[0], "sure", seen)
    else:
        mapped["length_unit"] = guess(fits[0] if fits else "m", UNCLEAR, seen or (
            "no name says it, and plate.start is not known: --set plate.start=.. would tell" if goes_down
            else "no name says it, and there are no grains to compare with"))


def _contact_forces(tables, grains):
    """Force of the grains on the plate in each of their frames, from their contacts with it; NaN if none is listed."""
    sums = np.full(len(grains.keys), np.nan)
    for table in of_role(tables, "contacts"):
        unit = table.map.get("force_unit")
        if not unit or unit.certainty == UNCLEAR:
            continue
        frames = import_contacts(table, grains, Problems())
        at = grains.frames_of(table.map.word("frames_by", "plate"), frames.keys)
        of_plate = np.flatnonzero(frames.partner == wall_partner("plate"))
        for frame, force in zip(at[frames.frame[of_plate]] if len(of_plate) else (), frames.force[of_plate, 2]):
            if frame >= 0:
                sums[frame] = np.nan_to_num(sums[frame]) - force
    return sums


def _unclear_lengths(mapped):
    return any(key in mapped and mapped[key].certainty == UNCLEAR for key in ("length_unit", "voxel_size", "origin_z", "same_diameter"))


def _guess_force(table, others, plate, known):
    mapped, force = table.map, plate.rows.force[np.isfinite(plate.rows.force)]
    low, high = force.min(initial=np.inf), force.max(initial=-np.inf)
    clear = min(abs(low), abs(high)) < 0.3 * max(abs(low), abs(high))
    mapped["force_sign"] = guess("-" if abs(low) > abs(high) else "+", "sure" if clear else UNCLEAR,
                                 f"forces reach from {low:.4g} to {high:.4g}, and the grains push")
    grains, sums = plate.grains, _contact_forces(others, plate.grains)
    start, unit = known.plate_start if "displacement" in mapped else 0, mapped.length_factor()
    by_sum = plate.force_ratio(lambda frame, z: sums[frame])
    by_hertz = plate.force_ratio(lambda frame, z: np.sum(hertz_force(
        known, grains.diameter / 2, np.inf, grains.position[frame][:, 2] + grains.diameter / 2 - start + unit * (start - z))))
    has_sum = np.isfinite(by_sum)
    ratio = by_sum if has_sum else by_hertz
    fits = fitting_units(FORCE_FACTORS, ratio, 1, *((0.6, 1.6) if has_sum else (1 / 3.1, 3.1)))
    seen = f"the largest forces are {ratio:.3g} times those " + (
        "of the contacts with the plate" if has_sum else "of Hertz from the overlaps with the plate") + " [N]" if np.isfinite(ratio) else ""
    named = mapped.get("force_unit")
    if named and not has_sum:  # Hertz's law is rough for strong compression and errors of position
        clear = np.isfinite(ratio) and not any(_unclear_lengths(table.map) for table in (*others, table))
        fits = fitting_units(FORCE_FACTORS, ratio, 1, 1 / 30, 30) if clear else [named.word]
    if named and (named.certainty == UNCLEAR or named.word in fits):
        return
    if named:
        mapped["force_unit"] = guess(named.word, UNCLEAR, "the columns' names say so, but " + seen)
    elif len(fits) == 1:
        mapped["force_unit"] = guess(fits[0], "sure" if has_sum or fits[0] not in LIKE_NEWTONS else UNCLEAR, seen)
    else:
        mapped["force_unit"] = guess("N", UNCLEAR, seen or "no name says it, and nothing is known to compare with")


def guess_plate_units(table, tables, grains, known, voxel_size):
    mapped = table.map
    if "top_force" not in mapped or ("plate_z" not in mapped and "displacement" not in mapped):
        return
    start = known.plate_start if np.isfinite(known.plate_start) else 0.0
    rows = _plain_rows(table, start)
    if not len(rows):
        return
    factors = length_factors(voxel_size)
    of_grains = next((other.map for other in of_role(tables, "grains")), None)
    _guess_downwards(mapped, rows)
    state_voxel_size(mapped, known)
    _guess_origin(mapped, _Plate(_plain_rows(table, start), grains), factors, of_grains.length_factor() if of_grains else 1)
    plate = _Plate(_plain_rows(table, start), grains)
    _guess_height(mapped, plate, known.plate_start, factors)
    state_voxel_size(mapped, known)
    _guess_force(table, tables, plate, known)
