"""Diagnoses as JSON; host/diagnose/DIAGNOSIS_OUTPUT.md describes the keys, mcdem.report.diagnosis reads them."""
import dataclasses
import math
import types
import typing
from typing import Any

from ..json_text import json_text
from .diagnosis_types import Diagnosis


def _value(kind: Any, value: Any) -> Any:
    """A value of a field, whose type is `kind`."""
    if isinstance(kind, types.UnionType):
        return None if value is None else _value(kind.__args__[0], value)
    if dataclasses.is_dataclass(kind):
        return _object(value)
    if kind is float:
        return float(value) if math.isfinite(value) else None
    arguments = typing.get_args(kind)
    if typing.get_origin(kind) is tuple:
        return [_value(arguments[0], item) for item in value]
    if typing.get_origin(kind) is dict:
        return {key: _value(arguments[1], item) for key, item in value.items()}
    return kind(value)


def _object(value: Any) -> dict[str, Any]:
    """Keys are the fields, and the properties that metadata["then"] puts behind them."""
    made: dict[str, Any] = {}
    for part in dataclasses.fields(value):
        content = getattr(value, part.name)
        made[part.name] = None if content == part.metadata.get("null") == "" else _value(part.type, content)
        if "then" in part.metadata:
            made[part.metadata["then"]] = _value(float, getattr(value, part.metadata["then"]))
    return made


def diagnosis_json(diagnosis: Diagnosis) -> str:
    """Indented JSON with keys in the documented order and a final line feed. Numbers that are not finite become null; what was
    invalid UTF-8 becomes replacement characters."""
    written = _object(dataclasses.replace(diagnosis, provenance=dict(sorted(diagnosis.provenance.items()))))
    return json_text(written)
