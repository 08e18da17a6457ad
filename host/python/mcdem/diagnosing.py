"""mcdem.diagnose: the compiled diagnosis, and what Python writes of it."""
import importlib
from collections.abc import Sequence
from typing import Any


def diagnose(scene: Any, experiment: Any, folder: Any, *, candidates: Sequence[str] = (), replicates: int = 32, pairs: int = 8,
             confirmations: int = 8, refine: float = 4.0, seed: int = 1, library: Any = None, device: str = "", page: bool = True,
             progress: Any = None) -> dict[str, Any]:
    """Where a scene and an experiment differ, and which effect is consistent with the difference: the contents of diagnosis.json.

    `experiment`: a folder, or a list of those of several packings, which are diagnosed together. `refine`: the largest factor by
    which a scene that is not converged is refined, 1: not at all. Writes diagnosis.json and, with `page`, diagnosis.html into
    `folder`, as `mcdem diagnose` does; simulations are kept there, so that the same call continues after an interruption by Ctrl-C.
    `progress(stage, fraction)` is called repeatedly. host/diagnose/DIAGNOSIS_OUTPUT.md explains the keys. Raises ValueError,
    RuntimeError.
    """
    engine = importlib.import_module("._engine", __package__)
    from .report.present_diagnosis import completed, write_page
    engine.diagnose(scene, experiment, folder, candidates=list(candidates), replicates=replicates, pairs=pairs,
                    confirmations=confirmations, refine=refine, seed=seed, library=library, device=device, progress=progress)
    diagnosis, document = completed(folder)
    if page:
        write_page(diagnosis, folder)
    return document
