"""Tables of runs and comparisons; those of programmes are in scan_tables.py."""
import math
from collections.abc import Sequence

import numpy as np

from ..observe.compare import Comparison
from ..observe.estimate import mean_over_replicas
from ..observe.levels import group_levels
from ..observe.model_table import ModelRow, ModelTable
from ..observe.replicas import Setting
from ..observe.scaling import fit_scaling, scaling_points
from ..results.names import Phase
from ..results.recording import Recording
from .csv_text import csv_field, known, varying_keys
from .estimate_text import beyond_note, number, rate_note, with_error
from .labels import words_for
from .text_table import Column, TextTable


def table_of_models(models: ModelTable) -> TextTable:
    """Top force at full stroke (or at the last scan, marked) and its ratio to the reference setting."""
    known_stroke = math.isfinite(models.displacement)
    title = f"top force at {number(models.displacement * 1e3, 2)} mm [N]" if known_stroke else "top force [N]"
    columns = [Column("model", "left"), Column(title), Column("over " + words_for(models.reference)), Column("replicas")]
    some_failed = any(row.failed for row in models.rows)
    if some_failed:
        columns.append(Column("stopped early"))
    rows = [[words_for(row.setting), with_error(row.top_force, 2) + _mark(row), with_error(row.ratio, 3), str(row.replicas),
             *([str(row.failed)] if some_failed else [])] for row in models.rows]
    notes = []
    if any(row.reached is not None for row in models.rows):
        notes.append("*: no replica reached full stroke; force and ratio are of the last scan")
    notes += [beyond_note(words_for(row.setting), number(row.beyond.displacement * 1e3, 2) + " mm", row.beyond)
              for row in models.rows if row.beyond]
    if math.isfinite(models.rate_error):
        notes.append(rate_note(False, models.rate_error))
    return TextTable(columns, rows, notes)


def _mark(row: ModelRow) -> str:
    return "" if row.reached is None else f" * at {row.reached * 1e3:.2f} mm"


def csv_of_models(models: ModelTable, settings: Sequence[Setting]) -> str:
    """table_of_models as CSV: one row per setting, with a column for each scene key that varies."""
    varying = varying_keys(settings)
    lines = [[csv_field(name) for name in ["setting", *varying.keys]]
             + ["displacement_mm", "top_force_N", "standard_error_N", "over", "ratio", "ratio_standard_error", "replicas", "stopped_early"]]
    for row, values in zip(models.rows, varying.values, strict=True):
        displacement = models.displacement if row.reached is None else row.reached
        lines.append([csv_field(text) for text in [row.setting, *values]]
                     + [known(displacement * 1e3), known(row.top_force.value), known(row.top_force.standard_error),
                        csv_field(models.reference), known(row.ratio.value), known(row.ratio.standard_error), str(row.replicas),
                        str(row.failed)])
    return "".join(",".join(cells) + "\n" for cells in lines)


def table_of_comparisons(comparisons: Sequence[Comparison]) -> TextTable:
    """Table I of the paper, one row per setting, with notes on unavailable data."""
    titles = ("Rtop", "errf [N]", "errZ", "bhat x 100", "tau [mN]", "levels")
    rows = [[words_for(one.setting), with_error(one.Rtop, 3), with_error(one.errf, 2), with_error(one.errZ, 2),
             with_error(one.bhat, 2, 1e-2), with_error(one.tau, 2, 1e-3), f"{one.levels_errf} of {one.reference_levels}"]
            for one in comparisons]
    notes = [*_notes_of(comparisons), "levels: displacements used for errf, in loading and unloading, of those of the reference"]
    return TextTable([Column("model", "left"), *map(Column, titles)], [*rows, ["perfect fit", "1", "0", "0", "0", "", ""]], notes)


def _notes_of(comparisons: Sequence[Comparison]) -> list[str]:
    """Notes for each setting; common notes once."""
    notes = []
    for number_of, one in enumerate(comparisons):
        for note in one.notes:
            if not all(note in other.notes for other in comparisons):
                notes.append(f"{words_for(one.setting)}: {note}")
            elif number_of == 0:
                notes.append(note)
    return notes


def table_of_scaling(settings: Sequence[Setting]) -> TextTable:
    """Coefficient, R^2 and curvature of the scaling law by setting and phase."""
    rows = []
    for setting in settings:
        points = scaling_points(group_levels(setting.replicas))
        for phase in Phase:
            fit = fit_scaling(points, phase)
            rows.append([words_for(setting.label), phase.name, number(fit.coefficient, 1), number(fit.r_squared, 4),
                         number(fit.curvature, 3), str(fit.points)])
    columns = [Column("model", "left"), Column("phase", "left"), *map(Column, ("F / (Z phi b f) [1/m]", "R^2", "curvature", "levels"))]
    return TextTable(columns, rows, [
        "F: top force, Z: coordination number, phi: packing fraction, b: branch length, f: mean contact force",
        "curvature: part of F that is quadratic, at the largest Z phi b f; levels: number of displacements fitted"])


ENERGIES = {"work of walls": "wall_work", "of weight": "weight_work", "elastic": "elastic_energy", "kinetic": "kinetic_energy",
            "lost by damping": "damping_loss", "by friction": "friction_loss", "by drag": "drag_loss", "error": "energy_error"}


def table_of_energies(settings: Sequence[Setting]) -> TextTable:
    """Energy budget: one row per setting, work, stored energy and losses at the scan with the largest elastic energy.

    Means over replicas [mJ]. No rows without budgets, as in measured data and runs of earlier versions.
    """
    rows = []
    for setting in settings:
        scans = [(recording.scans, row) for recording in setting.replicas if (row := _most_loaded(recording)) is not None]
        if scans:
            means = [mean_over_replicas([getattr(of, name)[row] for of, row in scans]).value for name in ENERGIES.values()]
            rows.append([words_for(setting.label), *(f"{mean / 1e-3:.3g}" for mean in means)])
    return TextTable([Column("model", "left"), *(Column(f"{title} [mJ]") for title in ENERGIES)], rows, [
        "at the scan with the largest elastic energy, since the first steps. Error: elastic and kinetic energy plus losses minus work; if "
        "positive, created by the time step or by an elastic energy that is an approximation (mc_dem, elastic_half_space); if negative, "
        "lost by viscoelasticity or plasticity"])


def _most_loaded(recording: Recording) -> int | None:
    energy = recording.scans.elastic_energy
    if not len(energy):
        return None
    row = 0 if np.isnan(energy[0]) else int(np.nanargmax(energy))
    return None if np.isnan(recording.scans.energy_error[row]) else row
