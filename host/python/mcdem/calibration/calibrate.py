"""mcdem.calibrate: a calibration for users of Python; the contents of calibration.json."""
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from .. import _engine
from ..json_text import finite
from ..look import Path
from ..observe.reference import reference_setting
from ..warn import warn_user
from .scene_fit import FitOptions, SceneFit, fit_scene
from .scene_calibration import Options, SceneCalibration, calibrate_scene, calibrated_model
from .search import SearchOptions

if TYPE_CHECKING:
    from .._engine import Run, Scene


def calibrate(scene: "Scene", reference: "Run | Path", *, setting: str = "", discard: int = 0, low: float = 0.5, high: float = 1.5,
              tolerance: float = 0.005, batch: int = 6, rounds: int = 8, model: str | None = None, fit: Sequence[str] = (),
              compare: Sequence[str] = (), device: str = "", progress: Callable[[float], object] | None = None) -> dict[str, Any]:
    """The gamma of MC-DEM that gives the reference's top force, or the grains' Young's modulus for another model; or with `fit` any keys,
    fitted together to the reference's curves. As `mcdem calibrate` finds them; keys of the dict as in calibration.json.

    `reference`: a run, a result folder, or the folder of an experiment, of which the first `discard` cycles are left out; `setting`
    chooses one of a run's. `low`, `high`: of gamma, or of E divided by the scene's E, as `tolerance`. `fit`: keys, or "KEY=LOW..HIGH";
    `compare`: names of the quantities that are compared, by default all. `progress(fraction)` is called repeatedly. Raises ValueError,
    RuntimeError.
    """
    chosen = reference_setting(reference, setting, discard, scene=scene)
    if fit:
        wanted = FitOptions(fit, compare, model or "", tolerance, batch, rounds, device)
        fitted = fit_scene(scene, chosen.replicas, wanted, progress or (lambda _: None), lambda _: None)
        return fit_document(fitted, scene.text, chosen.label)
    model = model or "mc_dem"
    options = Options(calibrated_model(model, "calibrate: model"), SearchOptions(low, high, tolerance, batch, rounds), device)
    result = calibrate_scene(scene, chosen.replicas, options, progress or (lambda _: None), warn_user)
    return calibration_document(result, scene.text, chosen.label)


def calibration_document(result: SceneCalibration, scene: str, reference: str) -> dict[str, Any]:
    """`scene`: its text; `reference`: label of its setting. Numbers that are not finite are None."""
    found, unit = result.found, result.unit
    key = "youngs_modulus_Pa" if result.of_modulus else "gamma"
    rounds = [{key: (unit * one.values).tolist(), "top_force_N": one.top_force.tolist(), "estimate": unit * one.root,
               "standard_error": unit * one.standard_error} for one in found.rounds]
    document: dict[str, Any] = finite({
        "contact_model": result.model.value, "converged": found.converged, "replicas": result.replicas, "reference": reference,
        "scene": scene, "program": _engine.__version__, "rounds": rounds, key: unit * found.value,
        f"{key}_standard_error": unit * result.standard_error, f"{key}_standard_error_of_fit": unit * found.standard_error,
        f"runs_away_at_{key}": unit * found.runs_away_at, "target_top_force_N": result.target.value,
        "target_standard_error_N": result.target.standard_error, "displacement_m": result.displacement})
    return document


def fit_document(fit: SceneFit, scene: str, reference: str) -> dict[str, Any]:
    """Of several keys; `scene` and `reference` as above."""
    def by_key(values: Any) -> dict[str, Any]:
        return dict(zip((key.name for key in fit.keys), values.tolist(), strict=True))

    errors, of_fit = by_key(fit.standard_error), by_key(fit.standard_error_of_fit)
    document: dict[str, Any] = finite({
        "converged": fit.end is not None, "replicas": fit.packings, "reference": reference, "scene": scene, "program": _engine.__version__,
        "keys": {key.name: {"value": value, "unit": key.unit, "scene": key.value, "standard_error": errors[key.name],
                            "standard_error_of_fit": of_fit[key.name], "at_limit": bool(limit)}
                 for key, value, limit in zip(fit.keys, fit.values.tolist(), fit.at_limit, strict=True)},
        "correlation": fit.correlation.tolist(), "not_determined": [[name for name, _ in group] for group in fit.undetermined],
        "differences": {one.quantity: {"unit": one.unit, "before": one.before, "after": one.after, "expected": one.expected}
                        for one in fit.differences},
        "Rtop": list(fit.ratio), "notes": list(fit.notes), "set": fit.assignments, "target_top_force_N": fit.target,
        "rounds": [{"trials": one.trials.tolist(), "misfit": one.misfit.tolist(), "estimate": by_key(one.values),
                    "standard_error": by_key(one.standard_error)} for one in fit.rounds]})
    return document
