"""Readers for files of simulation programs: dumps and data files of LAMMPS and LIGGGHTS, VTK, extended xyz."""
import contextlib
import io
import pathlib
import re
import tempfile

import numpy as np

from .problems import quoted, to_number
from .text import Form

ITEM = "ITEM: "
MAX_NUMBERS = 100_000_000


def _whole(word):
    return int(word) if re.fullmatch(r"[+-]?[0-9]{1,18}", word) else None


def parse_dump(table, lines, problems):
    """`dump custom` (ITEM: ATOMS) and `dump local` (ITEM: ENTRIES), any number of frames, each with the names of its columns."""
    table.begin("dump", lines, Form(" ", "."))
    items = [n for n, line in enumerate(lines) if line.startswith(ITEM)] + [len(lines)]
    first = next(n for n, line in enumerate(lines) if line.strip())
    if items[0] != first:
        items.insert(0, first)
    step = count = names = None
    for at, end in zip(items, items[1:]):
        title, line = lines[at].strip(), at + 1
        what = title.removeprefix(ITEM)
        value = lines[at + 1].strip() if at + 1 < len(lines) else None
        if what == title:
            return problems.add(f"{table.file}:{line}", f'must be a line that begins with "ITEM: ", got {quoted(title)}')
        if what == "TIMESTEP" or what.startswith("NUMBER OF "):
            number = None if value is None else _whole(value)
            if number is None or number < 0:
                said = "the timestep" if what == "TIMESTEP" else "the number of rows"
                problems.add(f"{table.file}:{min(line + 1, len(lines))}", f"{said} must be a whole number >= 0, got "
                             f"{quoted(value or '')}")
            if what == "TIMESTEP":
                step, count = number, None
            else:
                count = number
        elif what.startswith(("ATOMS", "ENTRIES")):
            if step is None:
                problems.add(f"{table.file}:{line}", '"ITEM: TIMESTEP" must come before, got none')
            columns = what.split()[1:]
            if not columns:
                problems.add(f"{table.file}:{line}", "the line must name the columns, got none: write the dump with a newer version")
            elif names is None:
                names = columns
                table.name_columns(names, len(names))
            elif columns != names:
                problems.add(f"{table.file}:{line}",
                             f"the columns must be those of the first frame, {' '.join(names)}, got {' '.join(columns)}")
            if problems.count:
                return None
            table.frames.append((step, table.rows))
            _dump_rows(table, at, end, count, problems)
            step = None
        if problems.full:
            return None
    if not table.frames and not problems.count:
        problems.add(table.file, "must hold at least one frame, got none")
    return None


def _dump_rows(table, at, end, count, problems):
    found = 0
    for number in range(at + 1, end):
        cells = table.lines[number].split()
        found += bool(cells)
        if len(cells) == len(table.columns):
            table.add_row(cells, number + 1)
        elif cells:
            problems.add(f"{table.file}:{number + 1}", f"must have {len(table.columns)} columns as line {at + 1} says, got {len(cells)}")
    if count is not None and found != count and not problems.full:
        problems.add(f"{table.file}:{at + 1}", f"must have the {count} rows that the frame promises, got {found}"
                     + ("; truncated?" if found < count else ""))


def looks_like_data(lines):
    counted = False
    for line in lines[1:2000]:
        words = line.partition("#")[0].split()
        counted |= len(words) == 2 and words[1] == "atoms"
        if counted and words == ["Atoms"]:
            return True
    return False


def parse_data(table, lines, problems):
    """LAMMPS data files of the styles sphere and granular: id type diameter density x y z, in the order of the ids."""
    start = next(n for n, line in enumerate(lines) if line.partition("#")[0].split() == ["Atoms"])
    promised = next((_whole(line.split()[0]) for line in lines[:start] if line.split()[1:2] == ["atoms"]), None)
    rows = []
    for number, line in enumerate(lines[start + 1:], start + 2):
        words = line.partition("#")[0].split()
        if not words:
            continue
        if words[0][0].isalpha() and len(words) < 7:
            break  # the next section
        values = [to_number(word) for word in words]
        if len(words) not in (7, 10) or None in values or values[2] <= 0:
            problems.add(f"{table.file}:{number}", "an atom must have 7 columns (id type diameter density x y z) or 10 (3 image "
                         f"flags more), numbers with a diameter > 0, got {quoted(' '.join(words))}")
        else:
            rows.append(values)
    if not problems.count and (not rows or promised != len(rows)):
        problems.add(table.file, f"must have the {promised} atoms that it promises, at least 1, got {len(rows)}; truncated?")
    if problems.count:
        return
    rows = np.array(rows)
    order = np.argsort(rows[:, 0], kind="stable")
    if len(np.unique(rows[:, 0])) < len(rows):
        problems.add(table.file, "each atom must have its own id, got one twice")
    table.set_numbers("data", ["x", "y", "z", "diameter"], rows[order][:, [4, 5, 6, 2]])


def looks_like_xyz(lines):
    return len(lines) > 2 and lines[0].strip().isdigit() and "Properties=" in lines[1]


def parse_xyz(table, text, problems):
    """Extended xyz, frame by frame, read by ASE; vectors become name_x, name_y, name_z."""
    from ase.io import iread

    names = None
    chunks = []
    try:
        for place, atoms in enumerate(iread(io.StringIO(text), format="extxyz", index=":")):
            fields = {name: np.atleast_2d(values.T).T for name, values in sorted(atoms.arrays.items())
                      if name not in ("positions", "numbers") and values.dtype.kind in "if"}
            columns = _columns(fields)
            if names not in (None, columns):
                return problems.add(table.file, f"the fields of all frames must be those of the first, {' '.join(names)}, got "
                                    f"{' '.join(columns)}")
            names = columns
            step = next((atoms.info[key] for key in ("step", "Step", "timestep", "frame") if key in atoms.info), place)
            table.frames.append((float(step), sum(map(len, chunks))))
            chunks.append(np.column_stack([atoms.positions, *fields.values()]))
    except Exception as error:  # ASE has no exception type for invalid files
        return problems.add(table.file, f"must be extended xyz that ASE reads, got: {quoted(str(error) or type(error).__name__)}")
    table.set_numbers("xyz", names, np.concatenate(chunks))
    return None


def is_mesh(content):
    head = content[:2000]
    return head.startswith((b"<?xml", b"<VTKFile")) and b"VTKFile" in head or (
        head.startswith(b"# vtk DataFile") and b"DATASET UNSTRUCTURED_GRID" in head)


def parse_mesh(table, content, problems):
    """VTK's unstructured grids, legacy or XML, read by meshio: a row is a point with its data."""
    import meshio

    ending = ".vtk" if content.startswith(b"#") else ".vtu"
    with tempfile.TemporaryDirectory(prefix="mcdem-") as folder:
        file = pathlib.Path(folder, "mesh" + ending)
        file.write_bytes(content)
        try:
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                mesh = meshio.read(file)
            fields = {name: np.asarray(values, float).reshape(len(mesh.points), -1) for name, values in mesh.point_data.items()}
        except SystemExit:  # meshio exits if it cannot read a file
            return problems.add(table.file, "must be a VTK file that meshio reads, got one that it cannot read")
        except Exception as error:
            return problems.add(table.file, f"must be a VTK file that meshio reads, got: {quoted(str(error) or type(error).__name__)}")
    if not len(mesh.points):
        return problems.add(table.file, "must hold points, got none")
    table.set_numbers("vtk", _columns(fields), np.column_stack([mesh.points, *fields.values()]))
    return None


def _columns(fields):
    """Names of the columns of points with these fields."""
    return ["x", "y", "z"] + [column for name, values in fields.items() for column in _component_names(name, values.shape[1])]


def _component_names(name, width):
    if width == 1:
        return [name]
    return [f"{name}_{'xyz'[k]}" if width == 3 else f"{name}_{'xyz'[k // 3 % 3]}{'xyz'[k % 3]}" for k in range(width)]


class _Vtk:
    """VTK's legacy format in ASCII with polygonal data, as Yade's VTKExporter writes it, which meshio does not read. A row is a
    point with its data, x y z first; where there are lines, a line with its data, x1 y1 z1 x2 y2 z2 of its two ends first.
    https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html"""

    def __init__(self, table, lines, problems):
        self.table, self.problems, self.lines, self.at = table, problems, lines, 2
        self.points, self.ends, self.fields, self.of_cells, self.count, self.points_at = None, None, [], False, 0, 0

    def next(self):
        while self.at < len(self.lines):
            self.at += 1
            if words := self.lines[self.at - 1].split():
                return words
        return None

    def wrong(self, what):
        self.problems.add(f"{self.table.file}:{self.at}", what)

    def size(self, words, place):
        count = _whole(words[place]) if place < len(words) else None
        if count is not None and 0 <= count <= MAX_NUMBERS:
            return count
        self.wrong(f"a section must say how many there are, up to {MAX_NUMBERS}, got "
                   f"{quoted(words[place]) if place < len(words) else 'nothing'}")
        return 0

    def numbers(self, count):
        """The next `count` numbers, which may span several lines."""
        words = []
        while len(words) < count and not self.problems.count:
            more = self.next()
            if more is None:
                self.wrong(f"{count - len(words)} more numbers must follow, got the file's end; truncated?")
                return np.zeros(0)
            words += more
        if len(words) > count:
            self.wrong(f"a section must end at a line's end, got {len(words) - count} numbers more")
        return np.array([np.nan if (value := to_number(word)) is None else value for word in words[:count]])

    def section(self, words):
        kind = words[0]
        if kind == "DATASET":
            if words[1:] != ["POLYDATA"]:
                self.wrong("the data set must be POLYDATA")
        elif kind == "POINTS":
            count = self.size(words, 1)
            self.points_at = self.at
            self.points = self.numbers(3 * count).reshape(-1, 3)
        elif kind == "LINES":
            count = self.size(words, 1)
            if self.size(words, 2) != 3 * count:
                return self.wrong("each line must join two points")
            self.ends = self.numbers(3 * count).reshape(-1, 3)
        elif kind in ("POINT_DATA", "CELL_DATA"):
            self.of_cells, self.count = kind == "CELL_DATA", self.size(words, 1)
        elif kind in ("SCALARS", "VECTORS", "TENSORS") and len(words) > 1:
            width = {"SCALARS": 1, "VECTORS": 3, "TENSORS": 9}[kind]
            before = self.at
            if width == 1 and (self.next() or [""])[0] != "LOOKUP_TABLE":
                self.at = before
            self.fields.append((words[1], self.of_cells, self.numbers(self.count * width).reshape(-1, width)))
        else:
            self.wrong("must be one of POINTS, LINES, POINT_DATA, CELL_DATA, SCALARS, VECTORS, TENSORS, got " + quoted(kind))
        return None

    def rows(self):
        if self.points is None or not len(self.points):
            return self.problems.add(self.table.file, "must hold POINTS, got none")
        names, values = ["x", "y", "z"], self.points
        if self.ends is not None:
            ends = self.ends[:, 1:]
            bad = ~((ends >= 0) & (ends < len(self.points)) & (ends == np.round(ends)))
            if bad.any():
                line = int(np.argmax(bad.any(axis=1)))
                return self.problems.add(self.table.file, f"line {line} must join two of the {len(self.points)} points")
            values = self.points[ends.astype(int)].reshape(-1, 6)
            names = [letter + end for end in "12" for letter in "xyz"]
        for name, of_cells, field in self.fields:
            if of_cells == (self.ends is not None):
                if len(field) != len(values):
                    return self.problems.add(self.table.file, f"{name} must have {len(values)} rows, as the points or lines, got {len(field)}")
                names = names + _component_names(name, field.shape[1])
                values = np.column_stack([values, field])
        lines = range(self.points_at + 1, self.points_at + 1 + len(values))
        a_line_each = self.ends is None and all(len(self.lines[line - 1].split()) == 3 for line in lines)
        self.table.set_numbers("vtk", names, values, lines if a_line_each else ())
        return None


def parse_vtk(table, lines, problems):
    vtk = _Vtk(table, lines, problems)
    words = vtk.next()
    if words != ["ASCII"]:
        return vtk.wrong("the format must be ASCII: write the file as text")
    while not problems.count and (words := vtk.next()):
        vtk.section(words)
    if not problems.count:
        vtk.rows()
    return None
