"""One result file: run.h5 or a segment of an unfinished run. host/io/README.md describes its layout."""
import math
from collections.abc import Collection, Iterator
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..errors import InputError
from ..number_text import shortest
from .hdf5 import File, fail
from .names import ContainerShape, Phase, Wall, all_names, parse
from .parameters import Parameters
from .recording import NO_CONTACTS, NO_VECTORS, Box, Contacts, Failure, Floats, Ints, Recording, Run, Scans

FORMAT = 1  # of this layout; later ones are refused
ROW_SHAPES = {"wall_force": (len(Wall), 3), "stress": (3, 3), "fabric": (3, 3), "strain": (6,)}  # of fields that are no numbers
# Files of earlier versions do not have these.
OPTIONAL = {"rate_error", "max_overlap", "stress", "fabric", "strain", "wall_work", "weight_work", "damping_loss", "friction_loss",
            "drag_loss", "energy_error"}
Chosen = bool | Collection[int]  # all or none of the replicas, or their numbers
KINDS: dict[str, type[np.generic]] = {"frame": np.int64, "cycle": np.int64, "phase": np.int64, "settled": np.bool_}
SCAN_FIELDS = [one.name for one in fields(Scans) if one.name not in ("position", "rotation", "contacts")]


def read_file(path: str, contacts: bool, positions: Chosen) -> Run:
    """The run in one file. Raises InputError, RunError."""
    with File(path) as file:
        _expect_result(file)
        texts = {name: file.text_attribute("/parameters", name) for name in ("name", "program", "device", "precision")}
        scene = file.texts("/parameters/scene")
        replicas = file.integer_attribute("/parameters", "replicas")
        if replicas != file.count("/observables"):
            raise InputError(f"{file.where('/observables')}: must hold {replicas} replicas")
        headers = [_read_header(file, f"replica_{number:05}") for number in range(replicas)]
        recordings = [_with_scans(file, f"replica_{number:05}", header, contacts, is_chosen(number, positions))
                      for number, header in enumerate(headers)]
        return Run(scene=scene[0] if scene else "", recordings=tuple(recordings), **texts)


def is_chosen(number: int, chosen: Chosen) -> bool:
    return chosen if isinstance(chosen, bool) else number in chosen


def whole_scans(path: str, replicas: Chosen) -> Iterator[Scans]:
    """The scans of these replicas of a file with contacts and positions, one replica after another. Raises InputError, RunError."""
    with File(path) as file:
        for number in range(file.count("/observables")):
            if is_chosen(number, replicas):
                replica = f"replica_{number:05}"
                yield _with_scans(file, replica, _read_header(file, replica), contacts=True, positions=True).scans


def _expect_result(file: File) -> None:
    if not file.has_attribute("/parameters", "format"):
        raise InputError(f"{file.path}: is HDF5 but not a result of this program: give a run.h5 or the folder of a run")
    layout = file.integer_attribute("/parameters", "format")
    if not 1 <= layout <= FORMAT:
        raise InputError(f"{file.path}: has layout {layout}, this program reads up to {FORMAT}: use a newer version")


def _read_header(file: File, replica: str) -> Recording:
    """A recording without scans."""
    particles = f"/particles/{replica}"
    label = file.text_attribute(particles, "label")
    box, plate_start = _read_box(file, f"{particles}/box")
    diameter = file.numbers(f"{particles}/diameter", np.float64)
    bad = np.flatnonzero(~(np.isfinite(diameter) & (diameter > 0)))
    if len(bad):
        raise InputError(f"{file.where(f'{particles}/diameter')}: must be numbers > 0 [m], got {shortest(diameter[bad[0]])} for grain "
                         f"{bad[0]}")
    species, names = _read_species(file, particles, len(diameter))
    parameters = _read_parameters(file, f"/parameters/{replica}")
    return Recording(label, parameters, box, plate_start, diameter, no_scans(), species, names, _read_failure(file, particles))


def _read_box(file: File, name: str) -> tuple[Box, float]:
    """The box, and where the plate starts [m]."""
    edges = file.numbers_attribute(name, "edges")
    if len(edges) != 3 or not all(math.isfinite(edge) and edge > 0 for edge in edges):
        raise InputError(f"{file.where(name)}: edges must be 3 numbers > 0 [m]")
    word = file.text_attribute(name, "shape") if file.has_attribute(name, "shape") else "box"
    shape = parse(ContainerShape, word)
    if not shape:
        raise InputError(f"{file.where(name)}: shape must be one of {all_names(ContainerShape)}")
    return Box(edges[0], edges[1], shape, edges[2] if shape == ContainerShape.cell else 0.0), edges[2]


def _read_species(file: File, particles: str, grains: int) -> tuple[Ints, tuple[str, ...]]:
    """Files of runs without species have none."""
    table = f"{particles}/species"
    if not file.exists(table):
        return np.zeros(0, np.int64), ()
    species, names = file.numbers(table, np.int64), tuple(file.texts(f"{particles}/species_names"))
    if len(species) != grains or ((species < 0) | (species >= len(names))).any():
        raise InputError(f"{file.where(table)}: must be a species of 0 to {len(names) - 1} for each of the {grains} grains")
    return species, names


def _read_parameters(file: File, name: str) -> Parameters:
    words = file.texts(name)
    if len(words) % 2:
        raise InputError(f"{file.where(name)}: must be pairs")
    return dict(zip(words[::2], words[1::2], strict=True))


def _read_failure(file: File, particles: str) -> Failure | None:
    if not file.has_attribute(particles, "failure_cause"):
        return None
    return Failure(file.integer_attribute(particles, "failure_step"), file.integer_attribute(particles, "failure_grain"),
                   file.text_attribute(particles, "failure_cause"))


def no_scans() -> Scans:
    values: dict[str, Any] = {name: np.zeros((0, *ROW_SHAPES.get(name, ())), KINDS.get(name, np.float64)) for name in SCAN_FIELDS}
    return Scans(**values)


def _with_scans(file: File, replica: str, header: Recording, contacts: bool, positions: bool) -> Recording:
    scans = _read_scans(file, f"/observables/{replica}")
    grains = len(header.diameter)
    if positions:
        scans = replace(scans, position=_read_vectors(file, f"/particles/{replica}/position", len(scans), grains),
                        rotation=_read_vectors(file, f"/particles/{replica}/rotation", len(scans), grains))
    if contacts:
        scans = replace(scans, contacts=_read_contacts(file, f"/contacts/{replica}", len(scans), grains))
    return replace(header, scans=scans)


def _read_scans(file: File, name: str) -> Scans:
    rows = file.fields(name)
    values: dict[str, Any] = {}
    for field in SCAN_FIELDS:
        shape, kind = ROW_SHAPES.get(field, ()), KINDS.get(field, np.float64)
        if field in (rows.dtype.names or ()):
            values[field] = file.converted(name, rows[field], kind, shape)
        elif field in OPTIONAL:
            values[field] = np.full((len(rows), *shape), 0.0 if field == "strain" else math.nan)
        else:
            fail(file.where(name), f"must have a field '{field}'")
    wrong = values["phase"][~np.isin(values["phase"], list(Phase))]
    if len(wrong):
        raise InputError(f"{file.where(name)}: phase must be load or unload, got number {wrong[0]}")
    nothing = (NO_VECTORS,) * len(rows)
    return Scans(**values, position=nothing, rotation=nothing, contacts=(NO_CONTACTS,) * len(rows))


def _read_vectors(file: File, group: str, scans: int, grains: int) -> tuple[Floats, ...]:
    """Positions or rotations by scan. Files of earlier versions have no rotations."""
    vectors = [NO_VECTORS] * scans
    if grains == 0 or (group.endswith("/rotation") and not file.exists(group)):
        return tuple(vectors)
    name = f"{group}/value"
    value, step = file.numbers(name, np.float64, (grains, 3)), file.numbers(f"{group}/step", np.int64)
    if len(step) != len(value):
        raise InputError(f"{file.where(name)}: must have one row for each of step")
    for scan, of_scan in zip(step.tolist(), value, strict=True):
        if not 0 <= scan < scans:
            raise InputError(f"{file.where(name)}: step {scan} must be the row of a scan, 0 to {scans - 1}")
        bad = np.flatnonzero(~np.isfinite(of_scan).all(1))
        if len(bad):
            raise InputError(f"{file.where(name)}: grain {bad[0]} has a value that is no number")
        vectors[scan] = of_scan
    return tuple(vectors)


def _read_contacts(file: File, group: str, scans: int, grains: int) -> tuple[Contacts, ...]:
    """By scan."""
    name = f"{group}/contact"
    rows, offset = file.fields(name), file.numbers(f"{group}/offset", np.int64)
    for field in ("grain", "partner", "point", "force", "overlap"):
        if field not in (rows.dtype.names or ()):
            fail(file.where(name), f"must have a field '{field}'")
    if len(offset) != scans + 1 or (np.diff(offset) < 0).any() or offset[0] != 0 or offset[-1] != len(rows):
        raise InputError(f"{file.where(name)}: offset must rise from 0 to the number of contacts, one entry a scan and one more")
    grain, partner = (file.converted(name, rows[field], np.int64, ()) for field in ("grain", "partner"))
    point, force = (file.converted(name, rows[field], np.float64, (3,)) for field in ("point", "force"))
    everyone = Contacts(grain, partner, point, force, file.converted(name, rows["overlap"], np.float64, ()))
    _expect_contacts(file.where(name), everyone, grains)
    return tuple(everyone.rows(slice(first, last)) for first, last in zip(offset[:-1].tolist(), offset[1:].tolist(), strict=True))


def _expect_contacts(where: str, contacts: Contacts, grains: int) -> None:
    grain, partner = contacts.grain, contacts.partner
    unknown = (grain < 0) | (grain >= grains) | (partner >= grains) | (partner < -len(Wall))
    is_finite = np.isfinite(contacts.point).all(1) & np.isfinite(contacts.force).all(1)
    bad = np.flatnonzero(unknown | ~is_finite)
    if len(bad) and unknown[bad[0]]:
        raise InputError(f"{where}: there is a contact of grain {grain[bad[0]]} with partner {partner[bad[0]]}, but the grains are 0 to "
                         f"{grains - 1} and the walls -1 to {-len(Wall)}")
    if len(bad):
        raise InputError(f"{where}: there is a contact of grain {grain[bad[0]]} whose point or force is no number")
