"""Where simulation and experiment differ, in words, and which values stand out."""
from math import inf, isfinite

from ..diagnosis.diagnosis_types import Diagnosis, WhereCell, WhereEntry
from .diagnosis_words import where_words, words_of

MOST_PLACES = 2
SAME_DISPLACEMENT_MM = 0.01  # displacements with a smaller difference are the same


def strongest_first(entries: tuple[WhereEntry, ...]) -> list[WhereEntry]:
    return sorted(entries, key=lambda entry: -abs(entry.z_score) if isfinite(entry.z_score) else inf)


def _is_within(cell: WhereCell, entry: WhereEntry) -> bool:
    first, last = entry.displacement_mm
    return (cell.observable == entry.observable and entry.phase in ("", cell.phase)
            and first - SAME_DISPLACEMENT_MM <= cell.displacement_mm <= last + SAME_DISPLACEMENT_MM)


def stands_out(diagnosis: Diagnosis, cell: WhereCell, refitted: bool) -> bool:
    """Whether "where" frames the cell. Where the threshold is not known, the cells of the entries stand out before recalibration, and
    none after."""
    if diagnosis.where_threshold > 0:
        return abs(cell.z_score_refitted if refitted else cell.z_score) >= diagnosis.where_threshold
    return not refitted and any(_is_within(cell, entry) for entry in diagnosis.where)


def _framed_line(diagnosis: Diagnosis) -> str:
    """Without entries: single cells beyond the threshold, so that the text agrees with the figure."""
    refitted = [cell.z_score_refitted for cell in diagnosis.cells if isfinite(cell.z_score_refitted) and stands_out(diagnosis, cell, True)]
    framed = [(z, cell) for cell in diagnosis.cells for z in [cell.z_score_refitted if refitted else cell.z_score]
              if isfinite(z) and stands_out(diagnosis, cell, bool(refitted))]
    if not framed:
        return "no single value stands out from the noise."
    z, strongest = max(framed, key=lambda one: abs(one[0]))
    end = "" if refitted and diagnosis.gap.detected else "; with this many values, chance alone can give that"
    return (f"{len(framed)} of {len(diagnosis.cells)} values {'is' if len(framed) == 1 else 'are'} beyond "
            f"{diagnosis.where_threshold:.1f} sigma {'after recalibration' if refitted else 'with the parameters as stated'} "
            f"(largest: {words_of(strongest.observable)}, {z:.1f} sigma){end if refitted else ', and none after recalibration'}.")


def where_line(diagnosis: Diagnosis) -> str:
    """The strongest entry of each observable, a few of them."""
    if not diagnosis.where:
        return _framed_line(diagnosis)
    strongest: dict[str, WhereEntry] = {}
    for entry in strongest_first(diagnosis.where):
        strongest.setdefault(entry.observable, entry)
    left_out = len(strongest) - MOST_PLACES
    more = f"; and {left_out} more observable{'' if left_out == 1 else 's'}" if left_out > 0 else ""
    return "; ".join(where_words(entry) for entry in list(strongest.values())[:MOST_PLACES]) + more + "."
