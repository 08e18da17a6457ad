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

/// Fills in Shrink::metrics (Rtop, errf [N], errZ, bhat) and Shrink::top_force.
void add_paper_metrics(Shrink& shrink, const Recording& experiment, const BeforeAfter& simulated);

}  // namespace mcdem::ensemble
