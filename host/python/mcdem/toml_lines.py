"""TOML with the line of each value, which the reader of Python does not tell."""
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

Where = tuple[str | int, ...]  # names of tables and keys, and numbers of elements from 0: ("programme", 0, "force")

DEEPEST = 100  # the reader is recursive, and its time is quadratic in the parts of a name
LONGEST = 1000  # characters of a number or of a name without quotes
WHOLE = 2 ** 63  # whole numbers of TOML are below

# Strings (of text that is no TOML, up to the end of their line or of the text), comments, signs, and words between them. Nothing is
# required after a repetition, so that the time is linear.
TOKEN = re.compile(r'''
    "{3} (?: [^"\\]+ | \\. | "{1,2}(?!") )* (?: "{3,5} )? | '{3} (?: [^']+ | '{1,2}(?!') )* (?: '{3,5} )?
    | " (?: [^"\\\n]+ | \\. )* "? | ' [^'\n]* '? | \# [^\n]* | [][{}=,.\n] | [^][{}=,.\s"'#]+
    ''', re.DOTALL | re.VERBOSE)


class TomlError(ValueError):
    """Text that is no TOML."""

    def __init__(self, line: int, what: str) -> None:
        super().__init__(what)
        self.line, self.what = line, what


@dataclass(frozen=True, eq=False)
class Document:
    """The root table, and the lines of its tables and values where they begin, from 1."""

    root: dict[str, Any] = field(default_factory=dict)
    lines: dict[Where, int] = field(default_factory=dict)

    def at(self, where: Where) -> Any:
        """The value there; None if there is none."""
        value: Any = self.root
        for part in where:
            value = value.get(part) if isinstance(value, dict) else None
        return value

    def replace(self, names: tuple[str, ...], value: Any) -> None:
        """Puts in a value, which has no line. Raises KeyError with the name of what is no table."""
        table = self.root
        for name in names[:-1]:
            table = table.setdefault(name, {})
            if not isinstance(table, dict):
                raise KeyError(name)
        table[names[-1]] = value
        for old in [where for where in self.lines if where[:len(names)] == names]:
            del self.lines[old]


def parse(text: str) -> Document:
    """Raises TomlError."""
    tokens = list(_tokens(text))
    _expect_readable(tokens)
    try:
        root = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        place = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)$", str(error))
        line = int(place[1]) if place and place[1] else text.count("\n") + 1
        raise TomlError(line, f"must be TOML, got: {str(error)[:place.start() if place else None]}") from None
    lines = _Lines(tokens).lines
    _expect_64_bits(root, (), lines)
    return Document(root, lines)


def parse_value(text: str) -> Any:
    """The value that TOML text means; the text itself where it is no TOML."""
    try:
        return parse(f"value = {text}").root["value"]
    except TomlError:
        return text


def _tokens(text: str) -> Iterator[tuple[str, int]]:
    """Each token with the line where it begins; comments are left out."""
    line = 1
    for found in TOKEN.finditer(text):
        if not found[0].startswith("#"):
            yield found[0], line
        line += found[0].count("\n")


def _expect_readable(tokens: list[tuple[str, int]]) -> None:
    """Counts the parts of dotted names, the open brackets and the characters of words."""
    outside = list[int]()  # depth outside each open bracket
    depth = dots = dots_of_key = 0
    for token, line in tokens:
        if token == ".":
            dots += 1
        elif token == "=":
            dots_of_key, dots = dots, 0
        elif token in ("[", "{"):
            outside.append(depth)
            depth += dots_of_key + 1
            dots_of_key = dots = 0
        elif token in ("]", "}") and outside:
            depth, dots = outside.pop(), 0
        elif token in (",", "\n"):
            dots = dots_of_key = 0
        if len(token) > LONGEST and token[0] not in "\"'":
            raise TomlError(line, f"must be TOML, got a number or a name of more than {LONGEST} characters")
        if depth + dots >= DEEPEST:
            raise TomlError(line, f"names must have at most {DEEPEST} parts, and values must be nested at most {DEEPEST} deep")


def _expect_64_bits(value: Any, where: Where, lines: dict[Where, int]) -> None:
    """Python has whole numbers of any length."""
    if isinstance(value, int) and not -WHOLE <= value < WHOLE:
        raise TomlError(lines.get(where, 1), f"must be TOML, got a whole number that is not between -2^63 and 2^63: {hex(value)[:20]}..")
    for key, inside in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        _expect_64_bits(inside, (*where, key), lines)


class _Lines:
    """The lines of a valid document."""

    def __init__(self, tokens: list[tuple[str, int]]) -> None:
        self.tokens = [*tokens, ("\n", 0)]
        self.at = 0
        self.lines: dict[Where, int] = {}
        self.elements: dict[Where, int] = {}  # numbers of tables in lists that [[..]] make
        table: Where = ()
        while self.at < len(self.tokens):
            if self.token == "[":
                table = self.header()
            elif self.token == "\n":
                self.at += 1
            else:
                self.pair(table)

    @property
    def token(self) -> str:
        return self.tokens[self.at][0]

    def next(self) -> tuple[str, int]:
        self.at += 1
        return self.tokens[self.at - 1]

    def name(self, end: str) -> list[str]:
        """The parts of a dotted name, up to and with the sign that follows it."""
        parts = list[str]()
        while (token := self.next()[0]) != end:
            if token != ".":
                parts.append(next(iter(tomllib.loads(f"{token} = 0"))) if token[0] in "\"'" else token)
        return parts

    def header(self) -> Where:
        """[name] or [[name]]. Returns the table whose keys follow."""
        line = self.next()[1]
        is_list = self.token == "["
        self.at += is_list
        *outer, last = self.name("]")
        self.at += is_list
        where: Where = ()
        for part in outer:
            where = (*where, part)
            self.lines.setdefault(where, line)
            if where in self.elements:
                where = (*where, self.elements[where] - 1)
        where = (*where, last)
        if is_list:
            self.lines.setdefault(where, line)
            number = self.elements.get(where, 0)
            self.elements[where] = number + 1
            where = (*where, number)
        self.lines[where] = line
        return where

    def pair(self, table: Where) -> None:
        """name = value"""
        line = self.tokens[self.at][1]
        *outer, last = self.name("=")
        where = table
        for part in outer:
            where = (*where, part)
            self.lines.setdefault(where, line)
        self.value((*where, last))

    def value(self, where: Where) -> None:
        first, self.lines[where] = self.next()
        number = 0
        while first in ("[", "{") and self.token not in ("]", "}"):
            if self.token in (",", "\n"):
                self.at += 1
            elif first == "{":
                self.pair(where)
            else:
                self.value((*where, number))
                number += 1
        if first in ("[", "{"):
            self.at += 1
        while self.token not in (",", "\n", "]", "}"):  # of a number or a date
            self.at += 1
