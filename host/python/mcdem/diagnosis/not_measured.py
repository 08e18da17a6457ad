"""What an experiment has not measured, and what that would tell."""
import numpy as np

from ..observe.grid import Grid, bins_of
from ..observe.observables import observables
from ..results.recording import Floats

NOT_MEASURED = {
    "contacts": "contacts.csv: the forces of contacts would tell the force distribution, the floor's and the walls' share, the plate's couple "
    "and biases of the force measurement",
    "positions": "grains.csv beyond frame 0, with contacts.csv: positions would tell the overlaps that the forces should imply, hence "
    "cross-contact effects, stiffening, adhesion, friction and errors of sizes; without contacts.csv still who touches, overlaps, packing "
    "fractions and motion",
}
WITH_GRAINS = {"contacts": NOT_MEASURED["contacts"],
               "positions": "contacts.csv in the frames of grains.csv: the overlaps that the forces should imply would tell cross-contact effects, "
               "stiffening, adhesion, friction and errors of sizes"}


def not_measured(observed: Floats, grid: Grid) -> list[str]:
    """One sentence for each file whose observables are missing in all scans; `observed`: one number per bin, NaN where unknown."""
    seen = {observables()[bin.observable].needs for bin, value in zip(bins_of(grid), observed) if np.isfinite(value)}
    return [text for needs, text in (WITH_GRAINS if "grains" in seen else NOT_MEASURED).items() if needs not in seen]
