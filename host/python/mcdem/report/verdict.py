"""The words of a verdict, for the text, the page and the figures of a diagnosis."""
from collections.abc import Iterable
from dataclasses import dataclass, replace

from ..diagnosis.diagnosis_types import Cause, Diagnosis, NuisanceFit
from ..diagnosis.mimics import mimics_of
from .diagnosis_words import (amount, cause_words, check_words, listed, listed_names, p_words, percent, refinement_words, sigma_words,
                              suspect_words, words_of)
from .labels import shortened

MOST_LIMITS = 5
MOST_OF_LEGEND = 40  # characters


@dataclass(frozen=True)
class VerdictWords:
    headline: str
    sentence: str
    which: str  # effects consistent with the gap
    limits: str  # what the verdict leaves open, without a full stop
    added: str  # what takes away the gap: "adding adhesion"
    after: str  # the simulation with it: "simulated with adhesion"
    causes_heading: str = "Effects consistent with the gap"
    named: frozenset[str] = frozenset()  # effects that the verdict names


def added_causes(diagnosis: Diagnosis) -> list[Cause]:
    """The effects that the explanation adds: one, or both of a pair; of a group only the leading one."""
    causes = diagnosis.causes
    return [cause for k, cause in enumerate(causes) if k == 0 or cause.effect not in causes[0].group]


def nothing_can_be_named(diagnosis: Diagnosis) -> bool:
    """Whether the data are so few that no reduction would suffice: random effects take away nearly all of the gap, or only a curve is known."""
    return diagnosis.explanation is not None and diagnosis.explanation.needed > 1


def library_words(diagnosis: Diagnosis) -> str:
    """"18 effects were tested"."""
    count = len(diagnosis.detection_limits)
    return f"{count} effect{' was' if count == 1 else 's were'} tested" if count else "no effect could be tested"


def reduction_words(diagnosis: Diagnosis) -> str:
    """"takes away 97 % of the gap", "makes the gap 20 % larger": the reduction on which the verdict depends."""
    if not diagnosis.explanation:
        return "takes away the gap"
    reduction = diagnosis.explanation.reduction
    return f"makes the gap {percent(-reduction)} larger" if reduction < 0 else f"takes away {percent(reduction)} of the gap"


def refined(diagnosis: Diagnosis) -> str:
    """Settings that the diagnosis has refined, as a continuation; empty if there are none."""
    return "".join(f", with {refinement_words(refinement)}" for refinement in diagnosis.refinements if refinement.done)


def suspects_of(diagnosis: Diagnosis) -> list[NuisanceFit]:
    """The leading cause, if it is a parameter; otherwise the parameters at their bounds, largest relative shift first."""
    for leader in diagnosis.causes[:1]:
        if fits := [fit for fit in diagnosis.nuisances if fit.name == leader.effect]:
            return [replace(fit, shift=leader.amplitude, error=leader.amplitude_error, at_bound=True) for fit in fits]
    return sorted((fit for fit in diagnosis.nuisances if fit.at_bound), key=lambda fit: -abs(fit.sigmas))


def verdict_words(diagnosis: Diagnosis) -> VerdictWords:
    words = OF_VERDICT[diagnosis.verdict](diagnosis)
    if not diagnosis.check_first:
        return words
    farthest, *others = diagnosis.check_first
    more = f" and {len(others)} more" if others else ""
    check = check_words(diagnosis.check_first)
    return replace(words, headline=f"Check first: {words_of(farthest.name)} ({sigma_words(farthest)}){more}. {words.headline}",
                   sentence=f"C{check[1:]}. {words.sentence}")


def _leader_of(diagnosis: Diagnosis) -> Cause | None:
    return next(iter(diagnosis.causes or diagnosis.ranking), None)


def _together_with(diagnosis: Diagnosis) -> str:
    """A second effect that acts together with the leading one, as a continuation; empty if there is none."""
    others = added_causes(diagnosis)[1:]
    return f" together with {listed(map(cause_words, others))}" if others else ""


def _of_an_effect(diagnosis: Diagnosis, headline: str, sentence: str, which: str,
                  limits: str = "consistent is not proven: an effect outside the library may look the same") -> VerdictWords:
    added = added_causes(diagnosis)
    names = listed_names(cause.effect for cause in added) if added else "the effect"
    return VerdictWords(headline, sentence, which, limits, f"adding {names}",
                        shortened(f"simulated with {'both effects' if len(added) > 1 else names}", MOST_OF_LEGEND))


def _no_gap(diagnosis: Diagnosis) -> VerdictWords:
    rank = {cause.effect: place for place, cause in reversed(list(enumerate(diagnosis.ranking)))}
    limits = sorted(diagnosis.detection_limits, key=lambda limit: rank.get(limit.effect, len(rank)))
    shown = [f"{words_of(limit.effect)} from {amount(limit.minimum_amplitude, limit.unit)}" for limit in limits if limit.is_finite]
    return _of_an_effect(
        diagnosis, "No detectable gap", f"No gap is detectable{refined(diagnosis)} ({p_words(diagnosis.gap.p_value)}).",
        "no effect is needed.",
        f"smaller ones may be there: in four of five cases these data would show {listed(shown, MOST_LIMITS)}" if shown else
        "smaller effects than these data can show may be there")


def _taken_away(diagnosis: Diagnosis, added: str) -> str:
    """The reduction of the named explanation, as a continuation."""
    explanation = diagnosis.explanation
    return f"; adding {added} takes away {percent(explanation.reduction)} of the gap" if explanation else ""


def _or_alike(diagnosis: Diagnosis) -> str:
    """What acts like the effects that are added but is in no library, as a continuation; empty if nothing is known."""
    alike = dict.fromkeys(mimic.what for cause in added_causes(diagnosis) for mimic in mimics_of(cause.effect))
    return f", or with something that acts like {'them' if len(added_causes(diagnosis)) > 1 else 'it'}: {'; '.join(alike)}" if alike else ""


def _effect(diagnosis: Diagnosis) -> VerdictWords:
    leader, together = _leader_of(diagnosis), _together_with(diagnosis)
    name = cause_words(leader) if leader else "one effect"
    added = "both" if len(added_causes(diagnosis)) > 1 else "it"
    which = (f"consistent with {name}{together}, with a probability of {percent(leader.confidence)} ({library_words(diagnosis)})"
             f"{_or_alike(diagnosis)}.") if leader else "no effect is named."
    return replace(_of_an_effect(
        diagnosis, f"A gap; {'a pair of effects' if together else 'one effect'} {reduction_words(diagnosis)}",
        f"The gap is consistent with {name}{together}{_taken_away(diagnosis, added)}.", which), named=_names(diagnosis.causes))


def _names(causes: Iterable[Cause]) -> frozenset[str]:
    return frozenset(cause.effect for cause in causes)


def _group(diagnosis: Diagnosis) -> VerdictWords:
    leader, together = _leader_of(diagnosis), _together_with(diagnosis)
    members = leader.group if leader else ()
    known = {cause.effect: cause_words(cause) for cause in reversed((*diagnosis.causes, *diagnosis.ranking))}
    listed_members = listed(known.get(name) or words_of(name) for name in members)
    which = f"consistent with any of {listed_members}{together}; these data cannot tell them apart{_or_alike(diagnosis)}." if leader else "no effect is named."
    names = listed_names(members) if leader else "several effects"
    return replace(_of_an_effect(
        diagnosis, f"A gap; one of several effects {reduction_words(diagnosis)}",
        f"The gap is consistent with any of {names}, which these data cannot tell apart{_taken_away(diagnosis, 'the first of them')}.",
        which), named=_names(diagnosis.causes))


def _needed_words(diagnosis: Diagnosis) -> str:
    """The reduction required to name an effect, as a continuation."""
    explanation = diagnosis.explanation
    if not explanation or explanation.reduction < 0:
        return ""
    if explanation.placebo > 0.5:
        return f", but random effects (placebo) take away up to {percent(explanation.placebo)}"
    if nothing_can_be_named(diagnosis):
        return ", as other effects may do that these data cannot tell from it"
    needed = percent(explanation.needed)
    return ", a little less than is needed to name it" if needed == percent(explanation.reduction) else \
        f", and {needed} would be needed to name it"


def _unknown_effect(diagnosis: Diagnosis) -> VerdictWords:
    few, library, best = nothing_can_be_named(diagnosis), library_words(diagnosis), _leader_of(diagnosis)
    reduction = reduction_words(diagnosis)
    which = f"{'these data cannot tell an effect from chance' if few else 'no tested effect explains it'} ({library})"
    if best and diagnosis.explanation:
        which += (f"; the best one, {cause_words(best)}{_together_with(diagnosis)}, has a probability of {percent(best.confidence)}: "
                  f"it {reduction}{_needed_words(diagnosis)}")
    return replace(_of_an_effect(
        diagnosis, "A gap whose cause these data cannot tell" if few else "A gap that no tested effect explains",
        f"There is a gap {'whose cause these data cannot tell' if few else 'that no tested effect explains'} ({library})"
        f"{f'; the best one {reduction}' if diagnosis.explanation else ''}.",
        which + ".", "an unknown effect, or several at once, may be the cause"), causes_heading="What comes nearest")


def _not_converged(diagnosis: Diagnosis) -> VerdictWords:
    leader = _leader_of(diagnosis)
    to_refine = next((f"; set {refinement_words(refinement)}" for refinement in diagnosis.refinements if not refinement.done), "")
    return VerdictWords(
        "The simulation is not converged", f"The gap is consistent with a simulation that is not converged{to_refine}.",
        "consistent with a numerical error of the simulation, which must be removed before an effect is named: "
        f"{words_of(leader.effect) if leader else 'a setting'}{_together_with(diagnosis)}{to_refine}.",
        "an effect that looks like this setting would give the same data, and must be distinguished from it first",
        "refining the setting", "simulated, refined")


def _calibration_suspect(diagnosis: Diagnosis) -> VerdictWords:
    suspects = listed(map(suspect_words, suspects_of(diagnosis)))
    suspects = f": {suspects}" if suspects else ""
    alike = [name for leader in diagnosis.causes[:1] for name in leader.group if name != leader.effect]
    not_told_from = f", which these data cannot tell from {listed_names(alike)}" if alike else ""
    return VerdictWords(
        "A stated parameter is suspect", f"The gap is consistent with an error of a stated parameter{suspects}.",
        "consistent with an error of a stated parameter, which must be excluded before an effect is named"
        f"{suspects}{not_told_from}.",
        "an effect that looks like this parameter would give the same data", "correcting the parameter", "simulated, recalibrated")


OF_VERDICT = {"no_gap": _no_gap, "effect": _effect, "group": _group, "unknown_effect": _unknown_effect, "not_converged": _not_converged,
              "calibration_suspect": _calibration_suspect}
