#!/usr/bin/python3
"""Draws the top force of every replica against plate displacement: plot_top_force.py RUN [OUT.png]"""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from run_file import arguments, displacement, label, open_run

path, picture = arguments(__doc__, "top_force.png")
figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
with open_run(path) as run:
    replicas = list(run["observables"])
    for i, replica in enumerate(replicas):
        scans = run["observables"][replica][:]
        stroke, force = 1e3 * displacement(run, replica), scans["wall_force"][:, 5, 2]
        loading = scans["phase"] == 0
        colour = plt.cm.viridis(i / max(len(replicas) - 1, 1))
        name = label(run, replica) if len(replicas) <= 12 else None
        axes.plot(stroke[loading], force[loading], "o-", ms=3, color=colour, label=name)
        axes.plot(stroke[~loading], force[~loading], "o--", ms=3, color=colour, mfc="white")
axes.set_xlabel("plate displacement [mm]")
axes.set_ylabel("top force [N]")
axes.set_title("loading: solid lines, unloading: dashed", fontsize="medium")
if len(replicas) <= 12:
    axes.legend(fontsize="small")
figure.savefig(picture, dpi=150)
print(picture)
