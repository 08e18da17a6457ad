#include "report/diagnosis/diagnosis_values.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "report/diagnosis/diagnosis_words.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

using Json = nlohmann::ordered_json;

/// Colours of all figures. Colour-blind readers can distinguish blue and orange.
constexpr const char* named_colour = "#D55E00";
constexpr const char* other_colour = "#6F9BBF";
constexpr const char* before_colour = "#2B87C8";
constexpr const char* after_colour = "#D55E00";
constexpr const char* faint_colour = "#999999";

constexpr double phase_gap = 0.35;      ///< between loading and unloading [column widths]
constexpr double interval_90 = 1.6449;  ///< sigmas on either side

/// Displacements with a smaller difference are one column [m].
constexpr double same_displacement = 1e-5;

/// Column of the figure "where"; its rows are observables.
struct Column {
    std::string phase;
    double displacement;  ///< [m]
    double x = 0;         ///< of the centre; columns have width 1, phases are separated by phase_gap
};

int phase_order(const std::string& phase) { return phase == "load" ? 0 : phase == "unload" ? 1 : 2; }

bool same(const Column& a, const Column& b) {
    return a.phase == b.phase && std::fabs(a.displacement - b.displacement) < same_displacement;
}

/// Order of the measurement: loading, then unloading.
bool earlier(const Column& a, const Column& b) {
    if (a.phase != b.phase)
        return std::pair(phase_order(a.phase), a.phase) < std::pair(phase_order(b.phase), b.phase);
    return a.phase == "unload" ? a.displacement > b.displacement : a.displacement < b.displacement;
}

bool within(const WhereCell& cell, const WhereEntry& entry) {
    return cell.observable == entry.observable && (entry.phase.empty() || entry.phase == cell.phase) &&
           cell.displacement >= entry.displacement[0] - same_displacement &&
           cell.displacement <= entry.displacement[1] + same_displacement;
}

struct HeatMap {
    std::vector<std::string> observables;  ///< from top to bottom
    std::vector<Column> columns;
    double width = 0;

    explicit HeatMap(const std::vector<WhereCell>& cells) {
        for (const auto& cell : cells) {
            if (row(cell) == std::ssize(observables)) observables.push_back(cell.observable);
            columns.push_back({cell.phase, cell.displacement});
        }
        std::ranges::sort(columns, earlier);
        columns.erase(std::unique(columns.begin(), columns.end(), same), columns.end());
        for (std::size_t c = 0; c < columns.size(); ++c) {
            if (c > 0 && columns[c].phase != columns[c - 1].phase) width += phase_gap;
            columns[c].x = width + 0.5;
            width += 1;
        }
    }
    std::ptrdiff_t row(const WhereCell& cell) const {
        return std::ranges::find(observables, cell.observable) - observables.begin();
    }
    std::ptrdiff_t column(const WhereCell& cell) const {
        const Column wanted{cell.phase, cell.displacement};
        return std::ranges::find_if(columns, [&](const Column& c) { return same(c, wanted); }) -
               columns.begin();
    }
};

/// Limits of the colour scale in sigmas: outliers must not hide all others, and noise must not look like a
/// gap.
double colour_range(const std::vector<WhereCell>& cells) {
    double largest = 0;
    for (const auto& cell : cells) largest = std::max(largest, std::fabs(cell.z_score));
    return std::clamp(std::ceil(largest), 6.0, 8.0);
}

Json panel_json(const Diagnosis& diagnosis, const HeatMap& map, bool refitted) {
    Json cells = Json::array();
    for (const auto& cell : diagnosis.cells) {
        const double z = refitted ? cell.z_score_refitted : cell.z_score;
        if (!std::isfinite(z)) continue;
        cells.push_back({{"row", map.row(cell)},
                         {"column", map.column(cell)},
                         {"z_score", z},
                         {"stands_out", stands_out(diagnosis, cell, refitted)}});
    }
    return {{"words", refitted ? "after recalibration" : "as stated"}, {"cells", cells}};
}

Json where_json(const Diagnosis& diagnosis) {
    const HeatMap map(diagnosis.cells);
    Json observables = Json::array(), columns = Json::array();
    for (const auto& observable : map.observables) observables.push_back(words_of(observable));
    for (const auto& column : map.columns)
        columns.push_back({{"phase", column.phase.empty() ? "whole cycle" : column.phase + "ing"},
                           {"displacement_mm", column.displacement * 1e3},
                           {"x", column.x}});
    return {{"x_label", "plate displacement [mm]"},
            {"colour_label", "measured minus simulated [sigma of the noise]"},
            {"colour_range", colour_range(diagnosis.cells)},
            {"width", map.width},
            {"observables", observables},
            {"columns", columns},
            {"panels", {panel_json(diagnosis, map, false), panel_json(diagnosis, map, true)}}};
}

/// Candidates named by the verdict: the causes; none if no effect explains the gap.
std::set<std::string> named_effects(const Diagnosis& diagnosis) {
    if (diagnosis.verdict != Verdict::effect && diagnosis.verdict != Verdict::group) return {};
    std::set<std::string> named;
    for (const Cause& cause : diagnosis.causes) named.insert(cause.effect);
    return named;
}

/// Detection limit of an effect, which makes amplitudes with different units comparable; 0 if unknown or
/// infinite.
double detectable(const Diagnosis& diagnosis, const std::string& effect) {
    const auto limit = std::ranges::find(diagnosis.detection_limits, effect, &DetectionLimit::effect);
    const bool known = limit != diagnosis.detection_limits.end() && std::isfinite(limit->minimum_amplitude);
    return known ? limit->minimum_amplitude : 0;
}

Json which_json(const Diagnosis& diagnosis) {
    const auto& ranking = diagnosis.ranking;
    const auto named = named_effects(diagnosis);
    const auto letters = group_letters(ranking);
    Json rows = Json::array();
    for (std::size_t i = 0; i < ranking.size(); ++i) {
        const Cause& cause = ranking[i];
        rows.push_back({{"effect", cause.effect},
                        {"words", words_of(cause.effect)},
                        {"is_named", named.contains(cause.effect)},
                        {"group", letters[i]},
                        {"gain", cause.score},
                        {"gain_simulated", cause.confirmed_score ? Json(*cause.confirmed_score) : Json()},
                        {"amplitude", amount(cause.amplitude, cause.amplitude_error, cause.unit)},
                        {"probability", percent(cause.confidence)}});
        const double limit = detectable(diagnosis, cause.effect);
        if (!(limit > 0)) continue;
        rows.back()["over_limit"] = cause.amplitude / limit;
        rows.back()["half_interval"] = interval_90 * cause.amplitude_error / limit;
    }
    return {{"gain_label", "gain in log likelihood"},
            {"over_limit_label", "fitted amplitude / detection limit"},
            {"colour_named", named_colour},
            {"colour_other", other_colour},
            {"rows", rows}};
}

/// Label of the simulated force after the change.
std::string words_after(const Diagnosis& diagnosis) {
    if (diagnosis.verdict == Verdict::calibration_suspect) return "simulated, recalibrated";
    if (diagnosis.verdict == Verdict::not_converged) return "simulated, refined";
    const bool pair = added_causes(diagnosis).size() > 1;
    return shortened("simulated with " + (pair ? "both effects" : added_words(diagnosis)), 40);
}

/// Displacements at which all forces are known.
Json forces_json(const Diagnosis& diagnosis) {
    Json displacement = Json::array(), experiment = Json::array(), before = Json::array(),
         after = Json::array();
    for (const auto& row : diagnosis.gap_reduction->top_force) {
        if (!std::ranges::all_of(row, [](double value) { return std::isfinite(value); })) continue;
        displacement.push_back(row[0] * 1e3), experiment.push_back(row[1]);
        before.push_back(row[2]), after.push_back(row[3]);
    }
    if (displacement.size() < 2) return {};
    Json json{{"x_label", "plate displacement [mm]"},
              {"y_label", "top force [N]"},
              {"x", displacement},
              {"experiment", experiment},
              {"before", before},
              {"after", after},
              {"words_before", "simulated before"},
              {"words_after", words_after(diagnosis)},
              {"colour_before", before_colour},
              {"colour_after", after_colour}};
    if (const auto [from, to] = diagnosis.gap_reduction->fitted_displacement; from != to)
        json["fitted"] = {from * 1e3, to * 1e3};
    return json;
}

Json how_far_json(const Diagnosis& diagnosis) {
    const GapReduction& gap = *diagnosis.gap_reduction;
    Json bars = Json::array();
    const auto add = [&](const char* words, const char* colour, double left) {
        bars.push_back({{"words", words}, {"colour", colour}, {"gap_left", left * 100}});
    };
    add("before", before_colour, 1);
    add(gap.confirmed ? "after, predicted" : "after", after_colour, 1 - gap.fraction);
    if (std::isfinite(gap.interval[0]) && std::isfinite(gap.interval[1]))
        bars.back()["interval"] = {(1 - gap.interval[1]) * 100, (1 - gap.interval[0]) * 100};
    if (gap.confirmed) add("after, simulated", after_colour, 1 - *gap.confirmed);
    add("placebo", faint_colour, 1 - gap.placebo);
    return {
        {"gap_label", "gap left in held-out data [%]"}, {"forces", forces_json(diagnosis)}, {"bars", bars}};
}

}  // namespace

bool stands_out(const Diagnosis& diagnosis, const WhereCell& cell, bool refitted) {
    if (diagnosis.where_threshold > 0)
        return std::fabs(refitted ? cell.z_score_refitted : cell.z_score) >= diagnosis.where_threshold;
    return !refitted &&
           std::ranges::any_of(diagnosis.where, [&](const WhereEntry& entry) { return within(cell, entry); });
}

std::vector<std::string> group_letters(const std::vector<Cause>& ranking) {
    std::vector<std::set<std::string>> groups;
    for (const auto& cause : ranking) {
        const std::set<std::string> group(cause.group.begin(), cause.group.end());
        if (group.size() > 1 && std::ranges::find(groups, group) == groups.end()) groups.push_back(group);
    }
    const auto part_of_another = [&](const std::set<std::string>& group) {
        return std::ranges::any_of(groups, [&](const std::set<std::string>& other) {
            return other.size() > group.size() && std::ranges::includes(other, group);
        });
    };
    std::vector<std::string> letters(ranking.size());
    char letter = 'A';
    for (const auto& group : groups) {
        if (part_of_another(group)) continue;
        for (std::size_t i = 0; i < ranking.size(); ++i)
            if (group.contains(ranking[i].effect)) letters[i] += letter;
        letter = letter == 'Z' ? 'a' : static_cast<char>(letter + 1);
    }
    return letters;
}

Json diagnosis_figure_values(const Diagnosis& diagnosis) {
    Json values = Json::object();
    if (std::ranges::any_of(diagnosis.cells, [](const auto& cell) { return std::isfinite(cell.z_score); }))
        values["where"] = where_json(diagnosis);
    if (!diagnosis.ranking.empty()) values["which"] = which_json(diagnosis);
    if (diagnosis.gap_reduction && diagnosis.gap_reduction->before > 0)
        values["how_far"] = how_far_json(diagnosis);
    return values;
}

}  // namespace mcdem::report
