"""Simulations of a scene's packings with other values of keys: all of a round in one batch, none of them twice."""
import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _engine
from ..diagnosis.trials import ObservationStore
from ..look import Path
from ..results.engine_run import run_of
from ..results.recording import Floats
from .keys import OFFSET, scene_changes
from .quantities import Quantities

if TYPE_CHECKING:
    from .._engine import Batch

ALL_SCANS = 1 << 31
Changes = Mapping[str, float]  # values of keys, or of OFFSET
Part = Callable[[float], object]  # is told the fraction of a round that is done


class Trials:
    """The same packings for every trial, so that differences between trials are paired."""

    def __init__(self, scene: "_engine.Scene", device: str, folder: Path | None = None) -> None:
        """`folder`: where data are kept, so that an interrupted fit continues."""
        self.batch: Batch = _engine.Batch(scene, device)
        self._parameters: Mapping[str, Any] = scene.parameters[0]
        self._store = ObservationStore(folder) if folder is not None else None
        self._facts = repr(sorted(_engine.manifest_of(scene).items())) + self.batch.device_name if self._store else ""
        self._known = dict[str, Floats]()

    @property
    def packings(self) -> int:
        return self.batch.packings

    def data(self, changes: Sequence[Changes], quantities: Quantities, scans: int = ALL_SCANS, progress: Part = lambda _: None) -> Floats:
        """(trials, packings, values) of the quantities with each of the changes; NaN where a simulation stopped before. Raises InputError,
        RunError, KeyboardInterrupt."""
        names = [hashlib.sha256(repr((self._facts, sorted(one.items()), scans, quantities.facts())).encode()).hexdigest() for one in changes]
        missing = {name: one for name, one in zip(names, changes, strict=True) if not self._find(name, quantities)}
        if missing:
            wanted = [scene_changes(one, self._parameters) for one in missing.values()]
            run = run_of(self.batch.simulate(wanted, scans, progress)).recordings
            for k, (name, values) in enumerate(missing.items()):
                replicas = run[k * self.packings:][:self.packings]
                if OFFSET in values:
                    replicas = tuple(replace(one, plate_start=self._parameters["plate.start"] - values[OFFSET]) for one in replicas)
                self._keep(name, quantities.of(replicas))
        return np.array([self._known[name] for name in names])

    def _find(self, name: str, quantities: Quantities) -> bool:
        if name not in self._known and self._store:
            stored = self._store.find(name)
            if stored is not None and len(stored) == self.packings * len(quantities):
                self._known[name] = stored.reshape(self.packings, len(quantities))
        return name in self._known

    def _keep(self, name: str, data: Floats) -> None:
        self._known[name] = data
        if self._store:
            self._store.keep(name, data.ravel())


def mean_data(data: Floats) -> Floats:
    """(values,) mean over the packings (packings, values) that reached the end; NaN if at least half of them did not, value by value."""
    known = np.isfinite(data)
    with np.errstate(invalid="ignore"):
        mean = np.where(known, data, 0).sum(0) / known.sum(0)
    return np.asarray(np.where(2 * known.sum(0) > len(data), mean, math.nan))
