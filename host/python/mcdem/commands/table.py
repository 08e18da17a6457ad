"""mcdem table: tables of runs."""
import argparse

from ..errors import InputError
from ..observe.model_table import model_table
from ..observe.programmes import with_programme
from ..report.run_tables import csv_of_models, table_of_models, table_of_scaling
from ..report.scan_tables import csv_of_scans, tables_of_scans
from ..report.text_table import to_text
from .sources import add_runs_option, load_runs

EPILOG = """\
Ratios are paired by packing if replicas start from the same one; ± is the standard error over
replicas. *: no replica reached full stroke; the last scan and its displacement are shown.
Examples:
  mcdem table out/small
  mcdem table out/small --over independent --markdown
  mcdem table out/small --csv > models.csv"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_runs_option(parser)
    parser.add_argument("--over", metavar="LABEL", default="", help="Label of the setting that ratios refer to (default: mc_dem)")
    parser.add_argument("--markdown", action="store_true", help="Print Markdown")
    parser.add_argument("--csv", action="store_true", help="Print CSV: top forces and ratios, for programmes scan by scan, with a column "
                                                           "for each scene key that varies")


def run(options: argparse.Namespace) -> int:
    settings = load_runs(options.RUN).settings
    programmes, strokes = with_programme(settings, True), with_programme(settings, False)
    if options.csv and programmes:
        if strokes:
            raise InputError("--csv: programmes and strokes have different columns; give the runs one by one")
        print(csv_of_scans(programmes), end="")
        return 0
    for table in tables_of_scans(programmes):
        print(to_text(table, options.markdown))
    if not strokes:
        return 0
    models = model_table(strokes, options.over or None)
    if options.csv:
        print(csv_of_models(models, strokes), end="")
        return 0
    print(to_text(table_of_models(models), options.markdown))
    print(to_text(table_of_scaling(strokes), options.markdown), end="")
    return 0
