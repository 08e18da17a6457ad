"""Advice on the scene's keys that follows from a diagnosis."""
from collections.abc import Callable, Sequence

from .diagnosis_types import Cause, Diagnosis, NextStep, Refinement, Verdict
from .effects import find_effect

Amplitudes = Sequence[tuple[str, float]]  # of effects and parameters by name


def _changed_together(causes: Sequence[Cause]) -> Sequence[Cause]:
    """The causes that are changed together; of a group only the leading one."""
    return causes if len(causes[0].group) == 1 else causes[:1]


def _to_refine(r: Refinement) -> NextStep:
    unit = r.unit and " " + r.unit
    return NextStep(f"set {r.key} = {r.to:.3g}{unit} in the scene (now {r.was:.3g}), or let the diagnosis refine it with "
                    f"--refine {r.was / r.to:.0f}, and diagnose again", None)


def _to_check_measurement(causes: Sequence[Cause]) -> NextStep:
    """Errors of measurement have no key in the scene."""
    effects = [find_effect(cause.effect) for cause in causes]
    words = [effect.words if effect else "the zero of the displacement ([plate] start in experiment.toml)" for effect in effects]
    return NextStep(f"check the measurement for {' and '.join(words)}: the scene describes no errors of measurement", None)


def change_of_the_scene(diagnosis: Diagnosis, changed_keys: Callable[[Amplitudes], list[str]]) -> NextStep | None:
    """How to change the scene according to the named effect; nothing if none is named.

    `changed_keys`: "key = value" for each key that these amplitudes change.
    """
    if diagnosis.refinements and not diagnosis.refinements[-1].done:
        return _to_refine(diagnosis.refinements[-1])
    if diagnosis.verdict == Verdict.unknown_effect or not diagnosis.causes:
        return None
    causes = _changed_together(diagnosis.causes)
    settings = changed_keys([(cause.effect, cause.amplitude) for cause in causes])
    if not settings:
        return _to_check_measurement(causes)
    return NextStep(f"set {', '.join(settings)} in the scene, and test with another packing whether the gap disappears", None)


def simulate_motion(motion: Sequence[tuple[str, str, float, float]]) -> NextStep:
    """The settings that give the scene's plate the motion of the experiment's; `motion`: key, unit, present and other value."""
    stops = any(key == "protocol.pause" and to > 0 for key, _, _, to in motion)
    settings = [*(["protocol.stop_at_scans=true"] if stops else []), *(f"{key}={to:.3g}" for key, _, _, to in motion)]
    return NextStep("simulate the motion of the experiment's plate:" + "".join(f" --set {setting}" for setting in settings), None)
