"""ParaView opens and draws an export, following the README.txt of the export.

paraview_test.py PROGRAM SOURCE [PICTURE]; PICTURE: file for the drawing. Exit code 77: no ParaView.
"""
import json
import pathlib
import shutil
import subprocess

import numpy as np

from exported import Exported, arguments, scan_of, skip

for tool, package in (("pvpython", "paraview"), ("xvfb-run", "xvfb")):
    if not shutil.which(tool):
        skip(f"{tool} is not there (Debian: {package})")

program, source, more = arguments()
exported = Exported(program, source, "vtk")
picture = more[0] if more else str(exported.folder / "paraview.png")
replica = sorted(exported.view.glob("replica_*"))[-1]
number = replica.name[:len("replica_00000")]
# -noreset: otherwise the server restarts between clients and refuses connections in the meantime.
done = subprocess.run(["xvfb-run", "-a", "--server-args=-screen 0 1280x1024x24 -noreset", "pvpython",
                       str(pathlib.Path(__file__).parent / "render_paraview.py"), str(replica), picture],
                      capture_output=True, text=True, timeout=300)
assert done.returncode == 0 and "ERR|" not in done.stdout + done.stderr, done.stdout + done.stderr
said = json.loads(done.stdout.splitlines()[-1])

with exported.open() as file:
    scans = len(file[f"observables/{number}"])
    position, contacts, _ = scan_of(file, number, scans - 1)
    diameter = file[f"particles/{number}/diameter"][:]
assert said["scans"] == scans and said["grains"] == len(position) and said["contacts"] == len(contacts), said
strongest = np.linalg.norm(contacts["force"].astype(float), axis=1).max()
assert abs(said["strongest"] / strongest - 1) < 1e-6, (said, strongest)
wide = (position[:, 0] + diameter / 2).max() - (position[:, 0] - diameter / 2).min()
assert abs(said["spheres_wide"] / wide - 1) < 0.02, (said, wide)  # the drawn spheres have flat faces
assert said["tubes"] >= len(contacts), said
assert said["arrows"] == len(contacts) and said["walls"] == 6, said

import matplotlib.image  # noqa: E402  after the skips
colours = np.round(matplotlib.image.imread(picture)[:, :, :3] * 15).reshape(-1, 3)
assert len(np.unique(colours, axis=0)) > 50, "the picture shows next to nothing"
