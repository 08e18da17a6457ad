"""Values of the figures of a diagnosis, as figures.json has them: where, which, how_far and law. None for unknown numbers."""
from collections.abc import Sequence
from math import ceil, isfinite
from typing import Any

from ..diagnosis.diagnosis_types import Cause, ContactLaw, Diagnosis, GapReduction, WhereBin
from ..json_text import finite
from .diagnosis_text import SAME_DISPLACEMENT_MM, stands_out
from .diagnosis_words import amount_with_error, percent, words_of
from .verdict import VerdictWords, verdict_words

# Colour-blind readers can distinguish blue and orange.
NAMED, OTHER, BEFORE, AFTER, FAINT = "#D55E00", "#6F9BBF", "#2B87C8", "#D55E00", "#999999"

PHASE_GAP = 0.35  # between loading and unloading [column widths]
SIGMAS_90 = 1.6449  # half width of a 90 % interval

Values = dict[str, Any]


def diagnosis_figure_values(diagnosis: Diagnosis) -> Values:
    """Of the figures that there are."""
    values = {}
    if any(isfinite(bin.z_score) and isfinite(bin.displacement_mm) for bin in diagnosis.cells):
        values["where"] = _where(diagnosis)
    if diagnosis.ranking:
        values["which"] = _which(diagnosis)
    if diagnosis.shrink and diagnosis.shrink.before > 0:
        values["how_far"] = _how_far(diagnosis.shrink, verdict_words(diagnosis))
    if diagnosis.contact_laws:
        values["law"] = _law(diagnosis.contact_laws)
    return values


def _in_time(place: tuple[str, float]) -> tuple[int, str, float]:
    """Order of the measurement: loading, then unloading."""
    phase, displacement_mm = place
    return {"load": 0, "unload": 1}.get(phase, 2), phase, -displacement_mm if phase == "unload" else displacement_mm


def _columns_of(bins: list[WhereBin]) -> tuple[list[Values], float, dict[tuple[str, float], int]]:
    """The columns of the figure "where" in the order of the measurement, with their centres `x`; their total width, a column being 1
    wide; and the column of each phase and displacement."""
    columns: list[Values] = []
    width, place, last = 0., {}, ("", -SAME_DISPLACEMENT_MM)
    for phase, displacement in sorted({(bin.phase, bin.displacement_mm) for bin in bins}, key=_in_time):
        if not columns or phase != last[0] or abs(displacement - last[1]) >= SAME_DISPLACEMENT_MM:
            width += PHASE_GAP * (bool(columns) and phase != last[0])
            columns.append({"phase": phase + "ing" if phase else "whole cycle", "displacement_mm": displacement, "x": width + 0.5})
            width, last = width + 1, (phase, displacement)
        place[phase, displacement] = len(columns) - 1
    return columns, width, place


def _where(diagnosis: Diagnosis) -> Values:
    bins = [bin for bin in diagnosis.cells if isfinite(bin.displacement_mm)]
    observables = list(dict.fromkeys(bin.observable for bin in bins))
    columns, width, place = _columns_of(bins)

    def panel(words: str, refitted: bool) -> Values:
        scores = [(bin, bin.z_score_refitted if refitted else bin.z_score) for bin in bins]
        return {"words": words, "cells": [
            {"row": observables.index(bin.observable), "column": place[bin.phase, bin.displacement_mm], "z_score": z,
             "stands_out": stands_out(diagnosis, bin, refitted)} for bin, z in scores if isfinite(z)]}

    largest = max((abs(bin.z_score) for bin in bins if isfinite(bin.z_score)), default=0)
    return {"x_label": "plate displacement [mm]", "colour_label": "measured minus simulated [sigma of the noise]",
            # Outliers must not hide all others, and noise must not look like a gap.
            "colour_range": min(max(float(ceil(largest)), 6.), 8.), "width": width,
            "observables": [words_of(observable) for observable in observables],
            "columns": columns,
            "panels": [panel("as stated", False), panel("after recalibration", True)]}


def group_letters(ranking: tuple[Cause, ...]) -> list[str]:
    """Candidates that these data cannot tell apart share a letter: "A", "AB", empty where one stands alone. By place in the ranking."""
    groups = list(dict.fromkeys(frozenset(cause.group) for cause in ranking))
    groups = [group for group in groups if len(group) > 1 and not any(group < other for other in groups)]
    alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
    return ["".join(alphabet[k % len(alphabet)] for k, group in enumerate(groups) if cause.effect in group) for cause in ranking]


def _which(diagnosis: Diagnosis) -> Values:
    named = verdict_words(diagnosis).named
    # Detection limits make amplitudes with different units comparable.
    limits = {limit.effect: limit.minimum_amplitude for limit in reversed(diagnosis.detection_limits)}
    rows = []
    for cause, letters in zip(diagnosis.ranking, group_letters(diagnosis.ranking)):
        rows.append({"effect": cause.effect, "words": words_of(cause.effect), "is_named": cause.effect in named, "group": letters,
                     "gain": finite(cause.score), "gain_simulated": finite(cause.confirmed_score),
                     "amplitude": amount_with_error(cause.amplitude, cause.amplitude_error, cause.unit),
                     "probability": percent(cause.confidence)})
        limit = limits.get(cause.effect, 0)
        if limit > 0 and isfinite(limit):
            rows[-1] |= {"over_limit": finite(cause.amplitude / limit),
                         "half_interval": finite(SIGMAS_90 * cause.amplitude_error / limit)}
    return {"gain_label": "gain in log likelihood", "over_limit_label": "fitted amplitude / detection limit", "colour_named": NAMED,
            "colour_other": OTHER, "rows": rows}


def _forces(shrink: GapReduction, words: VerdictWords) -> Values | None:
    """At the displacements at which all forces are known."""
    rows = [(row.displacement_mm, row.experiment_N, row.before_N, row.after_N) for row in shrink.top_force]
    rows = [row for row in rows if all(map(isfinite, row))]
    if len(rows) < 2:
        return None
    x, experiment, before, after = map(list, zip(*rows))
    first, last = shrink.fitted_displacement_mm
    return {"x_label": "plate displacement [mm]", "y_label": "top force [N]", "x": x, "experiment": experiment, "before": before,
            "after": after, "words_before": "simulated before", "words_after": words.after, "colour_before": BEFORE, "colour_after": AFTER,
            **({"fitted": [first, last]} if first != last and isfinite(first + last) else {})}


def _how_far(shrink: GapReduction, words: VerdictWords) -> Values:
    bars: list[Values] = []

    def add(what: str, colour: str, reduction: float) -> None:
        bars.append({"words": what, "colour": colour, "gap_left": finite((1 - reduction) * 100)})

    add("before", BEFORE, 0)
    add("after" if shrink.confirmed is None else "after, predicted", AFTER, shrink.fraction)
    low, high = shrink.interval
    if isfinite(low) and isfinite(high):
        bars[-1]["interval"] = [(1 - high) * 100, (1 - low) * 100]
    if shrink.confirmed is not None:
        add("after, simulated", AFTER, shrink.confirmed)
    add("placebo", FAINT, shrink.placebo)
    return {"gap_label": "gap left in held-out data [%]", "forces": _forces(shrink, words), "bars": bars}


def shown_laws(laws: Sequence[ContactLaw]) -> list[ContactLaw]:
    """At the largest displacement of each phase, and at the end of unloading."""
    shown = []
    for phase in ("load", "unload"):
        of_phase = sorted((law for law in laws if law.phase == phase), key=lambda law: -law.displacement_mm)
        shown += of_phase[:1] if phase == "load" else of_phase[:1] + of_phase[1:][-1:]
    return shown


def _law(laws: Sequence[ContactLaw]) -> Values:
    return {"x_label": "overlap / R*", "y_label": "force above the simulated one [%]", "curves": [
        {"words": f"{law.phase}ing, {law.displacement_mm:.3g} mm: exponent {amount_with_error(law.exponent, law.exponent_error, '')}",
         "colour": colour, "x": list(law.overlap), "y": [100 * change for change in law.change],
         "half_band": [100 * SIGMAS_90 * error for error in law.change_error]}
        for law, colour in zip(shown_laws(laws), (NAMED, BEFORE, FAINT))]}
