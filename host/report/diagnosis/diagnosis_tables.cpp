#include "report/diagnosis/diagnosis_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

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

/// Region and force class of the entry.
std::string part_words(const WhereEntry& entry) {
    std::vector<std::string> words;
    if (entry.region && !entry.region->empty()) words.push_back(words_of(*entry.region));
    if (entry.force_class && !entry.force_class->empty())
        words.push_back(words_of(*entry.force_class) + " forces");
    return words.empty() ? "all" : listed(words);
}

/// The ideal value of a metric.
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

}  // namespace

TextTable table_of_causes(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"effect", Align::left},
                     {"amplitude"},
                     {"probability"},
                     {"of chi-square"},
                     {"gain in log likelihood"},
                     {"simulated in full"},
                     {"indistinguishable from", Align::left}};
    for (const auto& cause : diagnosis.causes)
        table.rows.push_back(
            {words_of(cause.effect), amount(cause.amplitude, cause.amplitude_error, cause.unit),
             percent(cause.confidence), percent(cause.explained), number(cause.score, "{:.1f}"),
             cause.confirmed_score ? number(*cause.confirmed_score, "{:.1f}") : no_number,
             others(cause.group, cause.effect)});
    return table;
}

TextTable table_of_where(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"observable", Align::left},
                     {"part of it", Align::left},
                     {"phase", Align::left},
                     {"plate displacement"},
                     {"sigma"},
                     {"after recalibration"}};
    auto entries = diagnosis.where;
    std::stable_sort(entries.begin(), entries.end(), [](const WhereEntry& a, const WhereEntry& b) {
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
                     {"at twice that, indistinguishable from", Align::left}};
    for (const auto& limit : diagnosis.detection_limits)
        table.rows.push_back({words_of(limit.effect),
                              std::isfinite(limit.minimum_amplitude)
                                  ? amount(limit.minimum_amplitude, limit.unit)
                                  : "never shows",
                              percent(limit.absorbed_by_calibration), others(limit.group, limit.effect)});
    return table;
}

TextTable table_of_nuisances(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"parameter", Align::left},
                     {"shift from the scene"},
                     {"known to"},
                     {"over that"},
                     {"remark", Align::left}};
    for (const auto& fit : diagnosis.nuisances)
        table.rows.push_back({words_of(fit.name), amount(fit.value, fit.error, fit.unit, Sign::always),
                              "± " + amount(fit.prior, fit.unit),
                              fit.prior > 0 ? number(fit.value / fit.prior, "{:+.1f}") : no_number,
                              fit.at_bound ? "further than its stated error allows" : ""});
    return table;
}

TextTable table_of_gap_reduction(const Diagnosis& diagnosis) {
    TextTable table;
    if (!diagnosis.gap_reduction) return table;
    const auto& gap_reduction = *diagnosis.gap_reduction;
    table.columns = {{"", Align::left}, {"before"}, {"after"}, {"perfect"}};
    add_change(table, "gap, noise taken off", {gap_reduction.before, gap_reduction.after}, "0");
    table.notes = {"gap: squared differences on data held out, in standard deviations of the noise, summed"};
    for (const auto& [name, values] : metrics_in_order(gap_reduction)) {
        add_change(table, name == "errf" ? "errf [N]" : name, values, perfect(name));
        if (const auto meaning = meaning_of(name); !meaning.empty())
            table.notes.push_back(name + ": " + meaning);
    }
    return table;
}

namespace {

/// "0.31", "< 0.0001".
std::string p_number(double p) { return p < 1e-4 ? "< 0.0001" : number(p, "{:.2g}"); }

}  // namespace

TextTable table_of_packings(const Diagnosis& diagnosis) {
    TextTable table;
    const Cause* leader = diagnosis.causes.empty() ? nullptr : &diagnosis.causes.front();
    table.columns = {{"packing", Align::left}, {"p of its gap alone"}};
    if (leader) table.columns.push_back({words_of(leader->effect) + " alone"});
    table.columns.push_back({"p of what sets it apart"});
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

}  // namespace mcdem::report
