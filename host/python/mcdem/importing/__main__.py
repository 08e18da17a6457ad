"""What `mcdem experiment import` starts (host/cli/experiment/experiment_import.cpp): reads and guesses, and prints what each table is taken for.

Arguments: the work folder, the file in which the mapping is kept, the given mapping or "", tables. Reads request.json in the
work folder and writes mapping.toml, result.json and, unless this states problems, plate.csv, grains.csv and contacts.csv.
Mistakes for which no mapping can be written are bad input.
"""
import json
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


class Request:
    def __init__(self, work, kept, mapping, *tables):
        self.work, self.kept, self.mapping, self.tables = work, kept, mapping, tables
        with open(os.path.join(work, "request.json"), encoding="utf-8") as file:
            stated = json.load(file)
        self.known = Known(**{name: value for name, value in stated["known"].items() if value is not None})
        self.gzip, self.settings_problems = stated["gzip"], stated["settings_problems"]

    def write_mapping(self, text):
        write_whole(os.path.join(self.work, "mapping.toml"), text.encode("utf-8", "surrogateescape"))

    def write_result(self, **result):
        write_whole(os.path.join(self.work, "result.json"), json.dumps(result, ensure_ascii=False).encode("utf-8", "replace"))


def print_beside(head, text):
    print(textwrap.fill(text, LINE, initial_indent=head, subsequent_indent=" " * len(head), break_long_words=False,
                        break_on_hyphens=False) or head)


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


def import_by_mapping(request):
    text = text_of_mapping(request.mapping)
    tables = read_import_tables(parse_mapping(text, request.mapping), request.tables, request.mapping)
    mapping = mapping_of(tables)
    print_mapping(mapping)
    if request.settings_problems:
        raise InputError(request.settings_problems)
    text = mapping_text(mapping) if request.tables else text
    expect_kept(request.kept, text)
    request.write_mapping(text)
    return import_tables(tables, request.known)


def import_by_guess(request):
    """None if the guess is uncertain."""
    if not request.tables:
        raise InputError("TABLE: must be at least one file, or --mapping must name them, got neither")
    if os.path.lexists(request.kept):
        raise InputError(f"{request.kept}: is there already: import with --mapping {request.kept}, or remove it")
    tables = guess_tables(request.tables, request.known)
    mapping = mapping_of(tables)
    text = mapping_text(mapping)
    request.write_mapping(text)
    print_mapping(mapping)
    problems = unclear_entries(text, request.kept) + request.settings_problems
    rows = wrong_rows(tables) if problems else []
    if not problems:
        try:
            return import_tables(tables, request.known)
        except InputError as error:
            rows = error.problems
    request.write_result(problems=problems + rows, wrong_rows=bool(rows))
    return None


def main():
    request = Request(*sys.argv[1:])
    imported = (import_by_mapping if request.mapping else import_by_guess)(request)
    if imported is not None:
        write_tables(imported, request.work, request.gzip)
        request.write_result(plate_start=repr(imported.plate_start), notes=imported.notes)  # text: it may be infinite


if __name__ == "__main__":
    main()
