"""Reads mapping.toml, possibly edited by the user."""
import os
from typing import Any

from .. import toml_lines
from ..errors import InputError
from ..files import read_whole
from ..look import is_file, is_there
from ..number_text import shortest
from ..problems import Problems, quoted, to_number
from ..toml_lines import Document, TomlError, Where
from .mapping import BY_DIRECTION, KEYS, WALLS, Guess, Key, MappedTable, find_key, meaning_of, must_be_stated
from .names import VOXEL
from .text import Form

LARGEST = 1_000_000  # bytes
JOINED, JOINED_BY = Key("joined", "files"), Key("joined_by", "column")
ROLE, FILES, WALL = Key("role", "word", "", tuple(KEYS)), Key("files", "files"), Key("a wall", "word", "", (*WALLS, BY_DIRECTION))
POSITIVE = {"voxel_size": " [m]", "area": " [m2]", "solid_volume": " [m3]", "size_factor": ""}
FORM_KEYS = [Key("separator", "word", "", (",", ";", "tab", "blanks")), Key("decimal", "word", "", (".", ","))]


def _problem_of(key: Key, words: list[str]) -> str | None:
    """The problem of an entry, or None."""
    if len(words) > 1 and key.kind not in ("quantities", "files"):
        return f"must be one text, got {len(words)}"
    if key.kind in ("quantity", "quantities") and "-" in words:
        return "must be a column, got a sign only"
    if key.kind == "column" and words[0].startswith("-"):
        return f"must be a column without a sign, got {quoted(words[0])}"
    if key.kind == "number" and to_number(words[0]) is None:
        return f"must be a number in quotes, got {quoted(words[0])}"
    if key.name in POSITIVE and (to_number(words[0]) or 0) <= 0:
        return f"must be > 0{POSITIVE[key.name]}, got {quoted(words[0])}"
    if key.kind == "word" and words[0] not in key.words:
        return f"must be one of {' '.join(map(quoted, key.words))}, got {quoted(words[0])}"
    return None


class _Reader:
    def __init__(self, document: Document, file: str, stated: dict[str, float]) -> None:
        self.lines, self.file, self.stated, self.problems = document.lines, file, stated, Problems()

    def line_of(self, where: Where) -> int:
        """Of what is there, or of the innermost table around it."""
        return next((self.lines[where[:end]] for end in range(len(where), 0, -1) if where[:end] in self.lines), 1)

    def wrong(self, where: Where, what: str) -> None:
        self.problems.add(f"{self.file}:{self.line_of(where)}", what)

    def read(self, root: dict[str, Any]) -> list[MappedTable]:
        tables, others = root.pop("table", []), list(root)
        if not isinstance(tables, list) or not all(isinstance(one, dict) for one in tables):
            tables, others = [], [*others, "table"]
        for key in others:
            self.wrong((key,), f"{quoted(key)} must be a list of tables, [[table]], got something else")
        read = [self.read_table(("table", number), node) for number, node in enumerate(tables)]
        if not read and not self.problems.count:
            self.problems.add(self.file, "must hold at least one [[table]], got none")
        self.problems.report()
        return read

    def words(self, where: Where, value: Any, key: Key) -> list[str]:
        """The words of an entry; [] where they are a problem."""
        words, name, confirmable = [value] if isinstance(value, str) else value, str(where[-1]), key.kind != "files"
        if not isinstance(words, list) or not words or not all(isinstance(word, str) and word for word in words):
            self.wrong(where, f"{quoted(name)} must be a text, or a list of texts, got something else")
            return []
        for word in words if confirmable else ():
            if word.startswith("?"):
                self.wrong(where, f"{name} must be confirmed, got {quoted(word)}: put in what is right, without the question mark")
        words = [word.removeprefix("?") if confirmable else word for word in words]
        if what := _problem_of(key, words):
            self.wrong(where, f"{key.name} {what}")
        return [] if what else words

    def read_table(self, where: Where, node: dict[str, Any]) -> MappedTable:
        def stated(key: Key) -> list[str]:
            return self.words((*where, key.name), node.pop(key.name), key) if key.name in node else []

        table = MappedTable(line=self.line_of(where))
        node.setdefault("role", "nothing")
        table.role = "".join(stated(ROLE)) or "unused"
        table.files = stated(FILES)
        if not table.files:
            self.wrong(where, "files must name at least one file, got none")
        table.joined, table.joined_by = stated(JOINED), "".join(stated(JOINED_BY))
        if table.joined and (len(table.joined) != len(table.files) or not table.joined_by or "grain" not in node):
            self.wrong(where, "joined must name a file for each of files, joined_by their column of labels, and grain that of files")
        form = [stated(key) for key in FORM_KEYS]
        if any(form):
            separator, decimal = (words[0] if words else otherwise for words, otherwise in zip(form, ",."))
            table.form = Form({"tab": "\t", "blanks": " "}.get(separator, separator), decimal)
        walls = node.pop("walls", {}) if table.role == "contacts" else {}
        if not isinstance(walls, dict):
            self.wrong((*where, "walls"), "walls must be a table, [table.walls], got something else")
            walls = {}
        for name, value in walls.items():
            if words := self.words((*where, "walls", name), value, WALL):
                table.walls[name] = Guess(words)
        for name, value in node.items():
            key = find_key(table.role, name)
            if key and (words := self.words((*where, name), value, key)):
                table[name] = Guess(words)
            elif not key and table.role != "unused":
                self.wrong((*where, name), f"{quoted(name)} must be a key of a table of {table.role}, got another: remove it, or choose "
                                           "from " + ", ".join(key.name for key in KEYS[table.role]))
        for name, value in self.stated.items():  # by options, which replace what the mapping says
            if table.word("length_unit") == VOXEL if name == "voxel_size" else table.role == "plate":
                table[name] = Guess([shortest(value)])
        for key in must_be_stated(table):
            if key.name not in table and key.name not in node:
                self.wrong(where, f"{key.name} must be stated: {meaning_of(key)}, got none")
        return table


def parse_mapping(text: str, file: str, stated: dict[str, float] | None = None) -> list[MappedTable]:
    """The tables of a mapping. `stated`: voxel_size, area and solid_volume, in SI units, that replace those of the mapping.

    Raises InputError with all problems, each with its line of the file.
    """
    try:
        document = toml_lines.parse(text)
    except TomlError as error:
        raise InputError(f"{file}:{error.line}: {error.what}") from None
    return _Reader(document, file, stated or {}).read(document.root)


def small_file(file: str, what: str) -> bytes:
    """Of at most 1 MB. Raises InputError, OSError."""
    if not is_file(file) or os.path.getsize(file) > LARGEST:
        got = "something else" if is_there(file) else "no such file"
        raise InputError(f"{file}: must be {what} of at most 1 MB, got {got}")
    return read_whole(file)


def text_of_mapping(file: str) -> str:
    """Raises InputError, OSError."""
    try:
        return small_file(file, "a mapping").decode().replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise InputError(f"{file}: must be text in UTF-8") from None
