#include "report/run/run_charts.h"

#include <fmt/format.h>

#include <cmath>

#include "report/page/chart_parts.h"
#include "report/run/programme_figures.h"

namespace mcdem::inline report {
namespace {

Json axis(const std::string& title) { return {{"title", {{"text", title}}}, {"rangemode", "tozero"}}; }

/// The chart of a figure, without traces.
Chart chart_of(const RunFigure& figure, const std::string& title, const std::string& caption) {
    Chart chart{.name = figure.name, .title = title, .caption = caption};
    chart.layout = {{"xaxis", axis(figure.x_label)}, {"yaxis", axis(figure.y_label)}};
    return chart;
}

/// Loading solid, unloading dashed; the reference as points, filled and open.
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

/// Meaning of lines, points and bands.
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

/// Points of loading (filled) and unloading (open), and the line through the origin.
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

/// Explanation of the axes, if necessary.
std::string programme_words(const RunFigure& figure) {
    std::string words;
    const auto has = [&](const char* quantity) {
        return figure.x_label.starts_with(quantity) || figure.y_label.starts_with(quantity);
    };
    if (has("mean stress")) words += " p: a third of the stress tensor's trace, compression positive.";
    if (has("deviatoric stress")) words += " q = √(3/2 s:s) of its deviator s.";
    if (has("volume strain")) words += " Volume strain: part of the volume at start that is gone.";
    if (has("deviatoric strain"))
        words += " Deviatoric strain: √(2/3 e:e), e the deviator of the logarithmic strain.";
    return words;
}

/// Of a programme: one line through its scans.
Chart programme_chart(const Cast& cast, const RunFigure& figure) {
    auto chart = chart_of(figure, figure.title,
                          std::string("One scan after the other.") + programme_words(figure) +
                              (several_replicas(figure) ? " Bands: one standard error over replicas." : ""));
    const auto x = unit_of(figure.x_label), y = unit_of(figure.y_label);
    const auto with = [](const std::string& format, const std::string& unit) {
        return unit.empty() ? format : format + " " + unit;
    };
    const PointWords words{with("%{x:.4g}", x), with("%{y:.4g}", y), with(" ± %{customdata:.2g}", y)};
    for (const auto& shown : figure.series)
        append(chart.data, curve_traces(*shown.series, chart_colour(cast, *shown.series),
                                        shown.curves.front().points, CurveLook::line, words, true));
    if (figure.name == "pressure_strain") chart.log_axes = "y";
    if (figure.name == "cell_coordination")
        for (const char* name : {"xaxis", "yaxis"}) chart.layout[name].erase("rangemode");
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
        if (!figure.title.empty()) made.charts.push_back(programme_chart(cast, figure));
        if (figure.name == "scaling") made.charts.push_back(scaling_chart(cast, figure));
    }
    return made;
}

}  // namespace mcdem::report
