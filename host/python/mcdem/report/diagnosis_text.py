"""A diagnosis in a few lines, and which of its values stand out."""
from math import inf, isfinite

from ..diagnosis.diagnosis_types import Diagnosis, Explanation, WhereBin, WhereEntry
from .diagnosis_words import check_words, listed, listed_names, missing_words, next_words, p_words, percent, where_words, words_of
from .labels import one_line, shortened
from .verdict import MOST_LIMITS, reduction_words, refined, verdict_words

MOST_OF_REMARK = 160  # characters
MOST_PLACES = 2
SAME_DISPLACEMENT_MM = 0.01  # displacements with a smaller difference are the same


def verdict_lines(diagnosis: Diagnosis) -> list[tuple[str, str]]:
    """What is said about what: First (parameters to check before anything else, if there are any), Gap, Where, Which, How far, Limits
    and Next."""
    first = [("First", check_words(diagnosis.check_first) + ".")] if diagnosis.check_first else []
    return first + [("Gap", _gap_line(diagnosis)), ("Where", where_line(diagnosis)), ("Which", verdict_words(diagnosis).which),
                    ("How far", how_far_line(diagnosis)), ("Limits", _limits_line(diagnosis)), ("Next", _next_line(diagnosis))]


def diagnosis_text(diagnosis: Diagnosis) -> str:
    """These lines, aligned, each with a line feed."""
    return "".join(f"{about + ':':<9}{says}\n" for about, says in verdict_lines(diagnosis))


def _sentence(text: str) -> str:
    return text.rstrip(".") + "."


def _differing_packings(diagnosis: Diagnosis) -> list[str]:
    return [one_line(packing.experiment) for packing in diagnosis.packings if packing.differs]


def _packings_words(diagnosis: Diagnosis) -> str:
    """Agreement of the packings, as a continuation; empty for a single packing."""
    count, differing = len(diagnosis.packings), _differing_packings(diagnosis)
    if not count:
        return ""
    agreement = f"of which {listed(differing)} differs from the others by more than noise"
    if not differing:
        agreement = "which agree"
    elif len(differing) == count:
        agreement = "which differ from one another by more than noise"
    return f"; {count} packings together, {agreement}"


def _gap_line(diagnosis: Diagnosis) -> str:
    gap, packings, refinements = diagnosis.gap, _packings_words(diagnosis), refined(diagnosis)
    if gap.detected:
        return (f"yes: simulation and experiment differ by more than noise and calibration account for{refinements} "
                f"({p_words(gap.p_value)}){packings}.")
    at_one_place = gap.p_value > 2 * min(gap.p_omnibus, gap.p_directed)
    reason = "they differ at one displacement only, where grains may have rearranged" if at_one_place else \
        "noise alone gives differences like these"
    return f"none that these data show{refinements}: {reason} ({p_words(gap.p_value)}){packings}."


def strongest_first(entries: tuple[WhereEntry, ...]) -> list[WhereEntry]:
    return sorted(entries, key=lambda entry: -abs(entry.z_score) if isfinite(entry.z_score) else inf)


def _is_within(bin: WhereBin, entry: WhereEntry) -> bool:
    first, last = entry.displacement_mm
    return (bin.observable == entry.observable and entry.phase in ("", bin.phase)
            and first - SAME_DISPLACEMENT_MM <= bin.displacement_mm <= last + SAME_DISPLACEMENT_MM)


def stands_out(diagnosis: Diagnosis, bin: WhereBin, refitted: bool) -> bool:
    """Whether "where" frames the bin. Where the threshold is not known, the bins of the entries stand out before recalibration, and
    none after."""
    if diagnosis.where_threshold > 0:
        return abs(bin.z_score_refitted if refitted else bin.z_score) >= diagnosis.where_threshold
    return not refitted and any(_is_within(bin, entry) for entry in diagnosis.where)


def _framed_line(diagnosis: Diagnosis) -> str:
    """Without entries: single bins beyond the threshold, so that the text agrees with the figure."""
    refitted = [bin.z_score_refitted for bin in diagnosis.cells if isfinite(bin.z_score_refitted) and stands_out(diagnosis, bin, True)]
    framed = [(z, bin) for bin in diagnosis.cells for z in [bin.z_score_refitted if refitted else bin.z_score]
              if isfinite(z) and stands_out(diagnosis, bin, bool(refitted))]
    if not framed:
        return "no single value stands out from the noise."
    z, strongest = max(framed, key=lambda one: abs(one[0]))
    end = "" if refitted and diagnosis.gap.detected else "; with this many values, chance alone can give that"
    return (f"{len(framed)} of {len(diagnosis.cells)} values {'is' if len(framed) == 1 else 'are'} beyond "
            f"{diagnosis.where_threshold:.1f} sigma {'after recalibration' if refitted else 'with the parameters as stated'} "
            f"(largest: {words_of(strongest.observable)}, {z:.1f} sigma){end if refitted else ', and none after recalibration'}.")


def where_line(diagnosis: Diagnosis) -> str:
    """The strongest entry of each observable, a few of them."""
    if not diagnosis.where:
        return _framed_line(diagnosis)
    strongest: dict[str, WhereEntry] = {}
    for entry in strongest_first(diagnosis.where):
        strongest.setdefault(entry.observable, entry)
    left_out = len(strongest) - MOST_PLACES
    more = f"; and {left_out} more observable{'' if left_out == 1 else 's'}" if left_out > 0 else ""
    return "; ".join(where_words(entry) for entry in list(strongest.values())[:MOST_PLACES]) + more + "."


def _remainder_words(explanation: Explanation) -> str:
    """"3 % of the gap remains unexplained (p = 0.0004)"."""
    if not explanation.leaves_more_than_noise:
        without = f", except at {one_line(explanation.without)}, where grains may have rearranged" if explanation.without else ""
        return f"the remainder cannot be distinguished from noise{without}"
    left = explanation.remainder
    return f"{'all' if left >= 1 else percent(max(0, left))} of the gap remains unexplained ({p_words(explanation.remainder_p)})"


def _data_words(diagnosis: Diagnosis, explanation: Explanation) -> str:
    if not explanation.held_out:
        return " (of the whole gap: the held-out data alone show none)"
    which = shortened(one_line(diagnosis.shrink.held_out), MOST_OF_REMARK) if diagnosis.shrink else ""
    return f" in held-out data{f' ({which})' if which else ''}"


def how_far_line(diagnosis: Diagnosis) -> str:
    """How much of the gap is explained."""
    explanation, shrink = diagnosis.explanation, diagnosis.shrink
    if not explanation:
        return "there is nothing to explain." if diagnosis.verdict == "no_gap" else "not known: nothing was tried."
    text = (f"{verdict_words(diagnosis).added} {reduction_words(diagnosis)}{_data_words(diagnosis, explanation)}, "
            f"{'from full simulations' if explanation.simulated else 'estimated from signatures'}; "
            f"random effects (placebo) take away at most {percent(explanation.placebo)}; {_remainder_words(explanation)}")
    if diagnosis.check_first:
        text += ", with the shifts of parameters under First"
    if shrink and shrink.before > 0 and explanation.held_out:
        low, high = shrink.interval
        text += f"; the signatures had predicted {percent(shrink.fraction)} (90 % interval: {low * 100:.0f} to {percent(high)})"
    return text + "."


def _limits_line(diagnosis: Diagnosis) -> str:
    parts = [verdict_words(diagnosis).limits.rstrip(".")]
    if _differing_packings(diagnosis):
        parts.append("a difference between packings is not an effect that acts on all of them")
    if never := [limit.effect for limit in diagnosis.detection_limits if not limit.is_finite]:
        parts.append(f"these data can never show {listed_names(never, MOST_LIMITS)}")
    if missing := missing_words(diagnosis.missing_bins):
        parts.append(missing)
    if diagnosis.not_measured:
        parts.append(f"not measured: {shortened(one_line(diagnosis.not_measured[0]), MOST_OF_REMARK)}")
    return _sentence("; ".join(parts))


def _next_line(diagnosis: Diagnosis) -> str:
    if not diagnosis.next:
        return "no measurement whose benefit can be predicted would help."
    return _sentence("; ".join(one_line(next_words(step)) for step in diagnosis.next))
