#include "metrics/law_range.h"

#include <algorithm>

#include "core/law_range.h"

namespace mcdem::inline metrics {

std::optional<BeyondLaw> beyond_law(const Replicas& replicas) {
    const auto model = model_of(replicas);
    const auto tested = model ? tested_overlap(*model) : std::nullopt;
    if (!tested) return std::nullopt;
    std::optional<BeyondLaw> beyond;
    for (const Recording* recording : replicas)
        for (const Scan& scan : recording->scans) {
            if (!(scan.max_overlap > *tested)) continue;
            const double displacement = recording->displacement(scan);
            if (!beyond) beyond = {*tested, displacement, scan.max_overlap};
            beyond->displacement = std::min(beyond->displacement, displacement);
            beyond->max_overlap = std::max(beyond->max_overlap, scan.max_overlap);
        }
    return beyond;
}

}  // namespace mcdem::metrics
