"""Overlaps beyond the tested range of a contact model (host/core/law_range.h)."""
from dataclasses import dataclass

import numpy as np

from ..results.names import ContactModel
from .replicas import Replicas, model_of

# Largest relative geometric overlap of two grains at which the model agrees with finite elements (tests/truth/README.md): with
# elastic_sphere finite strain adds 7 % to the force of six plates at nu = 0.49 there. None for models that do not agree.
TESTED_OVERLAP = {ContactModel.elastic_sphere: 0.10, ContactModel.hyperelastic_sphere: 0.20}


@dataclass(frozen=True)
class BeyondLaw:
    """Relative overlaps of two grains."""

    tested: float
    displacement: float  # smallest displacement with a larger overlap [m]
    max_overlap: float


def beyond_law(replicas: Replicas) -> BeyondLaw | None:
    """None if no overlap is larger, overlaps are unknown, or the model was not tested."""
    model = model_of(replicas)
    tested = TESTED_OVERLAP.get(model) if model else None
    if tested is None:
        return None
    beyond = [(recording.displacement[over], recording.scans.max_overlap[over])
              for recording in replicas if (over := recording.scans.max_overlap > tested).any()]
    if not beyond:
        return None
    displacement, overlap = (np.concatenate(one) for one in zip(*beyond, strict=True))
    return BeyondLaw(tested, float(np.nanmin(displacement)), float(overlap.max()))
