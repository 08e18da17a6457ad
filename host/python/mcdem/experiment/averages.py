"""Averages over the contacts of each scan."""
from dataclasses import replace

import numpy as np

from ..results.names import Wall
from ..results.recording import Bools, Contacts, Floats, Scans


def average_contacts(scans: Scans, grains: int, force_threshold: float) -> Scans:
    """With wall forces except the plate's, Z, <f> and <b> of the scans that have contacts.

    Forces are those of walls that have any contact: on the others no contacts does not mean no force. The plate's gauge also
    measures contacts below the threshold [N], so the top force stays.
    """
    measured = sorted({-1 - int(partner) for one in scans.contacts for partner in np.unique(one.partner[one.is_wall])})
    wall_force, number, mean_force, branch = (values.copy() for values in (scans.wall_force, scans.coordination_number, scans.mean_force,
                                                                           scans.branch_length))
    for row, one in enumerate(scans.contacts):
        if not len(one):
            continue
        for wall in measured:
            wall_force[row, wall] = -one.force[one.partner == -1 - wall].sum(0)
        wall_force[row, Wall.plate, 2] = scans.top_force[row]
        magnitude = np.linalg.norm(one.force, axis=1)
        counted = ~(magnitude < force_threshold)
        pairs = counted & ~one.is_wall
        number[row] = (counted.sum() + pairs.sum()) / grains
        if counted.any():
            mean_force[row] = magnitude[counted].mean()
        if pairs.any() and len(scans.position[row]):
            branch[row] = _branches(scans.position[row], one, pairs).mean()
    return replace(scans, wall_force=wall_force, coordination_number=number, mean_force=mean_force, branch_length=branch)


def _branches(position: Floats, contacts: Contacts, which: Bools) -> Floats:
    """Distances of centres [m]."""
    return np.asarray(np.linalg.norm(position[contacts.partner[which]] - position[contacts.grain[which]], axis=1))
