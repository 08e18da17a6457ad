"""All numbers that a diagnosis is based on, without simulator and files.

Vectors have one entry per bin (observables.py), matrices one row per replicate and one column per bin, in the unit of the bin's
observable; unknown numbers are NaN.
"""
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import InputError
from ..results.recording import Bools, Floats, Ints
from .diagnosis_types import MissingBins
from .effect_fit import Candidate, explained_by
from .effect_fit import lacking_bins as lacking_of_any
from .gap_space import BinChoice, FreeParameter, GapSpace, lacking_bins, usable_bins, without
from .library import Library, apart_from_mean, mean_groups, scatter
from .signature import Signature, rows_with_numbers

FARTHEST = 12  # largest allowed shift of a parameter, in sigmas of its prior
OWN_PACKING = -1  # group of the replicates of the experiment's own packing if the library is made on other packings
MAX_FOLDS = 8
ENOUGH_BINS = 0.5  # of the known ones that a signature must have: otherwise it explains no more than a part of the gap
MIN_REPLICATES, MIN_OWN_REPLICATES = 8, 4

FailureCauses = Mapping[str, str]  # why simulations failed, by candidate or nuisance; empty name: the unchanged scene


@dataclass(frozen=True)
class CandidateRange:
    """A candidate effect with its range of plausible amplitudes."""

    name: str
    unit: str
    low: float = 0
    high: float = 0


@dataclass(frozen=True)
class NuisancePrior:
    """An uncertain parameter with its prior."""

    name: str
    unit: str
    sigma: float = 0


@dataclass(frozen=True, eq=False)
class PackingEvidence:
    """One of several packings of an experiment: its observation, and runs of the scene on it."""

    name: str
    observed: Floats  # (bins,)
    baseline: Floats  # (replicates, bins)

    def gap(self) -> Floats:
        """Observed minus the mean of the baseline. (bins,)"""
        return self.observed - column_means(self.baseline)


@dataclass(eq=False)
class Evidence:
    observed: Floats  # the experiment (bins,)
    baseline: Floats  # (replicates of the scene on the experiment's packing, bins)
    library: Library
    candidates: list[CandidateRange] = field(default_factory=list)  # all of library.effects
    nuisances: list[NuisancePrior] = field(default_factory=list)  # all of library.nuisances
    finer_baseline: Floats = field(default_factory=lambda: np.empty((0, 0)))  # with half the error of positions; may be empty
    seed: int = 1  # for all random draws
    library_is_own: bool = True  # made on the experiment's own packings
    # For several packings, whose means (take_means) are observed and baseline. Empty: a single packing.
    packings: list[PackingEvidence] = field(default_factory=list)

    def packing_count(self) -> int:
        return max(1, len(self.packings))


@dataclass(eq=False)
class GapData:
    """The evidence on selected bins, with all derived quantities that do not depend on the observation."""

    bins: BinChoice
    mean: Floats  # of the baseline (all bins,)
    gap: Floats  # observed minus mean (all bins,)
    noise: Floats  # (rows, all bins) scatter of one replicate; for several packings, of their mean
    group: Ints  # (rows,) rows with a common mean (library.py)
    fold: Ints  # (rows,) rows that are left out together, those of one packing
    mean_of: int  # number of replicates in the mean
    free: list[FreeParameter]
    candidates: list[Candidate]  # effects, then nuisances beyond their priors; signatures that lack bins are zero there
    effects: int = 0  # number of effects among them
    packings: int = 1  # number of packings in the gap
    missing: list[MissingBins] = field(default_factory=list)  # what lacks bins that the experiment has

    def lacking(self, candidates: Sequence[int]) -> BinChoice:
        """Bins that one of these candidates lacks."""
        return lacking_of_any(self.chosen(candidates))

    def space(self, bins: BinChoice | None = None, free: Sequence[FreeParameter] | None = None, *, noise: Floats | None = None,
              mean_of: int | None = None, extra: Floats | None = None) -> GapSpace:
        """The space of the gap, or of other bins, free parameters, noise, or runs in the mean. `extra`: (all bins,) additional variance."""
        return GapSpace(self.noise if noise is None else noise, self.mean_of if mean_of is None else mean_of,
                        self.bins if bins is None else bins, self.free if free is None else free, extra)

    def chosen(self, candidates: Sequence[int]) -> list[Candidate]:
        return [self.candidates[c] for c in candidates]

    def explained(self, candidates: Sequence[int], amplitudes: Floats | Sequence[float]) -> Floats:
        """(.., all bins) sum of their signatures at amplitudes (.., candidates)."""
        return explained_by(self.chosen(candidates), amplitudes, len(self.mean))

    def name(self, candidate: int) -> str:
        return self.candidates[candidate].signature.name

    def in_range(self, nuisances: Floats) -> Floats:
        """The nuisances, each limited to the range in which simulations are made. A fit far from the data may leave it, and a modulus is
        an exponential of its nuisance."""
        ends = FARTHEST * np.array([parameter.sigma for parameter in self.free])
        limited = np.array(nuisances, dtype=float)
        limited[: len(ends)] = np.clip(limited[: len(ends)], -ends, ends)
        return limited

    @staticmethod
    def at_end_of_range(nuisance: float, sigma: float) -> bool:
        return abs(nuisance) >= (1 - 1e-9) * FARTHEST * sigma


def column_means(rows: Floats) -> Floats:
    """Mean over the finite rows. (bins,)"""
    finite = np.isfinite(rows)
    with np.errstate(invalid="ignore"):
        mean: Floats = np.where(finite, rows, 0).sum(axis=0) / finite.sum(axis=0)
    return mean


def mean_over_packings(rows: Floats, packings: int) -> Floats:
    """Mean over packings whose rows are stored one packing after the other. (rows of a packing, bins)"""
    each = len(rows) // packings
    mean: Floats = rows[: packings * each].reshape(packings, each, -1).sum(axis=0) / packings
    return mean


def take_means(evidence: Evidence) -> None:
    """Sets observed and baseline to the means over the packings. If noise and signatures are equal, the mean of the gaps contains all
    information about what the packings share: its likelihood is the product of theirs."""
    evidence.observed = np.mean([packing.observed for packing in evidence.packings], axis=0)
    evidence.baseline = np.mean([packing.baseline for packing in evidence.packings], axis=0)


def find(signatures: Sequence[Signature], name: str) -> Signature:
    for signature in signatures:
        if signature.name == name:
            return signature
    raise LookupError(f"no signature of {name}")


def leave_out_failures(evidence: Evidence, causes: FailureCauses | None = None) -> list[str]:
    """Leaves out the results of failed simulations: replicates without any value, candidates and nuisances without a signature in most of
    the otherwise known bins. Replicates without values in some bins are left out of the noise if more values remain so. Returns what
    was left out and why. Raises InputError if too few replicates remain."""
    known_causes = causes or {}
    notes = _leave_out_replicates(evidence, known_causes) + _leave_out_incomplete(evidence)
    known = np.isfinite(evidence.library.baseline).all(axis=0) & np.isfinite(evidence.observed)

    def tested(name: str, signatures: Sequence[Signature]) -> bool:
        note = _not_testable(find(signatures, name), known, known_causes)
        notes.extend(note)
        return not note

    evidence.candidates = [c for c in evidence.candidates if tested(c.name, evidence.library.effects)]
    evidence.nuisances = [n for n in evidence.nuisances if tested(n.name, evidence.library.nuisances)]
    return notes


def _leave_out_replicates(evidence: Evidence, causes: FailureCauses) -> list[str]:
    runs, own_runs = evidence.library.baseline, evidence.baseline
    kept, own = rows_with_numbers(runs), rows_with_numbers(own_runs)
    failed = max(len(runs) - len(kept), len(own_runs) - len(own))
    if failed == 0:
        return []
    what = f"{failed} of {max(len(runs), len(own_runs))} runs of the scene as it stands failed"
    if len(kept) < MIN_REPLICATES or len(own) == 0:
        cause = causes.get("", "the packing runs away, or the scene cannot follow the experiment's plate")
        raise InputError(f"{what}: {cause}; try `mcdem run` of the scene with plate.start and plate.end of the experiment")
    _keep_rows(evidence, kept)
    evidence.baseline = own_runs[own]
    return [f"replicates: {what} and are left out" + (f": {causes['']}" if "" in causes else "")]


def _leave_out_incomplete(evidence: Evidence) -> list[str]:
    """Leaves out of the noise those replicates that lack the most bins, if more values remain without them: a bin is compared only if
    every replicate has it. Packings keep two replicates."""
    has = np.isfinite(evidence.library.baseline)
    count = len(has)
    order = np.argsort(-has.sum(axis=1), kind="stable")  # the fullest first
    values = np.arange(1, count + 1) * np.logical_and.accumulate(has[order]).sum(axis=1)  # left in the first 1, 2, .. of them
    _, packing = np.unique(evidence.library.packing, return_inverse=True)
    required = np.minimum(2, np.bincount(packing))
    best = count
    for n in range(count - 1, MIN_REPLICATES - 1, -1):
        if values[n - 1] > values[best - 1] and np.all(np.bincount(packing[order[:n]], minlength=len(required)) >= required):
            best = n
    if best == count:
        return []
    _keep_rows(evidence, np.sort(order[:best]))
    return [f"replicates: {count - best} of {count} runs of the scene as it stands lack values that the others have, and are left out of "
            "the noise"]


def _keep_rows(evidence: Evidence, kept: Ints) -> None:
    library = evidence.library
    evidence.library = replace(library, baseline=library.baseline[kept], packing=[library.packing[r] for r in kept])


def _not_testable(signature: Signature, known: Bools, causes: FailureCauses) -> list[str]:
    """The reason, if it lacks most of the bins that all others have."""
    name, has = signature.name, int((known & np.isfinite(signature.linear) & np.isfinite(signature.curvature)).sum())
    if has >= ENOUGH_BINS * known.sum():
        return []
    if has > 0 and name not in causes:
        return [f"{name}: with it only {has} of {known.sum()} bins have a value, so it cannot be tested"]
    return [f"{name}: its runs failed ({causes.get(name, 'the packing runs away with it')}), so it cannot be tested"]


def parameters_of(evidence: Evidence) -> list[Signature]:
    """The signatures of the evidence's nuisances."""
    return [find(evidence.library.nuisances, prior.name) for prior in evidence.nuisances]


def gap_data(evidence: Evidence) -> GapData:
    """Refers to signatures of `evidence`."""
    parameters = parameters_of(evidence)
    mean = column_means(evidence.baseline)
    gap = evidence.observed - mean
    candidates = [_candidate(evidence, wanted) for wanted in evidence.candidates]
    data = GapData(
        bins=usable_bins(evidence.library.baseline, parameters, gap), mean=mean, gap=gap,
        noise=scatter(evidence.library) / math.sqrt(evidence.packing_count()),
        group=np.array(mean_groups(evidence.library), dtype=np.int64), fold=_folds_of(evidence.library.packing),
        mean_of=len(evidence.baseline),
        free=[FreeParameter(signature.linear, prior.sigma) for signature, prior in zip(parameters, evidence.nuisances)],
        candidates=candidates, effects=len(candidates), packings=evidence.packing_count())
    data.missing = _missing_bins(evidence, data)
    if not evidence.library_is_own and _count_packings(evidence.library.packing) >= MAX_FOLDS:
        # A library of few packings may contain the experiment's own, whose replicates would be counted twice.
        _add_own_scatter(data, evidence.baseline)
    for signature, prior in zip(parameters, evidence.nuisances):
        if prior.name in ("modulus", "strain_offset", "gamma"):
            data.candidates.append(Candidate(signature, -FARTHEST * prior.sigma, FARTHEST * prior.sigma))
    return data


def _count_packings(packing: Sequence[int]) -> int:
    return 1 + max(packing)


def _folds_of(packing: Sequence[int]) -> Ints:
    """Replicates of one packing are correlated through their mean. They are left out together if there are enough packings."""
    left_out = packing if _count_packings(packing) >= MAX_FOLDS else range(len(packing))
    return np.array(left_out, dtype=np.int64) % MAX_FOLDS


def _candidate(evidence: Evidence, wanted: CandidateRange) -> Candidate:
    signature = find(evidence.library.effects, wanted.name)
    lacking = lacking_bins(signature)
    if len(lacking):
        linear, curvature, slopes = signature.linear.copy(), signature.curvature.copy(), signature.slopes.copy()
        linear[lacking] = curvature[lacking] = 0
        if signature.pairs() > 0:
            slopes[:, lacking] = 0
        signature = replace(signature, linear=linear, curvature=curvature, slopes=slopes)
    return Candidate(signature, wanted.low, wanted.high, lacking)


def _missing_bins(evidence: Evidence, data: GapData) -> list[MissingBins]:
    """What lacks bins that the experiment and most of the replicates have."""
    has = np.isfinite(evidence.library.baseline)
    measured = np.isfinite(evidence.observed)
    for packing in evidence.packings:
        measured = measured | np.isfinite(packing.observed)
    possible = np.flatnonzero(measured & (2 * has.sum(axis=0) > len(has)))
    of_all = [("", np.flatnonzero(~has.all(axis=0)))]
    of_all += [(packing.name, np.flatnonzero(~np.isfinite(packing.observed))) for packing in evidence.packings]
    of_all += [(signature.name, lacking_bins(signature)) for signature in parameters_of(evidence)]
    of_effects = [(candidate.signature.name, candidate.lacking) for candidate in data.candidates]
    return [MissingBins(name, lost, len(bins), for_all)
            for bins, for_all, lists in ((possible, True, of_all), (data.bins, False, of_effects))
            for name, lacking in lists if (lost := len(bins) - len(without(bins, lacking))) > 0]


def _add_own_scatter(data: GapData, baseline: Floats) -> None:
    """Adds the replicates of the experiment's own packing to the noise, as a further packing: packings differ in their scatter. Uses those
    that have all selected bins. Each is left out separately, because the experiment is compared when the others are known."""
    whole = baseline[np.isfinite(baseline[:, data.bins]).all(axis=1)]
    if len(whole) < MIN_OWN_REPLICATES:
        return
    group = [OWN_PACKING] * len(whole)
    data.noise = np.concatenate([data.noise, apart_from_mean(whole, group)])
    data.group = np.append(data.group, group)
    data.fold = np.append(data.fold, 1 + data.fold.max() + np.arange(len(whole)) % MAX_FOLDS)
