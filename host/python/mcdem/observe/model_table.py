"""Top force of each setting at full stroke over that of a reference setting: the Rtop column of the paper without measured data."""
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..results.names import ContactModel
from .estimate import Estimate, mean_over_replicas, not_available, ratio_of_means
from .law_range import BeyondLaw, beyond_law
from .levels import Levels, group_levels
from .replicas import Replicas, Setting, model_of
from .stress_strain import load
from .top_force import full_stroke, top_force_at

# Packings that are compressed at different speeds take different courses where grains rearrange. Single scans therefore differ by
# this much more than the mean over packings, of which `Scans.rate_error` is the estimate; not exceeded by 95 % of the scans of
# packings of 514 grains (scenes/README.md, scripts/plate_speed).
course_error = 0.07


@dataclass(frozen=True)
class ModelRow:
    """One setting."""

    setting: str
    model: ContactModel | None
    top_force: Estimate  # at full stroke, or at `reached` [N]
    ratio: Estimate  # over the reference setting; paired by packing seed if seeds match
    replicas: int
    failed: int  # replicas that stopped before the end of their protocol
    reached: float | None  # displacement of the last scan, if no replica reached full stroke [m]
    beyond: BeyondLaw | None


@dataclass(frozen=True)
class ModelTable:
    """`rows` in order of the settings."""

    rows: tuple[ModelRow, ...] = ()
    reference: str = ""  # label of the reference setting
    # Full stroke of the reference setting, or the largest that any setting reached if the reference stopped early [m].
    displacement: float = not_available
    rate_error: float = not_available  # largest estimate of the engine at or above a tenth of the top force


def largest_rate_error(replicas: Replicas) -> float:
    """Largest estimate at or above a tenth of the largest load (stress_strain.py); NaN if there is none."""
    largest = not_available
    for recording in replicas:
        loads = load(recording)
        loaded = loads >= 0.1 * np.fmax.reduce(loads, initial=0)
        largest = np.fmax.reduce(recording.scans.rate_error[loaded], initial=largest)
    return float(largest)


def model_table(settings: Sequence[Setting], reference: str | None = None) -> ModelTable:
    """The reference is the setting with that label; default: the first with model mc_dem, otherwise the first."""
    if not settings:
        return ModelTable()
    over = _reference_of(settings, reference)
    levels = {id(setting): group_levels(setting.replicas) for setting in [over, *settings]}
    displacement = full_stroke(levels[id(over)], over.replicas)
    if np.isnan(displacement):  # the largest of all replicas that did not stop early
        displacement = float(np.fmax.reduce([full_stroke(levels[id(one)], one.replicas) for one in settings]))
    rows = tuple(_row(setting, levels[id(setting)], over, levels[id(over)], displacement) for setting in settings)
    rate_error = float(np.fmax.reduce([largest_rate_error(setting.replicas) for setting in settings]))
    return ModelTable(rows, over.label, displacement, rate_error)


def _reference_of(settings: Sequence[Setting], label: str | None) -> Setting:
    for setting in settings:
        if setting.label == label if label is not None else model_of(setting.replicas) == ContactModel.mc_dem:
            return setting
    if label is None:
        return settings[0]
    known = ", ".join(f'"{setting.label}"' for setting in settings)
    raise InputError(f'reference setting: must be one of {known}; got "{label}"')


def _row(setting: Setting, levels: Levels, over: Setting, over_levels: Levels, displacement: float) -> ModelRow:
    above, reached = top_force_at(levels, setting.replicas, displacement), None
    last = max((level.displacement for level in levels), default=not_available)  # including replicas that stopped early
    if not mean_over_replicas(above.value).available() and np.isfinite(last):
        above, reached, displacement = top_force_at(levels, setting.replicas, last), last, last
    below = top_force_at(over_levels, over.replicas, displacement)
    failed = sum(recording.failure is not None for recording in setting.replicas)
    return ModelRow(setting.label, model_of(setting.replicas), mean_over_replicas(above.value), ratio_of_means(above, below),
                    len(setting.replicas), failed, reached, beyond_law(setting.replicas))
