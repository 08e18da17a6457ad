"""Values of dataclasses from JSON of others: everything is checked, and the first invalid value is named."""
import dataclasses
import functools
import json
import math
import types
import typing
from typing import Any, TypeVar

Value = TypeVar("Value")

KINDS = {dict: "an object", list: "a list", str: "a text", bool: "true or false", float: "a number", int: "a whole number",
         type(None): "null"}


class Invalid(ValueError):
    """What is invalid, and where."""


def finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise Invalid(f"parse error: {text[:20]} is not a finite number")
    return value


def parsed(content: bytes) -> Any:
    """The document of an UTF-8 file, all of its numbers as float. Raises Invalid."""
    try:
        return json.loads(content.decode("utf-8-sig"), parse_float=finite, parse_int=finite, parse_constant=finite)
    except json.JSONDecodeError as error:
        raise Invalid(f"parse error at line {error.lineno}, column {error.colno}: {error.msg}") from error
    except UnicodeDecodeError as error:
        raise Invalid(f"parse error at byte {error.start}: invalid UTF-8") from error
    except RecursionError as error:
        raise Invalid("parse error: too many lists within one another") from error


def _expect(value: Any, kind: type, place: str) -> None:
    found = float if isinstance(value, int) and not isinstance(value, bool) else type(value)
    if found is not kind:
        raise Invalid(f"{place or 'the document'}: must be {KINDS[kind]}, got {KINDS[found]}")


def _text(value: Any, place: str) -> str:
    _expect(value, str, place)
    if not value.isascii() and any("\ud800" <= c <= "\udfff" for c in value):
        raise Invalid(f"{place}: must be Unicode, got half a surrogate pair")
    return str(value)


def _whole(value: Any, place: str) -> int:
    _expect(value, float, place)
    if not float(value).is_integer():
        raise Invalid(f"{place}: must be {KINDS[int]}, got {value}")
    return int(value)


def _items(value: Any, kinds: tuple[Any, ...], place: str) -> tuple[Any, ...]:
    _expect(value, list, place)
    if kinds[1:] == (...,):
        kinds = (kinds[0],) * len(value)
    elif len(value) != len(kinds):
        raise Invalid(f"{place}: must be a list of {len(kinds)}, got {len(value)}")
    return tuple(value_of(kind, item, f"{place}[{k}]") for k, (kind, item) in enumerate(zip(kinds, value)))


def value_of(kind: Any, value: Any, place: str) -> Any:
    """The value as `kind`: float, int, bool, str, tuples, dicts, dataclasses, and None for `kind | None`; NaN for a number that is
    null. Raises Invalid, which begins with `place`."""
    if isinstance(kind, types.UnionType):
        return None if value is None else value_of(kind.__args__[0], value, place)
    if dataclasses.is_dataclass(kind):
        return object_of(typing.cast(type, kind), value, place)
    if kind is str:
        return _text(value, place)
    if kind is int:
        return _whole(value, place)
    if kind is float and value is None:
        return math.nan
    if kind in (float, bool):
        _expect(value, kind, place)
        return kind(value)
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is tuple:
        return _items(value, arguments, place)
    _expect(value, dict, place)
    return {_text(key, place): value_of(arguments[1], item, f"{place}.{key}") for key, item in value.items()}


@functools.cache
def _hints(kind: Any) -> dict[str, Any]:
    return typing.get_type_hints(kind)


def object_of(kind: type[Value], value: Any, place: str = "") -> Value:
    """The dataclass from an object whose keys are its fields; others are ignored. A field may be missing if it has a default, and
    is metadata["null"] where the object has null. Raises Invalid."""
    _expect(value, dict, place)
    hints = _hints(typing.cast(Any, kind))
    values = {}
    for part in dataclasses.fields(typing.cast(Any, kind)):
        where = f"{place}.{part.name}" if place else part.name
        if part.name not in value:
            if part.default is dataclasses.MISSING:
                raise Invalid(f"{where}: is missing")
        elif value[part.name] is None and "null" in part.metadata:
            values[part.name] = part.metadata["null"]
        else:
            values[part.name] = value_of(hints[part.name], value[part.name], where)
    return kind(**values)
