"""Text tables: aligned for a terminal, or Markdown."""
from collections.abc import Iterable, Sequence
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


def table_of(titles: Sequence[str], rows: Iterable[list[str]], notes: Iterable[str] = ()) -> TextTable:
    """A table whose columns are aligned to the left if their title begins with "<", which is not shown."""
    columns = [Column(title.removeprefix("<"), "left" if title.startswith("<") else "right") for title in titles]
    return TextTable(columns, list(rows), list(notes))


def to_text(table: TextTable, markdown: bool = False) -> str:
    """The table for a terminal, or as Markdown."""
    def prepared(text: str) -> str:
        return one_line(text).translate(ESCAPED) if markdown else one_line(text)

    is_left = [column.align == "left" for column in table.columns]
    lines = [[prepared(cell) for cell in cells] for cells in ([column.title for column in table.columns], *table.rows)]
    widths = [max(3, *map(width_of, column)) for column in zip(*lines, strict=True)]
    lines = [[_padded(*cell) for cell in zip(cells, widths, is_left, strict=True)] for cells in lines]
    lines.insert(1, [_rule(width, left) if markdown else "─" * width for width, left in zip(widths, is_left, strict=True)])
    text = [f"| {' | '.join(cells)} |" if markdown else "  ".join(cells).rstrip(" ") for cells in lines]
    notes = [("- " if markdown else "  ") + prepared(note) for note in table.notes]
    return "".join(line + "\n" for line in [*text, *([""] if notes else []), *notes])


def width_of(text: str) -> int:
    """Number of characters, each assumed to be one column wide; bytes that are no UTF-8 count where they begin one."""
    return sum(not 0xDC80 <= ord(character) < 0xDCC0 for character in text)


def _padded(cell: str, width: int, is_left: bool) -> str:
    blanks = " " * (width - width_of(cell))
    return cell + blanks if is_left else blanks + cell


def _rule(width: int, is_left: bool) -> str:
    dashes = "-" * (width - 1)
    return ":" + dashes if is_left else dashes + ":"
