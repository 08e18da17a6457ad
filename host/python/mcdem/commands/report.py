"""mcdem report: an HTML page of runs and diagnoses."""
import argparse
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import InputError
from ..program import say
from .command_line import output_path, whole_in
from .sources import add_figure_options, add_reference_options, figure_options, load_runs, reference_of

if TYPE_CHECKING:
    from ..report.page import Page

EPILOG = """\
The page is one file and needs no network. It shows top force, force distribution, coordination number and
scaling law as interactive charts, the packing with its force chains and a slider over scans, the results of
diagnoses, the metrics, and the scenes with versions and hashes.
The first replica of every setting is shown in 3D. Charts need a browser of 2023 or later.
Examples:
  mcdem report out/small --out out/small.html
  mcdem report out/small out/diagnosis --out out/both.html --against out/measured"""

def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("sources", metavar="RUN|DIAGNOSIS", nargs="+",
                        help="Result folders or files, of finished or running simulations, and diagnosis folders")
    parser.add_argument("--out", metavar="FILE", type=output_path, required=True, help="HTML file to write")
    add_reference_options(parser, "--against", "Experiment folder or run to compare the runs with; several are used together")
    add_figure_options(parser)
    parser.add_argument("--scans", metavar="N", type=whole_in(1, 100_000),
                        help="Maximum number of scans of a packing shown in 3D; default: as many as fit into about 3 MB")


def run(options: argparse.Namespace) -> int:
    write_report(options)
    print(options.out)
    return 0


def write_report(options: argparse.Namespace) -> None:
    from ..outputs import PAGE, expect_replaceable, make_folder
    expect_replaceable(options.out, PAGE)
    make_folder(os.path.dirname(options.out) or ".")
    from ..report.diagnosis import read_diagnosis
    from ..report.diagnosis_page import add_diagnosis
    from ..report.page import Page  # before minutes of reading, because plotly may not be there
    from ..report.report_sources import diagnosis_file
    files = {source: diagnosis_file(source) for source in options.sources}
    diagnoses = [(source, read_diagnosis(file)) for source in options.sources if (file := files[source])]
    runs = [source for source in options.sources if not files[source]]
    if not runs and options.against:
        raise InputError("--against: needs a run to compare with it, got diagnoses only")
    more = len(options.sources) - 1
    page = Page(f"mcdem report: {options.sources[0]}" + (f" and {more} more" if more else ""))
    if runs:
        _add_runs(page, runs, options)
    for source, diagnosis in diagnoses:
        add_diagnosis(page, diagnosis, source)
    page.write(options.out)


def _add_runs(page: "Page", paths: Sequence[str], options: argparse.Namespace) -> None:
    from ..report.packing_view import PackingLimits
    from ..report.report_sources import origins_of, shown_packings
    from ..report.run_page import RunsOnPage, add_runs
    loaded, reference = load_runs(paths, contacts=True, first_positions=True), reference_of(options)
    limits = PackingLimits(options.scans)
    packings, left_out = shown_packings(loaded.settings, limits)
    for note in left_out:
        say(note)
    add_runs(page, RunsOnPage(origins_of(paths, loaded.runs), loaded.settings, reference, figure_options(options), packings, left_out,
                              limits))
