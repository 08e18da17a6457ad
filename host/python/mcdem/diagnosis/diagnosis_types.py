"""Results of a diagnosis: the content of diagnosis.json and of the page. host/python/mcdem/diagnosis/DIAGNOSIS_OUTPUT.md explains the keys, which the
fields are named after and in whose order they are.

What files of earlier versions lack has a default value. Amplitudes are in their own `unit` (SI; empty: a pure number).
"""
from dataclasses import dataclass, field
from enum import StrEnum
from math import inf, isfinite

Pair = tuple[float, float]

NO_TEXT, INFINITE, ZERO = ({"null": value} for value in ("", inf, 0.0))  # values for null; NaN for other numbers


class Verdict(StrEnum):
    no_gap = "no_gap"  # no detectable gap
    effect = "effect"  # one effect explains it
    group = "group"  # one of several effects that these data cannot distinguish
    unknown_effect = "unknown_effect"  # a gap, but no effect of the library takes away enough of it
    not_converged = "not_converged"  # the simulation's own numerics explain it: a setting must be refined
    calibration_suspect = "calibration_suspect"  # a stated parameter is far outside its uncertainty


def millimetres(metres: float) -> float:
    """Rounded to a nanometre, to remove noise in the last digits."""
    return round(metres * 1e9) / 1e6


@dataclass(frozen=True)
class Gap:
    detected: bool
    p_value: float  # smaller p of the two tests, with Bonferroni correction
    p_omnibus: float
    p_directed: float


@dataclass(frozen=True)
class WhereEntry:
    """Part of the data with a significant gap."""
    observable: str
    phase: str = field(metadata=NO_TEXT)  # load, unload, or empty for both
    displacement_mm: Pair  # of the plate, from - to
    region: str | None
    z_score: float  # gap over its noise
    z_score_refitted: float  # the same after refitting the nuisances
    force_class: str | None
    difference: float = 0  # measured minus simulated at the most significant bin, in the observable's unit


@dataclass(frozen=True)
class WhereBin:
    """One observable at one displacement, significant or not."""
    observable: str
    phase: str = field(metadata=NO_TEXT)
    displacement_mm: float
    z_score: float
    z_score_refitted: float
    difference: float = 0  # measured minus simulated, in the observable's unit


@dataclass(frozen=True)
class Cause:
    effect: str
    amplitude: float
    unit: str
    confidence: float  # probability among all effects
    group: tuple[str, ...]  # effects that these data cannot distinguish from it, including itself
    amplitude_error: float = field(metadata=INFINITE)  # one sigma
    at_limit: bool  # within one sigma of the end of its range: it may also be larger
    explained: float  # fraction of the chi-square of all differences, including noise
    score: float  # gain in log likelihood over no effect, nuisances refitted in both
    confirmed_score: float | None  # the same from real runs at the fitted amplitude


@dataclass(frozen=True)
class Explanation:
    """How much of the gap the named explanation, otherwise the best one, takes away. The verdict depends on it."""
    reduction: float  # fraction of the gap that it takes away
    simulated: bool  # from real runs, otherwise from signatures
    held_out: bool  # of the gap in held-out data; otherwise these show none, so of the whole gap
    placebo: float  # reduction by the best of random signatures
    needed: float = field(metadata={"then": "remainder"})  # reduction that is required to name an effect
    remainder_p: float
    leaves_more_than_noise: bool
    without: str  # displacement and phase left out, where grains may have rearranged; empty: none

    @property
    def remainder(self) -> float:
        return 1 - self.reduction


@dataclass(frozen=True)
class TopForce:
    """Forces on the plate at one displacement during loading."""
    displacement_mm: float
    experiment_N: float
    before_N: float
    after_N: float


@dataclass(frozen=True)
class GapReduction:
    held_out: str  # which part of the data
    before: float  # gap without noise: sum over bins of squared differences in sigmas
    after: float
    fraction: float  # 1 - after/before
    interval: Pair  # 90 %
    placebo: float
    metrics: dict[str, Pair]  # Rtop, errf [N], errZ, bhat, as far as known: before and after
    confirmed: float | None  # fraction from real runs
    fitted_displacement_mm: Pair  # where the effect was fitted; equal ends: not one interval
    top_force: tuple[TopForce, ...]


@dataclass(frozen=True)
class DetectionLimit:
    effect: str
    minimum_amplitude: float = field(metadata=INFINITE)  # infinite: these data cannot show the effect
    absorbed_by_calibration: float  # fraction of its signature that nuisances absorb
    unit: str
    group: tuple[str, ...]  # effects that cannot be distinguished from it at twice that amplitude

    @property
    def is_finite(self) -> bool:
        return isfinite(self.minimum_amplitude)


@dataclass(frozen=True)
class NuisanceFit:
    name: str
    shift: float  # from the scene's value
    error: float  # one sigma after the fit
    prior: float  # one sigma before the fit
    unit: str
    at_bound: bool  # beyond 2.5 sigmas of its prior; of `check_first`: at the end of the range that is tried

    @property
    def sigmas(self) -> float:
        return self.shift / self.prior if self.prior > 0 else 0


@dataclass(frozen=True)
class MissingBins:
    """Something without a value in some bins of the experiment."""
    of: str  # an effect, a parameter, or one of several packings; empty: some runs of the unchanged scene
    bins: int  # bins that it lacks, of those that can be compared otherwise
    of_bins: int = field(metadata={"then": "share"})
    for_all: bool  # nothing is compared there; otherwise only that effect is not

    @property
    def share(self) -> float:
        return self.bins / self.of_bins if self.of_bins > 0 else 0.0


@dataclass(frozen=True)
class Refinement:
    """A numerical setting of the simulation that is consistent with the gap."""
    effect: str  # empty: the plate moves as that of the experiment
    key: str
    was: float
    to: float
    unit: str
    done: bool  # the diagnosis refined the scene and continued; otherwise the user must set it


@dataclass(frozen=True)
class NextStep:
    what: str
    power: float | None  # probability that it decides, predicted from signatures or runs


@dataclass(frozen=True)
class PackingAgreement:
    """One of several packings that were diagnosed together."""
    experiment: str
    gap_p: float  # p-value of its gap alone
    amplitude: float  # of the leading cause, from this packing alone
    amplitude_error: float = field(metadata=INFINITE)
    agreement_p: float  # p-value of its difference from the other packings
    differs: bool  # the difference exceeds noise, corrected for the number of packings


@dataclass(frozen=True)
class ContactLaw:
    """The law of contacts between grains that forces and positions show, at one displacement."""
    phase: str
    displacement_mm: float
    overlap: tuple[float, ...]  # over R*, corrected for the surface displacement by other contacts
    change: tuple[float, ...]  # of the force at that overlap, over that in the scene, minus one
    change_error: tuple[float, ...]  # one sigma
    exponent: float  # of the force against the overlap, if the scene's contacts have Hertz's 3/2
    exponent_error: float  # one sigma


@dataclass(frozen=True, kw_only=True)
class Diagnosis:
    verdict: str  # of Verdict
    gap: Gap
    where: tuple[WhereEntry, ...]
    causes: tuple[Cause, ...]  # best first; empty without a gap
    explanation: Explanation | None = None  # None without a gap
    shrink: GapReduction | None
    detection_limits: tuple[DetectionLimit, ...]
    not_measured: tuple[str, ...]  # missing data, and what they would show
    seconds: float
    where_threshold: float = field(metadata=ZERO)  # |z| above which a bin is significant among all bins; 0: unknown
    cells: tuple[WhereBin, ...]  # bins, by the key of the file
    ranking: tuple[Cause, ...]  # all candidates by score
    nuisances: tuple[NuisanceFit, ...]  # refitted without any effect
    check_first: tuple[NuisanceFit, ...] = ()  # parameters far from what is stated, the farthest first
    missing_bins: tuple[MissingBins, ...] = ()
    not_testable: tuple[str, ...]  # candidates that this scene or these data cannot show, with reasons
    refinements: tuple[Refinement, ...] = ()
    next: tuple[NextStep, ...] = ()  # most useful first
    packings: tuple[PackingAgreement, ...] = ()  # empty for a single packing
    contact_laws: tuple[ContactLaw, ...] = ()  # empty without contact forces and positions
    provenance: dict[str, str]  # scene, experiment, program, device, seed
