// Magnitudes of the contact forces in scans.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline metrics {

struct ForceLists {
    std::vector<double> grain_grain;  ///< |f| [N]
    std::vector<double> grain_wall;   ///< |f| [N]
    int scans = 0;                    ///< number of scans whose contacts were recorded
};
ForceLists contact_forces(const std::vector<const Scan*>& scans);

}  // namespace mcdem::metrics
