"""Reads mapping.toml, possibly edited by the user."""
import os
import re
import tomllib

from ..errors import InputError
from ..files import read_whole
from ..look import is_file, is_there
from ..problems import Problems, quoted, to_number
from .mapping import BY_DIRECTION, KEYS, WALLS, Guess, Key, MappedTable, find_key, meaning_of, must_be_stated
from .text import Form

LARGEST = 1_000_000  # bytes
MAX_DOTS = 100  # per line: the parser's time is quadratic in their number
ROLE, FILES, WALL = Key("role", "word", "", tuple(KEYS)), Key("files", "files"), Key("a wall", "word", "", (*WALLS, BY_DIRECTION))
FORM_KEYS = [Key("separator", "word", "", (",", ";", "tab", "blanks")), Key("decimal", "word", "", (".", ","))]


def _lines_of_keys(text):
    """Line numbers, which the TOML reader does not provide, by position of the table and key; "" stands for the header."""
    lines, table = {(-1, ""): 1}, -1
    for number, line in enumerate(text.split("\n"), 1):
        if re.match(r"\s*\[\[\s*table\s*\]\]", line):
            table += 1
            lines[table, ""] = number
        lines.setdefault((table, line.partition("=")[0].strip().strip("'\"")), number)
    return lines


def _problem_of(key, words):
    """The problem of an entry, or None."""
    if len(words) > 1 and key.kind not in ("quantities", "files"):
        return f"must be one text, got {len(words)}"
    if key.kind in ("quantity", "quantities") and "-" in words:
        return "must be a column, got a sign only"
    if key.kind == "column" and words[0].startswith("-"):
        return f"must be a column without a sign, got {quoted(words[0])}"
    if key.kind == "number" and to_number(words[0]) is None:
        return f"must be a number in quotes, got {quoted(words[0])}"
    if key.name == "voxel_size" and to_number(words[0]) <= 0:
        return f"must be > 0 [m], got {quoted(words[0])}"
    if key.kind == "word" and words[0] not in key.words:
        return f"must be one of {' '.join(map(quoted, key.words))}, got {quoted(words[0])}"
    return None


class _Reader:
    def __init__(self, text, file):
        self.lines, self.file, self.problems = _lines_of_keys(text), file, Problems()

    def line_of(self, number, name=""):
        return self.lines.get((number, name), self.lines.get((number, ""), 1))

    def wrong(self, number, name, what):
        self.problems.add(f"{self.file}:{self.line_of(number, name)}", what)

    def read(self, root):
        tables, others = root.pop("table", []), list(root)
        if not isinstance(tables, list) or not all(isinstance(one, dict) for one in tables):
            tables, others = [], [*others, "table"]
        for key in others:
            self.wrong(-1, key, f"{quoted(key)} must be a list of tables, [[table]], got something else")
        read = [self.read_table(number, node) for number, node in enumerate(tables)]
        if not read and not self.problems.count:
            self.problems.add(self.file, "must hold at least one [[table]], got none")
        self.problems.report()
        return read

    def words(self, number, name, value, key):
        """The words of an entry; [] where they are a problem."""
        words = [value] if isinstance(value, str) else value
        if not isinstance(words, list) or not words or not all(isinstance(word, str) and word for word in words):
            self.wrong(number, name, f"{quoted(name)} must be a text, or a list of texts, got something else")
            return []
        for word in words if key.kind != "files" else ():
            if word.startswith("?"):
                self.wrong(number, name, f"{name} must be confirmed, got {quoted(word)}: put in what is right, without the question mark")
        words = [word.removeprefix("?") if key.kind != "files" else word for word in words]
        if what := _problem_of(key, words):
            self.wrong(number, name, f"{key.name} {what}")
        return [] if what else words

    def read_table(self, number, node):
        table = MappedTable(line=self.line_of(number))
        table.role = "".join(self.words(number, "role", node.pop("role", "nothing"), ROLE)) or "unused"
        table.files = self.words(number, "files", node.pop("files"), FILES) if "files" in node else []
        if not table.files:
            self.wrong(number, "", "files must name at least one file, got none")
        form = [self.words(number, key.name, node.pop(key.name), key) if key.name in node else [] for key in FORM_KEYS]
        if any(form):
            separator, decimal = (words[0] if words else otherwise for words, otherwise in zip(form, ",."))
            table.form = Form({"tab": "\t", "blanks": " "}.get(separator, separator), decimal)
        walls = node.pop("walls", {}) if table.role == "contacts" else {}
        if not isinstance(walls, dict):
            self.wrong(number, "walls", "walls must be a table, [table.walls], got something else")
            walls = {}
        for name, value in walls.items():
            if words := self.words(number, name, value, WALL):
                table.walls[name] = Guess(words)
        for name, value in node.items():
            key = find_key(table.role, name)
            if key and (words := self.words(number, name, value, key)):
                table[name] = Guess(words)
            elif not key and table.role != "unused":
                self.wrong(number, name, f"{quoted(name)} must be a key of a table of {table.role}, got another: remove it, or choose from "
                           + ", ".join(key.name for key in KEYS[table.role]))
        for name in must_be_stated(table):
            if name not in node:
                self.wrong(number, "", f"{name} must be stated: {meaning_of(find_key(table.role, name))}, got none")
        return table


def parse_mapping(text, file):
    for number, line in enumerate(text.split("\n"), 1):
        if (dots := re.sub(r'"[^"]*"', "", line).count(".")) > MAX_DOTS:
            raise InputError(f"{file}:{number}: must have at most {MAX_DOTS} dots outside texts, got {dots}")
    try:
        root = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        line = re.search(r"at line (\d+)", str(error))
        raise InputError(f"{file}:{line[1] if line else text.count(chr(10)) + 1}: must be TOML, got: {error}") from None
    return _Reader(text, file).read(root)


def text_of_mapping(file):
    if not is_file(file) or os.path.getsize(file) > LARGEST:
        got = "something else" if is_there(file) else "no such file"
        raise InputError(f"{file}: must be a mapping of at most 1 MB, got {got}")
    try:
        return read_whole(file).decode().replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise InputError(f"{file}: must be text in UTF-8") from None
