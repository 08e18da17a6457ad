#include "report/run_charts.h"

#include <fmt/format.h>

#include <cmath>

#include "metrics/scaling.h"
#include "report/chart_parts.h"

namespace mcdem {
namespace {

constexpr double mm = 1e-3, mN = 1e-3;

Json axis(const std::string& title) { return {{"title", {{"text", title}}}, {"rangemode", "tozero"}}; }

std::vector<ChartPoint> points_of(const std::vector<LevelMean>& levels) {
    std::vector<ChartPoint> points;
    for (const auto& level : levels)
        points.push_back({level.displacement / mm, level.mean.value, level.mean.standard_error});
    return points;
}

/// Loading whole, unloading dashed; the reference as points, full and open.
void add_curves(Json& traces, const Cast& cast, const Series& series, const std::vector<LevelMean>& means,
                const PointWords& words) {
    bool in_key = true;
    const bool is_reference = cast.is_reference(series);
    for (const Phase phase : {Phase::load, Phase::unload}) {
        const auto points = points_of(curve_levels(means, phase));
        const auto look = is_reference ? (phase == Phase::load ? CurveLook::points : CurveLook::open_points)
                                       : (phase == Phase::load ? CurveLook::line : CurveLook::dashed);
        auto named = words;
        named.x += phase == Phase::load ? ", loading" : ", unloading";
        append(traces, curve_traces(series, chart_colour(cast, series), points, look, named, in_key));
        in_key = in_key && points.empty();
    }
}

template <class Draw>
void each_series(const Cast& cast, Draw draw) {
    for (const auto& series : cast.simulated) draw(series);
    if (cast.reference) draw(*cast.reference);
}

bool several_replicas(const Cast& cast) {
    bool several = false;
    each_series(cast, [&](const Series& series) { several = several || series.setting.replicas.size() > 1; });
    return several;
}

/// What lines, points and bands mean.
std::string caption(const Cast& cast) {
    return std::string("Whole lines: loading, dashed: unloading.") +
           (cast.reference ? " Points: the reference, full while loading, open while unloading." : "") +
           (several_replicas(cast) ? " Bands and bars: one standard error over replicas." : "");
}

Chart top_force_chart(const Cast& cast) {
    Chart chart{
        .name = "top_force", .title = "Force on the plate", .caption = caption(cast), .log_axes = "xy"};
    each_series(cast, [&](const Series& series) {
        add_curves(chart.data, cast, series, level_means(series.levels, top_force),
                   {"%{x:.2f} mm", "%{y:.4g} N", " ± %{customdata:.2g} N"});
    });
    chart.layout = {{"xaxis", axis("plate displacement [mm]")}, {"yaxis", axis("top force [N]")}};
    return chart;
}

std::optional<Chart> distribution_chart(const Cast& cast, const FigureOptions& options) {
    const auto shown = shown_densities(cast, options);
    if (shown.empty()) return std::nullopt;
    Chart chart{
        .name = "force_distribution",
        .title = fmt::format("Contact forces at {:.1f} mm, {}ing", shown.front().level->displacement / mm,
                             name(options.distribution_phase)),
        .caption =
            std::string("How often forces between grains are how large, at one level of compression.") +
            (several_replicas(cast) ? " Bands: one standard error over replicas." : "")};
    for (const auto& [series, level, density] : shown) {
        std::vector<ChartPoint> points;
        for (std::size_t b = 0; b < density.force.size(); ++b)
            if (density.density[b].value > 0)  // the logarithm of an empty bin cannot be drawn
                points.push_back({density.force[b] / mN, density.density[b].value * mN,
                                  density.density[b].standard_error * mN});
        append(chart.data, curve_traces(*series, chart_colour(cast, *series), points,
                                        cast.is_reference(*series) ? CurveLook::points : CurveLook::line,
                                        {"%{x:.4g} mN", "%{y:.3g} per mN", " ± %{customdata:.2g}"}, true));
    }
    chart.layout = {{"xaxis", axis("contact force f [mN]")},
                    {"yaxis",
                     {{"title", {{"text", "density p(f) [1/mN]"}}},
                      {"type", "log"},
                      {"dtick", "D2"},
                      {"exponentformat", "power"}}}};
    return chart;
}

std::optional<Chart> coordination_chart(const Cast& cast, const FigureOptions& options) {
    const bool thresholded = cast.reference || options.threshold > 0;
    Chart chart{.name = "coordination",
                .title = thresholded ? "Contacts per grain, weak forces left out" : "Contacts per grain",
                .caption = caption(cast)};
    each_series(cast, [&](const Series& series) {
        auto named = series;
        if (!cast.is_reference(series) && thresholded)
            named.words += fmt::format(", tau {:.2f} mN", threshold_of(series, options) / mN);
        Json traces = Json::array();
        add_curves(traces, cast, series, coordination_means(cast, series, options),
                   {"%{x:.2f} mm", "Z = %{y:.3f}", " ± %{customdata:.2g}"});
        for (auto& trace : traces) trace["name"] = plot_text(named.words);
        append(chart.data, traces);
    });
    if (chart.data.empty()) return std::nullopt;
    chart.layout = {{"xaxis", axis("plate displacement [mm]")},
                    {"yaxis", {{"title", {{"text", "contacts per grain Z"}}}}}};
    return chart;
}

/// Points of loading (full) and unloading (open), and the line through zero.
void add_scaling(Json& traces, const Cast& cast, const Series& series, double& largest) {
    constexpr double mN_m = 1e-3;
    const auto all = scaling_points(series.levels);
    double end = 0;
    for (const auto& p : all) end = std::fmax(end, p.product.value);
    if (!(end > 0)) return;
    largest = std::fmax(largest, end);
    const auto colour = chart_colour(cast, series);
    const double slope = fit_scaling(all).coefficient;
    bool in_key = true;
    for (const Phase phase : {Phase::load, Phase::unload}) {
        std::vector<ChartPoint> points;
        for (const auto& p : all)
            if (p.phase == phase)
                points.push_back({p.product.value / mN_m, p.top_force.value, p.top_force.standard_error});
        append(traces, curve_traces(series, colour, points,
                                    phase == Phase::load ? CurveLook::points : CurveLook::open_points,
                                    {"%{x:.4g} mN m", "%{y:.4g} N", " ± %{customdata:.2g} N"}, in_key));
        in_key = in_key && points.empty();
    }
    const double first = end / 1000;  // not zero: that has no logarithm
    traces.push_back({{"type", "scatter"},
                      {"mode", "lines"},
                      {"x", {first / mN_m, end / mN_m}},
                      {"y", {slope * first, slope * end}},
                      {"line", {{"color", colour}, {"width", 1}}},
                      {"legendgroup", plot_text(series.words)},
                      {"showlegend", false},
                      {"name", plot_text(series.words)},
                      {"hovertemplate", fmt::format("slope {:.4g} /m", slope)}});
}

std::optional<Chart> scaling_chart(const Cast& cast) {
    Chart chart{.name = "scaling",
                .title = "Scaling law F ∝ ⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩",
                .caption = "Full points: loading, open: unloading; lines through zero are fitted to both.",
                .log_axes = "xy"};
    double largest = 0;
    each_series(cast, [&](const Series& series) { add_scaling(chart.data, cast, series, largest); });
    if (!(largest > 0)) return std::nullopt;
    chart.layout = {{"xaxis", axis("⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩ [mN m]")}, {"yaxis", axis("top force F [N]")}};
    return chart;
}

}  // namespace

RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options) {
    RunCharts made;
    const auto cast = cast_of(settings, reference, options);
    if (cast.simulated.empty()) {
        made.notes.push_back("No charts: no scans are left after the discarded cycles.");
        return made;
    }
    const auto take = [&](std::optional<Chart> chart, const char* otherwise) {
        if (chart)
            made.charts.push_back(*std::move(chart));
        else
            made.notes.push_back(otherwise);
    };
    take(top_force_chart(cast), "");
    take(distribution_chart(cast, options), "No chart of the force distribution: no contacts recorded.");
    take(coordination_chart(cast, options), "No chart of Z: contacts per grain are not known.");
    take(scaling_chart(cast), "No chart of the scaling law: averages over the packing are not known.");
    return made;
}

}  // namespace mcdem
