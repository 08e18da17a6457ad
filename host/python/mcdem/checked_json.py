"""Dataclasses as JSON, and back from JSON of others: everything is checked, and the first invalid value is named.

Fields are float, int, bool, str, enumerations, arrays, lists, tuples, dicts, dataclasses, or one of these and None. Numbers that are not
finite are null in JSON, which is NaN. Metadata of a field: "null" is the value that is null in JSON, "then" a property that follows it.
"""
import dataclasses
import enum
import functools
import json
import math
import types
import typing
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Value = TypeVar("Value")

KINDS = {dict: "an object", list: "a list", str: "a text", bool: "true or false", float: "a number", int: "a whole number",
         type(None): "null"}


class Invalid(ValueError):
    """What is invalid, and where."""


def expect(right: bool, what: str) -> None:
    """Raises Invalid if `right` is false."""
    if not right:
        raise Invalid(what)


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


def _is_enumeration(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, enum.IntEnum)


def _array(value: Any, place: str) -> NDArray[np.float64]:
    """A vector, or a matrix by rows; (0, 0) for an empty list."""
    _expect(value, list, place)
    rows = value if not value or isinstance(value[0], list) else [value]
    for row in rows:
        expect(isinstance(row, list) and {type(number) for number in row} <= {float, int, type(None)}, f"{place}: must be numbers")
    expect(len({len(row) for row in rows}) <= 1, f"{place}: its rows are of unequal length")
    array = np.array(rows, float).reshape(len(rows), -1 if rows else 0)
    expect(not np.isinf(array).any(), f"{place}: has a number that is not finite")
    return array if rows is value else np.asarray(array[0])


def _items(value: Any, kinds: tuple[Any, ...], place: str, defaults: bool) -> tuple[Any, ...]:
    _expect(value, list, place)
    if kinds[1:] in ((...,), ()):
        kinds = (kinds[0],) * len(value)
    elif len(value) != len(kinds):
        raise Invalid(f"{place}: must be a list of {len(kinds)}, got {len(value)}")
    return tuple(value_of(kind, item, f"{place}[{k}]", defaults) for k, (kind, item) in enumerate(zip(kinds, value)))


def value_of(kind: Any, value: Any, place: str, defaults: bool = True) -> Any:
    """The value as `kind`. Raises Invalid, which begins with `place`. `defaults`: as of object_of."""
    if isinstance(kind, types.UnionType):
        return None if value is None else value_of(kind.__args__[0], value, place, defaults)
    if dataclasses.is_dataclass(kind):
        return object_of(typing.cast(Any, kind), value, place, defaults)
    if _is_enumeration(kind):
        expect(isinstance(value, str) and value in kind.__members__, f"{place}: there is no {json.dumps(value, ensure_ascii=False)}")
        return kind[value]
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
    if origin is np.ndarray:
        return _array(value, place)
    if origin in (tuple, list):
        items = _items(value, arguments, place, defaults)
        return items if origin is tuple else list(items)
    _expect(value, dict, place)
    return {_text(key, place): value_of(arguments[1], item, f"{place}.{key}", defaults) for key, item in value.items()}


@functools.cache
def _hints(kind: Any) -> dict[str, Any]:
    return typing.get_type_hints(kind)


def object_of(kind: Callable[..., Value], value: Any, place: str = "", defaults: bool = True) -> Value:
    """The dataclass from an object whose keys are its fields; others are ignored. With `defaults` a field may be missing if it has one.
    Raises Invalid."""
    _expect(value, dict, place)
    hints = _hints(typing.cast(Any, kind))
    values = {}
    for part in dataclasses.fields(typing.cast(Any, kind)):
        where = f"{place}.{part.name}" if place else part.name
        if part.name not in value:
            if part.default is dataclasses.MISSING or not defaults:
                raise Invalid(f"{where}: is missing")
        elif value[part.name] is None and "null" in part.metadata:
            values[part.name] = part.metadata["null"]
        else:
            values[part.name] = value_of(hints[part.name], value[part.name], where, defaults)
    return kind(**values)


def json_of(kind: Any, value: Any) -> Any:
    """The JSON of a value of this kind; keys of objects are in the order of the fields."""
    if isinstance(kind, types.UnionType):
        return None if value is None else json_of(kind.__args__[0], value)
    if dataclasses.is_dataclass(kind):
        return _object_json(typing.cast(Any, kind), value)
    if kind is float:
        return float(value) if math.isfinite(value) else None
    if _is_enumeration(kind):
        return value.name
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is np.ndarray:
        return np.where(np.isfinite(value), value, np.array(None)).tolist()
    if origin in (tuple, list):
        return [json_of(arguments[0], item) for item in value]
    if origin is dict:
        return {key: json_of(arguments[1], item) for key, item in value.items()}
    return kind(value)


def _object_json(kind: Any, value: Any) -> dict[str, Any]:
    hints, made = _hints(kind), dict[str, Any]()
    for part in dataclasses.fields(kind):
        content = getattr(value, part.name)
        is_null = part.metadata.get("null") == "" and content == ""
        made[part.name] = None if is_null else json_of(hints[part.name], content)
        if "then" in part.metadata:
            made[part.metadata["then"]] = json_of(float, getattr(value, part.metadata["then"]))
    return made
