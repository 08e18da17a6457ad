// A recording as one vector: every observable at a few displacements of loading and of unloading.
#pragma once
#include <vector>

#include "diagnose/observe/scan_observables.h"
#include "scene/programme.h"

namespace mcdem::inline diagnose {

/// A hold of a programme: the scans at its beginning and its end. Those in between belong to no stroke.
struct HoldScans {
    int begin = 0, first = 0, end = 0;  ///< scans; the first one that is taken during the hold
    Controlled keep = Controlled::position;
    Phase phase = Phase::load;
    double displacement = 0;  ///< of the experiment [m]
    bool operator==(const HoldScans&) const = default;
};

/// Where recordings are compared: displacements of the plate, and the width over which scans are smoothed.
struct Grid {
    std::vector<double> displacement;  ///< [m]
    double width = 0;                  ///< scans nearer than this count, the nearest most [m]
    double stroke = 0;                 ///< of the experiment [m]
    /// Where the programme sets forces: those that the experiment has at the displacements while loading.
    /// Scans are then sought by force, and the displacement is what is seen [N].
    std::vector<double> force = {};
    double force_width = 0;             ///< [N]
    std::vector<HoldScans> holds = {};  ///< of the programme, in its order
};

/// Four displacements of the experiment's stroke; the width takes in three scans at least.
Grid grid_of(const Recording& experiment);

struct Cell {
    int observable = 0;  ///< index in observables()
    Phase phase = Phase::load;
    double displacement = 0;  ///< [m]
};

/// The cells of a grid: by observable, then phase, then displacement.
std::vector<Cell> cells_of(const Grid& grid);

/// One value a cell; not-a-number where the recording does not tell. Cycles after `discard` are averaged.
/// What a hold shows counts where its displacement is nearest.
/// Within the width of a cell a straight line is fitted through the scans (local linear regression,
/// triangular weights), so that scans need not lie at the same displacements in what is compared.
Eigen::VectorXd observe(const Recording& recording, const Grid& grid, const ReferenceMaterial& material,
                        int discard = 0);

}  // namespace mcdem::diagnose
