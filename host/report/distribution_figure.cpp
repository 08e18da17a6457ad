#include <fmt/format.h>

#include <algorithm>

#include "metrics/force_distribution.h"
#include "report/figure_parts.h"
#include "report/gnuplot.h"

namespace mcdem {
namespace {

using gnuplot::csv_field;
using gnuplot::csv_number;

constexpr double mN = 1e-3;

/// The level of the phase nearest to the displacement that has contacts; none where there is none.
const Level* nearest_level(const Series& series, const FigureOptions& options) {
    const Level* nearest = nullptr;
    const auto distance = [&](const Level& level) {
        return std::abs(level.displacement - options.distribution_displacement);
    };
    for (const auto& level : series.levels) {
        bool known = false;
        for (const auto& scans : level.scans)
            for (const auto* scan : scans) known = known || !scan->contacts.empty();
        if (level.phase == options.distribution_phase && known &&
            (!nearest || distance(level) < distance(*nearest)))
            nearest = &level;
    }
    return nearest;
}

std::vector<ShownDensity> shown_levels(const Cast& cast, const FigureOptions& options) {
    std::vector<ShownDensity> shown;
    for (const auto& series : cast.simulated) shown.push_back({&series, nearest_level(series, options), {}});
    if (cast.reference) shown.push_back({&*cast.reference, nearest_level(*cast.reference, options), {}});
    std::erase_if(shown, [](const ShownDensity& s) { return !s.level; });
    return shown;
}

/// Bins common to all: to the force that all but a few contacts stay below, as many as the fewest allow.
struct Bins {
    double largest = 0;  ///< [N]
    int count = 100;
};
Bins common_bins(const std::vector<ShownDensity>& shown, WallContacts walls) {
    Bins bins;
    for (const auto& [series, level, density] : shown) {
        std::vector<double> forces;
        for (const auto& scans : level->scans) {
            const auto of_replica = contact_forces(scans, walls);
            forces.insert(forces.end(), of_replica.grain_grain.begin(), of_replica.grain_grain.end());
            forces.insert(forces.end(), of_replica.grain_wall.begin(), of_replica.grain_wall.end());
        }
        if (forces.empty()) continue;
        std::sort(forces.begin(), forces.end());
        bins.largest = std::max(bins.largest, forces[(forces.size() - 1) * 999 / 1000]);
        const auto contacts = static_cast<double>(forces.size());
        bins.count = std::min(bins.count, std::clamp(bin_count(contacts, contacts), 8, 30));
    }
    return bins;
}

Rows density_rows(const ShownDensity& shown) {
    Rows rows;
    const auto& density = shown.density;
    for (std::size_t b = 0; b < density.force.size(); ++b)
        if (density.density[b].value > 0)  // the logarithm of an empty bin cannot be drawn
            rows.push_back({csv_number(density.force[b] / mN), csv_number(density.density[b].value * mN),
                            csv_number(density.density[b].standard_error * mN),
                            csv_number(shown.level->displacement * 1e3),
                            std::string(name(shown.level->phase)), csv_field(shown.series->setting.label)});
    return rows;
}

void draw_series(PlotScript& script, const Series& series, int block, bool is_reference) {
    const auto& colour = series.style.colour;
    if (is_reference) {
        script.plot(block, "using 1:2 with points linecolor rgb '#000000' pointtype 7 pointsize 0.6");
        script.key(series.words, "with points linecolor rgb '#000000' pointtype 7 pointsize 0.6");
        return;
    }
    if (series.setting.replicas.size() > 1)  // a third of the density where the band would reach zero
        script.plot(block, fmt::format("using 1:($2-$3 > $2/3 ? $2-$3 : $2/3):($2+$3) with filledcurves "
                                       "linecolor rgb '{}'",
                                       colour));
    script.plot(block, fmt::format("using 1:2 with lines linecolor rgb '{}' linewidth 1.8", colour));
    script.key(series.words, fmt::format("with lines linewidth 3 linecolor rgb '{}'", colour));
}

}  // namespace

std::vector<ShownDensity> shown_densities(const Cast& cast, const FigureOptions& options) {
    const auto walls = options.compare.walls_in_distribution;
    auto shown = shown_levels(cast, options);
    const auto bins = common_bins(shown, walls);
    if (!(bins.largest > 0)) return {};
    for (auto& one : shown) one.density = force_density(*one.level, bins.count, bins.largest, walls);
    return shown;
}

std::optional<Figure> distribution_figure(const Cast& cast, const FigureOptions& options) {
    const auto shown = shown_densities(cast, options);
    if (shown.empty()) return std::nullopt;
    PlotScript script("force_distribution", "Density of contact forces at one compression level.",
                      "force_mN,density_per_mN,standard_error_per_mN,displacement_mm,phase,setting");
    script.title(fmt::format("Contact forces at {:.1f} mm, {}ing", shown.front().level->displacement * 1e3,
                             name(options.distribution_phase)));
    script.set("xlabel 'contact force f [mN]'");
    script.set("ylabel 'density p(f) [1/mN]'");
    script.set("logscale y");
    script.set("format y '10^{%T}'");
    script.set("xrange [0:*]");
    bool bands = false;
    for (const auto& one : shown) {
        bands = bands || one.series->setting.replicas.size() > 1;
        const auto rows = density_rows(one);
        if (!rows.empty())
            draw_series(script, *one.series, script.add_block(rows), cast.is_reference(*one.series));
    }
    if (bands) script.key("± standard error", "with filledcurves linecolor rgb '#666666'");
    return script.figure();
}

}  // namespace mcdem
