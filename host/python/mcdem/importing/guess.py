"""Guesses the meaning of tables. A guess is sure if a name states it and the numbers do not contradict, or if the numbers allow
only one possibility; it is unclear if they allow several."""
import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import InputError
from ..problems import Problems
from .grains import GrainFrames, import_grains
from .guess_contacts import guess_contact_meaning
from .guess_frames import guess_frames, guess_links
from .guess_lengths import guess_grain_lengths, guess_grains_upwards
from .guess_names import guess_by_names, note_units
from .guess_plate import guess_plate_units
from .guess_values import guess_contacts_by_values, guess_grains_by_values, guess_plate_by_values
from .joins import join_tables, joined
from .mapping import UNCLEAR, Known, MappedTable, columns_of, guess, must_be_stated, signed_column, unused_columns
from .plate import import_plate
from .rows import ImportTable, of_role
from .tables import Table, read_table, read_tables


def _group(parts: list[Table]) -> list[ImportTable]:
    """Groups files with the same columns as frames of one table, ordered by the numbers in their names."""
    groups = dict[object, list[Table]]()
    for number, part in enumerate(parts):
        groups.setdefault((tuple(part.columns), part.format, part.form) if part.named else number, []).append(part)
    tables = []
    for group in groups.values():
        group.sort(key=lambda part: re.sub("[0-9]+", lambda number: number[0].zfill(100), part.file))
        if all(part.frames for part in group):
            group.sort(key=lambda part: part.frames[0][0])
        mapped = MappedTable(files=[part.file for part in group], form=group[0].form if group[0].format == "text" else None)
        if not any(part.decimal_clear for part in group):
            mapped.decimal_unclear = "every comma has three digits behind it: if they part thousands, write the table without them"
        tables.append(ImportTable(mapped, group))
    return tables


def _grains_so_far(tables: list[ImportTable]) -> GrainFrames:
    """The grains in frames of the plate, read with the present mapping; empty if that is not possible yet."""
    guess_frames(tables)
    of_grains, problems = of_role(tables, "grains"), Problems()
    grains = import_grains(of_grains, problems)
    if problems.count or not grains.keys:
        return GrainFrames()
    for table in of_role(tables, "plate"):
        grains.place(of_grains[0].map.word("frames_by", "plate"), import_plate(table, 0.0, Problems()))
    return grains


def guess_tables(files: Sequence[str], known: Known) -> list[ImportTable]:
    tables = _group(read_tables(files))
    join_tables(tables)
    for table in tables:
        guess_by_names(table)
        if table.role == "unused":
            guess_grains_by_values(table)
            note_units(table.map)
    for table in of_role(tables, "grains"):
        guess_links(table)
    guess_grains_upwards(tables)
    for table in of_role(tables, "grains"):
        guess_grain_lengths(table, known)
    grains = _grains_so_far(tables)
    open_ = [table for table in of_role(tables, "unused") if table.map.role_certainty == UNCLEAR]
    for table in open_:
        guess_contacts_by_values(table, grains)
    for table in [] if of_role(tables, "plate") else of_role(open_, "unused"):
        guess_plate_by_values(table)
    for table in open_:
        note_units(table.map)
    grains = _grains_so_far(tables)
    voxel_size = next((table.map["voxel_size"] for table in of_role(tables, "grains") if "voxel_size" in table.map), None)
    if voxel_size:
        known = replace(known, voxel_size=float(voxel_size.word))
    for table in of_role(tables, "contacts"):
        guess_contact_meaning(table, grains, known)
    for table in of_role(tables, "plate"):
        guess_plate_units(table, tables, grains, known)
    for table in tables:
        if voxel_size and "voxel_size" in table.map:
            table.map["voxel_size"] = voxel_size
        table.map.unused = unused_columns(table.map, table.parts[0].columns)
    return tables


def mapping_of(tables: list[ImportTable]) -> list[MappedTable]:
    """Marks units and signs without a guess as unclear."""
    for table in tables:
        for key in must_be_stated(table.map):
            if key.name not in table.map:
                table.map[key.name] = guess(key.words[0] if key.words else "1", UNCLEAR, "nothing tells it")
    return [table.map for table in tables]


def wrong_rows(tables: list[ImportTable]) -> list[str]:
    """Problems in the tables of plate and grains that prevent further guesses, if their columns are known."""
    problems = []
    for table in tables:
        certainties = [of.certainty for key, of in table.map.entries.items() if "_" not in key]
        if UNCLEAR in (table.map.role_certainty, *certainties):
            continue
        of_table = Problems()
        if table.role == "plate":
            import_plate(table, np.nan, of_table)
        elif table.role == "grains":
            import_grains([table], of_table)
        problems += of_table.lines()
    return problems


def _distribute(files: Sequence[str], tables: list[ImportTable], problems: list[str]) -> None:
    """Assigns each file to the table with most columns, all of which the file has; a tie is a problem."""
    for file in files:
        fits, why = dict[int, list[tuple[ImportTable, Table]]](), f"{file}: must have the columns of a table of the mapping, got others"
        for table in tables:
            words = [word for _, words in columns_of(table.map) for word in words]
            try:
                part = read_table(file, table.map.form)
            except InputError as error:
                why = str(error)
            else:
                if all(part.find(signed_column(word)[1]) is not None for word in words):
                    fits.setdefault(len(words), []).append((table, part))
        best = fits[max(fits)] if fits else []
        if len(best) == 1:
            [(table, part)] = best
            table.parts.append(part)
            table.map.files.append(file)
        else:
            problems.append(f"{file}: must fit one table of the mapping, got two that it fits: name the files in the mapping" if best else why)


def read_import_tables(mapping: list[MappedTable], files: Sequence[str] = (), file: str = "mapping") -> list[ImportTable]:
    """Reads the files of the tables in a mapping. `files`, if given, replace those of the mapping: each is assigned to the
    table whose columns it has."""
    tables, problems = [ImportTable(mapped.changed(), []) for mapped in mapping], list[str]()
    if files and (of_several := [table.map for table in tables if table.map.joined]):
        raise InputError(f"{file}:{of_several[0].line}: the mapping must name the files where tables are joined, got others with the command: write them "
                         "into files and joined")
    if files:
        tables = [table for table in tables if table.role != "unused"]
        before = [table.map.files[0] for table in tables]
        for table in tables:
            table.map.files = []
        _distribute(files, tables, problems)
        problems = problems or [f"{file}:{table.map.line}: the table of {table.role}, {first} there, must have a file too, got none among those "
                                "given: give it, or remove the table from the mapping" for table, first in zip(tables, before) if not table.parts]
    for table in tables:
        try:
            if not files and table.role != "unused":
                table.parts = read_tables(table.map.files, table.map.form)
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    for table in tables:
        if table.map.joined:
            table.parts = [joined(part, table.map.word("grain"), other, table.map.joined_by)
                           for part, other in zip(table.parts, read_tables(table.map.joined), strict=True)]
    return tables
