#include "report/convergence_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace mcdem {
namespace {

/// In per cent for forces, in standard deviations of one packing's replicates for all else.
double shown(const Convergence& convergence, std::size_t cell, double value) {
    return convergence.is_relative(cell) ? 100 * value : value / convergence.scale(cell);
}

std::string unit(const Convergence& convergence, std::size_t cell) {
    return convergence.is_relative(cell) ? "%" : "sd";
}

std::string name_of(const Convergence& convergence, std::size_t cell) {
    return std::string(observables()[static_cast<std::size_t>(convergence.cells[cell].observable)].name);
}

/// "0.55 +- 0.08", ".. *" beyond the limit.
std::string error_text(const Convergence& convergence, const CauseErrors& cause, int cell) {
    if (cell < 0) return "-";
    const auto c = static_cast<std::size_t>(cell);
    return fmt::format("{:+.2f} +- {:.2f} {}{}", shown(convergence, c, cause.cells[c].value),
                       shown(convergence, c, cause.cells[c].standard_error), unit(convergence, c),
                       convergence.is_beyond(cause, c) ? " *" : "  ");
}

bool has_any(const Convergence& convergence, int observable) {
    for (const CauseErrors& cause : convergence.causes)
        if (convergence.worst_cell(cause, observable) >= 0) return true;
    return false;
}

/// By how much the error at this cell must go down.
double factor_of(const Convergence& convergence, const CauseErrors& cause, std::size_t cell) {
    return std::abs(cause.cells[cell].value) / convergence.limit(cell);
}

std::string remedy_of(const Convergence& convergence, const CauseErrors& cause, std::size_t cell) {
    if (cause.remedy.empty()) return "";
    const double factor = factor_of(convergence, cause, cell);
    return fmt::format("; within the limit with {}",
                       fmt::format(fmt::runtime(cause.remedy), factor, factor * factor));
}

std::string words_of(const Convergence& convergence, const CauseErrors& cause) {
    const int worst = convergence.worst_beyond(cause);
    if (worst < 0) return fmt::format("{}: nothing beyond the limits", cause.cause);
    const auto cell = static_cast<std::size_t>(worst);
    int beyond = 0;
    for (std::size_t c = 0; c < convergence.cells.size(); ++c)
        beyond += convergence.is_beyond(cause, c) ? 1 : 0;
    const CellError& error = cause.cells[cell];
    return fmt::format("{}: {} is {}{:.2g} +- {:.1g} {} too {} at {:.1f} mm of {}{}{}", cause.cause,
                       name_of(convergence, cell), error.follows_order ? "" : "at least ",
                       std::abs(shown(convergence, cell, error.value)),
                       shown(convergence, cell, error.standard_error), unit(convergence, cell),
                       error.value > 0 ? "high" : "low", 1e3 * convergence.cells[cell].displacement,
                       convergence.cells[cell].phase == Phase::load ? "loading" : "unloading",
                       beyond > 1 ? fmt::format(", {} cells beyond their limits", beyond) : "",
                       remedy_of(convergence, cause, cell));
}

nlohmann::ordered_json json_of(const Convergence& convergence, const CauseErrors& cause, std::size_t cell) {
    const CellError& error = cause.cells[cell];
    const auto c = static_cast<Eigen::Index>(cell);
    return {{"observable", name_of(convergence, cell)},
            {"phase", name(convergence.cells[cell].phase)},
            {"displacement_mm", 1e3 * convergence.cells[cell].displacement},
            {"mean", convergence.mean[c]},
            {"standard_deviation", convergence.deviation[c]},
            {"error", error.value},
            {"standard_error", error.standard_error},
            {"follows_order", error.follows_order},
            {"limit", convergence.limit(cell)},
            {"beyond", convergence.is_beyond(cause, cell)}};
}

}  // namespace

TextTable table_of_convergence(const Convergence& convergence) {
    TextTable table;
    table.columns = {{"observable", Align::left}};
    for (const CauseErrors& cause : convergence.causes) table.columns.push_back({cause.cause});
    for (int q = 0; q < static_cast<int>(observables().size()); ++q) {
        if (!has_any(convergence, q)) continue;
        std::vector<std::string> row{std::string(observables()[static_cast<std::size_t>(q)].name)};
        for (const CauseErrors& cause : convergence.causes)
            row.push_back(error_text(convergence, cause, convergence.worst_cell(cause, q)));
        table.rows.push_back(std::move(row));
    }
    table.notes = {
        fmt::format("largest error over phases and displacements, {} replicas of one packing; sd: standard "
                    "deviation of these, or twice what the observable resolves",
                    convergence.replicas),
        fmt::format("*: beyond {:.2g} % (forces) or {:.2g} sd (all else), and by four standard errors",
                    100 * convergence.limits.force, convergence.limits.deviations)};
    return table;
}

std::vector<std::string> words_of_convergence(const Convergence& convergence) {
    std::vector<std::string> words;
    bool converged = true;
    for (const CauseErrors& cause : convergence.causes) {
        words.push_back(words_of(convergence, cause));
        converged = converged && convergence.worst_beyond(cause) < 0;
    }
    words.insert(words.begin(),
                 converged ? "Converged: no error is beyond its limit as far as these replicas can tell."
                           : "Not converged.");
    return words;
}

std::string convergence_json(const Convergence& convergence) {
    nlohmann::ordered_json json;
    json["scene"] = convergence.scene;
    json["replicas"] = convergence.replicas;
    json["words"] = words_of_convergence(convergence);
    json["limits"] = {{"force", convergence.limits.force}, {"deviations", convergence.limits.deviations}};
    json["causes"] = nlohmann::ordered_json::array();
    for (const CauseErrors& cause : convergence.causes) {
        nlohmann::ordered_json entry{{"cause", cause.cause}, {"errors", nlohmann::ordered_json::array()}};
        for (std::size_t c = 0; c < convergence.cells.size(); ++c)
            if (std::isfinite(cause.cells[c].value))
                entry["errors"].push_back(json_of(convergence, cause, c));
        json["causes"].push_back(std::move(entry));
    }
    json["seconds"] = convergence.seconds;
    return json.dump(2) + "\n";
}

Figure convergence_figure(const Convergence& convergence) {
    PlotScript script("convergence",
                      "Error of every observable by the numerics, over the largest that is allowed.",
                      "error_over_limit,low,high,row,observable");
    std::vector<Setting> causes;
    for (const CauseErrors& cause : convergence.causes) causes.push_back({cause.cause, {}});
    const auto styles = styles_of(causes);
    std::vector<int> shown_observables;
    for (int q = 0; q < static_cast<int>(observables().size()); ++q)
        if (has_any(convergence, q)) shown_observables.push_back(q);
    const int rows = static_cast<int>(shown_observables.size());
    script.size(1000, 150 + 22 * rows);
    script.title("Error by the numerics over its limit");
    script.set("xlabel 'largest error over phases and displacements / limit, with two standard errors'");
    script.set(fmt::format("yrange [{}:0.5]", 0.5 - rows - 0.5));
    script.set("xrange [-4:4]");  // what lies farther out stands at the edge
    script.set("lmargin 24");
    script.set(
        "object 1 rectangle from -1, graph 0 to 1, graph 1 back fillcolor rgb '#e8e8e8' fillstyle solid "
        "noborder");
    std::string tics;
    for (int row = 0; row < rows; ++row)
        tics += fmt::format(
            "{}'{}' {}", row ? ", " : "",
            observables()[static_cast<std::size_t>(shown_observables[static_cast<std::size_t>(row)])].name,
            -row);
    script.set("ytics noenhanced (" + tics + ")");
    for (std::size_t k = 0; k < convergence.causes.size(); ++k) {
        const CauseErrors& cause = convergence.causes[k];
        std::vector<std::vector<std::string>> points;
        for (int row = 0; row < rows; ++row) {
            const int q = shown_observables[static_cast<std::size_t>(row)];
            const int cell = convergence.worst_cell(cause, q);
            if (cell < 0) continue;
            const auto c = static_cast<std::size_t>(cell);
            const double value = cause.cells[c].value / convergence.limit(c);
            const double bar = 2 * cause.cells[c].standard_error / convergence.limit(c);
            const double y =
                -row + 0.3 - 0.6 * static_cast<double>(k) / static_cast<double>(convergence.causes.size());
            const auto place = [](double x) { return fmt::format("{:.6g}", std::clamp(x, -3.9, 3.9)); };
            points.push_back({place(value), place(value - bar), place(value + bar), fmt::format("{:.6g}", y),
                              std::string(observables()[static_cast<std::size_t>(q)].name)});
        }
        const std::string look = fmt::format("linecolor rgb '{}' pointtype {} pointsize 0.6",
                                             styles[k].colour, styles[k].filled_point);
        script.plot(script.add_block(points), "using 1:4:2:3 with xerrorbars " + look);
        script.key(cause.cause, "with points " + look);
    }
    return script.figure();
}

}  // namespace mcdem
