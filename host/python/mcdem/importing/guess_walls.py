"""Guesses which partners of contacts are walls, and which walls."""
from collections.abc import Sequence

import numpy as np

from ..number_text import shortest
from .arrays import Ints
from .contacts import ContactFrames, wall_partner
from .grains import GrainFrames
from .mapping import BY_DIRECTION, UNCLEAR, WALLS, Guess, Known, MappedTable, guess
from .names import column_name
from .rows import ImportTable

NEAR = 1.3  # of a radius: at the wall, including measurement errors
NOTHING = {"", "-", "--", "?", "na", "n/a", "#n/a", "nan", "+nan", "-nan", "null", "none"}  # not a wall
WORDS = {"floor": "floor bottom boden base zmin zlo", "plate": "plate top lid piston deckel platte stempel zmax zhi",
         "x_min": "xmin left links xlo", "x_max": "xmax right rechts xhi", "y_min": "ymin front vorn ylo",
         "y_max": "ymax back rear hinten yhi"}
UPSIDE_DOWN = {"zmin": "plate", "zlo": "plate", "zmax": "floor", "zhi": "floor"}  # if z points downwards


def unknown_partners(table: ImportTable, grains: GrainFrames, offset: int, most: int | None = None,
                     keys: Sequence[str] = ("grain", "partner")) -> list[str]:
    """Partners in the first `most` rows that are not grains: possible names of walls, at most 20."""
    found = set()
    for key in keys:
        for part in table.parts:
            column = part.columns.index(table.map.word(key))
            numbers = part.numbers(column)[:most]
            texts = {part.text(row, column) for row in np.flatnonzero(np.isnan(numbers))}
            numbers = numbers[(grains.number_of(numbers + offset) < 0) & (np.abs(numbers) < 2e9)]
            found |= {*map(shortest, np.unique(numbers)[:20])} | {text for text in sorted(texts)[:20] if text.lower() not in NOTHING}
    return sorted(found - {*WALLS})[:20]


def set_walls(mapped: MappedTable, names: list[str], grains: GrainFrames) -> None:
    """Walls from their names or, if those are unknown, from the direction of their forces."""
    mapped.walls = {}
    for name in names:
        base = column_name(name).base
        word = next((wall for wall, words in WORDS.items() if base in words.split()), BY_DIRECTION)
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


def guess_walls(table: ImportTable, frames: ContactFrames, grains: GrainFrames, known: Known) -> None:
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
    is_near = np.abs(position[frame, grain, (-1 - walls) // 2] - places) < NEAR * radius[grain]
    offset = int(mapped.number("id_offset"))
    for_grains, for_partners = (unknown_partners(table, grains, offset, keys=[key]) for key in ("grain", "partner"))
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
