# The compiled module (host/python): what the package itself uses. `import mcdem` gives what users need (__init__.pyi).
from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .results.recording import Floats

__version__: str
Path = str | PathLike[str]
Progress = Callable[[float], object] | None  # is told the fraction that is done

KeyValue = str | float | bool | Sequence[float]

class Scene:
    name: str
    text: str
    labels: list[str]
    parameters: list[dict[str, int | float | str | None]]  # by replica
    _texts: dict[str, str]  # every key of the first replica with its value, in the order of the reference
    _values: dict[str, Any]  # the same as numbers, truths and texts; None for what is not given
    def _changed(self, values: Mapping[str, KeyValue]) -> Scene: ...  # all replicas, checked, on the packings that they have
    def _variant(self, values: Mapping[str, KeyValue]) -> Scene: ...  # the first replica, without checks of ranges
    def _with_programme(self, parameters: Mapping[str, str]) -> Scene: ...  # of a recording; none: strokes
    def _with_box(self, shape: str, size_x: float, size_y: float) -> Scene: ...
    def __len__(self) -> int: ...
    @staticmethod
    def read(file: Path, *, set: Mapping[str, Any] = ...) -> Scene: ...
    @staticmethod
    def parse(text: str, *, set: Mapping[str, Any] = ...) -> Scene: ...

class Failure:
    step: int
    grain: int
    cause: str

class Recording:
    label: str
    _parameter_texts: dict[str, str]
    box: tuple[float, float]
    plate_start: float
    container: str
    failure: Failure | None
    diameter: Floats
    species: NDArray[np.int32]
    species_names: list[str]
    scans: NDArray[np.void]
    wall_force: Floats
    strain: Floats
    stress: Floats
    fabric: Floats
    def positions(self, scan: int) -> Floats: ...
    def rotations(self, scan: int) -> Floats: ...
    def contacts(self, scan: int) -> NDArray[np.void]: ...
    def __len__(self) -> int: ...

class Run:
    name: str
    scene: str
    program: str
    device: str
    precision: str
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Recording]: ...

def scene_of_options(file: str, overrides: Sequence[str]) -> tuple[Scene, list[str]]: ...
def manifest_of(scene: Scene) -> dict[str, str]: ...
def expect_plain_strokes(scene: Scene, what: str) -> None: ...
def expect_plate(scene: Scene, what: str) -> None: ...
def key_unit(key: str) -> str: ...
def key_range(key: str) -> tuple[float, float, bool] | None: ...  # limits, and whether the low one is excluded; None: no key of a decimal number

class Random:
    """Random numbers of a seed and a stream (host/core/random.h)."""

    def __init__(self, seed: int, stream: str) -> None: ...
    def uniform(self, low: float = 0.0, high: float = 1.0) -> float: ...
    def normals(self, count: int) -> Floats: ...
    def shuffled(self, count: int) -> list[int]: ...

def read(path: Path, *, what: str = "everything") -> Run: ...
def read_replica(path: Path, number: int) -> Run: ...  # one recording
def programme_parameters(stages: Sequence[Mapping[str, str]], name: str, shape: str, size: tuple[float, float],
                         plate_start: float) -> tuple[dict[str, str], list[tuple[str, str]]]: ...  # parameters; problems: key, what
def programme_text(parameters: Mapping[str, str]) -> str: ...
def scan_places(parameters: Mapping[str, str], plate_start: float) -> list[dict[str, Any]]: ...

class Device:
    """An OpenCL device with its queue."""

    description: str  # name and driver
    name: str
    def __init__(self, choice: str = "") -> None: ...

class Packing:
    """Grains from which a simulation starts: position (grains, 3), diameter (grains,) [m]."""

    diameter: Floats
    digest: str  # SHA-256 of everything from which a simulation starts
    def __init__(self, position: Floats, diameter: Floats | Sequence[float]) -> None: ...
    def __len__(self) -> int: ...

def make_packings(scene: Scene, seeds: Sequence[int] = ()) -> list[Packing]: ...  # of each replica, or of the first with each seed

# A scene, whose first replica is simulated, its packing, standard deviations of the noise on coordinates and on diameters [m], and the seed of
# both and of random properties of the grains.
Start = tuple[Scene, Packing, float, float, int]

def simulate_starts(device: Device, starts: Sequence[Start], *, scans: int | None = None, end_below: Sequence[float] = (),
                    progress: Progress = None) -> Run:
    """Simulates all together, with positions and contacts, until every one has `scans` scans (None: all) or has failed.

    `end_below`: for each, the displacement of the plate below which, on its last way back, it ends [m].
    """

def write_recording(file: Path, run: Run, number: int) -> None: ...  # one recording as a run
def kernels_digest() -> str: ...  # SHA-256 of their program text
def derived_seed(seed: int, number: int) -> int: ...

class Batch:
    """The packings of a scene, one for each of its replicas, and simulations of variants of the scene on them (host/python/batch_class.cpp)."""

    packings: int  # their number
    mean_diameter: float  # of all grains [m]
    device_name: str
    def __init__(self, scene: Scene, device: str) -> None: ...
    def simulate(self, changes: Sequence[Mapping[str, KeyValue]], scans: int, progress: Progress = None) -> Run:
        """All replicas with each of `changes` of their keys, in this order, until every one has `scans` scans or has failed."""
