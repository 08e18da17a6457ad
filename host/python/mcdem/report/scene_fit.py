"""Results of `mcdem calibrate --fit` as tables and sentences."""
import math
from itertools import combinations

from ..calibration.fit import End
from ..calibration.keys import FitKey
from ..calibration.scene_fit import FitRound, SceneFit
from .labels import NO_NUMBER, number
from .text_table import table_of, to_text

CORRELATED = 0.9  # from which a correlation is told
BEYOND = 3.0  # a remaining difference, over what the scatter of packings explains
WORDS = {"force": "errf: force on the plate", "coordination": "errZ: contacts per grain"}


def value_text(key: FitKey, value: float, error: float = math.nan) -> str:
    """ "29.1 ± 0.4 kPa"; moduli in kPa, lengths in mm."""
    unit, size = {"Pa": ("kPa", 1e3), "m": ("mm", 1e-3)}.get(key.unit, (key.unit, 1.0))
    value, error = value / size, error / size
    if math.isfinite(error) and error > 0:
        digits = max(0, 1 - math.floor(math.log10(error)))
        text = f"{value:.{digits}f} ± {error:.{digits}f}"
    else:
        text = f"{value:.4g}"
    return f"{text} {unit}".rstrip()


def change_text(key: FitKey, value: float) -> str:
    relative = key.relative(value)
    return f"{100 * relative:+.3g} %{' of the ' + key.scale_words if key.scale_words else ''}" if math.isfinite(relative) else NO_NUMBER


def round_text(fit: SceneFit) -> str:
    """What the last round found, in one line."""
    last: FitRound = fit.rounds[-1]
    values = ", ".join(f"{key.name} = {value_text(key, *pair)}" for key, pair in
                       zip(fit.keys, zip(last.values.tolist(), last.standard_error.tolist(), strict=True), strict=True))
    least = min((one for one in last.misfit.tolist() if math.isfinite(one)), default=math.nan)
    apart = ", ".join(f"{one.quantity} {one.after:.3g} {one.unit}".rstrip() for one in fit.differences)
    return f"round {len(fit.rounds)}: {values}; misfit {least:.3g} (rms: {apart})"


def fit_text(fit: SceneFit) -> str:
    vague = {name for group in fit.undetermined for name, _ in group}
    texts = [value_text(key, value) + ", not determined" if key.name in vague else value_text(key, value, error)
             for key, value, error in zip(fit.keys, fit.values.tolist(), fit.standard_error.tolist(), strict=True)]
    rows = [[key.name, text, value_text(key, key.value), change_text(key, value)]
            for key, text, value in zip(fit.keys, texts, fit.values.tolist(), strict=True)]
    lines = [to_text(table_of(["<key", "value", "scene", "change"], rows))]
    rows = [[WORDS.get(one.quantity, one.quantity) + (f" [{one.unit}]" if one.unit else ""), number(one.before), number(one.after),
             number(one.expected)] for one in fit.differences]
    if math.isfinite(fit.ratio[1]):
        rows.append(["Rtop", number(fit.ratio[0], ".3f"), number(fit.ratio[1], ".3f"), NO_NUMBER])
    notes = ["root mean square of simulation less experiment; packings: what their scatter explains of it"]
    lines += [to_text(table_of(["<difference", "before", "after", "packings"], rows, notes)), *_sentences(fit)]
    return "\n".join([*lines, "in a scene: " + " ".join(f"--set {one}" for one in fit.assignments)])


def _sentences(fit: SceneFit) -> list[str]:
    lines = []
    for group in fit.undetermined:
        names = " and ".join(name for name, _ in group)
        if len(group) == 1:
            lines.append(f"the data do not determine {names}")
        else:
            units = {key.name: key.unit for key in fit.keys}
            moved = ", ".join(f"{name} by {step:+.2g} {units[name]}".rstrip() for name, step in group)
            lines.append(f"the data do not determine {names} separately: if they move together ({moved}), the data hardly change")
    for i, j in combinations(range(len(fit.keys)), 2):
        if abs(fit.correlation[i, j]) >= CORRELATED and not fit.undetermined:
            lines.append(f"{fit.keys[i].name} and {fit.keys[j].name} are correlated by {fit.correlation[i, j]:+.2f}: their errors are "
                         "larger together than one alone")
    lines += [f"{key.name} is at the limit of its range: give a wider one as {key.name}=LOW..HIGH, if it can have one"
              for key, at in zip(fit.keys, fit.at_limit, strict=True) if at]
    for one in fit.differences:
        if one.after > BEYOND * one.expected:
            lines.append(f"{one.quantity}: the remaining difference is {one.after / one.expected:.1f} times what the scatter of packings "
                         "explains; these keys do not bring the scene to the experiment, and the errors do not contain that")
    if fit.end is None:
        lines.append("the errors of the fit are above the tolerance: raise --rounds, or use more replicas")
    elif fit.end is not End.converged:
        lines.append("the best values are at the edge of what could be simulated")
    return lines + list(fit.notes)
