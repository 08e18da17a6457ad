// The quantity in which `scan_at` lists the scans of a cell's move. If the move changes strains, it is a
// strain or shear, otherwise a stress: the one that changes or, of several, the mean of those with the same
// target, or else the one that changes most.
#pragma once
#include <array>
#include <bitset>
#include <utility>

#include "scene/programme/legs.h"

namespace mcdem::inline scene {

/// Mean of some strains or stresses.
struct ScanQuantity {
    bool of_stress = false;
    std::bitset<6> counts;     ///< the strains or stresses; none if only the run shows which change most
    double begin = not_given;  ///< at the start of the move, if known before the run
    double target = not_given;
    double mean(const std::array<double, 6>& values) const;
};

/// The quantity of each leg; of a hold, one without strains and stresses.
std::vector<ScanQuantity> scan_quantities(const std::vector<Stage>& stages, const std::vector<Leg>& legs);

/// "strain_z", "pressure", ..
std::string quantity_name(const Stage& stage, const ScanQuantity& quantity);

/// Stages whose scan_at a cell cannot follow, each with the reason.
std::vector<std::pair<int, std::string>> scan_at_problems(const std::vector<Stage>& stages,
                                                          const Plate& plate);

}  // namespace mcdem::scene
