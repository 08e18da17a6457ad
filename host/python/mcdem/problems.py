"""Collected problems of the user's input; numbers and words for messages."""
import math
import re

from .errors import InputError

MAX_TOLD = 20  # maximum number of reported problems
NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)  # one way to match: in linear time


class Problems:
    """Problems of a file or a folder in the order in which they are found; those beyond the maximum are only counted."""

    def __init__(self) -> None:
        self.first: list[str] = []
        self.told: set[str] = set()  # topics of which one problem is enough
        self.count = 0

    def add(self, where: str, what: str) -> None:
        """`where` is a file, or file:line."""
        if not self.full:
            self.first.append(f"{where}: {what}")
        self.count += 1

    def add_once(self, topic: str, where: str, what: str) -> None:
        """Adds only one problem for each topic: a column in millimetres is one problem, not one for each line."""
        if topic not in self.told:
            self.told.add(topic)
            self.add(where, what)

    @property
    def full(self) -> bool:
        """True at the maximum."""
        return self.count >= MAX_TOLD

    def lines(self) -> list[str]:
        """All problems, and the number of further ones."""
        return self.first + [f".. and {self.count - MAX_TOLD} more"] * (self.count > MAX_TOLD)

    def report(self) -> None:
        """Raises InputError if there are problems."""
        if self.count:
            raise InputError(self.lines())


def to_number(word: str) -> float | None:
    """The whole word as a finite number, or None."""
    if not NUMBER.fullmatch(word):
        return None
    value = float(word)
    return value if math.isfinite(value) else None


def is_whole(value: float | None) -> bool:
    return value is not None and abs(value) <= 2e9 and value == round(value)


def quoted(word: str, longest: int = 80) -> str:
    """A word for use in messages: short, without control characters."""
    shown = "".join(c if c.isprintable() else "?" for c in word[:longest])
    return f'"{shown}{".." if len(word) > longest else ""}"'
