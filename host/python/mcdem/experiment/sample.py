"""A sample of any size, compared with a simulated part of it: stress against strain (host/python/mcdem/experiment/README.md, "A part for the whole")."""
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..number_text import shortest
from ..results.names import ContainerShape, Phase, Wall
from ..results.parameters import Parameters, typed_value
from ..results.recording import Box, Floats, Ints

if TYPE_CHECKING:
    from .._engine import Scene
    from .experiment import Experiment

OTHER_FRACTION = 0.02  # relative, of the part's packing fraction at plate.start: a stress then differs by a tenth or more
# Height at floor and plate, over the mean diameter, that grains do not fill; of a part it counts, of a sample not. From beds of 11 and 5.5 diameters
# (tests/experiment/sample_test.py), whose forces agree when their heights are compared without it.
EMPTY_HEIGHT = 0.1
MOST_FRICTION = 3.0  # of 4 mu K H/D: beyond it little of the stress reaches the floor


@dataclass(frozen=True)
class Sample:
    """What [sample] states; its height is plate.start."""

    area: float  # of the cross-section [m2]
    packing_fraction: float = math.nan  # at plate.start; NaN: not known
    wall_friction: float = 0.0  # mu between grains and side wall; 0: not corrected
    lateral_ratio: float = 0.5  # K: lateral over vertical stress

    def mean_over_top(self, height: Floats, phase: Ints) -> Floats:
        """Stress averaged over the height [m], over that below the plate, by Janssen's law without weight: the stress falls as exp(-x z/height)
        from the plate down with x = 4 mu K height/D (Janssen 1895, translated by Sperl, Granular Matter 8 (2006) 59; D of a circle with this
        area). Where the plate goes up friction acts the other way, and x is negative."""
        x = 4 * self.wall_friction * self.lateral_ratio * height / math.sqrt(4 * self.area / math.pi)
        x = np.where(phase == Phase.unload, -x, x)
        with np.errstate(invalid="ignore"):
            return np.where(np.abs(x) < 1e-9, 1.0, -np.expm1(-x) / x)


def part_of(experiment: "Experiment", scene: "Scene | None") -> "Experiment":
    """The experiment that a part with the container and the height of the scene would be: the same strains, and the same stresses averaged over
    the height. An experiment without a [sample] is returned as it is. Raises InputError."""
    sample, recording = experiment.sample, experiment.recording
    if sample is None:
        return experiment
    if scene is None:
        raise InputError(f"{experiment.name}: its [sample] is compared with a part of it by diagnose, calibrate and what-if only")
    values = scene._values
    _expect_part(experiment, sample, scene)
    box = Box(values["container.size_x"], values["container.size_y"], ContainerShape.periodic)
    empty = EMPTY_HEIGHT * values["packing.diameter_mean"]
    height = (values["plate.start"] - empty) / recording.plate_start
    area = box.size_x * box.size_y / sample.area
    scans = recording.scans
    force = scans.wall_force.copy()
    force[:, Wall.plate, 2] *= area * sample.mean_over_top(scans.plate_z, scans.phase)
    uncertainty = {key: sigma * (height if key == "plate.start" else 1) for key, sigma in experiment.uncertainty.items()}
    return replace(experiment, sample=None, uncertainty=uncertainty,
                   plate_speed=None if experiment.plate_speed is None else height * experiment.plate_speed,
                   recording=replace(recording, box=box, plate_start=values["plate.start"],
                                     parameters=_of_part(recording.parameters, height, area, empty, 1 - empty / values["plate.start"]),
                                     scans=replace(scans, plate_z=empty + height * scans.plate_z, wall_force=force)))


def _expect_part(experiment: "Experiment", sample: Sample, scene: "Scene") -> None:
    values, name, problems = scene._values, experiment.name, list[str]()
    if values["container.shape"] != ContainerShape.periodic:
        problems.append(f"{scene.name}: container.shape must be periodic for {name}: a part of a [sample] has no side walls")
    if len(experiment.recording.diameter):
        problems.append(f"{name}: grains.csv must be left out where experiment.toml has a [sample]: the part has other grains")
    longest = 4 * sample.wall_friction * sample.lateral_ratio * experiment.recording.plate_start / math.sqrt(4 * sample.area / math.pi)
    if longest > MOST_FRICTION:
        problems.append(f"{name}: wall_friction in [sample] must leave 4 mu K height/diameter at most {MOST_FRICTION:g}, got {longest:.3g}: little "
                        "of the plate's stress reaches the floor of such a column")
    if sample.wall_friction and any(value and key.endswith(".force") for key, value in experiment.recording.parameters.items()):
        problems.append(f"{name}: [sample] must not state wall_friction where the [[programme]] sets forces: the stress in the sample is not that "
                        "below the plate")
    if not problems and sample.packing_fraction > 0 and not values["packing.file"]:
        from .. import _engine
        [packing] = _engine.make_packings(scene._variant({"plate.start": 10 * values["plate.start"]}), [1])  # it may be too low
        wanted = EMPTY_HEIGHT * values["packing.diameter_mean"] + math.pi / 6 * float((packing.diameter**3).sum()) / (
            values["container.size_x"] * values["container.size_y"] * sample.packing_fraction)
        if abs(values["plate.start"] / wanted - 1) > OTHER_FRACTION:
            problems.append(f"{scene.name}: plate.start must be {wanted:.6g} m for {name}, where the grains of the scene have the sample's packing "
                            f"fraction of {sample.packing_fraction:.4g}, got {shortest(values['plate.start'])}: set it, and plate.end and "
                            "packing.packing_fraction accordingly")
    if problems:
        raise InputError(problems)


def _of_part(parameters: Parameters, height: float, area: float, empty: float, strain: float) -> Parameters:
    """A programme with the positions and speeds of the part, and its forces; times are the same. `strain`: of the part's whole
    height, over that without the empty one."""
    changed = dict(parameters)
    for key, text in parameters.items():
        stage, _, last = key.rpartition(".")
        if not stage.startswith("programme.") or not text:
            continue
        quantity = next((one for one in ("position", "force", "strain") if parameters.get(f"{stage}.{one}")), "")
        factor, offset = {"position": (height, empty), "force": (area, 0.0), "strain": (strain, 0.0)}.get(quantity, (1.0, 0.0))
        if last == "speed":
            factor, offset = height, 0.0
        elif last not in (quantity, "back", "scan_at") or not quantity:
            continue
        value = typed_value(text)
        numbers = [shortest(offset + factor * one) for one in (value if isinstance(value, list) else [value])]
        changed[key] = f"[{', '.join(numbers)}]" if isinstance(value, list) else numbers[0]
    return changed
