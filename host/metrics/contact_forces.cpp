#include "metrics/contact_forces.h"

#include <cmath>

namespace mcdem::inline metrics {

ForceLists contact_forces(const std::vector<const Scan*>& scans) {
    ForceLists forces;
    for (const auto* scan : scans) {
        // An empty list means "no contacts" only if Z is zero; otherwise contacts were not recorded.
        if (scan->contacts.empty() && scan->coordination_number != 0) continue;
        ++forces.scans;
        for (const auto& contact : scan->contacts) {
            const double magnitude = contact.force.norm();
            if (!std::isfinite(magnitude)) continue;
            (is_wall(contact.partner) ? forces.grain_wall : forces.grain_grain).push_back(magnitude);
        }
    }
    return forces;
}

}  // namespace mcdem::metrics
