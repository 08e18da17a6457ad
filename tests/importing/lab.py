"""A compression as tables of a laboratory or of another program, and the values that an import must return."""
import copy
import importlib.util
import itertools
import os
import sys
import tempfile
import unittest
from dataclasses import dataclass, field

MISSING = [name for name in ("numpy", "pandas", "ase", "meshio", "scipy") if not importlib.util.find_spec(name)]
if MISSING:
    print(f"skipped: {', '.join('python3-' + name for name in MISSING)} not installed")
    sys.exit(77)

import numpy as np

from mcdem.errors import InputError
from mcdem.importing.assemble import import_tables
from mcdem.importing.guess import guess_tables, mapping_of, read_import_tables
from mcdem.importing.mapping import WALLS, Known, mapping_text, unclear_entries
from mcdem.importing.read_mapping import parse_mapping
from mcdem.toml import toml_value

BOX = (0.06, 0.08)
GERMAN_WALLS = ["links", "rechts", "vorn", "hinten", "Boden", "Deckel"]


@dataclass
class Contact:
    grain: int
    partner: int  # a grain, or -1 - the index of a wall in WALLS
    point: np.ndarray
    force: np.ndarray

    @property
    def is_wall(self):
        return self.partner < 0

    def partner_text(self, first=1, walls=WALLS):
        return walls[-1 - self.partner] if self.is_wall else str(self.partner + first)


@dataclass
class Scan:
    frame: int
    plate_z: float
    phase: str
    position: np.ndarray
    contacts: list = field(default_factory=list)
    top_force: float = 0.0


@dataclass
class Truth:
    diameter: np.ndarray
    scans: list


def contacts_of(truth, scan):
    """Forces from overlaps by Hertz's law."""
    modulus, radius, found = 23300 / 0.75, truth.diameter / 2, []

    def add(i, partner, line, overlap, r, stiffness, point):
        if overlap > 0:
            found.append(Contact(i, partner, point, 4 / 3 * stiffness * np.sqrt(r) * overlap**1.5 * line))

    for i, at in enumerate(scan.position):
        for j in range(i + 1, len(scan.position)):
            line = at - scan.position[j]
            distance = np.linalg.norm(line)
            add(i, j, line / distance, radius[i] + radius[j] - distance, radius[i] * radius[j] / (radius[i] + radius[j]), modulus / 2,
                at - line / distance * (radius[i] + distance - radius[j]) / 2)
        for w, place in enumerate((0, BOX[0], 0, BOX[1], 0, scan.plate_z)):
            foot, sign = at.copy(), 1 if w % 2 == 0 else -1
            foot[w // 2] = place
            add(i, -1 - w, sign * np.eye(3)[w // 2], radius[i] - sign * (at[w // 2] - place), radius[i], modulus, foot)
    return found


def pressed_packing():
    """3 x 4 x 3 grains of about 20 mm on a lattice with random offsets; seven frames of one stroke down and up."""
    random = np.random.default_rng(7)
    lattice = np.array([(n % 3 + 0.5, n // 3 % 4 + 0.5, n // 12 + 0.5) for n in range(36)]) + random.uniform(-0.02, 0.02, (36, 3))
    truth = Truth(0.0207 + random.uniform(-3e-4, 3e-4, 36), [])
    for f, height in enumerate((0.0605, 0.059, 0.057, 0.055, 0.0565, 0.0585, 0.0602)):
        scan = Scan(f, height, "load" if f < 4 else "unload", lattice * [0.02, 0.02, height / 3])
        scan.contacts = contacts_of(truth, scan)
        scan.top_force = -sum(c.force[2] for c in scan.contacts if c.partner == -6)
        truth.scans.append(scan)
    return truth


PRESSED = pressed_packing()


@dataclass
class Style:
    separator: str = ";"
    decimal: str = ","
    named: bool = True  # units in column names
    length: float = 1e3  # the table's units per metre
    force: float = 1e3  # .. per newton

    def table(self, names, rows):
        """Numbers with nine digits."""
        cells = ([value if isinstance(value, str) else f"{value:.9g}".replace(".", self.decimal) for value in row] for row in rows)
        return "".join(self.separator.join(row) + "\n" for row in itertools.chain([names], cells))

    @property
    def mm(self):
        return " [mm]" if self.named else ""

    @property
    def mN(self):
        return " [mN]" if self.named else ""


def lab_plate(truth, style=Style()):
    """Without phase and cycle; frames are numbered by time, half a second each."""
    return style.table(["Kraft" + style.mN, "Zeit [s]", "Hoehe" + style.mm],
                       ((style.force * s.top_force, 0.5 * s.frame, style.length * s.plate_z) for s in truth.scans))


def lab_grains(truth, style=Style()):
    """Radii; ids start at 1."""
    mm, k = style.mm, style.length
    return style.table(["Radius" + mm, "z" + mm, "Nr.", "x" + mm, "Zeit [s]", "y" + mm],
                       ((k * truth.diameter[i] / 2, k * z, str(i + 1), k * x, 0.5 * s.frame, k * y)
                        for s in truth.scans for i, (x, y, z) in enumerate(s.position)))


def lab_contacts(truth, style=Style()):
    """Walls by name; other columns in between."""
    mm, mN, k = style.mm, style.mN, style.length
    return style.table(["fz" + mN, "Korn 2", "fx" + mN, "x" + mm, "fy" + mN, "z" + mm, "Guete", "y" + mm, "Korn 1", "Zeit [s]"],
                       ((style.force * c.force[2], c.partner_text(1, GERMAN_WALLS), style.force * c.force[0], k * c.point[0],
                         style.force * c.force[1], k * c.point[2], "gut", k * c.point[1], str(c.grain + 1), 0.5 * s.frame)
                        for s in truth.scans for c in s.contacts))


def _dump(frame, kind, columns, rows):
    return (f"ITEM: TIMESTEP\n{100 * frame}\nITEM: NUMBER OF {kind}\n{len(rows)}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
            f"ITEM: {kind} {columns} \n" + "".join(" ".join(f"{value:.9g}" for value in row) + " \n" for row in rows))


def dump_of_grains(truth):
    """LAMMPS' `dump custom`: timesteps 100 apart, ids from 1, rows in any order."""
    return "".join(_dump(s.frame, "ATOMS", "id type x y z radius", [(k + 1, 1, *s.position[k], truth.diameter[k] / 2)
                                                                    for k in reversed(range(len(s.position)))]) for s in truth.scans)


def dump_of_contacts(truth, walls):
    """LIGGGHTS' `dump local` of `compute pair/gran/local id force`; for walls of wall/gran/local, mesh numbers from
    0."""
    return "".join(_dump(s.frame, "ENTRIES", "c_p[1] c_p[2] c_p[3] c_p[4] c_p[5] c_p[6]",
                         [((-1 - c.partner, 0, c.grain + 1) if walls else (c.grain + 1, c.partner + 1, 0)) + tuple(c.force)
                          for c in s.contacts if c.is_wall == walls]) for s in truth.scans)


def plain_plate(truth, separator=",", frames="step", step=100):
    """In metres and newtons; `frames` names a column of numbers `step` apart, or none."""
    names = ([frames] if frames else []) + ["plate_z_m", "force_N"]
    rows = (([step * s.frame] if frames else []) + [float(s.plate_z), float(s.top_force)] for s in truth.scans)
    return "".join(separator.join(map(str, row)) + "\n" for row in itertools.chain([names], rows))


def mapped(role, file, walls=(), **entries):
    """A table of a mapping."""
    lines = [f"{key} = {toml_value(word)}" for key, word in {"role": role, "files": [file], **entries}.items()]
    return "\n".join(["[[table]]", *lines, "[table.walls]" * bool(walls), *(f'{name} = "{wall}"' for name, wall in dict(walls).items()), ""])


class ImportCase(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory(prefix="mcdem-test-")
        self.addCleanup(kept.cleanup)
        self.folder = kept.name
        self.truth = copy.deepcopy(PRESSED)
        self.known = Known(box=BOX, youngs_modulus=23300, poisson_ratio=0.5)

    def write(self, name, text):
        with open(self.path(name), "wb") as out:
            out.write(text if isinstance(text, bytes) else text.encode())
        return self.path(name)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write_lab(self, style=Style()):
        return [self.write("kraft.csv", lab_plate(self.truth, style)), self.write("koerner.csv", lab_grains(self.truth, style)),
                self.write("kontakte.csv", lab_contacts(self.truth, style))]

    def guess(self, files):
        return guess_tables(files, self.known)

    def imported(self, tables):
        return import_tables(tables, self.known)

    def unclear(self, tables):
        """Uncertain entries of the guess, without the folder's path."""
        return [line.replace(self.folder + "/", "") for line in unclear_entries(mapping_text(mapping_of(tables)), "m")]

    def by_mapping(self, text, files=()):
        return read_import_tables(parse_mapping(text, "m"), files, "m")

    def problems_of(self, action):
        try:
            action()
        except InputError as error:
            return [problem.replace(self.folder + "/", "") for problem in error.problems]
        return []

    @staticmethod
    def of(tables, role):
        return next(table.map for table in tables if table.role == role)

    def expect_one(self, lines, part):
        self.assertEqual(len(lines), 1, lines)
        self.assertIn(part, lines[0])

    def expect_among(self, lines, *parts):
        self.assertTrue(any(all(part in line for part in parts) for line in lines), (parts, lines))

    def guess_surely(self, files, **words):
        """The guess for these files, of which nothing must be confirmed. `words`: for a role, keys with the words of the mapping."""
        tables = self.guess(files)
        self.assertEqual(self.unclear(tables), [])
        for role, entries in words.items():
            found = {key: entry.word for key, entry in self.of(tables, role).entries.items()}
            self.assertEqual({key: found.get(key) for key in entries}, entries)
        return tables

    def expect_import(self, files, **words):
        """Of the truth, by a guess of which nothing must be confirmed."""
        tables = self.guess_surely(files, **words)
        self.expect_truth(tables)
        return tables

    def expect_truth(self, tables):
        """Numbers were printed with nine digits."""
        self.expect_tables(import_tables(tables, self.known))

    def accepted(self, tables, *replaced):
        """The mapping with all entries confirmed, and texts of it replaced."""
        text = mapping_text(mapping_of(tables)).replace('"?', '"')
        for old, new in replaced:
            self.assertIn(old, text)
            text = text.replace(old, new)
        return text

    def expect_tables(self, imported, contacts=True):
        plate, grains = imported.plate, imported.grains
        self.assertEqual(list(plate.frame), list(range(len(self.truth.scans))))
        self.assertEqual(list(plate.phase), [scan.phase for scan in self.truth.scans])
        self.assertEqual(set(plate.cycle), {0})
        np.testing.assert_allclose(plate.plate_z_m, [scan.plate_z for scan in self.truth.scans], atol=1e-10)
        np.testing.assert_allclose(plate.top_force_N, [scan.top_force for scan in self.truth.scans], atol=1e-8)
        placed = [scan for scan in self.truth.scans if len(scan.position)]
        self.assertEqual(list(grains.frame.unique()), [scan.frame for scan in placed])
        self.assertEqual(list(grains.grain), list(range(len(self.truth.diameter))) * len(placed))
        np.testing.assert_allclose(grains[["x_m", "y_m", "z_m"]], np.concatenate([scan.position for scan in placed]), atol=1e-9)
        np.testing.assert_allclose(grains.diameter_m, np.tile(self.truth.diameter, len(placed)), atol=1e-10)
        if contacts:
            for scan in self.truth.scans:
                self.expect_contacts(imported, scan)

    def expect_contacts(self, imported, scan, frame=None):
        table = imported.contacts
        rows = [] if table is None else table[table.frame == (scan.frame if frame is None else frame)].to_dict("records")
        found = sorted(((row["grain"], str(row["partner"]), row) for row in rows), key=lambda one: one[:2])
        wanted = sorted(((c.grain, c.partner_text(0), c) for c in scan.contacts), key=lambda one: one[:2])
        self.assertEqual([one[:2] for one in found], [one[:2] for one in wanted])
        for (*_, row), (*_, contact) in zip(found, wanted):
            np.testing.assert_allclose([row[f"f{axis}_N"] for axis in "xyz"], contact.force, atol=1e-8)
            np.testing.assert_allclose([row[f"{axis}_m"] for axis in "xyz"], contact.point, atol=1e-9)
