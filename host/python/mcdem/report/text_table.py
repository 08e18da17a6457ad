"""Text tables: aligned for a terminal, or Markdown."""
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from .labels import one_line

Align = Literal["left", "right"]
ESCAPED = str.maketrans({character: "\\" + character for character in r"|\`*[<"})


@dataclass(frozen=True)
class Column:
    """Its title and on which side its cells are aligned."""

    title: str
    align: Align = "right"


@dataclass(frozen=True)
class TextTable:
    """`rows` have as many cells as there are columns; `notes` are printed below."""

    columns: Sequence[Column]
    rows: list[list[str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def to_text(table: TextTable, markdown: bool = False) -> str:
    """The table for a terminal, or as Markdown."""
    lines = [_prepared(cells, markdown) for cells in ([column.title for column in table.columns], *table.rows)]
    widths = [max(3, *map(width_of, column)) for column in zip(*lines, strict=True)]
    sides = [column.align for column in table.columns]
    lines = [[_padded(*cell) for cell in zip(cells, widths, sides, strict=True)] for cells in lines]
    lines.insert(1, [_rule(width, side, markdown) for width, side in zip(widths, sides, strict=True)])
    notes = [("- " if markdown else "  ") + note for note in _prepared(table.notes, markdown)]
    return "".join(line + "\n" for line in [*(_line(cells, markdown) for cells in lines), *([""] if notes else []), *notes])


def width_of(text: str) -> int:
    """Number of characters, each assumed to be one column wide; bytes that are no UTF-8 count where they begin one."""
    return sum(not 0xDC80 <= ord(character) < 0xDCC0 for character in text)


def _prepared(cells: Sequence[str], markdown: bool) -> list[str]:
    return [one_line(cell).translate(ESCAPED) if markdown else one_line(cell) for cell in cells]


def _padded(cell: str, width: int, side: Align) -> str:
    blanks = " " * (width - width_of(cell))
    return cell + blanks if side == "left" else blanks + cell


def _rule(width: int, side: Align, markdown: bool) -> str:
    if not markdown:
        return "─" * width
    return ":" + "-" * (width - 1) if side == "left" else "-" * (width - 1) + ":"


def _line(cells: Sequence[str], markdown: bool) -> str:
    return "|" + "".join(f" {cell} |" for cell in cells) if markdown else "  ".join(cells).rstrip(" ")
