"""Guesses columns without meaningful names from their numbers."""
from collections.abc import Sequence

import numpy as np

from .arrays import Bools, Floats, Ints
from .grains import GrainFrames
from .guess_lengths import nearest_over_radii
from .mapping import PLACE_KEYS, UNCLEAR, MappedTable, guess
from .names import column_name, columns_by_key, other_quantity
from .rows import ImportTable
from .tables import Table

MAX_ROWS, MAX_COLUMNS = 20_000, 50  # maximum size used for guesses


def _numbers_of(part: Table) -> tuple[Floats, Bools]:
    """The numbers [rows][columns], and which columns are whole numbers."""
    numbers = np.column_stack([part.numbers(c)[:MAX_ROWS] for c in range(min(len(part.columns), MAX_COLUMNS))])
    return numbers, np.all((numbers == np.round(numbers)) & (np.abs(numbers) < 2e9), axis=0)


def _has_numbers(numbers: Floats) -> Bools:
    """Whether most cells of each column are numbers, because a table may have gaps."""
    return np.asarray(2 * np.isfinite(numbers).sum(axis=0) > len(numbers))


def _named(role: str, columns: list[str]) -> list[str]:
    """The key that its name tells for each of the columns, "" where it tells none. A repeated name tells none."""
    keys = {names[0]: key for key, names in columns_by_key(role, columns).items() if len(names) == 1}
    return [keys.get(column, "") for column in columns]


def _agrees(named: list[str], place: int, keys: Sequence[str]) -> bool:
    """Whether no name contradicts that the columns from `place` on are the `keys`: neither their own ones nor those of others."""
    return all(name in ("", key) and (name or key not in named) for name, key in zip(named[place:], keys))


def _note_named(mapped: MappedTable, named: list[str], columns: list[str], keys: Sequence[str]) -> None:
    mapped.entries.update({key: guess(name, "sure", "its name") for key, name in zip(named, columns) if key in keys})


def _guess_named_centres(table: ImportTable, numbers: Floats, whole: Bools, rows: int) -> None:
    """x, y and z by their names; the size among the columns without a meaning, confirmed by the user: the distances to neighbours
    tell how far it is from a radius and a diameter."""
    part, mapped = table.parts[0], table.map
    named = _named("grains", part.columns)
    at = [named.index(key) for key in "xyz"]
    mapped.role, mapped.role_certainty, mapped.role_why = "grains", UNCLEAR, "its columns x, y and z are named so, and none as a size"
    _note_named(mapped, named, part.columns, ("x", "y", "z", "grain", "frame"))
    found = []
    for c in range(len(whole)):
        size = numbers[:rows, c]
        may_be = not named[c] and not whole[c] and column_name(part.columns[c]).quantity in ("", "a length")
        if may_be and np.isfinite(size).all() and (size >= 0).all() and (size > 0).mean() > 0.9:
            ratio = nearest_over_radii(numbers[:rows][size > 0][:, at], size[size > 0])
            found += [(abs(np.log(ratio / other)), key, ratio, c) for key, other in (("diameter", 1), ("radius", 2)) if 0.5 < ratio < 4]
    if found:
        _, key, ratio, c = min(found)
        mapped.role_certainty = "likely"
        mapped[key] = guess(part.columns[c], UNCLEAR, f"no name says it, and the nearest neighbours are {ratio:.3g} times its numbers apart "
                            "(diameters: about 1, radii: 2): is it the size? Where no column has it, write same_diameter in its place")


def guess_grains_by_values(table: ImportTable) -> None:
    """Four columns that give touching spheres. Names beat geometry: a column that is named otherwise is none of them, and columns
    named x, y and z are the centres."""
    part, mapped = table.parts[0], table.map
    numbers, whole = _numbers_of(part)
    if len(numbers) < 3:
        return
    # The first frame ends where an integer column that is constant at first changes.
    change = np.argmax(numbers != numbers[0], axis=0)
    rows = min([len(numbers), *(start for _, start in part.frames[1:2]), *change[whole & (change > 1)]])
    named = _named("grains", part.columns)[:len(whole)]
    forces = {*columns_by_key("contacts", part.columns)} & {"fx", "fy", "fz", "force", "partner"}
    if {"x", "y", "z"} <= {*named} and forces:
        return
    if {"x", "y", "z"} <= {*named}:
        _guess_named_centres(table, numbers, whole, rows)
        return
    for c in range(len(whole) - 3):
        four = numbers[:rows, c:c + 4]
        if not np.isfinite(four).all() or not (four[:, 3] > 0).all() or (whole[c] and whole[c + 3]):
            continue
        if not _agrees(named, c, "xyz") or named[c + 3] not in ("", "diameter", "radius"):
            continue
        if any(column_name(name).quantity not in ("", "a length") for name in part.columns[c:c + 4]):
            continue
        ratio = nearest_over_radii(four[:, :3], four[:, 3])
        size_key = "diameter" if 0.75 < ratio < 1.25 else "radius" if 1.5 < ratio < 2.5 else None
        if size_key:
            # Words that say nothing known may say something else.
            certainty = UNCLEAR if part.named and not {*named[c:c + 4]} & {"x", "y", "z"} else "likely"
            mapped.role, mapped.role_certainty = "grains", certainty
            mapped.role_why = f"columns {c + 1} to {c + 4} taken for spheres touch one another"
            for key, column in zip(("x", "y", "z", named[c + 3] or size_key), part.columns[c:]):
                mapped[key] = guess(column, certainty, "spheres touch one another in the usual order")
            _note_named(mapped, named, part.columns, ("grain", "frame"))
            for k in (k for k in np.flatnonzero(whole[:c]) if not named[k]):
                different = len(np.unique(numbers[:rows, k]))
                if different == 1 and rows < len(numbers) and not part.frames:
                    mapped.entries.setdefault("frame", guess(part.columns[k], "likely", "whole numbers, the same over many rows"))
                elif different == rows:
                    mapped.entries.setdefault("grain", guess(part.columns[k], "likely", "whole numbers, each once in a frame"))
            return


def _touching_pairs(part: Table, pairs: Floats, grains: GrainFrames) -> tuple[Ints, Floats]:
    """Rows and unit vectors from partner to grain, if nearly all pairs in two columns touch; otherwise none."""
    frame = np.zeros(len(pairs), int)
    if part.frames:
        steps, starts = zip(*part.frames)
        frame = grains.index.find(steps)[np.searchsorted(starts, np.arange(len(pairs)), "right") - 1]
    both = grains.number_of(pairs)
    known = np.flatnonzero((frame >= 0) & (both >= 0).all(axis=1) & (both[:, 0] != both[:, 1]))
    i, j = both[known].T
    position = np.array(grains.position)
    line = position[frame[known], i] - position[frame[known], j]
    length = np.linalg.norm(line, axis=1)
    touch = length < 0.6 * (grains.diameter[i] + grains.diameter[j])
    if len(known) < len(pairs) // 2 or touch.sum() < 0.9 * len(known):
        return known[:0], line[:0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return known[touch], (line[touch] / length[touch, None]) * grains.sign


def _alignment(force: Floats, away: Floats) -> float:
    """Measure for forces along the lines of centres: the median of |cos| of the angle between them."""
    size = np.linalg.norm(force, axis=1)
    cosines = np.abs(np.sum(force * away, axis=1))[size > 0] / size[size > 0]
    return float(np.median(cosines)) if len(cosines) >= 3 else 0.0


def guess_contacts_by_values(table: ImportTable, grains: GrainFrames) -> None:
    """Two columns with numbers of touching grains, and forces along the lines of centres; none that are named otherwise."""
    part, mapped = table.parts[0], table.map
    numbers, whole = _numbers_of(part)
    named = _named("contacts", part.columns)[:len(whole)]
    for a in np.flatnonzero(whole[:-1] & whole[1:]).tolist() if grains.keys else ():
        if not _agrees(named, a, ("grain", "partner")):
            continue
        rows, away = _touching_pairs(part, numbers[:, a:a + 2], grains)
        if not len(rows):
            continue
        fits = {c: _alignment(numbers[rows, c:c + 3], away) for c in range(len(whole) - 2)
                if (c > a + 1 or c + 2 < a) and _agrees(named, c, ("fx", "fy", "fz"))}
        best = max(fits, key=lambda c: fits[c], default=0)
        most, good = fits.get(best, 0), sum(fit > 0.9 for fit in fits.values())
        others = np.delete(_has_numbers(numbers) & ~whole, slice(best, best + 3)).sum()
        seen = f"one of {good} triples of columns that point" if good > 1 else \
            "other columns may hold a tangential part to be added; points" if others >= 3 else "points"
        mapped.role, mapped.role_certainty, mapped.role_why = "contacts", "likely", "two columns name grains that touch"
        for key, column in zip(("grain", "partner"), part.columns[a:]):
            mapped[key] = guess(column, "likely", "grains of this and the other column touch")
        for key, column in zip(("fx", "fy", "fz") if most > 0 else (), part.columns[best:]):
            mapped[key] = guess(column, "likely" if most > 0.9 and good == 1 and others < 3 else UNCLEAR,
                                f"{seen} along the lines of centres (median cosine {most:.3f})")
        return


def guess_plate_by_values(table: ImportTable) -> None:
    """A few columns without names. Where a name says what a column is, the others are not guessed: a pressure is no force."""
    part, mapped = table.parts[0], table.map
    named = {key: names for key, names in columns_by_key("plate", part.columns).items() if key in (*PLACE_KEYS, "top_force")}
    numeric = [name for name, has in zip(part.columns, _has_numbers(_numbers_of(part)[0])) if has]
    if named:
        missing = "top_force" if "top_force" not in named else " or ".join(PLACE_KEYS)
        others = [name for name in part.columns if name not in {names[0] for names in named.values()}]
        mapped.role_why = f"no column is named as {missing}, which a plate's table must have; other columns: {', '.join(others) or 'none'}"
        mapped.entries.update({key: guess(names[0], UNCLEAR, "its name") for key, names in named.items()})
    elif len(numeric) >= 2 and len(part.columns) <= 8:
        mapped.role_why = "no names, no grains"
        if len(numeric) > 2 and not (np.diff(part.numbers(part.columns.index(numeric[0]))) <= 0).any():
            mapped["frame"] = guess(numeric.pop(0), UNCLEAR, "rises from row to row")
        forces = sorted(numeric[1:], key=lambda name: column_name(name).quantity != "a force")  # a name beats the place
        for key, name, quantity in zip(("plate_z", "top_force"), [numeric[0], *forces], ("length", "force")):
            mapped[key] = guess(name, UNCLEAR, other_quantity(name, quantity) or "by its place only")
    else:
        return
    mapped.role, mapped.role_certainty = "plate", UNCLEAR
