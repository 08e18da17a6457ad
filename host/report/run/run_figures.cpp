#include "report/run/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "metrics/coordination.h"
#include "metrics/programmes.h"
#include "metrics/scaling.h"
#include "report/page/labels.h"
#include "report/run/programme_figures.h"

namespace mcdem::inline report {
namespace {

constexpr double mN_m = 1e-3;
constexpr std::size_t key_characters = 44;  ///< longer labels would leave no space for the curves

std::optional<Comparison> comparison_of(const Setting& setting, const std::optional<Setting>& reference,
                                        const FigureOptions& options) {
    if (!reference) return std::nullopt;
    for (const auto& comparison : options.comparisons)
        if (comparison.setting == setting.label) return comparison;
    return compare(setting, reference->replicas, options.compare);
}

std::string key_words(const Setting& setting) { return shortened(words_for(setting.label), key_characters); }

bool is_programme(const Series& series) { return follows_programme(series.setting.replicas); }

void add_each(const Cast& cast, RunFigure& figure, const std::function<FigureSeries(const Series&)>& make) {
    const auto add = [&](const Series& series) {
        if (is_programme(series)) return;  // a programme has no levels
        auto shown = make(series);
        if (!shown.curves.empty()) figure.series.push_back(std::move(shown));
    };
    for (const auto& series : cast.simulated) add(series);
    if (cast.reference) add(*cast.reference);
}

/// The known levels of one phase. Unloading starts at the turning point, the last level of loading, which is
/// then last.
std::vector<FigurePoint> curve_points(const std::vector<LevelMean>& means, Phase phase) {
    std::vector<FigurePoint> points;
    const auto point_of = [](const LevelMean& level) -> FigurePoint {
        return {level.displacement / mm, level.mean.value, level.mean.standard_error};
    };
    const LevelMean* turning = nullptr;
    for (const auto& level : means) {
        if (!level.mean.available()) continue;
        if (level.phase == Phase::load) turning = &level;
        if (level.phase == phase) points.push_back(point_of(level));
    }
    if (phase == Phase::unload && turning && !points.empty() && turning->displacement / mm > points.back().x)
        points.push_back(point_of(*turning));
    return points;
}

std::vector<FigureCurve> curves_of(const std::function<std::vector<FigurePoint>(Phase)>& points_of) {
    std::vector<FigureCurve> curves;
    for (const Phase phase : {Phase::load, Phase::unload})
        if (auto points = points_of(phase); !points.empty()) curves.push_back({phase, std::move(points)});
    return curves;
}

std::vector<FigureCurve> curves_of(const std::vector<LevelMean>& means) {
    return curves_of([&](Phase phase) { return curve_points(means, phase); });
}

RunFigure top_force_figure(const Cast& cast) {
    RunFigure figure{"top_force", "plate displacement [mm]", "top force [N]", {}, {}};
    add_each(cast, figure, [](const Series& series) -> FigureSeries {
        const bool known = series.comparison && series.comparison->Rtop.available();
        return {&series, known ? fmt::format("Rtop {:.2f}", series.comparison->Rtop.value) : "",
                curves_of(level_means(series.levels, top_force))};
    });
    return figure;
}

RunFigure distribution_figure(const Cast& cast, const FigureOptions& options) {
    RunFigure figure{"force_distribution", "contact force f [mN]", "density p(f) [1/mN]", {}, {}};
    for (const auto& [series, level, density] : shown_densities(cast, options)) {
        figure.displacement = figure.displacement.value_or(level->displacement / mm);
        std::vector<FigurePoint> points;
        for (std::size_t b = 0; b < density.force.size(); ++b)
            if (density.density[b].value > 0)  // the logarithm of an empty bin cannot be drawn
                points.push_back({density.force[b] / mN, density.density[b].value * mN,
                                  density.density[b].standard_error * mN});
        if (!points.empty()) figure.series.push_back({series, "", {{level->phase, std::move(points)}}});
    }
    return figure;
}

/// Force threshold of Z [N], if weaker forces are left out.
std::optional<double> threshold_of(const Series& series, const FigureOptions& options) {
    if (series.comparison)
        return series.comparison->tau.available() ? std::optional(series.comparison->tau.value)
                                                  : std::nullopt;
    return options.threshold > 0 ? std::optional(options.threshold) : std::nullopt;
}

/// Z of the series at its threshold; as recorded without contacts, and for the reference.
std::vector<LevelMean> coordination_means(const Cast& cast, const Series& series,
                                          const FigureOptions& options) {
    const auto walls = options.compare.walls_in_coordination;
    Eigen::ArrayXXd z = reference_coordination(series.levels, series.setting.replicas, walls);
    if (const Coordination counted(series.levels, series.setting.replicas, walls);
        !cast.is_reference(series) && counted.known())
        z = counted.at_threshold(threshold_of(series, options).value_or(0));
    std::vector<LevelMean> means;
    for (std::size_t l = 0; l < series.levels.size(); ++l) {
        const Eigen::ArrayXd column = z.col(l);
        means.push_back({series.levels[l].phase, series.levels[l].displacement,
                         mean_over_replicas({column.data(), static_cast<std::size_t>(column.size())})});
    }
    return means;
}

RunFigure coordination_figure(const Cast& cast, const FigureOptions& options) {
    RunFigure figure{"coordination", "plate displacement [mm]", "contacts per grain Z", {}, {}};
    add_each(cast, figure, [&](const Series& series) -> FigureSeries {
        const auto tau = cast.is_reference(series) ? std::nullopt : threshold_of(series, options);
        return {&series, tau ? fmt::format("tau {:.2f} mN", *tau / mN) : "",
                curves_of(coordination_means(cast, series, options))};
    });
    return figure;
}

RunFigure scaling_figure(const Cast& cast) {
    RunFigure figure{"scaling", "⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩ [mN m]", "top force F [N]", {}, {}};
    add_each(cast, figure, [](const Series& series) -> FigureSeries {
        const auto all = scaling_points(series.levels);
        if (std::ranges::none_of(all, [](const ScalingPoint& p) { return p.product.value > 0; }))
            return {&series, "", {}};
        const auto points_of = [&](Phase phase) {
            std::vector<FigurePoint> points;
            for (const auto& p : all)
                if (p.phase == phase)
                    points.push_back({p.product.value / mN_m, p.top_force.value, p.top_force.standard_error});
            return points;
        };
        const double slope = fit_scaling(all).coefficient;
        return {&series, fmt::format("{:.0f} /m", slope), curves_of(points_of), slope * mN_m};
    });
    return figure;
}

}  // namespace

bool is_thresholded(const Cast& cast, const FigureOptions& options) {
    return std::ranges::any_of(
        cast.simulated, [&](const Series& series) { return threshold_of(series, options).has_value(); });
}

Cast cast_of(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
             const FigureOptions& options) {
    Cast cast;
    const auto styles = styles_of(settings);
    for (std::size_t s = 0; s < settings.size(); ++s) {
        const bool programme = follows_programme(settings[s].replicas);
        auto levels = programme ? Levels() : group_levels(settings[s].replicas, options.compare.levels);
        if (programme || !levels.empty())
            cast.simulated.push_back({key_words(settings[s]), styles[s], settings[s], std::move(levels),
                                      comparison_of(settings[s], reference, options)});
    }
    if (reference)
        cast.reference = Series{key_words(*reference), reference_style(), *reference,
                                group_levels(reference->replicas, options.compare.levels), std::nullopt};
    return cast;
}

RunFigures run_figures(const Cast& cast, const FigureOptions& options) {
    RunFigures made;
    if (cast.simulated.empty()) {
        made.missing.push_back("all: no scans are left after the discarded cycles");
        return made;
    }
    const auto take = [&](RunFigure figure, const char* missing) {
        if (!figure.series.empty())
            made.figures.push_back(std::move(figure));
        else
            made.missing.push_back(missing);
    };
    if (std::ranges::any_of(cast.simulated, &is_programme)) {
        for (auto& figure : programme_figures(cast)) made.figures.push_back(std::move(figure));
        if (std::ranges::all_of(cast.simulated, &is_programme)) return made;
    }
    take(top_force_figure(cast), "the top force: not known");
    take(distribution_figure(cast, options), "the force distribution: no contacts recorded");
    take(coordination_figure(cast, options), "Z: contacts per grain are not known");
    take(scaling_figure(cast), "the scaling law: averages over the packing are not known");
    return made;
}

}  // namespace mcdem::report
