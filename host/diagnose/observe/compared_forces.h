// Forces on the plate that a diagnosis can compare.
#pragma once
#include <vector>

#include "diagnose/observe/observation.h"

namespace mcdem::inline diagnose {

/// Minimum number of bins that an experiment and its simulations must have in common.
inline constexpr std::size_t min_bins = 4;

struct ComparedForces {
    std::vector<double> displacement;  ///< where forces are compared, while loading and unloading [m]
    std::size_t known = 0;             ///< number of these places with a force above 0
};
ComparedForces compared_forces(const Recording& recording);

}  // namespace mcdem::diagnose
