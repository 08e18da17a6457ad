"""JSON of vectors and matrices, with null for NaN."""
import math
from typing import Any

import numpy as np

from ..results.recording import Floats


class JsonError(ValueError):
    """The JSON is not what is expected."""


def expect_json(right: bool, what: str) -> None:
    """Raises JsonError if `right` is false."""
    if not right:
        raise JsonError(what)


def number_list(values: Floats) -> list[Any]:
    """JSON of a vector, or of a matrix by rows; a number that is not finite becomes None."""
    values = np.asarray(values, float)
    listed = values.astype(object)
    listed[~np.isfinite(values)] = None
    return list(listed.tolist())


def array_of(values: list[float | None]) -> Floats:
    """The vector of a JSON list; None becomes NaN."""
    expect_json(isinstance(values, list) and {type(value) for value in values} <= {float, int, type(None)}, "it has no list of numbers")
    array = np.array(values, float)
    expect_json(not np.isinf(array).any(), "it has a number that is not finite")
    return array


def number_of(value: Any) -> float:
    """A finite number."""
    expect_json(type(value) in (float, int) and math.isfinite(value), "it has something else than a finite number")
    return float(value)


def whole_of(value: Any) -> int:
    expect_json(type(value) is int, "it has something else than a whole number")
    return int(value)


def texts_of(value: Any) -> dict[str, str]:
    expect_json(isinstance(value, dict) and all(isinstance(text, str) for text in value.values()), "it has something else than texts by name")
    return dict(value)


def matrix_of(rows: list[list[float | None]]) -> Floats:
    """The matrix of a JSON list of rows; (0, 0) without rows."""
    expect_json(isinstance(rows, list), "it has no list of rows")
    arrays = [array_of(row) for row in rows]
    expect_json(len({len(row) for row in arrays}) <= 1, "its rows are of unequal length")
    return np.array(arrays) if arrays else np.zeros((0, 0))
