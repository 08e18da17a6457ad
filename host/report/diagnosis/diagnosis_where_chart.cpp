#include <fmt/format.h>

#include <cmath>

#include "report/diagnosis/diagnosis_charts.h"
#include "report/diagnosis/diagnosis_parts.h"
#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline report {
namespace {

constexpr int where_row_height = 22, where_above_rows = 64, where_below_rows = 56;  // [pixels]
constexpr int beside_columns = 300, min_column = 30;                                // [pixels]
constexpr std::size_t max_numbers = 16;  // maximum number of columns with printed numbers

/// Columns of the trace: those of the map, and an empty one between the phases.
struct Grid {
    std::vector<double> edges;
    std::vector<int> column;  ///< of the map; -1: empty
};
Grid grid_of(const HeatMap& map) {
    Grid grid;
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
        const double left = map.columns[c].x - 0.5;
        if (c > 0 && left > grid.edges.back()) grid.edges.push_back(left), grid.column.push_back(-1);
        if (c == 0) grid.edges.push_back(left);
        grid.edges.push_back(left + 1);
        grid.column.push_back(static_cast<int>(c));
    }
    return grid;
}

std::string hover_words(const WhereCell& cell, double z) {
    return plot_text(fmt::format("{}, {} at {:.2f} mm", words_of(cell.observable), phase_words(cell.phase),
                                 cell.displacement * 1e3)) +
           fmt::format("<br>{:.2f} sigma", z);
}

/// Blue: the experiment is lower; orange: it is higher.
Json colours() {
    return {{0, "var(--cool-3)"},     {0.2, "var(--cool-2)"}, {0.375, "var(--cool-1)"}, {0.5, "var(--none)"},
            {0.625, "var(--warm-1)"}, {0.8, "var(--warm-2)"}, {1, "var(--warm-3)"}};
}

/// A panel's cells as a trace, `axis` "" or "2".
Json cells_trace(const Diagnosis& diagnosis, const HeatMap& map, bool refitted, const std::string& axis) {
    const auto grid = grid_of(map);
    const Json empty_row(std::vector<Json>(grid.column.size()));
    Json z = Json::array(), words = Json::array();
    for (std::size_t r = 0; r < map.observables.size(); ++r)
        z.push_back(empty_row), words.push_back(empty_row);
    for (const auto& cell : diagnosis.cells) {
        const double score = refitted ? cell.z_score_refitted : cell.z_score;
        const auto column = &map.column(cell) - map.columns.data();
        const auto place = std::find(grid.column.begin(), grid.column.end(), column) - grid.column.begin();
        const auto row = static_cast<std::size_t>(map.row(cell));
        if (!std::isfinite(score)) continue;
        z[row][static_cast<std::size_t>(place)] = score;
        words[row][static_cast<std::size_t>(place)] = hover_words(cell, score);
    }
    const double range = colour_range(diagnosis.cells);
    return {{"type", "heatmap"},
            {"name", refitted ? "after recalibration" : "as stated"},
            {"x", grid.edges},
            {"y0", 0},
            {"dy", 1},
            {"z", z},
            {"text", words},
            {"hoverinfo", "text"},
            {"xaxis", "x" + axis},
            {"zmin", -range},
            {"zmax", range},
            {"xgap", 1},
            {"ygap", 1},
            {"colorscale", colours()},
            {"showscale", !refitted},
            {"colorbar",
             {{"thickness", 12},
              {"lenmode", "pixels"},
              {"len", 360},
              {"y", 1},
              {"yanchor", "top"},
              {"outlinewidth", 0},
              {"title",
               {{"text", "measured less simulated [sigma of its noise]"},
                {"side", "right"},
                {"font", {{"size", 12}}}}}}}};
}

/// Frames of the significant cells, and a trace of their numbers.
void add_frames(const Diagnosis& diagnosis, const HeatMap& map, bool refitted, const std::string& axis,
                Chart& chart) {
    const double range = colour_range(diagnosis.cells);
    Json x = Json::array(), y = Json::array(), text = Json::array(), ink = Json::array();
    for (const auto& cell : diagnosis.cells) {
        const double z = refitted ? cell.z_score_refitted : cell.z_score;
        if (!std::isfinite(z) || !stands_out(diagnosis, cell, refitted)) continue;
        const double middle = map.column(cell).x, row = map.row(cell);
        chart.layout["shapes"].push_back({{"type", "rect"},
                                          {"xref", "x" + axis},
                                          {"yref", "y"},
                                          {"x0", middle - 0.47},
                                          {"x1", middle + 0.47},
                                          {"y0", row - 0.45},
                                          {"y1", row + 0.45},
                                          {"line", {{"width", 1.3}, {"color", "var(--ink)"}}}});
        x.push_back(middle), y.push_back(row),
            text.push_back(fmt::format("{:.{}f}", z, std::fabs(z) < 10 ? 1 : 0));
        ink.push_back(std::fabs(z) > 0.6 * range ? "var(--on-strong)" : "#111111");
    }
    if (x.empty() || map.columns.size() > max_numbers) return;
    chart.data.push_back({{"type", "scatter"},
                          {"mode", "text"},
                          {"x", x},
                          {"y", y},
                          {"text", text},
                          {"textfont", {{"size", 10}, {"color", ink}}},
                          {"hoverinfo", "skip"},
                          {"showlegend", false},
                          {"xaxis", "x" + axis}});
}

Json columns_axis(const HeatMap& map, double from, double to) {
    Json places = Json::array(), words = Json::array();
    const auto every = map.columns.size() / 10 + 1;  // more labels would overlap
    for (std::size_t c = 0; c < map.columns.size(); c += every) {
        places.push_back(map.columns[c].x);
        words.push_back(fmt::format("{:.3g}", map.columns[c].displacement * 1e3));
    }
    return {{"domain", {from, to}},
            {"range", {-0.02, map.width + 0.02}},
            {"tickvals", places},
            {"ticktext", words},
            {"showgrid", false},
            {"showline", false},
            {"tickfont", {{"size", 11}}},
            {"tickangle", 0},
            {"fixedrange", true},
            {"title", {{"text", "plate displacement [mm]"}, {"font", {{"size", 12}}}}}};
}

Json words_above(const std::string& text, const std::string& axis, double x, int up, int size) {
    return {{"text", text},
            {"xref", axis},
            {"x", x},
            {"yref", "paper"},
            {"y", 1},
            {"yshift", up},
            {"showarrow", false},
            {"xanchor", "center"},
            {"yanchor", "bottom"},
            {"font", {{"size", size}}}};
}

/// The panel's heading, and its phases.
void add_headings(const HeatMap& map, const std::string& heading, const std::string& axis, Chart& chart) {
    auto& annotations = chart.layout["annotations"];
    annotations.push_back(words_above(heading, axis, map.width / 2, 22, 14));
    for (auto first = map.columns.begin(); first != map.columns.end();) {
        const auto last = std::find_if(first, map.columns.end(),
                                       [&](const auto& column) { return column.phase != first->phase; });
        const auto words = first->phase.empty() ? "whole cycle" : first->phase + "ing →";
        annotations.push_back(
            words_above(plot_text(words), axis, (first->x + std::prev(last)->x) / 2, 3, 12));
        first = last;
    }
}

}  // namespace

std::optional<Chart> where_chart(const Diagnosis& diagnosis) {
    if (!has_cells(diagnosis)) return std::nullopt;
    const auto map = heat_map_of(diagnosis.cells);
    const int rows = static_cast<int>(map.observables.size());
    Chart chart{.name = "where",
                .title = "Where simulation and experiment differ",
                .caption =
                    "Orange: the experiment lies above the simulation, blue: below. Time runs from left to "
                    "right. Left: parameters as stated; right: after they were fitted within their "
                    "uncertainty.",
                .height = where_above_rows + where_below_rows + where_row_height * rows,
                .min_width = beside_columns + 2 * min_column * static_cast<int>(map.columns.size())};
    if (diagnosis.where_threshold > 0)
        chart.caption +=
            fmt::format(" Framed: beyond {:.1f} sigma, which noise alone seldom reaches in any cell.",
                        diagnosis.where_threshold);
    Json names = Json::array();
    for (const auto& observable : map.observables) names.push_back(plot_text(words_of(observable)));
    chart.layout = {{"margin", {{"l", 60}, {"r", 16}, {"t", where_above_rows}, {"b", where_below_rows}}},
                    {"shapes", Json::array()},
                    {"annotations", Json::array()},
                    {"xaxis", columns_axis(map, 0, 0.485)},
                    {"xaxis2", columns_axis(map, 0.515, 1)},
                    {"yaxis",
                     {{"tickvals", Json::array()},
                      {"ticktext", names},
                      {"range", {rows - 0.5, -0.5}},
                      {"showgrid", false},
                      {"showline", false},
                      {"ticks", ""},
                      {"fixedrange", true}}}};
    for (int r = 0; r < rows; ++r) chart.layout["yaxis"]["tickvals"].push_back(r);
    for (const bool refitted : {false, true}) {
        const std::string axis = refitted ? "2" : "";
        chart.data.push_back(cells_trace(diagnosis, map, refitted, axis));
        add_frames(diagnosis, map, refitted, axis, chart);
        add_headings(map, refitted ? "after recalibration" : "as stated", "x" + axis, chart);
    }
    return chart;
}

}  // namespace mcdem::report
