// What the four figures share: settings made ready for drawing, and curves over the displacement.
#pragma once
#include <functional>
#include <optional>

#include "metrics/force_distribution.h"
#include "report/figures.h"
#include "report/plot_script.h"

namespace mcdem {

/// One setting, or the reference.
struct Series {
    std::string words;  ///< its name in the key
    SeriesStyle style;
    Setting setting;
    Levels levels;
    std::optional<Comparison> comparison;  ///< with the reference
};

/// All that is drawn.
struct Cast {
    std::vector<Series> simulated;
    std::optional<Series> reference;
    bool is_reference(const Series& series) const { return reference && &series == &*reference; }
};

/// The settings that have scans left after their discarded cycles.
Cast cast_of(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
             const FigureOptions& options);

/// The levels of one phase that are known. Unloading starts at the turning point, the last level of loading,
/// which then comes last.
std::vector<LevelMean> curve_levels(const std::vector<LevelMean>& means, Phase phase);

/// Rows `displacement [mm], value, standard error, phase, setting` of those levels.
using Rows = std::vector<std::vector<std::string>>;
Rows curve_rows(const Series& series, const std::vector<LevelMean>& means, Phase phase);

/// Value over displacement: bands, lines (loading whole, unloading dashed) and the reference's points
/// (loading full, unloading open).
void draw_curves(PlotScript& script, const Cast& cast,
                 const std::function<std::vector<LevelMean>(const Series&)>& means_of);

/// The key: the series in the order given, then what lines, points and bands mean.
void draw_key(PlotScript& script, const Cast& cast,
              const std::function<std::string(const Series&)>& words_of);

/// Z of the series at its threshold; as recorded where there are no contacts, and for the reference.
std::vector<LevelMean> coordination_means(const Cast& cast, const Series& series,
                                          const FigureOptions& options);
/// Below which contact forces are left out in that [N].
double threshold_of(const Series& series, const FigureOptions& options);

/// p(f) of one series at the level nearest to the one asked for.
struct ShownDensity {
    const Series* series;
    const Level* level;
    ForceDensity density;
};
/// On bins common to all, to the force that all but a few contacts stay below; empty where nothing is known.
std::vector<ShownDensity> shown_densities(const Cast& cast, const FigureOptions& options);

Figure top_force_figure(const Cast& cast);
std::optional<Figure> distribution_figure(const Cast& cast, const FigureOptions& options);
std::optional<Figure> coordination_figure(const Cast& cast, const FigureOptions& options);
std::optional<Figure> scaling_figure(const Cast& cast);

}  // namespace mcdem
