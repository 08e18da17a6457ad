"""The motion that an experiment states of its plate, where the scene's plate moves otherwise: grains that rearrange take their own time, and
friction unloads while the plate stands."""
import math

from ..experiment.experiment import Experiment
from .model import Model

Change = tuple[str, str, float, float]  # of a key of the scene: key, unit, from, to


def neglected_motion(model: Model, experiment: Experiment, max_slowdown: float) -> list[Change]:
    """The changes that give the model's plate the motion of the experiment's.

    Nothing if it already moves so or follows a programme, if the experiment does not state its speed, or if the experiment's plate is slower than
    the scene's by more than a factor of `max_slowdown`.
    """
    speed = experiment.plate_speed or 0.0
    if not speed > 0 or speed * max_slowdown < model["plate.speed"] or model.has_programme:
        return []
    # Grains that have come to rest do not change if the plate stands longer.
    rest = model["protocol.relax_time"] or math.inf

    def stands(key: str, stated: float) -> float:
        return float(model[key] if model[key] > 0 else min(stated, rest))

    wanted = [("protocol.pause", "s", stands("protocol.pause", experiment.plate_pause)),
              ("protocol.hold", "s", stands("protocol.hold", experiment.plate_hold)), ("plate.speed", "m/s", speed),
              ("protocol.rate_tolerance", "", 0.0)]
    return [(key, unit, model[key], to) for key, unit, to in wanted if model[key] != to]
