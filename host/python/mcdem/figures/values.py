"""Reads figures.json, which the commands write (mcdem/report/figure_values.py)."""
import json
import pathlib
from os import PathLike
from typing import Any

from ..files import read_whole
from ..look import is_folder, is_there
from ..report.figure_values import FORMAT

Source = str | PathLike[str]


def read(source: Source, name: str | None = None) -> dict[str, Any]:
    """Values of the figure `name`; without a name, of all figures in the folder or file."""
    file = pathlib.Path(source)
    if is_folder(file):
        file = file / "figures.json"
    if not is_there(file):
        raise FileNotFoundError(f"{file}: is not there; `mcdem figures RUN --out {file.parent}` writes it for a run, "
                                "`mcdem diagnose`, `converge` and `challenge score` write it beside their results")
    values = json.loads(read_whole(file).decode())
    if not isinstance(values, dict) or values.pop("mcdem_figures", None) != FORMAT:
        raise ValueError(f"{file}: must be a figures.json of this version of mcdem")
    if name is None:
        return values
    if name not in values:
        raise KeyError(f"{file}: has no figure {name}, but {', '.join(values)}")
    found: dict[str, Any] = values[name]
    return found
