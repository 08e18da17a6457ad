"""Candidates and parameters as they are in the results of a diagnosis."""
from dataclasses import dataclass

from ..results.recording import Floats
from .decision import Decision, Findings, chosen_proposal
from .diagnosis_types import Cause, NuisanceFit, Verdict
from .evidence import CandidateRange, Evidence
from .gap_space import GapSpace
from .gap_tests import GapStatistics

FAR_OUT = 2.5  # a parameter this far from its stated value, in sigmas of its prior, is outside its uncertainty


def _at_limit(known: CandidateRange | None, amplitude: float, error: float) -> bool:
    return known is not None and bool(known.high > 0 and amplitude + error >= known.high
                                      or known.low < 0 and amplitude - error <= known.low)


@dataclass(frozen=True)
class Causes:
    evidence: Evidence
    findings: Findings
    decision: Decision
    statistics: GapStatistics

    def of(self, candidate: int) -> Cause:
        findings, decision = self.findings, self.decision
        name, fit = findings.names[candidate], self.statistics.fits[candidate]
        amplitude, error = fit.amplitude, fit.error
        group, confirmed_score = [candidate], None
        explaining = [one for one in findings.proposals if one.candidates == [candidate] and one.confirmed_gain is not None]
        if explaining:
            confirmed_score = explaining[0].confirmed_gain
        if decision.verdict != Verdict.no_gap and decision.proposal >= 0:
            chosen = chosen_proposal(findings, decision)
            explaining.append(chosen)  # a named effect has only the amplitude of the explanation
            if not chosen.is_pair() and candidate in decision.group:
                group = decision.group
        for proposal in explaining:
            if candidate in proposal.candidates:
                place = proposal.candidates.index(candidate)
                amplitude, error = proposal.amplitudes[place], proposal.errors[place]
        known = next((one for one in self.evidence.candidates if one.name == name), None)
        unit = known.unit if known else next((one.unit for one in self.evidence.nuisances if one.name == name), "")
        score, omnibus = findings.gain[candidate], self.statistics.omnibus
        return Cause(name, amplitude, unit, decision.confidence[candidate], tuple(findings.names[c] for c in group), error,
                     _at_limit(known, amplitude, error), 2 * score / omnibus if omnibus > 0 else 0, score, confirmed_score)

    def ranking(self) -> tuple[Cause, ...]:
        gain = self.findings.gain
        return tuple(self.of(c) for c in sorted(range(len(gain)), key=lambda c: -gain[c]))

    def leading(self) -> tuple[Cause, ...]:
        """The leading effect and its group, or both effects of a pair."""
        return tuple(map(self.of, self.decision.group))


def nuisance_fits(evidence: Evidence, space: GapSpace, gap: Floats) -> list[NuisanceFit]:
    """In the order of the evidence. `gap`: all bins."""
    values, errors = space.fit_nuisances(gap), space.nuisance_errors()
    return [NuisanceFit(prior.name, float(value), float(error), prior.sigma, prior.unit, bool(abs(value) > FAR_OUT * prior.sigma))
            for prior, value, error in zip(evidence.nuisances, values, errors)]
