#!/usr/bin/python3
"""Draws the packing from the side with its contact forces, at the strongest scan of the first replica:
force_chains.py RUN [OUT.png]"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from run_file import arguments, displacement, label, open_run

path, picture = arguments(__doc__, "force_chains.png")
with open_run(path) as run:
    replica = next(iter(run["observables"]))
    particles, table = run["particles"][replica], run["contacts"][replica]
    step = particles["position/step"][:] if "position" in particles else np.array([], int)
    offset = table["offset"][:]
    drawable = [s for s in step if offset[s + 1] > offset[s]]  # positions and contacts both recorded
    if not drawable:
        sys.exit(f"{path}: no scan of {replica} has positions and contacts; record both to see force chains")
    scans = run["observables"][replica][:]
    best = drawable[np.argmax(scans["wall_force"][drawable, 5, 2])]
    position = particles["position/value"][int(np.flatnonzero(step == best)[0])].astype(float)
    contacts = table["contact"][offset[best]:offset[best + 1]]
    diameter, (width, depth, _) = particles["diameter"][:], particles["box"].attrs["edges"]
    shape = particles["box"].attrs.get("shape", b"box").decode()
    title = f"{label(run, replica)}: plate {1e3 * displacement(run, replica)[best]:.1f} mm down"
    plate_z = scans["plate_z"][best]

grain, partner = contacts["grain"], contacts["partner"]
start = position[grain]
end = position[np.maximum(partner, 0)]
if shape == "periodic":  # the partner's nearest image
    cell = np.array([width, depth, np.inf])
    end = end - np.where(np.isfinite(cell), cell, 0) * np.round((end - start) / cell)
# Walls: the foot of the perpendicular. Partner -1 - wall, walls x_min x_max y_min y_max floor plate.
for wall, (axis, place) in enumerate([(0, 0), (0, width), (1, 0), (1, depth), (2, 0), (2, plate_z)]):
    at_wall = partner == -1 - wall
    end[at_wall] = start[at_wall]
    end[at_wall, axis] = place
    if shape == "cylinder" and wall == 0:  # its side
        out = start[at_wall, :2] - width / 2
        end[at_wall, :2] = width / 2 * (1 + out / np.linalg.norm(out, axis=1, keepdims=True))
force = np.linalg.norm(contacts["force"], axis=1)
order = np.argsort(force)  # the strongest on top
lines = np.stack([start, end], axis=1)[order][:, :, [0, 2]] * 1e3
scale = max(np.percentile(force, 99), 1e-30)

figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
axes.add_collection(EllipseCollection(diameter * 1e3, diameter * 1e3, 0, units="xy", offsets=position[:, [0, 2]] * 1e3,
                                      transOffset=axes.transData, facecolors="0.93", edgecolors="0.75", linewidths=0.4))
chains = LineCollection(lines, array=force[order] * 1e3, cmap="inferno_r", clim=(0, scale * 1e3),
                        linewidths=0.2 + 5 * np.minimum(force[order] / scale, 1))
axes.add_collection(chains)
axes.axhline(plate_z * 1e3, color="k", lw=2)
axes.set(xlim=(0, width * 1e3), ylim=(0, plate_z * 1e3 * 1.05), aspect="equal", xlabel="x [mm]", ylabel="z [mm]", title=title)
figure.colorbar(chains, label="contact force [mN]")
figure.savefig(picture, dpi=150)
print(picture)
