"""Agreement between several packings of an experiment: distinguishes scatter between packings from an effect."""
from math import sqrt

from ..results.recording import Floats
from .decision import Limits, Proposal
from .diagnosis_types import PackingAgreement
from .effect_fit import fit_effect
from .evidence import Evidence, GapData, PackingEvidence
from .gap_space import FreeParameter, GapSpace
from .gap_tests import NullDistribution
from .proposals import signature_variance


def _own_parameters(evidence: Evidence, data: GapData, scale: float) -> list[FreeParameter]:
    """The only parameter that can differ between packings: the zero of strain. All others belong to the material."""
    return [FreeParameter(free.direction, scale * free.sigma)
            for free, nuisance in zip(data.free, evidence.nuisances) if nuisance.name == "strain_offset"]


def packing_agreements(evidence: Evidence, data: GapData, null: NullDistribution, decided: Proposal | None,
                       limits: Limits) -> list[PackingAgreement]:
    """One entry per packing of the evidence; none for a single packing. `decided`: the proposal of the verdict; the amplitude of its
    first effect is estimated for each packing."""
    count = evidence.packing_count()
    if count < 2:
        return []
    noise = sqrt(count) * data.noise  # for one packing
    apart = sqrt(1 - 1 / count)  # for the difference between one packing and the mean of all
    alone = data.space(noise=noise)
    extra = apart**2 * signature_variance(data, decided) if decided else None  # effects vary slightly between packings
    differences = data.space(free=_own_parameters(evidence, data, apart), noise=apart * noise, extra=extra)

    def p_of(space: GapSpace, gap: Floats) -> float:
        white = space.whiten(gap)
        return null.p_value("omnibus", float(white @ white))

    def agreement(packing: PackingEvidence) -> PackingAgreement:
        gap = packing.gap()
        p = p_of(differences, gap - data.gap)
        fit = fit_effect(alone, data.candidates[decided.candidates[0]], gap) if decided else None
        return PackingAgreement(experiment=packing.name, gap_p=p_of(alone, gap), agreement_p=p, differs=p < limits.false_alarm / count,
                                amplitude=fit.amplitude if fit else 0, amplitude_error=fit.error if fit else 0)

    return [agreement(packing) for packing in evidence.packings]
