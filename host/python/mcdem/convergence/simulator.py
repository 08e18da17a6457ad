"""Simulations of one scene with changed numerics, observed as in a diagnosis: what the study of its convergence compares."""
from __future__ import annotations

import pathlib
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from .. import _engine as engine
from ..diagnosis.model import Model
from ..diagnosis.plan import SEEDS
from ..diagnosis.trials import Comparison, ObservationStore, Observer, Progress, Trial
from ..errors import InputError
from ..experiment.experiment import Measurement
from ..experiment.instrument import Instrument
from ..look import Path
from ..observe.grid import Grid, grid_of, grid_of_stroke
from ..results.recording import Floats

JITTER = 0.005  # standard deviation of every initial coordinate, over the mean diameter


class Simulator:
    """Copies of the packing of a scene's first replica. Simulations are stored, so that none is repeated."""

    def __init__(self, scene: engine.Scene, folder: Path, *, replicas: int, jitter: float, seed: int, device: str) -> None:
        """`jitter`: standard deviation of every initial coordinate [m]; 0: half a per cent of a diameter. Raises InputError."""
        engine.expect_plate(scene, "mcdem converge")
        self._device = engine.Device(device)
        self._scene = scene._variant({})
        self._store = ObservationStore(pathlib.Path(folder) / "simulations")
        self._seed = seed
        self._packings = replicas * engine.make_packings(self._scene)
        self._mean_diameter = float(self._packings[0].diameter.mean())
        self._jitter = jitter or JITTER * self._mean_diameter
        self.grid = Grid([], 0, 0)

    @property
    def device_name(self) -> str:
        return self._device.name

    @property
    def draws_packings(self) -> bool:
        """Whether the packing is generated, so that there are others of its kind."""
        return self._scene._values["packing.file"] is None

    def find_grid(self, progress: Progress | None = None) -> Grid:
        """The displacements that are compared from then on: those of a diagnosis of an experiment with this scene's stroke or programme. The
        first copy is simulated if there is a programme. Raises InputError if that stops."""
        model = self._model(self._scene)
        if not model.has_programme:
            self.grid = _grid_of_stroke(model)
            return self.grid
        trials = [replace(self._trials(model)[0], jitter=0, recorded=True)]
        observer = self._observer(model)
        observer.observe(trials, progress)
        recording = observer.recordings(trials)[0]
        if recording.failure or not len(recording.scans):
            raise InputError(f"{self._scene.name}: the first replica does not come to the end of the programme: `mcdem run` with the same "
                             "settings says why")
        self.grid = grid_of(recording)
        return self.grid

    def observe(self, changes: Mapping[str, Any], progress: Progress | None = None) -> Floats:
        """(copies, bins) of the scene with these values of keys; NaN where a simulation failed. Raises InputError."""
        model = self._model(self._scene._changed(dict(changes)))
        return self._observer(model).observe(self._trials(model), progress)

    def draw_packings(self) -> None:
        """From then on every copy has its own random packing."""
        seed = self._scene._values["packing.seed"]
        self._packings = engine.make_packings(self._scene, [(seed + copy) % SEEDS for copy in range(len(self._packings))])

    def _model(self, scene: engine.Scene) -> Model:
        threshold = scene._values["protocol.force_threshold"]
        return Model(scene, {}, Instrument(Measurement(force_threshold=threshold)), self._mean_diameter)

    def _trials(self, model: Model) -> list[Trial]:
        return [Trial(model, packing, self._jitter, 0.0, (self._seed + copy) % SEEDS) for copy, packing in enumerate(self._packings)]

    def _observer(self, model: Model) -> Observer:
        comparison = Comparison(self.grid, model.material(), model["protocol.discard"])
        return Observer(self._device.description, self._store, comparison, self._device)


def _grid_of_stroke(model: Model) -> Grid:
    """Of an experiment with this stroke."""
    stroke = model["plate.start"] - model["plate.end"]
    return grid_of_stroke(stroke, stroke / model["protocol.scans_per_stroke"])
