"""Combines plate, grains and contacts into the tables of an experiment folder."""
import gzip
import os
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from ..files import write_whole
from ..look import Path
from ..number_text import shortest
from ..problems import Problems
from .arrays import Ints
from .boxes import check_boxes
from .contacts import ContactFrames, import_contacts
from .grains import GrainFrames, import_grains
from .mapping import WALLS, Known
from .plate import PlateRows, check_heights, import_plate, needs_start
from .record import import_course
from .rows import ImportTable, Rows, of_role

# For the two sides of a contact: largest difference over the larger force; weak forces over the largest one of the frame.
MAX_APART, WEAK = 0.5, 0.01


@dataclass
class Imported:
    """The tables of an experiment folder, and notes about ignored data."""

    plate: pd.DataFrame
    grains: pd.DataFrame | None
    contacts: pd.DataFrame | None
    plate_start: float
    notes: list[str] = field(default_factory=list)
    topology: pd.DataFrame | None = None  # contacts without forces
    programme: str = ""  # [[programme]] of experiment.toml


class _Assembly:
    def __init__(self, tables: list[ImportTable], known: Known) -> None:
        self.tables, self.known, self.problems = tables, known, Problems()
        self.plate, self.grains, self.notes, self.dropped = PlateRows(), GrainFrames(), list[str](), 0
        self.topology = list[pd.DataFrame]()

    def run(self) -> Imported:
        plates, grains, contacts = (of_role(self.tables, role) for role in ("plate", "grains", "contacts"))
        start = self.known.plate_start
        if len(plates) != 1:
            self.problems.add("plate", f"must be one table with the plate's position and force by frame, got {len(plates)}: say "
                              '`role = "plate"` in the mapping, or give the table')
        elif needs_start(plates[0].map) and np.isnan(start):
            self.problems.add(plates[0].map.files[0], f"{plates[0].map.place} counts downwards from plate.start, which must be given [m]: --set "
                              "plate.start=..")
        elif plates[0].map.word("course") == "stages":
            return self.of_record(plates[0], len(grains) + len(contacts))
        else:
            self.plate = import_plate(plates[0], start, self.problems, self.known.programme)
        self.grains = import_grains(grains, self.problems)
        self.notes += self.grains.notes
        check_boxes(self.grains, self.known, self.problems, self.notes)
        if contacts and not grains:
            self.problems.add("grains", "must be a table of the grains, for contacts name them, got none")
        self.problems.report()
        if grains:
            self.place_grains(grains[0].map.word("frames_by", "plate"))
        check_heights(self.plate, start, self.dropped)
        tables = list[pd.DataFrame]()
        for table in contacts if -1 not in self.grains.row else ():
            if table.map.is_topology:
                self.topology.append(self.topology_of(table))
            else:
                tables.append(self.contacts_of(table, tables))
        self.problems.report()
        return self.result(pd.concat(tables) if tables else None)

    def of_record(self, table: ImportTable, others: int) -> Imported:
        """Of a testing machine, without grains."""
        if others or self.known.programme:
            self.problems.add(table.map.files[0], 'course = "stages" must stand alone, got ' + ("tables of grains" if others else "[[programme]]")
                              + ' too: write course = "rows" in the mapping')
            self.problems.report()
        programme = import_course(table, self.known, self.problems)
        self.problems.report()
        assert programme is not None
        return Imported(programme.plate, None, None, programme.start, self.notes, programme=programme.text)

    def place_grains(self, by: str) -> None:
        def wrong(frame: int, topic: str, what: str) -> None:
            rows, first = grains.where[frame]
            rows.problem_once(topic, first, f"frame {shortest(grains.keys[frame])} must {what} in the mapping")

        grains, frames, rows = self.grains, len(self.grains.keys), len(self.plate)
        grains.place(by if by in ("order", "rows", "nearest") else "plate", self.plate)
        if by == "order" and frames < rows:
            self.notes.append(f"frames_by is order: the {frames} frames of the grains are at the first {frames} of the plate's {rows} rows")
        first_at = grains.frames_at(grains.row)
        for frame, row in enumerate(grains.row):
            if row < 0:
                wrong(frame, "frame", f"be one of the plate's {rows} rows, got none like it: see frame and frames_by")
                continue
            if first_at[frame] < frame:
                wrong(frame, "row", "have a row of the plate of its own, got one that an earlier frame has: see frames_by")
            x, y, z = size = np.array([*self.known.box, self.plate.z[row]])
            for centre in grains.position[frame][((grains.position[frame] < 0) | (grains.position[frame] > size)).any(axis=1)][:1]:
                wrong(frame, "inside", f"have all centres in the box of {x:g} by {y:g} m below the plate at {z:g} m, got one at "
                      + ", ".join(f"{place:.4g}" for place in centre) + ": see length_unit, origin_x, origin_y, origin_z and frames_by")
        if min(grains.row) > 0:  # an experiment starts at the first frame of the grains
            self.dropped = min(grains.row)
            self.notes.append(f"the plate's first {self.dropped} rows are left out: grains are known from then on")

    def topology_of(self, table: ImportTable) -> pd.DataFrame:
        """Pairs that touch, each once in a frame, by row of the plate."""
        frames = import_contacts(table, self.grains, self.problems)
        scan = self.scans_of(table, frames)[frames.frame]
        swapped = (frames.partner >= 0) & (frames.partner < frames.grain)
        pairs = pd.DataFrame({"frame": scan - self.dropped, "grain": np.where(swapped, frames.partner, frames.grain),
                              "partner": np.where(swapped, frames.grain, frames.partner)})
        return pairs[pairs.frame >= 0].drop_duplicates().sort_values(["frame", "grain", "partner"], kind="stable")

    def scans_of(self, table: ImportTable, frames: ContactFrames) -> Ints:
        """The plate's row of each frame; a frame with contacts that has none is a problem."""
        by = table.map.word("frames_by", "plate")
        scans = self.grains.plate_rows_of(by, frames.keys)
        for i in np.flatnonzero(scans[frames.frame] < 0)[:1]:
            key = shortest(frames.keys[frames.frame[i]])
            whose = "grains' frames" if by == "grains" else "plate's rows"
            frames.rows.problem_once("frame", frames.row[i], f"frame {key} must be one of the {whose}, got none like it: see frame and "
                                     "frames_by in the mapping")
        return scans

    def contacts_of(self, table: ImportTable, before: list[pd.DataFrame]) -> pd.DataFrame:
        """Each contact once, with grain < partner, by row of the plate."""
        frames = import_contacts(table, self.grains, self.problems)
        scans = self.scans_of(table, frames)
        reversed_ = (frames.partner >= 0) & (frames.partner < frames.grain)
        force = np.where(reversed_, -1, 1)[:, None] * frames.force
        all_of = pd.DataFrame({"scan": scans[frames.frame], "grain": np.where(reversed_, frames.partner, frames.grain),
                               "partner": np.where(reversed_, frames.grain, frames.partner), "side": reversed_, "row": frames.row,
                               **dict(zip(("x", "y", "z", "fx", "fy", "fz"), np.hstack([frames.point, force]).T))})
        all_of = all_of[all_of.scan >= 0].reset_index(drop=True)
        return self.put_points(self.joined(all_of, table.map.word("sides", "one") == "both", frames.rows, before), frames)

    def joined(self, contacts: pd.DataFrame, both: bool, rows: Rows, before: list[pd.DataFrame]) -> pd.DataFrame:
        """The mean of both sides if contacts are listed from both. Weak forces may differ more, because their errors are those of
        the strong ones."""
        pair, forces = ["scan", "grain", "partner"], ["fx", "fy", "fz"]
        of_pairs = contacts.groupby(pair, sort=False)
        place, first = of_pairs.cumcount(), of_pairs.transform("first")
        in_others = pd.MultiIndex.from_frame(contacts[pair]).isin([key for table in before for key in zip(*table[pair].values.T)])
        other_side = (place == 1) & (contacts.side != first.side) & ~in_others
        for i in np.flatnonzero((place > 0) & ~(other_side & both) | in_others)[:1]:
            rows.problem_once("twice", contacts.row[i], "each contact must be there once in a frame, got it " + (
                'from its other side too: write `sides = "both"` in the mapping where each is listed from either side'
                if other_side[i] else "again in the same direction or in another table: make one row of rows of normal and tangential "
                "parts, and leave out what is there twice"))
        size, size_of_first, apart = (np.linalg.norm(force, axis=1) for force in (
            contacts[forces], first[forces], contacts[forces] - first[forces]))
        allowed = np.maximum(MAX_APART * np.maximum(size, size_of_first), WEAK * pd.Series(size).groupby(contacts.scan).transform("max"))
        for i in np.flatnonzero(both & other_side & (apart > allowed))[:1]:
            rows.problem_once("sides", contacts.row[i], "the forces of a contact's two sides must be opposite, got sizes of "
                              f"{size_of_first[i]:.4g} and {size[i]:.4g} N, {apart[i]:.4g} N apart when one is negated: leave one "
                              'of the sides out of the table and write `sides = "one"`')
        return of_pairs.agg({"row": "first", **dict.fromkeys(["x", "y", "z", *forces], "mean")}).reset_index()

    def put_points(self, contacts: pd.DataFrame, frames: ContactFrames) -> pd.DataFrame:
        """Contact points that were not measured: midway between the surfaces; on a wall, the foot of the perpendicular."""
        lost = np.flatnonzero(contacts.x.isna())
        frame = self.grains.frames_at(contacts.scan[lost])
        position, radius = np.array(self.grains.position), self.grains.diameter / 2
        grain, partner = contacts.grain.values[lost], contacts.partner.values[lost]
        centre = position[frame, grain]
        line = position[frame, np.maximum(partner, 0)] - centre
        distance = np.linalg.norm(line, axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            point = centre + ((radius[grain] + distance - radius[np.maximum(partner, 0)]) / (2 * distance))[:, None] * line
        top = self.plate.z[contacts.scan.values[lost]]
        for wall, place in enumerate((0, self.known.box[0], 0, self.known.box[1], 0, top)):
            mine = partner == -1 - wall
            point[mine] = centre[mine]
            point[mine, wall // 2] = np.broadcast_to(place, len(lost))[mine]
        for i in lost[(frame < 0) | ~np.isfinite(point).all(axis=1)][:1]:
            frames.rows.problem_once("point", contacts.row[i], "a contact must have a point, or its grains a position in its "
                                     "frame, two places, got neither")
        contacts.loc[lost, ["x", "y", "z"]] = point
        return contacts

    def result(self, contacts: pd.DataFrame | None) -> Imported:
        plate, grains, first, start = self.plate, self.grains, self.dropped, self.known.plate_start
        rows = slice(first, None)
        if not np.isfinite(start):
            start = float(np.nanmax(plate.z[rows], initial=-np.inf))
        plate_table = pd.DataFrame({"frame": np.arange(len(plate.z[rows])), "cycle": plate.cycle[rows] - plate.cycle[first:first + 1],
                                    "phase": np.where(plate.phase[rows] == 0, "load", "unload"), "plate_z_m": plate.z[rows],
                                    "top_force_N": plate.force[rows]})
        if self.known.programme and np.isfinite(plate.set_force).any():
            plate_table["set_force_N"] = plate.set_force[rows]
        if self.known.programme:
            plate_table["time_s"] = plate.time[rows]
        grain_table = None
        if grains.keys:
            frames, count = np.argsort(grains.row), len(grains.diameter)
            position = np.concatenate([grains.position[frame] for frame in frames])
            grain_table = pd.DataFrame({"frame": np.repeat(np.sort(grains.row) - first, count),
                                        "grain": np.tile(np.arange(count), len(frames)), **dict(zip(("x_m", "y_m", "z_m"), position.T)),
                                        "diameter_m": np.tile(grains.diameter, len(frames))})
        if contacts is not None:
            contacts = contacts[contacts.scan >= first].sort_values("scan", kind="stable").drop(columns="row")
            contacts["partner"] = contacts.partner.map(lambda p: WALLS[-1 - p] if p < 0 else p)
            contacts["scan"] -= first
            contacts.columns = ["frame", "grain", "partner", "x_m", "y_m", "z_m", "fx_N", "fy_N", "fz_N"]
        topology = pd.concat(self.topology) if self.topology else None
        if topology is not None:
            self.notes.append(f"{len(topology)} contacts have no forces: topology.csv keeps which grains touch")
            topology["partner"] = topology.partner.map(lambda p: WALLS[-1 - p] if p < 0 else p)
        return Imported(plate_table, grain_table, contacts, start, self.notes, topology=topology)


def import_tables(tables: list[ImportTable], known: Known) -> Imported:
    return _Assembly(tables, known).run()


def write_tables(imported: Imported, folder: Path, packed: bool = False) -> None:
    """Writes a table if it has rows, with the shortest digits that give the same numbers when read; flushes it to disk."""
    for name in ("plate", "grains", "contacts", "topology"):
        table = getattr(imported, name)
        if table is not None and len(table):
            file = os.path.join(folder, name + ".csv" + (".gz" if packed else ""))
            rows = table.to_csv(index=False).encode()
            write_whole(file, gzip.compress(rows, mtime=0) if packed else rows)
