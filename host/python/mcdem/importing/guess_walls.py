"""Guesses which partners of contacts are walls, and which walls."""
import numpy as np

from .mapping import BY_DIRECTION, UNCLEAR, WALLS, guess
from .names import column_name
from .problems import Problems, number_text
from .rows import whole_entry

NEAR = 1.3  # of a radius: at the wall, including measurement errors
NOTHING = {"", "-", "--", "?", "na", "n/a", "#n/a", "nan", "+nan", "-nan", "null", "none"}  # not a wall
WORDS = {"floor": "floor bottom boden base zmin zlo", "plate": "plate top lid piston deckel platte stempel zmax zhi",
         "x_min": "xmin left links xlo", "x_max": "xmax right rechts xhi", "y_min": "ymin front vorn ylo",
         "y_max": "ymax back rear hinten yhi"}
UPSIDE_DOWN = {"zmin": "plate", "zlo": "plate", "zmax": "floor", "zhi": "floor"}  # if z points downwards


def unknown_partners(table, grains, offset, most=None, only=""):
    """Partners in the first `most` rows that are not grains: possible names of walls."""
    found = set()
    for key in ("grain", "partner"):
        name = table.map.word(key)
        if name in WALLS or (only and key != only):
            continue
        for part in table.parts:
            column = part.find(name)
            if column is None:
                continue
            numbers = part.numbers(column)[:most]
            whole = (np.abs(numbers) < 2e9) & (numbers == np.round(numbers))
            ids = np.where(whole, numbers, -1).astype(int) + offset
            for value in np.unique(numbers[np.isfinite(numbers) & (np.abs(numbers) < 2e9) & ~(whole & (grains.number_of(ids) >= 0))])[:20]:
                found.add(number_text(value))
            texts = {part.text(row, column) for row in np.flatnonzero(np.isnan(numbers))}
            found |= {text for text in sorted(texts)[:20] if text not in WALLS and text.lower() not in NOTHING}
    return set(sorted(found)[:20])


def set_walls(mapped, names, grains):
    """Walls from their names or, if those are unknown, from the direction of their forces."""
    mapped.walls = {}
    for name in names:
        base = column_name(name).base
        word = next((wall for wall, words in WORDS.items() if base in words.split()), BY_DIRECTION)
        if grains.sign[2] < 0:
            word = UPSIDE_DOWN.get(base, word)
        mapped.walls[name] = guess(word, "likely", "no grain has this number" if word == BY_DIRECTION else "its name")


def _is_at(walls, centres, radii, box, tops):
    """Whether each grain touches its wall."""
    axis = (-1 - walls) // 2
    places = np.array([0, box[0], 0, box[1], 0, 0], float)[-1 - walls]
    places = np.where(walls == -6, tops, places)
    return np.abs(centres[np.arange(len(axis)), axis] - places) < NEAR * radii


def _names_of(frames, mapped):
    """The name of the wall in each row: in the column of the partner, or of the grain."""
    def name_of(row):
        part = frames.rows.parts[frames.rows.part[row]]
        for key in ("partner", "grain"):
            column = part.find(mapped.word(key))
            if column is not None:
                number = part.numbers(column)[frames.rows.row[row]]
                name = number_text(number) if np.isfinite(number) else part.text(frames.rows.row[row], column)
                if name in mapped.walls:
                    return name
        return ""

    return np.array([name_of(row) for row in frames.row[frames.partner < 0][:5000]], object)


def guess_walls(table, frames, grains, known):
    """Walls that only have a number: determined by the common direction of nearly all their forces. Unclear if the grains do not
    touch the wall, because a grain may be missing."""
    mapped, box = table.map, known.box
    if not mapped.walls:
        return
    mine, names = np.flatnonzero(frames.partner < 0)[:5000], _names_of(frames, mapped)
    at = grains.frames_of(mapped.word("frames_by", "plate"), frames.keys)[frames.frame[mine]]
    walls, grain = frames.partner[mine], frames.grain[mine]
    placed = at >= 0
    at_wall = np.zeros(len(mine), bool)
    if placed.any():
        position, tops = np.array(grains.position), np.array([grains.top(frame) for frame in range(len(grains.keys))])
        at_wall[placed] = _is_at(walls[placed], position[at[placed], grain[placed]], grains.diameter[grain[placed]] / 2, box, tops[at[placed]])
    offset = whole_entry(mapped, "id_offset", Problems())
    for_grains, for_partners = (unknown_partners(table, grains, offset, only=key) for key in ("grain", "partner"))
    for name, wall in mapped.walls.items():
        of_name = names == name
        all_of, touching = int((of_name & placed).sum()), int(at_wall[of_name].sum())
        named = wall.word != BY_DIRECTION
        if not named:
            ways, counts = np.unique(walls[of_name], return_counts=True)
            if len(ways) and counts.max() > 0.9 * counts.sum():
                wall.words, wall.certainty = [WALLS[-1 - ways[np.argmax(counts)]]], "likely"
                wall.why = f"{counts.max()} of its {counts.sum()} forces point away from there"
            else:
                wall.why += "; its forces point several ways"
        if (box[0] > 0 and touching < 0.9 * all_of) or (not named and (all_of == 0 or box[0] <= 0)):
            wall.certainty = UNCLEAR
            wall.why += (f"; {touching} of its {all_of} contacts are of grains that are at that wall: is it a grain that is not in the "
                         "grains' table?")
        elif not named and name in for_grains and for_partners:
            wall.certainty = UNCLEAR
            wall.why += "; but it stands for a grain, and walls stand for partners"
