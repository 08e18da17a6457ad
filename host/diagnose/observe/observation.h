// A recording as one vector: every observable at several displacements of loading and of unloading.
#pragma once
#include <vector>

#include "diagnose/observe/scan_observables.h"
#include "scene/programme.h"

namespace mcdem::inline diagnose {

/// A hold of a programme: the scans at its start and its end. The scans in between belong to no stroke.
struct HoldScans {
    int begin = 0, first = 0, end = 0;  ///< scans; `first` is the first one taken during the hold
    Controlled keep = Controlled::position;
    Phase phase = Phase::load;
    double displacement = 0;  ///< of the experiment [m]
    bool operator==(const HoldScans&) const = default;
};

/// Displacements at which recordings are compared, and the width over which scans are smoothed.
struct Grid {
    std::vector<double> displacement;  ///< [m]
    double width = 0;                  ///< scans within this distance contribute, with decreasing weight [m]
    double stroke = 0;                 ///< of the experiment [m]
    /// If the programme sets forces: the experiment's forces at the displacements while loading. Scans are
    /// then selected by force, and the displacement is the observable [N].
    std::vector<double> force = {};
    double force_width = 0;             ///< [N]
    std::vector<HoldScans> holds = {};  ///< of the programme, in order
};

/// Four displacements of the experiment's stroke; the width covers at least three scans.
Grid grid_of(const Recording& experiment);

struct Bin {
    int observable = 0;  ///< index in observables()
    Phase phase = Phase::load;
    double displacement = 0;  ///< [m]
};

/// The bins of a grid: by observable, then phase, then displacement.
std::vector<Bin> bins_of(const Grid& grid);

/// One value per bin; NaN if the recording does not determine it. Cycles after `discard` are averaged. A
/// hold is assigned to the nearest displacement. Within the width of a bin a straight line is fitted through
/// the scans (local linear regression, triangular weights), so the recordings that are compared need not have
/// scans at the same displacements.
Eigen::VectorXd observe(const Recording& recording, const Grid& grid, const ReferenceMaterial& material,
                        int discard = 0);

}  // namespace mcdem::diagnose
