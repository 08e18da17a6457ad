"""Runs of a programme: evaluated scan by scan instead of by strokes and levels."""
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..results.names import Phase
from ..results.parameters import without_quotes
from ..results.recording import Floats, Recording
from .estimate import Estimate, mean_over_replicas
from .replicas import Replicas, Setting
from .stress_strain import deviatoric_strain, deviatoric_stress, mean_stress, volume_strain


def follows_programme(replicas: Recording | Replicas) -> bool:
    """Whether the recording, or any of the replicas, followed a [[programme]]."""
    return replicas.has_programme if isinstance(replicas, Recording) else any(one.has_programme for one in replicas)


def with_programme(settings: Sequence[Setting], programme: bool) -> list[Setting]:
    """The settings that follow a programme, or those that do not."""
    return [setting for setting in settings if follows_programme(setting.replicas) == programme]


def are_cells(replicas: Replicas) -> bool:
    """Whether the replicas are cells, which have stresses and strains instead of forces and displacements."""
    return bool(replicas) and replicas[0].box.is_cell


def has_hold(replicas: Replicas) -> bool:
    """Whether a stage of the programme is a hold."""
    return any(key.startswith("programme.") and key.endswith(".stage") and without_quotes(value) == "hold"
               for recording in replicas for key, value in recording.parameters.items())


@dataclass(frozen=True)
class MeanScan:
    """Averages of the same scan over all replicas that have it."""

    frame: int
    cycle: int
    phase: Phase
    time: Estimate  # [s]
    displacement: Estimate  # [m]
    top_force: Estimate  # [N]
    coordination: Estimate
    packing_fraction: Estimate
    p: Estimate  # stress_strain.py [Pa]
    q: Estimate
    strain: tuple[Estimate, ...]  # six, for cells, like the next two
    volume_strain: Estimate
    shear_strain: Estimate
    max_overlap: float  # maximum over all replicas


QUANTITIES: dict[str, Callable[[Recording], Floats]] = {
    "time": lambda recording: recording.scans.time,
    "displacement": lambda recording: recording.displacement,
    "top_force": lambda recording: recording.scans.top_force,
    "coordination": lambda recording: recording.scans.coordination_number,
    "packing_fraction": lambda recording: recording.scans.packing_fraction,
    "p": lambda recording: mean_stress(recording.scans.stress),
    "q": lambda recording: deviatoric_stress(recording.scans.stress),
    "volume_strain": lambda recording: volume_strain(recording.scans.strain),
    "shear_strain": lambda recording: deviatoric_strain(recording.scans.strain),
}


def mean_scans(replicas: Replicas) -> list[MeanScan]:
    """In order of the scans' frames."""
    frame, cycle, phase, overlap = (np.concatenate([getattr(one.scans, name) for one in replicas] or [np.zeros(0)])
                                    for name in ("frame", "cycle", "phase", "max_overlap"))
    if not len(frame):
        return []
    values = {name: np.concatenate([of(one) for one in replicas]) for name, of in QUANTITIES.items()}
    strain = np.concatenate([one.scans.strain for one in replicas])
    order = np.argsort(frame, kind="stable")
    rows_by_frame = np.split(order, np.flatnonzero(np.diff(frame[order])) + 1)
    return [MeanScan(int(frame[rows[0]]), int(cycle[rows[0]]), Phase(int(phase[rows[0]])),
                     strain=tuple(mean_over_replicas(strain[rows, k]) for k in range(6)),
                     max_overlap=float(np.fmax.reduce(overlap[rows])),
                     **{name: mean_over_replicas(of_all[rows]) for name, of_all in values.items()})
            for rows in rows_by_frame]
