"""Whether a library of signatures fits a diagnosis."""
import math
from collections.abc import Mapping, Sequence

import numpy as np

from ..errors import InputError
from ..look import Path
from ..observe.grid import Grid, bins_of
from ..observe.observables import observables
from ..results.names import Phase
from ..results.recording import Floats
from .library import Library
from .plan import ALIKE_STROKES

# Allowed difference between library and diagnosis, relative to the library, by how a name begins.
MAY_DIFFER = {
    "packing.": math.inf,  # an experiment has its own packing
    "plate.start": math.inf,  # the experiment's zero of strain; the stroke is compared with the library's levels
    "plate.end": math.inf,
    "protocol.scans_per_stroke": math.inf,  # observations use the levels of the library
    "box.size_": 0.1,  # measured separately for every experiment
    "container.size_": 0.1,
    "mean diameter": 0.1,
}
GRAINS = 0.1  # the same for their number, "grains"
ALIKE_LOADS = 1.6  # factor: packings of the same kind with grains 2 % larger carry 1.5 times as much


def _alike(name: str, made: str, needed: str) -> bool:
    if made == needed:
        return True
    part = GRAINS if name == "grains" else next((part for begins, part in MAY_DIFFER.items() if name.startswith(begins)), 0.0)
    if math.isinf(part):
        return True
    try:
        return abs(float(made) - float(needed)) <= part * abs(float(made))
    except ValueError:
        return False


def expect_origin(library: Library, needed: Mapping[str, str], file: Path) -> None:
    """Raises InputError with all differences between the origin of the library in `file` and `needed`, with both values."""
    names = sorted({*library.origin, *needed})
    differences = [(name, library.origin.get(name, "nothing"), needed.get(name, "nothing")) for name in names]
    problems = [f"{file}: was made with {name} = {made}, needed is {now}" for name, made, now in differences if not _alike(name, made, now)]
    if problems:
        raise InputError([*problems, "these differences may change the verdict: give another file name for --library; it is created if "
                          "missing. Or use the scene and experiment that this library was made with"])


def expect_library_of(library: Library, grid: Grid, candidates: Sequence[str], nuisances: Sequence[str], file: Path) -> None:
    """Raises InputError if the library lacks a signature, or has another stroke than the experiment's `grid`."""
    problems = []
    for signatures, names in ((library.effects, candidates), (library.nuisances, nuisances)):
        there = {signature.name for signature in signatures}
        problems += [f"{file}: has no signature of {name}: give another file name; it is created if missing. Or leave {name} out of "
                     "--candidates" for name in names if name not in there]
    by_force = bool(library.grid.force)  # then the stroke depends on the effects
    if not by_force and abs(library.grid.stroke - grid.stroke) > ALIKE_STROKES * grid.stroke:
        problems.append(f"{file}: was made for a stroke of {1e3 * library.grid.stroke:.4g} mm, the experiment has {1e3 * grid.stroke:.4g} mm")
    if problems:
        raise InputError(problems)


def _load(grid: Grid, baseline: Floats) -> float:
    """Mean top force of the runs (replicates, bins), summed over the levels of loading; large forces dominate [N]."""
    is_force = np.array([observables()[bin.observable].name == "top_force" and bin.phase == Phase.load for bin in bins_of(grid)])
    forces = np.exp(baseline[:, is_force])
    known = np.isfinite(forces)
    return float(np.sum(np.where(known, forces, 0).sum(axis=0) / np.maximum(1, known.sum(axis=0))))


def expect_alike_loads(library: Library, baseline: Floats, file: Path) -> None:
    """Raises InputError if runs of the scene on the experiment's packing carry another load than those of the library: at twice the load
    weight, for example, counts half as much.

    `baseline`: (replicates, bins) of the library's grid. Where forces are prescribed there is nothing to compare.
    """
    if library.grid.force:
        return
    own = _load(library.grid, library.baseline)
    times = _load(library.grid, baseline) / own if own else math.inf
    if max(times, 1 / times if times else math.inf) > ALIKE_LOADS:
        raise InputError(f"{file}: at the same displacements the scene carries {times:.2f} times the load on this experiment's packing that "
                         "it carries on the library's packings, so the effects differ: leave out --library, or give another file, made "
                         "where the plate starts as near to the grains")
