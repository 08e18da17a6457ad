#include "diagnose/convergence_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace mcdem::inline diagnose {
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

}  // namespace

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

}  // namespace mcdem::diagnose
