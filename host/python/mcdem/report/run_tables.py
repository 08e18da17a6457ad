"""Tables of runs and comparisons; those of programmes are in scan_tables.py."""
import math
from collections.abc import Sequence

import numpy as np

from ..number_text import mm
from ..observe.compare import Comparison
from ..observe.estimate import mean_over_replicas
from ..observe.levels import group_levels
from ..observe.model_table import ModelTable
from ..observe.replicas import Setting
from ..observe.scaling import fit_scaling, scaling_points
from ..results.names import Phase
from ..results.recording import Recording
from .csv_text import csv_of, varying_keys
from .estimate_text import beyond_note, rate_note, with_error
from .labels import number, words_for
from .text_table import TextTable, table_of

ENERGIES = {"work of walls": "wall_work", "of weight": "weight_work", "elastic": "elastic_energy", "kinetic": "kinetic_energy",
            "lost by damping": "damping_loss", "by friction": "friction_loss", "by drag": "drag_loss", "error": "energy_error"}


def table_of_models(models: ModelTable) -> TextTable:
    """Top force at full stroke (or at the last scan, marked) and its ratio to the reference setting."""
    force = f"top force at {mm(models.displacement)} mm [N]" if math.isfinite(models.displacement) else "top force [N]"
    some_failed = any(row.failed for row in models.rows)
    rows, notes, marked = [], [], False
    for row in models.rows:
        words, mark = words_for(row.setting), "" if row.reached is None else f" * at {mm(row.reached)} mm"
        rows.append([words, with_error(row.top_force, 2) + mark, with_error(row.ratio, 3), str(row.replicas),
                     *([str(row.failed)] if some_failed else [])])
        marked = marked or bool(mark)
        if row.beyond:
            notes.append(beyond_note(words, f"{mm(row.beyond.displacement)} mm", row.beyond))
    if marked:
        notes.insert(0, "*: no replica reached full stroke; force and ratio are of the last scan")
    if math.isfinite(models.rate_error):
        notes.append(rate_note(False, models.rate_error))
    return table_of(["<model", force, "over " + words_for(models.reference), "replicas", *(["stopped early"] if some_failed else [])],
                    rows, notes)


def csv_of_models(models: ModelTable, settings: Sequence[Setting]) -> str:
    """table_of_models as CSV: one row per setting, with a column for each scene key that varies."""
    keys, values = varying_keys(settings)
    return csv_of(
        ["setting", *keys, "displacement_mm", "top_force_N", "standard_error_N", "over", "ratio", "ratio_standard_error", "replicas",
         "stopped_early"],
        ([row.setting, *of, (models.displacement if row.reached is None else row.reached) * 1e3, row.top_force.value,
          row.top_force.standard_error, models.reference, row.ratio.value, row.ratio.standard_error, row.replicas, row.failed]
         for row, of in zip(models.rows, values, strict=True)))


def table_of_comparisons(comparisons: Sequence[Comparison]) -> TextTable:
    """Table I of the paper, one row per setting, with notes on unavailable data: for each setting, common ones once."""
    notes = list[str]()
    for one in comparisons:
        notes += [note if _is_common(note, comparisons) else f"{words_for(one.setting)}: {note}" for note in one.notes
                  if one is comparisons[0] or not _is_common(note, comparisons)]
    return table_of(
        ["<model", "Rtop", "errf [N]", "errZ", "bhat x 100", "tau [mN]", "levels"],
        [*([words_for(one.setting), with_error(one.Rtop, 3), with_error(one.errf, 2), with_error(one.errZ, 2),
            with_error(one.bhat, 2, 1e-2), with_error(one.tau, 2, 1e-3), f"{one.levels_errf} of {one.reference_levels}"]
           for one in comparisons), ["perfect fit", "1", "0", "0", "0", "", ""]],
        [*notes, "levels: displacements used for errf, in loading and unloading, of those of the reference"])


def _is_common(note: str, comparisons: Sequence[Comparison]) -> bool:
    return all(note in other.notes for other in comparisons)


def table_of_scaling(settings: Sequence[Setting]) -> TextTable:
    """Coefficient, R^2 and curvature of the scaling law by setting and phase."""
    rows = []
    for setting in settings:
        points = scaling_points(group_levels(setting.replicas))
        for phase in Phase:
            fit = fit_scaling(points, phase)
            rows.append([words_for(setting.label), phase.name, number(fit.coefficient, ".1f"), number(fit.r_squared, ".4f"),
                         number(fit.curvature, ".3f"), str(fit.points)])
    return table_of(["<model", "<phase", "F / (Z phi b f) [1/m]", "R^2", "curvature", "levels"], rows, [
        "F: top force, Z: coordination number, phi: packing fraction, b: branch length, f: mean contact force",
        "curvature: part of F that is quadratic, at the largest Z phi b f; levels: number of displacements fitted"])


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
    return table_of(["<model", *(f"{title} [mJ]" for title in ENERGIES)], rows, [
        "at the scan with the largest elastic energy, since the first steps. Error: elastic and kinetic energy plus losses minus work; if "
        "positive, created by the time step or by an elastic energy that is an approximation (mc_dem, elastic_half_space); if negative, "
        "lost by viscoelasticity or plasticity"])


def _most_loaded(recording: Recording) -> int | None:
    energy = recording.scans.elastic_energy
    if not len(energy):
        return None
    row = 0 if np.isnan(energy[0]) else int(np.nanargmax(energy))
    return None if np.isnan(recording.scans.energy_error[row]) else row
