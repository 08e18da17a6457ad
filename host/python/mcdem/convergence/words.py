"""The result of a convergence study in words."""
from collections.abc import Sequence

from .convergence_types import CauseErrors, BinError, Limits, unit_of

CONVERGED = "Converged: no error is beyond its limit."
NOT_CONVERGED = "Not converged."
NOT_DECIDED = "Not decided: no error is beyond its limit, but more replicas are needed to tell (--replicas)."


def _uncertain(errors: CauseErrors) -> int:
    """Number of errors that two standard errors do not separate from their limits."""
    return sum(2 * bin.standard_error > bin.limit for bin in errors.errors)


def _beyond(errors: CauseErrors) -> list[BinError]:
    return [bin for bin in errors.errors if bin.beyond]


def _remedy(remedy: str, bin: BinError) -> str:
    factor = abs(bin.over_limit)
    return "; within the limit with " + remedy.format(factor=factor, square=factor**2) if remedy else ""


def _words_of_worst(errors: CauseErrors, remedy: str, limits: Limits) -> str:
    beyond = _beyond(errors)
    worst = max(beyond, key=lambda bin: abs(bin.over_limit))
    unit, sign = unit_of(worst, limits)
    more = f", {len(beyond)} values beyond their limits" if len(beyond) > 1 else ""
    return (f"{worst.observable} is {'' if worst.follows_order else 'at least '}{abs(worst.error) / unit:.2g} +- "
            f"{worst.standard_error / unit:.1g} {sign} too {'high' if worst.error > 0 else 'low'} at {worst.displacement_mm:.1f} mm of "
            f"{worst.phase}ing{more}{_remedy(remedy, worst)}")


def words_of_cause(errors: CauseErrors, remedy: str, limits: Limits, values: int) -> str:
    """"plate speed: top_force is 1.3 +- 0.2 % too high at ..", or that all errors are within the limits; `values`: number of all bins."""
    if not any(abs(bin.error) + bin.standard_error > 0 for bin in errors.errors):
        return f"{errors.cause}: no influence in these runs"
    if _beyond(errors):
        return f"{errors.cause}: {_words_of_worst(errors, remedy, limits)}"
    uncertain = _uncertain(errors)
    return f"{errors.cause}: no error beyond its limit" + (
        f", but {uncertain} of {values} values have standard errors that are too large to tell; use more --replicas" if uncertain else "")


def words_of_result(causes: Sequence[CauseErrors]) -> str:
    if any(map(_beyond, causes)):
        return NOT_CONVERGED
    return NOT_DECIDED if any(map(_uncertain, causes)) else CONVERGED
