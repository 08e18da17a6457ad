"""Each key of a scene moved alone until one quantity is the wanted one, and what becomes of other quantities."""
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..look import Path
from ..observe.levels import Level, by_replica, top_force
from ..observe.replicas import SEED, Replicas
from ..results.names import Phase
from ..results.parameters import keys_that_vary
from ..results.recording import Floats
from .fit import End, Fit, Ranges, Target
from .keys import DIAMETERS, OFFSET, FitKey, fit_keys
from .quantities import MM, Quantities, Quantity, at_levels, curves, single, stroke_of
from .scene_fit import VARIES, of_averages
from .trials import ALL_SCANS, Trials, mean_data

if TYPE_CHECKING:
    from .._engine import Scene

KEYS = ("grains.youngs_modulus", "contact.gamma", "grains.poisson_ratio", "grains.friction+walls.friction", DIAMETERS, OFFSET)  # by default
HALVES = 0.5, 1.0  # of the stroke, where by default the force and Z are shown
BATCH = 3  # values of a key in the first round, besides the scene's; later it is one
FOR_SQUARES = 3  # trials: paired ones hardly scatter
LEVELS = 30  # of the curves


@dataclass(frozen=True)
class WhatIfOptions:
    keys: Sequence[str] = ()  # KEY or KEY=LOW..HIGH; none: KEYS that the scene has
    target: tuple[str, float] | None = None  # name of a quantity and its value; None: the measured top force
    shown: Sequence[str] = ()  # names of more quantities
    accuracy: float = 0.005  # relative, of the target
    rounds: int = 6
    device: str = ""
    folder: Path | None = None  # where trials are kept


@dataclass(frozen=True, eq=False)
class Move:
    """The trial of a key that comes nearest to the target."""
    key: FitKey
    value: float
    is_met: bool
    end: End | None  # why it comes no nearer; None: no rounds are left
    numbers: Floats  # (shown,) quantities there, the target first
    force: Floats  # (levels,) on the plate [N]; NaN beyond where it stops
    trials: Floats  # (n, 2) values and the target quantity, in order of values


@dataclass(frozen=True, eq=False)
class WhatIf:
    shown: Sequence[Quantity]  # the target first
    target: float
    base: Floats  # (shown,) of the scene
    displacement: Floats  # (levels,) [mm]
    force: Floats  # (levels,) of the scene [N]
    measured: tuple[Floats, Floats] | None  # displacement [mm] and force [N] of the experiment while loading
    measured_numbers: Floats  # (shown,) of the experiment; NaN where it does not know them
    moves: Sequence[Move]
    packings: int


def what_if(scene: "Scene", reference: Replicas | None, options: WhatIfOptions, progress: Callable[[float], object],
            after_round: Callable[[WhatIf], object]) -> WhatIf:
    """`progress` is told the fraction of all rounds, `after_round` what is found so far. Raises InputError, RunError."""
    parameters: Mapping[str, Any] = scene.parameters[0]
    if parameters["container.shape"] == "cell" or "programme.1.stage" in parameters:
        raise InputError("what-if: the scene must have the strokes of [plate] and [protocol], got a cell or a programme")
    if problems := [f"what-if: {key} must be the same for all replicas: give one value with --set {key}=.."
                    for key in keys_that_vary(scene.parameters) if key != SEED and not key.startswith(VARIES)]:
        raise InputError(problems)
    prepared = of_averages(scene, reference)
    words = options.keys or [key for key in KEYS if _is_moved(key, parameters)]
    fit_keys(words, prepared, 1.0)  # errors before packings are made
    work = _Work(prepared, reference, options)
    work.start(fit_keys(words, prepared, work.trials.batch.mean_diameter))
    while work.rounds < options.rounds and work.open():
        work.round(lambda part: progress((work.rounds + part) / options.rounds))
        after_round(work.result())
    return work.result()


def _is_moved(key: str, parameters: Mapping[str, Any]) -> bool:
    if key == "contact.gamma":
        return bool(parameters["contact.model"] == "mc_dem")
    names = key.split("+")
    if "species.1.name" in parameters and any(name.startswith("grains.") for name in names):
        return False  # species have their own
    return key == OFFSET or all(parameters.get(name) is not None and (parameters[name] or len(names) == 1) for name in names)


class _Work:
    """The trials so far of every key."""

    def __init__(self, scene: "Scene", reference: Replicas | None, options: WhatIfOptions) -> None:
        self.trials = Trials(scene, options.device, options.folder)
        parameters: Mapping[str, Any] = scene.parameters[0]
        self._parameters, self._options, self._reference, self.rounds = parameters, options, reference, 0
        self._stroke = parameters["plate.start"] - parameters["plate.end"]
        name, self._value = options.target or ("top_force", math.nan)
        place = stroke_of(reference) if reference else self._stroke
        others = options.shown or [f"{kind}@{round(part * place / MM, 2):g}" for kind in ("force_share", "coordination") for part in HALVES
                                   if (kind, part) != ("force_share", 1.0)]
        self._shown = [single(one, place) for one in dict.fromkeys([name, "top_force", *others])]
        levels = [Level(Phase.load, self._stroke * k / LEVELS, (), ()) for k in range(1, LEVELS + 1)]
        self._curve = at_levels("force", levels, lambda _, theirs: by_replica(theirs, top_force))
        self._all = Quantities([*self._shown, self._curve])
        self._measured = mean_data(Quantities(self._shown).of(reference)) if reference else np.full(len(self._shown), math.nan)
        self._value = self._value if options.target else float(self._measured[0])
        if not math.isfinite(self._value):
            raise InputError("what-if: without an experiment that knows the top force a target is required: --target top_force=VALUE")

    def start(self, keys: Sequence[FitKey]) -> None:
        self._keys = keys
        target = Target(np.array([self._value]), np.array([abs(self._value) or 1.0]))
        ends = [[np.array([value]) for value in (key.low, key.high, key.range_low, key.range_high)] for key in keys]
        self._fits = [Fit(target, Ranges(low, high, first, last, 2e-3 * (last - first)), BATCH, FOR_SQUARES) for low, high, first, last in ends]
        self._data = [dict[float, Floats]() for _ in keys]

    def open(self) -> list[int]:
        """Numbers of the keys of which more trials are needed."""
        return [k for k, fit in enumerate(self._fits) if fit.end in (None, End.converged) and not self._is_met(k)]

    def round(self, progress: Callable[[float], object]) -> None:
        """All keys' trials in one batch."""
        wanted = [(k, value) for k in self.open() for value in self._values(k)]
        changes = [self._keys[k].values(value) if value != self._keys[k].value else {} for k, value in wanted]
        data = self.trials.data(changes, self._all, self._scans(), progress)
        for k in self.open():
            rows = [row for row, (owner, _) in enumerate(wanted) if owner == k]
            values = np.array([wanted[row][1] for row in rows])
            means = [mean_data(data[row]) for row in rows]
            self._fits[k].add(values[:, None], np.array([one[:1] for one in means]))
            self._data[k] |= dict(zip(values.tolist(), means, strict=True))
        self.rounds += 1

    def _values(self, k: int) -> list[float]:
        """Of a key: the scene's and others in its range, later the estimate."""
        fit, key = self._fits[k], self._keys[k]
        if not self.rounds:
            return [key.value, *(value for value in fit.values[:, 0].tolist() if value != key.value)]
        if not fit.minimum:
            return list(fit.values[:, 0].tolist())
        return [float(fit.minimum.x[0])]

    def _scans(self) -> int:
        """Without the last unloading, if no quantity needs it."""
        if any(one.unloads.any() for one in self._shown):
            return ALL_SCANS
        strokes = 2 * self._parameters["protocol.cycles"] - 1
        return int(strokes * self._parameters["protocol.scans_per_stroke"] + self._parameters["protocol.scan_at_start"])

    def _best(self, k: int) -> float:
        """The value nearest to the target; the scene's, if all stop early."""
        known = {value: abs(data[0] - self._value) for value, data in self._data[k].items() if math.isfinite(data[0])}
        return min(known, key=lambda value: (known[value], abs(value - self._keys[k].value)), default=self._keys[k].value)

    def _is_met(self, k: int) -> bool:
        found = self._data[k].get(self._best(k))
        return found is not None and bool(abs(found[0] - self._value) <= self._options.accuracy * abs(self._value))

    def _measured_curve(self) -> tuple[Floats, Floats] | None:
        """Of the experiment while loading."""
        if not self._reference:
            return None
        force = curves(self._reference, ["force"])
        loading = force.each[0].unloads == 0
        return force.each[0].place[loading], mean_data(force.of(self._reference))[loading]

    def result(self) -> WhatIf:
        shown, moves = len(self._shown), []
        for k, (key, fit) in enumerate(zip(self._keys, self._fits, strict=True)):
            best = self._best(k)
            data, rows = self._data[k][best], sorted(self._data[k])
            moves.append(Move(key, best, self._is_met(k), fit.end, data[:shown], data[shown:],
                              np.array([(value, self._data[k][value][0]) for value in rows])))
        base = self._data[0][self._keys[0].value]
        return WhatIf(self._shown, self._value, base[:shown], self._curve.place, base[shown:], self._measured_curve(), self._measured, moves,
                      self.trials.packings)
