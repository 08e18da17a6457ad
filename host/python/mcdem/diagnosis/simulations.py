"""The simulations that a diagnosis asks for, as observations."""
from __future__ import annotations

import hashlib
import weakref
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import _engine as engine
from ..errors import InputError
from ..experiment.experiment import Experiment, other_materials
from ..experiment.topology import with_listed_contacts
from ..look import Path
from ..number_text import shortest
from ..observe.grid import Grid, HoldScans
from ..observe.observables import observables
from ..observe.observation import observe
from ..problems import to_number
from ..results.names import Phase
from ..results.recording import Floats, Recording
from .change_of_the_scene import Amplitudes
from .effects import EFFECTS, find_effect
from .library import DRAWN
from .model import Model
from .plan import Plan, plan_of, plan_of_others
from .plate_motion import Change, neglected_motion
from .trials import ObservationStore, Observer, Progress, Trial, parts_of

RECORDED = 4  # of the first trials, for the metrics of the paper
TIMES_HELD = 3  # relaxation times for which another protocol holds the plate
TIMES_SLOWER = 4  # factor by which its plate is slower; simulations take as much longer

_devices: "weakref.WeakValueDictionary[str, engine.Device]" = weakref.WeakValueDictionary()  # by choice


@dataclass(frozen=True)
class OtherProtocol:
    """Would it tell rival explanations of a gap apart? Predicted by runs of both."""

    what: str  # "hold the plate at full stroke for 0.3 s"
    change: Callable[[Model], Model]
    grid: Grid | None = None  # None: that of the diagnosis


class Simulations:
    """Results are (simulations, bins), NaN where a simulation failed. Simulations are kept in a folder and never repeated."""

    def __init__(self, plan: Plan, store: Path, device: str) -> None:
        """`device`: a choice, as for --device; it is opened when something must be simulated, and shared by all of the same choice."""
        self.plan, self._store, self._choice = plan, ObservationStore(store), device
        self._opened: engine.Device | None = None
        self._protocols: list[OtherProtocol] = []
        self._parts: list[list[Trial]] | None = None
        self.causes_of_failure: dict[str, str] = {}  # until now, by the probe of a library, or "" for the unchanged scene

    @staticmethod
    def of(scene: engine.Scene, experiments: Sequence[Experiment], store: Path, *, candidates: Sequence[str], replicates: int, pairs: int,
           seed: int, recordings: bool, device: str, note: Callable[[str], object]) -> Simulations:
        """Of the experiments' own packings (plan_of). Raises InputError."""
        return Simulations(plan_of(scene, experiments, candidates, replicates, pairs, seed, recordings, note), store, device)

    @staticmethod
    def of_others(scene: engine.Scene, experiment: Experiment, packings: int, store: Path, *, candidates: Sequence[str], replicates: int,
                  pairs: int, seed: int, device: str) -> Simulations:
        """Of other packings of the same kind (plan_of_others). Raises InputError."""
        return Simulations(plan_of_others(scene, experiment, packings, candidates, replicates, pairs, seed), store, device)

    def facts(self) -> dict[str, Any]:
        plan, model = self.plan, self.plan.model
        candidates = []
        for effect in plan.candidates:
            scale = effect.scale(model)
            slower = effect.name == "plate_speed" and model.experiment_speed is not None
            high = 1 - model.experiment_speed / model["plate.speed"] if slower and model.experiment_speed else effect.high * scale
            candidates.append((effect.name, effect.unit, effect.low * scale, high))
        return {"names": [one.name for one in plan.experiments], "packings": len(plan.packings), "replicates": plan.replicates,
                "candidates": candidates, "hindered": plan.hindered, "nuisances": [(one.name, one.unit, one.sigma) for one in plan.nuisances],
                "probes": [(one.name, *one.amplitudes) for one in plan.probes()], "paired_rows": plan.paired_rows(),
                "has_programme": model.has_programme, "drawn": plan.drawn, "other_materials": other_materials(plan.experiments[0].materials, model.base.parameters[0])}

    @property
    def device(self) -> str:
        """Its description; opened where needed."""
        return self._device.description

    @property
    def device_name(self) -> str:
        return self._device.name

    @property
    def _device(self) -> engine.Device:
        if self._opened is None:
            self._opened = _devices.get(self._choice) or engine.Device(self._choice)
            _devices[self._choice] = self._opened
        return self._opened

    @property
    def grid(self) -> Grid:
        """Displacements that are compared; set, those of a library from then on."""
        return self.plan.comparison.grid

    @grid.setter
    def grid(self, grid: Grid) -> None:
        self.plan.comparison = replace(self.plan.comparison, grid=grid)

    @property
    def origin(self) -> dict[str, str]:
        """What a library depends on, by name (library_origin.py)."""
        model, stated = self.plan.model, self.plan.model.instrument.stated
        origin = model.texts | {f"measurement.{name}": shortest(value) for name, value in vars(stated).items()}
        if self.plan.drawn:
            origin |= {DRAWN + key: text for key, text in model.scene._texts.items() if key.startswith("packing.") and key != "packing.seed"}
        if alone := self.plan.comparison.material.grains_alone:
            origin |= {"grains without contact forces": "contacts are listed" if alone.listed else "contacts by overlap"}
        return origin | {
            "mean diameter": shortest(model.mean_diameter), "grains": str(len(self.plan.packings[0].starts[0])),
            "kernels": engine.kernels_digest(), "observables": hashlib.sha256("".join(f"{one.name};" for one in observables()).encode()).hexdigest(),
            "program": engine.__version__.partition(" ")[0]}  # only the version; a commit need not change results

    def observed(self) -> Floats:
        """(experiments, bins)"""
        comparison = self.plan.comparison
        return np.array([observe(with_listed_contacts(one), comparison.grid, comparison.material, comparison.discard)
                         for one in self.plan.experiments])

    def library(self, progress: Progress | None = None) -> Floats:
        """The baseline, packing after packing; then for each probe and each of its two amplitudes the paired rows of the baseline again."""
        return self._observe_probes(self.plan.library(), progress)

    def baseline(self, progress: Progress | None = None) -> Floats:
        return self._observe_probes(self.plan.baseline(), progress)

    def finer_baseline(self, progress: Progress | None = None) -> Floats:
        """With half the error of positions."""
        return self._observer().observe(self.plan.baseline(finer=0.5), progress)

    def fitted(self, fits: Sequence[Amplitudes], runs: int, protocol: int | None = None, progress: Progress | None = None) -> Floats:
        """`runs` of every packing with each of the fits, with the protocol of other_protocols() if given."""
        other = None if protocol is None else self._protocols[protocol]

        def changed(fit: Amplitudes) -> Callable[[Model, float], Model]:
            return lambda model, _: other.change(self._with(model, fit)) if other else self._with(model, fit)

        trials = [trial for fit in fits for trial in self.plan.baseline(changed(fit), runs)]
        return self._observer(other.grid if other else None).observe(trials, progress)

    def record(self, fit: Amplitudes, runs: int, progress: Progress | None = None) -> None:
        """Stores recordings of the first `runs` of the baseline, or of a fit."""
        self._observer().observe(self._recorded(fit, runs), progress)

    def recordings(self, fit: Amplitudes, before: int, after: int) -> tuple[Recording, list[Recording], list[Recording]]:
        """Of the experiment, and those that `record` has stored of the scene and of the scene with the fit."""
        observer = self._observer()
        return (self.plan.experiments[0].recording, observer.recordings(self._recorded([], before)),
                observer.recordings(self._recorded(fit, after)))

    def setting(self, effect: str) -> Change:
        """Of a numerical effect: the key that it lowers, of several together the one to recommend, with its present value twice."""
        key = self._settings_of(effect)[0]
        value = self.plan.model[key]
        return key, engine.key_unit(key), value, value

    def refine(self, effect: str, factor: float) -> None:
        """Multiplies the settings of a numerical effect."""
        self._change(lambda model: model.with_keys({key: factor * model[key] for key in self._settings_of(effect)}))

    def neglected_motion(self, max_slowdown: float) -> list[Change]:
        """The plate's motion that the experiment states and the scene has not."""
        return neglected_motion(self.plan.model, self.plan.experiments[0], max_slowdown)

    def follow_motion(self, max_slowdown: float) -> None:
        motion = {key: to for key, _, _, to in self.neglected_motion(max_slowdown)}
        if motion:
            pauses = {"protocol.stop_at_scans": True} if motion.get("protocol.pause", self.plan.model["protocol.pause"]) > 0 else {}
            self._change(lambda model: model.with_keys({**motion, **pauses}))

    def other_protocols(self, slower: bool) -> list[str]:
        """What other protocols would tell effects apart, by runs of `fitted`; none if the scene has a programme.

        A hold at full stroke and one more cycle, and for effects that depend on the rate a slower plate.
        """
        model = self.plan.model
        if model.has_programme:
            return []
        held = TIMES_HELD * model["effects.relaxation_time"]
        self._protocols = [
            OtherProtocol(f"hold the plate at full stroke for {held:g} s", lambda one: _with_hold(one, held), _grid_with_hold(self.grid, model)),
            OtherProtocol("press one more cycle", lambda one: one.with_keys({"protocol.cycles": one["protocol.cycles"] + 1}))]
        if slower:
            keys = "plate.speed", "protocol.rate_tolerance"
            self._protocols.append(OtherProtocol(f"press {TIMES_SLOWER} times slower",
                                                 lambda one: one.with_keys({key: one[key] / TIMES_SLOWER for key in keys})))
        return [protocol.what for protocol in self._protocols]

    def changed_keys(self, amplitudes: Amplitudes) -> list[str]:
        """ "contact.gamma = 1.16" for every key of the scene that these amplitudes change."""
        before, after = self.plan.model.scene._texts, self._with(self.plan.model, amplitudes).scene._texts
        return [f"{key} = {_short(text)}" for key, text in after.items() if before.get(key) != text and not key.startswith("programme.")]

    # Parts of the library's simulations, for several processes

    def count_parts(self) -> int:
        return len(self._all_parts())

    def missing_parts(self, device: str) -> list[int]:
        """Those that the store does not have of the device with this description; all of them if it is empty."""
        observer = Observer(device, self._store, self.plan.comparison)
        return [k for k, part in enumerate(self._all_parts()) if not device or not observer.has(part)]

    def compute_part(self, part: int, progress: Progress | None = None) -> None:
        self._observer().observe(self._all_parts()[part], progress)

    def _all_parts(self) -> list[list[Trial]]:
        if self._parts is None:
            trials = self.plan.library()
            self._parts = parts_of(_with_recordings(trials) if self.plan.recordings else trials)
        return self._parts

    def _observer(self, grid: Grid | None = None) -> Observer:
        comparison = replace(self.plan.comparison, grid=grid, discard=0) if grid else self.plan.comparison
        return Observer(self.device, self._store, comparison, self._device)

    def _observe_probes(self, trials: list[Trial], progress: Progress | None) -> Floats:
        def failed(trial: int, cause: str) -> None:
            self.causes_of_failure.setdefault(self.plan.probe_of(trial), cause)

        return self._observer().observe(trials, progress, failed)

    def _with(self, model: Model, amplitudes: Amplitudes) -> Model:
        known = {one.name: one.apply for one in self.plan.nuisances} | {one.name: one.apply for one in EFFECTS}
        for name, amplitude in amplitudes:
            if name not in known:
                raise InputError(f"{name}: is neither an effect nor an uncertain parameter")
            model = known[name](model, amplitude)
        return model

    def _recorded(self, fit: Amplitudes, runs: int) -> list[Trial]:
        return _with_recordings(self.plan.baseline(lambda model, _: self._with(model, fit), max(1, runs)))[:max(0, min(runs, RECORDED))]

    def _settings_of(self, effect: str) -> list[str]:
        found = find_effect(effect)
        assert found and found.settings
        return found.settings(self.plan.model)

    def _change(self, change: Callable[[Model], Model]) -> None:
        self.plan.packings = [replace(packing, model=change(packing.model)) for packing in self.plan.packings]


def _with_recordings(trials: list[Trial]) -> list[Trial]:
    """The same; recordings of the first ones are stored."""
    return [replace(trial, recorded=True) for trial in trials[:RECORDED]] + trials[RECORDED:]


def _with_hold(model: Model, time: float) -> Model:
    """One stroke down and up as a programme, with a hold and a scan at its end between them."""
    scans = str(model["protocol.scans_per_stroke"])
    stages = [{"stage": "move", "position": shortest(model["plate.end"]), "scans": scans},
              {"stage": "hold", "time": shortest(time), "scans": "1"},
              {"stage": "move", "position": shortest(model["plate.start"]), "scans": scans}]
    programme = {f"programme.{number}.{key}": text for number, stage in enumerate(stages, 1) for key, text in stage.items()}
    held = model.with_keys({"protocol.scan_at_start": True})
    return replace(held, base=held.scene._with_programme(programme), changes={})


def _grid_with_hold(grid: Grid, model: Model) -> Grid:
    begin = model["protocol.scans_per_stroke"]  # scan 0 is before the stroke
    return replace(grid, holds=[HoldScans(begin, begin + 1, begin + 1, "position", Phase.load, grid.stroke)])


def _short(text: str) -> str:
    number = to_number(text)
    return text if number is None else f"{number:.3g}"
