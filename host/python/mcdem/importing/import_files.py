"""Files of a laboratory or another program, with or without a mapping, to the tables of an experiment; prints what each is taken for."""
import sys
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ..errors import InputError
from ..look import is_there
from .assemble import Imported, import_tables
from .guess import guess_tables, mapping_of, read_import_tables, wrong_rows
from .mapping import KEYS, Known, MappedTable, mapping_text, unclear_entries
from .read_mapping import parse_mapping, text_of_mapping
from .record import picture_of
from .rows import ImportTable, of_role

LINE = 110


@dataclass
class Attempt:
    """The mapping and the tables, or without them the problems that the mapping, or corrected tables, must solve."""

    mapping: str  # text of mapping.toml
    imported: Imported | None
    problems: list[str] = field(default_factory=list)
    has_wrong_rows: bool = False
    picture: bytes | None = None  # PNG of what was understood of a testing machine's record


def import_files(files: Sequence[str], known: Known, kept: str, given: str, settings_problems: Sequence[str]) -> Attempt:
    """Reads the files, or those of the mapping file `given` if that is not empty; otherwise guesses their mapping, for the file `kept`.

    `settings_problems`: those of the known values, which are told with the others. Raises InputError for what no mapping can solve.
    """
    tables, text = _tables_of(files, known, kept, given)
    mapping = mapping_of(tables)
    if files or known.stated:
        text = mapping_text(mapping)
    _print_mapping(mapping)
    if not given:
        attempt = _attempt(tables, known, text, [*unclear_entries(text, kept), *settings_problems])
        return replace(attempt, picture=_picture(tables))
    if settings_problems:
        raise InputError(settings_problems)
    _expect_kept(kept, text)
    return Attempt(text, import_tables(tables, known), picture=_picture(tables))


def _picture(tables: list[ImportTable]) -> bytes | None:
    records = [table for table in of_role(tables, "plate") if table.map.word("course") == "stages"]
    return picture_of(records[0]) if len(records) == 1 else None


def _tables_of(files: Sequence[str], known: Known, kept: str, given: str) -> tuple[list[ImportTable], str]:
    """The tables, and the text of the given mapping."""
    if given:
        text = text_of_mapping(given)
        return read_import_tables(parse_mapping(text, given, known.stated), files, given), text
    if not files:
        raise InputError("TABLE: must be at least one file, or --mapping must name them, got neither")
    if is_there(kept):
        raise InputError(f"{kept}: is there already: import with --mapping {kept}, or remove it")
    return guess_tables(files, known), ""


def _attempt(tables: list[ImportTable], known: Known, text: str, problems: list[str]) -> Attempt:
    """With a guessed mapping."""
    try:
        rows = wrong_rows(tables) if problems else []
        imported = None if problems else import_tables(tables, known)
    except InputError as error:
        rows, imported = error.problems, None
    return Attempt(text, imported, problems + rows, bool(rows))


def _print_mapping(mapping: list[MappedTable]) -> None:
    """Prints the role of each table and of its columns."""
    for table in mapping:
        more = f" and {len(table.files) - 1} more" if len(table.files) > 1 else ""
        why = f": {table.role_why}" if table.role_why else ""
        print(f"{table.files[0]}{more}: {table.role} ({table.role_certainty}{why})")
        entries = {key.name: table[key.name] for key in KEYS[table.role] if key.name in table}
        entries |= {"wall " + word: of for word, of in sorted(table.walls.items())}
        lines = [(f"  {name:<13} {' + '.join(of.words):<18} {of.certainty:<8}", of.why) for name, of in entries.items()]
        for head, text in lines + [("  not used     ", ", ".join(table.unused))] * bool(table.unused):
            print(textwrap.fill(text, LINE, initial_indent=head, subsequent_indent=" " * len(head), break_long_words=False,
                                break_on_hyphens=False) or head)
    sys.stdout.flush()


def _expect_kept(kept: str, text: str) -> None:
    """Raises an error if another mapping exists; the same one, edited by the user, may."""
    if not is_there(kept):
        return
    there = text_of_mapping(kept)
    try:
        same = there == text or mapping_text(parse_mapping(there, kept)) == text
    except InputError:
        same = False
    if not same:
        raise InputError(f"{kept}: is another mapping, and is not replaced: give another folder (--out), or remove it")
