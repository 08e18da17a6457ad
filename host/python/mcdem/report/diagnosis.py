"""Reads diagnosis.json."""
import pathlib

from ..diagnosis.diagnosis_types import Diagnosis, Verdict
from ..errors import InputError
from ..files import read_input
from ..checked_json import Invalid, object_of, parsed


def read_diagnosis(file: str | pathlib.Path) -> Diagnosis:
    """Reads diagnosis.json. Raises InputError that names the file and the first invalid value, and OSError."""
    return diagnosis_of(read_input(file), str(file))


def diagnosis_of(content: bytes, where: str) -> Diagnosis:
    """The diagnosis in the content of a file, which `where` names. Raises InputError."""
    try:
        diagnosis = object_of(Diagnosis, parsed(content))
        if diagnosis.verdict not in list(Verdict):
            raise Invalid(f"unknown verdict: {diagnosis.verdict}")
    except Invalid as problem:
        raise InputError(f"{where}: must be a diagnosis.json that `mcdem diagnose` wrote; {problem}") from problem
    return diagnosis
