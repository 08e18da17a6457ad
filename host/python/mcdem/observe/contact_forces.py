"""Magnitudes of the contact forces in scans."""
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..results.recording import Floats, Recording


@dataclass(frozen=True, eq=False)
class ForceLists:
    """|f| [N] of contacts between grains and with walls, scan after scan."""

    grain_grain: Floats
    grain_wall: Floats
    scans: int  # number of scans whose contacts were recorded


def contact_forces(recording: Recording, scans: Iterable[int]) -> ForceLists:
    """Of these scans (rows) of a recording. Scans without recorded contacts and forces that are not finite are left out."""
    known = [row for row in scans if len(recording.scans.contacts[row]) or recording.scans.coordination_number[row] == 0]
    contacts = [recording.scans.contacts[row] for row in known]
    force = np.linalg.norm(np.concatenate([one.force for one in contacts] or [np.zeros((0, 3))]), axis=1)
    is_wall = np.concatenate([one.is_wall for one in contacts] or [np.zeros(0, bool)])
    finite = np.isfinite(force)
    return ForceLists(force[finite & ~is_wall], force[finite & is_wall], len(known))
