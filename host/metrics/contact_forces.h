// Magnitudes of the contact forces in scans.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline metrics {

/// Whether contacts with walls are included.
enum class WallContacts { counted, left_out };

/// An empty list of contacts means "no contacts" only if Z is zero; otherwise contacts were not recorded.
bool contacts_known(const Scan& scan);

struct ForceLists {
    std::vector<double> grain_grain;  ///< |f| [N]
    std::vector<double> grain_wall;   ///< |f| [N]; empty if walls are left out
    int scans = 0;                    ///< number of scans with known contacts
};
ForceLists contact_forces(const std::vector<const Scan*>& scans, WallContacts walls);

}  // namespace mcdem::metrics
