"""mcdem.calibrate: a calibration for users of Python."""
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..look import Path
from ..warn import warn_user

if TYPE_CHECKING:
    from .._engine import Run, Scene


def calibrate(scene: "Scene", reference: "Run | Path", *, setting: str = "", discard: int = 0, low: float = 0.5, high: float = 1.5,
              tolerance: float = 0.005, batch: int = 6, rounds: int = 8, model: str = "mc_dem", device: str = "",
              progress: Callable[[float], object] | None = None) -> dict[str, Any]:
    """The gamma of MC-DEM that gives the reference's top force, or the grains' Young's modulus for another model, as `mcdem calibrate`
    finds it; keys of the dict as in calibration.json.

    `reference`: a run, a result folder, or the folder of an experiment, of which the first `discard` cycles are left out; `setting`
    chooses one of a run's. `low`, `high`: of gamma, or of E divided by the scene's E, as `tolerance`. `progress(fraction)` is called
    repeatedly. Raises ValueError, RuntimeError.
    """
    from .. import _engine
    from ..observe.reference import reference_setting
    from .calibration_json import calibration_document
    from .scene_calibration import Options, calibrate_scene, calibrated_model
    from .search import Bracket, SearchOptions
    options = Options(calibrated_model(model, "calibrate: model"), Bracket(low, high), SearchOptions(tolerance, batch, rounds), device)
    chosen = reference_setting(reference, setting, discard)
    result = calibrate_scene(scene, chosen.replicas, options, progress or (lambda _: None), warn_user)
    return calibration_document(result, scene.text, chosen.label, _engine.__version__)
