#include "report/run/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parameters.h"
#include "core/replaced.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

std::string number(double value, int decimals) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : no_number;
}

/// Notes for each setting; common notes once.
std::vector<std::string> notes_of(const std::vector<Comparison>& comparisons) {
    std::vector<std::string> notes;
    for (const auto& c : comparisons)
        for (const auto& note : c.notes) {
            const bool shared =
                std::all_of(comparisons.begin(), comparisons.end(), [&](const Comparison& other) {
                    return std::find(other.notes.begin(), other.notes.end(), note) != other.notes.end();
                });
            if (!shared)
                notes.push_back(words_for(c.setting) + ": " + note);
            else if (&c == &comparisons.front())
                notes.push_back(note);
        }
    return notes;
}

}  // namespace

std::string with_error(const Estimate& estimate, int decimals, double unit) {
    if (!estimate.available()) return no_number;
    const bool has_error = std::isfinite(estimate.standard_error);
    const double value = estimate.value / unit, error = estimate.standard_error / unit;
    const double size = std::max(std::abs(value), has_error ? error : 0);
    if (size < 1e-4 && size > 0)
        return fmt::format("{:.2e}", value) + (has_error ? fmt::format(" ± {:.1e}", error) : "");
    if (size > 0) decimals = std::max(decimals, 1 - static_cast<int>(std::floor(std::log10(size))));
    return number(value, decimals) + (has_error ? " ± " + number(error, decimals) : "");
}

std::string rate_note(const std::string& what, double rate_error, bool strokes) {
    constexpr double too_much = 0.02;
    std::string note = fmt::format("{} at most {:.2g} %, estimated", what, 100 * rate_error);
    if (rate_error > too_much) note += "; set protocol.rate_tolerance for less";
    if (rate_error > too_much && strokes) note += ", `mcdem converge` measures it";
    return note;
}

std::string beyond_note(const std::string& setting, const std::string& from, const BeyondLaw& beyond) {
    return fmt::format(
        "{}: from {} on grains overlap more than the law was tested for ({:.2f} of the sum of their radii), "
        "by up to {:.2f}; numerics.stop_beyond_law stops there",
        setting, from, beyond.tested, beyond.max_overlap);
}

std::string csv_field(const std::string& text) {
    const auto line = one_line(text);
    if (line.find_first_of(",\"") == std::string::npos) return line;
    return "\"" + replaced(line, {{'"', "\"\""}}) + "\"";
}

VaryingKeys varying_keys(const std::vector<Setting>& settings) {
    std::vector<Parameters> parameters;
    for (const auto& setting : settings) {
        parameters.push_back(setting.replicas.front()->parameters);
        parameters.back().erase("packing.seed");
    }
    VaryingKeys varying{keys_that_vary(parameters), {}};
    for (const auto& of_setting : parameters) {
        auto& values = varying.values.emplace_back();
        for (const auto& key : varying.keys) values.push_back(without_quotes(value_of(of_setting, key)));
    }
    return varying;
}

TextTable table_of_models(const ModelTable& models) {
    TextTable table;
    const auto full_stroke = std::isfinite(models.displacement)
                                 ? fmt::format("top force at {} mm [N]", number(models.displacement * 1e3, 2))
                                 : std::string("top force [N]");
    table.columns = {
        {"model", Align::left}, {full_stroke}, {"over " + words_for(models.reference)}, {"replicas"}};
    const bool some_failed = std::any_of(models.rows.begin(), models.rows.end(),
                                         [](const ModelRow& row) { return row.failed > 0; });
    if (some_failed) table.columns.push_back({"stopped early"});
    for (const auto& row : models.rows) {
        const auto mark = row.reached ? fmt::format(" * at {:.2f} mm", *row.reached * 1e3) : "";
        table.rows.push_back({words_for(row.setting), with_error(row.top_force, 2) + mark,
                              with_error(row.ratio, 3), std::to_string(row.replicas)});
        if (some_failed) table.rows.back().push_back(std::to_string(row.failed));
    }
    if (std::ranges::any_of(models.rows, [](const ModelRow& row) { return row.reached.has_value(); }))
        table.notes.push_back("*: no replica reached full stroke; force and ratio are of the last scan");
    for (const auto& row : models.rows)
        if (row.beyond)
            table.notes.push_back(beyond_note(
                words_for(row.setting), number(row.beyond->displacement * 1e3, 2) + " mm", *row.beyond));
    if (std::isfinite(models.rate_error))
        table.notes.push_back(rate_note("plate's speed: error of forces", models.rate_error));
    return table;
}

std::string csv_of_models(const ModelTable& models, const std::vector<Setting>& settings) {
    const auto [keys, values] = varying_keys(settings);
    const auto known = [](double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; };
    std::string text = "setting,";
    for (const auto& key : keys) text += key + ",";
    text +=
        "displacement_mm,top_force_N,standard_error_N,over,ratio,ratio_standard_error,replicas,stopped_"
        "early\n";
    for (std::size_t r = 0; r < models.rows.size(); ++r) {
        const ModelRow& row = models.rows[r];
        text += csv_field(row.setting) + ",";
        for (const auto& value : values[r]) text += csv_field(value) + ",";
        text += fmt::format(
            "{},{},{},{},{},{},{},{}\n", known(row.reached.value_or(models.displacement) * 1e3),
            known(row.top_force.value), known(row.top_force.standard_error), csv_field(models.reference),
            known(row.ratio.value), known(row.ratio.standard_error), row.replicas, row.failed);
    }
    return text;
}

TextTable table_of_comparisons(const std::vector<Comparison>& comparisons) {
    TextTable table;
    table.columns = {{"model", Align::left}, {"Rtop"},     {"errf [N]"}, {"errZ"},
                     {"bhat x 100"},         {"tau [mN]"}, {"levels"}};
    for (const auto& c : comparisons) {
        table.rows.push_back({words_for(c.setting), with_error(c.Rtop, 3), with_error(c.errf, 2),
                              with_error(c.errZ, 2), with_error(c.bhat, 2, 1e-2), with_error(c.tau, 2, 1e-3),
                              fmt::format("{} of {}", c.levels_errf, c.reference_levels)});
    }
    table.notes = notes_of(comparisons);
    table.rows.push_back({"perfect fit", "1", "0", "0", "0", "", ""});
    return table;
}

TextTable table_of_scaling(const std::vector<Setting>& settings, const LevelOptions& options) {
    TextTable table;
    table.columns = {{"model", Align::left},
                     {"phase", Align::left},
                     {"F / (Z phi b f) [1/m]"},
                     {"R^2"},
                     {"curvature"},
                     {"levels"}};
    for (const auto& setting : settings) {
        const auto points = scaling_points(group_levels(setting.replicas, options));
        for (Phase phase : {Phase::load, Phase::unload}) {
            const auto fit = fit_scaling(points, phase);
            table.rows.push_back({words_for(setting.label), std::string(name(phase)),
                                  number(fit.coefficient, 1), number(fit.r_squared, 4),
                                  number(fit.curvature, 3), std::to_string(fit.points)});
        }
    }
    return table;
}

}  // namespace mcdem::report
