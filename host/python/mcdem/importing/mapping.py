"""The mapping of table columns: guessed, and written as mapping.toml for the user to correct (read_mapping reads it)."""
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ..problems import to_number
from ..toml import toml_value
from .names import FORCE_WORDS, FORCES, LENGTH_WORDS, LENGTHS, PRESSURES, RATIO_KEYS, VOXEL
from .text import Form

WALLS = ["x_min", "x_max", "y_min", "y_max", "floor", "plate"]
BY_DIRECTION = "by direction"  # a wall that is determined by the direction of each force
UNCLEAR = "unclear"  # in addition to stated, sure, likely: must be confirmed in the mapping before the import


@dataclass
class Known:
    """Values that are not in the tables, including the scale that distinguishes millimetres from metres."""

    box: tuple[float, float] = (0.0, 0.0)  # [m]; 0: unknown
    shape: str = "box"  # or cylinder, periodic
    plate_start: float = math.nan
    youngs_modulus: float = math.nan  # of the grains [Pa]
    poisson_ratio: float = 0.4
    voxel_size: float = math.nan  # [m]
    area: float = math.nan  # on which a pressure acts [m2]; the container's cross-section unless it is stated
    solid_volume: float = math.nan  # of all grains [m3]
    programme: bool = False  # rows have times

    @property
    def stated(self) -> dict[str, float]:
        """Values of the mapping that options have stated, by their keys."""
        return {key: value for key in ("voxel_size", "area", "solid_volume") if (value := getattr(self, key)) > 0}

    @property
    def section(self) -> float:
        """Area of the container's cross-section [m2]; 0: unknown."""
        return self.box[0] * self.box[1] * (math.pi / 4 if self.shape == "cylinder" else 1)


@dataclass
class Guess:
    words: list[str]  # a word, or columns: "-z" if z is reversed
    certainty: str = "stated"
    why: str = ""

    @property
    def word(self) -> str:
        return self.words[0]


def guess(word: str, certainty: str, why: str) -> Guess:
    return Guess([word], certainty, why)


def signed_column(word: str) -> tuple[int, str]:
    return (-1, word[1:]) if word.startswith("-") else (1, word)


def negated(of: Guess) -> Guess:
    """The entry with all columns reversed."""
    return Guess([word[1:] if word.startswith("-") else "-" + word for word in of.words], of.certainty, of.why)


class Key(NamedTuple):
    name: str
    kind: str  # column, quantity (may have a sign), quantities (a sum of several), word, number
    meaning: str = ""
    words: tuple[str, ...] = ()


def _length_keys(meaning: str = "") -> list[Key]:
    return [Key("length_unit", "word", meaning, tuple(LENGTH_WORDS)),
            Key("voxel_size", "number", "edge of a voxel [m], where length_unit is voxel")]


_FRAMES_BY = ("plate: frames have the plate's numbers, times or steps; nearest: the row with the nearest time; order: the first is the "
              "plate's first row, and so on; rows: they are the plate's rows, counted from 0")
KEYS: dict[str, list[Key]] = {
    "plate": [
        Key("frame", "column", "a row's frame number, time or step; without it the rows count"),
        Key("course", "word", "stages: the record of a testing machine, which is thinned to the moves and holds of a programme; rows: each row is a scan",
            ("rows", "stages")),
        Key("scans", "number", "of each move and hold, where course is stages"),
        Key("contact", "number", "where the plate first touches, as its column counts: plate.start is the height there"),
        Key("tare", "number", "force before it, as its column counts, which is taken off"),
        Key("cycle", "column", "compression cycle, rising; without it from the plate's turns"),
        Key("phase", "column", "load or unload (down or up, compression or decompression); without it from the plate's direction"),
        Key("plate_z", "quantity", "height of the plate; this or displacement; with a - before its name where it counts downwards"),
        Key("displacement", "quantity", "how far the plate has gone down from plate.start; with a - where it counts upwards"),
        Key("strain", "quantity", "in place of a height: compression over plate.start"),
        Key("fraction", "quantity", "in place of a height: volume of the grains over that below the plate (relative density)"),
        Key("void_ratio", "quantity", "in place of a height: volume of the pores over that of the grains"),
        Key("porosity", "quantity", "in place of a height: volume of the pores over that below the plate"),
        Key("ratio_unit", "word", "of strain, fraction, void_ratio and porosity", ("1", "%")),
        Key("solid_volume", "number", "of all grains [m3], for fraction, void_ratio and porosity; without it plate.start is the first row's height"),
        Key("top_force", "quantities", "force on the plate, or the pressure on it"),
        Key("mean_stress", "quantity", "in place of a force, with deviator_stress: the pressure is their p + 2/3 q"),
        Key("deviator_stress", "quantity", "with mean_stress"),
        Key("area", "number", "on which a pressure acts [m2]"),
        Key("time", "column", "when the row was measured [s where the column names no unit]; needed where [[programme]] is stated"),
        Key("set_force", "quantity", "the force that was set, in rows where one was; others are empty there"),
        *_length_keys(),
        Key("origin_z", "number", "where the floor is, as plate_z's column counts; 0 where left out"),
        Key("force_unit", "word", "", tuple(FORCE_WORDS)),
        Key("force_sign", "word", "+: upward force on the plate is positive; -: negative", ("+", "-")),
    ],
    "grains": [
        Key("frame", "column", "which rows belong together: frame number, time or step"),
        Key("frames_by", "word", _FRAMES_BY, ("plate", "nearest", "order", "rows")),
        Key("grain", "column", "a grain's number, alike in all frames; without it the rows of a frame count"),
        Key("labels", "word", "kept: a grain has one number in all frames; linked: numbers count anew in each, and grains are linked by their places",
            ("kept", "linked")),
        Key("first_grain", "number", "the number of the first row's grain, where no column has it"),
        Key("where", "column", "rows with 0 here are no grains"),
        Key("x", "quantities", "centre; of several columns the sum, such as position and displacement"),
        Key("y", "quantities", "centre"),
        Key("z", "quantities", "centre, upwards; with a - before its name where it counts downwards"),
        Key("diameter", "column", "this, radius or volume"),
        Key("radius", "column", "this, diameter or volume"),
        Key("volume", "column", "this, diameter or radius: of a sphere, in cubes of length_unit"),
        Key("size_factor", "number", "sizes are multiplied by it, 1 where left out: image analysis may see radii too small or too large"),
        Key("same_diameter", "number", "of all grains, in the table's unit, where no column has it"),
        *_length_keys(),
        Key("origin_x", "number", "where the wall x_min stands, in the table's unit, as x's column counts"),
        Key("origin_y", "number", "where the wall y_min stands"),
        Key("origin_z", "number", "where the floor is"),
    ],
    "contacts": [
        Key("frame", "column", "which rows belong together: frame number, time or step"),
        Key("frames_by", "word", "whose frame numbers, times or steps these are; nearest: the plate's row with the nearest time; order: "
            "the plate's rows, one after the other; rows: the plate's rows, counted from 0", ("plate", "grains", "nearest", "order", "rows")),
        Key("grain", "column", "the grain"),
        Key("partner", "column", "the other grain, or a wall; or one wall's name, where all rows are its"),
        Key("where", "column", "rows with 0 here are no contacts"),
        Key("id_offset", "number", "added to grain and partner gives the numbers of the grains' table"),
        Key("x", "quantity", "contact point; without it midway between the surfaces"),
        Key("y", "quantity", "contact point"),
        Key("z", "quantity", "contact point"),
        Key("fx", "quantities", "force; several columns are added up, such as normal and tangential parts, those with a - are taken off"),
        Key("fy", "quantities", "force"),
        Key("fz", "quantities", "force"),
        Key("force", "quantities", "in place of fx, fy, fz: size of a force along the line of centres, > 0 where it pushes"),
        Key("force_on", "word", "on which of the two the force is", ("grain", "partner")),
        Key("sides", "word", "both: each contact is listed from either side, and the mean counts", ("one", "both")),
        *_length_keys("of contact points"),
        Key("force_unit", "word", "", tuple(FORCES)),
    ],
    "unused": [],
}
SIZE_KEYS = ("diameter", "radius", "volume")
PLACE_KEYS = ("plate_z", "displacement", *RATIO_KEYS)  # of a plate, the first one that a table has counts
COLUMN_KINDS = ("column", "quantity", "quantities")


def find_key(role: str, name: str) -> Key | None:
    return next((key for key in KEYS[role] if key.name == name), None)


@dataclass
class MappedTable:
    role: str = "unused"
    role_certainty: str = "stated"
    role_why: str = ""
    line: int = 0  # in the mapping
    files: list[str] = field(default_factory=list)  # with the same columns, in order of the frames
    joined: list[str] = field(default_factory=list)  # files with more columns, each of that in `files`, by the label
    joined_by: str = ""  # their column of labels
    unused: list[str] = field(default_factory=list)  # unused columns
    form: Form | None = None  # of text
    decimal_unclear: str = ""  # reason; empty if it is clear
    entries: dict[str, Guess] = field(default_factory=dict)
    walls: dict[str, Guess] = field(default_factory=dict)  # of contacts: from the table's name of a wall to the standard name

    def __contains__(self, key: str) -> bool:
        return key in self.entries

    def __getitem__(self, key: str) -> Guess:
        return self.entries[key]

    def __setitem__(self, key: str, value: Guess) -> None:
        self.entries[key] = value

    def get(self, key: str) -> Guess | None:
        return self.entries.get(key)

    def word(self, key: str, otherwise: str = "") -> str:
        return self.entries[key].word if key in self.entries else otherwise

    def number(self, key: str) -> float:
        return to_number(self.word(key, "0")) or 0.0

    def length_factor(self, otherwise: str = "m") -> float:
        """Length of the table's unit in metres."""
        unit = self.word("length_unit", otherwise)
        return self.number("voxel_size") if unit == VOXEL else LENGTHS[unit]

    @property
    def place(self) -> str:
        """The key that tells the plate's height; empty if there is none."""
        return next((key for key in PLACE_KEYS if key in self), "")

    @property
    def is_topology(self) -> bool:
        """Whether contacts have no forces."""
        return self.role == "contacts" and not self.entries.keys() & {"force", "fx", "fy", "fz"}

    @property
    def is_pressure(self) -> bool:
        return self.word("force_unit") in PRESSURES

    def force_factor(self) -> float:
        """Of the table's unit in newtons."""
        unit = self.word("force_unit", "N")
        return float(PRESSURES[unit] * self.number("area") if unit in PRESSURES else FORCES[unit])

    def changed(self, **entries: Guess) -> "MappedTable":
        """A copy with other entries."""
        return replace(self, entries={**self.entries, **entries}, walls=dict(self.walls))


def must_be_stated(table: MappedTable) -> list[Key]:
    """Units and signs that are required for the table's columns."""
    keys, all_of = table.entries.keys(), {key.name: key for key in KEYS[table.role]}
    needed = {"length_unit": keys & {"plate_z", "displacement", "x", "y", "z", *SIZE_KEYS, "same_diameter"},
              "voxel_size": table.word("length_unit") == VOXEL,
              "ratio_unit": keys & set(RATIO_KEYS),
              "force_unit": keys & {"top_force", "mean_stress", "force", "fx", "fy", "fz"},
              "area": table.is_pressure or "solid_volume" in keys,
              "force_sign": table.role == "plate" and keys & {"top_force", "mean_stress"},
              "force_on": table.role == "contacts" and keys & {"fx", "fy", "fz"}}
    return [all_of[name] for name, is_needed in needed.items() if is_needed]


def columns_of(table: MappedTable) -> Iterator[tuple[str, list[str]]]:
    """Key and words of every entry that names columns."""
    for key in KEYS[table.role]:
        words = table[key.name].words if key.name in table and key.kind in COLUMN_KINDS else []
        if words and not (key.name == "partner" and words[0] in WALLS):
            yield key.name, words


def unused_columns(table: MappedTable, columns: list[str]) -> list[str]:
    used = {signed_column(word)[1] for entry in table.entries.values() for word in entry.words}
    return [column for column in columns if column not in used]


INTRODUCTION = """\
# What the tables of an experiment mean, for `mcdem experiment import --mapping`. Every entry says how sure it is and why.
# An entry that begins with a question mark is not safe: put in what is right, without the question mark, and import
# again with --mapping. Columns go by their names, or as "column 3"; where several are listed they are added up.
"""


def _one_line(text: str) -> str:
    return re.sub(r"[\x00-\x1f\x7f]", " ", text)


def _line_text(key: str, of: Guess, meaning: str) -> str:
    mark = "?" if of.certainty == UNCLEAR else ""
    words = [mark + of.word, *of.words[1:]]
    text = f"{key} = {toml_value(words[0] if len(words) == 1 else words)}"
    if of.certainty != "stated":
        text += f"  # {of.certainty}: {_one_line(of.why)}" + (f" ({meaning})" if mark and meaning else "")
    return text + "\n"


def meaning_of(key: Key) -> str:
    return "; ".join(filter(None, ["one of " + ", ".join(key.words) if key.words else "", key.meaning]))


def _table_text(table: MappedTable) -> str:
    text = "\n[[table]]\n" + _line_text("role", guess(table.role, table.role_certainty, table.role_why), "one of " + ", ".join(KEYS))
    text += f"files = {toml_value(table.files)}\n"
    if table.joined:
        text += f"joined = {toml_value(table.joined)}\njoined_by = {toml_value(table.joined_by)}\n"
    if table.form:
        separator = {"\t": "tab", " ": "blanks"}.get(table.form.separator, table.form.separator)
        text += f'separator = "{separator}"\n'
        text += _line_text("decimal", guess(table.form.decimal, UNCLEAR if table.decimal_unclear else "stated", table.decimal_unclear),
                           "a comma or a point")
    if table.unused:
        text += f"# columns not used: {_one_line(', '.join(table.unused))}\n"
    for key in KEYS[table.role]:
        meaning = meaning_of(key)
        text += _line_text(key.name, table[key.name], meaning) if key.name in table else f"# {key.name} =  # {meaning}\n"
    if table.walls:
        text += "[table.walls]  # what the table calls a wall, and which it is\n"
        for word, of in sorted(table.walls.items()):
            text += _line_text(toml_value(word), of, ", ".join([*WALLS, BY_DIRECTION]))
    return text


def mapping_text(tables: list[MappedTable]) -> str:
    """Each guess with its certainty and reason; unclear ones begin with a question mark."""
    return INTRODUCTION + "".join(map(_table_text, tables))


def unclear_entries(text: str, file: str) -> list[str]:
    """The lines that must be confirmed, each as a problem with the possible values."""
    lines = [re.fullmatch(f"([^#].*?) = (.*)  # {UNCLEAR}: (.*)", line) for line in text.split("\n")]
    return [f"{file}:{number}: {line[1]} must be confirmed, got {line[2]}: {line[3]}" for number, line in enumerate(lines, 1) if line]
