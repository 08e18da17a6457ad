#include "metrics/top_force.h"

namespace mcdem::inline metrics {
namespace {

/// A level at one displacement, used for matching.
Levels level_at(Phase phase, double displacement) { return {{phase, displacement, {}}}; }

bool has(const Level& level, std::size_t replica) { return !level.scans[replica].empty(); }

}  // namespace

double full_stroke(const Levels& levels, const Replicas& replicas) {
    double end = not_available;
    for (const auto& level : levels)
        for (std::size_t r = 0; r < replicas.size(); ++r)
            if (!replicas[r]->failure && has(level, r)) end = std::fmax(end, level.displacement);
    return end;
}

Sample top_force_at(const Levels& levels, const Replicas& replicas, double displacement) {
    const auto forces = by_replica(levels, top_force);
    Sample sample{seeds_of(replicas), std::vector<double>(replicas.size(), not_available)};
    for (Phase phase : {Phase::load, Phase::unload}) {
        const auto at = at_reference(forces, match_levels(levels, level_at(phase, displacement)));
        for (std::size_t r = 0; r < replicas.size(); ++r)
            if (!std::isfinite(sample.value[r]) && at.rows() > 0) sample.value[r] = at(r, 0);
    }
    return sample;
}

TopForceRatio top_force_ratio(const Levels& simulated, const Replicas& simulated_replicas,
                              const Levels& reference, const Replicas& reference_replicas) {
    TopForceRatio ratio;
    ratio.reference_end = full_stroke(reference, reference_replicas);
    const double simulated_end = full_stroke(simulated, simulated_replicas);
    if (std::isnan(simulated_end) || std::isnan(ratio.reference_end)) return ratio;
    const bool ends_before = simulated_end < ratio.reference_end - level_tolerance;
    ratio.displacement = ends_before ? simulated_end : ratio.reference_end;
    ratio.Rtop = ratio_of_means(top_force_at(simulated, simulated_replicas, ratio.displacement),
                                top_force_at(reference, reference_replicas, ratio.displacement));
    return ratio;
}

LevelError rms_over_levels(const Eigen::ArrayXXd& simulated, const Eigen::ArrayXXd& reference,
                           const std::vector<Omission>& omissions) {
    LevelError error;
    for (const auto& omission : omissions) {
        const Eigen::ArrayXd difference =
            mean_without(simulated, omission.simulated) - mean_without(reference, omission.reference);
        double squares = 0;
        int used = 0;
        for (double d : difference)
            if (std::isfinite(d)) squares += d * d, ++used;
        error.by_omission.push_back(used ? std::sqrt(squares / used) : not_available);
        if (error.by_omission.size() == 1) error.levels_used = used;
    }
    return error;
}

LevelError top_force_error(const Levels& simulated, const Levels& reference,
                           const std::vector<LevelMatch>& matches, const std::vector<Omission>& omissions,
                           std::optional<double> touch_force) {
    const auto at = at_reference(by_replica(simulated, top_force), matches);
    auto measured = by_replica(reference, top_force);
    const Eigen::ArrayXd means = mean_without(measured, -1);
    for (Eigen::Index l = 0; l < measured.cols(); ++l)
        if (touch_force && !(means[l] > *touch_force)) measured.col(l) = not_available;
    return rms_over_levels(at, measured, omissions);
}

}  // namespace mcdem::metrics
