"""Guesses columns without meaningful names from their numbers."""
import numpy as np

from .guess_lengths import nearest_over_radii
from .mapping import UNCLEAR, guess
from .names import columns_by_key

MAX_ROWS, MAX_COLUMNS = 20_000, 50  # maximum size used for guesses


def _numbers_of(part, most=MAX_COLUMNS):
    return [part.numbers(c)[:MAX_ROWS] for c in range(min(len(part.columns), most))]


def _has_numbers(column):
    """Whether most cells are numbers, because a table may have gaps."""
    return 2 * np.isfinite(column).sum() > len(column)


def _all_whole(column):
    return bool(np.all((column == np.round(column)) & (np.abs(column) < 2e9)))


def _first_frame(part, columns):
    """Rows of the first frame: until an integer column that is constant at first changes."""
    rows = len(columns[0])
    if len(part.frames) > 1:
        rows = min(rows, part.frames[1][1])
    for column in columns:
        if len(column) > 1 and column[0] == column[1] and _all_whole(column) and (column != column[0]).any():
            rows = min(rows, int(np.argmax(column != column[0])))
    return rows


def _name_leading_columns(mapped, part, columns, frame_rows):
    for c, column in enumerate(columns):
        if not _all_whole(column):
            continue
        different = len(np.unique(column[:frame_rows]))
        if different == 1 and frame_rows < len(column) and "frame" not in mapped and not part.frames:
            mapped["frame"] = guess(part.columns[c], "likely", "whole numbers, the same over many rows")
        elif different == frame_rows and "grain" not in mapped:
            mapped["grain"] = guess(part.columns[c], "likely", "whole numbers, each once in a frame")


def guess_grains_by_values(table):
    """Four columns that give touching spheres."""
    part, mapped = table.parts[0], table.map
    columns = _numbers_of(part)
    rows = _first_frame(part, columns)
    for c in range(len(columns) - 3):
        four = np.column_stack([column[:rows] for column in columns[c:c + 4]])
        position, size = four[:, :3], four[:, 3]
        whole = np.all((size == np.round(size)) & (position[:, 0] == np.round(position[:, 0])))
        if not np.isfinite(four).all() or not (size > 0).all() or whole:
            continue
        ratio = nearest_over_radii(position, size)
        size_key = "diameter" if 0.75 < ratio < 1.25 else "radius" if 1.5 < ratio < 2.5 else None
        if size_key:
            mapped.role, mapped.role_certainty = "grains", "likely"
            mapped.role_why = f"columns {c + 1} to {c + 4} taken for spheres touch one another"
            for k, axis in enumerate("xyz"):
                mapped[axis] = guess(part.columns[c + k], "likely", "the usual order")
            mapped[size_key] = guess(part.columns[c + 3], "likely", "spheres of that size touch one another")
            return _name_leading_columns(mapped, part, columns[:c], rows)
    return None


def _touching_pairs(part, first, second, grains):
    """Rows and unit vectors from partner to grain, if nearly all pairs in two columns touch; otherwise none."""
    frame = np.zeros(len(first), int)
    if part.frames:
        steps, starts = zip(*part.frames)
        frame = grains.index.find(steps)[np.searchsorted(starts, np.arange(len(first)), "right") - 1]
    a, b = grains.number_of(first.astype(int)), grains.number_of(second.astype(int))
    known = np.flatnonzero((frame >= 0) & (a >= 0) & (b >= 0) & (a != b))
    i, j = a[known], b[known]
    position = np.array(grains.position)
    line = position[frame[known], i] - position[frame[known], j]
    length = np.linalg.norm(line, axis=1)
    touch = length < 0.6 * (grains.diameter[i] + grains.diameter[j])
    if len(known) < len(first) // 2 or touch.sum() < 0.9 * len(known):
        return known[:0], line[:0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return known[touch], (line[touch] / length[touch, None]) * grains.sign


def _alignment(columns, c, rows, away):
    """Measure for three columns being forces along the lines of centres: the median of |cos| of the angle between them."""
    force = np.column_stack([column[rows] for column in columns[c:c + 3]])
    size = np.linalg.norm(force, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosines = np.abs(np.sum(force * away, axis=1) / size)
    cosines = cosines[size > 0]
    return float(np.median(cosines)) if len(cosines) >= 3 else 0.0


def guess_contacts_by_values(table, grains):
    """Two columns with numbers of touching grains, and forces along the lines of centres."""
    part, mapped = table.parts[0], table.map
    columns = _numbers_of(part)
    for a in range(len(columns) - 1 if grains.keys else 0):
        if not (_all_whole(columns[a]) and _all_whole(columns[a + 1])):
            continue
        rows, away = _touching_pairs(part, columns[a], columns[a + 1], grains)
        if not len(rows):
            continue
        fits = {c: _alignment(columns, c, rows, away) for c in range(len(columns) - 2) if c > a + 1 or c + 2 < a}
        best = max(fits, key=fits.get, default=0)
        most, good = fits.get(best, 0), sum(fit > 0.9 for fit in fits.values())
        others = sum((c < best or c > best + 2) and _has_numbers(column) and not _all_whole(column) for c, column in enumerate(columns))
        seen = f"one of {good} triples of columns that point" if good > 1 else \
            "other columns may hold a tangential part to be added; points" if others >= 3 else "points"
        mapped.role, mapped.role_certainty, mapped.role_why = "contacts", "likely", "two columns name grains that touch"
        mapped["grain"] = guess(part.columns[a], "likely", "names grains that touch those of the next column")
        mapped["partner"] = guess(part.columns[a + 1], "likely", "names grains that touch those of the column before")
        for k, axis in enumerate("xyz" if most > 0 else ""):
            mapped["f" + axis] = guess(part.columns[best + k], "likely" if most > 0.9 and good == 1 and others < 3 else UNCLEAR,
                                       f"{seen} along the lines of centres (median cosine {most:.3f})")
        return


def guess_plate_by_values(table):
    """A few columns without names. Where a name says what a column is, the others are not guessed: a pressure is no force."""
    part, mapped = table.parts[0], table.map
    named = {key: names for key, names in columns_by_key("plate", part.columns).items() if key in ("plate_z", "displacement", "top_force")}
    if named:
        mapped.role, mapped.role_certainty = "plate", UNCLEAR
        missing = "top_force" if "top_force" not in named else "plate_z or displacement"
        others = [name for name in part.columns if name not in {names[0] for names in named.values()}]
        mapped.role_why = f"no column is named as {missing}, which a plate's table must have; other columns: {', '.join(others) or 'none'}"
        mapped.entries.update({key: guess(names[0], UNCLEAR, "its name") for key, names in named.items()})
        return
    columns = _numbers_of(part, 9)
    numeric = [c for c, column in enumerate(columns) if _has_numbers(column)]
    if len(numeric) < 2 or len(part.columns) > 8:
        return
    first = columns[numeric[0]]
    counts = len(numeric) > 2 and not (np.diff(first) <= 0).any()
    mapped.role, mapped.role_certainty, mapped.role_why = "plate", UNCLEAR, "no names, no grains"
    if counts:
        mapped["frame"] = guess(part.columns[numeric[0]], UNCLEAR, "rises from row to row")
    mapped["plate_z"] = guess(part.columns[numeric[counts]], UNCLEAR, "by its place only")
    mapped["top_force"] = guess(part.columns[numeric[counts + 1]], UNCLEAR, "by its place only")
