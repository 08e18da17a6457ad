"""Estimates, and notes on how far results can be trusted, as text."""
import math

from ..observe.estimate import Estimate
from ..observe.law_range import BeyondLaw
from ..observe.model_table import course_error
from .labels import NO_NUMBER, three_digits

TOO_LARGE_RATE_ERROR = 0.02


def with_error(estimate: Estimate, decimals: int, unit: float = 1.0) -> str:
    """ "0.430 ± 0.012"; without the error if it is unknown, a dash without a value.

    More decimals if fewer than two significant digits would be left, of the value or of a larger error.
    """
    if not estimate.available():
        return NO_NUMBER
    has_error = math.isfinite(estimate.standard_error)
    value, error = estimate.value / unit, estimate.standard_error / unit
    size = max(abs(value), error if has_error else 0.0)
    if 0 < size < 1e-4:
        return f"{value:.2e}" + (f" ± {error:.1e}" if has_error else "")
    if size > 0:
        decimals = max(decimals, 1 - math.floor(math.log10(size)))
    return f"{value:.{decimals}f}" + (f" ± {error:.{decimals}f}" if has_error else "")


def rate_note(cell: bool, rate_error: float) -> str:
    """If it is large, also which key to set and how to measure it. Single scans were measured for plates only."""
    cause = "stresses by the strain rate" if cell else "forces by the plate's speed"
    note = f"error of {cause}: at most {_per_cent(rate_error)} in the mean over packings"
    if not cell:
        note += f", {_per_cent(rate_error + course_error)} in 95 % of single scans"
    note += " (estimate)"
    if rate_error > TOO_LARGE_RATE_ERROR:
        note += "; set protocol.rate_tolerance to reduce it; `mcdem converge` measures it"
    return note


def _per_cent(error: float) -> str:
    return (f"{100 * error:.2g}" if error < 0.995 else three_digits(100 * error)) + " %"


def beyond_note(setting: str, start: str, beyond: BeyondLaw) -> str:
    """`start`: the displacement or scan from which on overlaps exceed the tested range."""
    return (f"{setting}: from {start} on, overlaps exceed the tested range of the contact model ({beyond.tested:.2f} of the sum of two "
            f"radii) and reach {beyond.max_overlap:.2f}; numerics.stop_beyond_law = true stops the run there")
