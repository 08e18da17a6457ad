#include "report/run/run_charts.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/run/figure_values.h"

namespace mcdem::inline report {
namespace {

bool several_replicas(const RunFigure& figure) {
    return std::ranges::any_of(
        figure.series, [](const FigureSeries& shown) { return shown.series->setting.replicas.size() > 1; });
}

std::string bands_words(const RunFigure& figure) {
    return several_replicas(figure) ? " Bands: one standard error over replicas." : "";
}

/// Meaning of lines, points and bands.
std::string phases_words(const Cast& cast, const RunFigure& figure) {
    return std::string("Solid lines: loading, dashed: unloading.") +
           (cast.reference ? " Points: the reference, full while loading, open while unloading." : "") +
           (several_replicas(figure) ? " Bands and bars: one standard error over replicas." : "");
}

/// Explanation of the axes of a programme, if necessary.
std::string axes_words(const RunFigure& figure) {
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

/// Title, caption and axes that can be made logarithmic.
Chart chart_of(const RunFigure& figure, const Cast& cast, const FigureOptions& options) {
    const std::string& name = figure.name;
    if (name == "top_force") return {name, "Force on the plate", phases_words(cast, figure), {}, "xy"};
    if (name == "force_distribution")
        return {name,
                fmt::format("Contact forces at {:.1f} mm, {}ing", *figure.displacement,
                            mcdem::name(figure.series.front().curves.front().phase)),
                "How often forces between grains are how large, at one level of compression." +
                    bands_words(figure),
                {}};
    if (name == "coordination")
        return {
            name,
            is_thresholded(cast, options) ? "Contacts per grain, weak forces left out" : "Contacts per grain",
            phases_words(cast, figure),
            {}};
    if (name == "scaling")
        return {name,
                "Scaling law F ∝ ⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩",
                "Full points: loading, open: unloading; lines through zero are fitted to both.",
                {},
                "xy"};
    return {name,
            figure.title,
            "One scan after the other." + axes_words(figure) + bands_words(figure),
            {},
            name == "pressure_strain" ? "y" : ""};
}

}  // namespace

RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options) {
    const auto cast = cast_of(settings, reference, options);
    const auto prepared = run_figures(cast, options);
    const Json values = figure_values(prepared, cast);
    RunCharts made;
    for (const auto& missing : prepared.missing) made.notes.push_back("No chart of " + missing + ".");
    for (const auto& figure : prepared.figures) {
        made.charts.push_back(chart_of(figure, cast, options));
        made.charts.back().values = values.at(figure.name);
    }
    return made;
}

}  // namespace mcdem::report
