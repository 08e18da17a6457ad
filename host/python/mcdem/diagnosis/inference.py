"""The loop of a diagnosis: which real runs it needs next, and what follows from them.

    while runs := inference.next_runs():
        inference.add(simulate(runs))
    inference.builder.diagnosis()
"""
from collections.abc import Sequence
from dataclasses import dataclass

from ..results.recording import Floats
from .builder import DiagnosisBuilder
from .decision import Limits
from .diagnosis_types import Verdict
from .evidence import Evidence
from .gap_reduction import PartialFit

MAX_ROUNDS = 3  # of real runs of a proposal, including the corrected ones


@dataclass(frozen=True)
class Runs:
    purpose: str  # confirmation or held-out confirmation
    fits: list[tuple[int, PartialFit]]  # proposals and their parameters


class Inference:
    """If there is a gap: real runs of every proposal, repeated with corrections; then of those that the verdict depends on, with the
    parameters fitted to the first part of the data. `confirmations`: replicates of each; 0: none."""

    def __init__(self, evidence: Evidence, limits: Limits, confirmations: int) -> None:
        self.evidence = evidence
        self.builder = DiagnosisBuilder(evidence, limits)
        self._wanted = confirmations > 0 and self.builder.decision.verdict != Verdict.no_gap
        self._tried = list(range(len(self.builder.findings.proposals)))
        self._rounds = 0

    def next_runs(self) -> Runs | None:
        """None if the diagnosis is complete. Without add() it is the same again."""
        if not self._wanted:
            return None
        if self._in_rounds():
            return Runs("confirmation", [(k, self.builder.whole_fit(k)) for k in self._tried])
        k = self.builder.wants_held_out()
        return None if k is None else Runs("held-out confirmation", [(k, self.builder.part_fit(k))])

    def _in_rounds(self) -> bool:
        return self._rounds < MAX_ROUNDS and len(self._tried) > 0

    def add(self, results: Sequence[Floats]) -> None:
        """The runs of next_runs(): (replicates, all bins) for each fit."""
        if not self._in_rounds():
            k = self.builder.wants_held_out()
            assert k is not None
            self.builder.confirm_held_out(k, results[0])
            return
        for k, runs in zip(self._tried, results, strict=True):
            self.builder.confirm(k, runs)
        self._tried = [k for k in self._tried if self.builder.refit(k)]
        self._rounds += 1
