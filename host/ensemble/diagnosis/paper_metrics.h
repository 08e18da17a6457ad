// Metrics of the paper for an experiment compared with the scene, and with the scene plus the named effect.
#pragma once
#include <vector>

#include "core/recording.h"
#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline ensemble {

struct BeforeAfter {
    std::vector<Recording> before, after;  ///< replicates, as measured
};

/// Sets GapReduction::metrics (Rtop, errf [N], errZ, bhat) and GapReduction::top_force.
void add_paper_metrics(GapReduction& gap_reduction, const Recording& experiment,
                       const BeforeAfter& simulated);

}  // namespace mcdem::ensemble
