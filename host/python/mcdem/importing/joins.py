"""Joins tables of one tomograph by the labels of its grains: centres in one file, sizes in another."""
import copy

import numpy as np

from ..errors import InputError
from ..number_text import shortest
from .mapping import SIZE_KEYS
from .names import columns_by_key
from .rows import ImportTable
from .tables import Table


def joined(part: Table, label: str, other: Table, other_label: str) -> Table:
    """The table with the other columns of another one in the rows of the same label. Raises InputError if one is missing or there twice."""
    at, at_other = part.find(label), other.find(other_label)
    for table, place, name in ((part, at, label), (other, at_other, other_label)):
        if place is None:
            raise InputError(f"{table.file}: must have the column {name} of labels, got {', '.join(table.columns)}")
    assert at is not None and at_other is not None
    labels, theirs = part.numbers(at), other.numbers(at_other)
    order = np.argsort(theirs, kind="stable")
    rows = order[np.minimum(np.searchsorted(theirs[order], labels), len(order) - 1)]
    missing = np.flatnonzero(~(theirs[rows] == labels) & np.isfinite(labels))
    if len(missing):
        raise InputError(f"{other.file}: must have a row for each label of {part.file}, got none for {shortest(labels[missing[0]])}")
    twice = np.flatnonzero(np.diff(theirs[order]) == 0)
    if len(twice):
        raise InputError(f"{other.where(int(order[twice[0] + 1]))}: must have each label once, got {shortest(theirs[order[twice[0]]])} again")
    more = [place for place, name in enumerate(other.columns) if place != at_other and part.find(name) is None]
    whole = copy.copy(part)
    own = [part.numbers(place) for place in range(len(part.columns))]
    whole.add_columns([other.columns[place] for place in more], np.column_stack([*own, *(other.numbers(place)[rows] for place in more)]))
    return whole


def _keys(table: ImportTable) -> dict[str, list[str]]:
    return columns_by_key("grains", table.parts[0].columns)


def join_tables(tables: list[ImportTable]) -> None:
    """Joins the one table of centres without sizes with the one of sizes without centres, if there are such, and removes the latter."""
    labelled = [(table, keys) for table in tables if "grain" in (keys := _keys(table))]
    centres = [table for table, keys in labelled if {"x", "y", "z"} <= keys.keys() and not keys.keys() & {*SIZE_KEYS}]
    sizes = [table for table, keys in labelled if not {"x", "y", "z"} & keys.keys() and keys.keys() & {*SIZE_KEYS}]
    if len(centres) != 1 or len(sizes) != 1 or len(centres[0].parts) != len(sizes[0].parts):
        return
    [table], [other] = centres, sizes
    label, other_label = (_keys(one)["grain"][0] for one in (table, other))
    table.parts = [joined(part, label, more, other_label) for part, more in zip(table.parts, other.parts)]
    table.map.joined, table.map.joined_by = other.map.files, other_label
    tables.remove(other)
