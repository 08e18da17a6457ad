// Overlaps beyond the tested range of a contact model.
#pragma once
#include <optional>

#include "metrics/replicas.h"

namespace mcdem::inline metrics {

/// Relative overlaps of two grains (core/law_range.h).
struct BeyondLaw {
    double tested = 0;        ///< overlap (core/law_range.h)
    double displacement = 0;  ///< smallest displacement with a larger overlap [m]
    double max_overlap = 0;
};

/// None if no overlap is larger, overlaps are unknown, or the model was not tested.
std::optional<BeyondLaw> beyond_law(const Replicas& replicas);

}  // namespace mcdem::metrics
