// Rtop and errf: simulated force on the plate compared with a reference.
#pragma once
#include "metrics/levels.h"

namespace mcdem::inline metrics {

/// Largest displacement reached by replicas that did not fail [m]; NaN if all failed.
double full_stroke(const Levels& levels, const Replicas& replicas);

/// Top force of each replica at a displacement [N]: on the loading branch, or on the unloading branch if
/// loading does not reach it (a turning point belongs to both).
Sample top_force_at(const Levels& levels, const Replicas& replicas, double displacement);

/// Ratio of mean top forces at maximum compression. If the simulation ends before the reference, the ratio is
/// taken at the end of the simulation (`displacement`).
struct TopForceRatio {
    Estimate Rtop;
    double displacement = not_available;   ///< [m]
    double reference_end = not_available;  ///< maximum compression of the reference [m]
};
TopForceRatio top_force_ratio(const Levels& simulated, const Replicas& simulated_replicas,
                              const Levels& reference, const Replicas& reference_replicas);

/// RMS over levels, for each omission of the jackknife.
struct LevelError {
    std::vector<double> by_omission;
    int levels_used = 0;
};

/// RMS over the levels at which both are finite.
LevelError rms_over_levels(const Eigen::ArrayXXd& simulated, const Eigen::ArrayXXd& reference,
                           const std::vector<Omission>& omissions);

/// errf [N]: RMS difference of the cycle-averaged top force over the levels of both phases. Levels at which
/// the reference's mean force does not exceed `touch_force` are ignored; default: all levels are used.
LevelError top_force_error(const Levels& simulated, const Levels& reference,
                           const std::vector<LevelMatch>& matches, const std::vector<Omission>& omissions,
                           std::optional<double> touch_force = std::nullopt);

}  // namespace mcdem::metrics
