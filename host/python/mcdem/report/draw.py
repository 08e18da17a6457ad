"""Writes figures.json and draws its figures as PDF, PNG and SVG beside it; replaces only figures and values of mcdem."""
import pathlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..outputs import FIGURE, FIGURE_VALUES, expect_replaceable, make_folder, replace_own
from ..program import message_of, say

if TYPE_CHECKING:
    from ..observe.replicas import Setting
    from .figure_data import FigureOptions

VALUES_FILE, KINDS = "figures.json", ("pdf", "png", "svg")
LARGEST_RUN = 1 << 30  # bytes; larger runs are read into memory only on request

Folder = str | pathlib.Path


def expect_replaceable_figures(folder: Folder, names: Iterable[str]) -> None:
    """Raises InputError if figures.json or a figure with one of these names exists and was not written by mcdem."""
    expect_replaceable(pathlib.Path(folder, VALUES_FILE), FIGURE_VALUES)
    for name in names:
        for kind in KINDS:
            expect_replaceable(pathlib.Path(folder, f"{name}.{kind}"), FIGURE)


def draw_file(file: Folder) -> None:
    """Draws every figure of a figures.json into its folder, in the style of mcdem, without a display."""
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    from mcdem import figures
    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # ignores the user's settings
        for name in figures.read(file):
            axes = getattr(figures, name)(file)
            for kind in KINDS:
                figures.save(axes, pathlib.Path(file).parent / f"{name}.{kind}")
            plt.close("all")


def draw_figures(folder: Folder, values: Mapping[str, Any]) -> list[pathlib.Path]:
    """Writes values as figures.json into the folder, which must exist, and draws them. Returns the PNG files. Raises InputError."""
    from .figure_values import figure_file
    expect_replaceable_figures(folder, values)
    file = pathlib.Path(folder, VALUES_FILE)
    replace_own(file, FIGURE_VALUES, figure_file(values))
    draw_file(file)
    return [pathlib.Path(folder, f"{name}.png") for name in values]


def draw_runs(folder: Folder, settings: "Sequence[Setting]", reference: "Setting | None" = None,
              options: "FigureOptions | None" = None) -> list[pathlib.Path]:
    """Draws runs with a reference, and says which figures are not available. Creates the folder. Returns the PNG files."""
    from .figure_data import FigureOptions
    from .run_figures import run_figures
    make_folder(folder)
    prepared = run_figures(settings, reference, options or FigureOptions())
    for missing in prepared.missing:
        say(f"no figure of {missing}")
    return draw_figures(folder, {figure.name: figure.values() for figure in prepared.figures})


def draw_if_possible(draw: Callable[[], list[pathlib.Path]]) -> list[pathlib.Path]:
    """For commands with other results: errors are only reported."""
    try:
        return draw()
    except Exception as error:
        say(f"no figures: {message_of(error)}")
        return []
