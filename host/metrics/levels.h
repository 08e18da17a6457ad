// Scans of one setting grouped by compression level: the same phase and the same plate displacement.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "metrics/estimate.h"
#include "metrics/replicas.h"

namespace mcdem::inline metrics {

/// Displacements within this distance of a level's mean belong to it [m]. If the scans of a recording are
/// closer (recorded without stopping), a third of their median spacing is used.
inline constexpr double level_tolerance = 0.1e-3;

struct Level {
    Phase phase = Phase::load;
    double displacement = 0;  ///< mean over its scans [m]
    std::vector<std::vector<const Scan*>>
        scans;  ///< by replica: one scan for each cycle that reached the level
};

/// Loading levels first; each phase in order of increasing displacement. Without the first cycles that each
/// recording's `protocol.discard` leaves out.
using Levels = std::vector<Level>;
Levels group_levels(const Replicas& replicas);

/// A quantity of a scan; NaN if the scan does not have it.
using Quantity = std::function<double(const Scan&)>;
double top_force(const Scan& scan);

/// Row: replica, column: level. Mean over the cycles that have the quantity; NaN if there are none.
Eigen::ArrayXXd by_replica(const Levels& levels, const Quantity& quantity);

struct LevelMean {
    Phase phase = Phase::load;
    double displacement = 0;  ///< [m]
    Estimate mean;            ///< over replicas, of their means over cycles
};
/// Of values by replica (rows) and level (columns), or of a quantity.
std::vector<LevelMean> level_means(const Levels& levels, const Eigen::ArrayXXd& values);
std::vector<LevelMean> level_means(const Levels& levels, const Quantity& quantity);

/// Position of a reference level among simulated ones: (1 - weight) of `below` + weight of `above`.
struct LevelMatch {
    int below = -1;  ///< index of a level; -1 if the reference level is out of range
    int above = -1;
    double weight = 0;
    bool found() const { return below >= 0; }
};

/// One match for each reference level: a simulated level within the tolerance, otherwise linear interpolation
/// between the two neighbours of the same phase (always if simulated levels are close together). No
/// extrapolation.
std::vector<LevelMatch> match_levels(const Levels& simulated, const Levels& reference);

/// Columns of `values` (by replica and simulated level) interpolated to the reference levels.
Eigen::ArrayXXd at_reference(const Eigen::ArrayXXd& values, const std::vector<LevelMatch>& matches);

/// Mean of the finite values over replicas (rows) without row `left_out` (-1: all rows).
Eigen::ArrayXd mean_without(const Eigen::ArrayXXd& values, int left_out);

}  // namespace mcdem::metrics
