"""Standard normal numbers that depend on a key and not on the order of calls: what two packings have in common gets the same numbers,
whatever else they contain."""
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..results.recording import Floats

Words = NDArray[np.uint64]

# Streams of random numbers (host/core/random.h); those with the same seed are independent.
MEASURED_DIAMETERS, MEASURED_POSITIONS, MEASURED_FORCES, SEEN_CONTACTS = 4, 5, 6, 10


def scattered(x: Words) -> Words:
    """splitmix64 (Steele, Lea & Flood 2014): hash that makes consecutive numbers independent."""
    x = x + np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


def keyed_normals(seed: int, stream: int, first: Any, second: Any) -> Floats:
    """One number for each pair of the whole numbers `first` and `second`, which are broadcast (Box & Muller 1958)."""
    base = scattered(scattered(np.array([seed], np.uint64)) + np.uint64(stream))
    bits = scattered(scattered(base + np.asarray(first).astype(np.uint64)) + np.asarray(second).astype(np.uint64))
    normals: Floats = np.sqrt(-2 * np.log(_unit_interval(bits))) * np.cos(2 * np.pi * _unit_interval(scattered(bits)))
    return normals


def _unit_interval(bits: Words) -> Floats:
    """Uniform in the open interval (0, 1), from the upper bits."""
    return ((bits >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53
