"""A page of runs: the figures of the paper, the packing in 3D, tables, and provenance."""
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ..observe.compare import compare
from ..observe.model_table import model_table
from ..observe.programmes import are_cells, with_programme
from ..observe.replicas import Setting, seed_of
from ..results import Run
from .charts import run_chart
from .figure_data import FigureOptions
from .packing_view import PackingLimits, ShownPacking, packing_view
from .page import Page
from .run_figures import run_figures
from .run_tables import table_of_comparisons, table_of_energies, table_of_models, table_of_scaling
from .run_words import main_result, new_words, what_was_simulated
from .scan_tables import tables_of_scans

MOST_SEEDS = 12  # that are listed


@dataclass(frozen=True, eq=False)
class RunOrigin:
    """`path` of its folder or file; `digests`: files and their SHA-256."""
    path: str
    run: Run
    digests: Sequence[tuple[str, str]] = ()

    @property
    def name(self) -> str:
        return self.run.name or self.path


@dataclass(frozen=True, eq=False)
class RunsOnPage:
    """`settings` of all runs with their contacts, `reference` for comparison, `left_out` says what of the packings is not shown."""
    origins: Sequence[RunOrigin]
    settings: Sequence[Setting]
    reference: Setting | None = None
    figures: FigureOptions = FigureOptions()
    packings: Sequence[ShownPacking] = ()
    left_out: Sequence[str] = ()
    limits: PackingLimits = field(default_factory=PackingLimits)


def add_runs(page: Page, runs: RunsOnPage) -> None:
    options = runs.figures
    if runs.reference and not options.comparisons:
        options = replace(options, comparisons=tuple(compare(setting, runs.reference.replicas, options.touch_force)
                                                     for setting in runs.settings))
    page.lead("Simulation", ", ".join(origin.name for origin in runs.origins), _head(runs))
    _add_charts(page, runs, options)
    _add_packing(page, runs)
    _add_tables(page, runs, options)
    page.section("Provenance")
    for origin in runs.origins:
        _add_origin(page, origin)


def _head(runs: RunsOnPage) -> str:
    species = new_words(name for origin in runs.origins for recording in origin.run.recordings for name in recording.species_names)
    words = (what_was_simulated(runs.settings), f"Grains of {', '.join(species)}." if species else "",
             f"Compared with {runs.reference.label}." if runs.reference else "", main_result(runs.settings))
    return " ".join(filter(None, words))


def _add_charts(page: Page, runs: RunsOnPage, options: FigureOptions) -> None:
    page.section("Stresses and contacts" if all(are_cells(setting.replicas) for setting in runs.settings) else "Forces and contacts")
    made = run_figures(runs.settings, runs.reference, options)
    for figure in made.figures:
        page.chart(run_chart(figure))
    for missing in made.missing:
        page.paragraph(f"No chart of {missing}.")


def _add_packing(page: Page, runs: RunsOnPage) -> None:
    page.section("The packing in 3D")
    view = packing_view(runs.packings, runs.limits)
    if view is None:
        page.paragraph("No positions recorded: run with output.positions = true to see the packing here.")
        return
    page.packing(view, " ".join((
        "Colour: force. Each line is a contact between two centres; its thickness grows with the force. Drag to rotate, scroll to zoom, "
        "hover for values.", *runs.left_out)))


def _add_tables(page: Page, runs: RunsOnPage, options: FigureOptions) -> None:
    page.section("Metrics")
    if runs.reference and options.comparisons:
        page.table("Against " + runs.reference.label, table_of_comparisons(options.comparisons))
    for table in tables_of_scans(with_programme(runs.settings, True)):
        page.table("Scans", table)
    page.table("Energy budget", table_of_energies(runs.settings))
    if strokes := with_programme(runs.settings, False):
        page.table("Top force", table_of_models(model_table(strokes)))
        page.table("Scaling law", table_of_scaling(strokes))


def _seeds(run: Run) -> str:
    """Seeds of the packings, shortened if there are many."""
    seeds = new_words(filter(None, map(seed_of, run.recordings)))
    more = f" and {len(seeds) - MOST_SEEDS} more" if len(seeds) > MOST_SEEDS else ""
    return ", ".join(seeds[:MOST_SEEDS]) + more if seeds else "not known"


def _add_origin(page: Page, origin: RunOrigin) -> None:
    run = origin.run
    page.subheading(origin.name)
    page.definitions([
        ("results", origin.path), ("program", run.program), ("device", run.device), ("precision", run.precision),
        ("replicas", str(len(run.recordings))), ("packing seeds", _seeds(run)),
        ("SHA-256 of the scene", hashlib.sha256(run.scene.encode("utf-8", "surrogateescape")).hexdigest()),
        *((f"SHA-256 of {file}", digest) for file, digest in origin.digests)])
    page.list([f"{recording.label or 'replica 1'} stopped at {recording.failure.text()}" for recording in run.recordings
               if recording.failure])
    page.folded("The scene, as it was run", run.scene)
