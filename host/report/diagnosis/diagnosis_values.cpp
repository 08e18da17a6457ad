#include "report/diagnosis/diagnosis_values.h"

#include <cmath>

#include "report/diagnosis/diagnosis_parts.h"
#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline report {
namespace {

using Json = nlohmann::ordered_json;

Json panel_json(const Diagnosis& diagnosis, const HeatMap& map, bool refitted) {
    Json cells = Json::array();
    for (const auto& cell : diagnosis.cells) {
        const double z = refitted ? cell.z_score_refitted : cell.z_score;
        if (!std::isfinite(z)) continue;
        cells.push_back({{"row", map.row(cell)},
                         {"column", &map.column(cell) - map.columns.data()},
                         {"z_score", z},
                         {"stands_out", stands_out(diagnosis, cell, refitted)}});
    }
    return {{"words", refitted ? "after recalibration" : "as stated"}, {"cells", cells}};
}

Json where_json(const Diagnosis& diagnosis) {
    const auto map = heat_map_of(diagnosis.cells);
    Json observables = Json::array(), columns = Json::array();
    for (const auto& observable : map.observables) observables.push_back(words_of(observable));
    for (const auto& column : map.columns)
        columns.push_back({{"phase", column.phase.empty() ? "whole cycle" : column.phase + "ing"},
                           {"displacement_mm", column.displacement * 1e3},
                           {"x", column.x}});
    return {{"x_label", "plate displacement [mm]"},
            {"colour_label", "measured less simulated [sigma of its noise]"},
            {"colour_range", colour_range(diagnosis.cells)},
            {"width", map.width},
            {"observables", observables},
            {"columns", columns},
            {"panels", {panel_json(diagnosis, map, false), panel_json(diagnosis, map, true)}}};
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
    }
    for (const auto& [place, over, half] : shown_amplitudes(diagnosis))
        rows[place]["over_limit"] = over, rows[place]["half_interval"] = half;
    return {{"gain_label", "gain in log likelihood"},
            {"over_limit_label", "fitted amplitude / detection limit"},
            {"colour_named", diagnosis_colour::named},
            {"colour_other", diagnosis_colour::other},
            {"rows", rows}};
}

Json forces_json(const Diagnosis& diagnosis) {
    const auto rows = known_forces(*diagnosis.gap_reduction);
    if (rows.size() < 2) return {};
    Json displacement = Json::array(), experiment = Json::array(), before = Json::array(),
         after = Json::array();
    for (const auto& row : rows) {
        displacement.push_back(row[0] * 1e3), experiment.push_back(row[1]);
        before.push_back(row[2]), after.push_back(row[3]);
    }
    Json json{{"x_label", "plate displacement [mm]"},
              {"y_label", "top force [N]"},
              {"x", displacement},
              {"experiment", experiment},
              {"before", before},
              {"after", after},
              {"words_before", "simulated before"},
              {"words_after", words_after(diagnosis)},
              {"colour_before", diagnosis_colour::before},
              {"colour_after", diagnosis_colour::after}};
    if (const auto [from, to] = diagnosis.gap_reduction->fitted_displacement; from != to)
        json["fitted"] = {from * 1e3, to * 1e3};
    return json;
}

Json how_far_json(const Diagnosis& diagnosis) {
    Json bars = Json::array();
    for (const auto& [words, colour, value, interval] : gap_bars(*diagnosis.gap_reduction)) {
        Json bar{{"words", words}, {"colour", colour}, {"gap_left", value * 100}};
        if (interval && std::isfinite((*interval)[0]) && std::isfinite((*interval)[1]))
            bar["interval"] = {(*interval)[0] * 100, (*interval)[1] * 100};
        bars.push_back(bar);
    }
    return {
        {"gap_label", "gap left on data held out [%]"}, {"forces", forces_json(diagnosis)}, {"bars", bars}};
}

}  // namespace

Json diagnosis_figure_values(const Diagnosis& diagnosis) {
    Json values = Json::object();
    if (has_cells(diagnosis)) values["where"] = where_json(diagnosis);
    if (!diagnosis.ranking.empty()) values["which"] = which_json(diagnosis);
    if (diagnosis.gap_reduction && diagnosis.gap_reduction->before > 0)
        values["how_far"] = how_far_json(diagnosis);
    return values;
}

}  // namespace mcdem::report
