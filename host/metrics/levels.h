// Scans of one setting sorted into compression levels: the same phase and the same plate displacement.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "metrics/estimate.h"
#include "metrics/replicas.h"

namespace mcdem::inline metrics {

struct LevelOptions {
    std::optional<int> discard =
        std::nullopt;  ///< first cycles left out; none: each recording's own `protocol.discard`
    /// Displacements closer than this to a level's mean belong to it [m]. Where a recording's own scans lie
    /// closer (recorded in passing), a third of their median spacing takes its place.
    double tolerance = 0.1e-3;
};

struct Level {
    Phase phase = Phase::load;
    double displacement = 0;                      ///< mean over its scans [m]
    std::vector<std::vector<const Scan*>> scans;  ///< by replica: one for each cycle that came here
};

/// Loading levels first, each phase by growing displacement.
using Levels = std::vector<Level>;
Levels group_levels(const Replicas& replicas, const LevelOptions& options = {});

/// What is looked at in a scan; not-a-number where the scan does not have it.
using Quantity = std::function<double(const Scan&)>;
double top_force(const Scan& scan);

/// Row: replica, column: level. Mean over the cycles that have the quantity, not-a-number where none has.
Eigen::ArrayXXd by_replica(const Levels& levels, const Quantity& quantity);

struct LevelMean {
    Phase phase = Phase::load;
    double displacement = 0;  ///< [m]
    Estimate mean;            ///< over replicas of their means over cycles
};
std::vector<LevelMean> level_means(const Levels& levels, const Quantity& quantity);

/// Where a level of the reference lies among simulated ones: (1 - weight) of `below` + weight of `above`.
struct LevelMatch {
    int below = -1;  ///< index of a level, -1 where the reference's level is out of reach
    int above = -1;
    double weight = 0;
    bool found() const { return below >= 0; }
};

/// One match for each reference level: its own level where one lies within the tolerance, else linear
/// between the two neighbours of the same phase (always so where simulated levels lie close together).
/// Never beyond the outermost levels.
std::vector<LevelMatch> match_levels(const Levels& simulated, const Levels& reference, double tolerance);

/// Columns of `values` (by replica and simulated level) brought onto the reference's levels.
Eigen::ArrayXXd at_reference(const Eigen::ArrayXXd& values, const std::vector<LevelMatch>& matches);

/// Mean over replicas (rows) of what is finite, one of them left out (-1: none).
Eigen::ArrayXd mean_without(const Eigen::ArrayXXd& values, int left_out);

}  // namespace mcdem::metrics
