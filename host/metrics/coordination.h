// Z(tau): contacts per grain once contacts with |f| < tau are ignored; errZ: how far it is from the
// reference, with the tau that brings it closest.
//
// A contact between two grains counts for both of them, a contact with a wall for one grain; whether
// walls count at all is a choice (as in Scan: they do).
#pragma once
#include "metrics/contact_forces.h"
#include "metrics/levels.h"

namespace mcdem::inline metrics {

/// Sorted contact forces of every replica at every level: Z at any threshold is two binary searches.
class Coordination {
public:
    Coordination(const Levels& levels, const Replicas& replicas, WallContacts walls);
    /// Row: replica, column: level. Not-a-number where contacts were not recorded.
    Eigen::ArrayXXd at_threshold(double tau) const;
    /// About `count` forces spread evenly over the contacts of all levels, ascending, from 0 on [N].
    std::vector<double> candidate_thresholds(int count) const;
    bool known() const;

private:
    struct Cell {
        ForceLists forces;
        double grain_scans = 0;  ///< grains times scans: what contacts are divided by
    };
    const Cell& cell(Eigen::Index replica, Eigen::Index level) const {
        return cells_[replica * levels_ + level];
    }
    Eigen::Index replicas_, levels_;
    std::vector<Cell> cells_;
};

/// Z of a reference, by replica and level: from its contacts where recorded, else as recorded per scan.
Eigen::ArrayXXd reference_coordination(const Levels& levels, const Replicas& replicas, WallContacts walls);

struct CoordinationError {
    Estimate errZ;
    Estimate tau;  ///< [N]; not available where contacts were not recorded (errZ is then without threshold)
    int levels_used = 0;
};

/// Minimises the RMS over levels of Z(tau) - Z_reference over tau. The objective is piecewise constant (a
/// step at every contact force) and may have several local minima: it is scanned at forces spread evenly
/// over the contacts, then again, ever finer, about the best; tau is the middle of the best interval.
/// Standard errors by jackknife: of errZ at that tau (where it is stationary), of tau from a parabola.
CoordinationError coordination_error(const Levels& simulated, const Replicas& simulated_replicas,
                                     const Eigen::ArrayXXd& reference, const std::vector<LevelMatch>& matches,
                                     const Jackknife& jackknife, WallContacts walls);

}  // namespace mcdem::metrics
