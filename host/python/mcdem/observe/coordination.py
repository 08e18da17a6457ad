"""Z(tau): contacts per grain when contacts with |f| < tau are ignored. errZ: difference to the reference at the tau that minimises it.

A contact between two grains counts for both, a contact with a wall for one grain.
"""
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..results.recording import Floats, Recording
from .contact_forces import ForceLists, contact_forces
from .estimate import Estimate, Jackknife, Omission, not_available
from .levels import LevelMatch, Levels, at_reference, by_replica
from .replicas import Replicas
from .top_force import LevelError, rms_over_levels

MOST_NUMBERS = 1 << 21  # at once: thresholds times replicas times levels


class Coordination:
    """Sorted contact forces of every replica at every level: Z at a threshold needs two binary searches."""

    def __init__(self, levels: Levels, replicas: Replicas) -> None:
        self._cells = [[_sorted(contact_forces(recording, level.scans[r])) for level in levels] for r, recording in enumerate(replicas)]
        grains = np.array([len(recording.diameter) for recording in replicas])
        scans = np.array([[forces.scans for forces in row] for row in self._cells]).reshape(len(replicas), len(levels))
        self._grain_scans = grains[:, None] * scans  # contacts are divided by it

    def at_threshold(self, tau: float | Floats) -> Floats:
        """(.., replica, level): Z at thresholds (..) [N]. NaN if contacts were not recorded."""
        contacts: Floats = np.array([[2 * _count_from(forces.grain_grain, tau) + _count_from(forces.grain_wall, tau) for forces in row]
                             for row in self._cells], float).reshape(*self._grain_scans.shape, *np.shape(tau))
        with np.errstate(divide="ignore", invalid="ignore"):
            z = np.moveaxis(contacts, (0, 1), (-2, -1)) / self._grain_scans
        return np.where(self._grain_scans > 0, z, not_available)

    def candidate_thresholds(self, count: int) -> Floats:
        """About `count` quantiles of the forces of all levels, ascending, starting at 0 [N]."""
        lists = [forces for row in self._cells for cell in row for forces in (cell.grain_grain, cell.grain_wall)]
        everyone = np.sort(np.concatenate([forces[::max(1, len(forces) // 64)] for forces in lists] or [np.zeros(0)]))
        chosen = everyone[::max(1, len(everyone) // count)]
        thresholds: Floats = np.unique(np.append(0, chosen[chosen > 0]))
        return thresholds

    @property
    def cells(self) -> int:
        """Replicas times levels."""
        return int(self._grain_scans.size)

    def known(self) -> bool:
        return bool((self._grain_scans > 0).any())


def _sorted(forces: ForceLists) -> ForceLists:
    return ForceLists(np.sort(forces.grain_grain), np.sort(forces.grain_wall), forces.scans)


def _count_from(forces: Floats, tau: float | Floats) -> Floats:
    """Number of forces in a sorted list that are at least tau."""
    return np.asarray(len(forces) - np.searchsorted(forces, tau, "left"), float)


def recorded_coordination(recording: Recording) -> Floats:
    """(S,)"""
    return recording.scans.coordination_number


def reference_coordination(levels: Levels, replicas: Replicas) -> Floats:
    """(replica, level) Z of a reference: from its contacts if recorded, otherwise as recorded per scan."""
    counted = Coordination(levels, replicas).at_threshold(0.0)
    return np.where(np.isfinite(counted), counted, by_replica(levels, recorded_coordination))


@dataclass(frozen=True)
class CoordinationError:
    """`tau` is not available if contacts were not recorded (errZ then has no threshold)."""

    errZ: Estimate = Estimate()
    tau: Estimate = Estimate()  # [N]
    levels_used: int = 0


class _Objective:
    """The RMS error as a function of tau."""

    def __init__(self, simulated: Coordination, reference: Floats, matches: Sequence[LevelMatch]) -> None:
        self._simulated, self._reference, self._matches = simulated, reference, matches

    def error(self, tau: float | Floats, omissions: Sequence[Omission] = (Omission(),)) -> LevelError:
        return rms_over_levels(at_reference(self._simulated.at_threshold(tau), self._matches), self._reference, omissions)

    def values(self, taus: Floats) -> Floats:
        """(tau,)"""
        at_once = max(1, MOST_NUMBERS // self._simulated.cells)
        return np.concatenate([self.error(taus[k:k + at_once]).by_omission[:, 0] for k in range(0, len(taus), at_once)])


def coordination_error(simulated: Levels, simulated_replicas: Replicas, reference: Floats, matches: Sequence[LevelMatch],
                       jackknife: Jackknife) -> CoordinationError:
    """Minimises the RMS over levels of Z(tau) - Z_reference over tau.

    The objective is piecewise constant (a step at every contact force) and may have several local minima. It is scanned at
    quantiles of the forces, then with increasing resolution around the best one; tau is the middle of the best interval.
    Standard errors by jackknife: of errZ at that tau (where it is stationary), of tau from a parabola.
    """
    coordination = Coordination(simulated, simulated_replicas)
    if not coordination.known():
        recorded = at_reference(by_replica(simulated, recorded_coordination), matches)
        error = rms_over_levels(recorded, reference, jackknife.omissions)
        return CoordinationError(jackknife.estimate(error.by_omission), levels_used=error.levels_used)
    objective = _Objective(coordination, reference, matches)
    tau = _minimising_tau(objective, coordination.candidate_thresholds(2000))
    error = objective.error(tau, jackknife.omissions)
    errZ = jackknife.estimate(error.by_omission)
    if error.levels_used == 0:
        return CoordinationError(errZ)
    return CoordinationError(errZ, Estimate(tau, _error_of_tau(objective, tau, jackknife), errZ.count), error.levels_used)


def _minimising_tau(objective: _Objective, candidates: Floats) -> float:
    for resolution in range(4):
        values = objective.values(candidates)
        first = int(np.argmin(values))
        worse = np.flatnonzero(values[first:] != values[first])
        last = first + int(worse[0]) - 1 if len(worse) else len(values) - 1
        last = max(last, first)  # not a number: no level is known
        before, after = candidates[max(first - 1, 0)], candidates[min(last + 1, len(values) - 1)]
        best = (candidates[first], candidates[last])
        if not before < after:
            break
        if resolution < 3:
            candidates = before + (after - before) * np.arange(101) / 100
    return 0.0 if best[0] == 0 else float((best[0] + best[1]) / 2)  # 0: no threshold is as good as any other


def _error_of_tau(objective: _Objective, tau: float, jackknife: Jackknife) -> float:
    """From the vertices of least-squares parabolas through squared errors, which are smooth while the objective has steps."""
    if not tau > 0 or len(jackknife.omissions) < 2:
        return not_available
    window = 0.7 * tau + (1.3 * tau - 0.7 * tau) * np.arange(41) / 40
    squared = objective.error(window, jackknife.omissions).by_omission ** 2
    middle, half_width = (window[0] + window[-1]) / 2, (window[-1] - window[0]) / 2
    powers = ((window - middle) / half_width)[:, None] ** np.arange(3)
    if not np.isfinite(squared).all():
        return not_available
    c = np.linalg.lstsq(powers, squared - squared[0], rcond=None)[0]  # exactly 0 without a step in the window
    with np.errstate(divide="ignore", invalid="ignore"):
        vertices = np.where(c[2] > 0, middle - half_width * c[1] / (2 * c[2]), not_available)
    return jackknife.estimate(vertices).standard_error
