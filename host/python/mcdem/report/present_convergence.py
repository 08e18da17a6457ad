"""Prints the results of a convergence study and draws its figure."""
import os

from ..convergence.convergence_json import FILE
from ..convergence.convergence_types import Convergence
from .convergence import convergence_figure_values, table_of_convergence
from .draw import draw_figures, draw_if_possible
from .text_table import to_text


def present(convergence: Convergence, folder: str) -> None:
    """Prints table and sentences, and the files of the study in its folder; draws the figure if that is possible. Raises InputError,
    RunError."""
    print(to_text(table_of_convergence(convergence)))
    for line in convergence.words:
        print(line)
    print(f"wrote\n  {os.path.join(folder, FILE)}", flush=True)
    for figure in draw_if_possible(lambda: draw_figures(folder, {"convergence": convergence_figure_values(convergence)})):
        print(f"  {figure}")
