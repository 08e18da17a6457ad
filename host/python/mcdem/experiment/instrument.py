"""The measurement: how a packing as it is becomes a packing as it is read. Simulations go through the same instrument as the experiment before
the two are compared."""
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..results.names import Phase, Wall
from ..results.recording import NO_VECTORS, Contacts, Floats, Ints, Recording, Scans
from .contact_averages import with_contact_averages
from .container import lengths
from .experiment import Measurement
from .keyed_normal import MEASURED_DIAMETERS, MEASURED_FORCES, MEASURED_POSITIONS, SEEN_CONTACTS, keyed_normals


@dataclass(frozen=True)
class Instrument:
    """What the instrument states of itself, and where it is wrong without knowing."""

    stated: Measurement = field(default_factory=Measurement)
    force_bias: float = 0.0  # contact forces are read (1 + force_bias) times too large
    threshold_shift: float = 0.0  # true force threshold less the stated one [N]
    position_bias: float = 0.0  # lengths between centres are read (1 + position_bias) times too large
    strain_offset: float = 0.0  # plate positions are read too high by this [m]
    # After the last cycle the top force is read (1 + gauge_drift) times too large, and larger by zero_drift of the highest, whatever it is;
    # both grow with the plate's path.
    gauge_drift: float = 0.0
    zero_drift: float = 0.0
    # On the way up the top force F is read larger by 4 gauge_hysteresis F (1 - F/F_max), F_max the highest: by gauge_hysteresis F_max at most.
    gauge_hysteresis: float = 0.0
    # The top force is that of an earlier plate position, this far back [m]; it catches up where the plate rests.
    force_lag: float = 0.0
    # As soon as the plate moves, the top force is read larger on the way down and smaller on the way up, by guide_friction F_max.
    guide_friction: float = 0.0
    force_saturation: float = 0.0  # a contact force f is read as f/(1 + force_saturation f) [1/N]
    height_bias: float = 0.0  # heights of grains and contacts over the floor are read (1 + height_bias) times too large
    lost_contacts: float = 0.0  # fraction of the contacts between grains that are not seen, whatever their force


def measured(truth: Recording, instrument: Instrument, seed: int) -> Recording:
    """`truth` as the instrument reads it, in the form of an experiment that was read.

    Normal noise on positions (anew in each scan), on diameters and on the size of contact forces; contact points err with the centres beside
    them; contacts below the threshold are gone. Lengths are read too large from the middle of the floor. Of the walls' forces the top force is
    read without noise, the others are the sums of the contacts seen; what an experiment does not know (energies, overlaps, packing fraction) is
    NaN. The noise depends on the seed and on what is measured (scan, grain, partner) only: of two similar packings it is alike.
    """
    scans, grains = truth.scans, len(truth.diameter)
    frames = np.arange(len(scans))
    noise = keyed_normals(seed, MEASURED_DIAMETERS, np.arange(grains), 0)
    shift = _shifts(instrument, seed, frames, grains)
    centre = np.array([0.5 * truth.box.size_x, 0.5 * truth.box.size_y, 0])
    position = tuple(_stretched(instrument, centre, at) + shift[k] if len(at) else NO_VECTORS for k, at in enumerate(scans.position))
    contacts = tuple(_seen(scans.contacts, instrument, seed, centre, shift))
    unknown: dict[str, Any] = {name: np.full(np.shape(getattr(scans, name)), np.nan) for name in (
        "kinetic_energy", "elastic_energy", "wall_work", "weight_work", "damping_loss", "friction_loss", "drag_loss", "energy_error",
        "rate_error", "packing_fraction", "max_overlap", "stress", "fabric", "coordination_number", "mean_force", "branch_length",
        "wall_force")}
    seen = Scans(frame=frames, cycle=scans.cycle, phase=scans.phase, settled=np.ones(len(scans), bool),
                 time=scans.time if truth.has_programme else np.full(len(scans), np.nan), plate_z=scans.plate_z + instrument.strain_offset,
                 strain=np.zeros((len(scans), 6)), position=position, rotation=(NO_VECTORS,) * len(scans), contacts=contacts, **unknown)
    seen.wall_force[:, Wall.plate, 2] = _top_force(truth, instrument)
    seen = with_contact_averages(seen, truth.box, grains, instrument.stated.force_threshold)
    return replace(truth, diameter=truth.diameter + instrument.stated.diameter_error * noise, scans=seen, species=np.zeros(0, int),
                   species_names=())


def _shifts(instrument: Instrument, seed: int, frames: Ints, grains: int) -> Floats:
    """(S, N, 3) errors of the grains' centres [m]."""
    shape = len(frames), grains, 3
    error = instrument.stated.position_error
    if not error > 0:
        return np.zeros(shape)
    return error * keyed_normals(seed, MEASURED_POSITIONS, frames[:, np.newaxis], np.arange(3 * grains)).reshape(shape)


def _stretched(instrument: Instrument, centre: Floats, point: Floats) -> Floats:
    return centre + (1 + instrument.position_bias) * np.array([1, 1, 1 + instrument.height_bias]) * (point - centre)


def _seen(contacts: tuple[Contacts, ...], instrument: Instrument, seed: int, centre: Floats, shift: Floats) -> list[Contacts]:
    """Of each scan. The point of a contact has the mean error of its two centres; at a wall, that of the grain."""
    frame = np.repeat(np.arange(len(contacts)), [len(one) for one in contacts])
    if not len(frame):
        return list(contacts)
    grain, partner, point, force = (np.concatenate([getattr(one, name) for one in contacts]) for name in ("grain", "partner", "point", "force"))
    gain = np.full(len(frame), 1 + instrument.force_bias)
    pair = grain.astype(np.uint64) << np.uint64(32) | partner.astype(np.int32).view(np.uint32).astype(np.uint64)
    if instrument.stated.force_error > 0:
        gain *= 1 + instrument.stated.force_error * keyed_normals(seed, MEASURED_FORCES, frame, pair)
    gain = np.maximum(gain, 0)  # errors do not reverse a force
    force = force * (gain / (1 + instrument.force_saturation * lengths(force)))[:, np.newaxis]
    there = lengths(force) >= instrument.stated.force_threshold + instrument.threshold_shift
    if instrument.lost_contacts > 0:
        from scipy.special import ndtri  # pages, which list the effects, do without it
        there &= (partner < 0) | (keyed_normals(seed, SEEN_CONTACTS, frame, pair) >= ndtri(instrument.lost_contacts))
    frame, grain, partner, force = frame[there], grain[there], partner[there], force[there]
    error = shift[frame, grain]
    grains = partner >= 0
    error[grains] += 0.5 * (shift[frame[grains], partner[grains]] - error[grains])
    point = _stretched(instrument, centre, point[there]) + error
    ends = np.cumsum(np.bincount(frame, minlength=len(contacts)))
    all_of_them = Contacts(grain, partner, point, force, np.full(len(frame), np.nan))
    return [all_of_them.rows(slice(begin, end)) for begin, end in zip([0, *ends[:-1]], ends)]


def _top_force(truth: Recording, instrument: Instrument) -> Floats:
    """(S,) as the load cell reads it [N]."""
    scans = truth.scans
    if not len(scans):
        return np.zeros(0)
    path = np.cumsum(np.abs(np.diff(scans.plate_z, prepend=truth.plate_start)))  # of the plate up to each scan [m]
    stroke = truth.plate_start - min(truth.plate_start, scans.plate_z.min())
    part = path / (2 * stroke * (scans.cycle[-1] + 1)) if stroke > 0 else path  # a recording may end before its last cycle is complete
    highest = max(0.0, scans.top_force.max())
    force = _late(scans.top_force, path, instrument.force_lag)
    read = (1 + instrument.gauge_drift * part) * force + instrument.zero_drift * part * highest
    unloads = scans.phase == Phase.unload
    if highest > 0:
        read = read + np.where(unloads, 4 * instrument.gauge_hysteresis * force * (1 - force / highest), 0)
    read = read + np.where(part > 0, np.where(unloads, -1, 1) * instrument.guide_friction * highest, 0)
    return np.asarray(read, float)


def _late(force: Floats, path: Floats, lag: float) -> Floats:
    """(S,) the force as it was the way `lag` of the plate before, linear between scans. It has caught up where the plate rests."""
    late = force.copy()
    if lag == 0:
        return late
    for s in range(1, len(force)):
        if path[s] == path[s - 1]:
            continue
        after = s  # the scan after the point that is read
        while after > 1 and path[after - 1] >= path[s] - lag:
            after -= 1
        step = path[after] - path[after - 1]
        part = min(1.0, (path[after] - path[s] + lag) / step) if step else 1.0
        late[s] = force[after] + part * (force[after - 1] - force[after])
    return late
