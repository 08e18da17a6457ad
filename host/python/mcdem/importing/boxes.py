"""Boxes in the files of simulation programs, and whether they contradict the container of the experiment."""
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..problems import Problems, quoted, to_number
from .arrays import Floats
from .mapping import Known, MappedTable, signed_column

if TYPE_CHECKING:
    from .grains import GrainFrames
    from .tables import Table

# Of bounds with six digits, as LIGGGHTS writes them (%g): half a unit of the last digit of both, and of the experiment's number.
ROUNDING = 1e-5
SIDES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")


@dataclass
class Box:
    """In the units of its table."""

    line: int  # 0: unknown
    low: Floats  # [3] corner
    edges: Floats  # [3][3] a row for each edge
    faces: str  # of SIDES: p periodic, f fixed, s or m follows the grains, ? not said


def _numbers(table: "Table", lines: list[str], line: int, count: int) -> list[float]:
    cells = lines[line - 1].partition("#")[0].split() if line <= len(lines) else []
    values = [value for cell in cells[:count] if (value := to_number(cell)) is not None]
    if len(values) < count:
        raise InputError(f"{table.file}:{min(line, len(lines))}: a line of the box must begin with {count} numbers, got "
                         + quoted(lines[line - 1] if line <= len(lines) else "the file's end"))
    return values


def dump_box(table: "Table", lines: list[str], title: str, line: int) -> Box:
    """The three lines from `line` on, below `ITEM: BOX BOUNDS ..`. https://docs.lammps.org/dump.html"""
    words = title.split()[2:]
    flags = [word for word in words if len(word) == 2 and set(word) <= set("pfsm")]
    faces = "".join(flags[:3]).ljust(6, "?")
    if "abc" in words:
        rows = np.array([_numbers(table, lines, line + axis, 4) for axis in range(3)])
        return Box(line, rows[:, 3], rows[:, :3], faces)
    rows = np.array([_numbers(table, lines, line + axis, 3 if "xy" in words else 2) for axis in range(3)])
    low, high = rows[:, 0].copy(), rows[:, 1].copy()
    xy, xz, yz = rows[:, 2] if "xy" in words else np.zeros(3)
    low -= [min(0, xy, xz, xy + xz), min(0, yz), 0]  # those of the corners are given
    high -= [max(0, xy, xz, xy + xz), max(0, yz), 0]
    return _upright(line, low, high, (xy, xz, yz), faces)


def _upright(line: int, low: Floats, high: Floats, tilts: Sequence[float], faces: str = "??????") -> Box:
    edges = np.diag(np.subtract(high, low))
    edges[1, 0], edges[2, 0], edges[2, 1] = tilts
    return Box(line, np.array(low, float), edges, faces)


def data_box(table: "Table", lines: list[str], end: int) -> Box | None:
    """Of the header of a data file, its first `end` lines; None if it says none. https://docs.lammps.org/read_data.html"""
    found = {}
    for number in range(2, end):
        words = lines[number - 1].partition("#")[0].split()
        for names in (("xlo", "xhi"), ("ylo", "yhi"), ("zlo", "zhi"), ("xy", "xz", "yz"), ("avec",), ("bvec",), ("cvec",),
                      ("abc", "origin")):
            count = 3 if names[0] in ("avec", "bvec", "cvec", "abc") else len(names)
            if tuple(words[count:]) == names:
                found[names[0]] = (number, _numbers(table, lines, number, count))
    line = min((number for number, _ in found.values()), default=0)
    if {"avec", "bvec", "cvec", "abc"} <= set(found):
        return Box(line, np.array(found["abc"][1]), np.array([found[name][1] for name in ("avec", "bvec", "cvec")]), "??????")
    if not {"xlo", "ylo", "zlo"} <= set(found):
        return None
    low, high = np.array([found[name][1] for name in ("xlo", "ylo", "zlo")]).T
    return _upright(line, low, high, found.get("xy", (0, (0.0, 0.0, 0.0)))[1])


def xyz_box(atoms: Any, states_pbc: bool) -> Box | None:
    """Of ASE's atoms; None without a lattice. ASE takes a lattice of which the file does not say so for periodic."""
    edges = np.array(atoms.cell)
    if not edges.any():
        return None
    low = np.ravel(atoms.info.get("Origin", np.zeros(3)))
    low = low.astype(float) if low.shape == (3,) and low.dtype.kind in "if" else np.zeros(3)
    return Box(0, low, edges, "".join("pp" if repeats else "ff" for repeats in atoms.pbc) if states_pbc else "??????")


def _in_metres(box: Box, mapped: MappedTable) -> tuple[Box, Floats, Floats] | None:
    """In the axes of the experiment, its size along them and the error of its ends; None if x, y and z are not the table's own axes in some order."""
    sign, names = zip(*(signed_column(mapped.word(key)) for key in "xyz"))
    axes = ["xyz".find(name[:1].lower()) if name[1:] in ("", "u") else -1 for name in names]
    if sorted(axes) != [0, 1, 2]:
        return None
    unit, origin = mapped.length_factor(), np.array([mapped.number(f"origin_{axis}") for axis in "xyz"])
    edges = unit * (np.array(sign, float)[None, :] * box.edges[axes][:, axes])
    ends = unit * np.array(sign) * np.array([box.low[axes] - origin, box.low[axes] + np.diag(box.edges)[axes] - origin])
    faces = "".join(box.faces[2 * axis:2 * axis + 2][::int(of)] for axis, of in zip(axes, sign))
    return Box(box.line, ends.min(axis=0), edges, faces), np.abs(np.diag(edges)), ROUNDING * np.abs(ends).max(axis=0)


def _contradiction(moved: tuple[Box, Floats, Floats], grains: Floats, known: Known) -> tuple[str, bool]:
    """What contradicts the container, or nothing; and whether it is certain. `grains`: lowest and highest ends of the grains [2][3]."""
    box, size, small = moved
    widths, periodic = np.array([*known.box, 0.0]), known.shape == "periodic"
    tilt = box.edges - np.diag(np.diag(box.edges))
    if periodic:  # whole periods give the same images
        tilt[1, 0] = np.remainder(tilt[1, 0] + size[0] / 2, size[0]) - size[0] / 2
    if (np.abs(tilt) > small).any():
        return "must be upright, as the experiment's container is, got one with edges of " + "; ".join(
            " ".join(f"{value:.6g}" for value in edge) for edge in box.edges) + " m: take tables of an upright one", True
    uncertain = ""
    for axis, name in enumerate("xyz"):
        faces, low, high = box.faces[2 * axis:2 * axis + 2], box.low[axis], box.low[axis] + size[axis]
        if periodic and axis < 2:
            if faces[0] not in "p?":
                return f'must repeat along {name} as container.shape = "periodic", got boundaries that do not: set container.shape', True
            if known.box[axis] and abs(size[axis] - known.box[axis]) > max(small[axis], ROUNDING * known.box[axis]):
                return (f"must be {known.box[axis]:.9g} m long along {name}, the period in box.size, got {size[axis]:.9g}: see box.size "
                        "and length_unit in the mapping"), True
            continue
        if faces[0] == "p" and (grains[0, axis] < low - small[axis] or grains[1, axis] > high + small[axis]):
            return (f"must not repeat along {name}, where the experiment has walls and grains reach through its face"
                    + (': set container.shape = "periodic"' if axis < 2 else ": an experiment has a floor and a plate"), True)
        begins, ends = low > small[axis], axis < 2 and known.box[axis] > 0 and high < widths[axis] - small[axis]
        kinds = faces[0] * bool(begins) + faces[1] * bool(ends)
        where = f"the experiment's box, 0 to {widths[axis]:.6g} m along {name}," if axis < 2 else "the floor, z = 0,"
        what = f"must hold {where} got {low:.6g} to {high:.6g} m: see box.size, and origin_{name} and length_unit in the mapping"
        if set(kinds) & set("pf"):
            return what, True
        uncertain = uncertain or (what if "?" in kinds else "")
    return uncertain, False


def check_boxes(grains: "GrainFrames", known: Known, problems: Problems, notes: list[str]) -> None:
    """Compares the boxes of all frames of grains (GrainFrames) with the known container; one finding for each file."""
    told = set()
    for frame, (rows, first) in enumerate(grains.where):
        part = rows.parts[rows.part[first]]
        place = np.searchsorted([row for _, row in part.frames], rows.row[first], "right") - 1 if part.frames else 0
        box = part.boxes[place] if 0 <= place < len(part.boxes) else None
        moved = _in_metres(box, rows.map) if box and part.file not in told else None
        if moved is None:
            continue
        radius = grains.diameter[:, None] / 2
        centres = grains.position[frame][:len(radius)]
        if len(centres) < len(radius):  # a problem already
            continue
        ends = np.array([(centres - radius).min(axis=0), (centres + radius).max(axis=0)])
        what, certain = _contradiction(moved, ends, known)
        if what:
            told.add(part.file)
            where = part.file + (f":{box.line}" if box.line else "")
            if certain:
                problems.add(where, "the box " + what)
            else:
                notes.append(f"{where}: the box {what.replace('must', 'should', 1)}")
