#include "metrics/levels.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"
#include "core/median.h"
#include "metrics/replicas.h"

namespace mcdem::inline metrics {
namespace {

struct Placed {
    double displacement;
    int replica;
    const Scan* scan;
};

std::vector<Placed> scans_of_phase(const Replicas& replicas, Phase phase) {
    std::vector<Placed> placed;
    for (std::size_t r = 0; r < replicas.size(); ++r) {
        const int discard = discard_of(*replicas[r]);
        for (const auto& scan : replicas[r]->scans) {
            const double displacement = replicas[r]->displacement(scan);
            if (scan.phase == phase && scan.cycle >= discard && std::isfinite(displacement))
                placed.push_back({displacement, static_cast<int>(r), &scan});
        }
    }
    std::stable_sort(placed.begin(), placed.end(),
                     [](const Placed& a, const Placed& b) { return a.displacement < b.displacement; });
    return placed;
}

/// Median distance between neighbouring scans of the same recording, phase and cycle [m]; infinite if there
/// are none.
double median_spacing(const Replicas& replicas) {
    std::vector<double> spacings;
    for (const auto* recording : replicas)
        for (std::size_t s = 1; s < recording->scans.size(); ++s) {
            const auto &a = recording->scans[s - 1], &b = recording->scans[s];
            const double spacing = std::abs(a.plate_z - b.plate_z);
            if (a.phase == b.phase && a.cycle == b.cycle && spacing > 0) spacings.push_back(spacing);
        }
    if (spacings.empty()) return std::numeric_limits<double>::infinity();
    return median(std::move(spacings));
}

/// A programme reaches the same displacement at different loads and times.
void expect_strokes(const Replicas& replicas) {
    for (const auto* recording : replicas)
        if (follows_programme(*recording))
            throw InputError(fmt::format(
                "{}: must be a run of the strokes of [plate] and [protocol] to be compared level by level, "
                "got one of a "
                "[[programme]]: its scans stand in plate.csv and run.h5, position and force against time",
                recording->label));
}

}  // namespace

Levels group_levels(const Replicas& replicas) {
    expect_strokes(replicas);
    const double tolerance = std::min(level_tolerance, median_spacing(replicas) / 3);
    Levels levels;
    for (Phase phase : {Phase::load, Phase::unload}) {
        int in_level = 0;
        for (const auto& [displacement, replica, scan] : scans_of_phase(replicas, phase)) {
            if (in_level == 0 || displacement - levels.back().displacement > tolerance) {
                levels.push_back({phase, 0, std::vector<std::vector<const Scan*>>(replicas.size())});
                in_level = 0;
            }
            auto& level = levels.back();
            ++in_level;
            level.displacement += (displacement - level.displacement) / in_level;
            level.scans[replica].push_back(scan);
        }
    }
    return levels;
}

double top_force(const Scan& scan) { return scan.top_force(); }

Eigen::ArrayXXd by_replica(const Levels& levels, const Quantity& quantity) {
    const auto replicas = levels.empty() ? 0 : levels.front().scans.size();
    Eigen::ArrayXXd values(replicas, levels.size());
    for (std::size_t l = 0; l < levels.size(); ++l)
        for (std::size_t r = 0; r < replicas; ++r) {
            std::vector<double> of_cycles;
            for (const auto* scan : levels[l].scans[r]) of_cycles.push_back(quantity(*scan));
            values(r, l) = mean_over_replicas(of_cycles).value;
        }
    return values;
}

std::vector<LevelMean> level_means(const Levels& levels, const Quantity& quantity) {
    return level_means(levels, by_replica(levels, quantity));
}

std::vector<LevelMean> level_means(const Levels& levels, const Eigen::ArrayXXd& values) {
    std::vector<LevelMean> means;
    for (std::size_t l = 0; l < levels.size(); ++l) {
        const Eigen::ArrayXd column = values.col(l);
        means.push_back({levels[l].phase, levels[l].displacement,
                         mean_over_replicas({column.data(), static_cast<std::size_t>(column.size())})});
    }
    return means;
}

std::vector<LevelMatch> match_levels(const Levels& simulated, const Levels& reference) {
    std::vector<LevelMatch> matches;
    for (const auto& wanted : reference) {
        int below = -1, above = -1;  // neighbouring levels; equal if a level matches
        for (std::size_t s = 0; s < simulated.size(); ++s) {
            if (simulated[s].phase != wanted.phase) continue;
            if (simulated[s].displacement <= wanted.displacement) below = static_cast<int>(s);
            if (simulated[s].displacement >= wanted.displacement && above < 0) above = static_cast<int>(s);
        }
        const auto distance = [&](int s) {
            return s < 0 ? std::numeric_limits<double>::infinity()
                         : std::abs(simulated[s].displacement - wanted.displacement);
        };
        const int nearest = distance(below) <= distance(above) ? below : above;
        const bool dense =
            below >= 0 && above >= 0 && distance(below) + distance(above) < 4 * level_tolerance;
        if (distance(nearest) <= level_tolerance && (!dense || below == above))
            matches.push_back({nearest, nearest, 0});
        else if (below >= 0 && above >= 0)
            matches.push_back({below, above, distance(below) / (distance(below) + distance(above))});
        else
            matches.push_back({});
    }
    return matches;
}

Eigen::ArrayXXd at_reference(const Eigen::ArrayXXd& values, const std::vector<LevelMatch>& matches) {
    Eigen::ArrayXXd at(values.rows(), matches.size());
    for (std::size_t l = 0; l < matches.size(); ++l) {
        const auto& [below, above, weight] = matches[l];
        if (below < 0)
            at.col(l) = not_available;
        else if (below == above)
            at.col(l) = values.col(below);
        else
            at.col(l) = (1 - weight) * values.col(below) + weight * values.col(above);
    }
    return at;
}

Eigen::ArrayXd mean_without(const Eigen::ArrayXXd& values, int left_out) {
    Eigen::ArrayXd mean(values.cols());
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
        double sum = 0;
        int count = 0;
        for (Eigen::Index row = 0; row < values.rows(); ++row)
            if (row != left_out && std::isfinite(values(row, column))) sum += values(row, column), ++count;
        mean[column] = count ? sum / count : not_available;
    }
    return mean;
}

}  // namespace mcdem::metrics
