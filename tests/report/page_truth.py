"""Expected contents of a page, computed from run.h5 and experiments' tables with numpy only."""
import csv
import dataclasses
import pathlib
import tomllib

import numpy as np

PLATE_SCENE = """
[box]
size_x = 0.06
size_y = 0.06
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.09
end = 0.07
[protocol]
scans_per_stroke = 6
scan_at_start = true
[batch]
replicas = 2
[batch.vary]
"contact.model" = ["independent", "mc_dem"]
"""
CELL_SCENE = """
name = "cell"
[container]
shape = "cell"
size_x = 0.08
size_y = 0.08
[packing]
count = 70
packing_fraction = 0.58
[protocol]
relax_time = 0.02
stop_at_scans = false
[[programme]]
strain = 0.05
rate = 2
scans = 4
[[programme]]
shear_xz = 0.1
rate = 2
scans = 2
[[programme]]
stage = "hold"
time = 0.01
"""

PLATE = 5  # number of the wall in result files
WORDS = {"independent": "Independent contacts", "mc_dem": "MC-DEM"}
PHASES = ("load", "unload")


@dataclasses.dataclass
class Recording:
    """Arrays over scans; for contacts, the forces of each scan [N]."""
    phase: np.ndarray
    displacement_mm: np.ndarray
    top_force: np.ndarray
    between_grains: list
    on_walls: list
    grains: int
    product: np.ndarray | None = None  # <Z><phi><b><f> [N m]


@dataclasses.dataclass
class Curve:
    """Points with the standard error over replicas; NaN for a single replica."""
    x: np.ndarray
    y: np.ndarray
    error: np.ndarray


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def parameters(run, replica):
    return {text(key): text(value) for key, value in run[f"parameters/replica_{replica:05}"][:]}


def contacts_of(run, replica, scan):
    offset = run[f"contacts/replica_{replica:05}/offset"][:]
    return run[f"contacts/replica_{replica:05}/contact"][offset[scan]:offset[scan + 1]]


def forces_of(contacts):
    return np.linalg.norm(contacts["force"].astype(float), axis=1)


def averages_of(contacts, position, grains):
    """Contacts per grain, mean force [N], and mean distance between the centres of touching grains [m]."""
    pairs = contacts[contacts["partner"] >= 0]
    branches = np.linalg.norm(position[pairs["grain"]] - position[pairs["partner"]], axis=1)
    return (len(contacts) + len(pairs)) / grains, forces_of(contacts).mean(), branches.mean()


def recording_of_run(run, replica):
    scans, particles = run[f"observables/replica_{replica:05}"][:], run[f"particles/replica_{replica:05}"]
    position, grains = particles["position/value"][:].astype(float), len(particles["diameter"])
    contacts = [contacts_of(run, replica, scan) for scan in range(len(scans))]
    averages = np.array([averages_of(*of_scan, grains) for of_scan in zip(contacts, position)])
    return Recording(scans["phase"], (particles["box"].attrs["edges"][2] - scans["plate_z"]) * 1e3,
                     scans["wall_force"][:, PLATE, 2],
                     [forces_of(c[c["partner"] >= 0]) for c in contacts],
                     [forces_of(c[c["partner"] < 0]) for c in contacts], grains,
                     averages.prod(axis=1) * scans["packing_fraction"])


def rows_of(file):
    with open(file, newline="") as lines:
        return list(csv.DictReader(lines))


def recording_of_experiment(folder):
    folder = pathlib.Path(folder)
    start = tomllib.loads((folder / "experiment.toml").read_text())["plate"]["start"]
    plate, contacts = rows_of(folder / "plate.csv"), rows_of(folder / "contacts.csv")
    forces = [{True: [], False: []} for _ in plate]
    for row in contacts:
        size = np.sqrt(sum(float(row[f"f{axis}_N"]) ** 2 for axis in "xyz"))
        forces[int(row["frame"])][row["partner"].isdigit()].append(size)
    grains = len({row["grain"] for row in rows_of(folder / "grains.csv")})
    return Recording(np.array([PHASES.index(row["phase"]) for row in plate]),
                     np.array([(start - float(row["plate_z_m"])) * 1e3 for row in plate]),
                     np.array([float(row["top_force_N"]) for row in plate]),
                     [np.array(of_scan[True]) for of_scan in forces],
                     [np.array(of_scan[False]) for of_scan in forces], grains)


def settings_of(run):
    """Recordings by the text for their model, in the file's order."""
    settings = {}
    for replica in range(run["parameters"].attrs["replicas"]):
        words = WORDS[parameters(run, replica)["contact.model"]]
        settings.setdefault(words, []).append(recording_of_run(run, replica))
    return settings


def mean_and_error(values):
    """Mean and standard error over replicas, the first axis."""
    values, count = np.asarray(values, float), len(values)
    error = values.std(axis=0, ddof=1) / np.sqrt(count) if count > 1 else np.full(values.shape[1:], np.nan)
    return values.mean(axis=0), error


def scans_of(recordings, phase):
    """Scans of a phase in order of displacement, the same in all replicas."""
    first = recordings[0]
    scans = np.flatnonzero(first.phase == phase)
    for other in recordings[1:]:
        np.testing.assert_allclose(other.displacement_mm, first.displacement_mm, atol=1e-4)
    return scans[np.argsort(first.displacement_mm[scans])]


def curve(recordings, quantity, phase):
    """Quantity against displacement; unloading starts at the last point of loading."""
    scans = scans_of(recordings, phase)
    if phase == 1:
        scans = np.append(scans, scans_of(recordings, 0)[-1])
    values = [quantity(recording)[scans] for recording in recordings]
    return Curve(recordings[0].displacement_mm[scans], *mean_and_error(values))


def contacts_per_grain(recording, threshold):
    """Contacts per grain with forces of at least the threshold [N]; a contact of two grains counts for both."""
    ends = [2 * (pairs >= threshold).sum() + (walls >= threshold).sum()
            for pairs, walls in zip(recording.between_grains, recording.on_walls)]
    return np.array(ends) / recording.grains


def scaling_curve(recordings, phase):
    scans = scans_of(recordings, phase)
    product, _ = mean_and_error([recording.product[scans] for recording in recordings])
    return Curve(product * 1e3, *mean_and_error([recording.top_force[scans] for recording in recordings]))


def slope_through_zero(curves):
    """Slope of the force over the product [1/m], by least squares."""
    x, y = (np.concatenate([getattr(c, axis) for c in curves]) for axis in "xy")
    return np.linalg.lstsq(x[:, None] * 1e-3, y, rcond=None)[0][0]


def scan_nearest(recordings, displacement_mm):
    scans = scans_of(recordings, 1)
    return scans[np.argmin(abs(recordings[0].displacement_mm[scans] - displacement_mm))]


def distribution_bins(pooled):
    """Bins up to the force that one in a thousand exceeds; their number follows from the smallest sample: 2 n^(2/5), 8
    to 30."""
    largest = max(np.sort(forces)[(len(forces) - 1) * 999 // 1000] for forces in pooled)
    count = min(int(np.clip(int(2 * len(forces) ** 0.4), 8, 30)) for forces in pooled)
    return largest, count


def distributions(sources, displacement_mm):
    """Probability density of the forces between grains while unloading [1/mN] against force [mN], by source."""
    forces = {}
    for name, recordings in sources.items():
        scan = scan_nearest(recordings, displacement_mm)
        forces[name] = [recording.between_grains[scan] for recording in recordings]
    largest, count = distribution_bins([np.concatenate(lists) for lists in forces.values()])
    edges = np.arange(count + 1) * (largest / count)
    densities = {}
    for name, lists in forces.items():
        parts = [np.bincount(np.searchsorted(edges[1:], of_one, side="right"), minlength=count + 1)[:count] / len(of_one)
                 for of_one in lists]
        y, error = mean_and_error(np.array(parts) / (edges[1] * 1e3))
        shown = y > 0
        middles = (edges[:-1] + edges[1:]) / 2 * 1e3
        densities[name] = Curve(middles[shown], y[shown], error[shown])
    return densities


def rms_of_contacts(recordings, references, threshold):
    """RMS difference over all scans; the scans of simulation and reference are the same."""
    simulated = np.mean([contacts_per_grain(r, threshold) for r in recordings], axis=0)
    return np.sqrt(np.mean((simulated - np.mean([contacts_per_grain(r, 0) for r in references], axis=0)) ** 2))


def threshold_near(recordings, references, shown):
    """The threshold [N] at which contacts per grain are closest to the reference; the one displayed as `shown` [N]."""
    forces = np.unique(np.concatenate([f for r in recordings for f in (*r.between_grains, *r.on_walls)]))
    low, high = shown - 4.99e-6, shown + 4.99e-6
    steps = np.concatenate([[low], forces[(forces > low) & (forces < high)], [high]])
    error = {tau: rms_of_contacts(recordings, references, tau) for tau in (steps[1:] + steps[:-1]) / 2}
    best = min(error, key=error.get)
    least = min(rms_of_contacts(recordings, references, tau) for tau in np.append(0, forces))
    assert error[best] <= 1.02 * least + 1e-9, (shown, error[best], least)
    return best


def invariants(rows):
    """p and q [Pa]."""
    stress = (rows["stress"] + rows["stress"].transpose(0, 2, 1)) / 2
    p = np.trace(stress, axis1=1, axis2=2) / 3
    deviator = stress - p[:, None, None] * np.eye(3)
    return p, np.sqrt(1.5 * (deviator ** 2).sum(axis=(1, 2)))
