"""convergence.json."""
import dataclasses
import json
import math
import pathlib
import re
from typing import Any

from ..outputs import CONVERGENCE, replace_own
from .convergence_types import Convergence

FILE = "convergence.json"


def _value(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _value(item) for key, item in value.items()}
    if isinstance(value, tuple):
        return [_value(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def convergence_json(convergence: Convergence) -> str:
    """Indented JSON whose keys are the fields. Numbers that are not finite become null; what was invalid UTF-8 becomes replacement
    characters."""
    written = json.dumps(_value(dataclasses.asdict(convergence)), indent=2, ensure_ascii=False, allow_nan=False)
    return re.sub("[\ud800-\udfff]", "\ufffd", written) + "\n"


def write_convergence(convergence: Convergence, folder: pathlib.Path) -> str:
    """Writes the file and returns its content. Raises InputError, RunError."""
    text = convergence_json(convergence)
    replace_own(folder / FILE, CONVERGENCE, text.encode())
    return text
