"""Figures for print of runs, comparisons, diagnoses, convergence studies and challenges, drawn with matplotlib.

    axes = mcdem.figures.top_force("out/small")
    axes.set_xlim(0, 20)
    mcdem.figures.save(axes, "top_force.pdf")

There is one function per figure. Its first argument is a folder written by a command, or the file `figures.json` in it, which
contains all values; these functions only draw them. `axes`: axes to draw into; by default new ones with the size of the figure in
print. Functions return the axes, or an array of axes if a figure has several.
"""
from .challenge import confidence, confusion, power
from .convergence import convergence
from .diagnosis import how_far, where, which
from .runs import (cell_coordination, coordination, displacement_time, force_displacement, force_distribution, force_time,
                   pressure_strain, pressure_time, scaling, shear_strain_time, shear_stress_strain, shear_stress_time,
                   stress_path, top_force, volume_time)
from .style import COLUMN, PAGE, STYLE, new_axes, save
from .values import read

__all__ = ["COLUMN", "PAGE", "STYLE", "cell_coordination", "confidence", "confusion", "convergence", "coordination",
           "displacement_time", "force_displacement", "force_distribution", "force_time", "how_far", "new_axes", "power",
           "pressure_strain", "pressure_time", "read", "save", "scaling", "shear_strain_time", "shear_stress_strain",
           "shear_stress_time", "stress_path", "top_force", "volume_time", "where", "which"]
