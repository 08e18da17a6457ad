#include "report/figure_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/gnuplot.h"
#include "report/labels.h"

namespace mcdem {
namespace {

using gnuplot::csv_field;
using gnuplot::csv_number;

std::optional<Comparison> comparison_of(const Setting& setting, const std::optional<Setting>& reference,
                                        const FigureOptions& options) {
    if (!reference) return std::nullopt;
    for (const auto& comparison : options.comparisons)
        if (comparison.setting == setting.label) return comparison;
    return compare(setting, reference->replicas, options.compare);
}

std::vector<std::string> curve_row(const Series& series, const LevelMean& level) {
    return {csv_number(level.displacement * 1e3), csv_number(level.mean.value),
            csv_number(level.mean.standard_error), std::string(name(level.phase)),
            csv_field(series.setting.label)};
}

/// A long label would leave no room for the plot.
std::string key_words(const Setting& setting) { return shortened(words_for(setting.label), 44); }

bool has_errors(const Series& series) { return series.setting.replicas.size() > 1; }

void draw_line(PlotScript& script, const Series& series, int block, Phase phase) {
    if (has_errors(series))
        script.plot(block, fmt::format("using 1:($2-$3):($2+$3) with filledcurves linecolor rgb '{}'",
                                       series.style.colour));
    script.plot(block, fmt::format("using 1:2 with lines linecolor rgb '{}' linewidth 1.8 dashtype {}",
                                   series.style.colour, phase == Phase::load ? "1" : "'-'"));
}

void draw_points(PlotScript& script, const Series& series, int block, Phase phase) {
    const int shape = phase == Phase::load ? series.style.filled_point : series.style.open_point;
    const auto look =
        fmt::format("linecolor rgb '{}' pointtype {} pointsize 0.6", series.style.colour, shape);
    script.plot(block,
                (has_errors(series) ? "using 1:2:3 with yerrorbars " : "using 1:2 with points ") + look);
}

}  // namespace

Cast cast_of(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
             const FigureOptions& options) {
    Cast cast;
    const auto styles = styles_of(settings);
    for (std::size_t s = 0; s < settings.size(); ++s) {
        auto levels = group_levels(settings[s].replicas, options.compare.levels);
        if (!levels.empty())
            cast.simulated.push_back({key_words(settings[s]), styles[s], settings[s], std::move(levels),
                                      comparison_of(settings[s], reference, options)});
    }
    if (reference)
        cast.reference = Series{key_words(*reference), reference_style(), *reference,
                                group_levels(reference->replicas, options.compare.levels), std::nullopt};
    return cast;
}

std::vector<LevelMean> curve_levels(const std::vector<LevelMean>& means, Phase phase) {
    std::vector<LevelMean> levels;
    const LevelMean* turning = nullptr;
    for (const auto& level : means) {
        if (!level.mean.available()) continue;
        if (level.phase == Phase::load) turning = &level;
        if (level.phase == phase) levels.push_back(level);
    }
    if (phase == Phase::unload && turning && !levels.empty() &&
        turning->displacement > levels.back().displacement)
        levels.push_back(*turning);
    return levels;
}

Rows curve_rows(const Series& series, const std::vector<LevelMean>& means, Phase phase) {
    Rows rows;
    for (const auto& level : curve_levels(means, phase)) rows.push_back(curve_row(series, level));
    return rows;
}

void draw_curves(PlotScript& script, const Cast& cast,
                 const std::function<std::vector<LevelMean>(const Series&)>& means_of) {
    const auto each_phase = [&](const Series& series, auto draw) {
        const auto means = means_of(series);
        for (Phase phase : {Phase::load, Phase::unload})
            if (const auto rows = curve_rows(series, means, phase); !rows.empty())
                draw(script, series, script.add_block(rows), phase);
    };
    for (const auto& series : cast.simulated) each_phase(series, draw_line);
    if (cast.reference) each_phase(*cast.reference, draw_points);
}

void draw_key(PlotScript& script, const Cast& cast,
              const std::function<std::string(const Series&)>& words_of) {
    const std::string grey = "linecolor rgb '#666666'";
    for (const auto& series : cast.simulated)
        script.key(words_of(series),
                   fmt::format("with lines linewidth 3 linecolor rgb '{}'", series.style.colour));
    if (cast.reference)
        script.key(words_of(*cast.reference),
                   "with points linecolor rgb '#000000' pointtype 7 pointsize 0.6");
    script.key(" ", "with lines linecolor rgb 'white'");
    script.key(cast.reference ? "loading (points: full)" : "loading", "with lines linewidth 1.8 " + grey);
    script.key(cast.reference ? "unloading (points: open)" : "unloading",
               "with lines linewidth 1.8 dashtype '-' " + grey);
    if (std::any_of(cast.simulated.begin(), cast.simulated.end(), has_errors))
        script.key("± standard error", "with filledcurves " + grey);
}

}  // namespace mcdem
