"""From evidence to diagnosis: detection limits, existence and location of the gap, effects, and gap reduction."""
from dataclasses import dataclass, replace
from math import hypot

from ..errors import InputError
from ..results.recording import Floats
from .causes import FAR_OUT, Causes, nuisance_fits
from .decision import Decision, Findings, Limits, Proposal, contenders, decide, explanation_of
from .detection_limits import detection_limits
from .diagnosis_types import Diagnosis, Explanation, Gap, GapReduction, NuisanceFit, Verdict, millimetres
from .effects import is_numerical
from .evidence import Evidence, GapData, gap_data
from .gap_reduction import FITTED_PART, HeldOutTest, PartialFit, fit_part, refit_part, stepped, whole_placebo
from .gap_space import BinChoice, without
from .gap_tests import NullDistribution, gap_statistics
from .location import locate
from .next_steps import ProtocolRuns, next_measurements, power_of_protocol
from .not_measured import not_measured
from ..observe.grid import bins_of
from ..observe.observation import MIN_BINS
from .packings import packing_agreements
from .proposals import confirm, propose, whole_runs
from .rearrangements import PlaceLeftOut, p_of_gap, p_without_one_place, places_left_out, without_place

WORTH_ANOTHER_RUN = 0.01  # another run is worthwhile if the p of the remainder is smaller
UNNOTICED = 4  # gain in log likelihood that also occurs by chance


@dataclass(frozen=True, eq=False)
class _Runs:
    """The runs of a proposal that explain most, and their parameters."""

    fit: PartialFit
    mean: Floats  # (all bins,)
    count: int


@dataclass
class _Tried:
    """How far a proposal was tried."""

    whole: PartialFit  # its parameters, fitted to all data
    step: Floats | None = None  # next step of nuisances, then amplitudes; None: no run finished
    runs: _Runs | None = None
    held_out_done: bool = False


def _checked_data(evidence: Evidence) -> GapData:
    data = gap_data(evidence)
    if len(data.bins) < MIN_BINS:
        raise InputError(f"the experiment and the simulations have {len(data.bins)} observations in common, and {MIN_BINS} are needed: "
                         "the plate must press the packing within its stroke in both")
    return data


class DiagnosisBuilder:
    """Builds a diagnosis step by step. Real runs of the proposals are optional; inference.py makes the steps in their order.

        builder = DiagnosisBuilder(evidence, limits)
        builder.confirm(k, runs of builder.whole_fit(k))  # for every proposal k
        while builder.refit(k): builder.confirm(..)  # again with corrected parameters
        while (k := builder.wants_held_out()) is not None: builder.confirm_held_out(k, runs of builder.part_fit(k))
        builder.diagnosis()

    Raises InputError if observation and library have too few common bins.
    """

    def __init__(self, evidence: Evidence, limits: Limits) -> None:
        self._evidence, self._limits = evidence, replace(limits, names_alone=not evidence.library.is_drawn)
        self.data = data = _checked_data(evidence)
        self._space = data.space()
        self._null = NullDistribution(data, evidence.seed)
        self._statistics = gap_statistics(self._space, data, data.gap)
        self._test = HeldOutTest.split(data, evidence.library.grid)
        self._places: list[PlaceLeftOut] = []  # if there is a gap
        names = [data.name(c) for c in range(len(data.candidates))]
        self.findings = Findings(p_value=self._p_of_gap(), names=names, effects=data.effects,
                                 gain=[fit.score for fit in self._statistics.fits],
                                 proposals=propose(self._space, data, self._null, self._statistics),
                                 numerics=[c for c in range(data.effects) if is_numerical(names[c])])
        self._tried = [_Tried(self._first_fit(proposal)) for proposal in self.findings.proposals]
        self._measure_reductions()
        self.decision: Decision = decide(self.findings, self._limits)

    def _p_of_gap(self) -> float:
        """Packings that are drawn rearrange in all ways, so no place is left out with them."""
        p = p_of_gap(self._null, self._statistics)
        if p >= self._limits.false_alarm or self._evidence.library.is_drawn:
            return p
        self._places = places_left_out(self.data, self._evidence.seed)
        return max(p, p_without_one_place(self._places))

    def _first_fit(self, proposal: Proposal) -> PartialFit:
        space = self._space.lacking(self.data.lacking(proposal.candidates))
        nuisances = space.fit_nuisances(self.data.gap - self.data.explained(proposal.candidates, proposal.amplitudes))
        return PartialFit(proposal.amplitudes, self.data.in_range(nuisances))

    def _measure_reductions(self) -> None:
        """Computes the reductions of all proposals and of a placebo from signatures."""
        findings, data, seed = self.findings, self.data, self._evidence.seed
        held_out = self._test.gap()
        findings.held_out = held_out.shows()
        findings.held_out_noise = held_out.noise / held_out.size if findings.held_out else 0
        # Gain in log likelihood if the whole gap were explained.
        self._excess = max(self._statistics.directed, 0.5 * (self._statistics.omnibus - self._null.mean("omnibus")))
        if not self._excess > 0:
            return
        findings.placebo = (self._test.placebo(seed) if findings.held_out
                            else whole_placebo(self._space, data, self._excess, seed))
        for proposal in findings.proposals:
            proposal.reduction = (self._likelihood_reduction(proposal.gain) if self._by_likelihood(proposal)
                                  else self._test.reduction(proposal.candidates))

    def _by_likelihood(self, proposal: Proposal) -> bool:
        """Whether the reduction is measured by likelihood: nuisances refitted within their priors leave no gap to measure otherwise."""
        return not self.findings.held_out or any(map(self.findings.is_nuisance, proposal.candidates))

    def _likelihood_reduction(self, gain: float) -> float:
        return min(max(gain / self._excess, -1.0), 1.0)

    def whole_fit(self, proposal: int) -> PartialFit:
        """Parameters of a proposal fitted to all data; after refit() corrected by the last runs."""
        return self._tried[proposal].whole

    def confirm(self, proposal: int, runs: Floats) -> None:
        """Adds real runs with whole_fit(). (replicates, all bins)"""
        state, known = self._tried[proposal], self.findings.proposals[proposal]
        fit, data = state.whole, self.data
        tried = replace(known, amplitudes=list(fit.amplitudes))
        state.step = confirm(tried, data, self._null, self._places, self._limits.enough(tried.is_pair()), self._evidence.observed,
                             fit.nuisances, runs)
        if state.step is None:
            return
        # If a signature is curved, its amplitude and that of the runs enclose the true one.
        half = [0.5 * float(step) for step in state.step[len(fit.nuisances):]]
        tried.amplitudes = [amplitude + change for amplitude, change in zip(tried.amplitudes, half)]
        tried.errors = list(map(hypot, tried.errors, half))
        assert tried.confirmed_gain is not None
        if known.confirmed_gain is None or tried.confirmed_gain > known.confirmed_gain:
            if self._by_likelihood(tried):
                tried.confirmed_reduction = self._likelihood_reduction(tried.confirmed_gain)
            self.findings.proposals[proposal] = tried
            whole = whole_runs(runs, without(data.bins, data.lacking(tried.candidates)))
            state.runs = _Runs(fit, whole.mean(axis=0), len(whole))
        self.decision = decide(self.findings, self._limits)

    def _may_gain(self, proposal: int, step: Floats) -> bool:
        """Whether a nuisance that does not lead may still gain according to its runs: it gets every chance before an effect is named."""
        tried = self.findings.proposals[proposal]
        return (not tried.is_pair() and self.findings.is_nuisance(tried.candidates[0]) and self.decision.proposal != proposal
                and bool(abs(step[len(self.whole_fit(proposal).nuisances)]) > tried.errors[0]))

    def refit(self, proposal: int) -> bool:
        """Corrects the parameters of a confirmed proposal by one Gauss-Newton step if its runs leave a gap, or if a nuisance can gain by
        it. Returns False if nothing can be gained."""
        state, tried = self._tried[proposal], self.findings.proposals[proposal]
        before = state.whole
        if state.step is None:  # no run finished: signatures bend, and the amplitude is too large
            state.whole = replace(before, amplitudes=[amplitude / 2 for amplitude in before.amplitudes])
            return tried.confirmed_gain is None
        if tried.best_misfit() >= WORTH_ANOTHER_RUN and not self._may_gain(proposal, state.step):
            return False
        state.whole = stepped(self.data, tried.candidates, before, state.step)
        return list(state.whole.amplitudes) != list(before.amplitudes)

    def _test_of(self, proposal: Proposal) -> HeldOutTest:
        """Without the place that is left out for this proposal."""
        place, test = proposal.left_out, self._test
        if place is None:
            return test
        return HeldOutTest(self.data, *(without_place(bins, place, len(self.data.gap)) for bins in (test.fitted, test.held_out)))

    def wants_held_out(self) -> int | None:
        """The next proposal that needs runs with part_fit(), because the verdict depends on how much of the held-out gap they take
        away."""
        if not self.has_decided():
            return None
        waiting = [*contenders(self.findings, self._limits), self.decided()]
        return next((k for k in waiting if not self._tried[k].held_out_done), None)

    def part_fit(self, proposal: int) -> PartialFit:
        """Parameters fitted to the data that are not held out, from real runs of the proposal if there are any."""
        return self._refit(proposal, self._test.fitted if len(self._test.fitted) else self.data.bins)

    def _refit(self, proposal: int, bins: BinChoice) -> PartialFit:
        candidates, runs = self.findings.proposals[proposal].candidates, self._tried[proposal].runs
        if runs is None:
            return fit_part(self.data, bins, self.data.gap, candidates)
        return refit_part(self.data, bins, self._evidence.observed - runs.mean, candidates, runs.fit, runs.count)

    def confirm_held_out(self, proposal: int, runs: Floats) -> None:
        """Adds real runs with part_fit(). (replicates, all bins)"""
        self._tried[proposal].held_out_done = True
        tried = self.findings.proposals[proposal]
        if not self._by_likelihood(tried):
            tried.confirmed_reduction = self._test_of(tried).reduction_by_runs(self._evidence.observed, runs,
                                                                               self.data.lacking(tried.candidates))
        self.decision = decide(self.findings, self._limits)

    def has_decided(self) -> bool:
        """Whether there is a gap and the verdict refers to a proposal."""
        return self.decision.verdict != Verdict.no_gap and self.decision.proposal >= 0

    def decided(self) -> int:
        return self.decision.proposal

    def refining_factor(self, candidate: int, most: float) -> float:
        """Factor by which a numerical setting must be refined, a power of two or at most `most`, so that the remaining change up to the
        fitted amplitude, from its signature, is not detectable."""
        numerics, fit = self.data.candidates[candidate], self._statistics.fits[candidate]
        largest = fit.amplitude + fit.error
        for proposal in self.findings.proposals:
            if candidate in proposal.candidates and proposal.confirmed_gain is not None:
                place = proposal.candidates.index(candidate)
                largest = proposal.amplitudes[place] + proposal.errors[place]
        largest = min(largest, numerics.high)
        space, factor = self._space.lacking(numerics.lacking), 2.0
        while factor < most:
            left = space.whiten(numerics.signature.at(largest) - numerics.signature.at(min(1 - 1 / factor, largest)))
            if 0.5 * left @ left < UNNOTICED:
                return factor
            factor *= 2
        return most

    def power_of(self, runs: ProtocolRuns) -> float:
        """Power of another protocol to distinguish the leading effect from its rival."""
        return power_of_protocol(runs, self._evidence, self.data, self.findings, self.decision, self._limits)

    def shifts_of(self, proposal: int) -> Floats:
        """Shifts of the nuisances that the explanation of a proposal needs besides its effects. (nuisances,)"""
        fit = self._refit(proposal, self.data.bins) if self._tried[proposal].runs else self.whole_fit(proposal)
        shifts, tried = fit.nuisances.copy(), self.findings.proposals[proposal]
        names = [prior.name for prior in self._evidence.nuisances]
        for candidate, amplitude in zip(tried.candidates, tried.amplitudes):
            if self.findings.is_nuisance(candidate):
                shifts[names.index(self.findings.names[candidate])] += amplitude
        return self.data.in_range(shifts)

    def check_first(self) -> list[NuisanceFit]:
        """Parameters far from what is stated, the farthest first."""
        if self.decision.verdict == Verdict.no_gap:
            return []
        shifts = (self.shifts_of(self.decided()) if self.has_decided()
                  else self.data.in_range(self._space.fit_nuisances(self.data.gap)))
        fits = [replace(fit, shift=float(shift), at_bound=bool(self.data.at_end_of_range(shift, fit.prior)))
                for fit, shift in zip(nuisance_fits(self._evidence, self._space, self.data.gap), shifts)]
        return sorted((fit for fit in fits if abs(fit.sigmas) > FAR_OUT), key=lambda fit: -abs(fit.sigmas))

    def _explanation(self) -> Explanation | None:
        explanation = explanation_of(self.findings, self.decision, self._limits)
        place = self.findings.proposals[self.decided()].left_out
        if explanation is None or place is None:
            return explanation
        bin = bins_of(self._evidence.library.grid)[place]
        return replace(explanation, without=f"{bin.displacement * 1e3:.4g} mm of {bin.phase.name}ing")

    def _reduction(self) -> GapReduction:
        """Of the decided proposal."""
        explaining, margin = self.findings.proposals[self.decided()], self._limits.reduction_margin
        made = self._test_of(explaining).measured(explaining.candidates, self._evidence.seed)
        return replace(made, placebo=self.findings.placebo, interval=(made.interval[0] - margin, min(1.0, made.interval[1] + margin)),
                       fitted_displacement_mm=(0, millimetres(FITTED_PART * self._evidence.library.grid.stroke)),
                       confirmed=None if self._by_likelihood(explaining) else explaining.confirmed_reduction)

    def diagnosis(self) -> Diagnosis:
        """Without what diagnose.py adds: what is not testable, refinements, seconds and provenance."""
        evidence, limits, data, findings, decision = self._evidence, self._limits, self.data, self.findings, self.decision
        null, statistics, grid = self._null, self._statistics, evidence.library.grid
        detected, decided = decision.verdict != Verdict.no_gap, self.has_decided()
        location = locate(self._space, data, null, data.gap, grid, limits)
        causes = Causes(evidence, findings, decision, statistics)
        proposal = findings.proposals[self.decided()] if decided else None
        return Diagnosis(
            verdict=decision.verdict,
            gap=Gap(detected, findings.p_value, null.p_value("omnibus", statistics.omnibus),
                    null.p_value("directed", statistics.directed)),
            where=tuple(location.entries) if detected else (),
            causes=causes.leading() if decided else (),
            explanation=self._explanation() if decided else None,
            shrink=self._reduction() if decided else None,
            detection_limits=tuple(detection_limits(self._space, data, null, evidence, limits)),
            not_measured=tuple(not_measured(evidence.observed, grid)),
            seconds=0,
            where_threshold=location.threshold,
            cells=tuple(location.bins),
            ranking=causes.ranking(),
            nuisances=tuple(nuisance_fits(evidence, self._space, data.gap)),
            check_first=tuple(self.check_first()),
            missing_bins=tuple(data.missing),
            not_testable=(),
            next=tuple(next_measurements(evidence, data, findings, decision, limits)),
            packings=tuple(packing_agreements(evidence, data, null, proposal, limits)),
            provenance={})
