"""convergence.json."""
import dataclasses
import pathlib

from ..json_text import finite, json_text
from ..outputs import CONVERGENCE, replace_own
from .convergence_types import Convergence

FILE = "convergence.json"


def convergence_json(convergence: Convergence) -> str:
    """JSON whose keys are the fields. Numbers that are not finite become null."""
    return json_text(finite(dataclasses.asdict(convergence)))


def write_convergence(convergence: Convergence, folder: pathlib.Path) -> str:
    """Writes the file and returns its content. Raises InputError, RunError."""
    text = convergence_json(convergence)
    replace_own(folder / FILE, CONVERGENCE, text.encode())
    return text
