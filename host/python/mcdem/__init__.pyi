from collections.abc import Callable, Iterator, Mapping, Sequence
import pathlib
from os import PathLike
from typing import Any, Literal, TypedDict, overload

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str
Path = str | PathLike[str]

class Device(TypedDict):
    index: int
    name: str
    platform: str
    version: str
    gpu: bool
    double_precision: bool
    compute_units: int
    memory: int

class Gap(TypedDict):
    detected: bool
    p_value: float | None
    p_omnibus: float | None
    p_directed: float | None

class Where(TypedDict):
    observable: str
    phase: Literal["load", "unload"] | None
    displacement_mm: list[float]
    region: str | None
    z_score: float | None
    z_score_refitted: float | None
    force_class: str | None
    difference: float | None

class Cell(TypedDict):
    observable: str
    phase: Literal["load", "unload"] | None
    displacement_mm: float | None
    z_score: float | None
    z_score_refitted: float | None
    difference: float | None


class Cause(TypedDict):
    effect: str
    amplitude: float | None
    unit: str
    confidence: float | None
    group: list[str]
    amplitude_error: float | None
    at_limit: bool
    explained: float | None
    score: float | None
    confirmed_score: float | None

class Nuisance(TypedDict):
    name: str
    shift: float | None
    error: float | None
    prior: float | None
    unit: str
    at_bound: bool

class TopForce(TypedDict):
    displacement_mm: float | None
    experiment_N: float | None
    before_N: float | None
    after_N: float | None

class Shrink(TypedDict):
    held_out: str
    before: float | None
    after: float | None
    fraction: float | None
    interval: list[float | None]
    placebo: float | None
    metrics: dict[str, list[float | None]]
    confirmed: float | None
    fitted_displacement_mm: list[float | None]
    top_force: list[TopForce]

class DetectionLimit(TypedDict):
    effect: str
    minimum_amplitude: float | None
    absorbed_by_calibration: float | None
    unit: str
    group: list[str]

class Explanation(TypedDict):
    reduction: float | None
    simulated: bool
    held_out: bool
    placebo: float | None
    needed: float | None
    remainder: float | None
    remainder_p: float | None
    leaves_more_than_noise: bool
    without: str

class Refinement(TypedDict):
    effect: str
    key: str
    was: float
    to: float
    unit: str
    done: bool

class NextStep(TypedDict):
    what: str
    power: float | None

class PackingAgreement(TypedDict):
    experiment: str
    gap_p: float | None
    amplitude: float | None
    amplitude_error: float | None
    agreement_p: float | None
    differs: bool

class Diagnosis(TypedDict):
    """diagnosis.json; host/python/mcdem/diagnosis/DIAGNOSIS_OUTPUT.md explains the keys."""

    verdict: Literal["no_gap", "effect", "group", "unknown_effect", "not_converged", "calibration_suspect"]
    gap: Gap
    where: list[Where]
    causes: list[Cause]
    explanation: Explanation | None
    shrink: Shrink | None
    detection_limits: list[DetectionLimit]
    not_measured: list[str]
    seconds: float
    sentence: str
    where_threshold: float | None
    cells: list[Cell]
    ranking: list[Cause]
    nuisances: list[Nuisance]
    not_testable: list[str]
    refinements: list[Refinement]
    next: list[NextStep]
    packings: list[PackingAgreement]
    provenance: dict[str, str]

class Scene:
    def __init__(self, tables: Mapping[str, Any] = ..., /, **more: Any) -> None: ...
    @staticmethod
    def read(file: Path, *, set: Mapping[str, Any] = ...) -> Scene: ...
    @staticmethod
    def parse(text: str, *, set: Mapping[str, Any] = ...) -> Scene: ...
    @property
    def name(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def labels(self) -> list[str]: ...
    @property
    def parameters(self) -> list[dict[str, int | float | str | None]]: ...
    def __len__(self) -> int: ...

class Failure:
    @property
    def step(self) -> int: ...
    @property
    def grain(self) -> int: ...
    @property
    def cause(self) -> str: ...

class Recording:
    @property
    def label(self) -> str: ...
    @property
    def parameters(self) -> dict[str, int | float | str | None]: ...
    @property
    def box(self) -> tuple[float, float]: ...
    @property
    def plate_start(self) -> float: ...
    @property
    def container(self) -> Literal["box", "cylinder", "periodic", "cell"]: ...
    @property
    def failure(self) -> Failure | None: ...
    @property
    def diameter(self) -> NDArray[numpy.float64]: ...
    @property
    def species(self) -> NDArray[numpy.int32]: ...
    @property
    def species_names(self) -> list[str]: ...
    @property
    def scans(self) -> NDArray[numpy.void]: ...
    @property
    def wall_force(self) -> NDArray[numpy.float64]: ...
    @property
    def top_force(self) -> NDArray[numpy.float64]: ...
    @property
    def strain(self) -> NDArray[numpy.float64]: ...
    @property
    def stress(self) -> NDArray[numpy.float64]: ...
    @property
    def fabric(self) -> NDArray[numpy.float64]: ...
    def grain_stress(self, scan: int) -> NDArray[numpy.float64]: ...
    def positions(self, scan: int) -> NDArray[numpy.float64]: ...
    def rotations(self, scan: int) -> NDArray[numpy.float64]: ...
    def contacts(self, scan: int) -> NDArray[numpy.void]: ...
    def __len__(self) -> int: ...

class Run:
    @property
    def name(self) -> str: ...
    @property
    def scene(self) -> str: ...
    @property
    def program(self) -> str: ...
    @property
    def device(self) -> str: ...
    @property
    def precision(self) -> Literal["float", "double"]: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int) -> Recording: ...
    @overload
    def __getitem__(self, label: str) -> Recording: ...
    def __iter__(self) -> Iterator[Recording]: ...

def devices() -> list[Device]: ...
def simulate(scene: Scene, *, device: str = "", progress: Callable[[float], object] | None = None) -> Run: ...
def run(
    scene: Scene,
    folder: Path,
    *,
    resume: bool = False,
    device: str = "",
    progress: Callable[[float], object] | None = None,
) -> Run: ...
def forces_along(
    scene: Scene,
    time: ArrayLike,
    position: ArrayLike,
    velocity: ArrayLike | None = None,
    spin: ArrayLike | None = None,
    *,
    device: str = "",
) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]: ...
def read(
    path: Path, *, what: Literal["everything", "observables", "positions", "contacts"] = "everything"
) -> Run: ...
def compare(
    run: Run,
    reference: Run | Path,
    *,
    setting: str = "",
    discard: int = 0,
    touch_force: float | None = None,
) -> list[dict[str, Any]]: ...
def calibrate(
    scene: Scene,
    reference: Run | Path,
    *,
    setting: str = "",
    discard: int = 0,
    low: float = 0.5,
    high: float = 1.5,
    tolerance: float = 0.005,
    batch: int = 6,
    rounds: int = 8,
    model: str | None = None,
    fit: Sequence[str] = (),
    compare: Sequence[str] = (),
    device: str = "",
    progress: Callable[[float], object] | None = None,
) -> dict[str, Any]: ...
def export(
    path: Path,
    folder: Path,
    *,
    vtk: bool = False,
    xyz: bool = False,
    replicas: Sequence[int] = (),
    scans: Sequence[int] = (),
) -> int: ...
def report(
    sources: Path | Sequence[Path],
    out: Path,
    *,
    against: Path | Sequence[Path] = (),
    setting: str = "",
    scans: int | None = None,
) -> pathlib.Path: ...
def converge(
    scene: Scene,
    folder: Path,
    *,
    replicas: int = 32,
    force_limit: float = 0.005,
    sd_limit: float = 0.5,
    jitter: float = 0.0,
    seed: int = 1,
    device: str = "",
    progress: Callable[[str, float], object] | None = None,
) -> dict[str, Any]: ...
def diagnose(
    scene: Scene,
    experiment: Path | Sequence[Path],
    folder: Path,
    *,
    candidates: Sequence[str] = ...,
    replicates: int = 32,
    pairs: int = 8,
    confirmations: int = 8,
    refine: float = 4.0,
    seed: int = 1,
    library: Path | None = None,
    device: str = "",
    page: bool = True,
    progress: Callable[[str, float], object] | None = None,
) -> Diagnosis: ...
