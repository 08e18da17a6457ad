"""Simulation results of a scene that do not depend on an experiment: the scatter of the observation, and the signature of every effect and
nuisance."""
import hashlib
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..checked_json import expect, json_of, object_of
from ..errors import InputError
from ..files import create_whole, read_input
from ..json_text import compact_json
from ..look import Path, is_file, is_there
from ..observe.grid import Grid, bins_of
from ..results.recording import Floats
from .signature import Signature

FORMAT = 4
DRAWN = "drawn "  # begins the names of what only packings that are drawn depend on
OTHER_OBSERVABLES = "it has other observables than this program"


@dataclass(eq=False)
class Library:
    grid: Grid
    baseline: Floats  # (replicates, bins)
    packing: list[int]  # of each replicate
    effects: list[Signature] = field(default_factory=list)
    nuisances: list[Signature] = field(default_factory=list)
    provenance: dict[str, str] = field(default_factory=dict)  # scene, program, device
    origin: dict[str, str] = field(default_factory=dict)  # everything that it depends on, by name (library_origin.py)

    @property
    def is_drawn(self) -> bool:
        """Whether every replicate is another packing, drawn for an experiment whose grains were not measured."""
        return any(name.startswith(DRAWN) for name in self.origin)


def mean_groups(library: Library) -> list[int]:
    """Groups of replicates with a common mean: those of a packing, or all of them if every packing has only one."""
    repeated = all(rows > 1 for rows in Counter(library.packing).values())
    return list(library.packing) if repeated else [0] * len(library.packing)


def apart_from_mean(rows: Floats, group: Sequence[int]) -> Floats:
    """(n, bins) rows minus the mean of their group, scaled to the variance of one row."""
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


def library_text(library: Library) -> str:
    """JSON text; bit-identical for the same library."""
    document = json_of(Library, library)
    document |= {**document.pop("grid"), "format": FORMAT, "origin_sha256": _digest_of(library.origin)}
    digest = hashlib.sha256(compact_json(document).encode()).hexdigest()
    return compact_json({**document, "sha256": digest})


def write_library(file: Path, library: Library) -> bool:
    """Writes the complete file or nothing. Returns False if the file exists; it is not replaced. Raises RunError."""
    return create_whole(file, library_text(library).encode())


def _expect_possible(library: Library) -> None:
    """Raises Invalid."""
    grid, signatures = library.grid, library.effects + library.nuisances
    bins = len(bins_of(grid))
    expect(len(grid.force) in (0, len(grid.displacement)), "it has another number of forces than displacements")
    for hold in grid.holds:
        expect(hold.keep in ("position", "force", "stress"), f"there is no {json.dumps(hold.keep, ensure_ascii=False)}")
        expect(0 <= hold.begin <= hold.first <= hold.end, "it has a hold that cannot be")
    numbers = [grid.width, grid.stroke, grid.force_width, *(hold.displacement for hold in grid.holds), *(s.reach for s in signatures)]
    expect(bool(np.isfinite(numbers).all()), "it has something else than a finite number")
    expect(len(library.packing) > 0, "it has no replicates")
    expect(library.baseline.shape[1:] == (bins,), OTHER_OBSERVABLES)
    expect(len(library.baseline) == len(library.packing), "it has another number of replicates than packings")
    for s in signatures:
        expect(s.linear.shape == s.curvature.shape == (bins,), f"signature {s.name} is of another length than the bins")
        expect(s.pairs() == 0 or s.slopes.shape[1:] == (bins,), OTHER_OBSERVABLES)


def _library_of(text: str) -> Library:
    j = json.loads(text)
    expect(j["format"] == FORMAT, "it is of another version")
    library = object_of(Library, {**j, "grid": j}, defaults=False)
    _expect_possible(library)
    expect(j["origin_sha256"] == _digest_of(library.origin), "what it says of its origin was changed")
    if "sha256" in j:  # of the text without it
        content = text.replace(f'"sha256":"{j["sha256"]}",', "", 1)
        expect(hashlib.sha256(content.encode()).hexdigest() == j["sha256"], "it was changed since it was written")
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
    except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise InputError(f"{file}: not a signature library ({error}): give another file name; it is created if missing") from error
