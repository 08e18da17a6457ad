"""Fits that take rounds."""
import pathlib
from collections.abc import Callable
from typing import Any, TypeVar

from ..json_text import json_text
from ..outputs import Kind, replace_own
from ..program import say
from ..progress import Progress

Found = TypeVar("Found")


def told_and_kept(progress: Progress, words: Callable[[Found], str], file: pathlib.Path | None, kind: Kind,
                  document: Callable[[Found], dict[str, Any]]) -> Callable[[Found], None]:
    """What a fit calls after each round with what it has found so far: tells it, and replaces the file, if there is one, with its document."""
    def after_round(found: Found) -> None:
        progress.clear()
        say(words(found))
        if file:
            replace_own(file, kind, json_text(document(found), sort_keys=True).encode())

    return after_round


def kept_words(folder: pathlib.Path | None) -> str:
    """What an interruption keeps of a fit with this folder."""
    return "trials are kept; run the same command again to continue" if folder else "nothing is kept; --out keeps trials"
