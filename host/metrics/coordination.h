// Z(tau): contacts per grain when contacts with |f| < tau are ignored. errZ: difference to the reference at
// the tau that minimises it.
//
// A contact between two grains counts for both, a contact with a wall for one grain.
#pragma once
#include "metrics/contact_forces.h"
#include "metrics/levels.h"

namespace mcdem::inline metrics {

/// Sorted contact forces of every replica at every level: Z at a threshold needs two binary searches.
class Coordination {
public:
    Coordination(const Levels& levels, const Replicas& replicas);
    /// Row: replica, column: level. NaN if contacts were not recorded.
    Eigen::ArrayXXd at_threshold(double tau) const;
    /// About `count` quantiles of the forces of all levels, ascending, starting at 0 [N].
    std::vector<double> candidate_thresholds(int count) const;
    bool known() const;

private:
    struct Cell {
        ForceLists forces;
        double grain_scans = 0;  ///< grains times scans; contacts are divided by it
    };
    const Cell& cell(Eigen::Index replica, Eigen::Index level) const {
        return cells_[replica * levels_ + level];
    }
    Eigen::Index replicas_, levels_;
    std::vector<Cell> cells_;
};

/// Z of a reference, by replica and level: computed from its contacts if recorded, otherwise as recorded per
/// scan.
Eigen::ArrayXXd reference_coordination(const Levels& levels, const Replicas& replicas);

struct CoordinationError {
    Estimate errZ;
    Estimate tau;  ///< [N]; not available if contacts were not recorded (errZ then has no threshold)
    int levels_used = 0;
};

/// Minimises the RMS over levels of Z(tau) - Z_reference over tau. The objective is piecewise constant (a
/// step at every contact force) and may have several local minima. It is scanned at quantiles of the forces,
/// then with increasing resolution around the best one; tau is the middle of the best interval. Standard
/// errors by jackknife: of errZ at that tau (where it is stationary), of tau from a parabola.
CoordinationError coordination_error(const Levels& simulated, const Replicas& simulated_replicas,
                                     const Eigen::ArrayXXd& reference, const std::vector<LevelMatch>& matches,
                                     const Jackknife& jackknife);

}  // namespace mcdem::metrics
