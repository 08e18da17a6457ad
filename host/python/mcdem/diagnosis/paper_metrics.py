"""The metrics of the paper for an experiment compared with the scene, and with the scene plus the named effect."""
from dataclasses import dataclass

import numpy as np

from ..observe.compare import compare
from ..observe.levels import at_reference, by_replica, group_levels, match_levels, mean_without, top_force
from ..observe.replicas import Replicas, Setting
from ..results.names import Phase
from .diagnosis_types import Pair, TopForce, millimetres


@dataclass(frozen=True)
class PaperMetrics:
    values: dict[str, Pair]  # Rtop, errf [N], errZ, bhat, as far as known: before and after
    top_force: tuple[TopForce, ...]


def paper_metrics(experiment: Replicas, before: Replicas, after: Replicas) -> PaperMetrics:
    """Of simulations `before` and `after` the effect is added to the scene. Raises InputError for an experiment without levels."""
    first, second = (compare(Setting("", replicas), experiment) for replicas in (before, after))
    pairs = {name: (getattr(first, name), getattr(second, name)) for name in ("Rtop", "errf", "errZ", "bhat")}
    values = {name: (a.value, b.value) for name, (a, b) in pairs.items() if a.available() and b.available()}
    return PaperMetrics(values, _top_force(experiment, before, after))


def _top_force(experiment: Replicas, before: Replicas, after: Replicas) -> tuple[TopForce, ...]:
    """At the experiment's levels during loading."""
    measured = group_levels(experiment)
    forces = [mean_without(by_replica(measured, top_force), -1)]
    for levels in map(group_levels, (before, after)):
        forces.append(mean_without(at_reference(by_replica(levels, top_force), match_levels(levels, measured)), -1))
    return tuple(TopForce(millimetres(level.displacement), *of_level)
                 for level, of_level in zip(measured, np.column_stack(forces).tolist(), strict=True) if level.phase == Phase.load)
