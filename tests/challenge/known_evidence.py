"""Evidence with a known result. known_evidence.py"""
import numpy as np

from mcdem._engine import Random
from mcdem.diagnosis.evidence import CandidateRange, Evidence, NuisancePrior
from mcdem.diagnosis.library import Library
from mcdem.observe.grid import Grid, bins_of
from mcdem.observe.observables import observables
from mcdem.diagnosis.signature import Signature

PACKINGS, REPLICATES = 8, 4
GRID = Grid([0.004, 0.006, 0.008, 0.0098], 0.002, 0.01)


def cells_that_need(what):
    return np.array([float(observables()[bin.observable].needs == what) for bin in bins_of(GRID)])


def signature(name, linear):
    return Signature(name, 1, linear, np.zeros(len(linear)), np.tile(linear, (8, 1)))


def evidence(adhesion=0.0, friction=0.0, modulus=0.0):
    """Noise of 1 between replicates and of 3 between packings. "adhesion" is visible only in observables that require positions,
    "friction" only in the top force, "modulus" in every bin."""
    random = Random(7, "null_draws")
    in_positions, in_top = cells_that_need("positions"), cells_that_need("plate")
    everywhere = np.ones(len(in_top))

    def packing(replicates):
        centre = 3 * random.normals(len(in_top))
        return centre, centre + random.normals(replicates * len(in_top)).reshape(replicates, -1)

    library = np.concatenate([packing(REPLICATES)[1] for _ in range(PACKINGS)])
    own, baseline = packing(6)
    observed = own + random.normals(len(in_top)) + adhesion * in_positions + friction * in_top + modulus * everywhere
    return Evidence(
        observed, baseline,
        Library(GRID, library, [p for p in range(PACKINGS) for _ in range(REPLICATES)],
                [signature("adhesion", in_positions), signature("friction", in_top)], [signature("modulus", everywhere)]),
        [CandidateRange("adhesion", "J/m2", -20, 20), CandidateRange("friction", "", -20, 20)], [NuisancePrior("modulus", "", 0.5)])
