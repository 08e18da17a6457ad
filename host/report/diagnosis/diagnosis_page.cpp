#include "report/diagnosis/diagnosis_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "diagnose/infer/effects.h"
#include "diagnose/observe/scan_observables.h"
#include "report/diagnosis/diagnosis_tables.h"
#include "report/diagnosis/diagnosis_text.h"
#include "report/diagnosis/diagnosis_values.h"
#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline report {
namespace {

void add_gap(Page& page, const Diagnosis& diagnosis) {
    page.section("Gap");
    page.paragraph(
        fmt::format("Two tests, each ranked against simulated experiments without any gap: one of all "
                    "differences together ({}), one along the known effects ({}). Corrected for there "
                    "being two: {}.",
                    p_words(diagnosis.p_omnibus), p_words(diagnosis.p_directed), p_words(diagnosis.p_value)));
    page.table("Packing by packing", table_of_packings(diagnosis));
}

/// Meanings of the rows of the figure.
TextTable table_of_observables(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"observable", Align::left}, {"what it is", Align::left}};
    for (const auto& observable : observables()) {
        const auto is_it = [&](const WhereCell& cell) { return cell.observable == observable.name; };
        if (std::any_of(diagnosis.cells.begin(), diagnosis.cells.end(), is_it))
            table.rows.push_back({words_of(std::string(observable.name)), std::string(observable.meaning)});
    }
    return table;
}

/// Meanings of the candidates' amplitudes.
TextTable table_of_effects(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"effect", Align::left}, {"amplitude", Align::left}, {"source", Align::left}};
    for (const auto& cause : diagnosis.ranking)
        if (const auto* effect = find_effect(cause.effect))
            table.rows.push_back(
                {words_of(cause.effect), std::string(effect->formula), std::string(effect->source)});
    return table;
}

void add_charts(Page& page, const std::vector<Chart>& charts, std::initializer_list<std::string_view> names) {
    for (const auto& chart : charts)
        if (std::ranges::find(names, chart.name) != names.end()) page.chart(chart);
}

void add_table(Page& page, const std::string& heading, const TextTable& table) {
    if (table.rows.empty()) return;
    page.section(heading);
    page.table("", table);
}

void add_list(Page& page, const std::string& heading, const std::vector<std::string>& texts) {
    if (texts.empty()) return;
    page.section(heading);
    page.list(texts);
}

// [pixels]
constexpr int where_height = 120, where_row = 22, where_width = 300, where_column = 60;
constexpr int which_height = 100, which_row = 26, gap_height = 110, gap_row = 36;

int count(const Json& list) { return static_cast<int>(list.size()); }

Chart where_chart(const Diagnosis& diagnosis, const Json& values) {
    std::string caption =
        "Orange: the experiment lies above the simulation, blue: below. Time runs from left to right. Left: "
        "parameters as stated; right: after they were fitted within their uncertainty.";
    if (diagnosis.where_threshold > 0)
        caption += fmt::format(" Framed: beyond {:.1f} sigma, which noise alone seldom reaches in any cell.",
                               diagnosis.where_threshold);
    return {.name = "where",
            .title = "Where simulation and experiment differ",
            .caption = caption,
            .values = values,
            .height = where_height + where_row * count(values["observables"]),
            .min_width = where_width + where_column * count(values["columns"])};
}

Chart which_chart(const Diagnosis& diagnosis, Json values) {
    for (std::size_t i = 0; i < diagnosis.ranking.size(); ++i)
        values["rows"][i]["explained"] = percent(diagnosis.ranking[i].explained);
    return {.name = "which",
            .title = "Candidate effects",
            .caption =
                "Left: how much better the data are explained with each effect, parameters fitted again in "
                "both cases; diamonds: simulated in full at the fitted amplitude; candidates that share a "
                "letter cannot be told apart by these data. Middle: amplitudes with 90 % intervals, over the "
                "smallest that these data can detect (dashed line); without a dot: never shows. Right: "
                "amplitude with one standard error, probability among the candidates.",
            .values = values,
            .height = which_height + which_row * count(values["rows"]),
            .min_width = 760};
}

}  // namespace

void add_diagnosis(Page& page, const Diagnosis& diagnosis, const std::string& name) {
    page.lead("Diagnosis of the gap between simulation and experiment" + (name.empty() ? "" : ": " + name),
              verdict_headline(diagnosis), verdict_sentence(diagnosis));
    std::vector<std::pair<std::string, std::string>> lines;
    for (const auto& [about, says] : verdict_lines(diagnosis)) lines.emplace_back(about, says);
    page.definitions(lines);
    add_gap(page, diagnosis);
    const auto charts = diagnosis_charts(diagnosis);
    page.section("Where");
    add_charts(page, charts, {"where"});
    page.table("What stands out", table_of_where(diagnosis));
    page.section("Which");
    add_charts(page, charts, {"which"});
    page.table(diagnosis.verdict == Verdict::unknown_effect ? "What comes nearest"
                                                            : "Effects consistent with the gap",
               table_of_causes(diagnosis));
    page.table("What these data can show", table_of_detection_limits(diagnosis));
    page.section("How far");
    if (!diagnosis.gap_reduction) page.paragraph(verdict_lines(diagnosis)[3].says);
    add_charts(page, charts, {"how_far", "gap_left"});
    page.table("Before and after", table_of_gap_reduction(diagnosis));
    std::vector<std::string> steps;
    for (const auto& step : diagnosis.next) steps.push_back(next_words(step));
    add_list(page, "What to do next", steps);
    add_table(page, "Parameters known only roughly", table_of_nuisances(diagnosis));
    add_list(page, "What was not measured", diagnosis.not_measured);
    add_list(page, "What cannot be tested", diagnosis.not_testable);
    add_table(page, "What the effects are", table_of_effects(diagnosis));
    add_table(page, "What the observables are", table_of_observables(diagnosis));
    add_table(page, "Where this comes from", table_of_provenance(diagnosis));
}

void write_diagnosis_page(const Diagnosis& diagnosis, const std::filesystem::path& file) {
    Page page("Diagnosis: " + verdict_headline(diagnosis));
    add_diagnosis(page, diagnosis, "");
    write_page(page, file);
}

std::vector<Chart> diagnosis_charts(const Diagnosis& diagnosis) {
    const Json values = diagnosis_figure_values(diagnosis);
    std::vector<Chart> charts;
    if (values.contains("where")) charts.push_back(where_chart(diagnosis, values["where"]));
    if (values.contains("which")) charts.push_back(which_chart(diagnosis, values["which"]));
    if (!values.contains("how_far")) return charts;
    const Json& how_far = values["how_far"];
    if (!how_far["forces"].is_null())
        charts.push_back({.name = "how_far",
                          .title = "Force on the plate, before and after",
                          .caption = "Shaded: where the effect was fitted.",
                          .values = how_far["forces"],
                          .log_axes = "y",
                          .height = 400});
    charts.push_back({.name = "gap_left",
                      .title = "Gap that is left",
                      .caption = "On data held out (" + diagnosis.gap_reduction->held_out +
                                 "), with its 90 % interval; placebo: the best of many made-up effects.",
                      .values = {{"gap_label", how_far["gap_label"]}, {"bars", how_far["bars"]}},
                      .height = gap_height + gap_row * count(how_far["bars"])});
    return charts;
}

}  // namespace mcdem::report
