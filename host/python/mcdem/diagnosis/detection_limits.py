"""Detection limits of the given kind of data, computed before the data are used."""
import math
from dataclasses import replace

import numpy as np

from .decision import Limits
from .diagnosis_types import DetectionLimit
from .evidence import Evidence, GapData
from .gap_space import GapSpace
from .gap_tests import NullDistribution, fits_of_singles
from .signature import Signature

POWER_OF_FOUR_FIFTHS = 0.842  # standard normal quantile
STEPS = 30


def _whitened(space: GapSpace, signature: Signature) -> Signature:
    return replace(signature, linear=space.whiten(signature.linear), curvature=space.whiten(signature.curvature))


def _expected_gain(whitened: Signature, amplitude: float) -> float:
    """In log likelihood."""
    return 0.5 * float((whitened.at(amplitude) ** 2).sum())


def _smallest_amplitude(whitened: Signature, end: float, wanted: float) -> float:
    """Smallest amplitude between zero and `end` with a gain of `wanted`; infinite if there is none."""
    if end == 0 or _expected_gain(whitened, end) < wanted:
        return math.inf
    below, above = 0.0, end
    for _ in range(STEPS):
        middle = 0.5 * (below + above)
        if _expected_gain(whitened, middle) < wanted:
            below = middle
        else:
            above = middle
    return above


def detection_limits(space: GapSpace, data: GapData, null: NullDistribution, evidence: Evidence, limits: Limits) -> list[DetectionLimit]:
    """One limit per candidate effect: the amplitude that the directed test detects in four of five cases, the part of its signature that
    refitted nuisances absorb, and the effects that cannot be distinguished from it at twice that amplitude."""
    threshold = null.quantile("directed", 0.5 * limits.false_alarm)  # Bonferroni correction for two tests
    wanted = 0.5 * (math.sqrt(2 * threshold) + POWER_OF_FOUR_FIFTHS) ** 2
    fixed = data.space(free=[])
    return [_limit(c, space, fixed, data, evidence.candidates[c].unit, wanted, limits) for c in range(data.effects)]


def _limit(c: int, whole: GapSpace, whole_fixed: GapSpace, data: GapData, unit: str, wanted: float, limits: Limits) -> DetectionLimit:
    candidate = data.candidates[c]
    space, signature = whole.lacking(candidate.lacking), candidate.signature
    refitted, fixed = _whitened(space, signature), _whitened(whole_fixed.lacking(candidate.lacking), signature)
    up, down = (_smallest_amplitude(refitted, end, wanted) for end in (candidate.high, candidate.low))
    probe = up if math.isfinite(up) else candidate.high
    alone = _expected_gain(fixed, probe)
    scores = fits_of_singles(space, data, signature.at(min(2 * probe, candidate.high))[None]).scores[:, 0]
    alike = np.flatnonzero(scores[c] - scores <= limits.group_margin(float(scores[c])))
    return DetectionLimit(
        effect=data.name(c), unit=unit, minimum_amplitude=abs(down) if abs(down) < abs(up) else up,
        absorbed_by_calibration=1 - _expected_gain(refitted, probe) / alone if alone > 0 else 0.0,
        group=tuple(data.name(int(other)) for other in alike if other != c))
