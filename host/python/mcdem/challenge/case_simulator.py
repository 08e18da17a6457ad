"""Simulates experiments with hidden effects."""
from collections.abc import Callable, Sequence
from dataclasses import replace

from .. import _engine as engine
from ..diagnosis.effects import find_effect, nuisances
from ..diagnosis.model import Model
from ..errors import InputError
from ..experiment.experiment import Measurement
from ..experiment.instrument import Instrument, measured
from ..results.engine_run import run_of
from ..results.recording import Recording
from .case import ChallengeCase
from .outside_effects import find_outside_effect

# Hidden numerics of every case, so that the diagnosis cannot rely on identical numerics.
TIME_STEP_FACTOR = 0.7
RESTITUTION_FACTOR = 0.95
START_JITTER = 0.02  # over the mean diameter, so that packings with the same seed differ

GRAINS_AT_ONCE = 16_384  # a batch is lost after an interruption


class CaseSimulator:
    def __init__(self, scene: engine.Scene, measurement: Measurement, device: str) -> None:
        """Raises InputError if the scene is unsuitable."""
        _expect_suitable(scene)
        base = scene._variant({"protocol.scan_at_start": True})
        self.stated = Model(base, {}, Instrument(measurement), scene._values["packing.diameter_mean"])
        self.nuisances = nuisances(self.stated, {})
        self._device = engine.Device(device)
        self._packings: list[engine.Packing] = []
        self._cases: Sequence[ChallengeCase] = ()
        self._recordings: Sequence[Recording] = ()  # of these cases

    def make_packings(self, seeds: Sequence[int]) -> None:
        self._packings = engine.make_packings(self.stated.scene, seeds)

    def at_once(self) -> int:
        """Number of cases that are simulated together."""
        return max(1, GRAINS_AT_ONCE // len(self._packings[0]))

    def simulate(self, cases: Sequence[ChallengeCase], loading: bool, progress: Callable[[float], object]) -> list[str]:
        """Why each case failed; empty where it did not. `loading`: only up to the end of the first stroke down."""
        self._cases, jitter = cases, START_JITTER * self.stated.mean_diameter
        starts = [(self._model_of(case).scene, self._packings[case.packing], jitter, 0.0, case.seed) for case in cases]
        scans = 1 + self.stated["protocol.scans_per_stroke"] if loading else None
        self._recordings = run_of(engine.simulate_starts(self._device, starts, scans=scans, progress=progress)).recordings
        return [one.failure.text() if one.failure else "" for one in self._recordings]

    def measured(self, k: int) -> Recording:
        """The k-th case of the last call as its instrument reads it, with the box as it is stated."""
        case, recording = self._cases[k], self._recordings[k]
        for hidden in case.effects:
            outside = find_outside_effect(hidden.name)
            if outside and outside.change_reading:
                recording = outside.change_reading(recording, hidden.amplitude)
        box = replace(recording.box, size_x=self.stated["box.size_x"], size_y=self.stated["box.size_y"])
        return measured(replace(recording, box=box, label=case.folder), self._model_of(case).instrument, case.seed)

    def _model_of(self, case: ChallengeCase) -> Model:
        model, shifts = self.stated, {one.name: one.apply for one in self.nuisances}
        for shift in case.nuisances:
            model = shifts[shift.name](model, shift.amplitude)
        for hidden in case.effects:
            effect, outside = find_effect(hidden.name), find_outside_effect(hidden.name)
            if outside and outside.change_model:
                model = outside.change_model(model, hidden.amplitude)
            elif effect and not outside:
                model = effect.apply(model, hidden.amplitude)
        factors = {"numerics.time_step": TIME_STEP_FACTOR, "grains.restitution": RESTITUTION_FACTOR, "walls.restitution": RESTITUTION_FACTOR}
        return model.with_keys({key: factor * model[key] for key, factor in factors.items()})


def _expect_suitable(scene: engine.Scene) -> None:
    engine.expect_plain_strokes(scene, "a challenge")
    values, problems = scene._values, []
    if len(scene) != 1:
        problems.append(f"{scene.name}: a challenge needs one replica, got {len(scene)}")
    if values["container.shape"] != "box":
        problems.append(f"{scene.name}: a challenge's container.shape must be box, got {values['container.shape']}")
    if values["packing.file"] is not None:
        problems.append(f"{scene.name}: a challenge generates its packings; packing.file must not be set")
    if problems:
        raise InputError(problems)
