"""What a fit compares: curves of the force on the plate and of Z, single values of them, and programmes scan by scan."""
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError
from ..observe.coordination import recorded_coordination
from ..observe.levels import Level, Levels, at_reference, by_replica, group_levels, match_levels, top_force
from ..observe.programmes import QUANTITIES
from ..observe.replicas import Replicas
from ..observe.top_force import full_stroke
from ..results.names import Phase
from ..results.recording import Floats

MM = 1e-3
BEGUN = 0.01  # over the stroke: before it the plate need not have a scan in the simulation
FLOOR = 0.02  # over the largest value: differences that count as one sigma, where packings do not scatter more
PLATE, CELL = ("top_force", "displacement", "coordination"), ("p", "q", "volume_strain", "shear_strain", "coordination")  # of programmes
UNITS = {"force": "N", "unloading_force": "N", "top_force": "N", "displacement": "m", "p": "Pa", "q": "Pa"}
AT = {"force": Phase.load, "unloading_force": Phase.unload, "coordination": Phase.load, "force_share": Phase.load}
NAME = re.compile(r"(force|unloading_force|coordination|force_share)@(\d+(?:\.\d*)?)", re.ASCII)
NAMES = "top_force, force@MM, unloading_force@MM, coordination@MM or force_share@MM (MM: plate displacement in mm)"


@dataclass(frozen=True, eq=False)
class Quantity:
    """`of`: (replicas, values) of the replicas of one setting; NaN where they stopped before."""
    name: str
    unit: str
    place: Floats  # (values,) displacement [mm], or number of the scan
    unloads: Floats  # (values,) 1 where the place is one of unloading
    of: Callable[[Replicas], Floats]


@dataclass(frozen=True, eq=False)
class Quantities:
    """Several, with their values side by side."""
    each: Sequence[Quantity]
    columns: list[slice] = field(init=False)

    def __post_init__(self) -> None:
        ends = np.cumsum([0, *(len(one.place) for one in self.each)]).tolist()
        object.__setattr__(self, "columns", [slice(a, b) for a, b in zip(ends, ends[1:])])

    def __len__(self) -> int:
        return sum(len(one.place) for one in self.each)

    def of(self, replicas: Replicas) -> Floats:
        """(replicas, values)"""
        return np.hstack([one.of(replicas) for one in self.each])

    def facts(self) -> str:
        """What determines the values of a recording."""
        return repr([(one.name, one.place.tolist(), one.unloads.tolist()) for one in self.each])


def curves(reference: Replicas, wanted: Sequence[str] = ()) -> Quantities:
    """What the reference has of the force and Z at its levels, or of its programme's scans; or only the `wanted` ones, which may also be
    single values. Raises InputError."""
    is_programme = reference[0].has_programme
    known = {one.name: one for one in (_of_programme(reference) if is_programme else _of_levels(reference)) if len(one.place)}
    if not known:
        raise InputError("the experiment must have scans after its discarded cycles, got none")
    others = [] if is_programme else [NAMES]  # single values
    if unknown := [name for name in wanted if name not in known and not (others and ("@" in name or name == "top_force"))]:
        raise InputError(f"--compare: must be of {', '.join([*known, *others])}; got {', '.join(unknown)}")
    return Quantities([known[name] if name in known else single(name, stroke_of(reference)) for name in wanted or known])


def _of_levels(reference: Replicas) -> list[Quantity]:
    stroke = stroke_of(reference)
    levels = [level for level in group_levels(reference) if level.displacement > BEGUN * stroke]
    force = at_levels("force", levels, lambda _, theirs: by_replica(theirs, top_force))
    if not levels:
        return [force]
    known = np.isfinite(by_replica(levels, recorded_coordination)).any(0)
    with_z = [level for level, is_known in zip(levels, known, strict=True) if is_known]
    return [force, at_levels("coordination", with_z, lambda _, theirs: by_replica(theirs, recorded_coordination))]


def at_levels(name: str, levels: Levels, quantity: Callable[[Replicas, Levels], Floats]) -> Quantity:
    """Of replicas of strokes, interpolated to these levels."""
    def of(replicas: Replicas) -> Floats:
        theirs = group_levels(replicas)
        if not theirs:
            return np.full((len(replicas), len(levels)), math.nan)
        return at_reference(quantity(replicas, theirs), match_levels(theirs, levels))

    place = np.array([level.displacement / MM for level in levels])
    return Quantity(name, UNITS.get(name, ""), place, np.array([float(level.phase == Phase.unload) for level in levels]), of)


def _of_programme(reference: Replicas) -> list[Quantity]:
    scans = min(len(one.scans) for one in reference)

    def by_scan(name: str) -> Callable[[Replicas], Floats]:
        def of(replicas: Replicas) -> Floats:
            values = np.full((len(replicas), scans), math.nan)
            for row, one in zip(values, replicas, strict=True):
                count = min(scans, len(one.scans))
                row[:count] = QUANTITIES[name](one)[:count]
            return values

        return of

    found = []
    for name in CELL if reference[0].box.is_cell else PLATE:
        if np.isfinite(by_scan(name)(reference)).all(0).all():
            found.append(Quantity(name, UNITS.get(name, ""), np.arange(scans, dtype=float), np.zeros(scans), by_scan(name)))
    return found


def single(name: str, displacement: float) -> Quantity:
    """One value of runs of strokes, by its NAMES; `displacement` at full stroke [m]. Raises InputError."""
    if name == "top_force":
        force = single(f"force@{displacement / MM!r}", displacement)
        back = single(f"unloading_force@{displacement / MM!r}", displacement)  # a turning point belongs to both

        def top(replicas: Replicas) -> Floats:
            down, up = force.of(replicas), back.of(replicas)
            return np.asarray(np.where(np.isfinite(down), down, up))

        return Quantity(name, "N", force.place, force.unloads, top)
    found = NAME.fullmatch(name)
    if not found or not 0 < float(found[2]) * MM <= displacement * (1 + 1e-9):
        raise InputError(f"{name}: must be {NAMES}, within the stroke of {displacement / MM:.2f} mm")
    kind, level = found[1], Level(AT[found[1]], float(found[2]) * MM, (), ())
    if kind == "coordination":
        return at_levels(name, [level], lambda _, theirs: by_replica(theirs, recorded_coordination))
    at = at_levels(name, [level], lambda _, theirs: by_replica(theirs, top_force))
    if kind != "force_share":
        return Quantity(name, "N", at.place, at.unloads, at.of)
    full = single("top_force", displacement)
    return Quantity(name, "", at.place, at.unloads, lambda replicas: at.of(replicas) / full.of(replicas))


def stroke_of(reference: Replicas) -> float:
    """The greatest displacement [m]. Raises InputError without one."""
    displacement = full_stroke(group_levels(reference), reference)
    if not math.isfinite(displacement):
        raise InputError("calibrate: the reference must have a scan, got none (all cycles discarded, or all replicas failed)")
    return displacement


def sigma_of(quantities: Quantities, reference: Floats) -> Floats:
    """(values,) what counts as one standard deviation: the scatter between the reference's replicas, and FLOOR of the largest value of each
    quantity."""
    scatter = variance_of_mean(reference)
    floor = np.concatenate([np.full(len(one.place), FLOOR * max(float(np.nanmax(np.abs(reference[:, columns]))), 1e-300))
                            for one, columns in zip(quantities.each, quantities.columns, strict=True)])
    return np.asarray(np.sqrt(np.nan_to_num(scatter) + floor**2))


def variance_of_mean(data: Floats) -> Floats:
    """(values,) of the mean over replicas (replicas, values) that have the value; NaN with fewer than two."""
    known = np.isfinite(data)
    count = known.sum(0)
    with np.errstate(invalid="ignore", divide="ignore"):
        rest = np.where(known, data - np.where(known, data, 0).sum(0) / count, 0)
        return np.asarray((rest**2).sum(0) / (count - 1) / count)
