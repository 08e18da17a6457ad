// Rtop and errf: the force on the plate, simulated against reference.
#pragma once
#include "metrics/levels.h"

namespace mcdem::inline metrics {

/// Greatest displacement reached by replicas that did not fail [m]; not-a-number where all failed.
double full_stroke(const Levels& levels, const Replicas& replicas);

/// Top force of each replica at a displacement [N]: on the loading branch, or on the unloading one where
/// loading does not reach it (a turning point counts as either).
Sample top_force_at(const Levels& levels, const Replicas& replicas, double displacement, double tolerance);

/// Ratio of mean top forces at maximum compression. Where the simulation ends before the reference, at
/// the end of the simulation: `displacement` says where.
struct TopForceRatio {
    Estimate Rtop;
    double displacement = not_available;   ///< [m]
    double reference_end = not_available;  ///< maximum compression of the reference [m]
};
TopForceRatio top_force_ratio(const Levels& simulated, const Replicas& simulated_replicas,
                              const Levels& reference, const Replicas& reference_replicas, double tolerance);

/// An RMS over levels, under each of the jackknife's omissions.
struct LevelError {
    std::vector<double> by_omission;
    int levels_used = 0;
};

/// RMS over the levels where both are finite.
LevelError rms_over_levels(const Eigen::ArrayXXd& simulated, const Eigen::ArrayXXd& reference,
                           const std::vector<Omission>& omissions);

/// errf [N]: RMS over the levels of both phases of the difference of the cycle-averaged top force. Levels
/// where the reference's mean force is not above `touch_force` are left out; none: all levels count.
LevelError top_force_error(const Levels& simulated, const Levels& reference,
                           const std::vector<LevelMatch>& matches, const std::vector<Omission>& omissions,
                           std::optional<double> touch_force = std::nullopt);

}  // namespace mcdem::metrics
