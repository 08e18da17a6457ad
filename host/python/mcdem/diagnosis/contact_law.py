"""The law of contacts between grains that the measured forces and positions show, without the name of an effect.

The regression of grain_overlaps (observe/overlap_observables.py) gives the implied minus the measured overlap as a parabola of the implied
one, corrected for the surface displacement by the other contacts. The gap of its coefficients is the difference of overlaps, measured minus
simulated, at equal force; it becomes a difference of forces at equal overlap by Hertz's law.
"""
import numpy as np

from ..observe.contact_residuals import Material, implied_overlap, reduced_modulus
from ..observe.grid import bins_each, bins_of
from ..observe.observables import index_of
from ..results.recording import Floats
from .diagnosis_types import ContactLaw, millimetres
from .evidence import Evidence, GapData

COEFFICIENTS = "overlap_offset", "overlap_slope", "overlap_curvature"
FORCES = 0.25, 2.5  # range of contact forces that is shown, over their mean: most contacts are in it
POINTS = 9
HERTZ = 1.5


def contact_laws(evidence: Evidence, data: GapData, material: Material, mean_diameter: float) -> tuple[ContactLaw, ...]:
    """At every displacement and phase with measured forces and positions. `mean_diameter` [m]"""
    bins = bins_of(evidence.library.grid)
    places = bins_each(len(bins))
    laws = []
    for place in range(places):
        chosen = [index_of(name) * places + place for name in COEFFICIENTS]
        log_force = evidence.observed[index_of("mean_force") * places + place]
        if np.isin(chosen, data.bins).all() and np.isfinite(log_force):
            rows = data.noise[:, chosen]
            covariance = (1 + (1 / data.mean_of if data.mean_of else 0)) * rows.T @ rows / len(rows)
            least, most = implied_overlap(np.exp(log_force) * np.array(FORCES), reduced_modulus(material, False), mean_diameter / 4)
            bin = bins[place]
            laws.append(_law(data.gap[chosen], covariance, np.geomspace(least, most, POINTS), bin.phase.name, millimetres(bin.displacement)))
    return tuple(laws)


def _law(gap: Floats, covariance: Floats, implied: Floats, phase: str, displacement_mm: float) -> ContactLaw:
    """Of the gap of the coefficients (3,) and its covariance (3, 3). ln of the ratio of the forces at equal overlap is 3/2 ln(x/(x - gap)), x the
    implied overlap. Its slope with the logarithm of the overlap is the change of the exponent. Errors to first order in the gap."""
    terms = np.column_stack([np.ones_like(implied), implied, implied**2])
    overlap = np.maximum(implied - terms @ gap, 0.1 * implied)  # a gap as large as the overlap has no law
    ratio = HERTZ * np.log(implied / overlap)
    by_gap = HERTZ * terms / overlap[:, np.newaxis]
    error = np.sqrt(np.einsum("ij,jk,ik->i", by_gap, covariance, by_gap))
    apart = np.log(overlap) - np.log(overlap).mean()
    weights = apart / (apart @ apart)
    slope = weights @ by_gap
    return ContactLaw(phase, displacement_mm, tuple(overlap.tolist()), tuple(np.expm1(ratio).tolist()), tuple((np.exp(ratio) * error).tolist()),
                      HERTZ + float(weights @ ratio), float(np.sqrt(slope @ covariance @ slope)))
