"""Measured compressions, in the form of a simulated recording (host/experiment/README.md describes their folders).

The program checks a folder (`mcdem experiment check`) before its tables are read here.
"""
import gzip
import os
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..command import ask
from ..errors import InputError, RunError
from ..look import is_there
from ..number_text import shortest
from ..files import INTACT
from .names import ContainerShape, Phase, Wall
from .parameters import Parameters
from .recording import NO_CONTACTS, NO_VECTORS, Bools, Box, Contacts, Floats, Ints, Recording, Scans
from .run_file import KINDS, ROW_SHAPES, SCAN_FIELDS

MATERIALS = ("grains.youngs_modulus", "grains.poisson_ratio", "grains.excess_density", "grains.friction", "grains.restitution",
             "walls.youngs_modulus", "walls.friction")
TEXT_LENGTH = 24  # of a partner or phase


def read_experiment(folder: str) -> Recording:
    """Z, <f> and <b> are computed from the contacts above the force threshold; what was not measured is NaN or empty.

    Raises InputError with all problems, RunError if the folder or the program cannot be read.
    """
    ask(["experiment", "check", f"./{folder}" if folder.startswith("-") else folder])
    try:
        return _read(folder)
    except OSError as error:
        raise RunError(f"{error.filename or folder}: cannot be read: {error.strerror or error}{INTACT}") from error
    except (ValueError, KeyError, IndexError, AttributeError, TypeError, EOFError) as error:
        raise InputError(f"{folder}: cannot be read although it is an experiment: has it changed meanwhile? ({error})") from error


def _read(folder: str) -> Recording:
    with open(os.path.join(folder, "experiment.toml"), encoding="utf-8-sig") as file:
        settings = tomllib.loads(file.read())
    box = _box(settings)
    plate = _rows(folder, "plate.csv", ("frame", "cycle", "phase", "plate_z_m", "top_force_N"), ("time_s",)) or {}
    scans = _scans(plate)
    start = settings.get("plate", {}).get("start", scans.plate_z.max())
    name = settings.get("name", os.path.splitext(os.path.basename(folder.rstrip("/")))[0])
    recording = Recording(name, _parameters(settings), box, float(start), np.zeros(0), scans)
    grains = _rows(folder, "grains.csv", ("frame", "grain", "x_m", "y_m", "z_m", "diameter_m"))
    contacts = _rows(folder, "contacts.csv", ("frame", "grain", "partner", "x_m", "y_m", "z_m", "fx_N", "fy_N", "fz_N"))
    if grains:
        recording = _with_grains(recording, grains)
    if contacts:
        recording = _with_contacts(recording, contacts)
    threshold = settings.get("measurement", {}).get("force_threshold", 0.0)
    return replace(recording, scans=average_contacts(recording.scans, len(recording.diameter), threshold))


def _box(settings: dict[str, Any]) -> Box:
    container = settings.get("container", {})
    shape = ContainerShape(container.get("shape", "box"))
    if shape == ContainerShape.cylinder:
        return Box(2.0 * container["radius"], 2.0 * container["radius"], shape)
    return Box(float(settings["box"]["size"][0]), float(settings["box"]["size"][1]), shape)


def _parameters(settings: dict[str, Any]) -> Parameters:
    """Scene keys that were measured, and the stages of a programme."""
    groups = [(key, *key.split(".")) for key in MATERIALS]
    known = {key: shortest(settings[group][name]) for key, group, name in groups if name in settings.get(group, {})}
    stages = {f"programme.{number}.{key}": str(value) for number, stage in enumerate(settings.get("programme", []), 1)
              for key, value in ({"stage": "move"} | stage).items()}
    return known | stages


def _rows(folder: str, name: str, columns: tuple[str, ...], optional: tuple[str, ...] = ()) -> dict[str, NDArray[Any]] | None:
    """The columns of a table, plain or compressed; None if it is not there."""
    plain, packed = os.path.join(folder, name), os.path.join(folder, name + ".gz")
    if not (is_there(plain) or is_there(packed)):
        return None
    form: dict[str, Any] = {"mode": "rt", "encoding": "utf-8-sig", "errors": "replace"}
    with open(plain, **form) if is_there(plain) else gzip.open(packed, **form) as file:
        lines = _lines(file)
        header, *rows = _lines(file)
    words = [word.strip() for word in header.split(",")]
    chosen = [column for column in (*columns, *optional) if column in words]
    if not rows or not set(columns) <= set(chosen):
        raise ValueError(f"{name} has no rows, or not all columns")
    kinds = [(column, f"U{TEXT_LENGTH}" if column in ("phase", "partner") else "f8") for column in chosen]
    table = np.loadtxt(rows, kinds, comments=None, delimiter=",", usecols=[words.index(column) for column in chosen], ndmin=1)
    return {column: table[column] for column in chosen}


def _lines(file: Any) -> Iterator[str]:
    """Those that are neither empty nor comments, without quotes."""
    for line in file:
        if (text := line.strip()) and not text.startswith("#"):
            yield text.replace('"', "")


def _whole(values: NDArray[Any]) -> Ints:
    return values.astype(float).astype(np.int64)


def _scans(plate: dict[str, NDArray[Any]]) -> Scans:
    count = len(plate["frame"])
    values: dict[str, Any] = {name: np.full((count, *ROW_SHAPES.get(name, ())), np.nan) for name in SCAN_FIELDS if name not in KINDS}
    values["strain"][:] = 0
    values["plate_z"] = plate["plate_z_m"]
    values["wall_force"][:, Wall.plate, 2] = plate["top_force_N"]
    values["time"] = plate.get("time_s", values["time"])
    phase = np.array([Phase[word.strip()] for word in plate["phase"].tolist()], np.int64)
    nothing = (NO_VECTORS,) * count
    return Scans(frame=np.arange(count), cycle=_whole(plate["cycle"]), phase=phase, settled=np.ones(count, bool), **values,
                 position=nothing, rotation=nothing, contacts=(NO_CONTACTS,) * count)


def _by_frame(frame: Ints) -> Iterator[tuple[int, Ints]]:
    """The numbers of the frames with their rows, in the order of the table."""
    order = np.argsort(frame, kind="stable")
    numbers, first = np.unique(frame[order], return_index=True)
    yield from zip(numbers.tolist(), np.split(order, first[1:]))


def _with_grains(recording: Recording, rows: dict[str, NDArray[Any]]) -> Recording:
    """Diameters of frame 0 and positions. In a periodic container a grain is at the image nearest to its previous position."""
    frame, grain = _whole(rows["frame"]), _whole(rows["grain"])
    centre = np.column_stack([rows[axis] for axis in ("x_m", "y_m", "z_m")])
    diameter = np.zeros(int(grain.max()) + 1)
    diameter[grain[frame == 0]] = rows["diameter_m"][frame == 0]
    if not (diameter > 0).all():
        raise ValueError("frame 0 of grains.csv has not all grains")
    edges = np.array([recording.box.size_x, recording.box.size_y, np.inf]) if recording.box.is_periodic else np.full(3, np.inf)
    position, last = list(recording.scans.position), None
    for number, mine in _by_frame(frame):
        here = np.zeros((len(diameter), 3))
        here[grain[mine]] = centre[mine]
        if last is not None and recording.box.is_periodic:
            way = here - last
            way[:, :2] -= np.rint(way[:, :2] / edges[:2]) * edges[:2]
            here = last + way
        position[number] = last = here
    return replace(recording, diameter=diameter, scans=replace(recording.scans, position=tuple(position)))


def _with_contacts(recording: Recording, rows: dict[str, NDArray[Any]]) -> Recording:
    frame, grain = _whole(rows["frame"]), _whole(rows["grain"])
    point, force = (np.column_stack([rows[name] for name in names])
                    for names in (("x_m", "y_m", "z_m"), ("fx_N", "fy_N", "fz_N")))
    words = np.char.strip(rows["partner"])
    walls = {recording.box.wall_name(wall): -1 - wall for wall in Wall if recording.box.has_wall(wall)}
    is_wall = np.isin(words, list(walls))
    partner = np.zeros(len(words), np.int64)
    partner[~is_wall] = _whole(words[~is_wall])
    for word, number in walls.items():
        partner[words == word] = number
    swapped = ~is_wall & (partner < grain)  # listed from the other side
    grain, partner = np.where(swapped, partner, grain), np.where(swapped, grain, partner)
    force = np.where(swapped[:, None], -force, force)
    contacts = list(recording.scans.contacts)
    for number, mine in _by_frame(frame):
        contacts[number] = Contacts(grain[mine], partner[mine], point[mine], force[mine], np.full(len(mine), np.nan))
    return replace(recording, scans=replace(recording.scans, contacts=tuple(contacts)))


def average_contacts(scans: Scans, grains: int, force_threshold: float) -> Scans:
    """With wall forces except the plate's, Z, <f> and <b> of the scans that have contacts.

    Forces are those of walls that have any contact: on the others no contacts does not mean no force. The plate's gauge also
    measures contacts below the threshold [N], so the top force stays.
    """
    measured = sorted({-1 - int(partner) for one in scans.contacts for partner in np.unique(one.partner[one.is_wall])})
    wall_force, number, mean_force, branch = (values.copy() for values in (scans.wall_force, scans.coordination_number, scans.mean_force,
                                                                           scans.branch_length))
    for row, one in enumerate(scans.contacts):
        if not len(one):
            continue
        for wall in measured:
            wall_force[row, wall] = -one.force[one.partner == -1 - wall].sum(0)
        wall_force[row, Wall.plate, 2] = scans.top_force[row]
        magnitude = np.linalg.norm(one.force, axis=1)
        counted = ~(magnitude < force_threshold)
        pairs = counted & ~one.is_wall
        number[row] = (counted.sum() + pairs.sum()) / grains
        if counted.any():
            mean_force[row] = magnitude[counted].mean()
        if pairs.any() and len(scans.position[row]):
            branch[row] = _branches(scans.position[row], one, pairs).mean()
    return replace(scans, wall_force=wall_force, coordination_number=number, mean_force=mean_force, branch_length=branch)


def _branches(position: Floats, contacts: Contacts, which: Bools) -> Floats:
    """Distances of centres [m]."""
    return np.asarray(np.linalg.norm(position[contacts.partner[which]] - position[contacts.grain[which]], axis=1))
