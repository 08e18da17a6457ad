"""What `mcdem experiment import` starts (host/cli/experiment/experiment_import.cpp): reads and guesses, prints what each table is taken for,
and leaves the results in the folder --work, from which the program puts them into place: mapping.toml, and either problems or
plate.csv, grains.csv, contacts.csv, plate_start and notes. Mistakes for which no mapping can be written are bad input."""
import argparse
import os
import sys
import textwrap

from ..errors import InputError
from ..files import write_whole
from .assemble import Known, import_tables, write_tables
from .guess import guess_tables, mapping_of, read_import_tables, wrong_rows
from .mapping import KEYS, mapping_text, unclear_entries
from .read_mapping import parse_mapping, text_of_mapping

LINE = 110


def arguments_of(words):
    parser = argparse.ArgumentParser(prog="mcdem experiment import", allow_abbrev=False)
    parser.add_argument("--work", required=True)
    parser.add_argument("--kept", required=True, help="where the mapping is kept")
    parser.add_argument("--mapping")
    parser.add_argument("--settings-problem", action="append", default=[])
    parser.add_argument("--gzip", action="store_true")
    parser.add_argument("--programme", action="store_true", help="experiment.toml states one")
    for name in ("--box-x", "--box-y", "--plate-start", "--youngs-modulus", "--poisson-ratio", "--voxel-size"):
        parser.add_argument(name, type=float, default=argparse.SUPPRESS)
    parser.add_argument("tables", nargs="*")
    return parser.parse_args(words)


def known_of(arguments):
    stated = {name: value for name, value in vars(arguments).items() if hasattr(Known, name)}
    return Known(box=(getattr(arguments, "box_x", 0.0), getattr(arguments, "box_y", 0.0)), **stated)


def print_beside(head, text):
    print(textwrap.fill(text, LINE, initial_indent=head, subsequent_indent=" " * len(head), break_long_words=False,
                        break_on_hyphens=False) if text else head)


def print_mapping(mapping):
    """Prints the role of each table and of its columns."""
    for table in mapping:
        more = f" and {len(table.files) - 1} more" if len(table.files) > 1 else ""
        why = f": {table.role_why}" if table.role_why else ""
        print(f"{table.files[0]}{more}: {table.role} ({table.role_certainty}{why})")
        entries = [(key.name, table[key.name]) for key in KEYS[table.role] if key.name in table]
        for name, of in entries + [("wall " + word, of) for word, of in sorted(table.walls.items())]:
            print_beside(f"  {name:<13} {' + '.join(of.words):<18} {of.certainty:<8}", of.why)
        if table.unused:
            print_beside("  not used     ", ", ".join(table.unused))
    sys.stdout.flush()


def write(arguments, name, text):
    """Writes a file for the program; `text` may be a list of lines."""
    if isinstance(text, list):
        text = "".join(line.replace("\n", " ") + "\n" for line in text)
    write_whole(os.path.join(arguments.work, name), text.encode("utf-8", "surrogateescape"))


def expect_kept(kept, text):
    """Raises an error if another mapping exists; the same one, edited by the user, may."""
    if not os.path.lexists(kept):
        return
    there = text_of_mapping(kept)
    try:
        same = there == text or mapping_text(parse_mapping(there, kept)) == text
    except InputError:
        same = False
    if not same:
        raise InputError(f"{kept}: is another mapping, and is not replaced: give another folder (--out), or remove it")


def import_by_mapping(arguments, known):
    text = text_of_mapping(arguments.mapping)
    tables = read_import_tables(parse_mapping(text, arguments.mapping), arguments.tables, arguments.mapping)
    mapping = mapping_of(tables)
    print_mapping(mapping)
    if arguments.settings_problem:
        raise InputError(arguments.settings_problem)
    text = mapping_text(mapping) if arguments.tables else text
    expect_kept(arguments.kept, text)
    write(arguments, "mapping.toml", text)
    return import_tables(tables, known)


def import_by_guess(arguments, known):
    """None if the guess is uncertain."""
    if not arguments.tables:
        raise InputError("TABLE: must be at least one file, or --mapping must name them, got neither")
    if os.path.lexists(arguments.kept):
        raise InputError(f"{arguments.kept}: is there already: import with --mapping {arguments.kept}, or remove it")
    tables = guess_tables(arguments.tables, known)
    mapping = mapping_of(tables)
    text = mapping_text(mapping)
    write(arguments, "mapping.toml", text)
    print_mapping(mapping)
    problems = unclear_entries(text, arguments.kept) + arguments.settings_problem
    rows = wrong_rows(tables) if problems else []
    if not problems:
        try:
            return import_tables(tables, known)
        except InputError as error:
            rows = error.problems
    write(arguments, "problems", problems + rows)
    if rows:
        write(arguments, "wrong_rows", "")
    return None


def main():
    arguments = arguments_of(sys.argv[1:])
    imported = (import_by_mapping if arguments.mapping else import_by_guess)(arguments, known_of(arguments))
    if imported is not None:
        write_tables(imported, arguments.work, arguments.gzip)
        write(arguments, "plate_start", repr(imported.plate_start))
        write(arguments, "notes", imported.notes)


if __name__ == "__main__":
    main()
