"""Findings from which decisions are tested. decision_cases.py"""
from dataclasses import replace

from mcdem.diagnosis.decision import Findings, Proposal


def proposal(candidates, gain, misfit_p, reduction=0.96):
    """A gap reduction of nearly the whole gap."""
    return Proposal(list(candidates), [1.0] * len(candidates), [0.1] * len(candidates), gain, misfit_p, reduction=reduction)


def clear_case(proposals=None, first=None, **others):
    """Four effects, a nuisance beyond its prior, and a clear gap that the second effect explains. `first`: changes of the first
    proposal; `others`: of the findings."""
    known = [proposal([1], 50, 0.5), proposal([4], 20, 1e-6, 0.3)] if proposals is None else proposals
    if first:
        known[0] = replace(known[0], **first)
    made = Findings(1e-4, ["adhesion", "friction", "plasticity", "plate_tilt", "modulus"], 4, [10, 50, 2, 0, 20], known, placebo=0.1)
    return replace(made, **others)
