"""Python values as TOML: keys of a scene and their values."""
import json
import math
import os
import re
from collections.abc import Iterator, Mapping
from typing import Any

from .errors import InputError

MAX_ITEMS = 1_000_000  # in a list; a scene has at most a MiB of text


def toml_value(value: object) -> str:
    """On one line. As JSON, but in tables a key is followed by `=`, not by `:`."""
    return json.dumps(value, ensure_ascii=False, separators=(", ", " = ")).replace("\x7f", "\\u007f")


def value_text(key: str, value: object) -> str:
    """The value of a key as TOML. Raises InputError."""
    return toml_value(_plain(value, key))


def assignments(values: Mapping[Any, Any]) -> list[str]:
    """`key = value` for each entry of nested tables, with dotted keys: lines of a scene, or overrides. Raises InputError."""
    try:
        return list(_assignments(values, ""))
    except RecursionError:
        raise InputError("tables and lists must be nested less deeply: does one hold itself?") from None


def _assignments(table: Mapping[Any, Any], inside: str) -> Iterator[str]:
    for key, value in table.items():
        name = inside + _key_text(key)
        if isinstance(value, Mapping) and value:
            yield from _assignments(value, name + ".")
        else:
            yield f"{name} = {value_text(name, value)}"


def _key_text(key: object) -> str:
    """Dotted keys remain dotted."""
    if not isinstance(key, str):
        raise InputError(f"a key must be text, got {key!r}")
    return key if re.fullmatch(r"[\w.-]+", key, re.ASCII) else toml_value(key)


def _plain(value: Any, name: str) -> Any:
    """The value made of types that json knows."""
    if hasattr(value, "tolist"):  # arrays and scalars of NumPy
        value = value.tolist()
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, os.PathLike):
        return os.fsdecode(value)
    if isinstance(value, Mapping):
        return {str(key): _plain(one, f"{name}.{key}") for key, one in value.items()}
    if hasattr(value, "__getitem__") and hasattr(value, "__len__"):
        if len(value) > MAX_ITEMS:
            raise InputError(f"{name} must be a list of at most {MAX_ITEMS} values, got more")
        return [_plain(one, name) for one in value]
    if hasattr(value, "__index__"):
        return int(value)
    if hasattr(value, "__float__") and math.isfinite(value):
        return float(value)
    raise InputError(f"{name} must be a finite number, true or false, text, a list or a table, got {value!r}")
