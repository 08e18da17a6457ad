// The magnitudes of the contact forces in scans, as the metrics on contacts need them.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline metrics {

/// Whether a grain's contact with a wall is one of its contacts.
enum class WallContacts { counted, left_out };

/// An empty list of contacts means that there were none only where Z was found to be zero; else that
/// they were not recorded.
bool contacts_known(const Scan& scan);

struct ForceLists {
    std::vector<double> grain_grain;  ///< |f| [N]
    std::vector<double> grain_wall;   ///< |f| [N]; empty where walls are left out
    int scans = 0;                    ///< scans with known contacts that they come from
};
ForceLists contact_forces(const std::vector<const Scan*>& scans, WallContacts walls);

}  // namespace mcdem::metrics
