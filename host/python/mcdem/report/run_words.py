"""Sentences on runs: what was simulated, and the main result."""
import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ..number_text import mm
from ..observe.model_table import model_table
from ..observe.programmes import are_cells, mean_scans, with_programme
from ..observe.replicas import Setting
from ..results import ContainerShape, Recording
from .estimate_text import with_error
from .labels import stress_unit, three_digits, words_for

MOST_LISTED = 4  # settings; of more the smallest and the largest
CONTAINERS = {ContainerShape.box: "in a box", ContainerShape.cylinder: "in a cylinder",
              ContainerShape.periodic: "between floor and plate without side walls",
              ContainerShape.cell: "in a cell that repeats in all directions"}


def new_words(words: Iterable[str]) -> list[str]:
    """Each once, in order of first appearance."""
    return list(dict.fromkeys(words))


def what_was_simulated(settings: Sequence[Setting]) -> str:
    """ "514 grains in a box, compressed by a plate, 20 cycles; 7 settings, 32 packings each." """
    recordings = [recording for setting in settings for recording in setting.replicas]
    if not recordings:
        return ""
    grains, packings = ({len(one.diameter) for one in recordings}, {len(setting.replicas) for setting in settings})
    containers, protocols = (" or ".join(new_words(map(of, recordings))) for of in (lambda one: CONTAINERS[one.box.shape], _protocol))
    return (f"{_range(grains)} grain{_plural(max(grains))} {containers}, {protocols}; {_counted(len(settings), 'setting')}, "
            f"{_range(packings)} packing{_plural(max(packings))} each.")


def main_result(settings: Sequence[Setting]) -> str:
    """ "Force on the plate at 30.13 mm: Independent contacts 7.19 N, MC-DEM 15.98 N."

    For a cell its largest mean stress. Also states how many replicas stopped early.
    """
    strokes = with_programme(settings, False)
    failed = [recording.failure is not None for setting in settings for recording in setting.replicas]
    stopped = f"{sum(failed)} of {len(failed)} replicas stopped early." if any(failed) else ""
    return " ".join(filter(None, (_of_strokes(strokes) if strokes else "", *_of_programmes(with_programme(settings, True)), stopped)))


def _plural(count: int) -> str:
    return "" if count == 1 else "s"


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{_plural(count)}"


def _range(numbers: set[int]) -> str:
    """ "60", or "60 to 240" """
    return str(min(numbers)) if len(numbers) == 1 else f"{min(numbers)} to {max(numbers)}"


def _protocol(recording: Recording) -> str:
    stages = sum(key.startswith("programme.") and key.endswith(".stage") for key in recording.parameters)
    if stages:
        return ("deformed in " if recording.box.is_cell else "loaded by a plate in ") + _counted(stages, "stage")
    cycles = recording.parameters.get("protocol.cycles", "")
    return "compressed by a plate" + ("" if cycles in ("", "1") else f", {cycles} cycles")


class Reached(NamedTuple):
    """What a setting reached."""
    setting: str
    value: float
    words: str


def _listed(quantity: str, everything: Iterable[Reached]) -> str:
    """ "Force: A 1 N, B 2 N." """
    reached = [one for one in everything if math.isfinite(one.value)]
    if not reached:
        return ""
    if len(reached) > MOST_LISTED:
        least, most = min(reached, key=lambda one: one.value), max(reversed(reached), key=lambda one: one.value)
        return (f"{quantity}: from {least.words} ({words_for(least.setting)}) to {most.words} ({words_for(most.setting)}).")
    return f"{quantity}: {', '.join(f'{words_for(one.setting)} {one.words}' for one in reached)}."


def _of_strokes(settings: Sequence[Setting]) -> str:
    table = model_table(settings)
    quantity = "Force on the plate"
    if math.isfinite(table.displacement):
        quantity += f" at {mm(table.displacement)} mm"
        if any(row.reached is not None for row in table.rows):
            quantity += ", or as far as a replica came"
    return _listed(quantity, [
        Reached(row.setting, row.top_force.value, with_error(row.top_force, 2) + " N"
                + ("" if row.reached is None else f" at {mm(row.reached)} mm")) for row in table.rows])


def _of_programmes(settings: Sequence[Setting]) -> tuple[str, str]:
    """Of plates and of cells, at the scan with the largest mean."""
    plates, cells = [], []
    for setting in settings:
        is_cell = are_cells(setting.replicas)
        quantity = "p" if is_cell else "top_force"
        known = [scan for scan in mean_scans(setting.replicas) if getattr(scan, quantity).available()]
        if not known:
            continue
        most = known[int(np.argmax([getattr(scan, quantity).value for scan in known]))]
        if is_cell:
            unit = stress_unit(most.p.value)
            words = f"{three_digits(most.p.value / unit.size)} {unit.name} at φ = {most.packing_fraction.value:.3f}"
            cells.append(Reached(setting.label, most.p.value, words))
        else:
            words = f"{three_digits(most.top_force.value)} N at {mm(most.displacement.value)} mm"
            plates.append(Reached(setting.label, most.top_force.value, words))
    return _listed("Largest force on the plate", plates), _listed("Largest mean stress", cells)
