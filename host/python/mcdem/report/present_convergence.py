"""Prints the results of a convergence study and draws its figure: python3 -m mcdem.report.present_convergence FOLDER."""
import os
import sys

from .convergence import convergence_figure_values, read_convergence, table_of_convergence
from .draw import draw_figures, draw_if_possible
from .text_table import to_text


def present(folder: str) -> None:
    """Prints the table and the sentences of convergence.json, and the files that are there. Raises InputError, RunError."""
    file = os.path.join(folder, "convergence.json")
    convergence = read_convergence(file)
    print(to_text(table_of_convergence(convergence)))
    for line in convergence.words:
        print(line)
    print(f"wrote\n  {file}", flush=True)
    for figure in draw_if_possible(lambda: draw_figures(folder, {"convergence": convergence_figure_values(convergence)})):
        print(f"  {figure}")


if __name__ == "__main__":
    present(sys.argv[1])
