"""The signatures of a scene from its simulations, and the library that a diagnosis uses."""
from collections.abc import Callable

from .. import _engine as engine
from ..look import Path, is_there
from ..outputs import remove_temporaries_of
from .library import Library, read_library
from .library_origin import expect_library_of, expect_origin
from .signature import learn_signature
from .simulations import Simulations

Progress = Callable[[float], object]


def build_library(simulations: Simulations, progress: Progress | None = None) -> Library:
    """Simulates the unchanged scene, and from the same packings every effect and nuisance at two amplitudes. Raises InputError."""
    facts = simulations.facts()
    rows = simulations.library(progress)
    paired, count = facts["paired_rows"], facts["packings"] * facts["replicates"]
    baseline = rows[:count]
    differences = rows[count:].reshape(-1, 2, len(paired), rows.shape[1]) - baseline[paired]
    signatures = [learn_signature(*probe, *pair) for probe, pair in zip(facts["probes"], differences, strict=True)]
    effects = len(facts["candidates"])  # they are first; a nuisance may have the name of an effect
    return Library(grid=simulations.grid, baseline=baseline, packing=[row // facts["replicates"] for row in range(count)],
                   effects=signatures[:effects], nuisances=signatures[effects:],
                   provenance={"program": engine.__version__, "device": simulations.device}, origin=simulations.origin)


def fitting_library(simulations: Simulations, file: Path | None) -> Library | None:
    """The library in `file` if there is one. Raises InputError if it does not fit the simulations."""
    if file is None:
        return None
    remove_temporaries_of(file)  # left by an interrupted diagnosis
    if not is_there(file):
        return None
    library, facts = read_library(file), simulations.facts()
    expect_origin(library, simulations.origin, file)
    candidates, nuisances = ([name for name, *_ in facts[kind]] for kind in ("candidates", "nuisances"))
    expect_library_of(library, simulations.grid, candidates, nuisances, file)
    return library
