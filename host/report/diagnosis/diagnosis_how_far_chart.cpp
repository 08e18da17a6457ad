#include <fmt/format.h>

#include <cmath>

#include "report/diagnosis/diagnosis_charts.h"
#include "report/diagnosis/diagnosis_parts.h"

namespace mcdem::inline report {
namespace {

Json title(const std::string& text) { return {{"text", text}}; }

Json force_trace(const std::vector<std::array<double, 4>>& rows, std::size_t column, const std::string& name,
                 const std::string& mode, const std::string& colour, const std::string& dash) {
    Json x = Json::array(), y = Json::array();
    for (const auto& row : rows) x.push_back(row[0] * 1e3), y.push_back(row[column]);
    return {{"type", "scatter"},
            {"mode", mode},
            {"name", plot_text(name)},
            {"x", x},
            {"y", y},
            {"line", {{"color", colour}, {"width", 2}, {"dash", dash}}},
            {"marker", {{"color", colour}, {"size", 7}}},
            {"hovertemplate", "%{x:.2f} mm<br>%{y:.4g} N"}};
}

Chart force_chart(const Diagnosis& diagnosis, const std::vector<std::array<double, 4>>& rows) {
    Chart chart{.name = "how_far",
                .title = "Force on the plate, before and after",
                .caption = "Shaded: where the effect was fitted.",
                .log_axes = "y",
                .height = 400};
    chart.data = {force_trace(rows, 2, "simulated before", "lines", diagnosis_colour::before, "dash"),
                  force_trace(rows, 3, words_after(diagnosis), "lines", diagnosis_colour::after, "solid"),
                  force_trace(rows, 1, "experiment", "markers", "var(--ink)", "solid")};
    chart.layout = {{"xaxis", {{"title", title("plate displacement [mm]")}}},
                    {"yaxis", {{"title", title("top force [N]")}, {"rangemode", "tozero"}}},
                    {"legend", {{"x", 0.02}, {"y", 0.98}}}};
    if (const auto [from, to] = diagnosis.gap_reduction->fitted_displacement; from != to)
        chart.layout["shapes"] = {{{"type", "rect"},
                                   {"xref", "x"},
                                   {"yref", "paper"},
                                   {"layer", "below"},
                                   {"x0", from * 1e3},
                                   {"x1", to * 1e3},
                                   {"y0", 0},
                                   {"y1", 1},
                                   {"fillcolor", "var(--card)"},
                                   {"line", {{"width", 0}}}}};
    return chart;
}

Chart gap_chart(const GapReduction& gap_reduction) {
    const auto bars = gap_bars(gap_reduction);
    Chart chart{.name = "gap_left",
                .title = "Gap that is left",
                .caption = "On data held out (" + gap_reduction.held_out +
                           "), with its 90 % interval; placebo: the best of many made-up effects.",
                .height = 110 + 36 * static_cast<int>(bars.size())};
    Json x = Json::array(), y = Json::array(), colours = Json::array(), above = Json::array(),
         below = Json::array(), names = Json::array(), places = Json::array();
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const auto& [name, colour, value, interval] = bars[i];
        x.push_back(value * 100), y.push_back(i), colours.push_back(colour);
        above.push_back(interval ? Json(((*interval)[1] - value) * 100) : Json());
        below.push_back(interval ? Json((value - (*interval)[0]) * 100) : Json());
        names.push_back(fmt::format("{}: {:.0f} %", name, value * 100 + 0.0)), places.push_back(i);
    }
    chart.data = {{{"type", "bar"},
                   {"orientation", "h"},
                   {"x", x},
                   {"y", y},
                   {"marker", {{"color", colours}}},
                   {"error_x",
                    {{"type", "data"},
                     {"symmetric", false},
                     {"array", above},
                     {"arrayminus", below},
                     {"color", "var(--ink)"},
                     {"width", 4},
                     {"thickness", 1.5}}},
                   {"hovertemplate", "%{x:.1f} %<extra></extra>"}}};
    chart.layout = {{"bargap", 0.35},
                    {"xaxis", {{"title", title("gap left on data held out [%]")}, {"rangemode", "tozero"}}},
                    {"yaxis",
                     {{"tickvals", places},
                      {"ticktext", names},
                      {"range", {static_cast<double>(bars.size()) - 0.4, -0.6}},
                      {"showgrid", false},
                      {"ticks", ""}}}};
    return chart;
}

}  // namespace

std::vector<Chart> how_far_charts(const Diagnosis& diagnosis) {
    if (!diagnosis.gap_reduction || !(diagnosis.gap_reduction->before > 0)) return {};
    std::vector<Chart> charts;
    if (const auto rows = known_forces(*diagnosis.gap_reduction); rows.size() > 1)
        charts.push_back(force_chart(diagnosis, rows));
    charts.push_back(gap_chart(*diagnosis.gap_reduction));
    return charts;
}

}  // namespace mcdem::report
