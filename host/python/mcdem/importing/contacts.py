"""Contacts by frame, with the numbers of the grains. Points that were not measured are NaN."""
from collections.abc import Sequence

import numpy as np
import pandas as pd

from ..number_text import shortest
from ..problems import Problems, is_whole, quoted
from .arrays import Bools, Floats, Ints
from .grains import GrainFrames
from .mapping import BY_DIRECTION, WALLS
from .rows import ImportTable, Rows, whole_entry

# In addition to grains >= 0 and walls -1 to -6: wall to be determined by the force; unknown partner; wall of a reversed axis.
SOME_WALL, NOBODY, REVERSED = -7, -8, -9
INWARDS = np.kron(np.eye(3), [[1], [-1]])  # normals of the walls


def wall_partner(name: str) -> int:
    return -1 - WALLS.index(name)


class ContactFrames:
    def __init__(self, rows: Rows, keys: Sequence[float] | Floats = ()) -> None:
        self.keys = list(keys)  # of each frame, including those without contacts
        self.frame = self.grain = self.partner = self.row = np.zeros(0, int)  # of each contact; row: among `rows`
        self.point = self.force = np.zeros((0, 3))  # [m], on `grain` [N]
        self.rows = rows


class _Reader:
    def __init__(self, table: ImportTable, grains: GrainFrames, problems: Problems, most: int | None) -> None:
        self.map, self.grains = table.map, grains
        self.rows = Rows(table, problems, most)
        self.rows.expect_quantity("force", ("fx", "fy", "fz", "force"))
        self.rows.expect_quantity("length", "xyz")
        self.offset = whole_entry(self.map, "id_offset", problems)
        self.one_wall = self.map.word("partner") if self.map.word("partner") in WALLS else None

    def side_of(self, key: str, name: float | str, frame: int) -> int:
        """A grain, a wall, SOME_WALL, REVERSED or NOBODY. `name` is a number or a text; `frame`: of the grains."""
        grain = int(self.grains.number_of(int(name) + self.offset, frame)) if isinstance(name, float) and is_whole(name) else -1
        wall = self.map.walls.get(shortest(name) if isinstance(name, float) else name)
        if wall and (key == "partner" or grain < 0):  # numbers of meshes may equal those of grains
            return SOME_WALL if wall.word == BY_DIRECTION else wall_partner(wall.word)
        if isinstance(name, str) and name in WALLS:
            return REVERSED if name[0] in "xy" and self.grains.sign["xy".index(name[0])] < 0 else wall_partner(name)
        return grain if grain >= 0 else NOBODY

    def sides(self, key: str, at: Ints, wanted: Bools) -> Ints:
        """Partner of each row, in frame `at` of the grains; unknown partners in `wanted` rows are problems, but not where grains are linked."""
        if key == "partner" and self.one_wall:
            return np.full(len(self.rows), wall_partner(self.one_wall))
        names = self.rows.cells(key).astype(object)
        for i in np.flatnonzero(pd.isna(names)):
            names[i] = self.rows.text(i, key)
        frames = at if self.grains.labels else np.zeros(len(names), int)
        sides = np.full(len(names), NOBODY)
        for frame in np.unique(frames):
            mine = np.flatnonzero(frames == frame)
            which, different = pd.factorize(names[mine])
            sides[mine] = np.array([self.side_of(key, name, frame) for name in different], int)[which]
        for i in np.flatnonzero((sides == REVERSED) & wanted)[:1]:
            wall = names[i]
            self.rows.problem_once(wall, i, f'{wall} must be named in [table.walls] where {wall[0]} is reversed, {wall} = "x_min" or another')
        nobody = np.flatnonzero((sides == NOBODY) & wanted)
        for i in nobody[:0 if self.grains.labels else 20]:
            self.rows.problem(i, f"{key} must be a grain, or a wall that [table.walls] of the mapping names, got "
                              + quoted(self.rows.text(i, key)))
        return np.asarray(np.maximum(sides, NOBODY))

    def partners(self, at: Ints, wanted: Bools) -> tuple[Ints, Ints, Bools, Bools]:
        """Grain and partner of each row, whether they were exchanged, and which rows are complete."""
        first, second = self.sides("grain", at, wanted), self.sides("partner", at, wanted)
        swapped = first < 0  # Yade lists walls first
        grain, partner = np.where(swapped, second, first), np.where(swapped, first, second)
        known = wanted & (first != NOBODY) & (second != NOBODY)
        wrong = known & ((grain < 0) | (grain == partner))
        for i in np.flatnonzero(wrong)[:20]:
            other = self.one_wall or quoted(self.rows.text(i, "partner"))
            self.rows.problem(i, f"a contact must have a grain and another, or a wall, got {quoted(self.rows.text(i, 'grain'))} and {other}")
        return grain, partner, swapped, known & ~wrong

    def forces(self, grain: Ints, partner: Ints, swapped: Bools, at: Ints, known: Bools) -> Floats:
        if "force" not in self.rows:
            on_grain = swapped == (self.map.word("force_on", "grain") != "grain")
            sign = np.where(on_grain, 1, -1)[:, None]
            return np.asarray(self.map.force_factor() * sign * self.rows.numbers(["fx", "fy", "fz"], known))
        away = np.full((len(grain), 3), np.nan)  # from the partner
        of_walls, of_pairs = (partner < 0) & (partner > SOME_WALL), known & (partner >= 0) & (at >= 0)
        away[of_walls] = INWARDS[-1 - partner[of_walls]]
        if of_pairs.any():
            position = np.array(self.grains.position)
            line = position[at[of_pairs], grain[of_pairs]] - position[at[of_pairs], partner[of_pairs]]
            with np.errstate(invalid="ignore", divide="ignore"):
                away[of_pairs] = line / np.linalg.norm(line, axis=1)[:, None]
        for i in np.flatnonzero(known & np.isnan(away).any(axis=1))[:1]:
            self.rows.problem_once("size", i, "a force's size needs to know its direction: both centres in this frame, at two "
                                   "places, or which wall")
        return np.asarray(self.map.force_factor() * self.rows.number("force", known)[:, None] * away)

    def read(self) -> ContactFrames:
        forces = [] if self.map.is_topology else ["force"] if "force" in self.rows else ["fx", "fy", "fz"]
        if self.rows.lacks("grain", *([] if self.one_wall else ["partner"]), *forces) or not len(self.rows):
            return ContactFrames(self.rows)
        starts = self.rows.frames()[:-1]
        keys = self.rows.key[starts]
        for place in np.flatnonzero(pd.Series(keys).duplicated())[:1]:
            self.rows.problem_once("order", starts[place], f"the rows of frame {shortest(keys[place])} must follow one another, got more "
                                   "behind others: sort them")
        frames = ContactFrames(self.rows, keys)
        frame = np.searchsorted(starts, np.arange(len(self.rows)), "right") - 1
        # A frame without contacts counts in the order as well.
        at = self.grains.frames_of(self.map.word("frames_by", "plate"), keys)[frame]
        grain, partner, swapped, known = self.partners(at, self.rows.wanted())
        force = self.forces(grain, partner, swapped, at, known) if forces else np.zeros((len(grain), 3))
        point = np.full((len(grain), 3), np.nan)
        if all(key in self.rows for key in "xyz"):
            point = self.rows.numbers("xyz", known) * self.map.length_factor() - self.grains.origin
            known &= np.isfinite(point).all(axis=1)
        # Grains without force do not touch; LAMMPS lists them as well.
        kept = known & np.isfinite(force).all(axis=1) & ((force != 0).any(axis=1) | (not forces))
        by_force = -1 - np.argmax(np.nan_to_num(force) @ INWARDS.T, axis=1)  # the wall whose normal is closest to the force
        frames.partner = np.where(partner == SOME_WALL, by_force, partner)[kept]
        frames.frame, frames.grain, frames.point, frames.force = frame[kept], grain[kept], point[kept], force[kept]
        frames.row = np.flatnonzero(kept)
        return frames


def import_contacts(table: ImportTable, grains: GrainFrames, problems: Problems, most: int | None = None) -> ContactFrames:
    return _Reader(table, grains, problems, most).read()
