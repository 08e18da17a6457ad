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
from ..files import read_whole, write_whole
from ..look import is_there
from .assemble import Known, import_tables, write_tables
from .guess import guess_tables, mapping_of, read_import_tables, wrong_rows
from .mapping import KEYS, mapping_text, unclear_entries
from .read_mapping import parse_mapping, text_of_mapping

LINE = 110


def print_mapping(mapping):
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


def expect_kept(kept, text):
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


def write_result(work, **result):
    write_whole(os.path.join(work, "result.json"), json.dumps(result, ensure_ascii=False).encode("utf-8", "replace"))


def main():
    work, kept, given, *files = sys.argv[1:]
    request = json.loads(read_whole(os.path.join(work, "request.json")))
    known = Known(**{name: value for name, value in request["known"].items() if value is not None})
    if given:
        text = text_of_mapping(given)
        tables = read_import_tables(parse_mapping(text, given), files, given)
    elif not files:
        raise InputError("TABLE: must be at least one file, or --mapping must name them, got neither")
    elif is_there(kept):
        raise InputError(f"{kept}: is there already: import with --mapping {kept}, or remove it")
    else:
        tables = guess_tables(files, known)
    mapping = mapping_of(tables)
    if files:
        text = mapping_text(mapping)
    print_mapping(mapping)
    problems = request["settings_problems"]
    if given and problems:
        raise InputError(problems)
    if given:
        expect_kept(kept, text)
    write_whole(os.path.join(work, "mapping.toml"), text.encode("utf-8", "surrogateescape"))
    if not given:
        problems = unclear_entries(text, kept) + problems
    try:
        rows = wrong_rows(tables) if problems else []
        imported = None if problems else import_tables(tables, known)
    except InputError as error:
        if given:
            raise
        rows = error.problems
    if problems or rows:
        write_result(work, problems=problems + rows, wrong_rows=bool(rows))
    else:
        write_tables(imported, work, request["gzip"])
        write_result(work, plate_start=repr(imported.plate_start), notes=imported.notes)  # text: it may be infinite


if __name__ == "__main__":
    main()
