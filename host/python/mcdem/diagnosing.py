"""mcdem.diagnose: a diagnosis for users of Python."""
import os
import pathlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from .command import folders
from .errors import InputError
from .look import Path
from .warn import warn_user

if TYPE_CHECKING:
    from ._engine import Scene
    from .diagnosis.diagnose import Options
    from .experiment.experiment import Experiment


def diagnose(scene: "Scene", experiment: Path | Sequence[Path], folder: Path, *, candidates: Sequence[str] = (), replicates: int = 32,
             pairs: int = 8, confirmations: int = 8, refine: float = 4.0, seed: int = 1, library: Path | None = None, device: str = "",
             page: bool = True, progress: Callable[[str, float], object] | None = None) -> dict[str, Any]:
    """Where a scene and an experiment differ, and which effect is consistent with the difference: the contents of diagnosis.json.

    `experiment`: a folder, or a list of those of several packings, which are diagnosed together. `refine`: the largest factor by
    which a scene that is not converged is refined, 1: not at all. Writes diagnosis.json and, with `page`, diagnosis.html into
    `folder`, as `mcdem diagnose` does; simulations are kept there, so that the same call continues after an interruption by Ctrl-C.
    `progress(stage, fraction)` is called repeatedly. host/python/mcdem/diagnosis/DIAGNOSIS_OUTPUT.md explains the keys. Raises ValueError,
    RuntimeError.
    """
    from .diagnosis.diagnose import Options
    from .experiment.read import read_experiments
    from .outputs import output_folder, remove_temporaries
    from .report.present_diagnosis import completed, write_page
    options = Options(candidates=list(candidates), replicates=replicates, pairs=pairs, confirmations=confirmations, refine=refine,
                      seed=seed, library=library)
    _check(options)
    experiments = read_experiments(folders(experiment), "experiment")
    with output_folder(folder) as out:
        remove_temporaries(out / "simulations")
        _write(scene, experiments, out, options, device, progress)
    diagnosis, document = completed(folder)
    if page:
        write_page(diagnosis, folder)
    return document


def _check(options: "Options") -> None:
    problems = [f"{name}: must be {least} or more, got {value}" for name, value, least in
                (("replicates", options.replicates, 8), ("pairs", options.pairs, 2), ("confirmations", options.confirmations, 0))
                if value < least]
    if not 1 <= options.refine <= 64:
        problems.append(f"refine: must be between 1 and 64, got {options.refine:g}")
    if problems:
        raise InputError(problems)


def _write(scene: "Scene", experiments: "list[Experiment]", out: pathlib.Path, options: "Options", device: str,
           progress: Callable[[str, float], object] | None) -> None:
    """Writes diagnosis.json."""
    from .diagnosis.diagnose import Listener, diagnose, make_simulations
    from .diagnosis.diagnosis_json import diagnosis_json
    from .outputs import DIAGNOSIS, replace_own

    class Caller(Listener):
        def progress(self, stage: str, fraction: float) -> None:
            if progress:
                progress(stage, fraction)

        def note(self, text: str) -> None:
            warn_user(text)

    caller = Caller()
    simulations = make_simulations(scene, experiments, os.path.join(out, "simulations"), options, device, caller)
    diagnosis = diagnose(scene, simulations, options, caller)
    replace_own(out / "diagnosis.json", DIAGNOSIS, diagnosis_json(diagnosis).encode())
