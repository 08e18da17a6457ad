// What the four figures share: settings made ready for drawing, and curves over the displacement.
#pragma once
#include <functional>
#include <optional>

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
};

/// The settings that have scans left after their discarded cycles.
Cast cast_of(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
             const FigureOptions& options);

/// Rows `displacement [mm], value, standard error, phase, setting` of one phase. Unloading starts at the
/// turning point, which is the last scan of loading.
using Rows = std::vector<std::vector<std::string>>;
Rows curve_rows(const Series& series, const std::vector<LevelMean>& means, Phase phase);

/// Value over displacement: bands, lines (loading whole, unloading dashed) and the reference's points
/// (loading full, unloading open).
void draw_curves(PlotScript& script, const Cast& cast,
                 const std::function<std::vector<LevelMean>(const Series&)>& means_of);

/// The key: the series in the order given, then what lines, points and bands mean.
void draw_key(PlotScript& script, const Cast& cast,
              const std::function<std::string(const Series&)>& words_of);

Figure top_force_figure(const Cast& cast);
std::optional<Figure> distribution_figure(const Cast& cast, const FigureOptions& options);
std::optional<Figure> coordination_figure(const Cast& cast, const FigureOptions& options);
std::optional<Figure> scaling_figure(const Cast& cast);

}  // namespace mcdem
