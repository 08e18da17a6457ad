#!/usr/bin/env python3
"""Draws finite_elements.png from finite_elements.txt: python3 tests/truth/finite_elements.py."""
import pathlib
import sys

import matplotlib
import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent.parent / "host/python"))
from mcdem.figures import PAGE, STYLE, new_axes, save  # noqa: E402

# Columns in order, with the colours of the models in all figures.
MODELS = {"Independent": "#0072B2", "Point force on sphere": "#56B4E9", "Sphere to sphere": "#009E73",
          "Half space, gamma = 1": "#E69F00", "MC-DEM, gamma = 1.125": "#D55E00", "Elastic sphere": "#CC79A7",
          "Hyperelastic sphere": "#666666"}
ROWS = [line.split() for line in (FOLDER / "finite_elements.txt").read_text().splitlines() if line.startswith(("linear", "neo-"))]
MATERIALS = {"linear": ("small strain", "Elastic sphere"), "neo-Hookean": ("neo-Hookean", "Hyperelastic sphere")}


def main():
    matplotlib.rcParams.update(STYLE)
    axes = new_axes(PAGE, 130, nrows=2, ncols=4, sharex=True, sharey=True)
    columns = [(material, ratio) for ratio in ("0.3", "0.49") for material in MATERIALS]
    for of_plates, plates in zip(axes, ("two", "six")):
        for place, (material, ratio) in zip(of_plates, columns):
            rows = np.array([row[3:] for row in ROWS if row[:3] == [material, f"{plates}_plates", ratio]], float)
            place.axhline(1, color="#999999", linewidth=0.8, linestyle=(0, (4, 2)))
            for column, (model, colour) in enumerate(MODELS.items(), start=1):
                is_best = model == MATERIALS[material][1]
                place.plot(rows[:, 0], rows[:, column], color=colour, marker="o", markersize=2, linewidth=1.8 if is_best else 0.9,
                           label=model)
            place.set_title(f"{plates} plates, nu {ratio}\n{MATERIALS[material][0]}")
    axes[0, 0].set_xlim(0, 0.155)
    axes[0, 0].set_ylim(0.35, 1.45)
    axes[0, 0].legend(loc="lower left", fontsize=5, handlelength=1.2, labelspacing=0.2)
    axes[0, 0].set_xticks(np.arange(0, 0.16, 0.05))
    for place in axes[1]:
        place.set_xlabel("overlap / radius")
    for place in axes[:, 0]:
        place.set_ylabel("force / finite elements")
    save(axes, FOLDER / "finite_elements.png")


main()
