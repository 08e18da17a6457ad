// Location of the gap: cells whose difference after refitting exceeds the largest one of the replicates,
// merged into ranges.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

struct Location {
    std::vector<WhereEntry> entries;  ///< significant ones, largest first
    std::vector<WhereCell> cells;     ///< all
    double threshold =
        0;  ///< simultaneous threshold: quantile 1 - `Limits::false_alarm` of the largest |z| of a replicate
};

/// Descends from observable to phase to displacement while the parent is significant.
Location locate(const GapSpace& space, const GapData& data, const NullDistribution& null,
                const Eigen::VectorXd& gap, const Grid& grid, const Limits& limits);

}  // namespace mcdem::diagnose
