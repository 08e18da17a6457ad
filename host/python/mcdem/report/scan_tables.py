"""Tables of programmes, scan by scan: forces and displacements of a plate, stresses and strains of a cell."""
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from ..observe.estimate import Estimate
from ..observe.law_range import beyond_law
from ..observe.model_table import largest_rate_error
from ..observe.programmes import MeanScan, are_cells, mean_scans
from ..observe.replicas import Setting
from .csv_text import csv_of, varying_keys
from .estimate_text import beyond_note, rate_note, with_error
from .labels import one_line, stress_unit, words_for
from .text_table import TextTable, table_of

STRAINS = ("strain_x", "strain_y", "strain_z", "shear_xy", "shear_xz", "shear_yz")
Scans = list[tuple[Setting, list[MeanScan]]]  # of each setting


@dataclass(frozen=True)
class _Quantity:
    """A column of means. `unit` and `decimals`: for tables; CSV uses SI units."""

    title: str
    csv_name: str
    of: Callable[[MeanScan], Estimate]
    unit: float = 1.0
    decimals: int = 3


PLATE_QUANTITIES = [_Quantity("displacement [mm]", "displacement_m", lambda scan: scan.displacement, 1e-3, 3),
                    _Quantity("top force [N]", "top_force_N", lambda scan: scan.top_force, 1.0, 4)]
COORDINATION = _Quantity("Z", "coordination_number", lambda scan: scan.coordination, 1.0, 2)
STRESSES = [_Quantity("p", "p_Pa", lambda scan: scan.p), _Quantity("q", "q_Pa", lambda scan: scan.q)]


def tables_of_scans(settings: Sequence[Setting]) -> list[TextTable]:
    """One table for plates and one for cells, if there are any, with notes."""
    return [_table_of(scans, cells) for cells in (False, True) if (scans := _scans_of(settings, cells))]


def csv_of_scans(settings: Sequence[Setting]) -> str:
    """The same as CSV, with standard errors and a column for each scene key that varies.

    Raises InputError if some are cells and some are not.
    """
    plates, cells = _scans_of(settings, False), _scans_of(settings, True)
    if plates and cells:
        raise InputError("--csv: cells and plates have different columns; give the runs one by one")
    quantities = _quantities(plates or cells, bool(cells), all_strains=True)
    keys, values = varying_keys(settings)
    return csv_of(
        ["setting", *keys, "frame", "cycle", "phase", "time_s",
         *(name for quantity in quantities for name in (quantity.csv_name, quantity.csv_name + "_standard_error")), "replicas"],
        ([setting.label, *of, scan.frame, scan.cycle, scan.phase.name, scan.time.value,
          *(number for quantity in quantities for number in (quantity.of(scan).value, quantity.of(scan).standard_error)), scan.time.count]
         for (setting, scans), of in zip(plates or cells, values, strict=True) for scan in scans))


def _scans_of(settings: Sequence[Setting], cells: bool) -> Scans:
    return [(setting, mean_scans(setting.replicas)) for setting in settings if are_cells(setting.replicas) == cells]


def _largest(scans: Scans, of: Callable[[MeanScan], Iterable[Estimate]]) -> float:
    return float(np.fmax.reduce([abs(one.value) for _, means in scans for scan in means for one in of(scan)], initial=0.0))


def _four_digits(largest: float) -> int:
    """Number of decimals with which the largest number has four digits."""
    return min(max(3 - math.floor(math.log10(largest)), 0), 6) if largest > 0 else 1


def _strain(axis: int, words: str) -> _Quantity:
    return _Quantity(words.replace("_", " ") + " [%]", STRAINS[axis], lambda scan: scan.strain[axis], 1e-2, 2)


def _strains(scans: Scans) -> list[_Quantity]:
    """Nonzero strains, with one column for the first three if they are equal."""
    isotropic = all(scan.strain[0].value == scan.strain[1].value == scan.strain[2].value for _, means in scans for scan in means)
    columns = [_strain(axis, "strain" if isotropic and axis == 2 else STRAINS[axis]) for axis in range(2 if isotropic else 0, 6)]
    return [column for column in columns if _largest(scans, lambda scan: [column.of(scan)]) > 0]


def _quantities(scans: Scans, cells: bool, all_strains: bool = False) -> list[_Quantity]:
    if not cells:
        return [*PLATE_QUANTITIES, COORDINATION]
    most = _largest(scans, lambda scan: (scan.p, scan.q))
    unit = stress_unit(most)
    strains = [_strain(axis, name) for axis, name in enumerate(STRAINS)] if all_strains else _strains(scans)
    stresses = (replace(stress, title=f"{stress.title} [{unit.name}]", unit=unit.size, decimals=_four_digits(most / unit.size))
                for stress in STRESSES)
    return [*strains, _Quantity("φ", "packing_fraction", lambda scan: scan.packing_fraction, 1.0, 4), *stresses, COORDINATION]


def _table_of(scans: Scans, cells: bool) -> TextTable:
    quantities = _quantities(scans, cells)
    lacking = any(scan.time.count < len(setting.replicas) for setting, means in scans for scan in means)
    rows = [[words_for(setting.label), str(scan.frame), scan.phase.name, with_error(Estimate(scan.time.value), 3),
             *(with_error(quantity.of(scan), quantity.decimals, quantity.unit) for quantity in quantities),
             *([str(scan.time.count)] if lacking else [])] for setting, means in scans for scan in means]
    notes = [note for setting, means in scans for note in _notes(setting, means)]
    if cells:
        notes.append("p: mean stress, q: deviatoric stress, sqrt(3/2 s:s); strains over the lengths at start, compression positive")
    rate_error = float(np.fmax.reduce([largest_rate_error(setting.replicas) for setting, _ in scans]))
    if math.isfinite(rate_error):
        notes.append(rate_note(cells, rate_error))
    return table_of(["<model", "scan", "<phase", "time [s]", *(quantity.title for quantity in quantities),
                     *(["replicas"] if lacking else [])], rows, notes)


def _notes(setting: Setting, means: Sequence[MeanScan]) -> list[str]:
    notes, words, replicas = [], words_for(setting.label), setting.replicas
    if beyond := beyond_law(replicas):  # from the first scan in which a replica's overlaps exceed the tested range
        first_scan = next(scan.frame for scan in means if scan.max_overlap > beyond.tested)
        notes.append(beyond_note(words, f"scan {first_scan}", beyond))
    failed = [(len(recording.scans), recording.failure.cause) for recording in replicas if recording.failure]
    if failed:
        scans, cause = min(failed, key=lambda one: one[0])
        notes.append(f"{words}: {len(failed)} of {len(replicas)} stopped early, the first after {scans} scans: {one_line(cause)}")
    return notes
