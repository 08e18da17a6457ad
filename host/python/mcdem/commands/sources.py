"""Options that name runs, references and figures, and what they load."""
import argparse
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ..errors import RunError
from .command_line import at_least_zero, whole_at_least_zero

if TYPE_CHECKING:
    from ..observe.replicas import Setting
    from ..report.figure_data import FigureOptions
    from ..results import Run


def add_runs_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("RUN", nargs="+", help="Result folders or files, of finished or running simulations")


def add_reference_options(parser: argparse.ArgumentParser, name: str, text: str, required: bool = False) -> None:
    """The option `name`, which load_reference gets as `paths`, and those of the setting and the discarded cycles."""
    parser.add_argument(name, metavar="DIR", action="append", required=required, help=text)
    parser.add_argument("--setting", metavar="LABEL", default="",
                        help="Setting of the reference run to compare with, if it has several (default: mc_dem)")
    parser.add_argument("--discard", metavar="CYCLES", type=whole_at_least_zero, default=0,
                        help="Number of first cycles of the experiment to leave out; runs state their own as protocol.discard")


def add_figure_options(parser: argparse.ArgumentParser) -> None:
    """Those that figure_options gets."""
    parser.add_argument("--displacement", metavar="M", type=at_least_zero, default=0.018, dest="distribution_displacement",
                        help="Draw the force distribution at the recorded plate displacement nearest to this one [m]")
    parser.add_argument("--threshold", metavar="N", type=at_least_zero, default=0.0,
                        help="Contact force below which contacts are not counted in the figure of Z if there is no reference [N]")


def figure_options(options: argparse.Namespace, **comparison: Any) -> "FigureOptions":
    """`comparison`: fields of FigureOptions that no option gives."""
    from ..report.figure_data import FigureOptions
    return FigureOptions(distribution_displacement=options.distribution_displacement, threshold=options.threshold, **comparison)


def print_figures(figures: Iterable[str | os.PathLike[str]], out: str) -> None:
    """One path a line. Raises RunError if there are none."""
    drawn = list(figures)
    if not drawn:
        raise RunError(f"{out}: no figures were drawn")
    for figure in drawn:
        print(figure)


@dataclass(frozen=True)
class LoadedRuns:
    """Several runs and their settings."""

    runs: "list[Run]"
    settings: "list[Setting]"


def load_runs(paths: Sequence[str], contacts: bool = False, first_positions: bool = False) -> LoadedRuns:
    """Each path is a result folder or file.

    `first_positions`: reads positions of the first replica of each setting. If there are several runs, the label of every setting
    begins with that of its run. Raises InputError, RunError.
    """
    from ..observe.replicas import group_by_setting
    from ..results import read_run
    runs = [read_run(path, contacts=contacts, positions=_first_replicas(path) if first_positions else False) for path in paths]
    prefixes = [name + ": " for name in names_of(paths)] if len(paths) > 1 else [""]
    return LoadedRuns(runs, [replace(setting, label=prefix + setting.label)
                             for run, prefix in zip(runs, prefixes, strict=True) for setting in group_by_setting(run)])


def _first_replicas(path: str) -> list[int]:
    """The number of the first replica of each setting."""
    from ..observe.replicas import group_by_setting
    from ..results import read_run
    run = read_run(path)
    return [run.recordings.index(setting.replicas[0]) for setting in group_by_setting(run)]


def names_of(paths: Sequence[str]) -> list[str]:
    """Unique names of the runs: the folders' names, or whole paths if those are not unique."""
    names = [_short_name(path) for path in paths]
    return [path if names.count(name) > 1 else name for path, name in zip(paths, names, strict=True)]


def _short_name(path: str) -> str:
    """The folder's name, also for "out/first/" and "out/first/run.h5"."""
    whole = os.path.normpath(path)
    return os.path.basename(os.path.dirname(whole) if os.path.basename(whole) == "run.h5" else whole)


def reference_of(options: argparse.Namespace) -> "Setting | None":
    """What --against names, with contacts."""
    from ..observe.reference import load_reference
    return load_reference(options.against, options.setting, options.discard, contacts=True) if options.against else None
