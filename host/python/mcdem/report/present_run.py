"""Prints the forces of a finished run and draws its figures: python3 -m mcdem.report.present_run FOLDER."""
import os
import sys
from collections.abc import Sequence

from ..number_text import mm
from ..observe.model_table import model_table
from ..observe.programmes import with_programme
from ..observe.replicas import Setting, group_by_setting
from ..program import say
from ..results import read_run
from .draw import LARGEST_RUN, draw_if_possible, draw_runs
from .estimate_text import with_error
from .run_tables import table_of_models
from .text_table import to_text


def present(folder: str) -> None:
    """Prints the table of the models, or the force of a single setting, and the files that are there. Raises InputError, RunError."""
    is_large = os.stat(os.path.join(folder, "run.h5")).st_size > LARGEST_RUN
    settings = group_by_setting(read_run(folder, contacts=not is_large))
    _print_forces(with_programme(settings, False))
    if is_large:
        say(f"no figures of so large a run: `mcdem figures {folder} --out DIR` draws them")
    figures = [] if is_large else draw_if_possible(lambda: draw_runs(folder, settings))
    print("\nwrote")
    for file in (os.path.join(folder, "run.h5"), os.path.join(folder, "plate.csv"), *figures):
        print(f"  {file}")


def _print_forces(settings: Sequence[Setting]) -> None:
    if not settings:
        return
    models = model_table(settings)
    if any(row.model != models.rows[0].model for row in models.rows):
        print(f"\n{to_text(table_of_models(models))}", end="", flush=True)
    elif len(models.rows) == 1 and models.rows[0].top_force.available():
        row = models.rows[0]
        where = row.reached if row.reached is not None else models.displacement
        print(f"force on the plate: {with_error(row.top_force, 2)} N at {mm(where)} mm", flush=True)


if __name__ == "__main__":
    present(sys.argv[1])
