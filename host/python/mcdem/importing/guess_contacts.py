"""Guesses the meaning of a table of contacts: grains and walls, sides of the forces, units."""
from collections.abc import Sequence

import numpy as np

from ..number_text import shortest
from ..problems import Problems
from .arrays import Floats, Ints
from .contacts import ContactFrames, import_contacts, wall_partner
from .grains import GrainFrames
from .guess_lengths import decide_unit, fitting_units, length_factors, state_voxel_size
from .mapping import BY_DIRECTION, UNCLEAR, WALLS, Guess, Known, MappedTable, guess, negated
from .names import FORCES, column_name
from .rows import ImportTable

MAX_ROWS = 200_000  # maximum number of rows used for a guess
NEAR = 1.2  # of the sum of radii: touching, including measurement errors
ROUGH = 3.1  # factor by which Hertz's forces may be wrong; gf and kgf are then confused with mN and N
FORCE_FACTORS = {unit: FORCES[unit] for unit in "N mN uN kN gf kgf".split()}  # the others are too similar to these
NEAR_WALL = 1.3  # of a radius: at the wall, including measurement errors
NOTHING = {"", "-", "--", "?", "na", "n/a", "#n/a", "nan", "+nan", "-nan", "null", "none"}  # not a wall
WALL_WORDS = {"floor": "floor bottom boden base zmin zlo", "plate": "plate top lid piston deckel platte stempel zmax zhi",
              "x_min": "xmin left links xlo", "x_max": "xmax right rechts xhi", "y_min": "ymin front vorn ylo",
              "y_max": "ymax back rear hinten yhi"}
UPSIDE_DOWN = {"zmin": "plate", "zlo": "plate", "zmax": "floor", "zhi": "floor"}  # if z points downwards


def decide_force_unit(mapped: MappedTable, ratio: float, off: float, seen: str, unknown: str) -> None:
    """The unit by the `ratio` of the raw numbers to forces [N] that may be `off` by a factor; NaN for the reason `unknown`."""
    named = mapped.word("force_unit")
    fits = fitting_units({named: FORCES[named]} if named else FORCE_FACTORS, ratio, 1, 1 / off, off)
    confused = off >= ROUGH and {"gf", "kgf"} & set(fits)
    seen = f"as newtons {seen}" if np.isfinite(ratio) else ""
    decide_unit(mapped, "force_unit", fits, seen, ("N", seen or unknown), UNCLEAR if confused else "sure")


def hertz_force(known: Known, radius: Floats, other: Floats | float, overlap: Floats) -> Floats:
    """Hertz force between two grains, or a grain and a rigid wall (radius inf) [N]; NaN if E is unknown."""
    modulus = known.youngs_modulus / (1 - known.poisson_ratio**2) / np.where(np.isinf(other), 1, 2)
    return np.asarray(4 / 3 * modulus * np.sqrt(1 / (1 / radius + 1 / other)) * np.maximum(overlap, 0) ** 1.5)


class _Places:
    """The contacts in frames with known positions of the grains; their raw numbers taken as m and N."""

    def __init__(self, table: ImportTable, grains: GrainFrames) -> None:
        plain = table.changed(length_unit=guess("m", "stated", ""), force_unit=guess("N", "stated", ""))
        self.all = frames = import_contacts(plain, grains, Problems(), MAX_ROWS)
        at = grains.frames_of(table.map.word("frames_by", "plate"), frames.keys)[frames.frame]
        kept = np.flatnonzero(at >= 0)
        at, grain, partner = at[kept], frames.grain[kept], frames.partner[kept]
        position, radius, other = np.array(grains.position), grains.diameter / 2, np.maximum(partner, 0)
        self.force, self.point, self.pair = frames.force[kept], frames.point[kept], partner >= 0
        self.centre, self.radius, self.other_radius = position[at, grain], radius[grain], radius[other]
        self.line = self.centre - position[at, other]
        self.distance, self.reach = np.linalg.norm(self.line, axis=1), self.radius + self.other_radius

    def touching(self) -> float:
        """Fraction of touching pairs, 0 without pairs."""
        return float(np.mean((self.distance < NEAR * self.reach)[self.pair])) if self.pair.any() else 0.0

    def outward(self, box: tuple[float, float], axes: Sequence[int] = (1, 1, 1)) -> float:
        """+1 if forces repel grains as given, -1 if they do after reversal: from pairs, otherwise from nearby walls. `axes` are
        signs for the forces."""
        force = self.force * axes
        with np.errstate(invalid="ignore", divide="ignore"):
            cosine = np.sum(force * self.line, axis=1) / (np.linalg.norm(force, axis=1) * self.distance)
        cosine = cosine[self.pair & np.isfinite(cosine)]
        if len(cosine) >= 3:
            return float(cosine.mean())
        axis = np.argmax(np.abs(force), axis=1)
        sides = np.flatnonzero(~self.pair & (axis < 2))  # the position of the plate is unknown here
        axis = axis[sides]
        low = self.centre[sides, axis] < np.array(box)[axis] / 2
        return float(np.mean(np.where(low == (force[sides, axis] > 0), 1, -1))) if len(sides) else 0.0


def _unknown_partners(table: ImportTable, grains: GrainFrames, offset: int, most: int | None = None,
                      keys: Sequence[str] = ("grain", "partner")) -> list[str]:
    """Partners in the first `most` rows that are not grains: possible names of walls, at most 20."""
    found = set()
    for key in keys:
        for part in table.parts:
            column = part.columns.index(table.map.word(key))
            numbers = part.numbers(column)[:most]
            texts = {part.text(row, column) for row in np.flatnonzero(np.isnan(numbers))}
            numbers = numbers[~grains.has_name(numbers + offset) & (np.abs(numbers) < 2e9)]
            found |= {*map(shortest, np.unique(numbers)[:20])} | {text for text in sorted(texts)[:20] if text.lower() not in NOTHING}
    return sorted(found - {*WALLS})[:20]


def _set_walls(mapped: MappedTable, names: list[str], grains: GrainFrames) -> None:
    """Walls from their names or, if those are unknown, from the direction of their forces."""
    mapped.walls = {}
    for name in names:
        base = column_name(name).base
        word = next((wall for wall, words in WALL_WORDS.items() if base in words.split()), BY_DIRECTION)
        word = UPSIDE_DOWN.get(base, word) if grains.sign[2] < 0 else word
        mapped.walls[name] = guess(word, "likely", "no grain has this number" if word == BY_DIRECTION else "its name")


def _names_of(frames: ContactFrames, walls: dict[str, Guess], contacts: Ints) -> list[str]:
    """The name of the wall of each of these contacts: in the column of the partner, or of the grain."""
    rows, names = frames.rows, [""] * len(contacts)
    for key in ("grain", "partner"):
        numbers = rows.number(key, np.zeros(len(rows), np.bool_))
        for i, row in enumerate(frames.row[contacts]):
            name = shortest(numbers[row]) if np.isfinite(numbers[row]) else rows.text(row, key)
            names[i] = name if name in walls else names[i]
    return names


def _guess_walls(table: ImportTable, frames: ContactFrames, grains: GrainFrames, known: Known) -> None:
    """Walls that only have a number: determined by the common direction of nearly all their forces. Unclear if the grains do not
    touch the wall, because a grain may be missing."""
    mapped, box = table.map, known.box
    if not mapped.walls:
        return
    mine = np.flatnonzero(frames.partner < 0)[:5000]
    names, walls, grain = np.array(_names_of(frames, mapped.walls, mine), object), frames.partner[mine], frames.grain[mine]
    frame = grains.frames_of(mapped.word("frames_by", "plate"), frames.keys)[frames.frame[mine]]
    position, radius = np.array(grains.position), grains.diameter / 2
    tops = (position[:, :, 2] + radius).max(axis=1)
    places = np.where(walls == wall_partner("plate"), tops[frame], np.array([0, box[0], 0, box[1], 0, 0])[-1 - walls])
    is_near = np.abs(position[frame, grain, (-1 - walls) // 2] - places) < NEAR_WALL * radius[grain]
    offset = int(mapped.number("id_offset"))
    for_grains, for_partners = (_unknown_partners(table, grains, offset, keys=[key]) for key in ("grain", "partner"))
    for name, wall in mapped.walls.items():
        placed = (names == name) & (frame >= 0)
        all_of, touching = int(placed.sum()), int((placed & is_near).sum())
        named = wall.word != BY_DIRECTION
        if not named:
            ways, counts = np.unique(walls[names == name], return_counts=True)
            if len(ways) and counts.max() > 0.9 * counts.sum():
                mapped.walls[name] = wall = guess(WALLS[-1 - ways[np.argmax(counts)]], "likely", f"{wall.why}; {counts.max()} of its "
                                                  f"{counts.sum()} forces point away from there")
            else:
                wall.why += "; its forces point several ways"
        if (box[0] > 0 and touching < 0.9 * all_of) or (not named and (all_of == 0 or box[0] <= 0)):
            wall.certainty = UNCLEAR
            wall.why += (f"; {touching} of its {all_of} contacts are of grains that are at that wall: is it a grain that is not in the "
                         "grains' table?")
        elif not named and name in for_grains and for_partners:
            wall.certainty = UNCLEAR
            wall.why += "; but it stands for a grain, and walls stand for partners"


def _guess_offset(table: ImportTable, grains: GrainFrames) -> None:
    """The offset of the numbers with which nearly all pairs touch."""
    most, best = -1.0, 0
    for offset in (0, 1, -1, -2, -3, -4, -5, -6):  # Yade may number its walls before its grains
        trial = table.changed(id_offset=guess(str(offset), "stated", ""))
        others = _unknown_partners(trial, grains, offset, MAX_ROWS)
        if len(others) > 12:  # there are only few walls
            continue
        _set_walls(trial.map, others, grains)
        share = _Places(trial, grains).touching()
        if share > most + 0.05:
            most, best = share, offset
    told = f"{100 * most:.0f} % of the pairs touch then"
    unclear = f"{told}: numbers of grains, frames or columns may be others"
    certainty, why = ("sure", told) if most > 0.9 else (UNCLEAR, unclear) if most > 0 else ("likely", "no pairs to tell it by")
    table.map["id_offset"] = guess(str(best), certainty, why)
    _set_walls(table.map, _unknown_partners(table, grains, best), grains)
    if len(table.map.walls) > 6:
        table.map["partner"] = guess(table.map.word("partner"), UNCLEAR, "more than six of its numbers are no grains")


def _guess_force_on(table: ImportTable, places: _Places, grains: GrainFrames, box: tuple[float, float]) -> None:
    """Guesses the sign of fz, for forces must be along the lines of centres, and the grain on which forces are."""
    mapped = table.map
    if not all(key in mapped for key in ("fx", "fy", "fz")):
        return
    fz, sign, other = mapped["fz"], places.outward(box), places.outward(box, (1, 1, -1))
    unknown = abs(abs(sign) - abs(other)) < 0.2
    if grains.sign[2] < 0 if unknown else abs(other) > abs(sign):
        mapped["fz"], sign = negated(fz), other
        mapped["fz"].certainty = UNCLEAR if unknown or fz.certainty == UNCLEAR else "sure"
        mapped["fz"].why = "z of the grains is downwards: are the forces too? If not, remove the -" if unknown else (
            f"{fz.why}; the other way, for so forces lie along the lines of centres (mean cosine {abs(other):.2f})")
    clear = abs(sign) > 0.5
    mapped["force_on"] = guess("partner" if sign < 0 else "grain", "sure" if clear else UNCLEAR,
                               "so forces push grains apart" if clear else "forces neither push grains apart nor together")


def _guess_sides(mapped: MappedTable, frames: ContactFrames) -> None:
    pairs = np.column_stack([frames.frame, frames.grain, frames.partner])[frames.partner >= 0]
    listed = set(map(tuple, pairs.tolist()))
    twice = sum((frame, partner, grain) in listed for frame, grain, partner in listed)
    mapped["sides"] = guess("both" if twice > 0.5 * len(listed) else "one", "sure" if twice in (0, len(listed)) else "likely",
                            f"{twice} of {len(listed)} pairs are there from either side")


def _guess_point_unit(mapped: MappedTable, places: _Places, grains: GrainFrames, known: Known) -> None:
    """Unit and direction of contact points, which are on the surfaces of their grains: z may have the opposite sign of the
    present guess."""
    if "x" not in mapped:
        return
    factors = length_factors(known.voxel_size) if len(places.point) else {}
    for axes in ((1, 1, 1), (1, 1, -1)):
        points = (places.point + grains.origin) * axes
        off = {unit: np.linalg.norm(points * factor - grains.origin - places.centre, axis=1) for unit, factor in factors.items()}
        if fits := [unit for unit, distance in off.items() if 0.6 < np.median(distance / places.radius) < 1.3]:
            break
    if fits and axes[2] < 0:
        mapped["z"] = negated(mapped["z"])
        mapped["z"].why += "; the other way, for so the points lie on the grains' surfaces"
    if "length_unit" not in mapped or len(fits) == 1:
        decide_unit(mapped, "length_unit", fits, f"in {' '.join(fits)} the points lie on the grains' surfaces",
                    ("m", "in no unit, or in several, do the points lie on the grains' surfaces"))
    state_voxel_size(mapped, known)


def _guess_force_unit(table: ImportTable, places: _Places, grains: GrainFrames, known: Known) -> None:
    mapped = table.map
    if "force_unit" in mapped:
        return
    overlap = places.reach - places.distance
    deep = places.pair & (overlap > 0.01 * places.reach)
    ratios = np.linalg.norm(places.force, axis=1)[deep] / hertz_force(known, places.radius[deep], places.other_radius[deep], overlap[deep])
    ratio = float(np.median(ratios)) if len(ratios) >= 5 else np.nan
    decide_force_unit(mapped, ratio, ROUGH, f"forces would be {ratio:.2g} times Hertz's from the overlaps",
                      "no name says it; with --set grains.youngs_modulus=.. the overlaps may")
    unit = mapped["force_unit"]
    if unit.word == "N" and unit.certainty == UNCLEAR and table.parts[0].format != "text" and grains.diameter[0] < 1:
        mapped["force_unit"] = guess("N", "likely", "the grains are in metres, so the program counts in SI")


def guess_contact_meaning(table: ImportTable, grains: GrainFrames, known: Known) -> None:
    if not grains.keys:
        table.map["id_offset"] = guess("0", UNCLEAR, "the grains' table cannot be read so far")
        return
    _guess_offset(table, grains)
    if table.map.is_topology:
        return
    _guess_force_on(table, _Places(table, grains), grains, known.box)
    places = _Places(table, grains)
    _guess_walls(table, places.all, grains, known)
    _guess_sides(table.map, places.all)
    _guess_point_unit(table.map, places, grains, known)
    _guess_force_unit(table, places, grains, known)
