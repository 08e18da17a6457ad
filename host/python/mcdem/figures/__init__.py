"""Figures for print of runs, comparisons, diagnoses, what-if tables, convergence studies and challenges, drawn with matplotlib.

    axes = mcdem.figures.top_force("out/small")
    axes.set_xlim(0, 20)
    mcdem.figures.save(axes, "top_force.pdf")

There is one function per figure. Its first argument is a folder written by a command, or the file `figures.json` in it, which
contains all values; these functions only draw them. `axes`: axes to draw into; by default new ones with the size of the figure in
print. Functions return the axes, or an array of axes if a figure has several.
"""
from collections.abc import Callable
from typing import Any

from ..report.figure_values import DEFINITIONS
from .challenge import confidence, confusion, power
from .convergence import convergence
from .diagnosis import how_far, law, where, which
from .runs import figure_function
from .style import COLUMN, PAGE, STYLE, new_axes, save
from .values import read
from .what_if import what_if

globals().update({name: figure_function(name) for name in DEFINITIONS})

__all__ = ["COLUMN", "PAGE", "STYLE", "confidence", "confusion", "convergence", "how_far", "law", "new_axes", "power", "read", "save",
           "what_if", "where", "which", *DEFINITIONS]


def __getattr__(name: str) -> Callable[..., Any]:  # for type checkers: the figures of runs are in no list here
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
