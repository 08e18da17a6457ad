"""Simulation results of a scene that do not depend on an experiment: the scatter of the observation, and the signature of every effect and
nuisance."""
import hashlib
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from ..errors import InputError
from ..files import create_whole, read_input
from ..look import Path, is_file, is_there
from ..results.names import Phase, parse
from ..results.recording import Floats
from .json_numbers import JsonError, array_of, expect_json, matrix_of, number_list, number_of, texts_of, whole_of
from ..observe.grid import Grid, HoldScans, cells_of
from .signature import Signature

FORMAT = 4
OTHER_OBSERVABLES = "it has other observables than this program"


@dataclass(eq=False)
class Library:
    grid: Grid
    baseline: Floats  # (replicates, cells)
    packing: list[int]  # of each replicate
    effects: list[Signature] = field(default_factory=list)
    nuisances: list[Signature] = field(default_factory=list)
    provenance: dict[str, str] = field(default_factory=dict)  # scene, program, device
    origin: dict[str, str] = field(default_factory=dict)  # everything that it depends on, by name (library_origin.py)


def mean_groups(library: Library) -> list[int]:
    """Groups of replicates with a common mean: those of a packing, or all of them if every packing has only one."""
    repeated = all(rows > 1 for rows in Counter(library.packing).values())
    return list(library.packing) if repeated else [0] * len(library.packing)


def apart_from_mean(rows: Floats, group: Sequence[int]) -> Floats:
    """(n, cells) rows minus the mean of their group, scaled to the variance of one row."""
    groups, apart = np.asarray(group), np.array(rows, float)
    for one in set(group):
        members = groups == one
        n = np.count_nonzero(members)
        apart[members] = (rows[members] - rows[members].mean(axis=0)) * np.sqrt(n / max(1, n - 1))
    return apart


def scatter(library: Library) -> Floats:
    """Baseline replicates minus the mean over those of the same packing, scaled to the variance of one replicate.

    With one replicate per packing the mean over packings is subtracted.
    """
    return apart_from_mean(library.baseline, mean_groups(library))


def _digest_of(origin: dict[str, str]) -> str:
    return hashlib.sha256("".join(f"{name}={origin[name]}\n" for name in sorted(origin)).encode()).hexdigest()


def _text_of(document: dict[str, Any]) -> str:
    return json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def _signature_json(s: Signature) -> dict[str, Any]:
    lists = {name: number_list(getattr(s, name)) for name in ("linear", "curvature", "slopes")}
    return {"name": s.name, "reach": float(s.reach), **lists}


def _grid_json(grid: Grid) -> dict[str, Any]:
    lists = {name: number_list(np.array(getattr(grid, name), float)) for name in ("displacement", "force")}
    numbers = {name: float(getattr(grid, name)) for name in ("width", "stroke", "force_width")}
    holds = [{**asdict(hold), "phase": hold.phase.name, "displacement": float(hold.displacement)} for hold in grid.holds]
    return {**lists, **numbers, "holds": holds}


def library_text(library: Library) -> str:
    """JSON text; bit-identical for the same library."""
    document = {
        **_grid_json(library.grid),
        "baseline": number_list(library.baseline),
        "packing": [int(packing) for packing in library.packing],
        "effects": [_signature_json(s) for s in library.effects],
        "nuisances": [_signature_json(s) for s in library.nuisances],
        "provenance": library.provenance,
        "origin": library.origin,
        "format": FORMAT,
        "origin_sha256": _digest_of(library.origin),
    }
    digest = hashlib.sha256(_text_of(document).encode()).hexdigest()
    return _text_of({**document, "sha256": digest})


def write_library(file: Path, library: Library) -> bool:
    """Writes the complete file or nothing. Returns False if the file exists; it is not replaced. Raises RunError."""
    return create_whole(file, library_text(library).encode())


def _signature_of(j: Any) -> Signature:
    expect_json(isinstance(j["name"], str), "it has a signature without a name")
    return Signature(j["name"], number_of(j["reach"]), array_of(j["linear"]), array_of(j["curvature"]), matrix_of(j["slopes"]))


def _hold_of(j: Any) -> HoldScans:
    phase = parse(Phase, j["phase"])
    for known, word in ((phase is not None, j["phase"]), (j["keep"] in ("position", "force", "stress"), j["keep"])):
        expect_json(known, f"there is no {json.dumps(word, ensure_ascii=False)}")
    assert phase is not None
    begin, first, end = (whole_of(j[name]) for name in ("begin", "first", "end"))
    expect_json(0 <= begin <= first <= end, "it has a hold that cannot be")
    return HoldScans(begin, first, end, j["keep"], phase, number_of(j["displacement"]))


def _numbers_of(values: Any) -> list[float]:
    numbers: list[float] = array_of(values).tolist()
    return numbers


def _grid_of(j: Any) -> Grid:
    displacement, force = _numbers_of(j["displacement"]), _numbers_of(j["force"])
    expect_json(len(force) in (0, len(displacement)), "it has another number of forces than displacements")
    width, stroke, force_width = (number_of(j[name]) for name in ("width", "stroke", "force_width"))
    return Grid(displacement, width, stroke, force, force_width, [_hold_of(hold) for hold in j["holds"]])


def _expect_cells(signatures: list[Signature], cells: int) -> None:
    for s in signatures:
        expect_json(len(s.linear) == len(s.curvature) == cells, f"signature {s.name} is of another length than the cells")
        expect_json(s.pairs() == 0 or s.slopes.shape[1] == cells, OTHER_OBSERVABLES)


def _library_of(text: str) -> Library:
    j = json.loads(text)
    expect_json(j["format"] == FORMAT, "it is of another version")
    grid = _grid_of(j)
    effects, nuisances = ([_signature_of(one) for one in j[name]] for name in ("effects", "nuisances"))
    library = Library(grid, matrix_of(j["baseline"]), [whole_of(one) for one in j["packing"]], effects, nuisances,
                      texts_of(j["provenance"]), texts_of(j["origin"]))
    cells = len(cells_of(grid))
    expect_json(len(library.packing) > 0, "it has no replicates")
    expect_json(library.baseline.shape[1] == cells, OTHER_OBSERVABLES)
    expect_json(len(library.baseline) == len(library.packing), "it has another number of replicates than packings")
    _expect_cells(effects + nuisances, cells)
    expect_json(j["origin_sha256"] == _digest_of(library.origin), "what it says of its origin was changed")
    if "sha256" in j:  # of the text without it
        content = text.replace(f'"sha256":"{j["sha256"]}",', "", 1)
        expect_json(hashlib.sha256(content.encode()).hexdigest() == j["sha256"], "it was changed since it was written")
    return library


def read_library(file: Path) -> Library:
    """Raises InputError if the file is not a library."""
    if not is_there(file):
        raise InputError(f"{file}: there is no signature library")
    if not is_file(file):
        raise InputError(f"{file}: must be a file, the signature library")
    content = read_input(file)
    try:
        return _library_of(content.decode())
    except (JsonError, json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        problem = str(error)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as error:
        problem = f"it lacks something, or has something else there: {error}"
    raise InputError(f"{file}: not a signature library ({problem}): give another file name; it is created if missing")
