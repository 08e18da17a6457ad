"""Results of `mcdem converge` as a table and a figure."""
import math
from collections.abc import Iterator
from typing import Any

from ..convergence.convergence_types import BinError, Convergence, unit_of
from ..observe.observables import observables
from .diagnosis_words import words_of
from .labels import style_number
from .text_table import Column, TextTable

X_LABEL = "largest error over phases and displacements / limit, ± two standard errors"


def _size(bin: BinError) -> float:
    return abs(bin.over_limit)


def _worst(convergence: Convergence) -> Iterator[tuple[str, list[BinError | None]]]:
    """For each observable with errors, the largest over its limit from each cause."""
    for observable in (one.name for one in observables()):
        found = [[bin for bin in cause.errors if bin.observable == observable] for cause in convergence.causes]
        worst = [max(bins, key=_size) if bins else None for bins in found]
        if any(worst):
            yield observable, worst


def table_of_convergence(convergence: Convergence) -> TextTable:
    """Row: observable; column: cause. The largest error over phases and displacements with its standard error, in per cent for forces,
    otherwise in standard deviations of one packing's replicates; a star marks values beyond their limit."""
    def words(bin: BinError | None) -> str:
        if bin is None:
            return "-"
        unit, sign = unit_of(bin, convergence.limits)
        return f"{bin.error / unit:+.2f} +- {bin.standard_error / unit:.2f} {sign}{' *' if bin.beyond else '  '}"

    columns = [Column("observable", "left"), *(Column(cause.cause) for cause in convergence.causes)]
    rows = [[observable, *map(words, worst)] for observable, worst in _worst(convergence)]
    notes = [f"largest error over phases and displacements, {convergence.replicas} {convergence.copies}",
             "errors of the mean over these; single runs differ more, since packings at other speeds take other courses",
             "sd: standard deviation of these, or twice what the observable resolves",
             f"*: beyond {100 * convergence.limits.force:.2g} % (forces) or {convergence.limits.deviations:.2g} sd (all else), and by four "
             "standard errors"]
    return TextTable(columns, rows, notes)


def convergence_figure_values(convergence: Convergence) -> dict[str, Any]:
    """Values of the figure `convergence` (figure_values.py): errors of every observable from each cause, over their limits."""
    def values(bin: BinError | None) -> dict[str, float | None] | None:
        if bin is None:
            return None
        error = bin.standard_error / bin.limit
        return {"over_limit": bin.over_limit, "standard_error": error if math.isfinite(error) else None}

    causes = [{"words": cause.cause, "colour": style_number(k).colour, "marker": style_number(k).marker}
              for k, cause in enumerate(convergence.causes)]
    return {"x_label": X_LABEL, "causes": causes,
            "rows": [{"observable": observable, "words": words_of(observable), "errors": list(map(values, worst))}
                     for observable, worst in _worst(convergence)]}
