"""Contacts by frame, with the numbers of the grains. Points that were not measured are NaN."""
import numpy as np

from .mapping import BY_DIRECTION, WALLS
from .problems import is_whole, number_text, quoted, to_number
from .rows import Rows, whole_entry

NOBODY, SOME_WALL = -8, -7  # in addition to grains >= 0 and walls -1 to -6: unknown partner; wall to be determined by the force


def wall_partner(name):
    return -1 - WALLS.index(name)


class ContactFrames:
    def __init__(self, keys=()):
        self.keys = list(keys)  # of each frame, including those without contacts
        self.frame = self.grain = self.partner = self.row = np.zeros(0, int)  # of each contact; row: among `rows`
        self.point = self.force = np.zeros((0, 3))  # [m], on `grain` [N]
        self.rows = None

    def __len__(self):
        return len(self.grain)


def wall_by_direction(force):
    """The wall that exerts this force on a grain: the one whose normal is closest to it."""
    axis = np.argmax(np.abs(force), axis=1)
    return -1 - (2 * axis + np.where(force[np.arange(len(axis)), axis] > 0, 0, 1))


class _Reader:
    def __init__(self, table, grains, problems, most):
        self.map, self.grains, self.problems = table.map, grains, problems
        self.rows = Rows(table, problems, most)
        self.offset = whole_entry(self.map, "id_offset", problems)
        self.one_wall = self.map.word("partner") if self.map.word("partner") in WALLS else None
        self.has_size = "force" in self.rows

    def side_of(self, key, text, number):
        """A grain, a wall, SOME_WALL or NOBODY; and the problem, or None."""
        grain = int(self.grains.number_of(int(number) + self.offset)) if is_whole(number) else -1
        wall = self.map.walls.get(text if number is None else number_text(number))
        if wall and (key == "partner" or grain < 0):  # numbers of meshes may equal those of grains
            return (SOME_WALL if wall.word == BY_DIRECTION else wall_partner(wall.word)), None
        if text in WALLS:
            axis = WALLS.index(text) // 2
            if axis < 2 and self.grains.sign[axis] < 0:
                return NOBODY, f'{text} must be named in [table.walls] where {"xyz"[axis]} is reversed, {text} = "x_min" or another'
            return wall_partner(text), None
        return (grain, None) if grain >= 0 else (NOBODY, "")

    def sides(self, key, wanted):
        """Partner of each row; unknown partners in `wanted` rows are problems."""
        sides = np.full(len(self.rows), NOBODY)
        if key == "partner" and self.one_wall:
            sides[:] = wall_partner(self.one_wall)
            return sides
        for part, rows, mine, [(_, column), *_] in self.rows.each_part(key):
            numbers = part.numbers(column)[rows]
            known = np.isfinite(numbers)
            values, places = np.unique(numbers[known], return_inverse=True)
            told = [self.side_of(key, number_text(value), value) for value in values]
            sides[mine[known]] = np.array([side for side, _ in told], int)[places] if told else []
            for at in np.flatnonzero(~known):
                text = part.text(rows[at], column)
                sides[mine[at]], wrong = self.side_of(key, text, to_number(text))
                if wrong and wanted[mine[at]]:
                    self.rows.problem_once(text, mine[at], wrong)
                    wanted[mine[at]] = False
        for i in np.flatnonzero((sides == NOBODY) & wanted)[:20]:
            self.rows.problem(i, f"{key} must be a grain, or a wall that [table.walls] of the mapping names, got "
                              + quoted(self.rows.text(i, key)))
        return sides

    def partners(self, wanted):
        """Grain and partner of each row, whether they were exchanged, and which rows are complete."""
        first, second = self.sides("grain", wanted.copy()), self.sides("partner", wanted.copy())
        swapped = first < 0  # Yade lists walls first
        grain, partner = np.where(swapped, second, first), np.where(swapped, first, second)
        known = wanted & (first != NOBODY) & (second != NOBODY)
        wrong = known & ((grain < 0) | (grain == partner))
        for i in np.flatnonzero(wrong)[:20]:
            other = self.one_wall or quoted(self.rows.text(i, "partner"))
            self.rows.problem(i, f"a contact must have a grain and another, or a wall, got {quoted(self.rows.text(i, 'grain'))} and {other}")
        return grain, partner, swapped, known & ~wrong

    def forces(self, grain, partner, swapped, at, known):
        if not self.has_size:
            sign = self.map.force_factor() * (1 if self.map.word("force_on", "grain") == "grain" else -1)
            force = np.column_stack([self.rows.number(key, known) for key in ("fx", "fy", "fz")])
            return np.where(swapped, -sign, sign)[:, None] * force
        away = np.full((len(grain), 3), np.nan)  # from the partner
        for wall in range(6):
            away[partner == -1 - wall] = np.eye(3)[wall // 2] * (1 if wall % 2 == 0 else -1)
        pairs = known & (partner >= 0) & (at >= 0)
        if pairs.any():
            position = np.array(self.grains.position)
            line = position[at[pairs], grain[pairs]] - position[at[pairs], partner[pairs]]
            with np.errstate(invalid="ignore", divide="ignore"):
                away[pairs] = line / np.linalg.norm(line, axis=1)[:, None]
        for i in np.flatnonzero(known & np.isnan(away).any(axis=1))[:1]:
            self.rows.problem_once("size", i, "a force's size needs to know its direction: both centres in this frame, at two "
                                   "places, or which wall")
        return self.map.force_factor() * self.rows.number("force", known)[:, None] * away

    def read(self):
        needed = ["grain"] + ([] if self.one_wall else ["partner"]) + ([] if self.has_size else ["fx", "fy", "fz"])
        if any([self.rows.lacks(key) for key in needed]) or not len(self.rows):
            return ContactFrames()
        starts = self.rows.frames()[:-1]
        keys = self.rows.key[starts]
        _, first = np.unique(keys, return_index=True)
        for place in np.flatnonzero(~np.isin(np.arange(len(keys)), first))[:1]:
            self.rows.problem_once("order", starts[place], f"the rows of frame {number_text(keys[place])} must follow one another, got more "
                                   "behind others: sort them")
        frames = ContactFrames(keys)
        frame = np.searchsorted(starts, np.arange(len(self.rows)), "right") - 1
        # A frame without contacts counts in the order as well.
        wanted = self.rows.wanted()
        grain, partner, swapped, known = self.partners(wanted)
        at = self.grains.frames_of(self.map.word("frames_by", "plate"), keys)[frame]
        force = self.forces(grain, partner, swapped, at, known)
        point = np.full((len(grain), 3), np.nan)
        if all(key in self.rows for key in "xyz"):
            point = np.column_stack([self.rows.number(key, known) for key in "xyz"]) * self.map.length_factor() - self.grains.origin
            known &= np.isfinite(point).all(axis=1)
        # Grains without force do not touch; LAMMPS lists them as well.
        kept = known & np.isfinite(force).all(axis=1) & (force != 0).any(axis=1)
        frames.partner = np.where(partner == SOME_WALL, wall_by_direction(np.nan_to_num(force)), partner)[kept]
        frames.frame, frames.grain, frames.point, frames.force = frame[kept], grain[kept], point[kept], force[kept]
        frames.row, frames.rows = np.flatnonzero(kept), self.rows
        return frames


def import_contacts(table, grains, problems, most=None):
    return _Reader(table, grains, problems, most).read()
