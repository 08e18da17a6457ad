"""Collected problems of the user's input; numbers and words for messages."""
import math
import re

from ..errors import InputError

MAX_TOLD = 20  # maximum number of reported problems
NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)  # one way to match: in linear time


class Problems:
    def __init__(self):
        self.first, self.told, self.count = [], set(), 0  # told: topics of which one problem is enough

    def add(self, where, what):
        """`where` is a file, or file:line."""
        if not self.full:
            self.first.append(f"{where}: {what}")
        self.count += 1

    @property
    def full(self):
        return self.count >= MAX_TOLD

    def lines(self):
        return self.first + [f".. and {self.count - MAX_TOLD} more"] * (self.count > MAX_TOLD)

    def report(self):
        if self.count:
            raise InputError(self.lines())


def to_number(word):
    """The whole word as a finite number, or None."""
    if not NUMBER.fullmatch(word):
        return None
    value = float(word)
    return value if math.isfinite(value) else None


def is_whole(value):
    return value is not None and abs(value) <= 2e9 and value == round(value)


def number_text(value):
    """The shortest digits that give the same number when read: 17, 0.5."""
    return repr(float(value)).removesuffix(".0")


def quoted(word):
    shown = "".join(c if c.isprintable() else "?" for c in word[:60])
    return f'"{shown}{".." if len(word) > 60 else ""}"'
