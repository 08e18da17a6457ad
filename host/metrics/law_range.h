// Where grains overlap more than their contact model was tested for.
#pragma once
#include <optional>

#include "metrics/replicas.h"

namespace mcdem::inline metrics {

/// Overlaps are those of two grains over the sum of their radii.
struct BeyondLaw {
    double tested = 0;        ///< overlap (core/law_range.h)
    double displacement = 0;  ///< least at which an overlap is larger [m]
    double max_overlap = 0;
};

/// None where no scan's overlap is larger, where it is not known, and for models that were not tested.
std::optional<BeyondLaw> beyond_law(const Replicas& replicas);

}  // namespace mcdem::metrics
