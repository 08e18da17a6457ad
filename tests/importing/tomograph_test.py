"""From images to a verdict: grains with cross-contact deformation are imaged, segmented by SPAM, imported and diagnosed with a scene without it.

tomograph_test.py PROGRAM SPAM_PYTHON; exit code 77: SPAM_PYTHON has no module spam (scripts/setup --full installs it).
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from mcdem.experiment.read import read_experiment
from mcdem.results import read_run

SCENE = """name = "small"
[box]
size_x = 0.08
size_y = 0.08
[contact]
model = "independent"
[packing]
count = 60
packing_fraction = 0.54
[plate]
start = 0.092
end = 0.076
speed = 0.05
[protocol]
scans_per_stroke = 8
rate_tolerance = 0
scan_at_start = true
relax_time = 0.1
"""
VOXEL = 9e-4  # a grain is 20 voxels wide
TOMOGRAPHS = (0, 2, 4, 6, 8, 12)  # at rest, at a quarter, half, three quarters and all of the stroke, at half of the way back
# Errors of centres and diameters that SPAM finds in these images, and their common part: 0.04, 0.04 and 0.03 voxels.
ERRORS = {"measurement.position_error": 3.5e-5, "measurement.diameter_error": 4e-5, "uncertainty.diameter": 3e-5}

program, python = map(pathlib.Path, sys.argv[1:3])
if not python.exists() or subprocess.run([python, "-c", "import spam.kalisphera"], capture_output=True).returncode:
    print(f"skipped: no module spam in {python} (pip install spam)")
    sys.exit(77)
kept = tempfile.TemporaryDirectory(prefix="mcdem-tomograph-")
folder = pathlib.Path(kept.name)


def call(*words):
    done = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


(folder / "small.toml").write_text(SCENE)
call(program, "run", "small.toml", "--out", "true", "--no-figures", "--set", "contact.model=mc_dem", "--set", "contact.gamma=1")
truth = read_run(folder / "true", positions=True).recordings[0]
scans = truth.scans
np.savez(folder / "frames.npz", position=np.stack([scans.position[k] for k in TOMOGRAPHS]) / VOXEL, diameter=truth.diameter / VOXEL,
         number=TOMOGRAPHS, shape=np.ceil(np.array([truth.plate_start, 0.08, 0.08]) / VOXEL).astype(int))
call(python, pathlib.Path(__file__).with_name("segment.py"), "frames.npz", ".")
rows = [f"{k},{z},{force}\n" for k, (z, force) in enumerate(zip(scans.plate_z, scans.top_force))]
(folder / "plate.csv").write_text("frame,plate_z_m,top_force_N\n" + "".join(rows))

stated = {"box.size": "[0.08, 0.08]", "plate.start": truth.plate_start, "grains.youngs_modulus": 23300, "walls.youngs_modulus": 50e6} | ERRORS
call(program, "experiment", "import", "plate.csv", *sorted(folder.glob("grains_*.csv")), "--voxel-size", VOXEL,
     *(word for key, value in stated.items() for word in ("--set", f"{key}={value}")), "--out", "lab")
measured = read_experiment(folder / "lab").recording
order = np.linalg.norm(measured.scans.position[0][:, None] - scans.position[0], axis=2).argmin(axis=0)  # of the true grains
assert len(set(order)) == len(measured.diameter) == 60, order
for k in TOMOGRAPHS:  # linked though SPAM's labels count anew
    off = np.sqrt(np.mean((measured.scans.position[k][order] - scans.position[k])**2))
    assert off < 1.5 * ERRORS["measurement.position_error"], (k, off)
check = call(program, "experiment", "check", "lab")
assert "who touches (by overlap), overlaps, local packing fractions and displacements of grains" in " ".join(check.split()), check

call(program, "diagnose", "small.toml", "--experiment", "lab", "--out", "told", "--replicates", 12, "--pairs", 3, "--confirmations", 4,
     "--candidates", "cross_contact,stiffening,friction,adhesion,diameter_error,plate_compliance")
told = json.loads((folder / "told/diagnosis.json").read_text())
named = {cause["effect"]: cause for cause in told["causes"]}
print(told["verdict"], {name: (cause["amplitude"], cause["amplitude_error"]) for name, cause in named.items()})
assert told["verdict"] in ("effect", "group") and "cross_contact" in named, told["verdict"]
assert any("measure contact forces" in step["what"] for step in told["next"]), told["next"]
