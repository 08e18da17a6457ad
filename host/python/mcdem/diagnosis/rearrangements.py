"""Rearrangements of grains that occur in no replicate. They change all observables at one displacement, and few elsewhere; an effect changes
observables in the whole stroke."""
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .evidence import GapData
from .gap_space import BinChoice
from .gap_tests import GapStatistics, NullDistribution, gap_statistics
from ..observe.grid import bins_each
from ..observe.observables import observables
from ..observe.observation import MIN_BINS

OF_HOLDS = "relaxation", "creep"  # observables with one place only


def without_place(bins: BinChoice, place: int, all_bins: int) -> BinChoice:
    """The bins without all observables at one displacement and phase (`place`, the index of a bin in its observable), except relaxation and
    creep in a hold, which have one place only."""
    observable, of_bin = np.divmod(bins, bins_each(all_bins))
    of_hold = [k for k, one in enumerate(observables()) if one.name in OF_HOLDS]
    rest: BinChoice = bins[(of_bin != place) | np.isin(observable, of_hold)]
    return rest


@dataclass(frozen=True, eq=False)
class PlaceLeftOut:
    """Tests without one place."""

    place: int
    data: GapData  # with the other bins
    null: NullDistribution


def places_left_out(data: GapData, seed: int) -> list[PlaceLeftOut]:
    """One for each place, unless too few other bins remain."""
    choices = [without_place(data.bins, place, len(data.gap)) for place in range(bins_each(len(data.gap)))]
    others = {place: replace(data, bins=bins) for place, bins in enumerate(choices) if MIN_BINS <= len(bins) < len(data.bins)}
    return [PlaceLeftOut(place, other, NullDistribution(other, seed)) for place, other in others.items()]


def p_of_gap(null: NullDistribution, statistics: GapStatistics) -> float:
    """p of a gap, from the omnibus and the directed test (Bonferroni correction)."""
    return min(1.0, 2 * min(null.p_value("omnibus", statistics.omnibus), null.p_value("directed", statistics.directed)))


def p_without_one_place(places: Sequence[PlaceLeftOut]) -> float:
    """The largest p of the gap without one of the places."""
    return max((p_of_gap(one.null, gap_statistics(one.data.space(), one.data, one.data.gap)) for one in places), default=0.0)
