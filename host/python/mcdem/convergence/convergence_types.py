"""Results of `mcdem converge`, named after the keys of convergence.json."""
from dataclasses import dataclass

RELATIVE = ("top_force", "mean_force")  # observables that are logarithms, so that their errors are relative


@dataclass(frozen=True)
class Limits:
    """Largest errors allowed: relative ones of forces, and of all else in standard deviations of one packing's replicates."""

    force: float = 0.005
    deviations: float = 0.5


@dataclass(frozen=True)
class BinError:
    """Error of an observable at one phase and displacement: the scene minus the limit of infinitely fine numerics.

    `mean` and `standard_deviation` are those of the scene's replicas. All but the displacement is in units of the observable.
    """

    observable: str
    phase: str  # load, unload
    displacement_mm: float
    mean: float
    standard_deviation: float
    error: float
    standard_error: float
    follows_order: bool  # False: the steps are inconsistent, and `error` is the difference of the last step, a lower limit
    limit: float  # largest error allowed
    beyond: bool  # significantly beyond the limit

    @property
    def is_relative(self) -> bool:
        return self.observable in RELATIVE

    @property
    def over_limit(self) -> float:
        return self.error / self.limit


@dataclass(frozen=True)
class CauseErrors:
    """Errors from one cause; those that are unknown are left out."""

    cause: str  # "plate speed"
    errors: tuple[BinError, ...]


@dataclass(frozen=True)
class Convergence:
    """`copies` describes the replicas; `words`: the result, and one sentence for each cause."""

    scene: str
    replicas: int
    copies: str
    words: tuple[str, ...]
    limits: Limits
    causes: tuple[CauseErrors, ...]
    seconds: float


def unit_of(bin: BinError, limits: Limits) -> tuple[float, str]:
    """The unit in which an error is shown: per cent for forces, otherwise the standard deviation of one packing's replicates."""
    return (0.01, "%") if bin.is_relative else (bin.limit / limits.deviations, "sd")
