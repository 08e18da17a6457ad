"""Runs of the compiled module as plain values."""
from typing import TYPE_CHECKING, Any

import numpy as np

from .names import ContainerShape
from .recording import NO_CONTACTS, Box, Contacts, Failure, Recording, Run, Scans
from .run_file import KINDS, ROW_SHAPES, SCAN_FIELDS

if TYPE_CHECKING:
    from .. import _engine


def run_of(run: "_engine.Run | Run") -> Run:
    """The same run as plain values; a run that is plain is returned as it is.

    Floating-point arrays are read-only views of the run's memory, which they keep alive; whole numbers are copied. Raises TypeError for
    what is no run.
    """
    if isinstance(run, Run):
        return run
    from .. import _engine
    if not isinstance(run, _engine.Run):
        raise TypeError(f"the run must be a Run, got {type(run).__name__}")
    return Run(run.name, run.scene, run.program, run.device, run.precision, tuple(_recording_of(one) for one in run))


def _recording_of(one: "_engine.Recording") -> Recording:
    failure = Failure(one.failure.step, one.failure.grain, one.failure.cause) if one.failure else None
    return Recording(one.label, one._parameter_texts, _box_of(one), one.plate_start, one.diameter, _scans_of(one),
                     one.species.astype(np.int64), tuple(one.species_names), failure)


def _box_of(one: "_engine.Recording") -> Box:
    shape = ContainerShape(one.container)
    return Box(*one.box, shape, one.plate_start if shape == ContainerShape.cell else 0.0)


def _scans_of(one: "_engine.Recording") -> Scans:
    rows = one.scans
    values: dict[str, Any] = {name: np.asarray(getattr(one, name) if name in ROW_SHAPES else rows[name], KINDS.get(name, np.float64))
                              for name in SCAN_FIELDS}
    scans = range(len(rows))
    return Scans(**values, position=tuple(map(one.positions, scans)), rotation=tuple(map(one.rotations, scans)),
                 contacts=tuple(_contacts_of(one.contacts(scan)) for scan in scans))


def _contacts_of(rows: Any) -> Contacts:
    """Of rows with the fields of Contacts."""
    if not len(rows):
        return NO_CONTACTS
    return Contacts(rows["grain"].astype(np.int64), rows["partner"].astype(np.int64), rows["point"], rows["force"], rows["overlap"])
