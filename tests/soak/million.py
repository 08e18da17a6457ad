"""A million grains for a thousand steps: the whole program needs less than 4 GB.

million.py MCDEM [GRAINS]
"""
import pathlib
import resource
import subprocess
import sys
import tempfile

import h5py
import numpy as np

MOST_MEMORY = 4e9  # [bytes]
DIAMETER = 0.02    # [m]
STEPS = 1000
TIME_STEP = 126e-6  # [s]


def write_packing(file, across):
    """Writes a simple cubic lattice, slightly compressed so that every grain has six contacts; returns its edge [m]."""
    edge = 0.99 * DIAMETER
    places = (np.indices((across,) * 3).reshape(3, -1).T + 0.5) * edge
    places += np.random.default_rng(1).normal(0, 1e-3 * DIAMETER, places.shape)
    np.savetxt(file, np.column_stack([places, np.full(len(places), DIAMETER)]), delimiter=",", fmt="%.6f",
               header="x_m,y_m,z_m,diameter_m", comments="")
    return across * edge


def write_scene(file, size):
    """One step is 126 microseconds (0.1 of the Rayleigh time); the plate moves 6.3 mm down and up at 0.1 m/s: 1000
    steps."""
    file.write_text(f"""name = "a million"
[box]
size_x = {size}
size_y = {size}
[packing]
file = "packing.csv"
[plate]
start = {size}
end = {size - 0.0063}
[protocol]
scans_per_stroke = 1
rate_tolerance = 0
relax_time = 0
""")


def steps_of(file):
    """Number of steps up to the last scan, at the end of the last stroke."""
    with h5py.File(file) as run:
        scans = run["observables/replica_00000"]
        assert len(scans) == 2, f"{len(scans)} scans of 2"
        return scans[-1]["time"] / TIME_STEP


def main():
    program = sys.argv[1]
    grains = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
    across = round(grains ** (1 / 3))
    with tempfile.TemporaryDirectory(prefix="mcdem-soak-") as name:
        folder = pathlib.Path(name)
        write_scene(folder / "scene.toml", write_packing(folder / "packing.csv", across))
        done = subprocess.run([program, "run", str(folder / "scene.toml"), "--out", str(folder / "run"), "--no-figures"])
        if done.returncode != 0:
            sys.exit("the run failed")
        steps = steps_of(folder / "run/run.h5")
    used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    print(f"{across ** 3} grains, {steps:.0f} steps: {used / 1e9:.2f} GB at most")
    if abs(steps - STEPS) > 0.02 * STEPS:
        sys.exit(f"{STEPS} steps were wanted")
    if used > MOST_MEMORY * across ** 3 / 1e6:
        sys.exit(f"more than {MOST_MEMORY / 1e9:.0f} GB")


if __name__ == "__main__":
    main()
