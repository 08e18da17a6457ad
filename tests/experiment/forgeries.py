"""Changes of run.h5 that others can make: of its first replica, with checksums as the program writes them."""
import h5py
import numpy as np

SCANS, CONTACTS, PARTICLES = "observables/replica_00000", "contacts/replica_00000", "particles/replica_00000"
MOTION = [f"{PARTICLES}/{what}/{table}" for what in ("position", "rotation") for table in ("value", "step", "time")]


def forge(file, change):
    with h5py.File(file, "r+") as run:
        change(run)


def number(field, at, value):
    """A change of one number of the scans."""
    def change(run):
        rows = run[SCANS][:]
        rows[field][at] = value
        run[SCANS][:] = rows

    return change


def contact(change):
    """A change of the contacts of scan 3 as a structured array."""
    def change_table(run):
        rows, first = run[f"{CONTACTS}/contact"][:], run[f"{CONTACTS}/offset"][3]
        change(rows[first:])
        run[f"{CONTACTS}/contact"][:] = rows

    return change_table


def value(table, at, value):
    def change(run):
        run[f"{PARTICLES}/{table}"][at] = value

    return change


def attribute(group, name, change):
    def change_attribute(run):
        run[f"{PARTICLES}/{group}"].attrs[name] = change(run[f"{PARTICLES}/{group}"].attrs[name])

    return change_attribute


def edge(axis, length):
    return attribute("box", "edges", lambda edges: np.where(np.arange(3) == axis, length, edges))


def label(text):
    return attribute("", "label", lambda _: np.bytes_(text))


def parameter(key, text):
    def change(run):
        rows = run["parameters/replica_00000"][:]
        rows[rows[:, 0] == key.encode(), 1] = text.encode()
        run["parameters/replica_00000"][:] = rows

    return change


def replaced(run, name, values):
    del run[name]
    shape = values.shape[1:]
    run.create_dataset(name, data=values, fletcher32=True, chunks=(max(len(values), 1), *shape), maxshape=(None, *shape))


def without_positions_in_the_middle(run):
    for name in MOTION:
        replaced(run, name, np.delete(run[name][:], 2, axis=0))


def without_grains(run):
    for name in MOTION:
        replaced(run, name, run[name][:0])
    replaced(run, f"{PARTICLES}/diameter", np.zeros(0))
    replaced(run, f"{CONTACTS}/contact", run[f"{CONTACTS}/contact"][:0])
    run[f"{CONTACTS}/offset"][:] = 0


def contact_with_itself(rows):
    rows["partner"][0] = rows["grain"][0]


def contact_far_away(rows):
    rows["point"][0, 0] = 5


def contact_twice(rows):
    rows[1] = rows[0]


def contact_of_no_size(rows):
    rows["force"][0] *= 1e30


FORGERIES = {
    "grain outside": value("position/value", (1, 2, 0), 3),
    "grain under the floor": value("position/value", (0, 0, 2), -1),
    "plate under the floor": number("plate_z", 1, -0.01),
    "plate far up": number("plate_z", 1, 1e9),
    "force beyond all": number("wall_force", (1, 5, 2), 1e300),
    "cycle falls": number("cycle", 0, 7),
    "cycle below zero": number("cycle", 0, -7),
    "contact far away": contact(contact_far_away),
    "contact with itself": contact(contact_with_itself),
    "contact twice": contact(contact_twice),
    "contact of no size": contact(contact_of_no_size),
    "grains of a kilometre": value("diameter", 1, 1e3),
    "box of a kilometre": edge(0, 1e3),
    "no positions in the middle": without_positions_in_the_middle,
    "modulus below zero": parameter("grains.youngs_modulus", "-5"),
    "ratio of two": parameter("grains.poisson_ratio", "2"),
    "plate starts at the floor": edge(2, 1e-30),
    "label of many lines": label(b'a\nb"\x01\t#'),
    "label that is no text": label(b"\xff\xfe"),
}
