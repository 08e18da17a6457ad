"""Recordings from a few values."""
import numpy as np

from mcdem.results.names import Wall
from mcdem.results.recording import NO_CONTACTS, NO_VECTORS, Recording, Scans
from mcdem.results.run_file import KINDS, ROW_SHAPES, SCAN_FIELDS


def recording_of(label, box, plate_start, diameter, *, plate_z, top_force, cycle=0, phase=0, position=(), contacts=(), parameters=(),
                 **more):
    """`position`: by scan, [] or missing where unknown; `contacts`: by number of the scan. Other values are NaN."""
    count = len(plate_z)
    values = {name: np.full((count, *ROW_SHAPES.get(name, ())), 0 if name in KINDS else np.nan, KINDS.get(name, float))
              for name in SCAN_FIELDS}
    values["frame"], values["plate_z"] = np.arange(count), np.array(plate_z, float)
    values["cycle"], values["phase"] = (np.broadcast_to(np.array(one, np.int64), count).copy() for one in (cycle, phase))
    values["wall_force"][:, Wall.plate, 2] = top_force
    known = [np.array(one, float).reshape(-1, 3) for one in position]
    scans = Scans(**values, position=(*known, *(NO_VECTORS,) * (count - len(known))), rotation=(NO_VECTORS,) * count,
                  contacts=tuple(dict(contacts).get(scan, NO_CONTACTS) for scan in range(count)))
    return Recording(label, dict(parameters), box, plate_start, np.array(diameter, float), scans, **more)
