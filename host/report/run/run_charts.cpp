#include "report/run/run_charts.h"

#include <fmt/format.h>

#include <cmath>

#include "report/page/chart_parts.h"

namespace mcdem::inline report {
namespace {

Json axis(const std::string& title) { return {{"title", {{"text", title}}}, {"rangemode", "tozero"}}; }

/// The chart of a figure, without traces.
Chart chart_of(const RunFigure& figure, const std::string& title, const std::string& caption) {
    Chart chart{.name = figure.name, .title = title, .caption = caption};
    chart.layout = {{"xaxis", axis(figure.x_label)}, {"yaxis", axis(figure.y_label)}};
    return chart;
}

/// Loading solid, unloading dashed; the reference as points, full and open.
void add_curves(Json& traces, const Cast& cast, const FigureSeries& shown, const PointWords& words,
                const std::string& remark = "") {
    bool in_key = true;
    Series series = *shown.series;
    if (!remark.empty()) series.words += ", " + remark;
    for (const auto& [phase, points] : shown.curves) {
        const bool loading = phase == Phase::load;
        const auto look = cast.is_reference(*shown.series)
                              ? (loading ? CurveLook::points : CurveLook::open_points)
                              : (loading ? CurveLook::line : CurveLook::dashed);
        auto named = words;
        named.x += loading ? ", loading" : ", unloading";
        append(traces, curve_traces(series, chart_colour(cast, *shown.series), points, look, named, in_key));
        in_key = false;
    }
}

bool several_replicas(const RunFigure& figure) {
    for (const auto& shown : figure.series)
        if (shown.series->setting.replicas.size() > 1) return true;
    return false;
}

/// What lines, points and bands mean.
std::string caption(const Cast& cast, const RunFigure& figure) {
    return std::string("Solid lines: loading, dashed: unloading.") +
           (cast.reference ? " Points: the reference, full while loading, open while unloading." : "") +
           (several_replicas(figure) ? " Bands and bars: one standard error over replicas." : "");
}

Chart top_force_chart(const Cast& cast, const RunFigure& figure) {
    auto chart = chart_of(figure, "Force on the plate", caption(cast, figure));
    chart.log_axes = "xy";
    for (const auto& shown : figure.series)
        add_curves(chart.data, cast, shown, {"%{x:.2f} mm", "%{y:.4g} N", " ± %{customdata:.2g} N"});
    return chart;
}

Chart distribution_chart(const Cast& cast, const RunFigure& figure) {
    auto chart =
        chart_of(figure,
                 fmt::format("Contact forces at {:.1f} mm, {}ing", *figure.displacement,
                             name(figure.series.front().curves.front().phase)),
                 std::string("How often forces between grains are how large, at one level of compression.") +
                     (several_replicas(figure) ? " Bands: one standard error over replicas." : ""));
    for (const auto& [series, remark, curves, slope] : figure.series)
        append(chart.data, curve_traces(*series, chart_colour(cast, *series), curves.front().points,
                                        cast.is_reference(*series) ? CurveLook::points : CurveLook::line,
                                        {"%{x:.4g} mN", "%{y:.3g} per mN", " ± %{customdata:.2g}"}, true));
    chart.layout["yaxis"] = {
        {"title", {{"text", figure.y_label}}}, {"type", "log"}, {"dtick", "D2"}, {"exponentformat", "power"}};
    return chart;
}

Chart coordination_chart(const Cast& cast, const RunFigure& figure, const FigureOptions& options) {
    auto chart = chart_of(
        figure,
        is_thresholded(cast, options) ? "Contacts per grain, weak forces left out" : "Contacts per grain",
        caption(cast, figure));
    for (const auto& shown : figure.series)
        add_curves(chart.data, cast, shown, {"%{x:.2f} mm", "Z = %{y:.3f}", " ± %{customdata:.2g}"},
                   shown.remark);
    chart.layout["yaxis"] = {{"title", {{"text", figure.y_label}}}};
    return chart;
}

/// Points of loading (full) and unloading (open), and the line through zero.
void add_scaling(Json& traces, const Cast& cast, const FigureSeries& shown) {
    const auto colour = chart_colour(cast, *shown.series);
    const auto words = plot_text(shown.series->words);
    bool in_key = true;
    double end = 0;
    for (const auto& [phase, points] : shown.curves) {
        append(traces, curve_traces(*shown.series, colour, points,
                                    phase == Phase::load ? CurveLook::points : CurveLook::open_points,
                                    {"%{x:.4g} mN m", "%{y:.4g} N", " ± %{customdata:.2g} N"}, in_key));
        in_key = false;
        for (const auto& point : points) end = std::fmax(end, point.x);
    }
    const double first = end / 1000;  // not zero: that has no logarithm
    traces.push_back({{"type", "scatter"},
                      {"mode", "lines"},
                      {"x", {first, end}},
                      {"y", {shown.slope * first, shown.slope * end}},
                      {"line", {{"color", colour}, {"width", 1}}},
                      {"legendgroup", words},
                      {"showlegend", false},
                      {"name", words},
                      {"hovertemplate", fmt::format("slope {:.4g} /m", shown.slope * 1e3)}});
}

Chart scaling_chart(const Cast& cast, const RunFigure& figure) {
    auto chart = chart_of(figure, "Scaling law F ∝ ⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩",
                          "Full points: loading, open: unloading; lines through zero are fitted to both.");
    chart.log_axes = "xy";
    for (const auto& shown : figure.series) add_scaling(chart.data, cast, shown);
    return chart;
}

/// Of a programme: one line through its scans.
Chart programme_chart(const Cast& cast, const RunFigure& figure) {
    const bool by_time = figure.x_label.starts_with("time"), force = figure.y_label.starts_with("top");
    const std::string title = force ? "Force on the plate" : "Displacement of the plate";
    auto chart = chart_of(figure, title + (by_time ? " against time" : " against displacement"),
                          std::string("One scan after the other.") +
                              (several_replicas(figure) ? " Bands: one standard error over replicas." : ""));
    const PointWords words{by_time ? "%{x:.4g} s" : "%{x:.3f} mm", force ? "%{y:.4g} N" : "%{y:.3f} mm",
                           force ? " ± %{customdata:.2g} N" : " ± %{customdata:.2g} mm"};
    for (const auto& shown : figure.series)
        append(chart.data, curve_traces(*shown.series, chart_colour(cast, *shown.series),
                                        shown.curves.front().points, CurveLook::line, words, true));
    return chart;
}

}  // namespace

RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options) {
    const auto cast = cast_of(settings, reference, options);
    const auto prepared = run_figures(cast, options);
    RunCharts made;
    for (const auto& missing : prepared.missing) made.notes.push_back("No chart of " + missing + ".");
    for (const auto& figure : prepared.figures) {
        if (figure.name == "top_force") made.charts.push_back(top_force_chart(cast, figure));
        if (figure.name == "force_distribution") made.charts.push_back(distribution_chart(cast, figure));
        if (figure.name == "coordination") made.charts.push_back(coordination_chart(cast, figure, options));
        if (figure.name == "force_time" || figure.name == "displacement_time" ||
            figure.name == "force_displacement")
            made.charts.push_back(programme_chart(cast, figure));
        if (figure.name == "scaling") made.charts.push_back(scaling_chart(cast, figure));
    }
    return made;
}

}  // namespace mcdem::report
