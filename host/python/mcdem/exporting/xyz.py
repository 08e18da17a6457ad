"""Grains as extended XYZ, which OVITO, ASE and others read, and the contacts between grains as `dump local` of LAMMPS."""
import itertools

import numpy as np

from ..files import new_file
from ..outputs import Kind, expect_replaceable

GUIDE_NAME = "OVITO.txt"
GUIDE = """replica_*.xyz            grains, one frame a scan, SI units (extended XYZ)
replica_*.contacts.dump  contacts between grains, the same frames (LAMMPS dump local)

OVITO: load a .xyz file. For contacts as bonds add the modifier "Load trajectory", open the .contacts.dump file in it
and name its columns: Particle Identifiers.1, Particle Identifiers.2, force_magnitude, force_x, force_y, force_z,
overlap. Colour and width of the bonds can follow force_magnitude [N]. In Python:

    from ovito.io import import_file
    from ovito.modifiers import LoadTrajectoryModifier
    pipeline = import_file("NAME.xyz")
    contacts = LoadTrajectoryModifier()
    contacts.source.load("NAME.contacts.dump", columns=["Particle Identifiers.1",
        "Particle Identifiers.2", "force_magnitude", "force_x", "force_y", "force_z", "overlap"])
    pipeline.modifiers.append(contacts)

Of a grain: its species as particle type (column element; in ASE an array of that name), radius [m], id, coordination_number (walls counted), force_magnitude (sum of its contacts' [N]), wall_force
(by the walls [N]). In a container that is periodic along x and y grains are where they have moved to, also out of it:
modifier "Wrap at periodic boundaries". In a cell they are in an upright box of its lengths. Of a contact: its force on the first of the two grains [N], its overlap [m].

The replicas here, each a NAME, with the scene keys that are not the same in all of the run:
"""

# The column of the species is called `element`: OVITO takes it for the particle type as it takes `species`, which ASE requires to be
# a chemical element.
PROPERTIES = "element:S:1:pos:R:3:id:I:1:radius:R:1:coordination_number:I:1:force_magnitude:R:1:wall_force:R:3"
GRAIN = "%s %.9g %.9g %.9g %d %.9g %d %.9g %.9g %.9g %.9g\n"
ENTRIES = "ITEM: ENTRIES grain partner force_magnitude fx fy fz overlap\n"
CONTACT = "%d %d %.9g %.9g %.9g %.9g %.9g\n"


def export_replica(replica, folder, is_chosen):
    """Writes both files of a replica and returns their number: 0 if no chosen scan has positions."""
    scans = (scan for scan in replica.scans() if is_chosen(scan) and scan.position is not None)
    first = next(scans, None)
    if first is None:
        return 0
    xyz, dump = (folder / (replica.file_name + ending) for ending in (".xyz", ".contacts.dump"))
    expect_replaceable(xyz, Kind("an export", b"", PROPERTIES.encode()))
    expect_replaceable(dump, Kind("an export", b"ITEM: TIMESTEP\n", ENTRIES.encode()))
    with new_file(xyz) as grains_out, new_file(dump) as contacts_out:
        for scan in itertools.chain([first], scans):
            grains_out.write(grains_frame(scan).encode("utf-8", "surrogateescape"))
            contacts_out.write(contacts_frame(scan).encode())
    return 2


def single_words(names):
    """The names of species without blanks, each different from the others: two that become alike get their number."""
    words = ["_".join(name.split()) for name in names]
    while len(set(words)) < len(words):
        words = [word if words.count(word) == 1 else f"{word}_{number}" for number, word in enumerate(words)]
    return words


def rows(form, *columns):
    """A line of text for each row; a column has one or several values a row."""
    split = [part.tolist() for column in columns for part in np.atleast_2d(np.asarray(column).T)]
    return "".join(map(form.__mod__, zip(*split)))


def numbers(values):
    return " ".join(f"{value:.9g}" for value in values)


def grains_frame(scan):
    replica, contacts = scan.replica, scan.contacts
    count = len(scan.position)
    names = np.array(single_words(replica.species_names), object)
    types = np.full(count, "X", object) if replica.species is None else names[replica.species]
    periodic = {"cell": "T T T", "periodic": "T T F"}.get(replica.shape, "F F F")
    label = replica.label.replace('"', "'").replace("\n", " ")  # extended XYZ cannot represent a double quote
    return (f'{count}\nLattice="{numbers(scan.cell.T.ravel())}" Origin="0 0 0" pbc="{periodic}" Properties={PROPERTIES} '
            f"Time={scan.time:.9g} frame={scan.frame} cycle={scan.cycle} phase={scan.phase} plate_z={scan.plate_z:.9g} "
            f'top_force={scan.top_force:.9g} label="{label}"\n'
            + rows(GRAIN, types, scan.position, np.arange(count), replica.diameter / 2, contacts.coordination_number(),
                   contacts.force_magnitude(), contacts.wall_force()))


def dump_bounds(scan):
    """As LAMMPS writes them: for a tilted cell, the bounding box."""
    (size_x, xy, xz), (_, size_y, yz), (_, _, height) = scan.cell
    if not scan.replica.is_cell:
        sides = "pp pp" if scan.replica.shape == "periodic" else "ff ff"
        return f"ITEM: BOX BOUNDS {sides} ff\n0 {size_x:.9g}\n0 {size_y:.9g}\n0 {height:.9g}\n"
    ends = (0.0, xy, xz, xy + xz)
    return ("ITEM: BOX BOUNDS xy xz yz pp pp pp\n"
            f"{numbers([min(ends), size_x + max(ends), xy])}\n{numbers([min(0.0, yz), size_y + max(0.0, yz), xz])}\n"
            f"{numbers([0, height, yz])}\n")


def contacts_frame(scan):
    contacts, pairs = scan.contacts, scan.contacts.is_pair
    return (f"ITEM: TIMESTEP\n{scan.frame}\nITEM: NUMBER OF ENTRIES\n{pairs.sum()}\n{dump_bounds(scan)}{ENTRIES}"
            + rows(CONTACT, contacts.grain[pairs], contacts.partner[pairs], contacts.magnitude[pairs], contacts.force[pairs],
                   contacts.overlap[pairs]))
