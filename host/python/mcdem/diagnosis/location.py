"""Location of the gap: bins whose difference after refitting exceeds the largest one of the replicates, merged into ranges."""
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from ..results.recording import Floats
from .decision import Limits
from .diagnosis_types import WhereBin, WhereEntry, millimetres
from .evidence import GapData
from .gap_space import GapSpace
from .gap_tests import NullDistribution
from ..observe.grid import Grid, bins_of
from ..observe.observables import observables


@dataclass(frozen=True)
class Location:
    entries: list[WhereEntry]  # significant ones, largest first
    bins: list[WhereBin]  # all
    threshold: float  # simultaneous: quantile 1 - Limits.false_alarm of the largest |z| of a replicate


def _entry(observable: int, bins: Sequence[tuple[float, WhereBin]], half_spacing: float, stroke: float) -> WhereEntry:
    """Of neighbouring significant displacements [m] of one observable and phase."""
    strongest = max((bin for _, bin in bins), key=lambda bin: abs(bin.z_score_refitted))
    known = observables()[observable]
    first, last = bins[0][0] - half_spacing, min(bins[-1][0] + half_spacing, stroke)
    return WhereEntry(
        observable=known.name, phase=strongest.phase, displacement_mm=(millimetres(first), millimetres(last)), region=known.region or None,
        force_class=known.force_class or None, z_score=strongest.z_score, z_score_refitted=strongest.z_score_refitted,
        difference=strongest.difference)


def locate(space: GapSpace, data: GapData, null: NullDistribution, gap: Floats, grid: Grid, limits: Limits) -> Location:
    """`gap`: observed minus model, all bins."""
    threshold = null.quantile("highest_refitted", limits.false_alarm)
    every = bins_of(grid)
    chosen = [every[bin] for bin in data.bins]
    values = zip(gap[data.bins] / space.sigma, space.refitted(gap) / space.sigma, gap[data.bins])
    bins = [WhereBin(observables()[bin.observable].name, bin.phase.name, millimetres(bin.displacement), *map(float, of_bin))
             for bin, of_bin in zip(chosen, values)]
    half_spacing = 0.5 * (grid.displacement[1] - grid.displacement[0] if len(grid.displacement) > 1 else grid.width)
    runs = groupby(zip(chosen, bins), lambda pair: (pair[0].observable, pair[0].phase, abs(pair[1].z_score_refitted) >= threshold))
    entries = [_entry(observable, [(place.displacement, bin) for place, bin in run], half_spacing, grid.stroke)
               for (observable, _, significant), run in runs if significant]
    entries.sort(key=lambda entry: -abs(entry.z_score_refitted))
    return Location(entries, bins, threshold)
