"""Keys of a scene that a fit moves: limits and units from the reference of keys, natural steps from the library of effects."""
import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from .. import _engine
from ..diagnosis.effects import EFFECTS
from ..diagnosis.model import Model
from ..errors import InputError
from ..experiment.instrument import Instrument
from ..problems import to_number
from ..results.parameters import has_programme

if TYPE_CHECKING:
    from .._engine import Scene

OFFSET = "strain_offset"  # as in a diagnosis: plate positions are read too high by this [m]
DIAMETERS = "effects.diameter_error"
NO_DATA = ("protocol.", "numerics.", "output.", "plate.", "programme.")  # how a scene is simulated and recorded
STEP, FACTOR = 0.15, 2.0  # of a value that no effect changes: first step, and first range if it moves alone
OFFSET_STEP, OFFSET_RANGE = 0.05, 0.1  # over the mean diameter
LEAST_PART = 1e-3  # of the scene's value, where the limit 0 is excluded
SIMILAR = 0.6  # of names that a user may have meant


@dataclass(frozen=True)
class FitKey:
    """A key, or OFFSET, or several that keep their ratios (KEY+KEY); the numbers are those of the first."""
    name: str
    unit: str
    value: float  # of the scene
    low: float  # limits
    high: float
    step_low: float  # first window of several keys that move together
    step_high: float
    range_low: float  # first range of a key that moves alone
    range_high: float
    scale: float  # of relative changes
    scale_words: str = ""  # empty: the scene's value
    ratios: tuple[float, ...] = (1.0,)  # of the keys to the first

    def values(self, value: float) -> dict[str, float]:
        """Of each key, where that of the first is `value`."""
        return {name: value * ratio for name, ratio in zip(self.name.split("+"), self.ratios, strict=True)}

    def relative(self, value: float) -> float:
        """Change over the scale; NaN without one."""
        return (value - self.value) / self.scale if self.scale else math.nan


def fit_keys(words: Sequence[str], scene: "Scene", mean_diameter: float) -> list[FitKey]:
    """Of KEY, KEY=LOW..HIGH or KEY+KEY. `mean_diameter` of the grains [m]. Raises InputError with all problems."""
    found, problems, steps = list[FitKey](), list[str](), _effect_steps(scene, mean_diameter)
    for word in words:
        name, equals, ends = word.partition("=")
        try:
            if any(one.name == name for one in found):
                raise InputError(f"{name}: must be given once")
            together = [_fit_key(key, _ends(word, ends) if equals else None, scene, steps, mean_diameter) for key in name.split("+")]
            found.append(_together(together) if len(together) > 1 else together[0])
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return found


def _together(keys: Sequence[FitKey]) -> FitKey:
    first = keys[0]
    if not all(key.value for key in keys):
        raise InputError(f"{'+'.join(key.name for key in keys)}: keys that move together must not be 0 in the scene, because they keep their "
                         "ratios")
    return replace(first, name="+".join(key.name for key in keys), ratios=tuple(key.value / first.value for key in keys))


def _ends(word: str, text: str) -> tuple[float, float]:
    low, high = (to_number(end) for end in text.split("..", 1)) if ".." in text else (None, None)
    if low is None or high is None or not low < high:
        raise InputError(f"{word}: must be KEY=LOW..HIGH with LOW below HIGH, as in grains.friction=0..0.3")
    return low, high


def _fit_key(name: str, ends: tuple[float, float] | None, scene: "Scene", steps: Mapping[str, Sequence[float]], diameter: float) -> FitKey:
    parameters: Mapping[str, Any] = scene.parameters[0]
    if name == OFFSET:
        if parameters["container.shape"] == "cell" or has_programme(parameters):
            raise InputError(f"{OFFSET}: must be that of a plate with strokes, got a cell or a programme")
        step, width = OFFSET_STEP * diameter, OFFSET_RANGE * diameter
        key = FitKey(OFFSET, "m", 0.0, -diameter, diameter, -step, step, -width, width, diameter, "mean diameter")
        return _within(key, ends) if ends else key
    value, limits = parameters.get(name), _engine.key_range(name)
    if limits is None or name.startswith(NO_DATA) or not isinstance(value, (int, float)):
        raise InputError(f"{name}: must be {OFFSET}, or a key of this scene with a number that packings, plate and recording do not depend "
                         f"on{_suggestion(name, parameters)}")
    scene._changed({name: value})  # raises InputError for keys that determine packings
    low, high, is_excluded = limits
    low = LEAST_PART * abs(value) if is_excluded else low
    if name in steps:
        low_step, high_step, low_end, high_end = steps[name]
    elif value:
        low_step, high_step = -STEP * abs(value), STEP * abs(value)
        low_end, high_end = sorted((value / FACTOR - value, value * FACTOR - value))
    elif ends:
        low_step, high_step, low_end, high_end = ends[0], ends[1], ends[0], ends[1]
    else:
        raise InputError(f"{name}: is 0 in this scene, from which no range of trials follows: give it as {name}=LOW..HIGH")
    scale, words = (diameter, "mean diameter") if name == DIAMETERS else (abs(value), "")
    key = FitKey(name, _engine.key_unit(name), float(value), low, high, value + low_step, value + high_step, value + low_end, value + high_end,
                 float(scale), words)
    return _within(key, ends or (low, high))


def _within(key: FitKey, ends: tuple[float, float]) -> FitKey:
    """With these limits, if they are closer. Raises InputError if the key cannot have them."""
    low, high = ends
    if not (key.low <= low and high <= key.high):
        raise InputError(f"{key.name}: its limits must be from {key.low:g} to {key.high:g} {key.unit}".rstrip() + f", got {low:g}..{high:g}")
    is_wide = (low, high) == (key.low, key.high)
    step_low, step_high = max(low, key.step_low), min(high, key.step_high)
    if step_low >= step_high:  # the scene's value is beyond these limits
        step_low, step_high = low, high
    first = (max(low, key.range_low), min(high, key.range_high)) if is_wide else (low, high)
    return replace(key, low=low, high=high, step_low=step_low, step_high=step_high, range_low=first[0], range_high=first[1])


def _effect_steps(scene: "Scene", mean_diameter: float) -> dict[str, tuple[float, float, float, float]]:
    """By the key that an effect of the diagnosis changes alone: changes of its value at the amplitudes of the paired runs, and at the ends of
    the plausible range."""
    model = Model(scene._variant({}), {}, Instrument(), mean_diameter)
    found = dict[str, tuple[float, float, float, float]]()
    for effect in EFFECTS:
        if effect.numerical:
            continue
        amplitudes = effect.first, effect.second, effect.low, effect.high
        try:
            by_key = [effect.apply(model, amplitude * effect.scale(model)).changes for amplitude in amplitudes]
        except (KeyError, TypeError):  # of walls or a plate, which a cell does not have
            continue
        names = {key for changes in by_key for key in changes}
        if len(names) == 1:
            name = names.pop()
            first, second, low, high = (float(changes[name]) - float(model[name]) for changes in by_key)
            step = max(abs(first), abs(second) / 2)
            found.setdefault(name, (-step, step, low, high))
    return found


def scene_changes(values: Mapping[str, float], parameters: Mapping[str, Any]) -> dict[str, float]:
    """The keys of a scene with these parameters to change. A plate that is read too high ends lower; one that is read too low also starts
    higher, so that there are scans from the first displacement on."""
    changes = {name: value for name, value in values.items() if name != OFFSET}
    if offset := values.get(OFFSET, 0.0):
        changes |= {"plate.end": parameters["plate.end"] - offset, "plate.start": parameters["plate.start"] + max(0.0, -offset)}
    return changes


def _suggestion(name: str, parameters: Mapping[str, Any]) -> str:
    near = difflib.get_close_matches(name, [key for key, value in parameters.items() if isinstance(value, (int, float))], 1, SIMILAR)
    return f" (did you mean {near[0]}?)" if near and name not in parameters else ""
