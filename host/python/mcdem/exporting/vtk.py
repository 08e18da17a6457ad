"""Grains, contacts and walls as VTKHDF files (unstructured grids, version 1.0: ParaView 5.10, VTK 9.1 or later)."""
import io
import re
import sys

import h5py
import numpy as np

from ..errors import InputError
from ..files import write_whole
from ..look import is_file, is_link, is_there
from ..outputs import Kind, expect_replaceable
from ..results.names import Wall
from .scans import PERIODIC

GUIDE_NAME = "README.txt"
GUIDE = """Grains and contacts for ParaView
================================

A folder a replica, called after its number and label; in it, one file a scan:

grains_000000.hdf, ..     grains
contacts_000000.hdf, ..   contacts, as lines from centre to centre
forces_000000.hdf, ..     the same contacts as points where they are, with their forces
walls_000000.hdf, ..      walls as surfaces; edges where a container repeats

1. Start ParaView (5.10 or later), File > Open, choose the group `grains_..hdf` of a replica (ParaView shows the
   numbered files as one time series), reader `VTKHDF`, Apply.
2. Grains: Filters > Glyph; Glyph Type `Sphere` with Radius 0.5, Orientation Array `No orientation array`,
   Scale Array `diameter`, Scale Factor 1, Glyph Mode `All Points`. Colour by `coordination_number`, `pressure`, a
   component of `stress` or `displacement_since_last_scan`.
3. Contacts: open `contacts_..hdf`, Filters > Extract Surface, then Filters > Tube; Scalars `force_magnitude`, Vary
   Radius `By Scalar`. Colour by `force_magnitude`: the force chains.
4. Arrows: open `forces_..hdf`, Filters > Glyph; Glyph Type `Arrow`, Orientation Array and Scale Array `force`, Glyph
   Mode `All Points`. The force is that on `grain`; its partner feels the opposite one.
5. Walls: open `walls_..hdf`, Apply, Opacity 0.2. Colour by `wall`.

Lengths in metres, forces in newtons, stress in pascals, compression positive. `stress` of a grain has nine components:
xx, xy, xz, yx, .. (row: branch from centre to contact, column: force), over the volume of the undeformed sphere. Each
file carries frame, time, plate_z and top_force as field data, and the strains of a cell. Walls are partners -1 to -6: x_min, x_max, y_min, y_max,
floor, plate. The side of a cylinder is partner -1. In a container that is periodic along x and y grains are where they
have moved to, also out of it; in a cell they are in an upright box of its lengths, and displacements are those beyond
the cell's own motion. Contacts end at a partner's nearest image. The force of `walls` is that of all grains on the
wall, the same on each of its surfaces. `rotation` of a grain is since the start of the run, before the packing relaxes, as
axis times angle in radians. Without output.contacts grains have no coordination_number, force_magnitude, stress and pressure.

The replicas here, with the scene keys that are not the same in all of the run:
"""

CELL_TYPES = np.array([1, 3, 7], np.uint8)  # of VTK: vertex, line, polygon
CURVED_WALL = Wall.x_min
SIDES = 64  # of the polygon that approximates a circle
VERSION = [1, 0]  # of VTKHDF
SCAN_FIELDS = {"frame", "time", "plate_z", "top_force"}  # that all files have


def export_replica(replica, folder, is_chosen):
    """Writes four files for each chosen scan with positions into a folder of the replica, and returns their number. Removes
    numbered files of an earlier export, which ParaView would show in the same time series."""
    folder = folder / replica.file_name
    written = set()
    motion = Motion()
    for scan in replica.scans():
        if scan.position is None:
            continue
        motion.go_on_to(scan)
        if is_chosen(scan):
            folder.mkdir(exist_ok=True)
            grids = {"grains": grains_grid(scan, motion), "contacts": contacts_grid(scan), "forces": forces_grid(scan.contacts),
                     "walls": walls_grid(scan)}
            for what, grid in grids.items():
                file = folder / f"{what}_{scan.frame:06}.hdf"
                expect_replaceable(file, Kind("an export", b"\x89HDF\r\n", b"VTKHDF"))
                if is_there(file) and file.stat().st_size > 0 and not is_own(file):
                    raise InputError(f"{file}: is not an export; it is not replaced: give another path (--out), or remove it first")
                write_whole(file, grid_bytes(scan, *grid))
                written.add(file)
    if written:
        remove_others(folder, written)
    return len(written)


def is_own(file):
    """Whether an export has written it: a grid of this version with the properties of a scan."""
    try:
        with open(file, "rb") as data, h5py.File(data, "r") as grid:
            return list(grid["VTKHDF"].attrs["Version"]) == VERSION and SCAN_FIELDS <= set(grid["VTKHDF/FieldData"])
    except (AttributeError, KeyError, OSError, RuntimeError, TypeError, ValueError):  # of others
        return False


def remove_others(folder, written):
    """Removes the other numbered files of the folder, if an export has written them. Those of others are kept and told, and all
    behind a symbolic link: the folder may be that of something else."""
    for file in sorted(set(folder.iterdir()) - written):
        if re.fullmatch(r"(grains|contacts|forces|walls)_\d*\.hdf", file.name):
            if is_link(folder) or is_link(file):
                why = "is reached by a symbolic link"
            elif not is_file(file) or not is_own(file):
                why = "is not an export"
            else:
                file.unlink()
                continue
            print(f"mcdem: {file}: {why}; it is kept, and ParaView shows it in the same time series", file=sys.stderr)


def grid_bytes(scan, points, sizes, point_data, cell_data):
    """A VTKHDF file of cells with `sizes` points each, in sequence: vertices, lines and polygons. The properties of the scan are field data."""
    fields = {name: getattr(scan, name) for name in sorted(SCAN_FIELDS)}
    if scan.replica.is_cell:
        fields |= zip(("strain_x", "strain_y", "strain_z", "shear_xy", "shear_xz", "shear_yz"), scan.strain)
    tables = {"NumberOfPoints": [len(points)], "NumberOfCells": [len(sizes)], "NumberOfConnectivityIds": [len(points)],
              "Points": points, "Connectivity": np.arange(len(points)), "Offsets": np.cumsum([0, *sizes]),
              "Types": CELL_TYPES[np.clip(sizes, 1, 3).astype(int) - 1]}
    image = io.BytesIO()  # written to disk as a whole, because HDF5 does not recover from a full disk
    with h5py.File(image, "w", libver="v110") as file:
        grid = file.create_group("VTKHDF")
        grid.attrs["Version"] = VERSION
        grid.attrs["Type"] = np.bytes_("UnstructuredGrid")
        groups = {"PointData": point_data, "CellData": cell_data,
                  "FieldData": {name: [float(value)] for name, value in fields.items()}}
        for group in groups:
            grid.create_group(group)
            tables |= {f"{group}/{name}": values for name, values in groups[group].items()}
        for name, values in tables.items():
            values = np.asarray(values)
            grid.create_dataset(name, data=values, maxshape=(None, *values.shape[1:]), compression="gzip", compression_opts=1,
                                shuffle=True, fletcher32=True)
    return image.getbuffer()


class Motion:
    """How far grains have moved, from scan to scan: since the first one, and since the last [m].

    In a `cell`, whose grains are put back into it, a step is the shortest of the periodic images of where a grain would be had it only
    moved with the cell, so grains must move less than half a period between scans. The steps are added: a grain's own way, without
    what the cell's motion adds where it has got to. In other containers positions are continuous."""

    def __init__(self):
        self.last = self.scan = None
        self.total = self.step = 0.0

    def go_on_to(self, scan):
        """The next scan that has positions, whether it is exported or not."""
        self.last = self.scan or scan
        self.scan = scan
        motion = scan.deformation @ np.linalg.inv(self.last.deformation)
        moved = scan.position - self.last.position @ motion.T
        self.step = scan.nearest(moved) if scan.replica.is_cell else moved
        self.total = self.total + self.step


def rotation_since(scan, before):
    """Rotation of each grain since another scan, axis times angle [rad], from unit quaternions."""
    def halves(turn):
        half = np.linalg.norm(turn, axis=1, keepdims=True) / 2
        return np.cos(half), turn / 2 * np.sinc(half / np.pi)

    (w, v), (w_before, v_before) = halves(scan.rotation), halves(before.rotation)
    cosine = w * w_before + (v * v_before).sum(axis=1, keepdims=True)
    vector = w_before * v - w * v_before - np.cross(v, v_before)
    vector = np.where(cosine < 0, -vector, vector)
    sine = np.linalg.norm(vector, axis=1, keepdims=True)
    return vector * np.where(sine > 0, 2 * np.arctan2(sine, abs(cosine)) / np.where(sine > 0, sine, 1), 2)


def grains_grid(scan, motion):
    replica, contacts, last = scan.replica, scan.contacts, motion.last
    count = len(scan.position)
    data = {"grain": np.arange(count, dtype=np.int32), "diameter": replica.diameter}
    if replica.species is not None:
        data["species"] = replica.species
    if scan.knows_contacts:
        stress = contacts.stress()
        data |= {"coordination_number": contacts.coordination_number(), "force_magnitude": contacts.force_magnitude(),
                 "stress": stress.reshape(-1, 9), "pressure": np.trace(stress, axis1=1, axis2=2) / 3}
    data |= {"displacement": motion.total, "displacement_since_last_scan": motion.step}
    if scan.rotation is not None:
        data["rotation"] = scan.rotation
    if scan.rotation is not None and last.rotation is not None:
        data["rotation_since_last_scan"] = rotation_since(scan, last)
    return scan.position, [1] * count, data, {}


def contact_data(contacts):
    normal = contacts.normal_force()
    return {"grain": contacts.grain, "partner": contacts.partner, "force": contacts.force, "force_magnitude": contacts.magnitude,
            "normal_force": normal, "tangential_force": np.sqrt(np.maximum(0, (contacts.force ** 2).sum(axis=1) - normal ** 2)),
            "overlap": contacts.overlap}


def wall_foot(scan, wall, points):
    """Feet of the perpendiculars from points on the walls with these numbers; the plate is level."""
    foot = points.copy()
    size_x, size_y, _ = scan.replica.edges
    foot[np.arange(len(wall)), wall // 2] = np.array([0, size_x, 0, size_y, 0, scan.plate_z])[wall]
    if scan.replica.shape == "cylinder":
        curved = wall == CURVED_WALL
        out = points[curved, :2] - scan.replica.edges[:2] / 2
        away = np.linalg.norm(out, axis=1, keepdims=True)
        towards = np.where(away > 0, out / np.where(away > 0, away, 1), [1, 0])
        foot[curved, :2] = points[curved, :2] + (size_x / 2 - away) * towards
    return foot


def contacts_grid(scan):
    """Lines from the grain's centre to that of its partner, or to the foot on the wall. Forces are also at the ends, because tubes
    take their radius from point data."""
    contacts = scan.contacts
    start = scan.position[contacts.grain]
    end = start + scan.nearest(contacts.partner_position() - start)
    at_wall = ~contacts.is_pair
    end[at_wall] = wall_foot(scan, -1 - contacts.partner[at_wall], start[at_wall])
    count = len(start)
    ends = {"force": contacts.force.repeat(2, axis=0), "force_magnitude": contacts.magnitude.repeat(2)}
    return np.stack([start, end], axis=1).reshape(-1, 3), [2] * count, ends, contact_data(contacts)


def forces_grid(contacts):
    """The same contacts as points at their positions."""
    count = len(contacts.point)
    return contacts.point, [1] * count, contact_data(contacts), {}


def walls_grid(scan):
    """Walls with their numbers and the force by the grains; -1: an edge of a periodic container. Side walls extend from the floor to
    the initial height of the plate; a `cell` is drawn as the upright cell that contains the positions."""
    shape = scan.replica.shape
    size_x, size_y, height = np.diag(scan.cell)
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    corners = np.array([[0, 0, 0], [size_x, 0, 0], [size_x, size_y, 0], [0, size_y, 0]])  # counterclockwise from above
    if shape == "cylinder":
        corners = size_x / 2 * np.stack([1 + np.cos(angle), 1 + np.sin(angle), 0 * angle], axis=1)
    after = np.roll(corners, -1, axis=0)
    if shape != "cell":
        height = max(height, scan.plate_z)
    up = np.array([0, 0, height])
    if PERIODIC[shape]:
        cells = [(-1, [here, here + up]) for here in corners]
    else:
        walls = [CURVED_WALL] * SIDES if shape == "cylinder" else (2, 1, 3, 0)
        cells = [(wall, [here, there, there + up, here + up]) for wall, here, there in zip(walls, corners, after)]
    if shape == "cell":
        cells += [(-1, [here + level, there + level]) for level in (0 * up, up) for here, there in zip(corners, after)]
    else:
        cells += [(Wall.floor, corners), (Wall.plate, corners + [0, 0, scan.plate_z])]
    walls, faces = zip(*cells)
    data = {"wall": np.array(walls, np.int32), "force": [scan.wall_force[wall] if wall >= 0 else np.zeros(3) for wall in walls]}
    return np.concatenate(faces), [len(face) for face in faces], {}, data
