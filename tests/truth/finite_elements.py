#!/usr/bin/env python3
"""Draws finite_elements.png from finite_elements.txt: python3 tests/truth/finite_elements.py."""
import pathlib
import sys

import matplotlib
import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent.parent / "host/python"))
from mcdem.figures import PAGE, STYLE, new_axes, save  # noqa: E402

# In the order of the columns, with the colours that models have in all figures.
MODELS = {"Independent": "#0072B2", "Point force on sphere": "#56B4E9", "Sphere to sphere": "#009E73",
          "Half space, gamma = 1": "#E69F00", "MC-DEM, gamma = 1.125": "#D55E00", "Elastic sphere": "#CC79A7"}
ROWS = [line.split() for line in (FOLDER / "finite_elements.txt").read_text().splitlines() if line.startswith(("two_", "six_"))]


def main():
    matplotlib.rcParams.update(STYLE)
    axes = new_axes(PAGE, 130, nrows=2, ncols=2, sharex=True, sharey=True)
    for of_plates, plates in zip(axes, ("two", "six")):
        for place, ratio in zip(of_plates, ("0.3", "0.49")):
            rows = np.array([row[2:] for row in ROWS if row[:2] == [f"{plates}_plates", ratio]], float)
            place.axhline(1, color="#999999", linewidth=0.8, linestyle=(0, (4, 2)))
            for column, (model, colour) in enumerate(MODELS.items(), start=1):
                is_best = model == "Elastic sphere"
                place.plot(rows[:, 0], rows[:, column], color=colour, marker="o", linewidth=1.8 if is_best else 1.1, label=model)
            place.set_title(f"{plates} plates, Poisson ratio {ratio}")
    axes[0, 0].set_xlim(0, 0.155)
    axes[0, 0].set_ylim(0.35, 1.45)
    axes[0, 1].legend(loc="lower left")
    axes[0, 0].set_xticks(np.arange(0, 0.16, 0.05))
    for place in axes[1]:
        place.set_xlabel("overlap / radius")
    for place in axes[:, 0]:
        place.set_ylabel("force / finite elements")
    save(axes, FOLDER / "finite_elements.png")


main()
