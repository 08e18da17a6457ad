"""Readable names of effects, quantities and probabilities of a diagnosis."""
import math
from collections.abc import Callable, Iterable, Sequence

from ..diagnosis.diagnosis_types import Cause, MissingBins, NextStep, NuisanceFit, Pair, Refinement, WhereEntry
from ..diagnosis.effects import find_effect
from .labels import NO_NUMBER, number, one_line

# Names that are not of effects.
SPECIAL_WORDS = {"strain_offset": "zero of the displacement", "non_affine": "non-affine displacement", "modulus": "modulus of the grains"}

# Unit in files: conversion factor, displayed unit.
UNITS = {"m": (1e3, "mm"), "N": (1e3, "mN"), "J/m2": (1e3, "mJ/m²"), "Pa": (1e-3, "kPa"), "s": (1e3, "ms"), "m/N": (1e3, "mm/N"),
         "relative": (100., "%"), "1": (1., ""), "kg/m3": (1., "kg/m³"), "J/m3": (1., "J/m³")}

# What the two signs of an amplitude mean, after its absolute value.
OF_THE_SCENE = "higher than in the scene", "lower than in the scene"
STATED = "higher than stated", "lower than stated"
READ = "too high", "too low"
DIRECTIONS = {
    "friction": OF_THE_SCENE, "wall_friction": OF_THE_SCENE, "gamma": OF_THE_SCENE,
    "modulus": STATED, "strain_offset": STATED, "force_threshold": STATED,
    "buoyancy": ("denser than stated", "lighter than stated"), "diameter_error": ("larger than stated", "smaller than stated"),
    "stiffening": ("stiffer than Hertz's law", "softer than Hertz's law"), "plate_tilt": ("rising along x", "falling along x"),
    "plate_tilt_y": ("rising along y", "falling along y"),
    "force_bias": READ, "gauge_drift": READ, "zero_drift": READ, "gauge_hysteresis": READ, "position_bias": READ}


def words_of(name: str) -> str:
    """Readable name of an effect, nuisance or observable; unknown names with blanks instead of underscores."""
    if name in SPECIAL_WORDS:
        return SPECIAL_WORDS[name]
    if (effect := find_effect(name)) and effect.words:
        return effect.words
    return one_line(name).replace("_", " ")


def listed(parts: Iterable[str], most: int = 100) -> str:
    """"a, b and c"; if there are more than `most`, the first ones "and N more"."""
    all_parts = list(parts)
    shown = all_parts[:most]
    if len(all_parts) > most:
        return f"{', '.join(shown)} and {len(all_parts) - most} more"
    return " and ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown)


def listed_names(names: Iterable[str], most: int = 100) -> str:
    return listed(map(words_of, names), most)


def _or_infinite(function: Callable[[float], float], x: float) -> float:
    try:
        return function(x)
    except OverflowError:
        return math.inf


def _shown_unit(unit: str) -> tuple[float, str]:
    factor, shown = UNITS.get(unit, (1., one_line(unit)))
    return factor, " " + shown if shown else ""


def _decimals_for(error: float) -> int:
    """Number of decimals that shows the first two digits of `error`."""
    if not 0 < error < math.inf:
        return 12 if error == 0 else 0
    return min(max(1 - math.floor(math.log10(error)), 0), 12)


def amount(value: float, unit: str) -> str:
    """"0.421 mJ/m²": three digits, in a convenient unit. "–" if it is not finite."""
    factor, shown = _shown_unit(unit)
    return f"{value * factor:.3g}{shown}" if math.isfinite(value) else NO_NUMBER


def amount_with_error(value: float, error: float, unit: str, signed: bool = False) -> str:
    """"0.42 ± 0.05 mJ/m²": with as many decimals as the first two digits of the error; `signed`: with a plus sign for positive
    values. "–" if the error is infinite."""
    if not math.isfinite(value) or math.isinf(error):
        return NO_NUMBER
    plus = "+" if signed and value > 0 else ""
    if not error > 0:
        return plus + amount(value, unit)
    factor, shown = _shown_unit(unit)
    decimals = _decimals_for(error * factor)
    return f"{plus}{value * factor:.{decimals}f} ± {error * factor:.{decimals}f}{shown}"


def percent(fraction: float) -> str:
    """"81 %"; "< 1 %" for nonzero values that round to zero."""
    if not math.isfinite(fraction * 100):
        return NO_NUMBER
    if 0 < fraction < 0.005:
        return "< 1 %"
    size = abs(fraction * 100)
    whole = math.floor(size) + (size - math.floor(size) >= 0.5)  # a half is rounded away from zero
    return f"{'-' if fraction < 0 and whole else ''}{whole} %"


def p_number(p: float) -> str:
    """"0.31", "< 0.0001"."""
    return "< 0.0001" if p < 1e-4 else number(p, ".2g")


def p_words(p: float) -> str:
    """"p = 0.004", at most two digits."""
    return ("p " if p < 1e-4 else "p = ") + p_number(p)


def displacement_words(displacement_mm: Pair) -> str:
    """"18 to 24 mm", "18 mm" if both ends are equal, empty if both are zero."""
    first, last = displacement_mm
    if first == last:
        return f"{first:.3g} mm" if first else ""
    return f"{first:.3g} to {last:.3g} mm"


def phase_words(phase: str) -> str:
    """"loading", "unloading", or "both phases" for an empty text."""
    return one_line(phase) + "ing" if phase else "both phases"


def _difference_words(entry: WhereEntry) -> str:
    """"12 % higher than simulated"; with a number only for the magnitude of forces, whose observables are logarithms."""
    is_force = entry.observable in ("top_force", "mean_force") and entry.difference != 0
    size = percent(abs(_or_infinite(math.expm1, entry.difference))) + " " if is_force else ""
    return f"{size}{'higher' if entry.z_score > 0 else 'lower'} than simulated"


def where_words(entry: WhereEntry) -> str:
    """The entry as a phrase: "top force while loading, at a displacement of 18 to 24 mm: 12 % higher than simulated (6.1 sigma, 0.4
    after recalibration)"."""
    text = words_of(entry.observable) + (f" while {phase_words(entry.phase)}" if entry.phase else "")
    text += "".join(f", {words_of(part)}" for part in (entry.region, entry.force_class) if part)
    if displacement := displacement_words(entry.displacement_mm):
        text += f", at a displacement of {displacement}"
    return f"{text}: {_difference_words(entry)} ({entry.z_score:.1f} sigma, {entry.z_score_refitted:.1f} after recalibration)"


def directed_amount(name: str, value: float, error: float, unit: str) -> str:
    """The amplitude with its direction if the sign means one: "0.42 ± 0.05 mJ/m²", "5.0 ± 0.4 % lower than stated"."""
    if name == "modulus" and unit == "relative":  # of the logarithm
        value, error = _or_infinite(math.expm1, value), error * _or_infinite(math.exp, value)
    if name not in DIRECTIONS or value == 0 or not math.isfinite(value) or math.isinf(error):
        return amount_with_error(value, error, unit)
    above, below = DIRECTIONS[name]
    return f"{amount_with_error(abs(value), error, unit)} {above if value > 0 else below}"


def cause_words(cause: Cause) -> str:
    """"adhesion (0.42 ± 0.05 mJ/m²)"."""
    size = directed_amount(cause.effect, cause.amplitude, cause.amplitude_error, cause.unit)
    more = ", or more: it is at the limit of the range tried" if cause.at_limit else ""
    return f"{words_of(cause.effect)} ({size}{more})"


def refinement_words(refinement: Refinement) -> str:
    """"plate.speed = 0.025 m/s instead of 0.1"."""
    unit = f" {refinement.unit}" if refinement.unit else ""
    return one_line(f"{refinement.key} = {refinement.to:.3g}{unit} instead of {refinement.was:.3g}")


def next_words(step: NextStep) -> str:
    """The step, with the predicted probability that it decides."""
    return step.what if step.power is None else f"{step.what} (probability of success: {percent(step.power)})"


def suspect_words(fit: NuisanceFit) -> str:
    """"modulus: 2.30 ± 0.20 kPa higher than stated (4.6 times its stated error)"."""
    times = f" ({abs(fit.sigmas):.1f} times its stated error)" if fit.prior > 0 else ""
    return f"{words_of(fit.name)}: {directed_amount(fit.name, fit.shift, fit.error, fit.unit)}{times}"


def sigma_words(fit: NuisanceFit) -> str:
    """"16 sigma", of its uncertainty; "at least 12 sigma" at the end of the range that is tried."""
    return f"{'at least ' if fit.at_bound else ''}{abs(fit.sigmas):.2g} sigma"


def check_words(fits: Sequence[NuisanceFit]) -> str:
    """"check what is stated: modulus of the grains must be 125 ± 5 % higher than stated to fit (16 sigma); all that follows assumes
    this shift"; empty if there is nothing to check."""
    if not fits:
        return ""
    words = [f"{words_of(fit.name)} must be {directed_amount(fit.name, fit.shift, fit.error, fit.unit)} to fit ({sigma_words(fit)})"
             for fit in fits]
    return f"check what is stated: {listed(words)}; all that follows assumes {'this shift' if len(fits) == 1 else 'these shifts'}"


def missing_name(missing: MissingBins) -> str:
    return words_of(missing.of) if missing.of else "some runs of the scene as it stands"


def _lacking_words(missing: Iterable[MissingBins]) -> str:
    """"adhesion and friction have no value in 4 of 8 bins (50 %)", with all that lack as many."""
    alike: dict[tuple[int, int], list[MissingBins]] = {}
    for one in missing:
        alike.setdefault((one.bins, one.of_bins), []).append(one)
    words = []
    for (bins, of_bins), group in alike.items():
        verb = "have" if len(group) > 1 or not group[0].of else "has"
        words.append(f"{listed(map(missing_name, group))} {verb} no value in {bins} of {of_bins} bins ({percent(group[0].share)})")
    return listed(words)


def missing_words(missing: Sequence[MissingBins]) -> str:
    """"adhesion has no value in 4 of 8 bins (50 %), ..": what lacks bins; empty if nothing does."""
    of_one = _lacking_words(one for one in missing if not one.for_all)
    of_all = _lacking_words(one for one in missing if one.for_all)
    parts = [of_one + ", whose gap counts as not explained by it"] * bool(of_one) + [of_all + ", which are not compared"] * bool(of_all)
    return "; ".join(parts)
