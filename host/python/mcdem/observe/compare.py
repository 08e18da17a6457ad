"""The comparison table of the paper: replicas of one setting against reference recordings, measured or simulated."""
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from ..errors import InputError
from ..number_text import mm
from .coordination import CoordinationError, coordination_error, reference_coordination
from .estimate import Estimate, Jackknife
from .force_distribution import DistributionDistance, distribution_distance
from .levels import LevelMatch, Levels, group_levels, match_levels
from .replicas import Replicas, Setting, seeds_of
from .top_force import TopForceRatio, top_force_error, top_force_ratio


@dataclass(frozen=True)
class Comparison:
    """`notes`: unavailable data, and what was done instead."""

    setting: str
    Rtop: Estimate = Estimate()  # top force at maximum compression over that of the reference
    errf: Estimate = Estimate()  # RMS error of the top force over all levels [N]
    errZ: Estimate = Estimate()  # RMS error of Z over all levels, at tau
    tau: Estimate = Estimate()  # force below which contacts are ignored, chosen to minimise errZ [N]
    bhat: Estimate = Estimate()  # -log of the mean over levels of the Bhattacharyya coefficient
    replicas: int = 0
    reference_levels: int = 0
    levels_errf: int = 0  # number of levels used for each
    levels_errZ: int = 0
    levels_bhat: int = 0
    notes: list[str] = field(default_factory=list)


def compare(simulated: Setting, reference: Replicas, touch_force: float | None = None) -> Comparison:
    """errf ignores levels at which the reference's force does not exceed `touch_force` [N]. Raises InputError without reference levels."""
    measured, levels = _levels_or_error(reference, "reference"), group_levels(simulated.replicas)
    notes = _failure_notes(simulated)
    if not levels:
        return Comparison(simulated.label, replicas=len(simulated.replicas), reference_levels=len(measured),
                          notes=[*notes, "no scans after the discarded cycles"])
    matches = match_levels(levels, measured)
    jackknife = Jackknife(seeds_of(simulated.replicas), seeds_of(reference))
    ratio = top_force_ratio(levels, simulated.replicas, measured, reference)
    errf = top_force_error(levels, measured, matches, jackknife.omissions, touch_force)
    z = coordination_error(levels, simulated.replicas, reference_coordination(measured, reference), matches, jackknife)
    distance = distribution_distance(levels, measured, matches, jackknife)
    notes += [*_level_notes(measured, matches), *_stroke_notes(ratio), *_contact_notes(z, distance, errf.levels_used)]
    return Comparison(simulated.label, ratio.Rtop, jackknife.estimate(errf.by_omission), z.errZ, z.tau, distance.bhat,
                      len(simulated.replicas), len(measured), errf.levels_used, z.levels_used, distance.levels_used, notes)


def _levels_or_error(replicas: Replicas, whose: str) -> Levels:
    levels = group_levels(replicas)
    if not levels:
        raise InputError(f"{whose}: must have scans after its discarded cycles, got none: record more cycles or discard fewer")
    return levels


def _failure_notes(setting: Setting) -> list[str]:
    failures = [recording.failure for recording in setting.replicas if recording.failure]
    return [f"{len(failures)} of {len(setting.replicas)} replicas stopped early (first: {failures[0].text()}); their scans until "
            "then count, except in Rtop where they did not get there"] if failures else []


def _level_notes(reference: Levels, matches: Sequence[LevelMatch]) -> list[str]:
    interpolated, missing = sum(match.below != match.above for match in matches), sum(not match.found() for match in matches)
    notes = [f"{interpolated} of {len(reference)} levels of the reference lie between levels of the simulation: interpolated"]
    left_out = [f"{missing} of {len(reference)} levels of the reference are outside the simulated ones: left out"]
    return notes * bool(interpolated) + left_out * bool(missing)


def _stroke_notes(ratio: TopForceRatio) -> list[str]:
    if math.isnan(ratio.displacement):
        return ["Rtop: no replica came to the end of its protocol"]
    if ratio.displacement < ratio.reference_end:
        return [f"Rtop is taken at {mm(ratio.displacement)} mm, where the simulation ends; the reference goes to "
                f"{mm(ratio.reference_end)} mm"]
    return []


def _contact_notes(z: CoordinationError, distance: DistributionDistance, levels_errf: int) -> list[str]:
    notes = []
    if z.levels_used == 0:
        notes.append("errZ: Z is not known on both sides at any level")
    elif not z.tau.available():
        notes.append("errZ is without threshold: the simulation has no contacts recorded")
    if distance.levels_used == 0:
        notes.append("bhat: contacts are not recorded on both sides at any level")
    elif distance.levels_used < levels_errf:
        notes.append(f"bhat rests on the {distance.levels_used} levels with contacts on both sides")
    return notes
