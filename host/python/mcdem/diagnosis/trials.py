"""Many small simulations, each observed through an instrument: for signatures, noise floors and the confirmation of effects."""
from __future__ import annotations

import hashlib
import pathlib
from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass

import numpy as np

from .. import _engine as engine
from ..errors import InputError
from ..experiment.instrument import measured
from ..files import read_whole, write_whole
from ..look import Path, is_there
from ..observe.contact_residuals import Material
from ..observe.grid import Grid, bins_of
from ..observe.observables import observables
from ..observe.observation import observe
from ..outputs import make_folder
from ..results.engine_run import run_of
from ..results.recording import Floats, Recording
from .model import Model

GRAINS_AT_ONCE = 32_768  # that a device simulates together
GRAINS_OF_A_PART = 8_192  # less, so that every process gets some
DIGEST = 64  # characters

Progress = Callable[[float], object]


def ignore(*_: object) -> None:
    """As progress that nobody sees."""


@dataclass(frozen=True, eq=False)
class Trial:
    """One simulation and its observation."""

    model: Model
    packing: engine.Packing  # initial one, as measured
    jitter: float  # standard deviation of the noise on every initial coordinate [m]
    diameter_jitter: float  # .. on every diameter [m]
    seed: int  # for both jitters, random properties of the grains, and the noise of the measurement
    recorded: bool = False  # whether the complete recording is stored as well


@dataclass(frozen=True)
class Comparison:
    """How all trials are observed."""

    grid: Grid
    material: Material
    discard: int  # number of first cycles that are ignored


class ObservationStore:
    """A folder that keeps observations and complete recordings by name, so that no simulation is repeated."""

    def __init__(self, folder: Path) -> None:
        self.folder = pathlib.Path(folder)
        make_folder(self.folder)

    def find(self, name: str) -> Floats | None:
        """(bins,); None if it is missing or damaged. A digest of the numbers is stored before them."""
        file = self.folder / f"{name}.obs"
        if not is_there(file):
            return None
        content = read_whole(file)
        digest, numbers = content[:DIGEST], content[DIGEST:]
        if len(numbers) % 8 or digest != hashlib.sha256(numbers).hexdigest().encode():
            return None
        return np.frombuffer(numbers, "<f8")

    def keep(self, name: str, observation: Floats) -> None:
        numbers = observation.astype("<f8").tobytes()
        write_whole(self.folder / f"{name}.obs", hashlib.sha256(numbers).hexdigest().encode() + numbers)

    def keep_recording(self, name: str, run: engine.Run, number: int) -> None:
        engine.write_recording(self.folder / f"{name}.h5", run, number)

    def recording(self, name: str) -> Recording:
        """As simulated. Raises InputError if it is missing or damaged."""
        file = self.folder / f"{name}.h5"
        recordings = run_of(engine.read(file)).recordings
        if not recordings:
            raise InputError(f"{file}: holds no recording")
        return recordings[0]

    def has_recording(self, name: str) -> bool:
        try:
            return is_there(self.folder / f"{name}.h5") and len(self.recording(name).diameter) > 0
        except InputError:
            return False


def simulation_name(trial: Trial, device: str) -> str:
    """Digest of everything that determines the simulation of a trial."""
    facts = (engine.__version__, device, trial.model.digest, trial.packing.digest, float(trial.jitter), float(trial.diameter_jitter),
             trial.seed)
    return hashlib.sha256(repr(facts).encode()).hexdigest()


def observation_name(simulation: str, comparison: Comparison, trial: Trial) -> str:
    """.. and its observation."""
    facts = simulation, plain(astuple(trial.model.instrument)), plain(astuple(comparison)), [one.name for one in observables()]
    return hashlib.sha256(repr(facts).encode()).hexdigest()


def plain(value: object) -> object:
    """The same with every number as a float: equal values have equal texts."""
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    return float(value) if isinstance(value, (int, float, np.number)) else value


class Observer:
    """Observes trials on one device. Trials that differ only in the instrument share a simulation."""

    def __init__(self, description: str, store: ObservationStore, comparison: Comparison, device: engine.Device | None = None) -> None:
        """`description`: of the device, which only simulations need."""
        self.description, self.store, self.comparison, self.device = description, store, comparison, device

    def observe(self, trials: Sequence[Trial], progress: Progress | None = None, failed: Callable[[int, str], object] = ignore) -> Floats:
        """(trials, bins); NaN where a simulation failed. Results in the store are reused, and new ones are stored as they are computed.

        `failed` receives the index of a trial and why its simulation failed; results in the store have no reason.
        """
        names = self.names(trials)
        stored = self._stored(trials, names)
        rows = np.full((len(trials), self._bins), np.nan)
        for t, observation in stored.items():
            rows[t] = observation
        jobs, done = jobs_of([t for t in range(len(trials)) if t not in stored], names), 0
        for batch in batches_of(jobs, trials, GRAINS_AT_ONCE):
            begin, part = done / len(jobs), len(batch) / len(jobs)
            run = self._simulate([[trials[t] for t in job] for job in batch], lambda fraction: (progress or ignore)(begin + part * fraction))
            for number, (job, recording) in enumerate(zip(batch, run_of(run).recordings, strict=True)):
                if recording.failure:
                    failed(job[0], recording.failure.cause)
                if any(trials[t].recorded for t in job):
                    self.store.keep_recording(names[job[0]], run, number)
                for t in job:
                    if not recording.failure:
                        rows[t] = self._observed(recording, trials[t])
                    self.store.keep(observation_name(names[t], self.comparison, trials[t]), rows[t])
            done += len(batch)
        return rows

    def has(self, trials: Sequence[Trial]) -> bool:
        """Whether the store has the observations of all these trials, and the recordings that they ask for."""
        return len(self._stored(trials, self.names(trials))) == len(trials)

    def recordings(self, trials: Sequence[Trial]) -> list[Recording]:
        """Complete ones that the store has, as measured. Raises InputError."""
        return [measured(self.store.recording(name), trial.model.instrument, trial.seed)
                for name, trial in zip(self.names(trials), trials, strict=True)]

    def names(self, trials: Sequence[Trial]) -> list[str]:
        """Of the trials' simulations."""
        return [simulation_name(trial, self.description) for trial in trials]

    @property
    def _bins(self) -> int:
        return len(bins_of(self.comparison.grid))

    def _stored(self, trials: Sequence[Trial], names: Sequence[str]) -> dict[int, Floats]:
        """The observations that the store has, by trial; without those whose recording it should have and lacks."""
        stored = {}
        for t, (trial, name) in enumerate(zip(trials, names, strict=True)):
            found = self.store.find(observation_name(name, self.comparison, trial))
            if found is not None and len(found) == self._bins and (not trial.recorded or self.store.has_recording(name)):
                stored[t] = found
        return stored

    def _simulate(self, batch: Sequence[Sequence[Trial]], progress: Progress) -> engine.Run:
        assert self.device
        starts = [(one.model.scene, one.packing, one.jitter, one.diameter_jitter, one.seed) for one, *_ in batch]
        ends = [-np.inf if any(trial.recorded for trial in job) else self._end_of(job) for job in batch]
        return engine.simulate_starts(self.device, starts, end_below=ends, progress=progress)

    def _end_of(self, trials: Sequence[Trial]) -> float:
        """Displacement below which, on the last way back, no scan counts for any of these trials [m]. A plate that follows the load is slowest
        there."""
        grid = self.comparison.grid
        return min(grid.displacement) - grid.width - max(abs(trial.model.instrument.strain_offset) for trial in trials)

    def _observed(self, recording: Recording, trial: Trial) -> Floats:
        seen = measured(recording, trial.model.instrument, trial.seed)
        return observe(seen, self.comparison.grid, self.comparison.material, self.comparison.discard)


def jobs_of(numbers: Sequence[int], names: Sequence[str]) -> list[list[int]]:
    """The trials with these numbers, grouped by the names of their simulations."""
    jobs: dict[str, list[int]] = {}
    for t in numbers:
        jobs.setdefault(names[t], []).append(t)
    return list(jobs.values())


def batches_of(jobs: Sequence[list[int]], trials: Sequence[Trial], max_grains: int) -> list[list[list[int]]]:
    """Jobs that are simulated together."""
    batches: list[list[list[int]]] = []
    grains = max_grains
    for job in jobs:
        if grains >= max_grains:
            batches.append([])
            grains = 0
        batches[-1].append(job)
        grains += len(trials[job[0]].packing)
    return batches


def parts_of(trials: Sequence[Trial]) -> list[list[Trial]]:
    """Parts that can be simulated separately; the division does not depend on the device. Trials that share a simulation are in one part."""
    jobs = jobs_of(range(len(trials)), [simulation_name(trial, "") for trial in trials])
    return [[trials[t] for job in batch for t in job] for batch in batches_of(jobs, trials, GRAINS_OF_A_PART)]

