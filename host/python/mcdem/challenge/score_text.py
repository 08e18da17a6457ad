"""The score of a challenge as tables for the terminal, score.md and score.json."""
import json
from dataclasses import fields
from typing import Any

from ..diagnosis.decision import Limits
from ..outputs import Kind
from ..report.text_table import Column, TextTable, to_text
from .limits import Bars, named_limits
from .merits import Merits, Share
from .score import ArmScore, ChallengeScore

SCORE = Kind("the score of a challenge", b'{\n "cases"', b'"not_diagnosed"')
SCORE_PAGE = Kind("the score of a challenge", b"# Score of the challenge\n")


def _met(is_met: bool) -> str:
    return "yes" if is_met else "NO"


def _short(share: Share | None) -> str:
    return f"{share.hits}/{share.of}" if share and share.of > 0 else "-"


def _share_row(name: str, arm: ArmScore, merit: str, required: str = "", is_met: bool = False) -> list[str]:
    second: Share = getattr(arm.second, merit)
    return [name, str(second), required, _met(is_met) if required and second.of > 0 else "", str(getattr(arm.first, merit))]


def _barred_row(name: str, arm: ArmScore, merit: str, is_upper: bool) -> list[str]:
    """Of a share that has a target."""
    bar, share = getattr(Bars(), merit), getattr(arm.second, merit).value()
    return _share_row(name, arm, merit, f"at {'most' if is_upper else 'least'} {100 * bar:.0f} %", share <= bar if is_upper else share >= bar)


def _number_row(name: str, first: float, second: float, required: str, is_met: bool) -> list[str]:
    return [name, f"{second:.2f}", required, _met(is_met), f"{first:.2f}"]


def _gap_reduction_rows(score: ChallengeScore) -> list[list[str]]:
    reduction = score.gap_reduction
    return [["gap reduction: median |predicted - simulated|", f"{reduction.median_error:.2f}", "at most 0.10",
             _met(reduction.median_error <= 0.10), f"{reduction.cases} cases, all"],
            ["gap reduction: simulated within the 90 % interval", str(reduction.covered), "at least 80 %",
             _met(reduction.covered.value() >= 0.80), "all"]] if reduction.cases else []


def base_rate_brier(merits: Merits, rate: float) -> float:
    """Mean square error of always stating the share of the other half."""
    right = merits.right_leaders.value()
    return right * (1 - rate)**2 + (1 - right) * rate**2


def table_of_merits(score: ChallengeScore) -> TextTable:
    """Figures of merit of the whole method with 95 % intervals and targets, for both halves."""
    arm = score.arms[0]
    first, second, group_size = arm.first, arm.second, Bars().group_size
    base = base_rate_brier(second, first.right_leaders.value())
    return TextTable(
        [Column("figure of merit", "left"), Column("scored half", "left"), Column("required", "left"), Column("met"),
         Column("half used to set limits", "left")],
        [_barred_row("no effect: a gap is claimed", arm, "false_alarms", True),
         _share_row("one effect: detected", arm, "detected"),
         _share_row("one effect, 1.5 limits or more: detected", arm, "detected_clear"),
         _barred_row(".. of these detected: named first", arm, "led_by_truth", False),
         _barred_row(".. of these detected: in the group named", arm, "truth_in_group", False),
         _number_row(".. of these detected: mean size of the group", first.group_size, second.group_size, f"at most {group_size}",
                     second.group_size <= group_size),
         _barred_row("effect outside the library: an effect is named", arm, "named_unknown", True),
         _barred_row("parameter far outside its uncertainty: an effect is named", arm, "named_outside_prior", True),
         _share_row(".. : verdict calibration_suspect", arm, "suspected"),
         _share_row("two effects: named first is one of them", arm, "pair_led"),
         _share_row("two effects: both named", arm, "pair_found"),
         _number_row("Brier score of the probabilities of all leading effects", first.brier, second.brier,
                     f"less than the base rate's {base:.2f}", second.brier < base),
         *_gap_reduction_rows(score)],
        ["95 % intervals after Wilson (1927). Limits were set on one half of the packings and scored on the other half."])


def table_of_arms(score: ChallengeScore) -> TextTable:
    """All methods on the scored half."""
    titles = ("false alarms", "detected", "named, of all", "named first, clear", "in group, clear", "group size", "unknown named",
              "outside prior named", "pairs found", "Brier")
    rows = [[arm.name, *map(_short, (m.false_alarms, m.detected, m.named, m.led_by_truth, m.truth_in_group)), f"{m.group_size:.2f}",
             *map(_short, (m.named_unknown, m.named_outside_prior, m.pair_found)), f"{m.brier:.3f}"]
            for arm in score.arms for m in (arm.second,)]
    notes = [f"{arm.name}: {arm.meaning}" + (", its limits set on the first half" if arm.limits else "") for arm in score.arms]
    return TextTable([Column("method", "left"), *map(Column, titles)], rows,
                     [*notes, "clear: 1.5 detection limits of the whole method or more, and detected"])


def _table_of_effects(score: ChallengeScore) -> TextTable:
    merits = score.arms[0].second
    return TextTable([Column("effect", "left"), Column("detected"), Column("named first")],
                     [[effect, _short(share), _short(merits.named_by_effect[effect])]
                      for effect, share in sorted(merits.detected_by_effect.items())])


def _table_of_unknown(score: ChallengeScore) -> TextTable:
    """Cases with unknown effects in which an effect was named, by unknown effect."""
    first, second = score.arms[0].first.named_by_unknown, score.arms[0].second.named_by_unknown
    return TextTable([Column("outside the library", "left"), Column("an effect is named, scored half"), Column("other half")],
                     [[name, _short(share), _short(first.get(name))] for name, share in sorted(second.items())])


def _table_of_limits(score: ChallengeScore) -> TextTable:
    """Limits set with the first half, and the defaults."""
    limits, defaults = named_limits(score.arms[0].limits or Limits()), named_limits(Limits())
    return TextTable([Column("limit", "left"), Column("set"), Column("default")],
                     [[name, f"{value:g}", f"{defaults[name]:g}"] for name, value in limits.items()])


def score_markdown(score: ChallengeScore) -> str:
    text = f"# Score of the challenge\n\n{score.cases} cases.\n"
    for title, table in (("Figures of merit", table_of_merits), ("Methods, on the scored half", table_of_arms),
                         ("By effect, on the scored half", _table_of_effects), ("Unknown effects", _table_of_unknown),
                         ("Limits", _table_of_limits)):
        text += f"\n## {title}\n\n{to_text(table(score), markdown=True)}\n"
    if score.not_diagnosed:
        text += "\n## Not diagnosed\n\n" + "".join(f"- {problem}\n" for problem in score.not_diagnosed)
    return text


def _json_of(value: float | Share | dict[str, Share]) -> Any:
    if isinstance(value, Share):
        return {"hits": value.hits, "of": value.of, "share": value.value() if value.of > 0 else None, "interval": value.interval()}
    if isinstance(value, dict):
        return {name: _json_of(share) for name, share in sorted(value.items())}
    return value


def _merits_json(merits: Merits) -> dict[str, Any]:
    return {part.name: _json_of(getattr(merits, part.name)) for part in fields(Merits)}


def score_json(score: ChallengeScore) -> str:
    arms = [{"name": arm.name, "meaning": arm.meaning, "limits": named_limits(arm.limits) if arm.limits else None,
             "first_half": _merits_json(arm.first), "scored_half": _merits_json(arm.second)} for arm in score.arms]
    reduction = score.gap_reduction
    shrink = {"cases": reduction.cases, "median_error": reduction.median_error, "covered": _json_of(reduction.covered)}
    return json.dumps({"cases": score.cases, "not_diagnosed": score.not_diagnosed, "shrink": shrink, "methods": arms}, indent=1,
                      ensure_ascii=False) + "\n"
