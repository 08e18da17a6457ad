"""The displacements at which recordings are compared."""
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from ..experiment.plate import scan_places
from ..results.names import Phase
from ..results.parameters import value_of, without_quotes
from ..results.recording import Bools, Floats, Recording
from .observables import observables

PHASES = Phase.load, Phase.unload
PARTS_OF_STROKE = 0.42, 0.61, 0.80, 0.98
EARLY = 0.15  # over the stroke: hardly any grains overlap clearly before
WIDTH_OF_STROKE = 0.12
SCANS_IN_WIDTH = 1.6  # over which scans are smoothed, on each side of a displacement


@dataclass(frozen=True)
class HoldScans:
    """A hold of a programme: the scans at its start and its end. The scans in between belong to no stroke."""

    begin: int
    first: int  # the first one taken during the hold
    end: int
    keep: str  # position, force or stress
    phase: Phase
    displacement: float  # of the experiment [m]


@dataclass(frozen=True)
class Grid:
    """Displacements at which recordings are compared, and the width over which scans are smoothed."""

    displacement: list[float]  # [m]
    width: float  # scans within this distance contribute, with decreasing weight [m]
    stroke: float  # of the experiment [m]
    # If the programme sets forces: those of the experiment at the displacements while loading [N]. Scans are then selected by force, and
    # the displacement is the observable.
    force: list[float] = field(default_factory=list)
    force_width: float = 0.0  # [N]
    holds: list[HoldScans] = field(default_factory=list)  # of the programme, in order

    def is_held(self, scans: int) -> Bools:
        """(scans,) whether a scan belongs to a hold."""
        number = np.arange(scans)
        held = np.zeros(scans, bool)
        for hold in self.holds:
            held |= (number >= hold.first) & (number <= hold.end)
        return held


@dataclass(frozen=True)
class Bin:
    observable: int  # index in observables()
    phase: Phase
    displacement: float  # [m]


def bins_of(grid: Grid) -> list[Bin]:
    """The bins of a grid: by observable, then phase, then displacement."""
    return [Bin(*key) for key in product(range(len(observables())), PHASES, grid.displacement)]


def bins_each(count: int) -> int:
    """Number of bins of each observable, of `count` bins of a grid."""
    return count // len(observables())


def grid_of(recording: Recording) -> Grid:
    """Four displacements of the recording's stroke; the width covers at least three scans."""
    scans = recording.scans
    places = scan_places(recording) if recording.has_programme else []
    stroke = float(max([0.0, *recording.displacement]))
    holds = _holds_of(recording, places)
    held = Grid([], 0, 0, holds=holds).is_held(len(scans))
    loading = np.count_nonzero((scans.phase == Phase.load) & ~held)
    spacing = stroke * (max(scans.cycle, default=0) + 1) / max(1, loading)
    grid = _at_tomographs(recording, replace(grid_of_stroke(stroke, spacing), holds=holds))
    return _with_forces(recording, grid) if _sets_forces(recording) else grid


def _at_tomographs(recording: Recording, grid: Grid) -> Grid:
    """Without contact forces and with the positions of grains in few of the frames of loading, displacements are those of the nearest of these,
    one each: between frames nothing is known of grains."""
    scans = recording.scans
    loads = (scans.phase == Phase.load) & ~grid.is_held(len(scans)) & (recording.displacement > EARLY * grid.stroke)
    seen = loads & np.array([len(at) > 0 for at in scans.position], bool)
    if not seen.any() or any(map(len, scans.contacts)) or (seen == loads).all():
        return grid
    from scipy.optimize import linear_sum_assignment  # few measurements need it
    there, places = np.unique(recording.displacement[seen]), np.array(grid.displacement)
    old, new = linear_sum_assignment(np.abs(places[:, np.newaxis] - there))
    places[old] = there[new]
    return replace(grid, displacement=sorted(places.tolist()))


def _sets_forces(recording: Recording) -> bool:
    """Whether a stage of its programme other than a hold has a force."""
    parameters = recording.parameters
    forces = [key.removesuffix(".force") for key, text in parameters.items() if key.startswith("programme.") and key.endswith(".force") and text]
    return any(without_quotes(value_of(parameters, f"{stage}.stage")) != "hold" for stage in forces)


def grid_of_stroke(stroke: float, spacing: float) -> Grid:
    """Of a stroke with scans at this distance [m]."""
    return Grid([part * stroke for part in PARTS_OF_STROKE], float(max(WIDTH_OF_STROKE * stroke, SCANS_IN_WIDTH * spacing)), stroke)


def _holds_of(recording: Recording, places: list[dict[str, Any]]) -> list[HoldScans]:
    """Each hold with the scan at its start: the last one before it, if that is at the end of its leg."""
    holds = dict[int, list[int]]()  # by leg: begin, first, end
    for k, place in enumerate(places[:max(0, len(recording.scans) - 1)]):
        if not place["held"]:
            continue
        scan = k + 1
        if place["leg"] not in holds:
            just_before = k == 0 or places[k - 1]["at_end"]
            holds[place["leg"]] = [scan - 1 if just_before else scan, scan, scan]
        holds[place["leg"]][2] = scan
    return [HoldScans(begin, first, end, places[first - 1]["by"], Phase(int(recording.scans.phase[first])), float(recording.displacement[begin]))
            for begin, first, end in holds.values()]


def _with_forces(recording: Recording, grid: Grid) -> Grid:
    """With the forces during loading at the displacements, interpolated between scans, where each force is first reached."""
    scans = recording.scans
    strokes = (scans.phase == Phase.load) & ~grid.is_held(len(scans))
    displacement, force = recording.displacement[strokes], scans.top_force[strokes]
    farther = np.concatenate([[True], displacement[1:] > np.maximum.accumulate(displacement)[:-1]]) if len(displacement) else strokes[:0]
    displacement, force = displacement[farther], force[farther]
    wanted = np.array(grid.displacement)
    if not len(displacement) or (wanted <= displacement[0]).any() or (wanted > displacement[-1]).any():
        return grid
    forces = np.interp(wanted, displacement, force)
    width = grid.width / grid.stroke * max(0.0, float(force.max()))
    return replace(grid, force=forces.tolist(), force_width=width)


def offsets(recording: Recording, grid: Grid) -> Floats:
    """(scans, displacements): distance of each scan from each displacement of the grid, over the width."""
    if grid.force:
        return (recording.scans.top_force[:, np.newaxis] - grid.force) / grid.force_width
    return (recording.displacement[:, np.newaxis] - grid.displacement) / grid.width
