"""Prints a diagnosis and writes what shows it beside diagnosis.json."""
import json
import os
from typing import Any

from ..diagnosis.diagnosis_types import Diagnosis
from ..errors import InputError
from ..files import read_whole
from ..json_text import json_text
from ..outputs import DIAGNOSIS, replace_own
from ..program import message_of, say
from .diagnosis import diagnosis_of
from .diagnosis_text import diagnosis_text
from .diagnosis_values import diagnosis_figure_values
from .draw import draw_figures, draw_if_possible
from .verdict import verdict_words

FILE = "diagnosis.json"


def present(folder: str | os.PathLike[str], page: bool = True, figures: bool = True) -> None:
    """Prints the text and the files that are there, writes diagnosis.html and figures, and adds the verdict's sentence to
    diagnosis.json if it lacks it. Raises InputError, RunError and OSError; figures that cannot be drawn are only reported."""
    diagnosis, _ = completed(folder)
    print(f"{diagnosis_text(diagnosis)}\nwrote\n  {os.path.join(folder, FILE)}", flush=True)
    if page:
        _write_page_if_possible(diagnosis, folder)
    if figures:
        for figure in draw_if_possible(lambda: draw_figures(os.fspath(folder), diagnosis_figure_values(diagnosis))):
            print(f"  {figure}")


def _write_page_if_possible(diagnosis: Diagnosis, folder: str | os.PathLike[str]) -> None:
    """As figures: errors are only reported, but for a file of others in its place."""
    try:
        print(f"  {write_page(diagnosis, folder)}", flush=True)
    except InputError:
        raise
    except Exception as error:
        say(f"no page: {message_of(error)}")


def completed(folder: str | os.PathLike[str]) -> tuple[Diagnosis, dict[str, Any]]:
    """The diagnosis in the folder, and its document; diagnosis.json has the verdict's sentence afterwards.

    Raises InputError, RunError, OSError."""
    file = os.path.join(folder, FILE)
    content = read_whole(file)
    diagnosis = diagnosis_of(content, file)
    return diagnosis, _with_sentence(file, json.loads(content.decode("utf-8-sig")), diagnosis)


def write_page(diagnosis: Diagnosis, folder: str | os.PathLike[str]) -> str:
    """Writes diagnosis.html and returns its path. Raises InputError, RunError."""
    from .diagnosis_page import write_diagnosis_page
    page = os.path.join(folder, "diagnosis.html")
    write_diagnosis_page(diagnosis, page)
    return page


def _with_sentence(file: str, document: dict[str, Any], diagnosis: Diagnosis) -> dict[str, Any]:
    """Writes the file again if the sentence was missing."""
    if "sentence" in document:
        return document
    written = {}
    for key, value in document.items():  # at its documented place
        written[key] = value
        if key == "seconds":
            written["sentence"] = verdict_words(diagnosis).sentence
    replace_own(file, DIAGNOSIS, json_text(written).encode())
    return written
