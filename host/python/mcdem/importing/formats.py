"""Readers for files of simulation programs: dumps and data files of LAMMPS and LIGGGHTS, VTK, extended xyz."""
import contextlib
import io
import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ..errors import InputError
from ..files import temporary_folder
from ..problems import quoted
from .arrays import Floats
from .boxes import data_box, dump_box, xyz_box
from .text import Form, numbers_of

if TYPE_CHECKING:
    from .tables import Table

ITEM = "ITEM: "


def _whole(word: str) -> int | None:
    """A whole number >= 0, or None."""
    return int(word) if re.fullmatch(r"\+?[0-9]{1,18}", word) else None


def _wrong(table: "Table", line: int, what: str) -> NoReturn:
    raise InputError(f"{table.file}:{line}: {what}")


def parse_dump(table: "Table", lines: list[str]) -> None:
    """`dump custom` (ITEM: ATOMS) and `dump local` (ITEM: ENTRIES), any number of frames, each with the names of its columns."""
    table.begin("dump", lines, Form(" ", "."))
    items = [n for n, line in enumerate(lines, 1) if line.lstrip().startswith(ITEM)] + [len(lines) + 1]
    step = count = names = box = None
    for line, end in zip(items, items[1:]):
        what = lines[line - 1].strip().removeprefix(ITEM)
        if what == "TIMESTEP" or what.startswith("NUMBER OF "):
            value = "".join(lines[line:line + 1]).strip()
            count = _whole(value)
            if count is None:
                said = "the timestep" if what == "TIMESTEP" else "the number of rows"
                _wrong(table, min(line + 1, len(lines)), f"{said} must be a whole number >= 0, got {quoted(value)}")
            if what == "TIMESTEP":
                step, count, box = count, None, None
        elif what.startswith("BOX BOUNDS"):
            box = dump_box(table, lines, what, line + 1)
        elif what.startswith(("ATOMS", "ENTRIES")):
            columns = what.split()[1:]
            if step is None:
                _wrong(table, line, '"ITEM: TIMESTEP" must come before, got none')
            if not columns:
                _wrong(table, line, "the line must name the columns, got none: write the dump with a newer version")
            if names is None:
                names = columns
                table.name_columns(names, len(names))
            if columns != names:
                _wrong(table, line, f"the columns must be those of the first frame, {' '.join(names)}, got {' '.join(columns)}")
            table.frames.append((step, table.rows))
            table.boxes.append(box)
            for number in range(line + 1, end):
                cells = lines[number - 1].split()
                if cells and len(cells) != len(names):
                    _wrong(table, number, f"must have {len(names)} columns as line {line} says, got {len(cells)}")
                if cells:
                    table.add_row(cells, number)
            found = table.rows - table.frames[-1][1]
            if count is not None and count != found:
                _wrong(table, line, f"must have the {count} rows that the frame promises, got {found}"
                       + ("; truncated?" if found < count else ""))
            step = None
    if not table.frames:
        raise InputError(f"{table.file}: must hold at least one frame, got none")


def looks_like_data(lines: list[str]) -> bool:
    words = [line.partition("#")[0].split() for line in lines[1:2000]]
    return ["Atoms"] in words and any(one[1:] == ["atoms"] for one in words[:words.index(["Atoms"])])


def parse_data(table: "Table", lines: list[str]) -> None:
    """LAMMPS data files of the styles sphere and granular: id type diameter density x y z, in the order of the ids."""
    words_of = [line.partition("#")[0].split() for line in lines]
    start = words_of.index(["Atoms"], 1) + 1
    promised = next(_whole(words[0]) for words in words_of[:start] if words[1:] == ["atoms"])
    rows = []
    for number, words in enumerate(words_of[start:], start + 1):
        if words and words[0][0].isalpha() and len(words) < 7:
            break  # the next section
        values = numbers_of(words, ".")
        if words and (len(words) not in (7, 10) or not all(map(math.isfinite, values)) or values[2] <= 0):
            _wrong(table, number, "an atom must have 7 columns (id type diameter density x y z) or 10 (3 image flags more), numbers with "
                   f"a diameter > 0, got {quoted(' '.join(words))}")
        if words:
            rows.append(values[:7])
    if not rows or promised != len(rows):
        raise InputError(f"{table.file}: must have the {promised} atoms that it promises, at least 1, got {len(rows)}; truncated?")
    table.boxes.append(data_box(table, lines, start))
    atoms = np.array(rows)
    _, order = np.unique(atoms[:, 0], return_index=True)
    if len(order) < len(atoms):
        raise InputError(f"{table.file}: each atom must have its own id, got one twice")
    table.set_numbers("data", ["x", "y", "z", "diameter"], atoms[order][:, [4, 5, 6, 2]])


def parse_xyz(table: "Table", text: str) -> None:
    """Extended xyz, frame by frame, read by ASE; vectors become name_x, name_y, name_z."""
    from ase.io import iread

    frames, names, rows = list[Floats](), list[str](), 0
    try:
        for place, atoms in enumerate(iread(io.StringIO(text), format="extxyz", index=":")):
            fields = {name: values for name, values in sorted(atoms.arrays.items())
                      if name not in ("positions", "numbers") and values.dtype.kind in "if"}
            columns, values = _with_fields(["x", "y", "z"], atoms.positions, fields)
            names = names or columns
            if columns != names:
                raise ValueError(f"the fields of a frame are {' '.join(columns)}, those of the first are {' '.join(names)}")
            step = next((atoms.info[key] for key in ("step", "Step", "timestep", "frame") if key in atoms.info), place)
            if not math.isfinite(step := float(step)):
                raise ValueError(f"the step of a frame must be a finite number, got {step}")
            table.frames.append((step, rows))
            table.boxes.append(xyz_box(atoms, "pbc=" in text))
            frames.append(values)
            rows += len(values)
    except (Exception, SystemExit) as error:  # ASE has no exception type for invalid files
        raise InputError(f"{table.file}: must be extended xyz that ASE reads, got: {quoted(str(error) or type(error).__name__)}") from None
    table.set_numbers("xyz", names, np.concatenate(frames))


def is_mesh(content: bytes) -> bool:
    head = content[:2000]
    return head.startswith((b"<?xml", b"<VTKFile")) and b"VTKFile" in head or (
        head.startswith(b"# vtk DataFile") and b"DATASET UNSTRUCTURED_GRID" in head)


def parse_mesh(table: "Table", content: bytes) -> None:
    """VTK's unstructured grids, legacy or XML, read by meshio: a row is a point with its data."""
    import meshio

    if (kind := re.search(rb"<VTKFile[^>]*\stype=[\"']([^\"'<>]*)", content[:2000])) and kind[1] != b"UnstructuredGrid":
        raise InputError(f"{table.file}: must be an UnstructuredGrid (.vtu), got {quoted(kind[1].decode(errors='replace'))}: save it in ParaView as "
                         ".csv, or as .vtu behind the filter Append Datasets")
    said = io.StringIO()
    with temporary_folder() as folder:
        file = folder / ("mesh.vtk" if content.startswith(b"#") else "mesh.vtu")
        file.write_bytes(content)
        try:
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                mesh = meshio.read(file)
            columns, values = _with_fields(["x", "y", "z"], mesh.points, mesh.point_data)
        except (Exception, SystemExit) as error:  # meshio prints and exits if it cannot read a file
            why = " ".join(said.getvalue().split()) if isinstance(error, SystemExit) else f"{type(error).__name__} {error}"
            raise InputError(f"{table.file}: must be a VTK file that meshio reads, got: {quoted(why.replace(str(file), 'it'))}") from None
    if not len(values):
        raise InputError(f"{table.file}: must hold points, got none")
    table.set_numbers("vtk", columns, values)


def _with_fields(names: list[str], values: Floats, fields: Mapping[str, Any]) -> tuple[list[str], Floats]:
    """Columns and their names with those of each field added: of vectors name_x, name_y, name_z, of tensors name_xx, .."""
    for name, field in fields.items():
        field = np.asarray(field, float).reshape(len(values), -1)
        width = field.shape[1]
        names = names + ([name] if width == 1 else [
            f"{name}_{'xyz'[k]}" if width == 3 else f"{name}_{'xyz'[k // 3 % 3]}{'xyz'[k % 3]}" for k in range(width)])
        values = np.column_stack([values, field])
    return names, values


WIDTHS = {"POINTS": 3, "LINES": 3, "POINT_DATA": 0, "CELL_DATA": 0, "SCALARS": 1, "VECTORS": 3, "TENSORS": 9}  # numbers in a row


def _vtk_sections(lines: list[str]) -> list[tuple[int, list[str], list[str]]]:
    """Line number, words of the first line and numbers below it, of each section."""
    sections = list[tuple[int, list[str], list[str]]]()
    for number, line in enumerate(lines, 1):
        words = line.split()
        if words and number > 3 and words[0][0].isalpha() and words[0].isupper():
            if words[0] != "LOOKUP_TABLE":
                sections.append((number, words, []))
        elif sections:
            sections[-1][2].extend(words)
    return sections


def parse_vtk(table: "Table", lines: list[str]) -> None:
    """VTK's legacy format in ASCII with polygonal data, as Yade's VTKExporter writes it, which meshio does not read. A row is a
    point with its data, x y z first; where there are lines, a line with its data, x1 y1 z1 x2 y2 z2 of its two ends first.
    https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html"""
    if "".join(lines[2:3]).strip() != "ASCII":
        _wrong(table, min(3, len(lines)), "the format must be ASCII: write the file as text")
    fields: dict[bool, dict[str, Floats]] = {True: {}, False: {}}  # of points, of lines
    first, points, ends, of_points, count = 0, np.zeros((0, 3)), None, True, 0
    for line, (kind, *words), numbers in _vtk_sections(lines):
        if kind == "DATASET" and words == ["POLYDATA"]:
            continue
        if kind not in WIDTHS or not words:
            _wrong(table, line, f"must be one of {', '.join(WIDTHS)}, of a data set POLYDATA, got " + quoted(" ".join([kind, *words])))
        if kind in ("POINTS", "LINES", "POINT_DATA", "CELL_DATA"):
            if (said := _whole(words[0])) is None:
                _wrong(table, line, f"a section must say how many there are, got {quoted(words[0])}")
            count = said
        wanted = WIDTHS[kind] * count
        if len(numbers) != wanted:
            _wrong(table, line, f"{wanted} numbers must follow, got {len(numbers)}" + ("; truncated?" if len(numbers) < wanted else ""))
        values = np.array(numbers_of(numbers, ".")).reshape(-1, max(WIDTHS[kind], 1))
        if kind == "POINTS":
            first, points = line, values
        elif kind == "LINES":
            ends = values
        elif kind.endswith("_DATA"):
            of_points = kind == "POINT_DATA"
        else:
            fields[of_points][words[0]] = values
    if not len(points):
        raise InputError(f"{table.file}: must hold POINTS, got none")
    names, values = ["x", "y", "z"], points
    if ends is not None:
        bad = (ends[:, 0] != 2) | ~np.isin(ends[:, 1:], np.arange(len(points))).all(axis=1)
        if bad.any():
            raise InputError(f"{table.file}: line {np.argmax(bad)} must join two of the {len(points)} points")
        values = points[ends[:, 1:].astype(int)].reshape(-1, 6)
        names = ["x1", "y1", "z1", "x2", "y2", "z2"]
    for name, field in fields[ends is None].items():
        if len(field) != len(values):
            raise InputError(f"{table.file}: {name} must have {len(values)} rows, as the points or lines, got {len(field)}")
    names, values = _with_fields(names, values, fields[ends is None])
    rows = range(first + 1, first + 1 + len(values))
    a_line_each = ends is None and all(len(line.split()) == 3 for line in lines[first:first + len(values)])
    table.set_numbers("vtk", names, values, rows if a_line_each else ())
