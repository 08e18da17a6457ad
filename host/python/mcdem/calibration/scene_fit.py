"""Several keys of a scene, fitted together to the curves of an experiment."""
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..look import Path
from ..observe.estimate import pair_by_seed
from ..observe.replicas import MODEL, SEED, THRESHOLD, Replicas, seeds_of
from ..results.parameters import has_programme, keys_that_vary
from ..results.recording import Bools, Floats
from .fit import End, Fit, Minimum, Ranges, Target
from .keys import STEP, FitKey, fit_keys, scene_changes
from .quantities import Quantities, curves, sigma_of, single, stroke_of, variance_of_mean
from .scene_calibration import calibrated_model, check_stroke
from .trials import Trials, mean_data

if TYPE_CHECKING:
    from .._engine import Scene

VARIES = ("packing.", "container.", "box.")  # what may differ between replicas
UNDETERMINED = 0.5  # standard error, over ten thirds of the first step (for most keys: over their value)
LEAST_CHANGE = 4.0  # of the data by that much of a key, sum of squares over sigma: less determines nothing
NOISE = 3.0  # a change counts if its square is this many times what the scatter of the trials makes of it
SETTLED = 0.5  # of the errors: a fit of which no round moves a key more has ended, because of the scatter between packings
SHARE = 0.3  # of a key's effect on the data over the largest, from which it belongs to a combination


@dataclass(frozen=True)
class FitOptions:
    keys: Sequence[str]  # KEY or KEY=LOW..HIGH
    compared: Sequence[str] = ()  # names of quantities; none: force and Z, or all of a programme
    model: str = ""  # empty: that of the scene
    tolerance: float = 0.005  # standard error, as UNDETERMINED
    batch: int = 6  # number of values of a single key per round
    rounds: int = 8
    device: str = ""
    folder: Path | None = None  # where trials are kept


@dataclass(frozen=True, eq=False)
class FitRound:
    trials: Floats  # (n, p)
    misfit: Floats  # (n,) in sigma; NaN: stopped early
    values: Floats  # (p,) estimate after this round
    standard_error: Floats  # (p,) from the scatter of the trials


@dataclass(frozen=True)
class Difference:
    """Root mean square over the levels of simulation less experiment."""
    quantity: str
    unit: str
    before: float
    after: float
    expected: float  # from the scatter between packings; NaN if it is not known


@dataclass(frozen=True, eq=False)
class SceneFit:
    keys: Sequence[FitKey]
    values: Floats  # (p,)
    standard_error: Floats  # (p,) of the fit and of the packings
    standard_error_of_fit: Floats  # (p,) from the scatter of the trials alone
    correlation: Floats  # (p, p)
    at_limit: Bools  # (p,)
    undetermined: Sequence[Sequence[tuple[str, float]]]  # keys that hardly change the data if they move together by these amounts, or one alone
    rounds: Sequence[FitRound]
    differences: Sequence[Difference]
    ratio: tuple[float, float]  # Rtop before and after; NaN for programmes
    end: End | None
    packings: int
    notes: Sequence[str]

    assignments: Sequence[str]  # of the scene's keys: "grains.friction=0.05"
    target: float  # measured top force [N]; NaN for programmes


def fit_scene(scene: "Scene", reference: Replicas, options: FitOptions, progress: Callable[[float], object],
              after_round: Callable[[SceneFit], object]) -> SceneFit:
    """The scene gives packings, protocol and the start of all keys. `progress` is told the fraction of all rounds, `after_round` what is found
    so far. Raises InputError, RunError."""
    prepared = _prepared(scene, reference, options)
    names = [name for key in fit_keys(options.keys, prepared, 1.0) for name in key.values(0)]  # errors before packings are made
    if twice := [name for name in dict.fromkeys(names) if names.count(name) > 1]:
        raise InputError(f"{', '.join(twice)}: must be in one of the keys that are fitted together")
    fitted = curves(reference, options.compared)
    work = _Work(Trials(prepared, options.device, options.folder), prepared, reference, fitted, options)
    found = None
    while found is None or (len(found.rounds) < options.rounds and found.end is None):
        found = work.round(lambda part: progress((len(work.rounds) + part) / options.rounds))
        after_round(found)
    return found


def _prepared(scene: "Scene", reference: Replicas, options: FitOptions) -> "Scene":
    """With one contact model, the reference's force threshold, and averages alone. Raises InputError if it cannot be compared."""
    model, values = calibrated_model(options.model, "--model").value if options.model else "", scene.parameters
    problems = [f"calibrate: {key} must be the same for all replicas: give one value with --set {key}=.."
                for key in keys_that_vary(values) if key != SEED and not key.startswith(VARIES) and not (model and key == MODEL)]
    first: Mapping[str, Any] = values[0]
    programmes, cells = (has_programme(first), reference[0].has_programme), (first["container.shape"] == "cell", reference[0].box.is_cell)
    if programmes[0] != programmes[1] or cells[0] != cells[1]:
        problems.append("calibrate: scene and experiment must both have strokes, the same [[programme]], or both be cells")
    if problems:
        raise InputError(problems)
    if not programmes[0]:
        check_stroke(first["plate.start"] - first["plate.end"], stroke_of(reference))
    changes: dict[str, Any] = {MODEL: model} if model else {}
    if not programmes[0]:
        changes["protocol.scan_at_start"] = True  # levels between the first displacement and the next scan are known, too
    return of_averages(scene, reference, changes)


def of_averages(scene: "Scene", reference: Replicas | None, changes: Mapping[str, Any] = {}) -> "Scene":
    """With these changes, without positions and contacts, and with the reference's force threshold, which decides what counts in Z."""
    threshold = reference[0].value(THRESHOLD) if reference else None
    known = {THRESHOLD: threshold} if isinstance(threshold, (int, float)) else {}
    return scene.parse(scene.text, set={"output.positions": False, "output.contacts": False, **known, **changes})


class _Work:
    """The rounds so far, and what follows from them."""

    def __init__(self, trials: Trials, scene: "Scene", reference: Replicas, fitted: Quantities, options: FitOptions) -> None:
        self._trials, self._reference, self._fitted, self._options = trials, reference, fitted, options
        self._parameters: Mapping[str, Any] = scene.parameters[0]
        self._seeds = [str(one[SEED]) for one in scene.parameters]
        self.keys = fit_keys(options.keys, scene, trials.batch.mean_diameter)
        self._scale = np.array([(key.step_high - key.step_low) / (2 * STEP) for key in self.keys])
        shown = [] if reference[0].has_programme else [single("top_force", stroke_of(reference))]
        self._all = Quantities([*fitted.each, *shown])
        self._measured = self._all.of(reference)
        self._mean = mean_data(self._measured)
        self._kept = np.isfinite(self._mean[:len(fitted)])  # values that are compared
        self._data = dict[tuple[float, ...], Floats]()  # (packings, values) of every trial
        self._start = np.array([key.value for key in self.keys])
        self.rounds, self.notes = list[FitRound](), list[str]()
        self.fit = self._new_fit()

    def _new_fit(self) -> Fit:
        kept = np.flatnonzero(self._kept)
        sigma = sigma_of(self._fitted, self._measured[:, :len(self._fitted)])
        self._target = Target(self._mean[kept], sigma[kept])
        alone = len(self.keys) == 1
        columns = [np.array([getattr(key, f"{'range' if alone else 'step'}_{end}") for key in self.keys]) for end in ("low", "high")]
        limits = [np.array([getattr(key, end) for key in self.keys]) for end in ("low", "high")]
        return Fit(self._target, Ranges(limits[0], limits[1], columns[0], columns[1], self._options.tolerance * self._scale), self._options.batch)

    def round(self, progress: Callable[[float], object]) -> SceneFit:
        """Raises InputError if the scene's own simulations stop before the first value that is compared."""
        x = self.fit.values
        if not self.rounds:  # the scene's own values come first
            x = np.vstack([self._start, x[(x != self._start).any(1)]])
        for row, data in zip(x.tolist(), self._trials.data(list(map(self._changes, x)), self._all, progress=progress), strict=True):
            self._data[tuple(row)] = data
        if not self.rounds:
            self._leave_out()
        y = np.array([self._mean_of(row) for row in x])
        self.fit.add(x, y)
        if self.fit.end is End.no_data:
            raise InputError("calibrate: all simulations of the first round stop early: start from other values with --set")
        found = self.fit.minimum
        self.rounds.append(FitRound(x, self._target.misfit(y), found.x if found else self.fit.x[self.fit.best],
                                    found.standard_error if found else np.full(len(self.keys), math.nan)))
        result = self.result()
        if len(self.rounds) > 1 and result.end is None:
            moved = np.abs(self.rounds[-1].values - self.rounds[-2].values)
            if (np.fmax(moved, result.standard_error_of_fit) <= SETTLED * result.standard_error).all():
                self.fit.end = End.converged
                result = replace(result, end=self.fit.end)
        return result

    def _changes(self, values: Floats) -> dict[str, float]:
        return {name: value for key, one in zip(self.keys, values.tolist(), strict=True) for name, value in key.values(one).items()}

    def _leave_out(self) -> None:
        """Values that the scene's own simulations do not reach."""
        reached = np.isfinite(mean_data(self._data[tuple(self._start.tolist())]))[:len(self._fitted)]
        missing = int((self._kept & ~reached).sum())
        if not (self._kept & reached).any():
            raise InputError("calibrate: the scene's simulations stop before the first value that is compared: start from other values with --set")
        if missing:
            self._kept &= reached
            self.notes.append(f"the scene's simulations do not reach {missing} of {missing + int(self._kept.sum())} measured values, which are "
                              "left out: `mcdem run` says why")
            self.fit = self._new_fit()

    def _mean_of(self, x: Floats) -> Floats:
        return np.asarray(mean_data(self._data[tuple(x.tolist())])[:len(self._fitted)][self._kept])

    def result(self) -> SceneFit:
        found = self.fit.minimum
        values = found.x if found else self.fit.x[self.fit.best]
        near = min(self._data, key=lambda x: (not np.isfinite(self._mean_of(np.array(x))).all(), float(np.abs((x - values) / self._scale).max())))
        unknown = np.full((len(self.keys),) * 2, math.nan)
        packings, notes = self._packing_covariance(self._data[near], found) if found else (unknown, [])
        covariance = unknown if not found else packings + (found.covariance if np.isfinite(found.covariance).all() else 0)
        error = np.sqrt(np.diag(covariance))
        with np.errstate(divide="ignore", invalid="ignore"):
            correlation = covariance / np.outer(error, error)
        limits = np.array([[key.low, key.high] for key in self.keys]).T
        at_limit = np.abs(values - limits).min(0) < 1e-3 * self._scale * STEP
        tops = [mean_data(self._data[x])[-1] / self._mean[-1] if len(self._all) > len(self._fitted) else math.nan
                for x in (tuple(self._start.tolist()), near)]
        return SceneFit(self.keys, values, error, found.standard_error if found else np.diag(unknown), correlation, at_limit,
                        self._undetermined(covariance) if found else [], tuple(self.rounds), self._differences(near), (tops[0], tops[1]),
                        self.fit.end, self._trials.packings, [*self.notes, *self._stopped(), *notes],
                        [f"{name}={value:.6g}" for name, value in scene_changes(self._changes(values), self._parameters).items()],
                        float(self._mean[-1]) if len(self._all) > len(self._fitted) else math.nan)

    def _stopped(self) -> list[str]:
        count = len(self.fit.failed)
        return [f"{count} of {len(self._data)} trials stopped early and were left out: the best values may be beyond what could be simulated"
                ] * bool(count)

    def _packing_covariance(self, data: Floats, found: Minimum) -> tuple[Floats, list[str]]:
        """(p, p) of the values, from the scatter between the packings of the scene and of the reference; and what it leaves out."""
        columns = np.flatnonzero(self._kept)
        ours, theirs = data[:, columns], self._measured[:, columns]
        pairs = pair_by_seed(self._seeds, seeds_of(self._reference))
        if pairs and len(pairs) > 1:
            return _scatter(ours[[i for i, _ in pairs]] - theirs[[j for _, j in pairs]], found)[0], []
        (of_ours, count), (of_theirs, their_count) = _scatter(ours, found), _scatter(theirs, found)
        if pairs:
            return 0 * of_ours, ["scene and experiment have the same single packing: the errors are those of the fit alone"]
        if count < 2 and their_count < 2:
            return 0 * of_ours, ["the errors leave out the scatter between packings, because scene and experiment each have a single one: use "
                                 "more (batch.replicas)"]
        if count < 2:
            return of_theirs * (1 + their_count), []
        return (of_ours + of_theirs if their_count > 1 else of_ours * (1 + count)), []

    def _undetermined(self, covariance: Floats) -> list[list[tuple[str, float]]]:
        weight, noise = (one * np.outer(self._scale, self._scale) for one in self.fit.slopes())
        is_alone = np.diag(weight) < np.fmax(LEAST_CHANGE, NOISE * np.diag(noise))  # the key changes nothing
        groups = [[(key.name, math.nan)] for key, alone in zip(self.keys, is_alone, strict=True) if alone]
        others = np.flatnonzero(~is_alone)
        of_others = np.ix_(others, others)
        scaled = np.nan_to_num(covariance / np.outer(self._scale, self._scale))[of_others]
        sizes, directions = np.linalg.eigh(weight[of_others])
        for size, v in zip(sizes, directions.T, strict=True):
            if size < max(LEAST_CHANGE, NOISE * float(v @ noise[of_others] @ v)) or float(v @ scaled @ v) > UNDETERMINED**2:
                effect = np.abs(v) * np.sqrt(np.diag(weight)[others])  # of each key on the data, which cancel each other
                members = [k for k in np.argsort(-effect).tolist() if effect[k] >= SHARE * effect.max()]
                step = 0.1 * v / v[members[0]]
                groups.append([(self.keys[others[k]].name, float(step[k] * self._scale[others[k]])) for k in members])
        return groups

    def _differences(self, near: tuple[float, ...]) -> list[Difference]:
        def rms(values: Floats) -> float:
            return float(np.sqrt((values**2).mean()))

        found = []
        for one, columns in zip(self._fitted.each, self._fitted.columns, strict=True):
            kept = np.arange(len(self._fitted))[columns][self._kept[columns]]
            if not len(kept):
                continue
            before, after = (mean_data(self._data[x])[kept] - self._mean[kept] for x in (tuple(self._start.tolist()), near))
            expected = rms(np.sqrt(variance_of_mean(self._data[near][:, kept]) + variance_of_mean(self._measured[:, kept])))
            found.append(Difference(one.name, one.unit, rms(before), rms(after), expected))
        return found


def _scatter(data: Floats, found: Minimum) -> tuple[Floats, int]:
    """(p, p) covariance of the minimum by that of the mean of these rows (replicas, values), and their number."""
    shifts = data[np.isfinite(data).all(1)] @ found.gain.T
    count = len(shifts)
    if count < 2:
        return np.zeros((len(found.x),) * 2), count
    shifts = shifts - shifts.mean(0)
    return shifts.T @ shifts / (count * (count - 1)), count
