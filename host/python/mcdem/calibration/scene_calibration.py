"""The gamma with which a scene with model mc_dem has the reference's top force at its maximum compression; for a model without gamma the
Young's modulus of the grains."""
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _engine
from ..errors import InputError
from ..experiment.experiment import MATERIALS, other_materials
from ..observe.estimate import Estimate, mean_over_replicas
from ..observe.levels import level_tolerance
from ..observe.replicas import MODEL, SEED, Replicas
from ..results.names import ContactModel, all_names, parse
from ..results.parameters import keys_that_vary
from ..results.recording import Floats
from .quantities import Quantities, single, stroke_of
from .search import Calibration, SearchOptions, find_value
from .trials import Trials, mean_data

if TYPE_CHECKING:
    from .._engine import Scene

GAMMA, MODULUS = "contact.gamma", "grains.youngs_modulus"  # scene keys
LEFT_ASIDE = {MODEL, GAMMA, SEED}  # keys that may vary among the replicas of the scene


@dataclass(frozen=True)
class Options:
    """`model`: for others than mc_dem E over that of the scene is searched for."""

    model: ContactModel = ContactModel.mc_dem
    search: SearchOptions = SearchOptions()
    device: str = ""


@dataclass(frozen=True, eq=False)
class SceneCalibration:
    found: Calibration  # gamma, or E over that of the scene
    target: Estimate  # mean top force of the reference [N]
    simulated: Estimate  # of the scene's packings, for the last value that did not run away [N]
    displacement: float = 0.0  # of the plate at the target [m]
    replicas: int = 0  # number of packings in each evaluation
    model: ContactModel = ContactModel.mc_dem
    youngs_modulus: float = 0.0  # of the scene [Pa]; 0 if gamma was searched for

    @property
    def standard_error(self) -> float:
        """Of found.value: of the fit, of the reference and of the scene's packings. A single packing has no standard error; its scatter
        is left out."""
        forces = [error for error in (self.target.standard_error, self.simulated.standard_error) if math.isfinite(error)]
        return math.hypot(self.found.standard_error, *(error / self.found.slope for error in forces))

    @property
    def knows_scatter(self) -> bool:
        return math.isfinite(self.target.standard_error) and math.isfinite(self.simulated.standard_error)

    @property
    def of_modulus(self) -> bool:
        return self.youngs_modulus > 0

    @property
    def unit(self) -> float:
        """Of the values in `found`."""
        return self.youngs_modulus if self.of_modulus else 1.0


def calibrated_model(model: str, option: str) -> ContactModel:
    """The contact model to calibrate. Raises InputError, which names the `option` and all models."""
    known = parse(ContactModel, model)
    if known is None:
        raise InputError(f'{option} must be one of {all_names(ContactModel)}, got "{model}"')
    return known


def calibrate_scene(scene: "Scene", reference: Replicas, options: Options, progress: Callable[[float], object],
                    note: Callable[[str], object]) -> SceneCalibration:
    """The scene provides packings, materials and protocol. Its contact.model and contact.gamma are ignored; nothing else may vary.

    A value counts as running away if at least half of its replicas do; otherwise the mean is over the others. Raises InputError,
    RunError.
    """
    _engine.expect_plain_strokes(scene, "a calibration")
    if problems := [f"calibrate: {key} must be the same for all replicas: give one value with --set {key}=.."
                    for key in keys_that_vary(scene.parameters) if key not in LEFT_ASIDE]:
        raise InputError(problems)
    _note_other_materials(scene, reference, options.model, note)
    parameters: dict[str, Any] = scene.parameters[0]
    displacement = stroke_of(reference)
    check_stroke(parameters["plate.start"] - parameters["plate.end"], displacement)
    wanted = Quantities([single("top_force", displacement)])
    target = mean_over_replicas(wanted.of(reference)[:, 0])
    modulus = 0.0 if options.model == ContactModel.mc_dem else parameters[MODULUS]
    search = replace(options.search, what="E over the scene's") if modulus else options.search
    strokes = 2 * parameters["protocol.cycles"] - 1  # the last unloading is not evaluated
    scans = strokes * parameters["protocol.scans_per_stroke"] + parameters["protocol.scan_at_start"]
    trials, simulated, rounds = Trials(scene_of_model(scene, options.model), options.device), Estimate(), 0

    def top_forces(values: Floats) -> Floats:
        nonlocal simulated, rounds
        changes = [{MODULUS: modulus * value} if modulus else {GAMMA: value} for value in values.tolist()]
        # The simulation may be one interval into the last unloading when it stops.
        data = trials.data(changes, wanted, scans, lambda part: progress((rounds + min(1.0, part * (strokes + 1) / strokes)) / search.rounds))
        rounds += 1
        means = np.array([mean_data(one)[0] for one in data])
        for one in data[np.isfinite(means)]:
            simulated = mean_over_replicas(one[:, 0])
        return means

    found = find_value(top_forces, target.value, search)
    return SceneCalibration(found, target, simulated, displacement, trials.packings, options.model, modulus)


def scene_of_model(scene: "Scene", model: ContactModel) -> "Scene":
    """One replica with this contact model for each packing of the scene, of which only forces are recorded."""
    return scene.parse(scene.text, set={MODEL: model.value, GAMMA: 1, "output.positions": False, "output.contacts": False})


def _note_other_materials(scene: "Scene", reference: Replicas, model: ContactModel, note: Callable[[str], object]) -> None:
    """Materials that the reference states and the scene does not have: the calibrated parameter would make up for them."""
    searched = {MODULUS} if model != ContactModel.mc_dem else set()
    values = {key: reference[0].value(key) for key in MATERIALS if key not in searched}
    if others := other_materials({key: value for key, value in values.items() if isinstance(value, (int, float))}, scene.parameters[0]):
        note(f"the reference has {', '.join(others)}: the calibrated value makes up for the difference; change the scene with --set if the "
             "reference is right")


def check_stroke(stroke: float, displacement: float) -> None:
    """Raises InputError if the stroke of the scene does not reach the greatest displacement of the reference [m]."""
    if stroke < displacement - min(level_tolerance, 0.01 * displacement):
        raise InputError("calibrate: plate.start - plate.end must reach the reference's greatest displacement of "
                         f"{displacement * 1e3:.3f} mm, got {stroke * 1e3:.3f} mm")
