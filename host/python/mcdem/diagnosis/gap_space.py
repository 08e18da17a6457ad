"""The space in which an observation is compared with the model: common bins, whitened noise, uncertain parameters marginalised."""
import copy
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve, cholesky, solve_triangular

from ..results.recording import Floats, Ints
from ..observe.grid import bins_each
from ..observe.observables import observables
from .signature import Signature

BinChoice = Ints  # subset of the bins in ascending order, for ablations and the split into fitted and held-out bins
MORE_REPLICATES = 8  # weight of the mean variance of an observable in that of a single bin


def shrunk_covariance(rows: Floats) -> Floats:
    """(p, p) covariance of rows (n, p) with mean zero, shrunk towards its diagonal (Ledoit & Wolf 2004, applied to correlations)."""
    n = len(rows)
    sigma = np.maximum(np.sqrt((rows**2).sum(axis=0) / n), 1e-300)
    z = rows / sigma
    correlation = z.T @ z / n
    # Sum over pairs of bins of the variance of their correlation, over that of its square.
    sampling = ((z**2).T @ z**2 / n - correlation**2).sum() / n
    signal = (correlation**2).sum() - len(correlation)
    shrink = min(max(sampling / signal, 0.0), 1.0) if signal > 0 else 1.0
    correlation *= 1 - shrink
    np.fill_diagonal(correlation, 1)
    covariance: Floats = sigma[:, None] * correlation * sigma
    return covariance


def usable_bins(baseline: Floats, parameters: Sequence[Signature], observed: Floats) -> BinChoice:
    """Bins with finite values in every replicate (n, all) and in the signature of every uncertain parameter, and with nonzero variance.

    A parameter whose change of a bin is unknown may shift it by any amount.
    """
    usable = np.isfinite(baseline).all(axis=0) & (baseline != baseline[0]).any(axis=0) & np.isfinite(observed)
    for signature in parameters:
        usable &= _has_value(signature)
    return np.flatnonzero(usable)


def _has_value(signature: Signature) -> NDArray[np.bool_]:
    known: NDArray[np.bool_] = np.isfinite(signature.linear) & np.isfinite(signature.curvature)
    return known


def lacking_bins(signature: Signature) -> BinChoice:
    """Bins in which a signature has no value."""
    return np.flatnonzero(~_has_value(signature))


def without(bins: BinChoice, others: BinChoice) -> BinChoice:
    """`bins` that are not among `others`."""
    return bins[~np.isin(bins, others)] if len(others) else bins


def resolutions(bins: BinChoice, all: int) -> Floats:
    """(bins,) Observable.resolution of each selected bin, of `all` bins."""
    chosen: Floats = np.array([observable.resolution for observable in observables()])[bins // bins_each(all)]
    return chosen


def _moderated(variance: Floats, bins: BinChoice, noise: Floats) -> Floats:
    """Variances of single bins, moderated towards the mean of their observable because there are few replicates.

    As if that mean had been observed in a few more replicates (Smyth 2004). A bin with an accidentally small scatter is then not
    significant.
    """
    n, all = noise.shape
    observable = bins // bins_each(all)
    mean = (np.bincount(observable, variance) / np.maximum(np.bincount(observable), 1))[observable]
    moderated: Floats = (n * variance + MORE_REPLICATES * mean) / (n + MORE_REPLICATES)
    return moderated


@dataclass(frozen=True, eq=False)
class FreeParameter:
    """A refitted parameter: its linear signature on all bins and its prior."""

    direction: Floats  # (all,) per unit
    sigma: float  # prior


class GapSpace:
    """`noise`: (n, all) rows of the scatter of one replicate. `mean_of`: number of replicates in the mean that is compared with the
    observation (0: exact). `extra`: (all,) additional variance.

    A difference `all` is (all,), or (N, all) for N of them; results then have N rows.
    """

    bins: BinChoice
    whitener: Floats  # (bins, bins) inverse of the Cholesky factor of the covariance with nuisances
    sigma: Floats  # (bins,) one sigma of each selected bin, moderated over its observable, without nuisances

    def __init__(
        self, noise: Floats, mean_of: int, bins: BinChoice, free: Sequence[FreeParameter], extra: Floats | None = None
    ) -> None:
        self.bins = np.asarray(bins, np.int64)
        both = 1 + (1 / mean_of if mean_of > 0 else 0)  # scatter of the observation and of the mean
        self._covariance = both * shrunk_covariance(noise[:, self.bins])  # without nuisances
        variance = self._covariance.diagonal() + resolutions(self.bins, noise.shape[1]) ** 2
        if extra is not None and len(extra):
            variance = variance + extra[self.bins]
        np.fill_diagonal(self._covariance, variance)
        self.sigma = np.sqrt(_moderated(variance, self.bins, noise))
        self._directions = np.array([one.direction[self.bins] for one in free]).reshape(len(free), len(self.bins))
        self._priors = np.array([one.sigma for one in free], float)
        self._factorise()

    def _factorise(self) -> None:
        """From bins, covariance, directions and priors."""
        self._parts: dict[bytes, GapSpace] = {}  # by the bins that they lack
        count = len(self.bins)
        self._noise = cholesky(self._covariance, lower=True) if count else np.zeros((0, 0))
        scaled = self._priors[:, None] * self._directions
        total = cholesky(self._covariance + scaled.T @ scaled, lower=True) if count else self._noise
        self.whitener = solve_triangular(total, np.eye(count), lower=True) if count else total
        self._log_determinant = float(np.log(total.diagonal()).sum())  # half of it
        # Gain: most probable nuisances per difference. Posterior: their covariance.
        inverse = cho_solve((self._noise, True), self._directions.T).T if count and len(self._priors) else self._directions
        self._posterior = np.linalg.inv(inverse @ self._directions.T + np.diag(self._priors**-2.0))
        self._gain = self._posterior @ inverse

    def lacking(self, lacking: BinChoice) -> "GapSpace":
        """The same on its bins that are not among `lacking`: nothing is assumed about the others."""
        if not len(lacking):
            return self
        key = np.asarray(lacking, np.int64).tobytes()
        if key not in self._parts:
            places = np.flatnonzero(~np.isin(self.bins, lacking))
            self._parts[key] = self if len(places) == len(self.bins) else self._part(places)
        return self._parts[key]

    def _part(self, places: Ints) -> "GapSpace":
        """The part at these places of its bins."""
        part = copy.copy(self)
        part.bins, part.sigma = self.bins[places], self.sigma[places]
        part._covariance, part._directions = self._covariance[np.ix_(places, places)], self._directions[:, places]
        part._factorise()
        return part

    def whiten(self, all: Floats) -> Floats:
        """(.., bins) whitened difference; its square is a chi-square of the gap with nuisances marginalised."""
        return all[..., self.bins] @ self.whitener.T

    def log_likelihood(self, all: Floats) -> Floats:
        """(..) marginal log likelihood of a difference, up to a constant that depends on the number of bins."""
        log_likelihood: Floats = -0.5 * (self.whiten(all) ** 2).sum(axis=-1) - self._log_determinant
        return log_likelihood

    def fit_nuisances(self, all: Floats) -> Floats:
        """(.., free) most probable values of the nuisances for a difference."""
        nuisances: Floats = all[..., self.bins] @ self._gain.T
        return nuisances

    def nuisance_errors(self) -> Floats:
        """(free,) posterior errors of the nuisances."""
        errors: Floats = np.sqrt(self._posterior.diagonal())
        return errors

    def refitted(self, all: Floats) -> Floats:
        """(.., bins) difference minus the contribution of the most probable nuisances."""
        left: Floats = all[..., self.bins] - self.fit_nuisances(all) @ self._directions
        return left

    def sigma_of(self, weights: Floats) -> float:
        """One sigma of a weighted sum of selected bins, without nuisances."""
        return float(np.linalg.norm(weights @ self._noise))
