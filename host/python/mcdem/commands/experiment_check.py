"""mcdem experiment check: which data an experiment contains, which are missing and which are suspicious."""
import argparse
import pathlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

from .command_line import output_path

if TYPE_CHECKING:
    from ..experiment.experiment import Experiment

EPILOG = """\
The last lines say what must be added before `mcdem diagnose` accepts the folder.
The exit code is 0 if the folder can be read, and 2 if it cannot.
Example:
  mcdem experiment check out/lab"""

LINE = 110  # length
TITLES = {"note": "available data", "missing": "missing data, and what they would show", "odd": "suspicious data"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("DIR", type=output_path, help="Experiment folder")


def run(options: argparse.Namespace) -> int:
    from ..experiment.read import read_experiment
    print(*_lines(read_experiment(pathlib.Path(options.DIR))), sep="\n")
    return 0


def _lines(experiment: "Experiment") -> Iterator[str]:
    from ..experiment.check import check_experiment
    from ..diagnosis.needed import needed_to_diagnose
    findings = check_experiment(experiment)
    yield experiment.name
    for severity, title in TITLES.items():
        found = [wrapped(f"  {finding.about:<16}", finding.text) for finding in findings if finding.severity.name == severity]
        if found or severity != "note":
            yield f"\n{title}" + ("" if found else ": nothing")
        yield from found
    needed = needed_to_diagnose(experiment)
    yield "\nrequired by `mcdem diagnose` in addition" + ("" if needed else ": nothing")
    yield from (wrapped("  ", text) for text in needed)


def wrapped(head: str, text: str) -> str:
    """Lines of text, all but the first indented to the text."""
    lines, line = list[str](), head
    for word in text.split(" "):
        if len(line) + 1 + len(word) > LINE and len(line) > len(head):
            lines.append(line)
            line = " " * len(head)
        line += (" " if len(line) > len(head) else "") + word
    return "\n".join([*lines, line])
