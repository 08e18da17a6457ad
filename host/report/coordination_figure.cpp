#include <fmt/format.h>

#include "metrics/coordination.h"
#include "report/figure_parts.h"

namespace mcdem {
double threshold_of(const Series& series, const FigureOptions& options) {
    if (!series.comparison) return options.threshold;
    return series.comparison->tau.available() ? series.comparison->tau.value : 0;
}

std::vector<LevelMean> coordination_means(const Cast& cast, const Series& series,
                                          const FigureOptions& options) {
    const auto walls = options.compare.walls_in_coordination;
    Eigen::ArrayXXd z = reference_coordination(series.levels, series.setting.replicas, walls);
    if (const Coordination counted(series.levels, series.setting.replicas, walls);
        !cast.is_reference(series) && counted.known())
        z = counted.at_threshold(threshold_of(series, options));
    std::vector<LevelMean> means;
    for (std::size_t l = 0; l < series.levels.size(); ++l) {
        const Eigen::ArrayXd column = z.col(l);
        means.push_back({series.levels[l].phase, series.levels[l].displacement,
                         mean_over_replicas({column.data(), static_cast<std::size_t>(column.size())})});
    }
    return means;
}

std::optional<Figure> coordination_figure(const Cast& cast, const FigureOptions& options) {
    const auto means_of = [&](const Series& series) { return coordination_means(cast, series, options); };
    bool any = false;
    for (const auto& series : cast.simulated)
        for (const auto& level : means_of(series)) any = any || level.mean.available();
    if (!any) return std::nullopt;

    PlotScript script("coordination", "Contacts per grain against plate displacement, weak forces left out.",
                      "displacement_mm,contacts_per_grain,standard_error,phase,setting");
    const bool thresholded = cast.reference || options.threshold > 0;
    script.title(thresholded ? "Contacts per grain, forces below tau left out" : "Contacts per grain");
    script.set("xlabel 'plate displacement [mm]'");
    script.set("xrange [0:*]");
    script.set("ylabel 'contacts per grain Z'");
    draw_curves(script, cast, means_of);
    draw_key(script, cast, [&](const Series& series) {
        if (cast.is_reference(series) || !thresholded) return series.words;
        return fmt::format("{}, tau {:.2f} mN", series.words, threshold_of(series, options) * 1e3);
    });
    return script.figure();
}

}  // namespace mcdem
