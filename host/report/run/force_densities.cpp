#include <algorithm>

#include "report/run/run_figures.h"

namespace mcdem::inline report {
namespace {

/// The level with contacts nearest to the displacement in this phase; null if there is none.
const Level* nearest_level(const Series& series, const FigureOptions& options, Phase phase) {
    const Level* nearest = nullptr;
    const auto distance = [&](const Level& level) {
        return std::abs(level.displacement - options.distribution_displacement);
    };
    for (const auto& level : series.levels) {
        bool known = false;
        for (const auto& scans : level.scans)
            for (const auto* scan : scans) known = known || !scan->contacts.empty();
        if (level.phase == phase && known && (!nearest || distance(level) < distance(*nearest)))
            nearest = &level;
    }
    return nearest;
}

/// In the phase of the options; in the other one if that has no contacts, as in runs that stopped early.
const Level* nearest_level(const Series& series, const FigureOptions& options) {
    const Phase wanted = options.distribution_phase;
    const Level* level = nearest_level(series, options, wanted);
    return level ? level
                 : nearest_level(series, options, wanted == Phase::load ? Phase::unload : Phase::load);
}

std::vector<ShownDensity> shown_levels(const Cast& cast, const FigureOptions& options) {
    std::vector<ShownDensity> shown;
    for (const auto& series : cast.simulated) shown.push_back({&series, nearest_level(series, options), {}});
    if (cast.reference) shown.push_back({&*cast.reference, nearest_level(*cast.reference, options), {}});
    std::erase_if(shown, [](const ShownDensity& s) { return !s.level; });
    return shown;
}

/// Common bins up to a force that few contacts exceed; their number follows from the smallest sample.
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

}  // namespace

std::vector<ShownDensity> shown_densities(const Cast& cast, const FigureOptions& options) {
    const auto walls = options.compare.walls_in_distribution;
    auto shown = shown_levels(cast, options);
    const auto bins = common_bins(shown, walls);
    if (!(bins.largest > 0)) return {};
    for (auto& one : shown) one.density = force_density(*one.level, bins.count, bins.largest, walls);
    return shown;
}

}  // namespace mcdem::report
