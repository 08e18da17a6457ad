// Magnitudes of the contact forces in scans.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline metrics {

/// An empty list of contacts means "no contacts" only if Z is zero; otherwise contacts were not recorded.
bool contacts_known(const Scan& scan);

struct ForceLists {
    std::vector<double> grain_grain;  ///< |f| [N]
    std::vector<double> grain_wall;   ///< |f| [N]
    int scans = 0;                    ///< number of scans with known contacts
};
ForceLists contact_forces(const std::vector<const Scan*>& scans);

}  // namespace mcdem::metrics
