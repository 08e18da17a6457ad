"""mcdem compare: comparison of runs with a reference as numbers and figures."""
import argparse
import contextlib
from collections.abc import Sequence

from ..observe.compare import Comparison, compare
from ..observe.reference import load_reference
from ..observe.replicas import Setting
from ..report.run_tables import table_of_comparisons
from ..report.text_table import to_text
from .command_line import at_least_zero, output_path
from .sources import add_figure_options, add_reference_options, add_runs_option, figure_options, load_runs, print_figures

EPILOG = """\
Rtop: top force at maximum compression over the reference's. errf: RMS error of the top force.
errZ: RMS error of the coordination number, contacts below tau ignored. bhat: distance of the
distributions of contact forces. An experiment folder is described in host/python/mcdem/experiment/README.md.
Examples (DIR: your experiment folder):
  mcdem compare out/first --against DIR --discard 5 --out out/comparison
  mcdem compare out/small --against out/small --setting mc_dem"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_runs_option(parser)
    add_reference_options(parser, "--against", "Experiment folder or run; several are used together", required=True)
    parser.add_argument("--out", metavar="DIR", type=output_path, help="Folder for the four figures; without it no figures are drawn")
    parser.add_argument("--touch-force", metavar="N", type=at_least_zero,
                        help="For errf, use only displacements at which the reference's top force is above this [N]")
    add_figure_options(parser)
    parser.add_argument("--markdown", action="store_true", help="Print Markdown")


def run(options: argparse.Namespace) -> int:
    reference = load_reference(options.against, options.setting, options.discard, contacts=True)
    settings = load_runs(options.RUN, contacts=True).settings
    with contextlib.ExitStack() as stack:
        if options.out:
            from ..outputs import output_folder
            stack.enter_context(output_folder(options.out))
        comparisons = [compare(setting, reference.replicas, options.touch_force) for setting in settings]
        print(f"against {reference.label}\n\n{to_text(table_of_comparisons(comparisons), options.markdown)}", end="")
        if options.out:
            print()
            _draw(options, settings, reference, comparisons)
    return 0


def _draw(options: argparse.Namespace, settings: Sequence[Setting], reference: Setting, comparisons: Sequence[Comparison]) -> None:
    from ..report.draw import draw_runs
    chosen = figure_options(options, touch_force=options.touch_force, comparisons=tuple(comparisons))
    print_figures(draw_runs(options.out, settings, reference, chosen), options.out)
