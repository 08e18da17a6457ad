"""Diagnoses without a part of the method, and simpler methods, to measure the value of each part."""
import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..diagnosis.builder import DiagnosisBuilder
from ..diagnosis.decision import Findings, Limits
from ..diagnosis.diagnosis_types import Verdict
from ..diagnosis.effect_fit import fit_effect
from ..diagnosis.evidence import MAX_FOLDS, Evidence, GapData, gap_data
from ..diagnosis.gap_space import GapSpace
from ..observe.grid import bins_of
from ..observe.observables import observables
from ..errors import InputError
from .merits import Answer


@dataclass(frozen=True)
class Ablation:
    """The method with modified evidence, without confirming runs."""
    name: str
    meaning: str
    changed: Callable[[Evidence], Evidence]


@dataclass(frozen=True)
class SimplerMethod:
    """Another method on the same evidence."""
    name: str
    meaning: str
    answer: Callable[[Evidence], Answer]


def _observing_only(evidence: Evidence, *needs: str) -> Evidence:
    """Without the observations in the bins of other observables."""
    wanted = [observables()[bin.observable].needs in needs for bin in bins_of(evidence.library.grid)]
    return replace(evidence, observed=np.where(wanted, evidence.observed, np.nan))


def _without_pairing(evidence: Evidence) -> Evidence:
    """Uses the mean over the library's packings instead of the experiment's own packing, and their scatter instead of that of
    replicates."""
    library = evidence.library
    packing = np.array(library.packing)
    replicates = np.bincount(packing)
    baseline = np.zeros((len(replicates), library.baseline.shape[1]))
    np.add.at(baseline, packing, library.baseline / replicates[packing][:, None])
    # Every replicate represents a packing of its own; those of one packing stay in one fold.
    step = -(-len(replicates) // MAX_FOLDS) * MAX_FOLDS
    apart = [p + step * library.packing[:r].count(p) for r, p in enumerate(library.packing)]
    return replace(evidence, baseline=baseline, library=replace(library, packing=apart),
                   library_is_own=True)  # the baseline is not of the experiment's packing


def _best_effect(space: GapSpace, data: GapData) -> tuple[str, float, float]:
    """The effect with the largest gain in `space`, this gain, and its share of exp(gain)."""
    gains = [fit_effect(space, candidate, data.gap).score for candidate in data.candidates[:data.effects]]
    best = max(gains, default=0.0)
    names = [data.name(c) for c, gain in enumerate(gains) if gain == best]
    return (names or [""])[-1], best, 1 / sum(math.exp(gain - best) for gain in gains) if gains else 0.0


def _smallest_residual(evidence: Evidence) -> Answer:
    """Least squares in units of the scatter of each bin, without covariance and nuisances; always names an effect."""
    data = gap_data(evidence)
    count, rows = len(data.bins), len(data.noise)
    independent = np.zeros((count, data.noise.shape[1]))
    independent[np.arange(count), data.bins] = np.linalg.norm(data.noise[:, data.bins], axis=0) * math.sqrt(count / rows)
    return Answer(Verdict.effect, (_best_effect(GapSpace(independent, 0, data.bins, []), data)[0],), 1)


def _bayesian_information(evidence: Evidence) -> Answer:
    """Schwarz 1978: an effect is accepted if it justifies its parameter; the method cannot abstain."""
    data = gap_data(evidence)
    name, gain, confidence = _best_effect(GapSpace(data.noise, len(evidence.baseline), data.bins, data.free), data)
    return Answer(Verdict.effect, (name,), confidence) if 2 * gain > math.log(max(1, len(data.bins))) else Answer()


ABLATIONS = (
    Ablation("without confirming runs", "signatures alone", lambda evidence: evidence),
    Ablation("without conditional observables", "nothing that needs positions",
             lambda evidence: _observing_only(evidence, "plate", "programme", "contacts")),
    Ablation("without pairing", "the mean over other packings for runs of the experiment's own", _without_pairing),
    Ablation("without nuisances", "modulus and strain zero treated as exact", lambda evidence: replace(evidence, nuisances=[])),
    Ablation("top force alone", "one curve", lambda evidence: _observing_only(evidence, "plate", "programme")),
)
SIMPLER_METHODS = (
    SimplerMethod("RMSE ranking", "the effect with the smallest residual", _smallest_residual),
    SimplerMethod("BIC", "the best effect, where its information criterion beats that of none", _bayesian_information),
)


def ablated_findings(evidence: Evidence, ablation: Ablation) -> Findings:
    """Findings of the modified evidence; no candidates if it is not sufficient for a diagnosis."""
    try:
        return DiagnosisBuilder(ablation.changed(evidence), Limits()).findings
    except InputError:
        return Findings()
