"""Tables of programmes, scan by scan: forces and displacements of a plate, stresses and strains of a cell."""
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from ..number_text import shortest
from ..observe.estimate import Estimate
from ..observe.law_range import beyond_law
from ..observe.model_table import largest_rate_error
from ..observe.programmes import MeanScan, are_cells, mean_scans
from ..observe.replicas import Setting
from .csv_text import csv_field, known, varying_keys
from .estimate_text import beyond_note, rate_note, with_error
from .labels import one_line, stress_unit, words_for
from .text_table import Column, TextTable

STRAINS = ("strain_x", "strain_y", "strain_z", "shear_xy", "shear_xz", "shear_yz")


@dataclass(frozen=True)
class _Told:
    """Scans of one setting."""

    setting: Setting
    scans: list[MeanScan]


@dataclass(frozen=True)
class _Quantity:
    """A column of means. `unit` and `decimals`: for tables; CSV uses SI units."""

    title: str
    csv_name: str
    of: Callable[[MeanScan], Estimate]
    unit: float = 1.0
    decimals: int = 3


def tables_of_scans(settings: Sequence[Setting]) -> list[TextTable]:
    """One table for plates and one for cells, if there are any, with notes."""
    return [_table_of(told, cells) for cells in (False, True) if (told := _told_of(settings, cells))]


def csv_of_scans(settings: Sequence[Setting]) -> str:
    """The same as CSV, with standard errors and a column for each scene key that varies.

    Raises InputError if some are cells and some are not.
    """
    plates, cells = _told_of(settings, False), _told_of(settings, True)
    if plates and cells:
        raise InputError("--csv: cells and plates have different columns; give the runs one by one")
    told = cells or plates
    quantities = _cell_quantities(told, all_strains=True) if cells else PLATE_QUANTITIES
    varying = varying_keys(settings)
    lines = [[csv_field(name) for name in ["setting", *varying.keys]] + ["frame", "cycle", "phase", "time_s"]
             + [name for quantity in quantities for name in (quantity.csv_name, quantity.csv_name + "_standard_error")] + ["replicas"]]
    for one, values in zip(told, varying.values, strict=True):
        for scan in one.scans:
            means = [quantity.of(scan) for quantity in quantities]
            lines.append([csv_field(text) for text in [one.setting.label, *values]]
                         + [str(scan.frame), str(scan.cycle), scan.phase.name, shortest(scan.time.value)]
                         + [known(number) for mean in means for number in (mean.value, mean.standard_error)] + [str(scan.time.count)])
    return "".join(",".join(cells_of_line) + "\n" for cells_of_line in lines)


def _told_of(settings: Sequence[Setting], cells: bool) -> list[_Told]:
    return [_Told(setting, mean_scans(setting.replicas)) for setting in settings if are_cells(setting.replicas) == cells]


def _largest(told: Sequence[_Told], quantity: _Quantity) -> float:
    return float(np.fmax.reduce([abs(quantity.of(scan).value) for one in told for scan in one.scans], initial=0.0))


def _four_digits(largest: float) -> int:
    """Number of decimals with which the largest number has four digits."""
    return min(max(3 - math.floor(math.log10(largest)), 0), 6) if largest > 0 else 1


PLATE_QUANTITIES = [_Quantity("displacement [mm]", "displacement_m", lambda scan: scan.displacement, 1e-3, 3),
                    _Quantity("top force [N]", "top_force_N", lambda scan: scan.top_force, 1.0, 4),
                    _Quantity("Z", "coordination_number", lambda scan: scan.coordination, 1.0, 2)]


def _strain(axis: int, words: str) -> _Quantity:
    return _Quantity(words.replace("_", " ") + " [%]", STRAINS[axis], lambda scan: scan.strain[axis], 1e-2, 2)


def _strains(told: Sequence[_Told], all_strains: bool) -> list[_Quantity]:
    """Nonzero strains, with one column for the first three if they are equal; or all six."""
    if all_strains:
        return [_strain(axis, name) for axis, name in enumerate(STRAINS)]
    isotropic = all(scan.strain[0].value == scan.strain[1].value == scan.strain[2].value for one in told for scan in one.scans)
    columns = [_strain(axis, "strain" if isotropic and axis == 2 else STRAINS[axis]) for axis in range(2 if isotropic else 0, 6)]
    return [column for column in columns if _largest(told, column) > 0]


def _cell_quantities(told: Sequence[_Told], all_strains: bool = False) -> list[_Quantity]:
    stresses = [_Quantity("p", "p_Pa", lambda scan: scan.p), _Quantity("q", "q_Pa", lambda scan: scan.q)]
    most = max(_largest(told, stress) for stress in stresses)
    unit = stress_unit(most)
    stresses = [replace(stress, title=f"{stress.title} [{unit.name}]", unit=unit.size, decimals=_four_digits(most / unit.size))
                for stress in stresses]
    return [*_strains(told, all_strains), _Quantity("φ", "packing_fraction", lambda scan: scan.packing_fraction, 1.0, 4), *stresses,
            _Quantity("Z", "coordination_number", lambda scan: scan.coordination, 1.0, 2)]


def _table_of(told: Sequence[_Told], cells: bool) -> TextTable:
    quantities = _cell_quantities(told) if cells else PLATE_QUANTITIES
    lacking = any(scan.time.count < len(one.setting.replicas) for one in told for scan in one.scans)
    columns = [Column("model", "left"), Column("scan"), Column("phase", "left"), Column("time [s]"),
               *(Column(quantity.title) for quantity in quantities), *([Column("replicas")] if lacking else [])]
    rows = [[words_for(one.setting.label), str(scan.frame), scan.phase.name, with_error(Estimate(scan.time.value), 3),
             *(with_error(quantity.of(scan), quantity.decimals, quantity.unit) for quantity in quantities),
             *([str(scan.time.count)] if lacking else [])] for one in told for scan in one.scans]
    notes = [note for one in told for note in _notes(one)]
    if cells:
        notes.append("p: mean stress, q: deviatoric stress, sqrt(3/2 s:s); strains over the lengths at start, compression positive")
    rate_error = float(np.fmax.reduce([largest_rate_error(one.setting.replicas) for one in told]))
    if math.isfinite(rate_error):
        notes.append(rate_note(cells, rate_error))
    return TextTable(columns, rows, notes)


def _notes(one: _Told) -> list[str]:
    notes, words, replicas = [], words_for(one.setting.label), one.setting.replicas
    if beyond := beyond_law(replicas):  # from the first scan in which a replica's overlaps exceed the tested range
        first_scan = next(scan.frame for scan in one.scans if scan.max_overlap > beyond.tested)
        notes.append(beyond_note(words, f"scan {first_scan}", beyond))
    failed = [recording for recording in replicas if recording.failure]
    if failed:
        first = min(failed, key=lambda recording: len(recording.scans))
        cause = one_line(first.failure.cause) if first.failure else ""
        notes.append(f"{words}: {len(failed)} of {len(replicas)} stopped early, the first after {len(first.scans)} scans: {cause}")
    return notes
