"""What an experiment knows only from its contacts: wall forces, Z, <f> and <b>."""
from dataclasses import replace

import numpy as np

from ..results.names import Wall
from ..results.recording import Box, Floats, Ints, Scans
from .container import apart, lengths


def with_contact_averages(scans: Scans, box: Box, grains: int, force_threshold: float) -> Scans:
    """With wall forces except the plate's, Z, <f> and <b> of the scans that have contacts, from those at or above the threshold [N].

    Forces are those of walls that have any contact: on the others no contacts does not mean no force. The plate's gauge also
    measures contacts below the threshold, so the top force stays.
    """
    count, frame = len(scans), np.repeat(np.arange(len(scans)), [len(one) for one in scans.contacts])
    if not len(frame):
        return scans
    partner, force = (np.concatenate([getattr(one, name) for one in scans.contacts]) for name in ("partner", "force"))
    known = np.bincount(frame, minlength=count) > 0
    wall_force, number = scans.wall_force.copy(), scans.coordination_number.copy()
    for wall in Wall:
        at = partner == -1 - wall
        if at.any():
            sums = [np.bincount(frame[at], force[at, axis], count) for axis in range(3)]
            wall_force[known, wall] = -np.column_stack(sums)[known]
    wall_force[:, Wall.plate, 2] = scans.top_force
    size = lengths(force)
    counted = ~(size < force_threshold)
    number[known] = (np.bincount(frame[counted], np.where(partner[counted] < 0, 1.0, 2.0), count) / grains)[known]
    placed = np.array([len(at) > 0 for at in scans.position])[frame]
    branch = lengths(np.concatenate([apart(box, at[one.grain], at[np.maximum(one.partner, 0)]) if len(at) else np.zeros(one.force.shape)
                                     for at, one in zip(scans.position, scans.contacts)]))
    branches = counted & placed & (partner >= 0)
    return replace(scans, wall_force=wall_force, coordination_number=number,
                   mean_force=_means(scans.mean_force, frame[counted], size[counted]),
                   branch_length=_means(scans.branch_length, frame[branches], branch[branches]))


def _means(before: Floats, frame: Ints, values: Floats) -> Floats:
    """The mean of each frame that has values; of the others what was there before."""
    number = np.bincount(frame, minlength=len(before))
    return np.where(number > 0, np.bincount(frame, values, len(before)) / np.maximum(number, 1), before)
