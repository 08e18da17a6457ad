"""Convergence of a scene: influence of plate speed, inertia, time step, settling, precision and neighbour lists on every observable."""
import json
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from .._engine import Scene
from ..errors import InputError
from ..look import Path
from ..observe.grid import Bin, Grid, bins_of
from ..observe.observables import observables
from ..outputs import CONVERGENCE, expect_replaceable, output_folder, remove_temporaries
from ..results.recording import Floats
from .convergence_json import FILE, write_convergence
from .convergence_types import Convergence, Limits
from .errors import Baseline, Errors, cause_errors, errors_of
from .refinements import Changes, Refinement, refinements_of
from .simulator import Simulator
from .words import words_of_cause, words_of_result

FEWEST_RUNS = 4  # that give a standard error

Progress = Callable[[str, float], object]  # stage, fraction


def converge(scene: Scene, folder: Path, *, replicas: int = 32, force_limit: float = 0.005, sd_limit: float = 0.5,
             jitter: float = 0.0, seed: int = 1, device: str = "", progress: Progress | None = None) -> dict[str, Any]:
    """How plate speed, inertia, time step, settling, precision and list margin change the observables of a scene's first replica: the
    contents of convergence.json, which is written into `folder`.

    `replicas`: jittered copies of the packing; `jitter`: their standard deviation [m], 0: half a per cent of a diameter; `force_limit`:
    largest relative error of forces; `sd_limit`: largest error of all else, in standard deviations over the copies. Simulations are kept in
    the folder, so that the same call continues after an interruption by Ctrl-C. `progress(stage, fraction)` is called repeatedly.
    `mcdem converge --help` explains the method. Raises ValueError, RuntimeError.
    """
    _check(replicas, force_limit, sd_limit, jitter)
    with output_folder(folder) as out:
        remove_temporaries(out / "simulations")
        expect_replaceable(out / FILE, CONVERGENCE)
        simulator = Simulator(scene, out, replicas=replicas, jitter=jitter, seed=seed, device=device)
        study = Study(scene, simulator, jitter, Limits(force_limit, sd_limit), progress or (lambda stage, fraction: None))
        document: dict[str, Any] = json.loads(write_convergence(study.run(), out))
    return document


def _check(replicas: int, force_limit: float, sd_limit: float, jitter: float) -> None:
    problems = [f"replicas: must be 8 or more, got {replicas}"] if replicas < 8 else []
    problems += [f"{name}: must be above 0, got {value:g}" for name, value in (("force_limit", force_limit), ("sd_limit", sd_limit))
                 if not value > 0]
    if not 0 <= jitter <= 1:
        problems.append(f"jitter: must be between 0 and 1, got {jitter:g}")
    if problems:
        raise InputError(problems)


class Study:
    """The steps of a study of a scene's first replica."""

    def __init__(self, scene: Scene, simulator: Simulator, jitter: float, limits: Limits,
                 progress: Progress) -> None:
        self._scene, self._simulator, self._jitter, self._limits, self._progress = scene, simulator, jitter, limits, progress

    def run(self) -> Convergence:
        """Uses jittered copies of the replica's packing or, if those hardly differ, new packings. Raises InputError if the runs of the
        scene itself stop, RunError, KeyboardInterrupt."""
        begin = time.monotonic()
        grid = self._simulator.find_grid(self._stage("the programme's displacements"))
        bins = bins_of(grid)
        first = _first_compared(bins, grid)
        baseline, copies = self._baseline(bins, first)
        causes, words = [], []
        for refinement in refinements_of(self._scene.parameters[0]):
            errors = cause_errors(refinement.cause, baseline, self._errors(baseline.observed, refinement))
            causes.append(errors)
            words.append(words_of_cause(errors, refinement.remedy, self._limits, len(bins)))
        return Convergence(self._scene.name, len(baseline.observed), copies, (words_of_result(causes), *words), self._limits, tuple(causes),
                           time.monotonic() - begin)

    def _baseline(self, bins: list[Bin], first: int) -> tuple[Baseline, str]:
        """The scene's replicas, and a description of them."""
        copies = "jittered copies of one packing"
        baseline = self._observed_scene("the scene as it stands", bins, first)
        if self._jitter or not baseline.hardly_differ():
            return baseline, copies
        if not self._simulator.draws_packings:
            return baseline, f"{copies}, which hardly differ; a packing.file has no random copies: a larger --jitter makes them"
        self._simulator.draw_packings()
        return (self._observed_scene("new random packings", bins, first),
                "new random packings, because jittered copies of one hardly differ")

    def _observed_scene(self, stage: str, bins: list[Bin], first: int) -> Baseline:
        observed = self._observe(stage, {})
        runs = np.count_nonzero(~np.isnan(observed[:, first]))
        if runs < FEWEST_RUNS:
            raise InputError(f"{self._scene.name}: {runs} of {len(observed)} replicas reach the first compared displacement with a force "
                             f"on the plate, and {FEWEST_RUNS} are needed: `mcdem run` with the same settings says why")
        return Baseline(bins, observed, self._limits)

    def _errors(self, base: Floats, refinement: Refinement) -> Errors:
        return errors_of(base, [step.remaining for step in refinement.steps],
                         [self._observe(refinement.cause, step.changes) for step in refinement.steps])

    def _observe(self, stage: str, changes: Changes) -> Floats:
        return self._simulator.observe(changes, self._stage(stage))

    def _stage(self, name: str) -> Callable[[float], object]:
        return lambda fraction: self._progress(name, fraction)


def _first_compared(bins: list[Bin], grid: Grid) -> int:
    """The first bin of what the plate does not prescribe: of the force, or of the displacement where the programme sets forces."""
    name = "displacement" if grid.force else "top_force"
    return next(k for k, bin in enumerate(bins) if observables()[bin.observable].name == name)
