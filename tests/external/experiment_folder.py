"""Writes an experiment folder (host/python/mcdem/experiment/README.md) from a simulation by another code, with errors of
measurement."""
import csv
import math
import random

POSITION_ERROR, DIAMETER_ERROR = 1e-4, 2e-5       # [m]
FORCE_ERROR, FORCE_THRESHOLD = 0.05, 0.004        # relative, [N]

SETTINGS = """name = "{name}"
{container}
[plate]
start = {start}
{plate}[grains]
youngs_modulus = 23300.0
poisson_ratio = 0.5
excess_density = 11.5
friction = 0.03
restitution = 0.95
[walls]
youngs_modulus = 50e6
friction = 0.03
[measurement]
position_error = {position}
diameter_error = {diameter}
force_error = {force}
force_threshold = {threshold}
{programme}"""


def write_table(path, columns, rows):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([f"{value:.8g}" if isinstance(value, float) else value for value in row] for row in rows)


def container_text(shape, width):
    if shape == "cylinder":
        return f'[container]\nshape = "cylinder"\nradius = {width / 2}'
    box = f"[box]\nsize = [{width}, {width}]"
    return box if shape == "box" else f'[container]\nshape = "{shape}"\n{box}'


def write(folder, name, container, scans, seed, programme="", plate=""):
    """`container`: shape and width. `programme`: its stages, if it was not a stroke. `plate`: lines about its motion.

    `scans` as returned by realities.simulate. Noise is drawn for each frame, for diameters once."""
    chance = random.Random(seed)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "experiment.toml").write_text(SETTINGS.format(
        name=name, container=container_text(*container), programme=programme, plate=plate, start=scans[0]["height"],
        position=POSITION_ERROR, diameter=DIAMETER_ERROR, force=FORCE_ERROR, threshold=FORCE_THRESHOLD))
    diameters = [grain[0] + chance.gauss(0, DIAMETER_ERROR) for grain in scans[0]["grains"]]
    plate, grains, contacts = [], [], []
    for frame, scan in enumerate(scans):
        errors = [[chance.gauss(0, POSITION_ERROR) for _ in "xyz"] for _ in diameters]
        plate.append((frame, scan.get("cycle", 0), scan["phase"], scan["height"], scan["top"],
                      *((scan["time"], "" if scan["set"] is None else scan["set"]) if programme else ())))
        for i, (_, *centre) in enumerate(scan["grains"]):
            grains.append((frame, i, *(a + e for a, e in zip(centre, errors[i])), diameters[i]))
        for i, partner, point, force in scan["contacts"]:
            read = [component * (1 + part) for part in [chance.gauss(0, FORCE_ERROR)] for component in force]
            if math.hypot(*read) < FORCE_THRESHOLD:
                continue
            other = errors[i] if isinstance(partner, str) else errors[partner]
            contacts.append((frame, i, partner, *(p + (a + b) / 2 for p, a, b in zip(point, errors[i], other)), *read))
    of_programme = ["time_s", "set_force_N"] if programme else []
    write_table(folder / "plate.csv", ["frame", "cycle", "phase", "plate_z_m", "top_force_N", *of_programme], plate)
    write_table(folder / "grains.csv", ["frame", "grain", "x_m", "y_m", "z_m", "diameter_m"], grains)
    write_table(folder / "contacts.csv", ["frame", "grain", "partner", "x_m", "y_m", "z_m", "fx_N", "fy_N", "fz_N"], contacts)
