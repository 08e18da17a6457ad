"""Results of `mcdem converge`, read from its convergence.json, as a table and a figure. Its sentences are in the file."""
import math
import pathlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ..errors import InputError
from ..files import read_input
from ..checked_json import Invalid, object_of, parsed
from .diagnosis_words import words_of
from .effect_names import OBSERVABLES
from .labels import style_number
from .text_table import Column, TextTable

RELATIVE = ("top_force", "mean_force")  # observables that are logarithms
X_LABEL = "largest error over phases and displacements / limit, ± two standard errors"


@dataclass(frozen=True)
class CellError:
    """Error of an observable at one phase and displacement: the scene minus the limit of infinitely fine numerics."""
    observable: str
    error: float
    standard_error: float
    limit: float
    beyond: bool  # significantly beyond the limit

    @property
    def over_limit(self) -> float:
        return self.error / self.limit


@dataclass(frozen=True)
class Limits:
    """Largest errors allowed: relative ones of forces, and of all else in standard deviations of one packing's replicates."""
    force: float
    deviations: float


@dataclass(frozen=True)
class CauseErrors:
    cause: str  # "plate speed"
    errors: tuple[CellError, ...]


@dataclass(frozen=True)
class Convergence:
    """The fields are named after the keys of the file. `words`: the result, and one line for each cause; `copies` describes the
    replicas."""
    replicas: int
    copies: str
    words: tuple[str, ...]
    limits: Limits
    causes: tuple[CauseErrors, ...]


def read_convergence(file: str | pathlib.Path) -> Convergence:
    """Raises InputError unless the file is a convergence.json."""
    try:
        return object_of(Convergence, parsed(read_input(file)))
    except Invalid as error:
        raise InputError(f"{file}: must be a convergence.json of mcdem: {error}") from error


def _size(cell: CellError) -> float:
    return abs(cell.over_limit)


def _worst(convergence: Convergence) -> Iterator[tuple[str, list[CellError | None]]]:
    """For each observable with errors, the largest over its limit from each cause."""
    for observable in OBSERVABLES:
        found = [[cell for cell in cause.errors if cell.observable == observable] for cause in convergence.causes]
        worst = [max(cells, key=_size) if cells else None for cells in found]
        if any(worst):
            yield observable, worst


def table_of_convergence(convergence: Convergence) -> TextTable:
    """Row: observable; column: cause. The largest error over phases and displacements with its standard error, in per cent for forces,
    otherwise in standard deviations of one packing's replicates; a star marks values beyond their limit."""
    def words(cell: CellError | None) -> str:
        if cell is None:
            return "-"
        is_relative = cell.observable in RELATIVE
        unit = 0.01 if is_relative else cell.limit / convergence.limits.deviations
        return (f"{cell.error / unit:+.2f} +- {cell.standard_error / unit:.2f} {'%' if is_relative else 'sd'}"
                f"{' *' if cell.beyond else '  '}")

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
    def values(cell: CellError | None) -> dict[str, float | None] | None:
        if cell is None:
            return None
        error = cell.standard_error / cell.limit
        return {"over_limit": cell.over_limit, "standard_error": error if math.isfinite(error) else None}

    causes = [{"words": cause.cause, "colour": style_number(k).colour, "marker": style_number(k).marker}
              for k, cause in enumerate(convergence.causes)]
    return {"x_label": X_LABEL, "causes": causes,
            "rows": [{"observable": observable, "words": words_of(observable), "errors": list(map(values, worst))}
                     for observable, worst in _worst(convergence)]}
