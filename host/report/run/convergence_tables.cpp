#include "report/run/convergence_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/diagnosis/diagnosis_words.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

/// In per cent for forces, otherwise in standard deviations of one packing's replicates.
double shown(const Convergence& convergence, std::size_t cell, double value) {
    return convergence.is_relative(cell) ? 100 * value : value / convergence.scale(cell);
}

std::string unit(const Convergence& convergence, std::size_t cell) {
    return convergence.is_relative(cell) ? "%" : "sd";
}

std::string name_of(const Convergence& convergence, std::size_t cell) {
    return std::string(observables()[convergence.cells[cell].observable].name);
}

/// "0.55 +- 0.08", ".. *" beyond the limit.
std::string error_text(const Convergence& convergence, const CauseErrors& cause, int cell) {
    if (cell < 0) return "-";
    return fmt::format("{:+.2f} +- {:.2f} {}{}", shown(convergence, cell, cause.cells[cell].value),
                       shown(convergence, cell, cause.cells[cell].standard_error), unit(convergence, cell),
                       convergence.is_beyond(cause, cell) ? " *" : "  ");
}

bool has_any(const Convergence& convergence, int observable) {
    for (const CauseErrors& cause : convergence.causes)
        if (convergence.worst_cell(cause, observable) >= 0) return true;
    return false;
}

/// Factor by which the error at this cell must be reduced.
double factor_of(const Convergence& convergence, const CauseErrors& cause, std::size_t cell) {
    return std::abs(cause.cells[cell].value) / convergence.limit(cell);
}

std::string remedy_of(const Convergence& convergence, const CauseErrors& cause, std::size_t cell) {
    if (cause.remedy.empty()) return "";
    const double factor = factor_of(convergence, cause, cell);
    return fmt::format("; within the limit with {}",
                       fmt::format(fmt::runtime(cause.remedy), factor, factor * factor));
}

/// Errors that two standard errors do not separate from their limits.
int uncertain_errors(const Convergence& convergence, const CauseErrors& cause) {
    int count = 0;
    for (std::size_t c = 0; c < convergence.cells.size(); ++c)
        count += 2 * cause.cells[c].standard_error > convergence.limit(c) ? 1 : 0;
    return count;
}

std::string words_of(const Convergence& convergence, const CauseErrors& cause) {
    const auto is_zero = [](const CellError& error) {
        return !(std::abs(error.value) + error.standard_error > 0);
    };
    if (std::ranges::all_of(cause.cells, is_zero))
        return fmt::format("{}: no influence in these runs", cause.cause);
    const int worst = convergence.worst_beyond(cause), uncertain = uncertain_errors(convergence, cause);
    if (worst < 0)
        return fmt::format("{}: no error beyond its limit{}", cause.cause,
                           uncertain ? fmt::format(", but {} of {} values have standard errors that are too "
                                                   "large to tell; use more --replicas",
                                                   uncertain, convergence.cells.size())
                                     : "");
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
                       beyond > 1 ? fmt::format(", {} values beyond their limits", beyond) : "",
                       remedy_of(convergence, cause, cell));
}

nlohmann::ordered_json json_of(const Convergence& convergence, const CauseErrors& cause, std::size_t cell) {
    const CellError& error = cause.cells[cell];
    return {{"observable", name_of(convergence, cell)},
            {"phase", name(convergence.cells[cell].phase)},
            {"displacement_mm", 1e3 * convergence.cells[cell].displacement},
            {"mean", convergence.mean[cell]},
            {"standard_deviation", convergence.deviation[cell]},
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
        std::vector<std::string> row{std::string(observables()[q].name)};
        for (const CauseErrors& cause : convergence.causes)
            row.push_back(error_text(convergence, cause, convergence.worst_cell(cause, q)));
        table.rows.push_back(std::move(row));
    }
    table.notes = {
        fmt::format("largest error over phases and displacements, {} {}", convergence.replicas,
                    convergence.copies),
        "errors of the mean over these; single runs differ more, since packings at other speeds take other "
        "courses",
        "sd: standard deviation of these, or twice what the observable resolves",
        fmt::format("*: beyond {:.2g} % (forces) or {:.2g} sd (all else), and by four standard errors",
                    100 * convergence.limits.force, convergence.limits.deviations)};
    return table;
}

std::vector<std::string> words_of_convergence(const Convergence& convergence) {
    std::vector<std::string> words;
    bool converged = true, decided = true;
    for (const CauseErrors& cause : convergence.causes) {
        words.push_back(words_of(convergence, cause));
        converged = converged && convergence.worst_beyond(cause) < 0;
        decided = decided && !uncertain_errors(convergence, cause);
    }
    words.insert(words.begin(),
                 !converged ? "Not converged."
                 : decided  ? "Converged: no error is beyond its limit."
                            : "Not decided: no error is beyond its limit, but more replicas are needed "
                              "to tell (--replicas).");
    return words;
}

std::string convergence_json(const Convergence& convergence) {
    nlohmann::ordered_json json;
    json["scene"] = convergence.scene;
    json["replicas"] = convergence.replicas;
    json["copies"] = convergence.copies;
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

nlohmann::ordered_json convergence_figure_values(const Convergence& convergence) {
    using Json = nlohmann::ordered_json;
    Json causes = Json::array(), rows = Json::array();
    for (std::size_t k = 0; k < convergence.causes.size(); ++k) {
        const auto style = style_number(k);
        causes.push_back(
            {{"words", convergence.causes[k].cause}, {"colour", style.colour}, {"marker", style.marker}});
    }
    for (int q = 0; q < static_cast<int>(observables().size()); ++q) {
        if (!has_any(convergence, q)) continue;
        const std::string name(observables()[q].name);
        Json row{{"observable", name}, {"words", words_of(name)}, {"errors", Json::array()}};
        for (const CauseErrors& cause : convergence.causes) {
            const int cell = convergence.worst_cell(cause, q);
            row["errors"].push_back(
                cell < 0
                    ? Json()
                    : Json{{"over_limit", cause.cells[cell].value / convergence.limit(cell)},
                           {"standard_error", cause.cells[cell].standard_error / convergence.limit(cell)}});
        }
        rows.push_back(row);
    }
    return {{"x_label", "largest error over phases and displacements / limit, ± two standard errors"},
            {"causes", causes},
            {"rows", rows}};
}

}  // namespace mcdem::report
