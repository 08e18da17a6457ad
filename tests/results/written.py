"""Writes result files with h5py alone, as host/io/README.md describes them: an independent truth for the reader."""
import h5py
import numpy as np

SCAN = np.dtype([("frame", "<i4"), ("cycle", "<i4"), ("phase", "i1"), ("settled", "?"), ("time", "<f8"), ("plate_z", "<f8"),
                 ("wall_force", "<f8", (6, 3)), ("kinetic_energy", "<f8"), ("elastic_energy", "<f8"), ("rate_error", "<f8"),
                 ("wall_work", "<f8"), ("weight_work", "<f8"), ("damping_loss", "<f8"), ("friction_loss", "<f8"), ("drag_loss", "<f8"),
                 ("energy_error", "<f8"), ("coordination_number", "<f8"), ("mean_force", "<f8"), ("packing_fraction", "<f8"),
                 ("branch_length", "<f8"), ("max_overlap", "<f8"), ("stress", "<f8", (3, 3)), ("fabric", "<f8", (3, 3)),
                 ("strain", "<f8", (6,))])
CONTACT = np.dtype([("grain", "<i4"), ("partner", "<i4"), ("point", "<f4", (3,)), ("force", "<f4", (3,)), ("overlap", "<f4")])
GRAINS, SCANS = 4, 3
OFFSET = [0, 2, 2, 5]  # of the contacts of each scan; the second has none


def scans():
    rows = np.zeros(SCANS, SCAN)
    rows["frame"], rows["phase"], rows["settled"] = np.arange(SCANS), [0, 0, 1], [True, False, True]
    rows["plate_z"], rows["time"] = [0.09, 0.08, 0.085], [0.5, 1.5, 2.5]
    rows["wall_force"][:, 5, 2] = [1.25, 3.5, 2.0]
    rows["coordination_number"] = [1.0, 0.0, 2.0]
    rows["stress"] = np.arange(9).reshape(3, 3)
    return rows


def contacts():
    rows = np.zeros(OFFSET[-1], CONTACT)
    rows["grain"], rows["partner"] = [0, 1, 0, 1, 2], [1, -6, 2, 3, -5]
    rows["force"][:, 2] = [1, 2, 3, 4, 5]
    return rows


def write_run(file, replicas=1):
    """Replicas with the scans and contacts above; positions were recorded in the first and last scan."""
    with h5py.File(file, "w", libver=("v110", "v110")) as run:
        write_head(run, replicas)
        for number in range(replicas):
            write_replica(run, f"replica_{number:05}", number)


def write_head(run, replicas):
    head = run.create_group("parameters")
    for name, value in (("name", "made by hand"), ("program", "0.2.0 (test)"), ("device", "none"), ("precision", "float")):
        head.attrs[name] = np.bytes_(value)
    head.attrs["format"], head.attrs["replicas"] = 1, replicas
    add(run, "parameters/scene", np.array([b'name = "made"']))


def add(run, name, values):
    """A table with a checksum, as the program writes it."""
    values = np.asarray(values)
    run.create_dataset(name, data=values, fletcher32=True, chunks=values.shape)


def write_replica(run, name, number):
    add(run, f"parameters/{name}", [[b"contact.model", b"mc_dem"], [b"packing.seed", str(number + 1).encode()],
                                    [b"grains.friction", b"0.25"], [b"contact.friction_law", b"mindlin"]])
    particles = run.create_group(f"particles/{name}")
    particles.attrs["label"] = np.bytes_(f"mc_dem #{number + 1}")
    box = particles.create_group("box")
    box.attrs["edges"], box.attrs["shape"] = [0.05, 0.06, 0.1], np.bytes_("cylinder")
    add(particles, "diameter", np.full(GRAINS, 0.02))
    for what in ("position", "rotation"):
        add(particles, f"{what}/value", np.arange(2 * GRAINS * 3, dtype="<f4").reshape(2, GRAINS, 3))
        add(particles, f"{what}/step", [0, 2])
        add(particles, f"{what}/time", [0.5, 2.5])
    add(run, f"observables/{name}", scans())
    add(run, f"contacts/{name}/contact", contacts())
    add(run, f"contacts/{name}/offset", OFFSET)


def add_species_and_failure(run):
    """To the first replica."""
    particles = run["particles/replica_00000"]
    particles.attrs["failure_cause"], particles.attrs["failure_step"], particles.attrs["failure_grain"] = np.bytes_("why"), 10**12, 3
    particles["species"], particles["species_names"] = [0, 1, 1, 0], np.array([b"soft", b"stiff"])
