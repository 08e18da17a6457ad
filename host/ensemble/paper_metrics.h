// The paper's metrics of an experiment against the scene as it stands and against the scene with its cause
// added.
#pragma once
#include <vector>

#include "core/recording.h"
#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline ensemble {

struct BeforeAfter {
    std::vector<Recording> before, after;  ///< replicates, as measured
};

/// Fills in GapReduction::metrics (Rtop, errf [N], errZ, bhat) and GapReduction::top_force.
void add_paper_metrics(GapReduction& gap_reduction, const Recording& experiment,
                       const BeforeAfter& simulated);

}  // namespace mcdem::ensemble
