"""Results of `mcdem what-if` as a table, a figure and JSON."""
import math
from typing import Any

import numpy as np

from .. import _engine
from ..calibration.fit import End
from ..calibration.what_if import Move, WhatIf
from ..json_text import finite
from ..results.recording import Floats
from .labels import NO_NUMBER, number, style_number
from .scene_fit import change_text, value_text
from .text_table import table_of, to_text

WORDS = {"top_force": "top force", "force": "force", "unloading_force": "force of unloading", "coordination": "Z",
         "force_share": "force over top force"}
UNMET = {End.out_of_range: "no: end of its range", End.stops_early: "no: simulations stop beyond", None: "no: raise --rounds"}


def quantity_words(name: str) -> str:
    """ "force over top force, 18 mm" """
    kind, _, place = name.partition("@")
    return WORDS[kind] + (f", {place} mm" if place else "")


def what_if_text(found: WhatIf) -> str:
    target = f"{quantity_words(found.shown[0].name)} = {number(found.target, '.4g')} {found.shown[0].unit}".rstrip()
    titles = ["<key moved alone", "needed", "change", "<target met",
              *(quantity_words(one.name) + (f" [{one.unit}]" if one.unit else "") for one in found.shown)]
    rows = [["none: the scene", NO_NUMBER, NO_NUMBER, NO_NUMBER, *_numbers(found.base)]]
    if np.isfinite(found.measured_numbers).any():
        rows.append(["experiment", NO_NUMBER, NO_NUMBER, NO_NUMBER, *_numbers(found.measured_numbers)])
    rows += [[move.key.name, value_text(move.key, move.value), change_text(move.key, move.value), _met(move), *_numbers(move.numbers)]
             for move in found.moves]
    notes = [f"target: {target}; of a key that does not meet it, the value that comes nearest",
             f"{found.packings} packing{'' if found.packings == 1 else 's'}, the same for all"]
    if stopped := _stop_words(found.displacement, found.force):
        notes.append(f"the scene's own simulations {stopped}")
    return to_text(table_of(titles, rows, notes))


def round_text(found: WhatIf) -> str:
    """What is found so far, in one line."""
    moves = "; ".join(f"{move.key.name} = {value_text(move.key, move.value)}: {number(float(move.numbers[0]), '.4g')}"
                      + " (met)" * move.is_met for move in found.moves)
    return f"{quantity_words(found.shown[0].name)}, {number(found.target, '.4g')} wanted: {moves}"


def _met(move: Move) -> str:
    return "yes" if move.is_met else UNMET.get(move.end, UNMET[None])


def _numbers(values: Floats) -> list[str]:
    """The target with four digits, because it is met within half a per cent."""
    return [number(value, ".3g" if k else ".4g") for k, value in enumerate(values.tolist())]


def _stop_words(displacement: Floats, force: Floats) -> str:
    """Where a curve ends before the stroke; empty if it does not."""
    known = np.flatnonzero(np.isfinite(force))
    if len(known) and known[-1] == len(force) - 1:
        return ""
    return f"stop at {displacement[known[-1]]:.1f} mm and {force[known[-1]]:.3g} N" if len(known) else "stop before the first level"


def what_if_document(found: WhatIf, scene: str, reference: str) -> dict[str, Any]:
    """The contents of what_if.json. `scene`: its text; `reference`: label of the experiment's setting, or empty."""
    names = [one.name for one in found.shown]

    def named(values: Floats) -> dict[str, float]:
        return dict(zip(names, values.tolist(), strict=True))

    moves = [{"key": move.key.name, "unit": move.key.unit, "value": move.value, "scene": move.key.value,
              "relative_change": move.key.relative(move.value), "met": move.is_met, "quantities": named(move.numbers),
              "trials": move.trials.tolist()} for move in found.moves]
    document: dict[str, Any] = finite({
        "moves": moves, "program": _engine.__version__, "reference": reference, "replicas": found.packings, "scene": scene,
        "scene_quantities": named(found.base), "experiment_quantities": named(found.measured_numbers),
        "what_if_target": {"name": names[0], "unit": found.shown[0].unit, "value": found.target}})
    return document


def what_if_figure_values(found: WhatIf) -> dict[str, Any]:
    """Values of the figure `what_if`: the target quantity over the relative change of each key, and force curves."""
    target = found.shown[0]
    series = []
    for k, move in enumerate(found.moves):
        style = style_number(k)
        change = [100 * move.key.relative(value) for value in move.trials[:, 0].tolist()]
        series.append({"words": f"{move.key.name} {value_text(move.key, move.value)}", "colour": style.colour, "marker": style.marker,
                       "change": change, "target": move.trials[:, 1].tolist(), "is_met": move.is_met,
                       "found": [100 * move.key.relative(move.value), float(move.numbers[0])], "force": move.force.tolist()})
    measured = [values.tolist() for values in found.measured] if found.measured else None
    values: dict[str, Any] = finite({
        "x_label": "change of the key [%]", "y_label": quantity_words(target.name) + (f" [{target.unit}]" if target.unit else ""),
        "target": found.target, "displacement": found.displacement.tolist(), "scene_force": found.force.tolist(), "measured": measured,
        "top_force": found.target if target.name == "top_force" else math.nan, "series": series})
    return values
