// Where is the gap? Cells whose difference, parameters refitted, is larger than any cell's of a replicate,
// gathered into ranges.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

struct Location {
    std::vector<WhereEntry> entries;  ///< significant ones, largest first
    std::vector<WhereCell> cells;     ///< all
    double threshold =
        0;  ///< simultaneous: |z| of the largest refitted cell of all replicates but `Limits::false_alarm`
};

/// Descends from observable to phase to displacement where the parent stands out.
Location locate(const GapSpace& space, const GapData& data, const NullDistribution& null,
                const Eigen::VectorXd& gap, const Grid& grid, const Limits& limits);

}  // namespace mcdem::diagnose
