"""A diagnosis: simulates the scene with and without effects, infers which of them the experiment has, and asks for the next runs."""
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import _engine as engine
from ..errors import InputError
from ..experiment.experiment import Experiment
from ..look import Path
from ..number_text import shortest
from ..results.recording import Floats
from .change_of_the_scene import Amplitudes, change_of_the_scene, simulate_motion
from .contact_law import contact_laws
from .decision import Findings, Limits
from .diagnosis_types import ContactLaw, Diagnosis, GapReduction, NextStep, Refinement, Verdict
from .effects import depends_on_speed
from .evidence import (CandidateRange, Evidence, NuisancePrior, PackingEvidence, column_means, leave_out_failures, mean_over_packings,
                       take_means)
from .gap_reduction import PartialFit
from .inference import Inference, Runs
from .library import Library, write_library
from .library_origin import expect_alike_loads
from .library_simulations import build_library, fitting_library
from .needed import needed_to_diagnose
from .next_steps import ProtocolRuns, check_of, proposal_of_rival
from .paper_metrics import paper_metrics
from .signature import continued_from
from .simulations import Simulations

MAX_REFINEMENT = 64  # largest factor by which a refinement of a numerical setting is recommended
# Largest factor by which an experiment's plate may be slower than the scene's if its motion is to be simulated. With rate_tolerance the
# scene's plate is mostly slower than its maximum, and the runs take less than this factor longer.
MAX_SLOWDOWN = 20


@dataclass(frozen=True)
class Options:
    candidates: Sequence[str] = ()  # effects; none: all
    replicates: int = 32  # of the unchanged scene on each of the experiment's packings
    pairs: int = 8  # for every effect; at most `replicates`
    confirmations: int = 8  # real runs of each proposal
    # Largest factor by which the simulation's own numerics are refined, once, if they explain the gap; the diagnosis is then repeated.
    # 1: never. Above 1, pauses of the experiment's plate are also simulated if there is a gap.
    refine: float = 4.0
    paper_metrics: bool = True  # Rtop, errf, errZ, bhat before and after
    seed: int = 1
    library: Path | None = None  # read if it exists, otherwise computed and written
    limits: Limits = Limits()


class Listener:
    """What a caller can learn while a diagnosis goes on."""

    def progress(self, stage: str, fraction: float) -> object:
        """Of a stage of simulations."""

    def note(self, text: str) -> object:
        """What is left out or done otherwise, and why."""

    def evidence(self, evidence: Evidence) -> object:
        """When it is complete: limits and ablations can be tried with it without simulations."""

    def findings(self, findings: Findings) -> object:
        """The numbers on which the verdict is based."""


def make_simulations(scene: engine.Scene, experiments: Sequence[Experiment], store: Path, options: Options, device: str = "",
                     listener: Listener | None = None) -> Simulations:
    """The simulations of a diagnosis of one experiment, or of several packings of one; `store`: folder that keeps them.

    Raises InputError if the experiments have too few data or are not alike.
    """
    if problems := [needed for experiment in experiments for needed in needed_to_diagnose(experiment)]:
        raise InputError(problems)
    return Simulations.of(scene, experiments, store, candidates=list(options.candidates), replicates=options.replicates, pairs=options.pairs,
                          seed=options.seed, recordings=options.paper_metrics, device=device, note=(listener or Listener()).note)


def diagnose(scene: engine.Scene, simulations: Simulations, options: Options, listener: Listener | None = None) -> Diagnosis:
    """The diagnosis of the experiments of these simulations. Raises InputError, RunError, KeyboardInterrupt."""
    begin = time.monotonic()
    diagnosis = _Diagnosing(simulations, options, listener or Listener()).run()
    provenance = {"scene": scene.name, "experiment": ", ".join(simulations.facts()["names"]), "program": engine.__version__,
                  "device": simulations.device, "seed": str(options.seed)}
    return replace(diagnosis, seconds=time.monotonic() - begin, provenance=provenance)


class _Diagnosing:
    """The steps of one diagnosis, in order."""

    def __init__(self, simulations: Simulations, options: Options, listener: Listener) -> None:
        self.simulations, self.options, self.listener = simulations, options, listener
        self.facts = simulations.facts()
        self.packings: int = self.facts["packings"]
        self.hindered: list[str] = list(self.facts["hindered"])
        self.refinements: list[Refinement] = []
        self.has_metrics = options.paper_metrics and not self.facts["has_programme"]  # they compare levels of strokes

    def run(self) -> Diagnosis:
        self._tell_what_is_left_out()
        evidence = self._gather()
        inference = self._infer(evidence)
        has_gap = self._verdict(inference) != Verdict.no_gap
        if self.options.refine > 1 and has_gap and (motion := self.simulations.neglected_motion(MAX_SLOWDOWN)):
            self._follow_motion(evidence, motion)
            inference = self._infer(evidence)
        self._confirm(inference)
        if self._verdict(inference) == Verdict.not_converged and self.options.refine > 1:
            self._refine(evidence, self._refinement_of(inference, self.options.refine))
            inference = self._infer(evidence)
            self._confirm(inference)
        if self._verdict(inference) == Verdict.not_converged:
            self.refinements.append(self._refinement_of(inference, MAX_REFINEMENT))
        if not self.facts["drawn"]:
            evidence.finer_baseline = mean_over_packings(self.simulations.finer_baseline(self._stage("half the noise")), self.packings)
        self.listener.evidence(evidence)
        self.listener.findings(inference.builder.findings)
        return self._diagnosis(inference)

    def _infer(self, evidence: Evidence) -> Inference:
        return Inference(evidence, self.options.limits, self.options.confirmations)

    def _confirm(self, inference: Inference) -> None:
        """Real runs of what may explain the gap, until the verdict needs no more."""
        while runs := inference.next_runs():
            inference.add(self._simulated(inference, runs))

    def _simulated(self, inference: Inference, runs: Runs) -> list[Floats]:
        fits = [self._amplitudes(inference, proposal, fit) for proposal, fit in runs.fits]
        if self.has_metrics and runs.purpose == "held-out confirmation":
            self.simulations.record(fits[0], self.options.confirmations, self._stage("recordings"))
        simulated = self._simulate(fits, runs.purpose)
        return [one + self._luck_of_packings(inference.evidence) for one in simulated] if self.facts["drawn"] else simulated

    def _simulate(self, fits: list[Amplitudes], stage: str, protocol: int | None = None) -> list[Floats]:
        """(confirmations, bins) for each fit: means over the packings."""
        rows = self.simulations.fitted(fits, self.options.confirmations, protocol, self._stage(stage))
        each = self.options.confirmations * self.packings
        return [mean_over_packings(rows[k * each:(k + 1) * each], self.packings) for k in range(len(fits))]

    def _luck_of_packings(self, evidence: Evidence) -> Floats:
        """(bins,) Mean of the baseline minus that of the packings that confirm, for packings that are drawn: what the few do not share with all
        is known from the baseline (a control variate)."""
        return column_means(evidence.baseline) - column_means(evidence.baseline[:self.options.confirmations])

    def _amplitudes(self, inference: Inference, proposal: int, fit: PartialFit) -> Amplitudes:
        """Of the effects of a proposal, and of all nuisances."""
        builder = inference.builder
        shifts = {prior.name: float(shift) for prior, shift in zip(inference.evidence.nuisances, fit.nuisances, strict=True)}
        effects = []
        for candidate, amplitude in zip(builder.findings.proposals[proposal].candidates, fit.amplitudes):
            name = builder.data.name(candidate)
            if candidate < builder.data.effects:
                effects.append((name, float(amplitude)))
            else:
                shifts[name] += float(amplitude)
        return [*effects, *shifts.items()]

    @staticmethod
    def _verdict(inference: Inference) -> Verdict:
        return inference.builder.decision.verdict

    def _stage(self, name: str) -> Callable[[float], object]:
        return lambda fraction: self.listener.progress(name, fraction)

    # Evidence

    def _tell_what_is_left_out(self) -> None:
        if others := self.facts["other_materials"]:
            self.listener.note(f"experiment.toml states {', '.join(others)}, but simulations use the values of the scene; change them with "
                               "--set if the experiment is right")
        if self.options.candidates:
            for hindered in self.hindered:
                self.listener.note(f"not tested: {hindered}")

    def _gather(self) -> Evidence:
        library = fitting_library(self.simulations, self.options.library)
        is_own = library is None
        if library is None:
            self._record()
            library = self._new_library()
            baseline = library.baseline
        else:
            self.simulations.grid = library.grid
            # Packings that are drawn are as good for one experiment as for another.
            baseline = np.tile(library.baseline, (self.packings, 1)) if self.facts["drawn"] else self._simulated_baseline("baseline")
        evidence = Evidence(observed=baseline[0], baseline=baseline, library=library,
                            candidates=[CandidateRange(*row) for row in self.facts["candidates"]],
                            nuisances=[NuisancePrior(*row) for row in self.facts["nuisances"]], seed=self.options.seed,
                            library_is_own=is_own)
        self._take_baseline(evidence, baseline)
        if not is_own and self.options.library is not None:
            expect_alike_loads(library, evidence.baseline, self.options.library)
        self._note_failures(evidence)
        return evidence

    def _new_library(self) -> Library:
        library = build_library(self.simulations, self._stage("library"))
        file = self.options.library
        if file is not None and not write_library(file, library):
            self.listener.note(f"{file}: another process wrote this library first; it is kept")
        return library

    def _record(self) -> None:
        """Before simulations of the baseline, because those with complete recordings are not repeated."""
        if self.has_metrics:
            self.simulations.record([], self.options.replicates, self._stage("recordings"))

    def _simulated_baseline(self, stage: str) -> Floats:
        self._record()
        return self.simulations.baseline(self._stage(stage))

    def _take_baseline(self, evidence: Evidence, runs: Floats) -> None:
        """Runs of the unchanged scene (packings x replicates, bins), one packing after the other."""
        if evidence.library_is_own:  # all rows again: what failed before may not fail now
            packing = [row * self.packings // len(runs) for row in range(len(runs))]
            evidence.library = replace(evidence.library, baseline=runs, packing=packing)
        packings = zip(self.facts["names"], self.simulations.observed(), runs.reshape(self.packings, -1, runs.shape[1]), strict=True)
        evidence.packings = [PackingEvidence(name, observed, baseline) for name, observed, baseline in packings]
        take_means(evidence)
        if self.packings == 1:
            evidence.packings = []

    def _note_failures(self, evidence: Evidence) -> None:
        notes = leave_out_failures(evidence, self.simulations.causes_of_failure)
        for note in notes:
            self.listener.note(note)
        self.hindered += notes

    def _follow_motion(self, evidence: Evidence, motion: list[tuple[str, str, float, float]]) -> None:
        """Lets the plate move as that of the experiment. Its speed is then known and no candidate."""
        self.refinements += [Refinement(effect="", key=key, was=was, to=to, unit=unit, done=True) for key, unit, was, to in motion]
        settings = ", ".join(f"{key} = {to:.3g}" for key, _, _, to in motion)
        self.listener.note(f"there is a gap, and experiment.toml states how the plate moves: continuing with that motion ({settings})")
        self.simulations.follow_motion(MAX_SLOWDOWN)
        if len(evidence.candidates) > 1:
            evidence.candidates = [candidate for candidate in evidence.candidates if candidate.name != "plate_speed"]
        self._take_baseline(evidence, self._simulated_baseline("baseline with the experiment's plate"))
        self._note_failures(evidence)

    def _refinement_of(self, inference: Inference, most: float) -> Refinement:
        """Of the leading effect, one of the simulation's own numerics."""
        candidate = inference.builder.decision.group[0]
        effect = inference.builder.findings.names[candidate]
        key, unit, value, _ = self.simulations.setting(effect)
        return Refinement(effect=effect, key=key, was=value, to=value / inference.builder.refining_factor(candidate, most), unit=unit,
                          done=False)

    def _refine(self, evidence: Evidence, refinement: Refinement) -> None:
        """Signatures are differences of paired runs and are kept; the baseline is simulated again."""
        part = refinement.to / refinement.was
        self.simulations.refine(refinement.effect, part)
        self.refinements.append(replace(refinement, done=True))
        self.listener.note("the gap is consistent with a simulation that is not converged: continuing with "
                           f"{refinement.key} = {shortest(refinement.to)} instead of {shortest(refinement.was)}")
        self._take_baseline(evidence, self._simulated_baseline("refined baseline"))
        evidence.library.effects = [continued_from(signature, 1 - part) if signature.name == refinement.effect else signature
                                    for signature in evidence.library.effects]
        self._note_failures(evidence)

    # What follows

    def _diagnosis(self, inference: Inference) -> Diagnosis:
        diagnosis = replace(inference.builder.diagnosis(), not_testable=tuple(self.hindered),
                            refinements=tuple(self.refinements), contact_laws=self._contact_laws(inference))
        steps = list(diagnosis.next)
        if diagnosis.verdict == Verdict.group:
            steps = self._with_other_protocols(inference, steps)
        left = self.simulations.neglected_motion(MAX_REFINEMENT)
        first = [check_of(diagnosis), change_of_the_scene(diagnosis, self.simulations.changed_keys),
                 simulate_motion(left) if left and diagnosis.verdict != Verdict.no_gap else None]
        diagnosis = replace(diagnosis, next=(*(step for step in first if step), *steps))
        if diagnosis.shrink and self.has_metrics and self.options.confirmations > 0:
            diagnosis = replace(diagnosis, shrink=self._with_metrics(diagnosis.shrink, inference))
        return diagnosis

    def _contact_laws(self, inference: Inference) -> tuple[ContactLaw, ...]:
        plan = self.simulations.plan
        return contact_laws(inference.evidence, inference.builder.data, plan.comparison.material, plan.model.mean_diameter)

    def _with_other_protocols(self, inference: Inference, steps: list[NextStep]) -> list[NextStep]:
        """Adds the power of other protocols to tell the leading effect from its rival, predicted by runs of both. The most powerful step
        is first."""
        builder = inference.builder
        rival = proposal_of_rival(builder.findings, builder.decision)
        if rival is None or self.options.confirmations < 2:
            return steps
        proposals = builder.decided(), rival
        names = [builder.data.name(builder.findings.proposals[k].candidates[0]) for k in proposals]
        fits = [self._amplitudes(inference, k, builder.whole_fit(k)) for k in proposals]
        for protocol, what in enumerate(self.simulations.other_protocols(any(map(depends_on_speed, names)))):
            runs = ProtocolRuns(*(self._simulate([fit], "other protocols", protocol)[0] for fit in fits))
            steps.append(NextStep(f"{what}, to distinguish {names[0]} from {names[1]}", builder.power_of(runs)))
        return sorted(steps, key=lambda step: -(step.power or 0))

    def _with_metrics(self, shrink: GapReduction, inference: Inference) -> GapReduction:
        """The metrics of the paper for the first packing, without and with the explanation."""
        builder, confirmations = inference.builder, self.options.confirmations
        fit = self._amplitudes(inference, builder.decided(), builder.part_fit(builder.decided()))
        few = min(self.options.replicates, confirmations)
        self.simulations.record([], few, self._stage("recordings"))
        self.simulations.record(fit, confirmations, self._stage("recordings"))
        experiment, before, after = self.simulations.recordings(fit, few, confirmations)
        metrics = paper_metrics((experiment,), tuple(before), tuple(after))
        return replace(shrink, metrics=metrics.values, top_force=metrics.top_force)
