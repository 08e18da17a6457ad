"""References of comparisons and calibrations: experiments, or one setting of runs."""
import os
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ..errors import InputError
from ..look import Path
from ..number_text import shortest
from ..results import ContactModel, Recording, Run, read_run
from ..results.folder import is_there
from .replicas import DISCARD, THRESHOLD, Setting, group_by_setting, model_of

if TYPE_CHECKING:
    from .. import _engine


def load_reference(paths: Sequence[str], setting: str = "", discard: int = 0, contacts: bool = False,
                   scene: "_engine.Scene | None" = None) -> Setting:
    """All replicas of experiment folders, result folders or files as one setting.

    Metrics ignore the first `discard` cycles of an experiment. `setting`: of a run with several; default: mc_dem, if it exists. `scene`: of the part
    of an experiment's [sample]. Raises InputError, RunError.
    """
    runs = [read_reference(path, discard, contacts, scene) for path in paths]
    settings = [Setting(run.name, run.recordings) if _is_measured(path) else chosen_setting(run, setting, path, "--setting")
                for path, run in zip(paths, runs, strict=True)]
    replicas: list[Recording] = [replica for one in settings for replica in one.replicas]
    return Setting(", ".join(one.label for one in settings), tuple(replicas))


def reference_setting(reference: "_engine.Run | Run | Path", setting: str = "", discard: int = 0, contacts: bool = False,
                      scene: "_engine.Scene | None" = None) -> Setting:
    """What a function of the package gets as its reference: a run, or the path of a result or an experiment.

    Arguments as of load_reference. Raises TypeError for anything else, InputError, RunError.
    """
    run = read_reference(reference, discard, contacts, scene) if isinstance(reference, (str, os.PathLike)) else _run_of(reference)
    return chosen_setting(run, setting, run.name, "setting")


def _run_of(reference: "_engine.Run | Run") -> Run:
    from .. import _engine
    from ..results.engine_run import run_of
    if not isinstance(reference, (_engine.Run, Run)):
        raise TypeError("the reference must be a Run, or the path of a result or an experiment")
    return run_of(reference)


def read_reference(path: Path, discard: int = 0, contacts: bool = False, scene: "_engine.Scene | None" = None) -> Run:
    """A result folder or file, or an experiment as a run of one recording. Raises InputError, RunError."""
    folder = os.fspath(path)
    if not _is_measured(folder):
        return read_run(folder, contacts=contacts)
    from ..experiment.read import read_experiment
    from ..experiment.sample import part_of
    experiment = part_of(read_experiment(folder), scene)
    recording = experiment.recording
    recording = replace(recording, parameters=recording.parameters | {DISCARD: str(discard),
                                                                      THRESHOLD: shortest(experiment.measurement.force_threshold)})
    return Run(recording.label, "", "", "", "", (recording,))


def _is_measured(path: str) -> bool:
    return is_there(os.path.join(path, "experiment.toml"))


def chosen_setting(run: Run, label: str, where: str, option: str) -> Setting:
    """The setting with this label; empty: the only one, or that of mc_dem. Raises InputError, which names `where` and `option`."""
    settings = group_by_setting(run)
    known = ", ".join(setting.label for setting in settings)
    for setting in settings:
        if setting.label == label:
            return setting
    if label:
        raise InputError(f"{option}: must be one of {where}'s: {known or 'it has one, without a label'}; got {label}")
    if len(settings) == 1:
        return settings[0]
    for setting in settings:
        if model_of(setting.replicas) == ContactModel.mc_dem:
            return setting
    raise InputError(f"{where}: holds several settings; choose one with {option}, of {known}")
