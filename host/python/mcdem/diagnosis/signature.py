"""Change of the observation by an effect as a function of its amplitude, from paired runs."""
from dataclasses import dataclass, field, replace

import numpy as np

from ..results.recording import Floats, Ints


@dataclass(eq=False)
class Signature:
    """mu(a) = linear a + curvature a^2 up to the largest simulated amplitude, linear beyond it. One entry per bin."""

    name: str = ""
    reach: float = 0.0  # largest |a| of the paired runs
    linear: Floats = field(default_factory=lambda: np.zeros(0))  # (bins,) per unit amplitude
    curvature: Floats = field(default_factory=lambda: np.zeros(0))  # (bins,) per unit amplitude squared
    slopes: Floats = field(default_factory=lambda: np.zeros((0, 0)))  # (pairs, bins) difference at the second amplitude over it

    def at(self, amplitude: Floats | float) -> Floats:
        """(.., bins) mu at amplitudes (..)."""
        a = np.asarray(amplitude, float)[..., None]
        inside = np.clip(a, -self.reach, self.reach)
        mu: Floats = a * self.linear + inside * (2 * a - inside) * self.curvature
        return mu

    def slope(self, amplitude: float) -> Floats:
        """(bins,) d mu / d a."""
        slope: Floats = self.linear + 2 * np.clip(amplitude, -self.reach, self.reach) * self.curvature
        return slope

    def pairs(self) -> int:
        return len(self.slopes)

    def spread(self) -> Floats:
        """(bins,) variance over pairs of `slopes`: differences between packings, random draws of the effect, and chaos."""
        return _Moments.of(self.slopes).variance * self.pairs() if self.pairs() else np.zeros_like(self.linear)


@dataclass(frozen=True, eq=False)
class _Moments:
    """Mean over rows and its variance, for each column."""

    mean: Floats
    variance: Floats

    @classmethod
    def of(cls, rows: Floats) -> "_Moments":
        n = float(len(rows))
        with np.errstate(invalid="ignore"):  # missing values, no rows
            mean = rows.sum(axis=0) / n
            return cls(mean, ((rows - mean) ** 2).sum(axis=0) / (n * max(1.0, n - 1)))

    def kept(self) -> Floats:
        """Factor of each mean after shrinkage."""
        kept: Floats = np.maximum(1 - self.variance / np.maximum(self.mean**2, 1e-300), 0)
        return kept

    def mixed(self, other: "_Moments", part: Floats) -> "_Moments":
        """`part` of these, the rest of the other."""
        return _Moments(part * self.mean + (1 - part) * other.mean, part * self.variance + (1 - part) * other.variance)


def rows_with_numbers(rows: Floats) -> Ints:
    """Rows of complete runs; a failed run has only NaN."""
    return np.flatnonzero(np.isfinite(rows).any(axis=1))


def continued_from(signature: Signature, done: float) -> Signature:
    """The signature of a further reduction `b` of a setting after it was reduced by `done`.

    That of the amplitude done + b (1 - done) minus that of `done`.
    """
    left = 1 - done
    inside = done < signature.reach
    return replace(
        signature,
        reach=(signature.reach - done) / left if inside else signature.reach,
        linear=left * signature.slope(done),
        curvature=left * left * signature.curvature if inside else np.zeros_like(signature.curvature),
        slopes=left * signature.slopes,
    )


def learn_signature(name: str, first: float, second: float, at_first: Floats, at_second: Floats) -> Signature:
    """From differences of paired runs (pairs, bins) at two amplitudes.

    Values are shrunk towards zero according to the scatter over pairs (positive-part James & Stein 1961, bin by bin), the curvature
    first. Pairs with a failed run (all NaN) are left out. With fewer than two complete pairs, it is a straight line through the results at
    the amplitude at which runs succeed; NaN if they succeed at neither. The same holds for a single bin without a value in some pair: a
    force whose logarithm is observed may vanish with a large effect only.
    """
    needed = min(2, len(at_first))
    holds_first, holds_second = rows_with_numbers(at_first), rows_with_numbers(at_second)
    both = np.intersect1d(holds_first, holds_second)
    if len(both) >= needed:
        s = _parabola_signature(name, first, second, at_first[both], at_second[both])
        _fill_in(s, _straight_signature(name, second, at_second[both]))
        _fill_in(s, _straight_signature(name, first, at_first[both]))
        return s
    if len(holds_second) >= needed:
        return _straight_signature(name, second, at_second[holds_second])
    if len(holds_first) >= needed:
        return _straight_signature(name, first, at_first[holds_first])
    none = np.full(at_first.shape[1], np.nan)
    return Signature(name, max(abs(first), abs(second)), none, none.copy())


def _straight_signature(name: str, amplitude: float, at: Floats) -> Signature:
    """Straight line through the pairs of one amplitude."""
    line = _Moments.of(at / amplitude)
    return Signature(name, abs(amplitude), line.kept() * line.mean, np.zeros(at.shape[1]), at / amplitude)


def _parabola_signature(name: str, first: float, second: float, at_first: Floats, at_second: Floats) -> Signature:
    """The mean of the parabolas through zero and both differences of each pair."""
    a, b = first, second
    determinant = a * b * (b - a)
    with np.errstate(invalid="ignore"):
        curvature = _Moments.of((at_second * a - at_first * b) / determinant)
        parabola = _Moments.of((at_first * b * b - at_second * a * a) / determinant)
        straight = _Moments.of((at_first * a + at_second * b) / (a * a + b * b))
        bent = curvature.kept()
        linear = parabola.mixed(straight, bent)
        seen = np.maximum(linear.kept(), bent)
        return Signature(name, max(abs(a), abs(b)), seen * linear.mean, bent * curvature.mean, at_second / b)


def _fill_in(s: Signature, other: Signature) -> None:
    """Takes the bins in which `s` has no value from `other`, which has the same pairs."""
    missing = ~(np.isfinite(s.linear) & np.isfinite(s.curvature))
    s.linear[missing] = other.linear[missing]
    s.curvature[missing] = other.curvature[missing]
    s.slopes[:, missing] = other.slopes[:, missing]
