#include "report/diagnosis/diagnosis_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "diagnose/infer/effects.h"
#include "diagnose/observe/scan_observables.h"
#include "report/diagnosis/diagnosis_text.h"
#include "report/diagnosis/diagnosis_values.h"
#include "report/diagnosis/diagnosis_words.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

constexpr std::size_t max_rows = 20;  // of "where"

std::string number(double value, const char* format = "{:.3g}") {
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : no_number;
}

/// The group without the effect itself, in words.
std::string others(const std::vector<std::string>& group, const std::string& effect) {
    std::vector<std::string> words;
    for (const auto& name : group)
        if (name != effect) words.push_back(words_of(name));
    return words.empty() ? no_number : listed(words);
}

std::string part_words(const WhereEntry& entry) {
    std::vector<std::string> words;
    if (entry.region && !entry.region->empty()) words.push_back(words_of(*entry.region));
    if (entry.force_class && !entry.force_class->empty())
        words.push_back(words_of(*entry.force_class) + " forces");
    return words.empty() ? "all" : listed(words);
}

std::string perfect(const std::string& metric) { return metric == "Rtop" ? "1" : "0"; }

/// Meaning of a metric of the paper; empty for others.
std::string meaning_of(const std::string& metric) {
    if (metric == "Rtop") return "force on the plate at full stroke, simulated over measured";
    if (metric == "errf") return "root mean square error of the force on the plate over the cycle";
    if (metric == "errZ")
        return "root mean square error of the coordination number over the cycle, contacts below a force "
               "left "
               "out that makes it smallest";
    if (metric == "bhat")
        return "difference between the distributions of contact forces: -ln of the mean of Bhattacharyya's "
               "coefficient";
    return "";
}

void add_change(TextTable& table, const std::string& words, const std::array<double, 2>& values,
                const std::string& best) {
    table.rows.push_back({words, number(values[0]), number(values[1]), best});
}

TextTable table_of_causes(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"effect", Align::left},
                     {"amplitude"},
                     {"probability"},
                     {"part of chi-square"},
                     {"gain in log likelihood"},
                     {"gain in full simulations"},
                     {"indistinguishable from", Align::left}};
    for (const auto& cause : diagnosis.causes)
        table.rows.push_back(
            {words_of(cause.effect), amount(cause.amplitude, cause.amplitude_error, cause.unit),
             percent(cause.confidence), percent(cause.explained), number(cause.score, "{:.1f}"),
             cause.confirmed_score ? number(*cause.confirmed_score, "{:.1f}") : no_number,
             others(cause.group, cause.effect)});
    return table;
}

/// Significant parts of the data, strongest first.
TextTable table_of_where(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"observable", Align::left},
                     {"part of it", Align::left},
                     {"phase", Align::left},
                     {"plate displacement"},
                     {"sigma"},
                     {"after recalibration"}};
    auto entries = diagnosis.where;
    std::ranges::stable_sort(entries, [](const WhereEntry& a, const WhereEntry& b) {
        return std::fabs(a.z_score) > std::fabs(b.z_score);
    });
    for (const auto& entry : std::span(entries).first(std::min(entries.size(), max_rows)))
        table.rows.push_back({words_of(entry.observable), part_words(entry), phase_words(entry.phase),
                              displacement_words(entry.displacement), number(entry.z_score, "{:.1f}"),
                              number(entry.z_score_refitted, "{:.1f}")});
    if (entries.size() > max_rows)
        table.notes.push_back(fmt::format("and {} more, in diagnosis.json", entries.size() - max_rows));
    return table;
}

TextTable table_of_detection_limits(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"effect", Align::left},
                     {"smallest detectable amplitude"},
                     {"absorbed by calibration"},
                     {"indistinguishable at twice that amplitude from", Align::left}};
    for (const auto& limit : diagnosis.detection_limits)
        table.rows.push_back({words_of(limit.effect),
                              std::isfinite(limit.minimum_amplitude)
                                  ? amount(limit.minimum_amplitude, limit.unit)
                                  : "not detectable",
                              percent(limit.absorbed_by_calibration), others(limit.group, limit.effect)});
    return table;
}

TextTable table_of_nuisances(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"parameter", Align::left},
                     {"shift from the scene"},
                     {"uncertainty"},
                     {"shift / uncertainty"},
                     {"remark", Align::left}};
    for (const auto& fit : diagnosis.check_first)
        table.rows.push_back({words_of(fit.name), amount(fit.value, fit.error, fit.unit, Sign::always),
                              "± " + amount(fit.prior, fit.unit), number(fit.sigmas(), "{:+.1f}"),
                              diagnosis.causes.empty() ? "to be checked first"
                                                       : "to be checked first: with the effects above"});
    for (const auto& fit : diagnosis.nuisances)
        table.rows.push_back({words_of(fit.name), amount(fit.value, fit.error, fit.unit, Sign::always),
                              "± " + amount(fit.prior, fit.unit),
                              fit.prior > 0 ? number(fit.value / fit.prior, "{:+.1f}") : no_number,
                              fit.at_bound ? "more than 2.5 times its uncertainty, without an effect" : ""});
    table.notes = {"shifts are fitted without any effect unless the remark says otherwise"};
    return table;
}

/// What lacks values that the experiment has.
TextTable table_of_missing_bins(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {
        {"what", Align::left}, {"bins without a value"}, {"of"}, {"part"}, {"consequence", Align::left}};
    for (const auto& missing : diagnosis.missing_bins)
        table.rows.push_back(
            {missing.of.empty() ? "some runs of the scene as it stands" : words_of(missing.of),
             std::to_string(missing.count), std::to_string(missing.all), percent(missing.share()),
             missing.for_all ? "nothing is compared there" : "their gap counts as not explained by it"});
    return table;
}

/// Gap and metrics before and after; empty without a gap reduction.
TextTable table_of_gap_reduction(const Diagnosis& diagnosis) {
    TextTable table;
    if (!diagnosis.gap_reduction) return table;
    const auto& gap_reduction = *diagnosis.gap_reduction;
    table.columns = {{"", Align::left}, {"before"}, {"after"}, {"perfect"}};
    add_change(table, "gap, noise subtracted", {gap_reduction.before, gap_reduction.after}, "0");
    table.notes = {"gap: sum of squared differences in held-out data, in standard deviations of the noise"};
    for (const auto& [name, values] : gap_reduction.metrics) {
        add_change(table, name == "errf" ? "errf [N]" : name, values, perfect(name));
        if (const auto meaning = meaning_of(name); !meaning.empty())
            table.notes.push_back(name + ": " + meaning);
    }
    return table;
}

/// "0.31", "< 0.0001".
std::string p_number(double p) { return p < 1e-4 ? "< 0.0001" : number(p, "{:.2g}"); }

/// Each of several packings separately; no rows for a single one.
TextTable table_of_packings(const Diagnosis& diagnosis) {
    TextTable table;
    const Cause* leader = diagnosis.causes.empty() ? nullptr : &diagnosis.causes.front();
    table.columns = {{"packing", Align::left}, {"p of its gap"}};
    if (leader) table.columns.push_back({words_of(leader->effect) + " from this packing"});
    table.columns.push_back({"p of its difference from the others"});
    for (const auto& packing : diagnosis.packings) {
        auto& row = table.rows.emplace_back();
        row = {packing.experiment, p_number(packing.gap_p)};
        if (leader) row.push_back(amount(packing.amplitude, packing.amplitude_error, leader->unit));
        row.push_back(p_number(packing.agreement_p) + (packing.differs ? " *" : ""));
    }
    table.notes = {"*: differs from the others by more than noise"};
    return table;
}

TextTable table_of_provenance(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"what", Align::left}, {"", Align::left}};
    for (const auto& [key, value] : diagnosis.provenance) table.rows.push_back({words_of(key), value});
    table.rows.push_back({"time taken", number(diagnosis.seconds, "{:.0f} s")});
    return table;
}

void add_gap(Page& page, const Diagnosis& diagnosis) {
    page.section("Gap");
    page.paragraph(
        fmt::format("Two tests, each ranked against simulated experiments without a gap: one for any "
                    "difference ({}), one for differences along the tested effects ({}). The smaller p, with "
                    "Bonferroni correction for two tests: {}.",
                    p_words(diagnosis.p_omnibus), p_words(diagnosis.p_directed), p_words(diagnosis.p_value)));
    page.table("Packing by packing", table_of_packings(diagnosis));
}

/// Meanings of the rows of the figure.
TextTable table_of_observables(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"observable", Align::left}, {"what it is", Align::left}};
    for (const auto& observable : observables()) {
        const auto is_it = [&](const WhereCell& cell) { return cell.observable == observable.name; };
        if (std::ranges::any_of(diagnosis.cells, is_it))
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
        caption +=
            fmt::format(" Framed: beyond {:.1f} sigma, exceeded anywhere by noise in 1 % of the replicates.",
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
                "Left: gain in log likelihood by each effect, with the parameters refitted in both cases; "
                "diamonds: from full simulations at the fitted amplitude. Candidates that share a letter "
                "cannot be distinguished by these data. Middle: amplitude with its 90 % interval, divided by "
                "the detection limit (dashed line); no dot: not detectable. Right: amplitude with one "
                "standard error, and the probability that the effect is the cause. Orange: named by the "
                "verdict.",
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
    if (!diagnosis.gap_reduction)
        for (const auto& [about, says] : verdict_lines(diagnosis))
            if (about == "How far") page.paragraph(says);
    add_charts(page, charts, {"how_far", "gap_left"});
    page.table("Before and after", table_of_gap_reduction(diagnosis));
    std::vector<std::string> steps;
    for (const auto& step : diagnosis.next) steps.push_back(next_words(step));
    add_list(page, "What to do next", steps);
    add_table(page, "Uncertain parameters", table_of_nuisances(diagnosis));
    add_table(page, "Bins without a value", table_of_missing_bins(diagnosis));
    add_list(page, "What was not measured", diagnosis.not_measured);
    add_list(page, "What cannot be tested", diagnosis.not_testable);
    add_table(page, "What the effects are", table_of_effects(diagnosis));
    add_table(page, "What the observables are", table_of_observables(diagnosis));
    add_table(page, "Provenance", table_of_provenance(diagnosis));
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
                      .caption = "In held-out data (" + diagnosis.gap_reduction->held_out +
                                 "), with its 90 % interval; placebo: the best of twenty random effects.",
                      .values = {{"gap_label", how_far["gap_label"]}, {"bars", how_far["bars"]}},
                      .height = gap_height + gap_row * count(how_far["bars"])});
    return charts;
}

}  // namespace mcdem::report
