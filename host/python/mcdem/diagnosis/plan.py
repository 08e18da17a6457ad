"""What a diagnosis simulates and compares: the packings of an experiment, or others of the same kind if their grains were not measured."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import _engine as engine
from ..errors import InputError
from ..experiment.experiment import Experiment
from ..experiment.instrument import Instrument
from ..experiment.sample import part_of
from ..observe.contact_residuals import GrainsAlone
from ..observe.grid import Grid, grid_of
from ..results.names import Phase
from ..results.parameters import has_programme
from .effects import EFFECTS, Apply, Effect, Nuisance, find_effect, nuisances
from .model import Model
from .trials import Comparison, Trial

ALIKE_STROKES = 0.1  # relative, of packings and a library that are compared; the diagnosis finds a shifted zero of strain
BEGUN = 0.02  # over the stroke: a scan before it is not one of its levels, even if the plate's zero is slightly wrong
APART = 0x6C696272617279  # seeds of other packings are not those of any experiment, but for an improbable coincidence
SEEDS_OF_A_PACKING = 1000  # apart from those of the next one
SEEDS = 2**64  # seeds beyond begin again
# Where nothing is stated because nothing was measured: what a tomograph and forces from it would have, for the power of measuring them.
ASSUMED_POSITION_ERROR = 0.005  # over the mean diameter
ASSUMED_FORCE_ERROR = 0.05

Note = Callable[[str], object]


@dataclass(frozen=True)
class Probe:
    """An effect or nuisance that is simulated at two amplitudes."""

    name: str
    amplitudes: tuple[float, float]
    apply: Apply


@dataclass(frozen=True, eq=False)
class Packing:
    """One that was measured, and from which simulations start."""

    model: Model
    # Its grains; if they were not measured, those of another packing of the same kind for each replicate: the scatter of packings is then
    # that of the replicates.
    starts: Sequence[engine.Packing]


@dataclass(eq=False)
class Plan:
    experiments: list[Experiment]  # with the cycles that are compared
    packings: list[Packing]
    comparison: Comparison
    candidates: list[Effect]
    hindered: list[str]  # "friction_history: the scene has no friction"
    nuisances: list[Nuisance]
    replicates: int  # of the baseline, on every packing
    pairs: int  # .. that are repeated with every effect and nuisance
    seed: int
    recordings: bool = False  # whether a library keeps those of its first trials, for the metrics of the paper
    drawn: bool = False  # whether the packings are others of the same kind, because the grains were not measured

    @property
    def model(self) -> Model:
        return self.packings[0].model

    def probes(self) -> list[Probe]:
        """The candidates, then the nuisances on both sides of the model, so that their slope there is accurate. Amplitudes use the scale of
        the first packing."""
        found = []
        for effect in self.candidates:
            scale = effect.scale(self.model)
            found.append(Probe(effect.name, (effect.first * scale, effect.second * scale), effect.apply))
        return found + [Probe(one.name, (-one.sigma, one.sigma), one.apply) for one in self.nuisances]

    def paired_rows(self) -> list[int]:
        """Rows of the baseline that are repeated with every probe."""
        return [row for row in range(len(self.packings) * self.replicates) if row % self.replicates < self.pairs]

    def baseline(self, change: Apply | None = None, replicates: int | None = None, finer: float = 1.0) -> list[Trial]:
        """The trials of a baseline, one packing after the other. Replicate r of packing p has the same seed in every library and diagnosis.

        `change`: of the model, with amplitude 1. `finer`: factor of the errors of positions.
        """
        trials, measurement = [], self.experiments[0].measurement
        for p, packing in enumerate(self.packings):
            changed = change(packing.model, 1.0) if change else packing.model
            if finer != 1:
                stated = changed.instrument.stated
                changed = changed.read_with(stated=replace(stated, position_error=finer * stated.position_error))
            trials += [Trial(changed, packing.starts[r % len(packing.starts)], finer * measurement.position_error, measurement.diameter_error,
                             (self.seed + SEEDS_OF_A_PACKING * p + r) % SEEDS)
                       for r in range(self.replicates if replicates is None else replicates)]
        return trials

    def library(self) -> list[Trial]:
        """The baseline; then for each probe and each of its two amplitudes its paired rows again."""
        trials = self.baseline()
        for probe in self.probes():
            for amplitude in probe.amplitudes:
                changed = {id(packing.model): probe.apply(packing.model, amplitude) for packing in self.packings}
                trials += [replace(trials[row], model=changed[id(trials[row].model)]) for row in self.paired_rows()]
        return trials

    def probe_of(self, trial: int) -> str:
        """The effect or nuisance of a trial of the library; empty for the baseline."""
        baseline = len(self.packings) * self.replicates
        return self.probes()[(trial - baseline) // (2 * len(self.paired_rows()))].name if trial >= baseline else ""


def plan_of(scene: engine.Scene, measured: Sequence[Experiment], candidates: Sequence[str], replicates: int, pairs: int, seed: int,
            recordings: bool, note: Note) -> Plan:
    """Simulations of the experiments' own packings. Raises InputError if an experiment has too few data, or the packings of one experiment are
    not measured in the same way."""
    engine.expect_plate(scene, "a diagnosis")
    if len(scene) > 1:
        note(f"the scene has {len(scene)} replicas; the first one is diagnosed: {scene.labels[0]}")
    experiments = [_compared_cycles(scene, part_of(one, scene)) for one in measured]
    for one in measured:
        if one.sample is not None:
            note(f"{one.name}: its [sample] is compared with a part of {scene._values['plate.start']:.4g} m height: equal strains and stresses")
    for one in experiments:
        if not len(one.recording.scans):
            raise InputError(f"{one.name}: cycles in plate.csv must count from 0, got none below protocol.cycles")
    _note_cycles(measured[0], experiments[0], note)
    grid = min((grid_of(one.recording) for one in experiments), key=lambda one: one.stroke)
    _expect_alike(experiments, grid)
    if experiments[0].recording.has_start:
        packings = [Packing(_model_of(scene, one), [_start_of(one)]) for one in experiments]
    else:
        note(f"{measured[0].name}: grains.csv has no positions of frame 0: packings are drawn as the scene generates them, and their scatter is "
             "the noise")
        packings = [_drawn(scene, one, replicates, seed, p) for p, one in enumerate(experiments)]
    return _filled(experiments, packings, grid, candidates, replicates, pairs, seed, recordings)


def plan_of_others(scene: engine.Scene, measured: Experiment, packings: int, candidates: Sequence[str], replicates: int, pairs: int,
                   seed: int) -> Plan:
    """Simulations of `packings` others of the same kind, for a library that several experiments share."""
    engine.expect_plain_strokes(scene, "a challenge")
    experiment = _compared_cycles(scene, part_of(measured, scene))
    if not experiment.recording.has_start:
        drawn = _drawn(scene, experiment, packings * replicates, seed, 0)
        return _filled([experiment], [drawn], grid_of(experiment.recording), candidates, packings * replicates, packings * pairs, seed, False)
    plate = {key: scene._values[key] for key in ("plate.start", "plate.end")}
    model = _model_of(scene, experiment).with_keys(plate)
    made = [Packing(model, [start]) for start in engine.make_packings(model.scene, _seeds(seed, packings))]
    # The grid has the plate positions of the scene, from which the experiment's zero of strain differs.
    grid = grid_of(experiment.recording)
    factor = (plate["plate.start"] - plate["plate.end"]) / grid.stroke
    grid = replace(grid, displacement=[factor * one for one in grid.displacement], width=factor * grid.width, stroke=factor * grid.stroke)
    return _filled([experiment], made, grid, candidates, replicates, pairs, seed, False)


def _seeds(seed: int, packings: int, first: int = 0) -> list[int]:
    """Of packings that are drawn, from number `first` on."""
    return [engine.derived_seed((seed + APART) % SEEDS, first + p) for p in range(packings)]


def _filled(experiments: list[Experiment], packings: list[Packing], grid: Grid, candidates: Sequence[str], replicates: int,
            pairs: int, seed: int, recordings: bool) -> Plan:
    model = packings[0].model
    chosen, hindered = _choice(model, candidates)
    comparison = Comparison(grid, replace(model.material(), grains_alone=_grains_alone(experiments)), model["protocol.discard"])
    drawn = not experiments[0].recording.has_start
    uncertain = nuisances(model, experiments[0].uncertainty, not drawn)
    return Plan(experiments, packings, comparison, chosen, hindered, uncertain, replicates, min(pairs, replicates), seed, recordings, drawn)


def _grains_alone(experiments: Sequence[Experiment]) -> GrainsAlone | None:
    """Grains touch from one standard error of their overlap."""
    errors = experiments[0].measurement
    if not all(one.has_grains_alone for one in experiments):
        return None
    return GrainsAlone(math.sqrt(2 * errors.position_error**2 + 0.5 * errors.diameter_error**2), all(len(one.topology) for one in experiments))


def _choice(model: Model, wanted: Sequence[str]) -> tuple[list[Effect], list[str]]:
    """The effects in `wanted` (none: all) that this model can have; the others with reasons. Raises InputError."""
    if unknown := [name for name in wanted if not find_effect(name)]:
        known = ", ".join(effect.name for effect in EFFECTS)
        raise InputError([f"--candidates: {name} is not an effect; there are {known}" for name in unknown])
    found = [find_effect(name) for name in wanted] or list(EFFECTS)
    effects = [effect for effect in found if effect]
    hindrances = [effect.hindrance(model) for effect in effects]
    hindered = [f"{effect.name}: {why}" for effect, why in zip(effects, hindrances) if why]
    chosen = [effect for effect, why in zip(effects, hindrances) if not why]
    if not chosen:
        raise InputError(f"--candidates: must name an effect that can be tested, got {'; '.join(hindered)}")
    return chosen, hindered


# What a diagnosis takes from an experiment

def _simulated_cycles(scene: engine.Scene) -> int:
    values = scene._values
    return int(max(values["protocol.cycles"], values["protocol.discard"] + 1))


def _compared_cycles(scene: engine.Scene, experiment: Experiment) -> Experiment:
    """Without cycles that the scene does not have (at least one that is not discarded): grains move within a cycle, so that later ones differ.
    A programme is compared as a whole."""
    recording = experiment.recording
    if recording.has_programme:
        return experiment
    kept = recording.scans.chosen(recording.scans.cycle < _simulated_cycles(scene))
    return replace(experiment, recording=replace(recording, scans=kept))


def _note_cycles(measured: Experiment, compared: Experiment, note: Note) -> None:
    cycles, some = (int(one.recording.scans.cycle[-1]) + 1 for one in (measured, compared))
    if cycles != some:
        note(f"{measured.name}: only the first {'cycle is' if some == 1 else f'{some} cycles are'} compared, of {cycles}; protocol.cycles in "
             "the scene is the number of cycles to simulate")


def _expect_alike(experiments: Sequence[Experiment], grid: Grid) -> None:
    """Raises InputError unless the packings of one experiment are compressed and measured in the same way."""
    first, problems = experiments[0], []
    for other in experiments:
        if other.recording.has_start != first.recording.has_start:
            problems.append(f"{other.name}: must have the positions of frame 0, or not, as {first.name}, to be diagnosed with it")
        if (other.measurement, other.uncertainty) != (first.measurement, first.uncertainty):
            problems.append(f"{other.name}: experiment.toml must state the same [measurement] and [uncertainty] as that of {first.name}, to be "
                            "diagnosed with it")
        if engine.programme_text(other.recording.parameters) != engine.programme_text(first.recording.parameters):
            problems.append(f"{other.name}: experiment.toml must state the same [[programme]] as that of {first.name}, to be diagnosed with it")
        if (stroke := grid_of(other.recording).stroke) > (1 + ALIKE_STROKES) * grid.stroke:
            problems.append(f"{other.name}: its stroke of {1e3 * stroke:.4g} mm must be within a tenth of the shortest, "
                            f"{1e3 * grid.stroke:.4g} mm, to be diagnosed with it")
    if problems:
        raise InputError(problems)


def _start_of(experiment: Experiment) -> engine.Packing:
    """The grains at the experiment's first frame."""
    return engine.Packing(experiment.recording.scans.position[0], experiment.recording.diameter)


def _drawn(scene: engine.Scene, experiment: Experiment, replicates: int, seed: int, number: int) -> Packing:
    """Packings as the scene generates them, for an experiment (with this number) whose grains were not measured. Raises InputError."""
    if scene._values["packing.file"]:
        raise InputError(f"{scene.name}: packing.file must be left out for {experiment.name}, whose grains were not measured: packings are "
                         "generated (packing.count, packing.packing_fraction); or give the experiment the positions of the file (grains.csv)")
    model = _model_of(scene, experiment)
    starts = engine.make_packings(model.scene, _seeds(seed, replicates, SEEDS_OF_A_PACKING * number))
    mean_diameter = float(engine.make_packings(model.scene, [APART])[0].diameter.mean())  # the same for every seed and number of replicates
    stated = model.instrument.stated
    assumed = replace(stated, position_error=stated.position_error or ASSUMED_POSITION_ERROR * mean_diameter)
    return Packing(replace(model, mean_diameter=mean_diameter, instrument=Instrument(assumed)), starts)


def _model_of(scene: engine.Scene, experiment: Experiment) -> Model:
    """The scene's first replica with the experiment's box, plate and scans. Raises InputError if the experiment does not contain enough data
    to simulate it."""
    recording, scans, values = experiment.recording, experiment.recording.scans, scene._values
    if values["container.shape"] != recording.box.shape:
        raise InputError(f"{scene.name}: container.shape must be {recording.box.shape}, as in {experiment.name}: others cannot be diagnosed")
    if has_programme(values) and not recording.has_programme:
        raise InputError(f"{experiment.name}: experiment.toml must state the [[programme]] of the experiment, and plate.csv its time_s, for a "
                         "scene that has one")
    lowest = float(min(recording.plate_start, scans.plate_z.min()))
    begun = BEGUN * (recording.plate_start - lowest)
    loading = int(np.count_nonzero((scans.cycle == 0) & (scans.phase == Phase.load) & (recording.displacement > begun)))
    if not loading or not lowest < recording.plate_start:
        raise InputError(f"{experiment.name}: plate.csv must have loading frames below plate.start")
    changes = {"plate.start": recording.plate_start, "protocol.scan_at_start": True}
    if recording.has_programme:  # under a prescribed force the plate may move as far as the scene allows
        changes["plate.end"] = min(values["plate.end"], lowest)
    else:
        cycles = int(scans.cycle.max()) + 1
        changes |= {"plate.end": lowest, "protocol.scans_per_stroke": loading, "protocol.cycles": min(cycles, _simulated_cycles(scene))}
    box = recording.box
    base = scene._variant(changes)._with_programme(recording.parameters)._with_box(box.shape, box.size_x, box.size_y)
    mean_diameter = float(recording.diameter.mean()) if len(recording.diameter) else math.nan
    stated = experiment.measurement
    if not any(map(len, scans.contacts)):
        stated = replace(stated, force_error=stated.force_error or ASSUMED_FORCE_ERROR)
    return Model(base, {}, Instrument(stated), mean_diameter, experiment.plate_speed)
