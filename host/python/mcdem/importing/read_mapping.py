"""Reads mapping.toml, possibly edited by the user."""
import collections
import os
import re
import tomllib

from ..errors import InputError
from ..toml import toml_value
from .mapping import BY_DIRECTION, KEYS, WALLS, Guess, MappedTable, find_key, must_be_stated
from .problems import Problems, quoted, to_number
from .text import Form

LARGEST = 1_000_000  # bytes
MAX_DOTS = 100  # per line: the parser's time is quadratic in their number


class _Reader:
    def __init__(self, text, file, problems):
        self.lines, self.file, self.problems = text.split("\n"), file, problems
        self.places = collections.defaultdict(list)  # line numbers by the text before their "="
        for n, line in enumerate(self.lines, 1):
            self.places[line.partition("=")[0].strip()].append(n)
        self.headers = [n for n, line in enumerate(self.lines, 1) if re.match(r"\s*\[\[\s*table\s*\]\]", line)]

    def wrong(self, line, what):
        self.problems.add(f"{self.file}:{line}", what)

    def line_of(self, key, table=None):
        """Line of the key in the table, which the TOML reader does not provide."""
        first = self.headers[table] if table is not None and table < len(self.headers) else 0
        last = self.headers[table + 1] - 1 if table is not None and table + 1 < len(self.headers) else len(self.lines)
        found = [n for name in (key, toml_value(key), f"'{key}'") for n in self.places.get(name, []) if first < n <= last]
        return min(found, default=max(first, 1))

    def read(self, root):
        for key, value in root.items():
            if key != "table" or not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
                self.wrong(self.line_of(key), f"{quoted(key)} must be a list of tables, [[table]], got something else")
        tables = root.get("table")
        tables = [one for one in tables if isinstance(one, dict)] if isinstance(tables, list) else []
        read = [self.read_table(number, one) for number, one in enumerate(tables)]
        if not read and not self.problems.count:
            self.problems.add(self.file, "must hold at least one [[table]], got none")
        return read

    def words(self, key, value, line):
        """None if it is not text."""
        words = [value] if isinstance(value, str) else value
        if not isinstance(words, list) or not words or not all(isinstance(word, str) and word for word in words):
            self.wrong(line, f"{quoted(key)} must be a text, or a list of texts, got something else")
            return None
        for word in words:
            if word.startswith("?") and key != "files":
                self.wrong(line, f"{key} must be confirmed, got {quoted(word)}: put in what is right, without the question mark")
        return [word.removeprefix("?") if key != "files" else word for word in words]

    def one_word(self, key, node, number, otherwise):
        if key not in node:
            return otherwise
        words = self.words(key, node[key], self.line_of(key, number)) or [otherwise]
        if len(words) > 1:
            self.wrong(self.line_of(key, number), f"{key} must be one text, got {len(words)}")
        return words[0]

    def read_form(self, node, number):
        if "separator" not in node and "decimal" not in node:
            return None
        separator = self.one_word("separator", node, number, ",")
        decimal = self.one_word("decimal", node, number, ".")
        if separator not in ("tab", "blanks", ",", ";"):
            self.wrong(self.line_of("separator", number), f'separator must be one of ",", ";", tab, blanks, got {quoted(separator)}')
        if decimal not in (".", ","):
            self.wrong(self.line_of("decimal", number), f'decimal must be "." or ",", got {quoted(decimal)}')
        return Form({"tab": "\t", "blanks": " "}.get(separator, separator), decimal)

    def problem_of(self, key, words):
        """The problem of an entry, or None."""
        if len(words) > 1 and key.kind != "quantities":
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
            return f"must be one of {' '.join(key.words)}, got {quoted(words[0])}"
        return None

    def read_walls(self, value, table, number):
        if not isinstance(value, dict):
            return self.wrong(self.line_of("walls", number), "walls must be a table, [table.walls], got something else")
        for word, wall in value.items():
            line = self.line_of(word, number)
            words = self.words(word, wall, line)
            if words and (len(words) > 1 or words[0] not in [*WALLS, BY_DIRECTION]):
                self.wrong(line, f"a wall must be one of {', '.join([*WALLS, BY_DIRECTION])}, got {quoted(words[0])}")
            elif words:
                table.walls[word] = Guess(words)
        return None

    def read_table(self, number, node):
        table = MappedTable(line=self.headers[number] if number < len(self.headers) else 1)
        role = self.one_word("role", node, number, "")
        if role in KEYS:
            table.role = role
        else:
            self.wrong(self.line_of("role", number), f"role must be one of {', '.join(KEYS)}, got {quoted(role)}")
        if "files" in node:
            table.files = self.words("files", node["files"], self.line_of("files", number)) or []
        if not table.files:
            self.wrong(table.line, "files must name at least one file, got none")
        table.form = self.read_form(node, number)
        for name, value in node.items():
            if name not in ("role", "files", "separator", "decimal"):
                self.read_entry(name, value, table, number)
        for name in must_be_stated(table):
            if name not in node:
                key = find_key(table.role, name)
                which = f", one of {' '.join(key.words)}" if key.words else ""
                self.wrong(table.line, f"{name} must be stated{which}{': ' if key.meaning else ''}{key.meaning}, got none")
        return table

    def read_entry(self, name, value, table, number):
        key, line = find_key(table.role, name), self.line_of(name, number)
        if name == "walls" and table.role == "contacts":
            self.read_walls(value, table, number)
        elif key:
            words = self.words(name, value, line)
            if words and (problem := self.problem_of(key, words)):
                self.wrong(line, f"{name} {problem}")
            elif words:
                table[name] = Guess(words)
        elif table.role != "unused":
            self.wrong(line, f"{quoted(name)} must be a key of a table of {table.role}, got another: remove it, or choose from "
                       + ", ".join(key.name for key in KEYS[table.role]))


def parse_mapping(text, file):
    problems, tables = Problems(), []
    for number, line in enumerate(text.split("\n"), 1):
        if (dots := re.sub(r'"[^"]*"', "", line).count(".")) > MAX_DOTS:
            raise InputError(f"{file}:{number}: must have at most {MAX_DOTS} dots outside texts, got {dots}")
    try:
        root = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        line = re.search(r"at line (\d+)", str(error))
        problems.add(f"{file}:{line[1] if line else text.count(chr(10)) + 1}", f"must be TOML, got: {error}")
    else:
        tables = _Reader(text, file, problems).read(root)
    problems.report()
    return tables


def text_of_mapping(file):
    if not os.path.isfile(file) or os.path.getsize(file) > LARGEST:
        got = "something else" if os.path.lexists(file) else "no such file"
        raise InputError(f"{file}: must be a mapping of at most 1 MB, got {got}")
    with open(file, "rb") as stream:
        content = stream.read()
    try:
        return content.decode().replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise InputError(f"{file}: must be text in UTF-8") from None
