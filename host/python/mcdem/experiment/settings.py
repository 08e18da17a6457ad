"""experiment.toml: what is known of an experiment besides its tables."""
import math
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import toml_lines
from ..errors import InputError
from ..files import read_input
from ..number_text import shortest
from ..problems import Problems, quoted
from ..results.names import ContainerShape, parse
from ..results.parameters import Parameters, has_programme
from ..results.recording import Box, Recording
from ..results.run_file import no_scans
from ..toml import value_text
from ..toml_lines import Document, TomlError, Where
from .experiment import MATERIALS, UNCERTAIN, Experiment, Measurement
from .sample import Sample

LONGEST_KEY = 1000  # in --set
LARGEST_BOX = 20  # [m]; a larger one was given in millimetres
MOST_STAGES = 100  # as max_stages in host/scene/programme.h

CONTROL = "[\\x00-\\x08\\x0a-\\x1f\\x7f\\x85\\u2028\\u2029\\ud800-\\udfff]"  # with bytes that are no UTF-8
ESCAPES = {'"': '\\"', "\\": "\\\\", "\b": "\\b", "\n": "\\n", "\f": "\\f", "\r": "\\r"}


@dataclass(frozen=True)
class Limits:
    """Of a number; as in scenes, or those of a laboratory: longer lengths are in millimetres."""

    low: float
    high: float
    unit: str = ""
    above: bool = False  # `low` itself is too low

    def contain(self, value: float) -> bool:
        return (self.low < value if self.above else self.low <= value) and value <= self.high

    @property
    def text(self) -> str:
        interval = f"> {self.low:g} and <= {self.high:g}" if self.above else f"between {self.low:g} and {self.high:g}"
        return f"a number {interval}{f' [{self.unit}]' if self.unit else ''}"


STIFFNESS, FRICTION, DURATION = Limits(0, 1e13, "Pa", above=True), Limits(0, 10), Limits(0, 1e6, "s")
LIMITS = {
    "container.radius": Limits(0, LARGEST_BOX / 2, "m", above=True),
    "sample.height": Limits(0, 100, "m", above=True),
    "sample.diameter": Limits(0, LARGEST_BOX, "m", above=True),
    "sample.area": Limits(0, LARGEST_BOX**2, "m2", above=True),
    "sample.mass": Limits(0, 1e6, "kg", above=True),
    "sample.solid_density": Limits(0, 1e5, "kg/m3", above=True),
    "sample.packing_fraction": Limits(0, 1, above=True),
    "sample.wall_friction": FRICTION,
    "sample.lateral_ratio": Limits(0, 2, above=True),
    "plate.start": Limits(0, 100, "m", above=True),
    "plate.speed": Limits(0, 1000, "m/s", above=True),
    "plate.pause": DURATION,
    "plate.hold": DURATION,
    "grains.youngs_modulus": STIFFNESS,
    "grains.poisson_ratio": Limits(0, 0.5),
    "grains.excess_density": Limits(-1e5, 1e5, "kg/m3"),
    "grains.friction": FRICTION,
    "grains.restitution": Limits(0, 1, above=True),
    "grains.diameter": Limits(0, 1, "m"),  # only its uncertainty
    "walls.youngs_modulus": STIFFNESS,
    "walls.friction": FRICTION,
    "measurement.position_error": Limits(0, 1, "m"),
    "measurement.diameter_error": Limits(0, 1, "m"),
    "measurement.force_error": Limits(0, 10),
    "measurement.force_threshold": Limits(0, 1e9, "N"),
}


def read_settings(file: Path, problems: Problems) -> Experiment:
    """An experiment without scans, from a file that is there; the default name is that of its folder.

    Raises InputError, RunError, OSError if it cannot be read.
    """
    return parse_settings(read_input(file), str(file), (), problems, os.path.splitext(file.parent.name or ".")[0])


def parse_settings(text: bytes, file: str, overrides: Sequence[str], problems: Problems, name: str = "") -> Experiment:
    """An experiment without scans, from TOML text (may be empty) and overrides "grains.youngs_modulus=23300", which have precedence.

    `name` is the default. What is not stated has its default; plate_start is NaN then. Problems are added, each with its line of the file,
    or with --set.
    """
    try:
        document = toml_lines.parse(_decoded(text))
    except TomlError as error:
        problems.add(f"{file}:{error.line}", error.what)
        return Experiment(name, _without_scans(name, {}, Box()))
    for word in overrides:
        _override(document, word, problems)
    return _Reader(document, file, problems).read(name)


def _without_scans(name: str, parameters: Parameters, box: Box, plate_start: float | None = None) -> Recording:
    return Recording(name, parameters, box, math.nan if plate_start is None else plate_start, np.zeros(0), no_scans())


def _decoded(text: bytes) -> str:
    try:
        return text.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TomlError(text.count(b"\n", 0, error.start) + 1, "must be text in UTF-8") from None


def _override(document: Document, word: str, problems: Problems) -> None:
    """Puts "a.b=value" into the document; a value that is not TOML is a text."""
    key, equals, value = word.partition("=")
    parts = key.split(".")
    if not equals or not all(parts) or len(key) > LONGEST_KEY:
        problems.add("--set", f"must be KEY=VALUE such as box.size=[0.165,0.166], got {quoted(word)}")
        return
    try:
        document.replace(tuple(parts), toml_lines.parse_value(value))
    except KeyError as error:
        problems.add("--set", f"{_plain(error.args[0])} must be a table, got a value before")


def _plain(name: str) -> str:
    """A name for messages: short, without control characters."""
    return quoted(name)[1:-1]


def _shown(value: Any) -> str:
    """A value for messages: `0.5`, `"abc"`, `a table`."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        return "a list" if value else "an empty list"
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, float):
        return shortest(value)
    return str(value.isoformat()).replace("+00:00", "Z") if hasattr(value, "isoformat") else str(value).lower()


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class _Reader:
    def __init__(self, document: Document, file: str, problems: Problems) -> None:
        self.document, self.file, self.problems = document, file, problems
        self.known = {"name", "programme"}

    def read(self, name: str) -> Experiment:
        if (stated := self.document.at(("name",))) is not None:
            name = stated if isinstance(stated, str) else ""
            if not isinstance(stated, str):
                self.problem(("name",), "name must be a text")
        start, speed = self.number("plate.start"), self.number("plate.speed")
        sample = self.sample(start)
        box, start = (sample[1], sample[2]) if sample else (self.box(), start)
        pause, hold = (self.number(key) or 0.0 for key in ("plate.pause", "plate.hold"))
        materials, uncertainty = dict[str, float](), dict[str, float]()
        for key in MATERIALS:  # in alphabetical order
            if (value := self.number(key)) is not None:
                materials[key] = value
        for key in UNCERTAIN:
            for sigma in self.sigmas(key):
                uncertainty[key] = sigma
        names = "position_error", "diameter_error", "force_error", "force_threshold"
        errors = Measurement(*(self.number(f"measurement.{error}") or 0.0 for error in names))
        parameters = {key: shortest(value) for key, value in materials.items()} | self.programme(box, start)
        self.report_unknown(self.document.root)
        return Experiment(name, _without_scans(name, parameters, box, start), materials, uncertainty, errors, speed, pause, hold,
                          sample[0] if sample else None)

    def problem(self, where: Where, what: str) -> None:
        line = self.document.lines.get(where)
        self.problems.add("--set" if line is None else f"{self.file}:{line}", what)

    def number(self, name: str, limits: Limits | None = None) -> float | None:
        """None if it is missing or a problem."""
        self.known.add(name)
        where, limits = tuple(name.split(".")), limits or LIMITS[name]
        value = self.document.at(where)
        if value is None or _is_number(value) and limits.contain(value):
            return None if value is None else float(value)
        self.problem(where, f"{name} must be {limits.text}, got {_shown(value)}")
        return None

    def sigmas(self, key: str) -> Iterator[float]:
        """[uncertainty] contains full names of keys ("walls.friction"), or for grains the last word ("friction")."""
        group, _, last = key.partition(".")
        for name in (key, last) if group == "grains" else (key,):
            if (sigma := self.number(f"uncertainty.{name}", Limits(0, 1e15, LIMITS[key].unit))) is not None:
                yield sigma

    def sample(self, start: float | None) -> tuple[Sample, Box, float | None] | None:
        """[sample], if there is one, the container that it means, and its height."""
        stated = self.document.at(("sample",))
        if stated is None:
            return None
        names = "height", "diameter", "area", "mass", "solid_density", "packing_fraction", "wall_friction", "lateral_ratio"
        height, diameter, area, mass, density, fraction, friction, ratio = (self.number(f"sample.{name}") for name in names)
        wrong = [(start is not None) == (height is not None) and "height [m] at no strain, or plate.start, and not both",
                 (diameter is None) == (area is None) and "diameter [m] or area [m2] of its cross-section, and not both",
                 (mass is None) != (density is None) and "mass with solid_density, the density of the grains' material, or neither",
                 mass is not None and fraction is not None and "packing_fraction, or mass and solid_density, and not both",
                 any(self.document.at((table,)) is not None for table in ("box", "container")) and "the container: leave [box] and [container] out"]
        self.known.update(f"{table}.{key}" for table, key in (("box", "size"), ("container", "shape"), ("container", "radius")))
        for what in filter(None, wrong):
            self.problem(("sample",), f"[sample] must state {what}")
        wide, tall = (diameter or math.sqrt(4 * (area or 1) / math.pi)), height or start or 1.0
        section = area or math.pi / 4 * wide**2
        if mass is not None and density is not None:
            fraction = mass / (density * section * tall)
            if fraction > 1:
                self.problem(("sample",), f"[sample] must leave a packing fraction of at most 1, got {fraction:.4g} of mass, solid_density and size")
        found = Sample(section, math.nan if fraction is None else fraction, friction or 0.0, ratio or Sample.lateral_ratio)
        return found, Box(wide, wide, ContainerShape.cylinder), height or start

    def box(self) -> Box:
        where = "container", "shape"
        self.known.add("container.shape")
        word = self.document.at(where)
        shape = ContainerShape.box if word is None else parse(ContainerShape, word) if isinstance(word, str) else None
        if shape in (None, ContainerShape.cell):
            self.problem(where, 'container.shape must be "box", "cylinder" or "periodic": an experiment is a compression by a plate')
            return Box()
        assert shape is not None
        return self.cylinder() if shape == ContainerShape.cylinder else self.rectangle(shape)

    def cylinder(self) -> Box:
        radius = self.number("container.radius")
        if radius is None and self.document.at(("container", "radius")) is None:
            self.problems.add(self.file, "container.radius must be the inner radius of the cylinder [m], such as 0.06")
        return Box(2 * (radius or 0.0), 2 * (radius or 0.0), ContainerShape.cylinder)

    def rectangle(self, shape: ContainerShape) -> Box:
        self.known.add("box.size")
        where = "box", "size"
        size = self.document.at(where)
        if not (isinstance(size, list) and len(size) == 2 and all(map(_is_number, size))):
            what = "box.size must be the inner width and depth of the box, two numbers [m], such as [0.165, 0.166]"
            if size is None:
                self.problems.add(self.file, what)
            else:
                self.problem(where, what)
            return Box(shape=shape)
        for length in size:
            if not 0 < length <= LARGEST_BOX:
                self.problem(where, f"box.size must be > 0 and <= {LARGEST_BOX} [m], got {_shown(length)}: "
                                    "divide by 1000 if it is in millimetres")
        return Box(float(size[0]), float(size[1]), shape)

    def programme(self, box: Box, plate_start: float | None) -> Parameters:
        """The stages, read as in a scene, as parameters of a simulation; empty without a programme."""
        stages = self.document.at(("programme",))
        if stages is None:
            return {}
        if not isinstance(stages, list) or not 1 <= len(stages) <= MOST_STAGES or not all(isinstance(one, dict) for one in stages):
            self.problem(("programme",), f"programme must be a list of 1 to {MOST_STAGES} stages ([[programme]])")
            return {}
        from .. import _engine
        places = {f"programme.{number + 1}.{key}": ("programme", number, key) for number, stage in enumerate(stages) for key in stage}
        texts = [{_encodable(key): _stage_text(key, value) for key, value in stage.items()} for stage in stages]
        start = math.nan if plate_start is None else plate_start
        parameters, found = _engine.programme_parameters(texts, "the grains", box.shape, (box.size_x, box.size_y), start)
        for key, what in found:
            self.problem(places.get(key, ("programme",)), f"{_plain(key)} {what}")
        if plate_start is None:
            self.problem(("programme",), "[[programme]] requires plate.start: its strains are relative to that height")
            return {}
        return parameters

    def report_unknown(self, table: dict[str, Any], prefix: str = "", where: Where = ()) -> None:
        groups = {name[:dot] for name in self.known for dot, sign in enumerate(name) if sign == "."}
        for key in sorted(table):
            name, value = prefix + key, table[key]
            if name in groups and isinstance(value, dict):
                self.report_unknown(value, name + ".", (*where, key))
            elif name not in self.known:
                self.problem((*where, key), f"{_plain(name)} is not a key of an experiment: remove it, or see its README for the names")


def _encodable(text: str) -> str:
    """Without the bytes that are no UTF-8, of an override."""
    return text.encode(errors="replace").decode()


def _stage_text(key: str, value: Any) -> str:
    """TOML. A value that no key of a stage may have is replaced by a similar one."""
    try:
        return _encodable(value_text(key, value))
    except InputError:  # not finite, a date, or a list or table with one
        return "[{}]" if isinstance(value, list) else "{}" if isinstance(value, dict) else str(value)


def settings_text(experiment: Experiment) -> str:
    """The text of experiment.toml, with exact numbers."""
    parameters = experiment.recording.parameters
    tables = [f"[{name}]" + "".join(f"\n{key} = {value}" for key, value in sorted(values.items()))
              for name, values in sorted(_tables(experiment).items())]
    if has_programme(parameters):
        from .. import _engine
        tables.append(_engine.programme_text(parameters))
    return "\n\n".join([f"name = {_text(experiment.name)}", *tables]) + "\n"


def _tables(experiment: Experiment) -> dict[str, dict[str, str]]:
    """The keys of each table with their values as text."""
    materials = {group: _of_group(experiment.materials, group) for group in ("grains", "walls")}
    sigmas = {f"uncertainty.{group}": _of_group(experiment.uncertainty, group) for group in ("grains", "walls")}
    if zero := _of_group(experiment.uncertainty, "plate"):
        sigmas["uncertainty.plate"] = zero
    plate = {"start": experiment.recording.plate_start, "pause": experiment.plate_pause, "hold": experiment.plate_hold}
    plate = {key: value for key, value in plate.items() if key == "start" or value > 0}
    if experiment.plate_speed is not None:
        plate["speed"] = experiment.plate_speed
    tables = {group: {key: _number(value) for key, value in values.items()}
              for group, values in {**materials, **sigmas, "plate": plate, "measurement": asdict(experiment.measurement)}.items()}
    box = experiment.recording.box
    if (sample := experiment.sample) is not None:
        stated = {key: value for key, value in asdict(sample).items() if math.isfinite(value)}
        return tables | {"sample": {key: _number(value) for key, value in stated.items()}}
    if box.shape != ContainerShape.box:
        tables["container"] = {"shape": _text(box.shape)}
    if box.is_cylinder:
        tables["container"]["radius"] = _number(box.size_x / 2)
    else:
        tables["box"] = {"size": f"[ {_number(box.size_x)}, {_number(box.size_y)} ]"}
    return tables


def _of_group(values: dict[str, float], group: str) -> dict[str, float]:
    """Without the name of the group."""
    return {key.removeprefix(group + "."): value for key, value in values.items() if key.startswith(group + ".")}


def _number(value: float) -> str:
    """With a point or an exponent, which make it a TOML number that is not whole."""
    text = f"{value:.17g}"
    return text + ".0" if text.lstrip("-").isdigit() else text


def _text(text: str) -> str:
    """In single quotes, or if that is impossible in double quotes with escapes."""
    if "'" in text or re.search(CONTROL, text):
        return '"' + re.sub(f'["\\\\]|{CONTROL}', _escaped, text) + '"'
    return f"'{text}'"


def _escaped(found: re.Match[str]) -> str:
    """A byte that is no UTF-8 becomes the character with its number."""
    code = ord(found[0])
    return ESCAPES.get(found[0], f"\\u{code & 0xff if code >= 0xd800 else code:04X}")
