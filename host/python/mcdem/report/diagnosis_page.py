"""A diagnosis on a page: verdict, charts, tables and provenance."""
import pathlib
from collections.abc import Iterable, Sequence
from math import isfinite

from ..diagnosis.diagnosis_types import Diagnosis, WhereEntry
from ..diagnosis.effects import find_effect
from ..observe.observables import observables
from .diagnosis_charts import diagnosis_charts
from .diagnosis_text import how_far_line, strongest_first, verdict_lines
from .diagnosis_words import (amount, amount_with_error, displacement_words, listed, listed_names, missing_name, next_words, p_number,
                              p_words, percent, phase_words, words_of)
from .labels import NO_NUMBER, number
from .page import Page
from .text_table import TextTable, table_of
from .verdict import verdict_words

MOST_ROWS = 20  # of "where"

# Metrics of the paper.
MEANINGS = {
    "Rtop": "force on the plate at full stroke, simulated over measured",
    "errf": "root mean square error of the force on the plate over the cycle",
    "errZ": "root mean square error of the coordination number over the cycle, contacts below a force left out that makes it smallest",
    "bhat": "difference between the distributions of contact forces: -ln of the mean of Bhattacharyya's coefficient"}


def add_diagnosis(page: Page, diagnosis: Diagnosis, name: str = "") -> None:
    """Adds everything. `name` distinguishes several diagnoses on a page; empty for a single one."""
    words = verdict_words(diagnosis)
    page.lead("Diagnosis of the gap between simulation and experiment" + (f": {name}" if name else ""), words.headline, words.sentence)
    page.definitions(verdict_lines(diagnosis))
    charts = {chart.name: chart for chart in diagnosis_charts(diagnosis)}

    def add_charts(*names: str) -> None:
        for one in names:
            if one in charts:
                page.chart(charts[one])

    _add_gap(page, diagnosis)
    page.section("Where")
    add_charts("where")
    page.table("What stands out", _where(diagnosis))
    page.section("Which")
    add_charts("which")
    page.table(words.causes_heading, _causes(diagnosis))
    add_charts("law")
    page.table("What these data can show", _detection_limits(diagnosis))
    page.section("How far")
    if not diagnosis.shrink:
        page.paragraph(how_far_line(diagnosis))
    add_charts("how_far", "gap_left")
    page.table("Before and after", _gap_reduction(diagnosis))
    _add_rest(page, diagnosis)


def diagnosis_page(diagnosis: Diagnosis) -> Page:
    """A page with only this diagnosis."""
    page = Page("Diagnosis: " + verdict_words(diagnosis).headline)
    add_diagnosis(page, diagnosis)
    return page


def write_diagnosis_page(diagnosis: Diagnosis, file: str | pathlib.Path) -> None:
    """Raises InputError if there is a file that is no page of mcdem, and RunError if it cannot be written."""
    diagnosis_page(diagnosis).write(file)


def _add_gap(page: Page, diagnosis: Diagnosis) -> None:
    page.section("Gap")
    gap = diagnosis.gap
    page.paragraph(
        "Two tests, each ranked against simulated experiments without a gap: one for any difference "
        f"({p_words(gap.p_omnibus)}), one for differences along the tested effects ({p_words(gap.p_directed)}). The smaller p, with "
        f"Bonferroni correction for two tests: {p_words(gap.p_value)}.")
    page.table("Packing by packing", _packings(diagnosis))


def _add_rest(page: Page, diagnosis: Diagnosis) -> None:
    content: dict[str, TextTable | Sequence[str]] = {
        "What to do next": [next_words(step) for step in diagnosis.next], "Uncertain parameters": _nuisances(diagnosis),
        "Bins without a value": _missing_bins(diagnosis), "What was not measured": diagnosis.not_measured,
        "What cannot be tested": diagnosis.not_testable, "What the effects are": _effects(diagnosis),
        "What the observables are": _observables(diagnosis), "Provenance": _provenance(diagnosis)}
    for heading, one in content.items():
        if isinstance(one, TextTable) and one.rows:
            page.section(heading)
            page.table("", one)
        elif one and not isinstance(one, TextTable):
            page.section(heading)
            page.list(one)


def _packings(diagnosis: Diagnosis) -> TextTable:
    """Each of several packings separately; no rows for a single one."""
    leader = diagnosis.causes[:1]
    return table_of(
        ["<packing", "p of its gap", *(f"{words_of(cause.effect)} from this packing" for cause in leader),
         "p of its difference from the others"],
        ([packing.experiment, p_number(packing.gap_p),
          *(amount_with_error(packing.amplitude, packing.amplitude_error, cause.unit) for cause in leader),
          p_number(packing.agreement_p) + " *" * packing.differs] for packing in diagnosis.packings),
        ["*: differs from the others by more than noise"])


def _part_words(entry: WhereEntry) -> str:
    region = [words_of(entry.region)] if entry.region else []
    return listed(region + ([f"{words_of(entry.force_class)} forces"] if entry.force_class else [])) or "all"


def _where(diagnosis: Diagnosis) -> TextTable:
    """Significant parts of the data, strongest first."""
    entries = strongest_first(diagnosis.where)
    left_out = len(entries) - MOST_ROWS
    return table_of(
        ["<observable", "<part of it", "<phase", "plate displacement", "sigma", "after recalibration"],
        ([words_of(entry.observable), _part_words(entry), phase_words(entry.phase), displacement_words(entry.displacement_mm),
          number(entry.z_score, ".1f"), number(entry.z_score_refitted, ".1f")] for entry in entries[:MOST_ROWS]),
        [f"and {left_out} more, in diagnosis.json"] if left_out > 0 else [])


def _others(group: Iterable[str], effect: str) -> str:
    """The group without the effect itself, in words."""
    others = [name for name in group if name != effect]
    return listed_names(others) if others else NO_NUMBER


def _causes(diagnosis: Diagnosis) -> TextTable:
    return table_of(
        ["<effect", "amplitude", "probability", "part of chi-square", "gain in log likelihood", "gain in full simulations",
         "<indistinguishable from"],
        ([words_of(cause.effect), amount_with_error(cause.amplitude, cause.amplitude_error, cause.unit), percent(cause.confidence),
          percent(cause.explained), number(cause.score, ".1f"),
          NO_NUMBER if cause.confirmed_score is None else number(cause.confirmed_score, ".1f"), _others(cause.group, cause.effect)]
         for cause in diagnosis.causes))


def _detection_limits(diagnosis: Diagnosis) -> TextTable:
    return table_of(
        ["<effect", "smallest detectable amplitude", "absorbed by calibration", "<indistinguishable at twice that amplitude from"],
        ([words_of(limit.effect), amount(limit.minimum_amplitude, limit.unit) if limit.is_finite else "not detectable",
          percent(limit.absorbed_by_calibration), _others(limit.group, limit.effect)] for limit in diagnosis.detection_limits))


def _gap_reduction(diagnosis: Diagnosis) -> TextTable:
    """Gap and metrics before and after; empty without a gap reduction."""
    shrink = diagnosis.shrink
    if not shrink:
        return table_of([], [])
    changes = [("gap, noise subtracted", (shrink.before, shrink.after), "0")]
    changes += [("errf [N]" if name == "errf" else name, values, "1" if name == "Rtop" else "0") for name, values in shrink.metrics.items()]
    return table_of(
        ["<", "before", "after", "perfect"], ([words, number(before), number(after), best] for words, (before, after), best in changes),
        ["gap: sum of squared differences in held-out data, in standard deviations of the noise",
         *(f"{name}: {MEANINGS[name]}" for name in shrink.metrics if name in MEANINGS)])


def _nuisances(diagnosis: Diagnosis) -> TextTable:
    first = "to be checked first: with the effects above" if diagnosis.causes else "to be checked first"
    fits = [(fit, first, number(fit.sigmas, "+.1f")) for fit in diagnosis.check_first]
    fits += [(fit, "more than 2.5 times its uncertainty, without an effect" if fit.at_bound else "",
              number(fit.sigmas, "+.1f") if fit.prior > 0 else NO_NUMBER) for fit in diagnosis.nuisances]
    return table_of(
        ["<parameter", "shift from the scene", "uncertainty", "shift / uncertainty", "<remark"],
        ([words_of(fit.name), amount_with_error(fit.shift, fit.error, fit.unit, signed=True), f"± {amount(fit.prior, fit.unit)}", sigmas,
          remark] for fit, remark, sigmas in fits),
        ["shifts are fitted without any effect unless the remark says otherwise"])


def _missing_bins(diagnosis: Diagnosis) -> TextTable:
    """What lacks values that the experiment has."""
    return table_of(
        ["<what", "bins without a value", "of", "part", "<consequence"],
        ([missing_name(missing), str(missing.bins), str(missing.of_bins), percent(missing.share),
          "nothing is compared there" if missing.for_all else "their gap counts as not explained by it"]
         for missing in diagnosis.missing_bins))


def _effects(diagnosis: Diagnosis) -> TextTable:
    """Meanings of the candidates' amplitudes."""
    return table_of(["<effect", "<amplitude", "<source"],
                  ([words_of(cause.effect), effect.formula, effect.source] for cause in diagnosis.ranking
                   if (effect := find_effect(cause.effect))))


def _observables(diagnosis: Diagnosis) -> TextTable:
    """Meanings of the rows of the figure."""
    shown = {bin.observable for bin in diagnosis.cells}
    return table_of(["<observable", "<what it is"], ([words_of(one.name), one.meaning] for one in observables() if one.name in shown))


def _provenance(diagnosis: Diagnosis) -> TextTable:
    return table_of(["<what", "<"], [*([words_of(key), value] for key, value in sorted(diagnosis.provenance.items())),
                                   ["time taken", f"{diagnosis.seconds:.0f} s" if isfinite(diagnosis.seconds) else NO_NUMBER]])
